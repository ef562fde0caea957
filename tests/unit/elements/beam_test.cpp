// Beams, shells and bars against closed forms, in a frame program of a few lines: every number here is statics or a
// textbook's.  docs/theory/structures.md
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/conformance/element_cases.hpp"
#include "sage/conformance/law_driver.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "sage/messages/error.hpp"

namespace sage {
namespace {

using conformance::ElementRun;

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue c;
    register_elements(c);
    register_materials(c);
    return c;
  }();
  return all;
}

const ElementEntry& entry(const std::string& name) {
  return *catalogue().elements.find(catalogue().elements.code_of(name));
}

LawPtr law(const std::string& name, const std::vector<double>& values) {
  return catalogue()
      .materials.find(catalogue().materials.code_of(name))
      ->make(values, conformance::kpa_units());
}

// Nodes with three dofs each: u, v, theta.
class Frame {
 public:
  Frame(Geometry geometry, Eigen::Matrix2Xd x)
      : geometry_(geometry), x_(std::move(x)), load_(Eigen::VectorXd::Zero(3 * x_.cols())) {}

  void element(const std::string& name, const LawPtr& law, std::vector<int> nodes) {
    elements_.push_back({entry(name).make(geometry_, 0), reference(law), std::move(nodes)});
  }
  void hold(int node, int component) { held_[3 * node + component] = 0.0; }
  void clamp(int node) {
    for (int c = 0; c < 3; ++c) hold(node, c);
  }
  void spring(int node, int component, double k) { springs_[3 * node + component] = k; }
  void load(int node, int component, double value) { load_(3 * node + component) += value; }
  void pressure(std::size_t e, Vector2 normal, Vector2 shear = Vector2::Zero()) {
    add(e, [&](const Eigen::Matrix2Xd& x, std::vector<double>& f) {
      elements_[e].element->edge_load(x, 0, normal, shear, f);
    });
  }
  void weight(std::size_t e, Vector2 b) {
    add(e,
        [&](const Eigen::Matrix2Xd& x, std::vector<double>& f) { elements_[e].element->body_load(x, b, f); });
  }

  void solve() {
    const Eigen::Index n = load_.size();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      ElementRun run(*elements_[e].element, coordinates(e), elements_[e].law);
      run.evaluate(Eigen::VectorXd::Zero(run.f.size()));
      const std::vector<int> dofs = dofs_of(e);
      for (std::size_t i = 0; i < dofs.size(); ++i)
        for (std::size_t j = 0; j < dofs.size(); ++j)
          K(dofs[i], dofs[j]) += run.K(static_cast<int>(i), static_cast<int>(j));
    }
    for (const auto& [dof, k] : springs_) K(dof, dof) += k;
    std::vector<int> free;
    for (int dof = 0; dof < n; ++dof)
      if (!held_.contains(dof) && K(dof, dof) != 0.0) free.push_back(dof);
    u_ = Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd answer = Eigen::MatrixXd(K(free, free)).ldlt().solve(load_(free));
    for (std::size_t i = 0; i < free.size(); ++i) u_(free[i]) = answer(static_cast<Eigen::Index>(i));
  }

  double u(int node, int component) const { return u_(3 * node + component); }
  // Stress of an element's point.
  Eigen::VectorXd stress(std::size_t e, int point) const {
    ElementRun run(*elements_[e].element, coordinates(e), elements_[e].law);
    const std::vector<int> dofs = dofs_of(e);
    Eigen::VectorXd own(static_cast<Eigen::Index>(dofs.size()));
    for (std::size_t i = 0; i < dofs.size(); ++i) own(static_cast<Eigen::Index>(i)) = u_(dofs[i]);
    run.evaluate(own);
    const int n = elements_[e].element->traits().law_size;
    return Eigen::Map<const Eigen::VectorXd>(run.sigma1.data() + point * n, n);
  }

 private:
  struct One {
    std::unique_ptr<Element> element;
    LawRef law;
    std::vector<int> nodes;
  };
  Eigen::Matrix2Xd coordinates(std::size_t e) const { return x_(Eigen::all, elements_[e].nodes); }
  std::vector<int> dofs_of(std::size_t e) const {
    std::vector<int> dofs;
    for (const int node : elements_[e].nodes)
      for (int c = 0; c < 2; ++c) dofs.push_back(3 * node + c);
    if (elements_[e].element->traits().law_size == 5)
      for (const int node : elements_[e].nodes) dofs.push_back(3 * node + 2);
    return dofs;
  }
  template <class Add>
  void add(std::size_t e, const Add& add_load) {
    const std::vector<int> dofs = dofs_of(e);
    std::vector<double> f(dofs.size(), 0.0);
    add_load(coordinates(e), f);
    for (std::size_t i = 0; i < dofs.size(); ++i) load_(dofs[i]) += f[i];
  }

  Geometry geometry_;
  Eigen::Matrix2Xd x_;
  std::vector<One> elements_;
  std::map<int, double> held_, springs_;
  Eigen::VectorXd load_, u_;
};

