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
