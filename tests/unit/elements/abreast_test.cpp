// Four points side by side have what one point has alone: functions of strain, and elements under large strain.
#include "elements/abreast.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "elements/large_strain.hpp"
#include "sage/core/four_at_a_time.hpp"
#include "tests/support/elements.hpp"
#include "tests/support/laws.hpp"

namespace sage::test {
namespace {

// Beside the C library, each place with other neighbours: small, large, outside the domain.
TEST(Abreast, ExpAndLogAreThoseOfTheLibraryToRounding) {
  constexpr double kDigits = 6.0 * std::numeric_limits<double>::epsilon();
  for (double size = 1e-300; size < 40.0; size *= 1.013)
    for (const double x : {size, -size})
      for (const Four& four : {Four{x, 0.0, 0.1 * x, -x}, Four{1e-9, 30.0, x, -0.2}, Four{0.4, -0.4, 3.0, x}}) {
        const Four less = exp_less_1(four), log = log_1_plus(four);
        for (std::size_t l = 0; l < 4; ++l) {
          const double at = place(four, l), expm1 = std::expm1(at), log1p = std::log1p(at);
          EXPECT_NEAR(place(less, l), expm1, kDigits * std::abs(expm1)) << at;
          if (at > -1.0)
            EXPECT_NEAR(place(log, l), log1p, kDigits * std::abs(log1p)) << at;
          else
            EXPECT_FALSE(std::isfinite(place(log, l))) << at;
        }
      }
}

TEST(Abreast, AValueDoesNotDependOnThoseBesideIt) {
  for (const double x : {1e-12, 0.01, -0.29, 0.31, -0.5, 0.9, 2.0}) {
    const Four alone{x, x, x, x};
    for (const double other : {0.0, 0.5, -0.7, 5.0, std::numeric_limits<double>::quiet_NaN()}) {
      const Four beside{other, x, other, other};
      EXPECT_EQ(place(exp_less_1(beside), 1), place(exp_less_1(alone), 0)) << x << " beside " << other;
      EXPECT_EQ(place(log_1_plus(beside), 1), place(log_1_plus(alone), 0)) << x << " beside " << other;
    }
  }
}

// Elements of the product against the same text for one point after another.  Rounding: in sums over the points, and in
// the functions above.
template <class Shape, class Kinematics, class Rule, AssumedStrain strain = AssumedStrain::none>
void expect_the_points_alone(const Eigen::Matrix2Xd& x, const SolidLaw& law) {
  const LargeStrain<Shape, Kinematics, Rule, strain> four("four", false, false, false);
  const LargeStrain<Shape, Kinematics, Rule, strain, double> one("one", false, false, false);
  ElementRun together(four, x, &law), with_law(four, x, &law), alone(one, x, &law);
  with_law.four_law = dynamic_cast<const FourPointLaw<4>*>(&law);
  const Vector4 start(-50.0, -90.0, -60.0, 20.0);
  for (const double size : {1e-6, 0.02, 0.3}) {
    Eigen::VectorXd du(one.traits().dofs);
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      du.segment<2>(2 * i) << size * (0.3 * x(0, i) + 0.1 * x(1, i) * x(1, i)),
          size * (0.2 * x(0, i) - 0.5 * x(1, i));
    for (ElementRun* run : {&together, &with_law, &alone}) {
      for (int p = 0; p < one.traits().points; ++p) Vector4::Map(run->sigma0.data() + 4 * p) = start;
      ASSERT_EQ(run->evaluate(du), Outcome::ok);
    }
    for (const ElementRun* run : {&together, &with_law}) {
      EXPECT_LT((run->K - alone.K).norm(), 1e-13 * alone.K.norm()) << size;
      EXPECT_LT((run->f - alone.f).norm(), 1e-12 * alone.f.norm()) << size;
      for (std::size_t i = 0; i < alone.sigma1.size(); ++i) {
        EXPECT_NEAR(run->sigma1[i], alone.sigma1[i], 1e-12 * start.norm() + 1e-14 * size * alone.K.norm())
            << size;
        EXPECT_NEAR(run->eps1[i], alone.eps1[i], 1e-14 * size) << size;
      }
      for (std::size_t i = 0; i < alone.h1.size(); ++i) EXPECT_NEAR(run->h1[i], alone.h1[i], 1e-13) << size;
      EXPECT_EQ(run->status, alone.status) << size;
    }
  }
}

TEST(Abreast, ElementsUnderLargeStrainHaveWhatTheirPointsHaveAlone) {
  const auto dp = solid(3, {1000.0, 0.3, 20.0, 30.0, 10.0}), mc = solid(4, {1000.0, 0.3, 20.0, 30.0, 10.0});
  ASSERT_NE(dynamic_cast<const FourPointLaw<4>*>(dp.get()), nullptr);
  Eigen::Matrix2Xd quad8(2, 8), tri6(2, 6);
  quad8 << 1.0, 2.1, 2.0, 0.9, 1.5, 2.0, 1.5, 0.9, 0.0, 0.1, 1.2, 1.0, 0.0, 0.6, 1.2, 0.5;
  tri6 << 1.0, 2.1, 1.2, 1.5, 1.7, 1.1, 0.0, 0.2, 1.1, 0.1, 0.6, 0.5;
  for (const SolidLaw* law : {dp.get(), mc.get()}) {
    expect_the_points_alone<Quad8, Axisymmetric, GaussSquare<2>>(quad8, *law);
    expect_the_points_alone<Quad8, PlaneStrain, GaussSquare<3>>(quad8,
                                                                *law);  // nine points: three places are empty
    expect_the_points_alone<Quad4, Axisymmetric, GaussSquare<2>, AssumedStrain::mean_dilatation>(
        quad8.leftCols(4), *law);
    expect_the_points_alone<Tri6, Axisymmetric, Triangle3>(tri6, *law);
  }
}

}  // namespace
}  // namespace sage::test
