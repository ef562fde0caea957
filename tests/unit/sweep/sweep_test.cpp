// Random draws, probabilities and quantities of sweeps.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "sage/sweep/draws.hpp"
#include "sage/sweep/journal.hpp"
#include "sage/sweep/probability.hpp"
#include "sage/sweep/random_fields.hpp"
#include "sage/sweep/study.hpp"

namespace sage::sweep {
namespace {

TEST(SweepDraws, NormalQuantileInvertsTheShare) {
  // Tables of the normal distribution: 97.5 % lie below 1.959963984540054, 2.275013194817921e-2 below -2.
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(2.275013194817921e-2), -2.0, 1e-12);
  EXPECT_NEAR(normal_quantile(normal_share(-7.0)), -7.0, 1e-9);
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-15);
}

struct Sample {
  double mean = 0.0, deviation = 0.0;
};

Sample sample_of(const Eigen::VectorXd& values) {
  const double mean = values.mean();
  return {mean, std::sqrt((values.array() - mean).square().sum() / static_cast<double>(values.size() - 1))};
}

double correlation_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return x.dot(y) / std::sqrt(x.squaredNorm() * y.squaredNorm());
}

// Of 2000 draws: mean within 3 sd/sqrt(n), deviation within 3 of its standard errors, which follows from the fourth
// moment (normal: sd/sqrt(2n); lognormal with V = .3: kurtosis 4.64, sd * sqrt(3.64/(4n)); uniform: kurtosis 1.8).
TEST(SweepDraws, HaveTheirMomentsAndCorrelations) {
  constexpr int kDraws = 2000;
  const double n = kDraws;
  const std::vector<Distribution> variables{{.shape = Shape::normal, .mean = 30.0, .deviation = 3.0},
                                            {.shape = Shape::lognormal, .mean = 10.0, .deviation = 3.0},
                                            {.shape = Shape::uniform, .low = 1.0, .high = 4.0}};
  Eigen::MatrixXd wanted(3, 3);
  wanted << 1.0, -0.5, 0.3, -0.5, 1.0, 0.2, 0.3, 0.2, 1.0;
  const Eigen::MatrixXd values = draw(variables, wanted, kDraws, 7);
  const double means[] = {30.0, 10.0, 2.5}, deviations[] = {3.0, 3.0, 3.0 / std::sqrt(12.0)},
               kurtosis[] = {3.0, 4.64, 1.8};
  for (int i = 0; i < 3; ++i) {
    const Sample s = sample_of(values.col(i));
    EXPECT_NEAR(s.mean, means[i], 3.0 * deviations[i] / std::sqrt(n)) << i;
    EXPECT_NEAR(s.deviation, deviations[i], 3.0 * deviations[i] * std::sqrt((kurtosis[i] - 1.0) / (4.0 * n)))
        << i;
    for (int j = 0; j < i; ++j)
      EXPECT_NEAR(correlation_of(values.col(i), values.col(j)), wanted(i, j),
                  3.0 * (1.0 - wanted(i, j) * wanted(i, j)) / std::sqrt(n))
          << i << ' ' << j;
  }
  EXPECT_GT(values.col(1).minCoeff(), 0.0);
  EXPECT_GE(values.col(2).minCoeff(), 1.0);
  EXPECT_LE(values.col(2).maxCoeff(), 4.0);
}

// Of 2000 draws of two fields, at places apart by the distance r in correlation lengths: means, variances and correlations
// within 3 standard errors (of normal variables) of 0, 1 and exp(-r).
TEST(SweepFields, HaveTheirMomentsAndCorrelations) {
  constexpr int kDraws = 2000;
  const double n = kDraws, rho = -0.5;
  const FieldVariable c{{.shape = Shape::normal, .mean = 20.0, .deviation = 4.0}, {10.0, 2.0}},
      phi{{.shape = Shape::normal, .mean = 30.0, .deviation = 3.0}, {10.0, 2.0}};
  Eigen::MatrixXd both(2, 2);
  both << 1.0, rho, rho, 1.0;
  const RandomFields fields({c, phi}, both, 11);
  const Vector2 places[] = {{3.0, -7.0}, {8.0, -7.0}, {3.0, -6.0}, {23.0, -3.0}};
  Eigen::MatrixXd values(kDraws, 5);
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto field = fields.field(0, draw + 1);
    for (int i = 0; i < 4; ++i) values(draw, i) = (field(places[i]) - 20.0) / 4.0;
    values(draw, 4) = (fields.field(1, draw + 1)(places[0]) - 30.0) / 3.0;
  }
  const double wanted[] = {1.0, std::exp(-0.5), std::exp(-0.5), std::exp(-std::sqrt(8.0)), rho};
  for (int i = 0; i < 5; ++i) {
    const Sample s = sample_of(values.col(i));
    EXPECT_NEAR(s.mean, 0.0, 3.0 / std::sqrt(n)) << i;
    EXPECT_NEAR(s.deviation, 1.0, 3.0 / std::sqrt(2.0 * n)) << i;
    if (i == 0) continue;
    EXPECT_NEAR(correlation_of(values.col(0), values.col(i)), wanted[i],
                3.0 * (1.0 - wanted[i] * wanted[i]) / std::sqrt(n))
        << i;
  }
}

