// Interfaces under large strain, one element: rotations, small strain as the limit, equilibrium, tangents by differences.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/elements.hpp"
#include "tests/support/laws.hpp"

namespace sage::test {
namespace {

constexpr double kNormal = 2000.0, kShear = 300.0;

std::vector<ElementCase> large_cases() {
  std::vector<ElementCase> cases = interface_cases();
  std::erase_if(cases, [](const ElementCase& c) {
    return !c.entry->make_large || c.entry->make_large(c.geometry, c.formulation) == nullptr;
  });
  return cases;
}

std::unique_ptr<InterfaceLaw> joint() {
  return interface(21, {kShear, kNormal, 0.0});
}

struct Joint {
  Joint(const ElementCase& c, const InterfaceLaw& law)
      : element(c.entry->make_large(c.geometry, c.formulation)), run(*element, sample_shape(*c.entry), &law) {}
  void commit(const Eigen::VectorXd& du) {
    ASSERT_EQ(run.evaluate(du), Outcome::ok);
    run.sigma0 = run.sigma1;
    run.eps0 = run.eps1;
    run.h0 = run.h1;
    run.u0 += du;
  }
  // All nodes turned about the origin from where they are.
  Eigen::VectorXd turn(double angle) const {
    const Eigen::Matrix2d R =
        (Eigen::Matrix2d() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)).finished();
    Eigen::VectorXd du(run.u0.size());
    for (Eigen::Index i = 0; i < run.x.cols(); ++i) {
      const Vector2 now = run.x.col(i) + run.u0.segment<2>(2 * i);
      du.segment<2>(2 * i) = R * now - now;
    }
    return du;
  }
  std::unique_ptr<Element> element;
  ElementRun run;
};

// Moves of a wavy shape, by a fraction of the element's size.
Eigen::VectorXd wave(Eigen::Index dofs, double size, double phase) {
  Eigen::VectorXd du(dofs);
  for (Eigen::Index i = 0; i < dofs; ++i) {
    const auto k = static_cast<double>(i);
    du(i) = size * std::sin(0.9 * k * k + 1.7 * k + phase);
  }
  return du;
}

TEST(LargeInterface, ThereAreFourForEachGeometry) {
  EXPECT_EQ(large_cases().size(), 8u);  // interface4 and interface6, Gauss and Newton-Cotes
}

// In plane strain; rings can't turn.
TEST(LargeInterface, ARotationBy90DegreesLeavesTractionsAndTurnsForces) {
  const auto law = joint();
  for (const ElementCase& c : large_cases()) {
    if (c.axisymmetric()) continue;
    Joint body(c, *law);
    body.commit(wave(body.run.u0.size(), 0.1, 0.3));
    const std::vector<double> sigma = body.run.sigma0, eps = body.run.eps0;
    const Eigen::VectorXd f = body.run.f;
    for (int quarter = 0; quarter < 3; ++quarter) body.commit(body.turn(kPi / 6.0));
    for (std::size_t i = 0; i < sigma.size(); ++i) {
      EXPECT_NEAR(body.run.sigma0[i], sigma[i], 1e-11 * kNormal) << c.name;
      EXPECT_NEAR(body.run.eps0[i], eps[i], 1e-14) << c.name;
    }
    for (Eigen::Index i = 0; i < f.size(); i += 2) {
      EXPECT_NEAR(body.run.f(i), -f(i + 1), 1e-11 * f.norm()) << c.name;
      EXPECT_NEAR(body.run.f(i + 1), f(i), 1e-11 * f.norm()) << c.name;
    }
  }
}

// Their forces differ by the size of the motion over that of the element, which is of order 1.
TEST(LargeInterface, SmallMotionsHaveTheForcesOfSmallStrain) {
  const auto law = joint();
  for (const ElementCase& c : large_cases())
    for (const double size : {1e-3, 1e-6}) {
      Joint body(c, *law);
      const auto small = c.make();
      ElementRun run(*small, sample_shape(*c.entry), law.get());
      const Eigen::VectorXd du = wave(run.u0.size(), size, 0.5);
      ASSERT_EQ(body.run.evaluate(du), Outcome::ok);
      ASSERT_EQ(run.evaluate(du), Outcome::ok);
      EXPECT_LT((body.run.f - run.f).norm(), 10.0 * size * run.f.norm()) << c.name;
    }
}

TEST(LargeInterface, BothSidesAreInEquilibrium) {
  const auto law = joint();
  for (const ElementCase& c : large_cases()) {
    if (c.axisymmetric()) continue;
    Joint body(c, *law);
    body.commit(wave(body.run.u0.size(), 0.2, 0.3));
    const Eigen::VectorXd du = wave(body.run.u0.size(), 0.1, 1.1);
    ASSERT_EQ(body.run.evaluate(du), Outcome::ok);
    Vector2 sum = Vector2::Zero();
    double moment = 0.0;
    for (Eigen::Index i = 0; i < body.run.x.cols(); ++i) {
      const Vector2 at = body.run.x.col(i) + body.run.u0.segment<2>(2 * i) + du.segment<2>(2 * i);
      const Vector2 f = body.run.f.segment<2>(2 * i);
      sum += f;
      moment += at.x() * f.y() - at.y() * f.x();
    }
    const double size = body.run.f.norm();
    EXPECT_GT(size, 1.0);
    EXPECT_LT(sum.norm(), 1e-13 * size) << c.name;
    EXPECT_NEAR(moment, 0.0, 1e-12 * size) << c.name;
  }
}

TEST(LargeInterface, StiffnessIsTheDerivativeOfTheForce) {
  const SmoothLaw<2> smooth(1e9);
  const auto elastic = joint();
  for (const InterfaceLaw* law :
       {static_cast<const InterfaceLaw*>(&smooth), static_cast<const InterfaceLaw*>(elastic.get())})
    for (const ElementCase& c : large_cases()) {
      Joint body(c, *law);
      body.commit(wave(body.run.u0.size(), 0.1, 0.3));
      EXPECT_LT(tangent_error(body.run, wave(body.run.u0.size(), 0.05, 1.1), 1e-5), 1e-7) << c.name;
    }
}

}  // namespace
}  // namespace sage::test
