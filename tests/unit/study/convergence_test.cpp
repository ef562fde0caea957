// What rows of values say about their limit, from sequences whose limit is known.
#include "sage/study/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sage::study {
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
}  // namespace sage::study