// The same draw has the same values, another has others; correlated fields share their lengths.
TEST(SweepFields, AreThoseOfTheirDraw) {
  const FieldVariable one{{.shape = Shape::lognormal, .mean = 20.0, .deviation = 4.0}, {10.0, 2.0}};
  FieldVariable other = one;
  const Eigen::MatrixXd apart = Eigen::MatrixXd::Identity(2, 2);
  const RandomFields fields({one, other}, apart, 3), again({one, other}, apart, 3);
  const Vector2 place(1.0, 2.0);
  EXPECT_EQ(fields.field(1, 5)(place), again.field(1, 5)(place));
  EXPECT_NE(fields.field(1, 5)(place), fields.field(1, 6)(place));
  EXPECT_NE(fields.field(1, 5)(place), fields.field(0, 5)(place));
  other.correlation_length.x() = 5.0;
  Eigen::MatrixXd together = apart;
  together(0, 1) = together(1, 0) = 0.3;
  EXPECT_NO_THROW((RandomFields({one, other}, apart, 3)));
  EXPECT_THROW((RandomFields({one, other}, together, 3)), std::invalid_argument);
}

TEST(SweepDraws, AreTheSameForMoreDraws) {
  const std::vector<Distribution> one{{.shape = Shape::normal, .mean = 1.0, .deviation = 1.0}};
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(1, 1);
  EXPECT_EQ(draw(one, identity, 10, 3), draw(one, identity, 20, 3).topRows(10));
  EXPECT_NE(draw(one, identity, 10, 3), draw(one, identity, 10, 4));
}

// A normal distribution cut off at its mean is half-normal: its mean is sqrt(2/pi) deviations away.
TEST(SweepDraws, AreCutOffInProportion) {
  const std::vector<Distribution> one{{.shape = Shape::normal, .mean = 5.0, .deviation = 2.0, .low = 5.0}};
  const Eigen::MatrixXd values = draw(one, Eigen::MatrixXd::Identity(1, 1), 4000, 1);
  EXPECT_GE(values.minCoeff(), 5.0);
  EXPECT_NEAR(values.mean(), 5.0 + 2.0 * std::sqrt(2.0 / 3.14159265358979),
              3.0 * 2.0 * 0.603 / std::sqrt(4000.0));
}

TEST(SweepDraws, WantCorrelationsThatExist) {
  const std::vector<Distribution> three(3, {.shape = Shape::normal, .mean = 0.0, .deviation = 1.0});
  Eigen::MatrixXd impossible(3, 3);
  impossible << 1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0;
  EXPECT_THROW(draw(three, impossible, 1, 1), std::invalid_argument);
}

// Clopper and Pearson: 0 of n has the upper end 1 - (a/2)^(1/n); 5 of 10 with 95 %: 0.1871 to 0.8129 (their table).
TEST(SweepProbability, IsThatOfClopperAndPearson) {
  const Probability none = probability_of(0, 100, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1.0 - std::pow(0.025, 0.01), 1e-9);
  const Probability half = probability_of(5, 10, 0.95);
  EXPECT_NEAR(half.low, 0.1871, 5e-5);
  EXPECT_NEAR(half.high, 0.8129, 5e-5);
  EXPECT_EQ(half.value, 0.5);
  EXPECT_EQ(probability_of(10, 10, 0.95).high, 1.0);
  EXPECT_TRUE(std::isnan(probability_of(0, 0, 0.95).value));
  // 1000 of 10 000: the normal approximation 0.1 +- 1.96 * 0.003 is right to 1e-4 here.
  const Probability many = probability_of(1000, 10'000, 0.95);
  EXPECT_NEAR(many.low, 0.1 - 1.96 * 0.003, 2e-4);
  EXPECT_NEAR(many.high, 0.1 + 1.96 * 0.003, 2e-4);
}

class SweepJournal : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / "sweep_journal";
    std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_;
};

TEST_F(SweepJournal, KeepsEveryBitAndForgetsWhatAKillCutOff) {
  {
    Journal journal(folder_, "study", 0);
    journal.add(1, {"ok", {0.1 + 0.2, std::nan("")}, "S301", {}});
    journal.add(2, {"failed", {}, {}, "a reason [S510]"});
  }
  {
    std::ofstream torn(folder_ / "study.cases.0", std::ios::app);
    torn << "0000000000000003\tok\t\t3ff00000";  // the process died here
  }
  Journal journal(folder_, "study", 0);
  journal.add(4, {"ok", {4.0}, {}, {}});
  Journal again(folder_, "study", 9);
  EXPECT_EQ(again.size(), 3U);
  ASSERT_NE(again.find(1), nullptr);
  EXPECT_EQ(again.find(1)->values[0], 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(again.find(1)->values[1]));
  EXPECT_EQ(again.find(2)->reason, "a reason [S510]");
  EXPECT_EQ(again.find(3), nullptr);
  EXPECT_NE(again.find(4), nullptr);
}

TEST_F(SweepJournal, IsForOneProcessAtATime) {
  const Journal journal(folder_, "study", 0);
  EXPECT_THROW(Journal(folder_, "study", 0), InputError);
}

}  // namespace
}  // namespace sage::sweep
