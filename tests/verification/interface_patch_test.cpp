// Interfaces: uniform traction in any orientation (P4), consistent forces in rings (P5), and assembled patches.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "materials/linear_elastic.hpp"
#include "sage/conformance/patch.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

constexpr double kShear = 300.0, kNormal = 5000.0;
constexpr int kRowSum = 1, kNewtonCotes = 3;

// Pairs of local nodes: bottom, top.
struct Pair {
  int bottom, top;
};
std::vector<Pair> pairs_of(const ElementCase& c) {
  std::vector<Pair> pairs{{0, 3}, {1, 2}};
  if (!c.entry->only_corners()) pairs.push_back({4, 5});
  return pairs;
}

Eigen::Matrix2Xd straight(const ElementCase& c, const Vector2& from, const Vector2& to) {
  Eigen::Matrix2Xd ends(2, 2);
  ends << from, to;
  return straight_element(*c.entry, ends);
}

// An interface whose top side moves by `jump` (x, y), half of it down on the bottom side.
ElementRun open_by(const ElementCase& c, const Element& element, const Eigen::Matrix2Xd& x,
                   const InterfaceLaw& law, const Vector2& jump) {
  ElementRun run(element, x, &law);
  Eigen::Matrix2Xd u(2, c.entry->nodes);
  for (const Pair& pair : pairs_of(c)) {
    u.col(pair.bottom) = -0.5 * jump;
    u.col(pair.top) = 0.5 * jump;
  }
  run.evaluate(u.reshaped());
  return run;
}

// P4.  theta is the direction from node 1 to node 2; s = (cos, sin), n = (-sin, cos).
TEST(InterfaceP4, UniformTractionInAnyDirection) {
  const LinearLaw<2> law = interface_law(kShear, kNormal);
  const double L = 2.5;
  for (const ElementCase& c : interface_cases()) {
    if (c.axisymmetric()) continue;
    for (const double degrees : {0.0, 30.0, 90.0, 180.0, 251.0}) {
      SCOPED_TRACE(c.name + " " + std::to_string(degrees));
      const double a = degrees * kRadiansPerDegree;
      const Vector2 s(std::cos(a), std::sin(a)), n(-std::sin(a), std::cos(a));
      const auto element = c.make();
      const Eigen::Matrix2Xd x = straight(c, {0.3, -0.2}, Vector2(0.3, -0.2) + L * s);
      const double w_s = 2e-3, w_n = -1e-3;
      const ElementRun run = open_by(c, *element, x, law, w_s * s + w_n * n);
      for (std::size_t p = 0; p < run.status.size(); ++p) {
        EXPECT_NEAR(run.eps1[2 * p], w_s, 1e-15);
        EXPECT_NEAR(run.eps1[2 * p + 1], w_n, 1e-15);
        EXPECT_NEAR(run.sigma1[2 * p], kShear * w_s, 1e-12);
        EXPECT_NEAR(run.sigma1[2 * p + 1], kNormal * w_n, 1e-12);
      }
      // Internal forces: on the top side +t, on the bottom -t, shared 1/2 1/2 or 1/6 1/6 4/6.
      const Vector2 t = kShear * w_s * s + kNormal * w_n * n;
      const std::vector<Pair> pairs = pairs_of(c);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double share = pairs.size() == 2 ? 0.5 : (k == 2 ? 4.0 / 6.0 : 1.0 / 6.0);
        EXPECT_LT((run.f.segment<2>(2 * pairs[k].top) - share * L * t).norm(), 1e-13 * L * t.norm());
        EXPECT_LT((run.f.segment<2>(2 * pairs[k].bottom) + share * L * t).norm(), 1e-13 * L * t.norm());
      }
    }
  }
}

TEST(InterfaceP4, NormalIsPositiveWhenItOpens) {
  const LinearLaw<2> law = interface_law(kShear, kNormal);
  const ElementCase c = element_case(11, kRowSum, Geometry::plane_strain);
  const auto element = c.make();
  const ElementRun run = open_by(c, *element, straight(c, {0, 0}, {1, 0}), law, {0.0, 1e-3});  // top moves up
  EXPECT_GT(run.sigma1[1], 0.0);
  EXPECT_GT(run.f(2 * 3 + 1), 0.0) << "the internal force pulls the top node back down against a force up";
}