// n elements in a row from a to z; with three nodes an element has its middle node behind its second.
struct Row {
  Eigen::Matrix2Xd x;
  std::vector<std::vector<int>> nodes;
  int last = 0;

  Row(const std::string& name, int n, const Vector2& a, const Vector2& z) {
    const int order = entry(name).nodes - 1;
    last = order * n;
    x.resize(2, last + 1);
    for (int i = 0; i <= last; ++i) x.col(i) = a + (z - a) * i / last;
    for (int e = 0; e < n; ++e) {
      nodes.push_back({order * e, order * (e + 1)});
      if (order == 2) nodes.back().push_back(2 * e + 1);
    }
  }
  void add_to(Frame& frame, const std::string& name, const LawPtr& law) const {
    for (const auto& list : nodes) frame.element(name, law, list);
  }
};

// Width and height 1, L = 10, E = 1e4, nu = .25: strips carry E, a plate E/(1-nu^2).  P L^3/(3 EI) + P L/(5/6 GA).
constexpr double kE = 1e4, kNu = 0.25, kL = 10.0;

TEST(Beam, CantileverIsExactWithOneElement) {
  for (const double across : {0.0, 1.0}) {
    const LawPtr plate = law("plate", {kE, kNu, 1.0, across});
    const double EI = kE / 12.0 / (across == 1.0 ? 1.0 - kNu * kNu : 1.0), GA = 5.0 / 6.0 * kE / 2.5;
    for (const double degrees : {0.0, 37.0, 90.0, 200.0}) {
      const double turn = degrees * kRadiansPerDegree;
      const Vector2 along(std::cos(turn), std::sin(turn)), left(-along.y(), along.x());
      for (const int n : {1, 3}) {
        const Row row("beam2", n, {1.0, 2.0}, Vector2(1.0, 2.0) + kL * along);
        Frame frame(Geometry::plane_strain, row.x);
        row.add_to(frame, "beam2", plate);
        frame.clamp(0);
        for (int c = 0; c < 2; ++c) frame.load(row.last, c, left(c));
        frame.solve();
        const double w = left.x() * frame.u(row.last, 0) + left.y() * frame.u(row.last, 1);
        const double exact = kL * kL * kL / (3.0 * EI) + kL / GA;
        EXPECT_NEAR(w, exact, 1e-11 * exact) << n;  // 1e-16 times the condition number of three elements
        EXPECT_NEAR(frame.u(row.last, 2), kL * kL / (2.0 * EI), 1e-11 * exact);
        EXPECT_NEAR(frame.stress(0, 0)(3), kL, 1e-9);   // M at the clamp: the load pulls the right-hand side
        EXPECT_NEAR(frame.stress(0, 0)(2), 1.0, 1e-9);  // Q
      }
    }
  }
}

// The numbers of the B1: Euler-Bernoulli .4, with shear .403; plane strain .375 and .378.
TEST(Beam, CantileverHasTheBooksNumbers) {
  for (const auto& [across, deflection] : {std::pair{0.0, 0.403}, {1.0, 0.378}}) {
    const LawPtr plate = law("plate", {kE, kNu, 1.0, across});
    const Row row("beam2", 4, {0.0, 0.0}, {kL, 0.0});
    Frame frame(Geometry::plane_strain, row.x);
    row.add_to(frame, "beam2", plate);
    frame.clamp(0);
    frame.load(row.last, 1, 1.0);
    frame.solve();
    EXPECT_NEAR(frame.u(row.last, 1), deflection, 1e-11);
  }
}

// An even load: 5 q L^4/(384 EI) + q L^2/(8 GA) simply supported, q L^4/(384 EI) + q L^2/(8 GA) clamped, at nodes.
TEST(Beam, EvenLoadIsExactAtTheNodes) {
  const LawPtr plate = law("plate", {kE, kNu, 1.0, 0.0});
  for (const bool clamped : {false, true}) {
    const Row row("beam2", 2, {0.0, 0.0}, {kL, 0.0});
    Frame frame(Geometry::plane_strain, row.x);
    row.add_to(frame, "beam2", plate);
    for (const int node : {0, row.last}) {
      for (int c = 0; c < (clamped ? 3 : 2); ++c) frame.hold(node, c);
    }
    frame.pressure(0, {-1.0, -1.0});
    frame.weight(1, {0.0, -1.0});  // the same, as weight
    frame.solve();
    EXPECT_NEAR(frame.u(1, 1), clamped ? -0.035 : -0.16, 1e-12);
  }
}

