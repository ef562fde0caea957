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
  const Limit limit = limit_of(std::vector<double>{2.1, 2.01, 2.0001, 2.000001}, Ladder::spectral);
  EXPECT_EQ(limit.value, 2.000001);
  EXPECT_NEAR(limit.error, 9.9e-5, 1e-9);
  EXPECT_FALSE(limit.rate.has_value());
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