// Curved: on a parabola the pairs of the lumped rules carry exactly their own traction.
// Weights by fine summation.
TEST(InterfaceP4, CurvedPairsCarryTheirOwnTraction) {
  const LinearLaw<2> law = interface_law(kShear, kNormal);
  for (const int formulation : {kRowSum, kNewtonCotes}) {
    const ElementCase c = element_case(12, formulation, Geometry::plane_strain);
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    Eigen::Matrix2Xd x = straight(c, {0.0, 0.0}, {2.0, 0.0});
    x.col(4) = x.col(5) = Vector2(1.0, 0.3);  // y = 0.3 (1 - xi^2), x = 1 + xi
    const auto slope = [](double xi) { return -0.6 * xi; };
    ElementRun run(*element, x, static_cast<const InterfaceLaw*>(&law));
    const double at[3] = {-1.0, 1.0, 0.0};
    const Vector2 w(2e-3, -1e-3);
    Eigen::Matrix2Xd u = Eigen::Matrix2Xd::Zero(2, 6);
    std::vector<Matrix2> T;
    for (std::size_t k = 0; k < 3; ++k) {
      const double m = slope(at[k]), J = std::hypot(1.0, m);
      T.push_back((Matrix2() << 1.0, m, -m, 1.0).finished() / J);
      u.col(pairs_of(c)[k].top) = T[k].transpose() * w;
    }
    run.evaluate(u.reshaped());
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(run.sigma1[2 * k], kShear * w.x(), 1e-12);
      EXPECT_NEAR(run.sigma1[2 * k + 1], kNormal * w.y(), 1e-12);
      double weight = 0.0;  // integral N_k J, or Simpson's weight times J
      if (formulation == kNewtonCotes)
        weight = (k == 2 ? 4.0 : 1.0) / 3.0 * std::hypot(1.0, slope(at[k]));
      else
        for (int i = 0; i < 20000; ++i) {
          const double xi = -1.0 + (i + 0.5) * 1e-4;
          const double N = k == 2 ? 1.0 - xi * xi : 0.5 * xi * (xi + at[k]);
          weight += 1e-4 * N * std::hypot(1.0, slope(xi));
        }
      const Vector2 t(kShear * w.x(), kNormal * w.y());
      // 5 Gauss points on the square root and the midpoint sum: 1e-5 and 1e-9 of the weight.
      EXPECT_LT((run.f.segment<2>(2 * pairs_of(c)[k].top) - weight * T[k].transpose() * t).norm(),
                1e-5 * weight * t.norm());
    }
  }
}

// P5.  Uniform traction on a ring from r1 to r2: 2 pi L t {(2 r1 + r2)/6, (r1 + 2 r2)/6},
// quadratic 2 pi L t {r1/6, r2/6, (r1 + r2)/3}.  The linear Newton-Cotes rule gives {r1/2, r2/2}:
// the source chapter's objection.
TEST(InterfaceP5, ForcesOfUniformTractionInARing) {
  const LinearLaw<2> law = interface_law(kShear, kNormal);
  const Vector2 along(0.8, 0.6), normal(-0.6, 0.8);
  const double L = 1.5, w = 1e-3, t = kNormal * w;
  for (const ElementCase& c : interface_cases()) {
    if (!c.axisymmetric()) continue;
    for (const double r1 : {0.0, 0.01, 2.0}) {
      SCOPED_TRACE(c.name + " r1 = " + std::to_string(r1));
      const double r2 = r1 + 0.8 * L;
      const auto element = c.make();
      const Eigen::Matrix2Xd x = straight(c, {r1, 0.4}, Vector2(r1, 0.4) + L * along);
      const ElementRun run = open_by(c, *element, x, law, w * normal);
      std::vector<double> expected{(2.0 * r1 + r2) / 6.0, (r1 + 2.0 * r2) / 6.0};
      if (!c.entry->only_corners())
        expected = {r1 / 6.0, r2 / 6.0, (r1 + r2) / 3.0};
      else if (c.formulation == kNewtonCotes)
        expected = {r1 / 2.0, r2 / 2.0};
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const Vector2 top = run.f.segment<2>(2 * pairs_of(c)[k].top);
        EXPECT_LT((top - 2.0 * kPi * L * t * expected[k] * normal).norm(), 1e-13 * 2.0 * kPi * L * t * r2);
      }
    }
  }
}

// The row-sum rule leaves pairs uncoupled; Gauss couples them.
TEST(InterfaceRules, RowSumCouplesNoPairs) {
  const LinearLaw<2> law = interface_law(kShear, kNormal);
  for (const ElementCase& c : interface_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape(*c.entry), static_cast<const InterfaceLaw*>(&law));
    run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs));
    const double between = run.K.block<2, 2>(0, 2).norm();  // nodes 1 and 2, of different pairs
    if (c.formulation == 2)
      EXPECT_GT(between, 0.02 * run.K.norm());
    else
      EXPECT_EQ(between, 0.0);
  }
}

