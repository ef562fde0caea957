// Edge and body loads against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "sage/conformance/sample_laws.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

// Nodal forces, 2 x nodes, of a load on one edge.
Eigen::Matrix2Xd edge_forces(const Element& element, const Eigen::Matrix2Xd& x, int edge, const Vector2& normal,
                             const Vector2& shear) {
  std::vector<double> f(static_cast<std::size_t>(element.traits().dofs), 0.0);
  element.edge_load(x, edge, normal, shear, f);
  return Eigen::Map<const Eigen::Matrix2Xd>(f.data(), 2, element.traits().nodes);
}

Eigen::Matrix2Xd rectangle(const ElementEntry& entry, double x0, double x1, double y0, double y1) {
  Eigen::Matrix2Xd corners(2, entry.corners);
  if (entry.square())
    corners << x0, x1, x1, x0, y0, y0, y1, y1;
  else
    corners << x0, x1, x0, y0, y0, y1;
  return straight_element(entry, corners);
}

// Edge 1 of every element runs from (x0, y0) to (x1, y0): the lower side, inward = +y, counter-clockwise = +x.
TEST(EdgeLoad, SignsOnTheLowerSide) {
  for (const ElementCase& c : solid_cases()) {
    if (c.axisymmetric()) continue;
    SCOPED_TRACE(c.name);
    const auto x = rectangle(*c.entry, 1.0, 4.0, 2.0, 3.0);
    const Vector2 pressure = edge_forces(*c.make(), x, 0, {5.0, 5.0}, {0.0, 0.0}).rowwise().sum();
    EXPECT_NEAR(pressure.x(), 0.0, 1e-13);
    EXPECT_NEAR(pressure.y(), 15.0, 1e-13);
    const Vector2 shear = edge_forces(*c.make(), x, 0, {0.0, 0.0}, {7.0, 7.0}).rowwise().sum();
    EXPECT_NEAR(shear.x(), 21.0, 1e-13);
    EXPECT_NEAR(shear.y(), 0.0, 1e-13);
  }
}

// p from p1 to p2 over a length L: force L (p1 + p2) / 2, moment about the first corner L^2 (p1 + 2 p2) / 6.
TEST(EdgeLoad, LinearVariationForceAndMoment) {
  const double L = 3.0, p1 = 2.0, p2 = 11.0;
  for (const ElementCase& c : solid_cases()) {
    if (c.axisymmetric()) continue;
    SCOPED_TRACE(c.name);
    const auto x = rectangle(*c.entry, 1.0, 1.0 + L, 2.0, 3.0);
    const auto f = edge_forces(*c.make(), x, 0, {p1, p2}, {0.0, 0.0});
    double moment = 0.0;
    for (int i = 0; i < c.entry->nodes; ++i) moment += f(1, i) * (x(0, i) - 1.0);
    EXPECT_NEAR(f.row(1).sum(), L * (p1 + p2) / 2.0, 1e-12);
    EXPECT_NEAR(moment, L * L * (p1 + 2.0 * p2) / 6.0, 1e-12);
  }
}

TEST(EdgeLoad, ConsistentForcesOfTheQuadraticEdge) {
  const ElementCase c = element_case(2, 1, Geometry::plane_strain);
  const auto f = edge_forces(*c.make(), rectangle(*c.entry, 0.0, 6.0, 0.0, 1.0), 0, {1.0, 1.0}, {0.0, 0.0});
  EXPECT_NEAR(f(1, 0), 1.0, 1e-14);  // 1/6, 4/6, 1/6 of 6
  EXPECT_NEAR(f(1, 4), 4.0, 1e-14);
  EXPECT_NEAR(f(1, 1), 1.0, 1e-14);
}

// Pressure inside a cylinder of radius a, height h: radial nodal forces add up to p 2 pi a h, outwards.
TEST(EdgeLoad, CylinderUnderInternalPressure) {
  const double a = 1.5, h = 2.0, p = 3.0;
  for (const ElementCase& c : solid_cases()) {
    if (!c.axisymmetric()) continue;
    SCOPED_TRACE(c.name);
    const int left = c.entry->corners - 1;  // the last edge runs down the left side
    const auto f = edge_forces(*c.make(), rectangle(*c.entry, a, 2.5, 0.0, h), left, {p, p}, {0.0, 0.0});
    EXPECT_NEAR(f.row(0).sum(), p * 2.0 * kPi * a * h, 1e-12);
    EXPECT_NEAR(f.row(1).sum(), 0.0, 1e-12);
  }
}

