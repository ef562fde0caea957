// Every refusal names the parameter, its index, its value and what was expected.
#include "materials/parameters.hpp"

#include <gtest/gtest.h>

#include "tests/support/laws.hpp"

namespace sage {
namespace {

// Message and index of the ParameterError that `make` throws.
std::pair<int, std::string> refusal(int code, const std::vector<double>& values, const UnitSystem& units) {
  try {
    test::make_law(code, values, units);
  } catch (const ParameterError& e) {
    return {e.parameter(), e.what()};
  }
  return {-99, "accepted"};
}
std::pair<int, std::string> refusal(int code, const std::vector<double>& values) {
  return refusal(code, values, test::psi_units());
}
bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Parameters, SayWhichValueWasExpected) {
  const auto [index, message] = refusal(1, {3000.0, 0.5});
  EXPECT_EQ(index, 1);
  EXPECT_TRUE(contains(message, "poissons_ratio") && contains(message, "below 0.5") &&
              contains(message, "it is 0.5"))
      << message;
}

TEST(Parameters, RefuseNotANumberAndInfinity) {
  EXPECT_EQ(refusal(1, {std::nan(""), 0.3}).first, 0);
  EXPECT_EQ(refusal(1, {3000.0, -std::numeric_limits<double>::infinity()}).first, 1);
}

TEST(Parameters, NameTheMissingOne) {
  const auto [index, message] = refusal(3, {3000.0, 0.3});
  EXPECT_EQ(index, 2);
  EXPECT_TRUE(contains(message, "cohesion is missing")) << message;
}

TEST(Parameters, RefuseMoreThanTheTableHas) {
  EXPECT_EQ(refusal(2, {1.0, 1.0, 1.0}).first, -1);
}

TEST(Parameters, CheckEveryLaw) {
  EXPECT_EQ(refusal(1, {0.0, 0.3}).first, 0);
  EXPECT_EQ(refusal(1, {1.0, -1.0}).first, 1);
  EXPECT_EQ(refusal(2, {1.0, -1.0}).first, 1);
  EXPECT_EQ(refusal(3, {1.0, 0.3, -1.0, 30.0}).first, 2);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 0.0, 90.0}).first, 3);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 0.0, 30.0, 31.0}).first, 4);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 0.0, 30.0, 0.0, 6.0}).first, 5);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 0.0, 30.0, 0.0, 1.0, 1.5}).first, 6);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 0.0, 30.0, 5.0, 1.0, 0.0, -1.0, 1.0}).first, 8);
  EXPECT_EQ(refusal(21, {1.0, 0.0}).first, 1);
  EXPECT_EQ(refusal(22, {0.0, 30.0, 0.0, 1.1, 1.0, 1.0, 1.0, 1.0, 0.0}).first, 3);
  EXPECT_EQ(refusal(22, {0.0, 30.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0}).first, 7);
}

// A value at the end of its range is accepted, one just beyond it refused by its index.
void expect_range(int code, std::vector<double> values, int index, double lowest, double highest) {
  const double beyond = 1e-4 * (highest - lowest);
  const auto with = [&](double value) {
    std::vector<double> changed = values;
    changed[index] = value;
    return refusal(code, changed);
  };
  for (const double value : {lowest, highest})
    EXPECT_EQ(with(value).second, "accepted") << code << " " << index;
  for (const double value : {lowest - beyond, highest + beyond}) EXPECT_EQ(with(value).first, index) << code;
}

TEST(Parameters, Ranges) {
  const std::vector<double> eb = {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0.49, 0.01, 0, 0, 1e-3};
  const std::vector<double> poisson = {400, 0.5, 0.8, 600, 0.4, 0.1, 3.0, 5, 33, 0, 0.49, 0.01, 0, 0, 1e-3};
  const std::vector<double> bounded = {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0, -1, 0.49, 0.01, 1e-3};
  for (const auto& [code, values, nu_max] :
       {std::tuple{5, poisson, 10}, std::tuple{6, eb, 9}, std::tuple{7, bounded, 11}}) {
    expect_range(code, values, 2, 0.0, 1.0);                                      // R_f
    expect_range(code, values, nu_max, 0.0, 0.4999);                              // largest Poisson's ratio
    expect_range(code, values, static_cast<int>(values.size()) - 1, 1e-10, 1.0);  // step_tolerance
    if (code != 5) expect_range(code, values, 5, -2.0, 2.0);                      // m
  }
  expect_range(5, poisson, 4, 0.0, 1.0);   // G
  expect_range(5, poisson, 5, -1.0, 1.0);  // F
  expect_range(22, {0.0, 30.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0, 0.0}, 3, 0.0, 1.0);
}