// A quadratic row-sum element uses three Gauss points where a pair would get less than 1/100 of the area, and
// says through position() where they are.
TEST(InterfaceRules, QuadraticRowSumTurnsToGaussAtTheAxis) {
  const LinearLaw<2> law = interface_law(kShear, kNormal);
  const ElementCase c = element_case(12, kRowSum, Geometry::axisymmetric);
  const auto element = c.make();
  const auto radius_of_first_point = [&](double r1) {
    return element->position(straight(c, {r1, 0.0}, {r1 + 2.0, 0.0}), 0).x();
  };
  EXPECT_EQ(radius_of_first_point(1.0), 1.0);
  EXPECT_NEAR(radius_of_first_point(0.0), 1.0 - std::sqrt(0.6), 1e-14);
  EXPECT_NEAR(radius_of_first_point(0.05), 1.05 - std::sqrt(0.6), 1e-14);  // r1/(3 (r1 + r2)) = 0.0079
  EXPECT_EQ(radius_of_first_point(0.1), 0.1);                              // 0.015
}

// ---- assembled patches: two blocks of solids with an interface between them ----

struct Sandwich {
  Eigen::Matrix2Xd x;
  std::vector<std::vector<int>> solids, interfaces;
  int columns = 0;
};

// Blocks (x0, x0 + 3) x (-1, 0) and (x0, x0 + 3) x (0, 1) in `columns` elements each;
// nodes on y = 0 are double.
Sandwich make_sandwich(const ElementEntry& solid, const ElementEntry& interface, double x0, int columns) {
  CornerMesh lower, upper;
  lower = perturbed_grid(columns, 1, x0, x0 + 3.0, -1.0, 0.0, 0.0);
  upper = perturbed_grid(columns, 1, x0, x0 + 3.0, 0.0, 1.0, 0.0);
  for (int i = 1; i < columns; ++i) {  // slanted and unequal, the same on both sides of y = 0
    lower.x(0, columns + 1 + i) += 0.2 * std::sin(2.0 * i);
    upper.x(0, i) += 0.2 * std::sin(2.0 * i);
  }
  const PatchMesh below = make_mesh(solid, lower), above = make_mesh(solid, upper);
  Sandwich s;
  s.columns = columns;
  s.x.resize(2, below.x.cols() + above.x.cols());
  s.x << below.x, above.x;
  s.solids = below.elements;
  const int offset = static_cast<int>(below.x.cols());
  for (std::vector<int> nodes : above.elements) {
    for (int& node : nodes) node += offset;
    s.solids.push_back(nodes);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
    const std::vector<int>& b = s.solids[i];
    const std::vector<int>& t = s.solids[i + static_cast<std::size_t>(columns)];
    std::vector<int> nodes{b[3], b[2], t[1], t[0]};  // bottom side from left to right, top side back
    if (!interface.only_corners()) nodes.insert(nodes.end(), {b[6], t[4]});
    s.interfaces.push_back(nodes);
  }
  return s;
}

struct SandwichErrors {
  double solid = 0.0, interface = 0.0;  // largest stress error over norm of the exact stress
};