// No locking: L/h = 1e4, one element as well as sixteen; the digits that are lost are those of the condition number.
TEST(Beam, SlenderBeamsDoNotLock) {
  const double h = 1e-3;
  const LawPtr plate = law("plate", {kE, kNu, h, 0.0});
  const double EI = kE * h * h * h / 12.0, exact = kL * kL * kL / (3.0 * EI);
  for (const auto& [name, n, tolerance] :
       {std::tuple{"beam2", 1, 1e-7}, {"beam2", 16, 1e-4}, {"beam3", 16, 1e-2}}) {
    const Row row(name, n, {0.0, 0.0}, {kL, 0.0});
    Frame frame(Geometry::plane_strain, row.x);
    row.add_to(frame, name, plate);
    frame.clamp(0);
    frame.load(row.last, 1, 1.0);
    frame.solve();
    EXPECT_NEAR(frame.u(row.last, 1) / exact, 1.0, tolerance) << name << " " << n;
  }
}

// Deflection in the middle of a circular plate under a pressure of 1.
double circular_plate(const std::string& name, int n, bool clamped) {
  const double a = 1.0, t = 0.1;
  const LawPtr plate = law("plate", {1000.0, 0.3, t});
  const Row row(name, n, {0.0, 0.0}, {a, 0.0});
  Frame frame(Geometry::axisymmetric, row.x);
  row.add_to(frame, name, plate);
  frame.hold(0, 0);
  frame.hold(0, 2);
  frame.hold(row.last, 1);
  frame.hold(row.last, 0);
  if (clamped) frame.hold(row.last, 2);
  for (std::size_t e = 0; e < row.nodes.size(); ++e) frame.pressure(e, {-1.0, -1.0});
  frame.solve();
  return -frame.u(0, 1);
}

// q a^4/(64 D), simply supported times (5+nu)/(1+nu), and q a^2/(4 k G t) of shear.  A shell's shear and axial strain
// vary within an element, of which beam2 takes the mean: order 2; beam3 has order 4.
TEST(Shell, CircularPlatesConvergeAtTheirRate) {
  for (const auto& [name, rate, last] : {std::tuple{"beam2", 1.75, 3e-5}, {"beam3", 3.5, 4e-7}})
    for (const auto& [clamped, exact] : {std::pair{true, 0.178425}, {false, 0.703425}}) {
      SCOPED_TRACE(std::string(name) + (clamped ? " clamped" : " simply supported"));
      double before = 0.0;
      for (const int n : {4, 8, 16, 32}) {
        const double error = std::abs(circular_plate(name, n, clamped) / exact - 1.0);
        if (before > 0.0) {
          EXPECT_GT(std::log2(before / error), rate) << n;
        }
        before = error;
      }
      EXPECT_LT(before, last);
    }
}

// M on the axis of the simply supported plate is (3+nu) q a^2/16 along and around alike.
TEST(Shell, MomentsOnTheAxisAreTheSameAlongAndAround) {
  const int n = 32;
  const LawPtr plate = law("plate", {1000.0, 0.3, 0.1});
  const Row row("beam2", n, {0.0, 0.0}, {1.0, 0.0});
  Frame frame(Geometry::axisymmetric, row.x);
  row.add_to(frame, "beam2", plate);
  for (const auto& [node, component] : {std::pair{0, 0}, {0, 2}, {n, 1}}) frame.hold(node, component);
  for (std::size_t e = 0; e < row.nodes.size(); ++e) frame.pressure(e, {-1.0, -1.0});
  frame.solve();
  const Eigen::VectorXd at = frame.stress(0, 0);
  EXPECT_NEAR(at(3), 0.20625, 2e-3 * 0.20625);  // of the first element, order 2
  EXPECT_NEAR(at(4), at(3), 1e-12);
}

// Radial displacement of the wall of a tank (PHYSICS: 30 digits), base clamped and top free, without shear.
TEST(Shell, TankWallConverges) {
  const double a = 5.0, H = 6.0, t = 0.25;
  const double exact[] = {1.39410377647e-4, 2.01960761189e-4};  // at y = 1 and 2
  for (const auto& [name, last] : {std::pair{"beam2", 1e-5}, {"beam3", 3e-6}}) {
    const int n = 96;
    // The exact wall does not shear: at 1e5 times the shear stiffness that is 5e-7 of the answer; more costs digits.
    const LawPtr plate = law("plate", {2e7, 0.2, t, 1.0, 1e5});
    const Row row(name, n, {a, 0.0}, {a, H});
    Frame frame(Geometry::axisymmetric, row.x);
    row.add_to(frame, name, plate);
    frame.clamp(0);
    for (std::size_t e = 0; e < row.nodes.size(); ++e)
      frame.pressure(e, {-10.0 * (H - row.x(1, row.nodes[e][0])), -10.0 * (H - row.x(1, row.nodes[e][1]))});
    frame.solve();
    for (const int y : {1, 2}) EXPECT_NEAR(frame.u(row.last * y / 6, 0) / exact[y - 1], 1.0, last) << name << y;
    if (std::string(name) == "beam3") continue;                  // its points are not at the ends
    EXPECT_NEAR(frame.stress(32, 0)(1), 201.96076118891, 0.02);  // N_theta at y = 2
    EXPECT_NEAR(frame.stress(0, 0)(3), -18.9362636344, 0.03);    // M at the base
  }
}