// A stress floor, tension cut-offs and their -1 for none, and what excludes each other.
TEST(Parameters, FloorAndTension) {
  EXPECT_EQ(refusal(6, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0.49, 0.0}).first, 10);
  EXPECT_EQ(refusal(7, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0, -1, 0.49, 0.0}).first, 12);
  EXPECT_EQ(refusal(7, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0, -2}).first, 10);
  EXPECT_EQ(refusal(7, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0, 1}).second, "accepted");
  EXPECT_EQ(refusal(4, {1.0, 0.3, 1.0, 30.0, 0.0, -2.0}).first, 5);
  EXPECT_EQ(refusal(4, {1.0, 0.3, 1.0, 30.0, 0.0, 1.0}).second, "accepted");
  EXPECT_EQ(refusal(3, {1.0, 0.3, 1.0, 30.0, 0.0, 1.0, 0.0, -2.0}).first, 7);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 1.0, 30.0, 0.0, 1.0, 0.0, 1.0, 1.0}).first, 8);
  EXPECT_EQ(refusal(3, {1.0, 0.3, 1.0, 30.0, 0.0, 1.0, 0.0, -1.0, 1.0}).second, "accepted");
  EXPECT_EQ(refusal(22, {0.0, 30.0, 0.5, 0.5, 1.0, 1.0, 1.0, 0.0, 0.0}).first, 7);
  EXPECT_EQ(refusal(22, {0.0, 30.0, 0.0, 0.5, 1.0, 1.0, 1.0, 0.0, 0.0}).second, "accepted");
  EXPECT_EQ(refusal(22, {0.0, 30.0, 0.5, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0}).second, "accepted");
}

// phi_0 + 2 dphi is the angle at the default floor of p_a/100.  And 2 sigma_3 sin phi/(1 - sin phi) must still
// grow at 1000 p_a, where its slope vanishes for the largest dphi: found here by differences and halving.
TEST(Parameters, LossOfFrictionIsLimited) {
  const auto refused = [](double phi0, double dphi) {
    return refusal(6, {400, 0.5, 0.8, 600, 250, 0.3, 0, phi0, dphi});
  };
  const auto slope = [](double phi0, double dphi) {
    const auto strength = [&](double decades) {
      const double s = std::sin((phi0 - dphi * decades) * kRadiansPerDegree);
      return std::pow(10.0, decades) * s / (1 - s);
    };
    return strength(3.0 + 1e-6) - strength(3.0 - 1e-6);
  };
  double least = 0.0, most = 12.0;  // phi_0 = 38
  for (int i = 0; i < 60; ++i) (slope(38.0, 0.5 * (least + most)) > 0.0 ? least : most) = 0.5 * (least + most);
  EXPECT_EQ(refused(38.0, 0.9999 * least).second, "accepted");
  EXPECT_EQ(refused(38.0, 1.0001 * least).first, 8);
  EXPECT_TRUE(contains(refused(38.0, 1.0001 * least).second, "grows with sigma_3"));

  EXPECT_TRUE(contains(refused(45.0, 22.3).second, "below 89.5 degrees"));
  EXPECT_FALSE(contains(refused(45.0, 22.2).second, "below 89.5 degrees"));
}

// Only a law that uses p_a or gamma_w asks for them.
TEST(Parameters, AskForUnitsOnlyWhereNeeded) {
  const UnitSystem none{"in", "lbf", "psi", 0.0, 0.0};
  const auto [index, message] = refusal(22, {0.0, 28.5, 0.0, 0.0, 5000.0, 0.9, 1e9, 1e9, 0.0}, none);
  EXPECT_EQ(index, -1);
  EXPECT_TRUE(contains(message, "gamma_w") && contains(message, "lbf/in^3")) << message;
  const UnitSystem no_air{"in", "lbf", "psi", 0.0, 0.0361};
  EXPECT_TRUE(contains(refusal(22, {0.0, 28.5, 0.0, 0.0, 5000.0, 0.9, 1e9, 1e9, 0.0}, no_air).second, "p_a"));
  EXPECT_EQ(refusal(22, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e9, 1e9, 0.0}, none).second, "accepted");
}

}  // namespace
}  // namespace sage