// Ring from r1 to r2, pressure p1 to p2: 2 pi L (2 p1 r1 + p1 r2 + p2 r1 + 2 p2 r2) / 6; on the axis too.
TEST(EdgeLoad, RingWithLinearPressure) {
  const double p1 = 2.0, p2 = 5.0;
  for (const double r1 : {0.0, 1.0}) {
    const double r2 = r1 + 2.0;
    for (const ElementCase& c : solid_cases()) {
      if (!c.axisymmetric()) continue;
      SCOPED_TRACE(c.name);
      const auto f = edge_forces(*c.make(), rectangle(*c.entry, r1, r2, 0.0, 1.0), 0, {p1, p2}, {0.0, 0.0});
      EXPECT_NEAR(f.row(1).sum(), 4.0 * kPi * (2 * p1 * r1 + p1 * r2 + p2 * r1 + 2 * p2 * r2) / 6.0, 1e-12);
    }
  }
  const ElementCase q4 = element_case(1, 1, Geometry::axisymmetric);
  const auto f = edge_forces(*q4.make(), rectangle(*q4.entry, 1.0, 3.0, 0.0, 1.0), 0, {1.0, 1.0}, {0.0, 0.0});
  EXPECT_NEAR(f(1, 0), 2.0 * kPi * 2.0 * (2.0 * 1.0 + 3.0) / 6.0, 1e-13);
  EXPECT_NEAR(f(1, 1), 2.0 * kPi * 2.0 * (1.0 + 2.0 * 3.0) / 6.0, 1e-13);
}

// Divergence theorem: a uniform stress and its tractions on all edges are in balance at every node,
//   integral B^T sigma dV = boundary integral N^T (sigma n) dA.
// Ties together sign and order of edges, B, hoop strain, r in the weights, and B-bar.  A ring needs
// sigma_rr = sigma_tt and no shear to be in balance without body force.
TEST(EdgeLoad, BalancesUniformStress) {
  const SmoothLaw<4> law;
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    for (const auto& x : {sample_shape(*c.entry), sample_shape_on_axis(*c.entry)}) {
      const Vector4 sigma = c.axisymmetric() ? Vector4(-3.0, 5.0, -3.0, 0.0) : Vector4(-3.0, 2.0, 9.0, 1.5);
      ElementRun run(*element, x, static_cast<const SolidLaw*>(&law));
      for (std::size_t i = 0; i < run.sigma0.size(); ++i) run.sigma0[i] = sigma(static_cast<int>(i % 4));
      run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs));
      Eigen::Matrix2Xd f = Eigen::Matrix2Xd::Zero(2, c.entry->nodes);
      for (int e = 0; e < c.entry->corners; ++e) {
        const std::vector<int>& edge = element->edges()[e];
        const Vector2 s = (x.col(edge[1]) - x.col(edge[0])).normalized(), out(s.y(), -s.x());
        const Vector2 t(sigma(0) * out.x() + sigma(3) * out.y(), sigma(3) * out.x() + sigma(1) * out.y());
        f += edge_forces(*element, x, e, Vector2::Constant(-t.dot(out)), Vector2::Constant(t.dot(s)));
      }
      EXPECT_LT((f.reshaped() - run.f).norm(), 1e-13 * run.f.norm());
    }
  }
}

// The two sides of an interface take pressure too, each pushed towards the other.
TEST(EdgeLoad, SidesOfAnInterface) {
  for (const ElementCase& c : interface_cases()) {
    if (c.axisymmetric()) continue;
    SCOPED_TRACE(c.name);
    Eigen::Matrix2Xd ends(2, 2);
    ends << 0, 2, 0, 0;
    const auto x = straight_element(*c.entry, ends);
    EXPECT_NEAR(edge_forces(*c.make(), x, 0, {3.0, 3.0}, {0.0, 0.0}).row(1).sum(), 6.0, 1e-13);
    EXPECT_NEAR(edge_forces(*c.make(), x, 1, {3.0, 3.0}, {0.0, 0.0}).row(1).sum(), -6.0, 1e-13);
  }
}

// Rectangle r1..r2 x h: node forces of b_z in proportion (2 r1 + r2) : (r1 + 2 r2), a
// quarter of the height each.
TEST(BodyLoad, ConsistentInARing) {
  const ElementCase c = element_case(1, 2, Geometry::axisymmetric);
  const auto x = rectangle(*c.entry, 1.0, 3.0, 0.0, 0.5);
  std::vector<double> f(8, 0.0);
  c.make()->body_load(x, {0.0, -2.0}, f);
  const double half = -2.0 * 0.25 * 2.0 * kPi * 2.0 / 6.0;  // b h/2 2 pi (r2 - r1) / 6
  EXPECT_NEAR(f[1], half * 5.0, 1e-13);
  EXPECT_NEAR(f[3], half * 7.0, 1e-13);
  EXPECT_NEAR(f[5], half * 7.0, 1e-13);
  EXPECT_NEAR(f[7], half * 5.0, 1e-13);
}

// Plane square: corners of the serendipity element get -1/12 of the weight, mid-sides 1/3.
TEST(BodyLoad, SerendipityCorners) {
  const ElementCase c = element_case(2, 1, Geometry::plane_strain);
  std::vector<double> f(16, 0.0);
  c.make()->body_load(rectangle(*c.entry, 0.0, 2.0, 0.0, 3.0), {0.0, 12.0}, f);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(f[2 * i + 1], 72.0 * (i < 4 ? -1.0 / 12.0 : 1.0 / 3.0), 1e-12);
}

}  // namespace
}  // namespace sage::test
