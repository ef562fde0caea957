// The table of fields: closed forms of principal stresses, p and q; names; rows of one's own.
#include "sage/core/field.hpp"

#include <cmath>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace sage {
namespace {

std::vector<double> of_stress(const char* name, const Vector4& stress) {
  const FieldEntry* row = FieldTable().find(name);
  std::vector<double> value(row->size());
  std::get<StressField>(row->value).of(stress, value.data());
  return value;
}

// Three stresses turned by an angle in the plane: a along it, b across it, c out of the plane.
Vector4 turned(double a, double b, double c, double degrees) {
  const double t = degrees * kRadiansPerDegree, m = 0.5 * (a + b), r = 0.5 * (a - b);
  return {m + r * std::cos(2 * t), m - r * std::cos(2 * t), c, r * std::sin(2 * t)};
}

TEST(FieldTable, PrincipalStressesOfAKnownTensor) {
  struct Case {
    double a, b, c;
  };
  for (const auto& [a, b, c] : {Case{90, 20, 50}, Case{90, 20, 120}, Case{90, 20, -5}, Case{-10, -40, -20}})
    for (double degrees : {-70.0, -30.0, 0.0, 12.5, 45.0, 80.0}) {
      const Vector4 s = turned(a, b, c, degrees);
      std::vector<double> sorted{a, b, c};
      std::sort(sorted.begin(), sorted.end(), std::greater<>());
      const std::vector<double> found = of_stress("principal_stress", s);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], sorted[i], 1e-12) << degrees;
      EXPECT_NEAR(of_stress("stress_difference", s)[0], sorted[0] - sorted[2], 1e-12);
      EXPECT_NEAR(of_stress("principal_angle", s)[0], degrees, 1e-12);
      EXPECT_NEAR(of_stress("mean_stress", s)[0], (a + b + c) / 3, 1e-12);
      EXPECT_NEAR(of_stress("deviator", s)[0],
                  std::sqrt(0.5 * ((a - b) * (a - b) + (b - c) * (b - c) + (c - a) * (c - a))), 1e-12);
    }
}

// sigma n = sigma_i n for both directions, unit length, at right angles.
TEST(FieldTable, PrincipalDirectionsAreThoseOfTheirStresses) {
  for (double c : {50.0, 120.0, -5.0})
    for (double degrees : {-70.0, -30.0, 0.0, 12.5, 45.0, 80.0}) {
      const Vector4 s = turned(90, 20, c, degrees);
      const std::vector<double> stress = of_stress("principal_stress", s),
                                n1 = of_stress("principal_direction_1", s),
                                n3 = of_stress("principal_direction_3", s);
      const auto expect_direction = [&](const std::vector<double>& n, double sigma) {
        EXPECT_NEAR(s[0] * n[0] + s[3] * n[1], sigma * n[0], 1e-11);
        EXPECT_NEAR(s[3] * n[0] + s[1] * n[1], sigma * n[1], 1e-11);
        EXPECT_NEAR(s[2] * n[2], sigma * n[2], 1e-11);
        EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0, 1e-14);
      };
      expect_direction(n1, stress[0]);
      expect_direction(n3, stress[2]);
      EXPECT_NEAR(n1[0] * n3[0] + n1[1] * n3[1] + n1[2] * n3[2], 0.0, 1e-14);
    }
}

// Zero shear comes out of a run as rounding of either sign; equal stresses have no direction of their own.
TEST(FieldTable, RoundingTurnsNoDirection) {
  for (const double rounding : {0.0, 1e-14, -1e-14}) {
    const Vector4 upright(100.0, 200.0, 100.0, rounding), lying(200.0, 100.0, 100.0, rounding),
        equal(100.0 + rounding, 100.0, 100.0, rounding);
    EXPECT_EQ(of_stress("principal_angle", upright)[0], 90.0);
    EXPECT_EQ(of_stress("principal_angle", lying)[0], 0.0);
    EXPECT_EQ(of_stress("principal_angle", equal)[0], 0.0);
    EXPECT_EQ(of_stress("principal_direction_1", upright)[1], 1.0);
    if (rounding == 0.0) {
      EXPECT_EQ(of_stress("principal_direction_3", lying)[1], 1.0);
    }
  }
}