// The sandwich under a uniform stress `local` = [ss nn tt sn] (axes s, n turned by `degrees`): bottom supported
// by its exact displacements, top and sides loaded by tractions.  Elastic interface with stiffness k.
SandwichErrors load_sandwich(const ElementCase& solid, const ElementCase& interface, double degrees,
                             const Vector2& k, const Vector4& local, double x0) {
  const double E = 1000.0, nu = 0.3;
  const LinearElastic law(moduli_from_young(E, nu));
  const LinearLaw<2> joint = interface_law(k.x(), k.y());
  const auto solid_element = solid.make(), interface_element = interface.make();
  Sandwich s = make_sandwich(*solid.entry, *interface.entry, x0, 3);
  const Eigen::Matrix2Xd flat = s.x;
  const Matrix2 R = Eigen::Rotation2Dd(degrees * kRadiansPerDegree).toRotationMatrix();
  s.x = R * flat;

  const Eigen::Index n = s.x.cols();
  std::vector<char> fixed(static_cast<std::size_t>(2 * n), 0);
  Eigen::Matrix2Xd given = Eigen::Matrix2Xd::Zero(2, n);
  // Bottom: u_s = eps_ss x + const, u_n = const; shear strain goes into the slope of u_s with y.
  const Vector2 in_plane(local(0), local(1));
  const double eps_ss = solid.axisymmetric() ? (local(0) - nu * (local(1) + local(2))) / E
                                             : (1.0 + nu) / E * ((1.0 - nu) * in_plane.x() - nu * in_plane.y());
  for (Eigen::Index i = 0; i < n; ++i) {
    if (flat(1, i) != -1.0) continue;
    given.col(i) = R * Vector2(eps_ss * flat(0, i), 0.0);
    fixed[2 * i] = fixed[2 * i + 1] = 1;
  }
  if (solid.axisymmetric())
    for (Eigen::Index i = 0; i < n; ++i)
      if (flat(0, i) == 0.0) fixed[2 * i] = 1;

  Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * n);
  const auto add = [&](const std::vector<int>& nodes, int edge, double pressure, double shear) {
    std::vector<double> f(2 * nodes.size(), 0.0);
    solid_element->edge_load(element_nodes(s.x, nodes), edge, Vector2::Constant(pressure),
                             Vector2::Constant(shear), f);
    for (std::size_t i = 0; i < f.size(); ++i) load(2 * nodes[i / 2] + static_cast<int>(i % 2)) += f[i];
  };
  const auto columns = static_cast<std::size_t>(s.columns);
  for (std::size_t i = 0; i < columns; ++i) add(s.solids[columns + i], 2, -local(1), -local(3));
  for (const std::size_t row : {std::size_t{0}, columns}) {
    add(s.solids[row + columns - 1], 1, -local(0), local(3));
    if (x0 > 0.0 || !solid.axisymmetric()) add(s.solids[row], 3, -local(0), local(3));
  }

  const std::vector<Group> groups{
      {solid_element.get(), static_cast<const SolidLaw*>(&law), s.solids},
      {interface_element.get(), static_cast<const InterfaceLaw*>(&joint), s.interfaces}};
  const Eigen::Matrix2Xd u = solve(s.x, groups, fixed, given, load);
  const DenseSystem solved = assemble(s.x, groups, u);

  const Matrix2 tensor = (Matrix2() << local(0), local(3), local(3), local(1)).finished();
  const Matrix2 turned = R * tensor * R.transpose();
  const double sigma_zz = solid.axisymmetric() ? local(2) : nu * (local(0) + local(1));
  const Vector4 sigma(turned(0, 0), turned(1, 1), sigma_zz, turned(0, 1));
  const Vector2 traction(local(3), local(1));
  SandwichErrors errors;
  for (const ElementRun& run : solved.runs[0])
    for (std::size_t p = 0; p < run.status.size(); ++p)
      errors.solid = std::max(
          errors.solid, (Eigen::Map<const Vector4>(run.sigma1.data() + 4 * p) - sigma).norm() / sigma.norm());
  for (const ElementRun& run : solved.runs[1])
    for (std::size_t p = 0; p < run.status.size(); ++p)
      errors.interface =
          std::max(errors.interface,
                   (Eigen::Map<const Vector2>(run.sigma1.data() + 2 * p) - traction).norm() / traction.norm());
  return errors;
}

// Solid that fits the interface: quad4 b-bar or quad8 full.
ElementCase neighbour(const ElementCase& interface) {
  return interface.entry->only_corners() ? element_case(1, 2, interface.geometry)
                                         : element_case(2, 2, interface.geometry);
}

// Stiffness ratio up to 1e12.  Stress in the solids keeps its digits; in the interface w = t/k is a difference
// of displacements known to rounding, so its stress loses digits in proportion: 2e-16 k h / E (h = 1).
TEST(InterfacePatch, PlaneStrainAnyDirectionAndStiffness) {
  for (const ElementCase& c : interface_cases()) {
    if (c.axisymmetric()) continue;
    for (const double degrees : {0.0, 30.0, 90.0})
      for (const double ratio : {1.0, 1e3, 1e6, 1e9, 1e12}) {
        SCOPED_TRACE(c.name + " " + std::to_string(degrees) + " " + std::to_string(ratio));
        const SandwichErrors e = load_sandwich(neighbour(c), c, degrees, Vector2(0.4, 1.0) * ratio * 1000.0,
                                               {-1.0, -3.0, 0.0, 0.8}, 0.0);
        EXPECT_LT(e.solid, 1e-11 + 1e-15 * ratio);
        EXPECT_LT(e.interface, 1e-11 + 1e-15 * ratio);
      }
  }
}

// Ring and full cylinder under axial stress and cell pressure: uniform with the row-sum and Gauss rules, also
// on the axis. Newton-Cotes fails on the linear element: the source chapter's objection.
TEST(InterfacePatch, AxisymmetricColumn) {
  for (const ElementCase& c : interface_cases()) {
    if (!c.axisymmetric()) continue;
    for (const double x0 : {0.0, 1.0}) {
      if (c.formulation == kNewtonCotes && x0 == 0.0) continue;  // the pair on the axis is free: singular
      SCOPED_TRACE(c.name + " from r = " + std::to_string(x0));
      const SandwichErrors e = load_sandwich(neighbour(c), c, 0.0, {4e4, 1e5}, {-1.0, -3.0, -1.0, 0.0}, x0);
      if (c.formulation == kNewtonCotes && c.entry->only_corners()) {
        EXPECT_GT(e.interface, 1e-3);
      } else {
        EXPECT_LT(e.solid, 1e-11);
        EXPECT_LT(e.interface, 1e-11);
      }
    }
  }
}

}  // namespace
}  // namespace sage::test
