// Contact with a rigid line, one element: forces in closed form, equilibrium with the line, tangents by differences, and
// what it makes of points that do not touch.
#include <gtest/gtest.h>

#include <cmath>

#include "sage/messages/error.hpp"
#include "tests/support/elements.hpp"
#include "tests/support/laws.hpp"

namespace sage::test {
namespace {

constexpr double kNormal = 2000.0, kShear = 300.0;

struct Kind {
  const char* name;
  Geometry geometry;
  int edge;  // nodes
};
std::vector<Kind> kinds() {
  return {{"contact4", Geometry::plane_strain, 2},
          {"contact4", Geometry::axisymmetric, 2},
          {"contact5", Geometry::plane_strain, 3},
          {"contact5", Geometry::axisymmetric, 3}};
}
std::string words(const Kind& kind) {
  return std::string(kind.name) + (kind.geometry == Geometry::axisymmetric ? " axisymmetric" : " plane strain");
}
std::unique_ptr<Element> make(const Kind& kind) {
  const Registry<ElementEntry>& elements = element_catalogue().elements;
  return elements.find(elements.code_of(kind.name))->make_large(kind.geometry, 1);
}
std::unique_ptr<InterfaceLaw> joint(double shear = kShear) {
  return interface(21, {shear, kNormal, 0.0});
}

// The edge from (1, height) to (3, height) above a line from (0, 0) to (5, 0); the body is above.
Eigen::Matrix2Xd above(const Kind& kind, double height) {
  Eigen::Matrix2Xd x(2, kind.edge + 2);
  x.col(0) << 1.0, height;
  x.col(1) << 3.0, height;
  if (kind.edge == 3) x.col(2) << 2.0, height;
  x.col(kind.edge) << 0.0, 0.0;
  x.col(kind.edge + 1) << 5.0, 0.0;
  return x;
}

struct Touching {
  Touching(const Kind& kind, const Eigen::Matrix2Xd& x, const InterfaceLaw& law)
      : element(make(kind)), run(*element, x, &law), edge(kind.edge) {}
  // All nodes of the edge by `by`, those of the line stay.
  Eigen::VectorXd moved(const Vector2& by) const {
    Eigen::VectorXd du = Eigen::VectorXd::Zero(run.u0.size());
    for (int i = 0; i < edge; ++i) du.segment<2>(2 * i) = by;
    return du;
  }
  void commit(const Eigen::VectorXd& du) {
    ASSERT_EQ(run.evaluate(du), Outcome::ok);
    run.sigma0 = run.sigma1;
    run.eps0 = run.eps1;
    run.h0 = run.h1;
    run.u0 += du;
  }
  Vector2 force_on_edge() const {
    Vector2 sum = Vector2::Zero();
    for (int i = 0; i < edge; ++i) sum += run.f.segment<2>(2 * i);
    return sum;
  }
  std::unique_ptr<Element> element;
  ElementRun run;
  int edge;
};

// k_n times the depth on the area 2, or the ring pi (3^2 - 1^2); pushes the body up, against the internal force.
TEST(Contact, PressureIsTheStiffnessTimesTheDepth) {
  const auto law = joint();
  for (const Kind& kind : kinds()) {
    Touching body(kind, above(kind, 0.5), *law);
    ASSERT_EQ(body.run.evaluate(body.moved({0.0, -0.7})), Outcome::ok);
    const double area = kind.geometry == Geometry::axisymmetric ? 8.0 * kPi : 2.0;
    EXPECT_NEAR(body.force_on_edge().y(), -0.2 * kNormal * area, 1e-11 * kNormal * area) << words(kind);
    EXPECT_NEAR(body.force_on_edge().x(), 0.0, 1e-11 * kNormal * area) << words(kind);
  }
}

// The part of the way on which both touch counts as slip: none in the step that makes contact, all of the next.
TEST(Contact, ShearFollowsTheSlipSinceContact) {
  const auto law = joint();
  for (const Kind& kind : kinds()) {
    Touching body(kind, above(kind, 0.5), *law);
    body.commit(body.moved({0.3, -0.7}));
    EXPECT_NEAR(body.force_on_edge().x(), 0.0, 1e-10) << words(kind);
    body.commit(body.moved({0.1, 0.0}));
    for (int p = 0; p < body.element->traits().points; ++p) {
      EXPECT_NEAR(body.run.sigma1[2 * p], 0.1 * kShear, 1e-11 * kShear) << words(kind);
      EXPECT_NEAR(body.run.eps1[2 * p], 0.1, 1e-14) << words(kind);
      EXPECT_NEAR(body.run.eps1[2 * p + 1], -0.2, 1e-14) << words(kind);
    }
    // Lifted off, all is forgotten.
    body.commit(body.moved({0.0, 0.4}));
    body.commit(body.moved({0.0, -0.4}));
    EXPECT_NEAR(body.force_on_edge().x(), 0.0, 1e-10) << words(kind);
    EXPECT_LT(body.force_on_edge().y(), -100.0) << words(kind);
  }
}

TEST(Contact, NothingActsBeforeTheLineOrBeyondItsEnds) {
  const auto law = joint();
  for (const Kind& kind : kinds()) {
    Touching body(kind, above(kind, 0.5), *law);
    for (const Vector2& by : {Vector2(0.0, -0.499), Vector2(4.5, -0.7)}) {
      ASSERT_EQ(body.run.evaluate(body.moved(by)), Outcome::ok);
      EXPECT_EQ(body.run.f.norm(), 0.0) << words(kind);
      EXPECT_EQ(body.run.K.norm(), 0.0) << words(kind);
      for (const PointStatus status : body.run.status) EXPECT_EQ(status, PointStatus::open) << words(kind);
      EXPECT_NEAR(body.run.eps1[1], 0.5 + by.y(), 1e-14) << words(kind);
    }
  }
}

// A bent edge that has entered a slanting line, in two steps, with shear.
void press(Touching& body, Eigen::VectorXd& du) {
  const int dofs = static_cast<int>(body.run.u0.size());
  Eigen::VectorXd first(dofs);
  for (int i = 0; i < dofs; ++i) first(i) = 0.05 * std::sin(1.3 * i * i + 0.7 * i + 0.4);
  for (int i = 0; i < body.edge; ++i) first(2 * i + 1) -= 0.8;
  body.commit(first);
  du.resize(dofs);
  for (int i = 0; i < dofs; ++i) du(i) = 0.04 * std::sin(0.9 * i * i + 1.7 * i + 0.2);
}

// In plane strain forces and moments of the edge and of the line cancel, in the moved place.
TEST(Contact, EdgeAndLineAreInEquilibrium) {
  const auto law = joint();
  for (const Kind& kind : kinds()) {
    if (kind.geometry == Geometry::axisymmetric) continue;
    Touching body(kind, above(kind, 0.5), *law);
    Eigen::VectorXd du;
    press(body, du);
    ASSERT_EQ(body.run.evaluate(du), Outcome::ok);
    Vector2 sum = Vector2::Zero();
    double moment = 0.0;
    for (int i = 0; i < body.edge + 2; ++i) {
      const Vector2 at = body.run.x.col(i) + body.run.u0.segment<2>(2 * i) + du.segment<2>(2 * i);
      const Vector2 f = body.run.f.segment<2>(2 * i);
      sum += f;
      moment += at.x() * f.y() - at.y() * f.x();
    }
    const double size = body.run.f.norm();
    EXPECT_GT(size, 100.0);
    EXPECT_LT(sum.norm(), 1e-13 * size) << words(kind);
    EXPECT_NEAR(moment, 0.0, 1e-12 * size) << words(kind);
  }
}

TEST(Contact, StiffnessIsTheDerivativeOfTheForce) {
  const SmoothLaw<2> smooth(1e9);
  const auto elastic = joint();
  for (const InterfaceLaw* law :
       {static_cast<const InterfaceLaw*>(&smooth), static_cast<const InterfaceLaw*>(elastic.get())})
    for (const Kind& kind : kinds()) {
      Touching body(kind, above(kind, 0.5), *law);
      Eigen::VectorXd du;
      press(body, du);
      for (int p = 0; p < body.element->traits().points; ++p) EXPECT_LT(body.run.eps0[2 * p + 1], -0.1);
      EXPECT_LT(tangent_error(body.run, du, 1e-5), 1e-7) << words(kind);
      // In the step that makes contact too.
      Touching coming(kind, above(kind, 0.5), *law);
      EXPECT_LT(tangent_error(coming.run, coming.moved({0.1, -0.6}) + du, 1e-5), 1e-7) << words(kind);
    }
}

TEST(Contact, ALineWithTheBodyOnItsOtherSideIsRejected) {
  const auto law = joint();
  for (const Kind& kind : kinds()) {
    Eigen::Matrix2Xd x = above(kind, 0.5);
    const Vector2 start = x.col(kind.edge);
    x.col(kind.edge) = x.col(kind.edge + 1);
    x.col(kind.edge + 1) = start;
    try {
      Touching body(kind, x, *law);
      ADD_FAILURE() << words(kind);
    } catch (const ElementShapeError& error) {
      EXPECT_NE(std::string(error.what()).find("the edge lies beyond the line"), std::string::npos)
          << error.what();
      EXPECT_NE(std::string(error.what()).find("exchange the two"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sage::test
