#include "sage/drive/lab_test.hpp"

#include <array>

namespace sage::drive {

namespace {

constexpr std::array<LabTest, 9> kTests{{
    {"triaxial_compression", "strain yy grows, lateral stresses xx and zz stay", 4, "sds0", "hdh0", 1, 1.0, 0},
    {"triaxial_extension", "the same with strain yy falling", 4, "sds0", "hdh0", 1, -1.0, 0},
    {"oedometer", "strain yy grows without lateral strain", 4, "0d00", "", 1, 1.0, 0},
    {"isotropic", "all normal stresses are driven, to the same value", 4, "ppp0", "", 1, 1.0, 0},
    {"biaxial", "plane strain: strain yy grows, stress xx stays, no strain zz", 4, "sd00", "md00", 1, 1.0, 0},
    {"simple_shear", "shear strain xy grows, stress yy stays, no strain xx and zz", 4, "0s0d", "000d", 3, 1.0,
     1},
    {"direct_shear", "shear zone of a box, whose rigid halves hold its length: the path of simple_shear", 4,
     "0s0d", "000d", 3, 1.0, 1},
    {"direct_shear",
     "relative shear grows; normal stress stays, or pushes a spring, or normal displacement stays", 2, "ds",
     "d0", 0, 1.0, 1},
    {"closure", "relative normal displacement is driven, shear stress stays", 2, "sd", "", 1, 1.0, 0},
}};

constexpr std::array<std::string_view, 4> kSolidStress{"stress_xx", "stress_yy", "stress_zz", "stress_xy"};
constexpr std::array<std::string_view, 4> kSolidStrain{"strain_xx", "strain_yy", "strain_zz", "strain_xy"};
constexpr std::array<std::string_view, 2> kJointStress{"shear", "normal"};
constexpr std::array<std::string_view, 2> kJointStrain{"relative_shear", "relative_normal"};

Goal goal_of(char letter, double value, double start) {
  switch (letter) {
    case 'd':
      return {Control::strain, value};
    case 'p':
      return {Control::stress, value};
    case 's':
      return {Control::stress, start};
    case 'h':
      return {Control::strain, -0.5 * value};
    case 'm':
      return {Control::strain, -value};
    default:
      return {Control::strain, 0.0};
  }
}

}  // namespace

std::span<const LabTest> lab_tests() {
  return kTests;
}

const LabTest* find_lab_test(std::string_view name, int law_size) {
  for (const LabTest& test : kTests)
    if (test.name == name && test.law_size == law_size) return &test;
  return nullptr;
}

std::string known_lab_tests(int law_size) {
  std::string names;
  for (const LabTest& test : kTests)
    if (test.law_size == law_size) names += (names.empty() ? "" : ", ") + std::string(test.name);
  return names;
}

std::vector<Leg> legs_of(const LabTest& test, bool undrained, std::span<const double> start,
                         std::span<const double> turns, int steps) {
  const std::string_view letters = undrained ? test.undrained : test.drained;
  std::vector<Leg> legs;
  for (const double turn : turns) {
    Leg leg{{}, steps, 1.0};
    for (std::size_t i = 0; i < letters.size(); ++i)
      leg.goals.push_back(goal_of(letters[i], test.sense * turn, start[i]));
    legs.push_back(leg);
  }
  return legs;
}

std::string_view stress_column(int law_size, int component) {
  const auto at = static_cast<std::size_t>(component);
  return law_size == 4 ? kSolidStress[at] : kJointStress[at];
}

std::string_view strain_column(int law_size, int component) {
  const auto at = static_cast<std::size_t>(component);
  return law_size == 4 ? kSolidStrain[at] : kJointStrain[at];
}

std::string_view driven_column(const LabTest& test) {
  const bool stress = test.drained[test.driven] == 'p';
  return stress ? stress_column(test.law_size, test.driven) : strain_column(test.law_size, test.driven);
}

}  // namespace sage::drive