// A ring under a pull of 3 for each unit of its circumference: u = 3 r^2 / EA.
TEST(Ring, StretchesAsAHoop) {
  const LawPtr bar = law("axial_elastic", {200.0});
  Frame frame(Geometry::axisymmetric, Eigen::Vector2d(2.0, 1.0));
  frame.element("ring1", bar, {0});
  frame.hold(0, 1);
  frame.load(0, 0, 3.0 * 2.0 * kPi * 2.0);
  frame.solve();
  EXPECT_NEAR(frame.u(0, 0), 3.0 * 4.0 / 200.0, 1e-15);
  EXPECT_NEAR(frame.stress(0, 0)(0), 6.0, 1e-13);
}

// A cantilever propped at its tip by a spring of 50 (PHYSICS, B3): EI = 1000 ... by statics R = q L^4/(8 EI) over
// L^3/(3 EI) + 1/k.
TEST(Spring, PropsACantilever) {
  const double EI = 1e4 / 12.0, k = 50.0, q = 1.0;
  const LawPtr section = law("section_elastic", {1e4, EI, 1e9}), spring = law("axial_elastic", {k});
  Eigen::Matrix2Xd x(2, 4);
  x << 0.0, 5.0, 10.0, 10.0, 0.0, 0.0, 0.0, -3.0;
  Frame frame(Geometry::plane_strain, x);
  frame.element("beam2", section, {0, 1});
  frame.element("beam2", section, {1, 2});
  frame.element("spring2", spring, {2, 3});
  frame.clamp(0);
  frame.clamp(3);
  frame.pressure(0, {-q, -q});
  frame.pressure(1, {-q, -q});
  frame.solve();
  const double prop = q * 1e4 / (8.0 * EI) / (1e3 / (3.0 * EI) + 1.0 / k);
  EXPECT_NEAR(frame.stress(2, 0)(0), -prop, 1e-4 * prop);  // GA = 1e9 for none
  EXPECT_NEAR(frame.u(2, 1), -prop / k, 1e-4 * prop / k);
}

// k for each unit of width; around the axis the whole circle.
TEST(RotationalSpring, HasAMomentForEachRadian) {
  const LawPtr section = law("section_elastic", {1.0, 50.0});
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
    const auto element = entry("rotational_spring1").make(geometry, 0);
    ElementRun run(*element, Eigen::Vector2d(2.0, 1.0), reference(section));
    run.evaluate(Eigen::Vector4d(0.3, -0.2, 0.01, 0.03));
    const double width = geometry == Geometry::axisymmetric ? 2.0 * kPi * 2.0 : 1.0;
    EXPECT_NEAR(run.sigma1[3], 50.0 * 0.02, 1e-14);
    EXPECT_LT((run.f - width * Eigen::Vector4d(0.0, 0.0, -1.0, 1.0)).norm(), 1e-13 * width);
  }
  const auto element = entry("rotational_spring1").make(Geometry::axisymmetric, 0);
  std::vector<double> room(static_cast<std::size_t>(element->traits().geometry_size()));
  EXPECT_THROW(element->geometry(Eigen::Vector2d(0.0, 1.0), room), ElementShapeError);
}

// Reversed, every element answers the same but for the sign of the bending moment.
TEST(Beam, ReversedElementsAreTheSame) {
  const LawPtr plate = law("plate", {kE, kNu, 1.0});
  std::array<Eigen::VectorXd, 2> stress;
  for (const std::size_t reversed : {0, 1}) {
    Eigen::Matrix2Xd x(2, 2);
    x << 0.3, 2.0, 0.1, 1.2;
    Frame frame(Geometry::axisymmetric, x);
    frame.element("beam2", plate, reversed == 1 ? std::vector<int>{1, 0} : std::vector<int>{0, 1});
    frame.clamp(0);
    frame.load(1, 0, 1.0);
    frame.load(1, 2, 0.4);
    frame.solve();
    stress[reversed] = frame.stress(0, reversed == 1 ? 2 : 0);
  }
  const Vector<5> signs(1.0, 1.0, 1.0, -1.0, -1.0);
  EXPECT_LT((signs.asDiagonal() * stress[1] - stress[0]).norm(), 1e-13 * stress[0].norm());
}

}  // namespace
}  // namespace sage