// Triaxial test: cell pressure 50, deviator 100: p = 50 + 100 / 3, q = 100.
TEST(FieldTable, TriaxialStateHasItsPAndQ) {
  const Vector4 s(50, 150, 50, 0);
  EXPECT_NEAR(of_stress("mean_stress", s)[0], 50 + 100.0 / 3, 1e-12);
  EXPECT_NEAR(of_stress("deviator", s)[0], 100, 1e-12);
  EXPECT_NEAR(of_stress("stress_difference", s)[0], 100, 1e-12);
}

TEST(FieldTable, EveryRowHasANameOfItsOwnAndAMeaning) {
  std::set<std::string> names, arrays;
  for (const FieldEntry& row : FieldTable().rows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_FALSE(row.meaning.empty()) << row.name;
    EXPECT_TRUE(row.columns.empty() || row.columns.size() == row.size()) << row.name;
    EXPECT_TRUE(row.arrays.size() <= 1 || row.arrays.size() == row.size()) << row.name;
    EXPECT_EQ(row.words.empty(), row.form != FieldForm::word) << row.name;
    if (row.place() != FieldPlace::increment) {
      EXPECT_TRUE(arrays.insert(row.arrays.empty() ? row.name : row.arrays[0]).second) << row.name;
    }
  }
}

TEST(FieldTable, ChoosesComponentsLengthsAndNumbers) {
  const FieldTable table;
  EXPECT_EQ(table.choose("stress_yy")->component, 1);
  EXPECT_EQ(table.choose("mean_stress")->component, 0);
  EXPECT_TRUE(table.choose("displacement")->length());
  EXPECT_FALSE(table.choose("displacement_y")->length());
  for (const char* name : {"stress", "status", "nonsense", "", "stress_", "stress_ww", "_xx"})
    EXPECT_FALSE(table.choose(name).has_value()) << name;
}

TEST(FieldTable, CopiesShareRowsUntilOneAdds) {
  FieldTable one;
  const std::size_t before = one.rows().size();
  one.add({.name = "ratio",
           .meaning = "sigma_yy / sigma_xx",
           .value = StressField{[](const Vector4& s, double* v) { *v = s[1] / s[0]; }}});
  FieldTable two = one;
  EXPECT_EQ(two.rows().data(), one.rows().data());
  two.add(
      {.name = "other", .meaning = "other", .value = StressField{[](const Vector4&, double* v) { *v = 0; }}});
  EXPECT_EQ(one.rows().size(), before + 1);
  EXPECT_EQ(two.rows().size(), before + 2);
  EXPECT_EQ(FieldTable().rows().size(), before);
  EXPECT_THROW(two.add(*one.find("ratio")), std::logic_error);
  EXPECT_THROW(two.add(*one.find("stress")), std::logic_error);
  EXPECT_THROW(two.add(FieldEntry{}), std::logic_error);
}

// Two columns of one name in a file: of another field, of what says where a row is, of the field itself.
TEST(FieldTable, RefusesColumnsThatAreThere) {
  const auto number = [](const char* name, FieldSource value, std::vector<FieldComponent> components = {}) {
    return FieldEntry{
        .name = name, .meaning = name, .value = std::move(value), .components = std::move(components)};
  };
  const NodeField node{[](const NodeView&, double* v) { *v = 0.0; }};
  const PointField point{[](const PointView&, double* v) { *v = 0.0; }};
  const IncrementField increment{[](const IncrementView&, double* v) { *v = 0.0; }};
  const auto refusal = [](FieldEntry entry) {
    try {
      FieldTable().add(std::move(entry));
    } catch (const std::logic_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const auto& [entry, words] :
       {std::pair{number("stress_xx", point), "column stress_xx is one of the field stress"},
        std::pair{number("stress_xx", node),
                  "column stress_xx is one of the field stress"},  // reports have both
        std::pair{number("place", point), "place is one that says where"},
        std::pair{number("x", node), "x is one that says where"},
        std::pair{number("material", point), "field material is taken"},
        std::pair{number("increment", increment), "increment is one that says where"},
        std::pair{number("own", point, {{"a"}, {"a"}}), "column own_a is there twice"}}) {
    const std::string said = refusal(entry);
    EXPECT_NE(said.find(entry.name), std::string::npos) << said;
    EXPECT_NE(said.find(words), std::string::npos) << entry.name << ": " << said;
  }
  EXPECT_EQ(refusal(number("stress_xx", increment)), "") << "no file has columns of both";
  EXPECT_EQ(refusal(number("own", point, {{"a"}, {"b"}})), "");
}

}  // namespace
}  // namespace sage
