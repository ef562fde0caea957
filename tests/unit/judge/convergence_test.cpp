// What rows of values say about their limit, from sequences whose limit is known.
#include "sage/judge/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sage::judge {
namespace {

// 2 + c h^q + c2 h^(q + 1), h = 1, 1/2 ...
std::vector<double> halved(double q, double c, double c2, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) {
    const double h = std::pow(0.5, i);
    values.push_back(2.0 + c * std::pow(h, q) + c2 * std::pow(h, q + 1));
  }
  return values;
}

TEST(Limit, OneValueSaysNothing) {
  EXPECT_TRUE(std::isinf(limit_of(std::vector<double>{1.0}, Ladder::halving).error));
  EXPECT_TRUE(std::isinf(limit_of(std::vector<double>{1.0}, Ladder::spectral).error));
}

TEST(Limit, HalvingBoundsTheErrorAndFindsTheRate) {
  for (const double q : {0.6, 1.2, 2.0, 4.0})
    for (const double c : {1.0, -0.3})
      for (int n = 3; n < 8; ++n) {
        const Limit limit = limit_of(halved(q, c, 0.1, n), Ladder::halving);
        EXPECT_LE(std::abs(limit.value - 2.0), 1.01 * limit.error) << "q " << q << " c " << c << " n " << n;
        if (n < 7) continue;
        ASSERT_TRUE(limit.rate.has_value());
        EXPECT_NEAR(*limit.rate, q, 0.1);
      }
}

TEST(Limit, ExtrapolationIsBetterThanTheLastValue) {
  const std::vector<double> values = halved(1.2, 1.0, 0.1, 6);
  const Limit limit = limit_of(values, Ladder::halving);
  EXPECT_LT(std::abs(limit.value - 2.0), 0.1 * std::abs(values.back() - 2.0));
}

TEST(Limit, SpectralErrorIsTheLastDifference) {
  const Limit limit = limit_of(std::vector<double>{2.1, 2.001, 2.00001, 2.0000001}, Ladder::spectral);
  EXPECT_EQ(limit.value, 2.0000001);
  EXPECT_NEAR(limit.error, 9.9e-6, 1e-9);
  EXPECT_FALSE(limit.rate.has_value());
}

// Differences of 5.6e-2, 3.1e-3 and then 3.6e-6, after which the values moved by 3e-5 again: Cook's membrane.
TEST(Limit, SpectralErrorDoesNotTrustASuddenAgreement) {
  const std::vector<double> values{16.76228525, 16.81828229, 16.82134414, 16.82134773};
  EXPECT_GT(limit_of(values, Ladder::spectral).error, std::abs(16.82138677 - values.back()));
  EXPECT_NEAR(limit_of(values, Ladder::spectral).error, 1.67e-4, 1e-6) << "3.06e-3 squared by 5.60e-2";
}

// Graded meshes of high degree agreed to 3e-14 where 2.5e-11 was true: no smaller error than 1e-10 is stated.
TEST(Limit, NoErrorIsStatedBelowTheFloor) {
  EXPECT_EQ(kLeastError, 1e-10);
  for (const Ladder ladder : {Ladder::spectral, Ladder::halving})
    for (const double scale : {1.0, -3e5})
      for (const std::vector<double>& shape : {std::vector<double>{1.0, 1.0, 1.0},
                                               {1.001, 1.0 + 3e-14, 1.0},
                                               {1.0 + 2.5e-11, 1.0, 1.0 + 3e-14},
                                               {1.1, 1.0 + 1e-6, 1.0 + 1e-11, 1.0},
                                               {1.0 + 8e-15, 1.0 + 4e-15, 1.0 + 2e-15, 1.0 + 1e-15}}) {
        std::vector<double> values = shape;
        for (double& v : values) v *= scale;
        const Limit limit = limit_of(values, ladder);
        EXPECT_GE(limit.error, 1e-10 * std::abs(values.back()));
        EXPECT_TRUE(std::isfinite(limit.error)) << "rounding that grows is rounding";
      }
}

// Three values: a difference of 1e-3 does not fall to nothing at once.  Halved meshes: nor by more than 32
// times.
TEST(Limit, ASuddenAgreementCanBeChance) {
  EXPECT_NEAR(limit_of(std::vector<double>{1.0, 1.001, 1.001}, Ladder::spectral).error, 1e-6, 1e-12);
  EXPECT_NEAR(limit_of(std::vector<double>{1.0, 1.001, 1.001}, Ladder::halving).error, 1e-3 / 32.0, 1e-12);
}

// What was said after three meshes, given the fourth and fifth.
TEST(Limit, LaterMeshesWidenAnEarlierError) {
  const std::vector<double> spoiled{1.0, 1.01, 1.0101, 1.0101005, 1.0111};
  EXPECT_EQ(limit_after(spoiled, 5, Ladder::spectral).error, limit_of(spoiled, Ladder::spectral).error);
  EXPECT_TRUE(std::isinf(limit_after(spoiled, 5, Ladder::spectral).error)) << "the differences grow";
  const Limit best = limit_after(spoiled, 4, Ladder::spectral);
  EXPECT_EQ(best.value, 1.0101005) << "an earlier mesh says more than the last";
  EXPECT_NEAR(best.error, 1.0111 - 1.0101005, 1e-12) << "and holds what the last one found";
  // Values on their way to an extrapolated limit are no contradiction.
  const std::vector<double> falling = halved(1.2, 1.0, 0.1, 7);
  const Limit after = limit_after(falling, 6, Ladder::halving),
              then = limit_of({falling.data(), 6}, Ladder::halving);
  ASSERT_TRUE(then.rate.has_value());
  EXPECT_EQ(after.error, then.error);
}

TEST(Limit, GrowingDifferencesAreNoLimit) {
  EXPECT_TRUE(std::isinf(limit_of(std::vector<double>{1.0, 1.1, 1.3, 1.7}, Ladder::halving).error));
  EXPECT_TRUE(std::isinf(limit_of(std::vector<double>{1.0, 1.1, 0.9}, Ladder::spectral).error));
}

TEST(Limit, AlternatingValuesAreNotExtrapolated) {
  const Limit limit = limit_of(std::vector<double>{2.2, 1.9, 2.05, 1.975}, Ladder::halving);
  EXPECT_EQ(limit.value, 1.975);
  EXPECT_FALSE(limit.rate.has_value());
  EXPECT_GE(limit.error, 0.025) << "the limit is 2";
}

}  // namespace
}  // namespace sage::judge
