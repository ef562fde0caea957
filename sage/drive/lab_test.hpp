// The tests of a laboratory as paths of one point: which components are driven, and what holds the others.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/point_driver.hpp"

namespace sage::drive {

// Compression positive, shear turned with it (docs/notation.md); strains are engineering strains, of joints
// relative displacements.
struct Goal {
  Control control = Control::strain;
  double value = 0.0;  // at the end of the leg: strain since the start, or stress; NaN: the strain stays
};

// A straight part of a path, in equal steps.
struct Leg {
  std::vector<Goal> goals;  // one a component: [xx yy zz xy], or [shear normal]
  int steps = 1;
  double duration = 1.0;  // of the leg, for laws that depend on time
};

struct LabTest {
  std::string_view name, about;
  int law_size = 4;
  // A letter a component: d = driven strain, p = driven stress, 0 = strain stays, s = stress stays,
  // h = minus half of the driven strain, m = minus all of it.  Undrained: no volume change; empty = there is none.
  std::string_view drained, undrained;
  int driven = 0;              // component
  double sense = 1.0;          // of the driven component when the test's own number is positive
  int total_stress_stays = 0;  // component whose total stress does not change while it is undrained
};

std::span<const LabTest> lab_tests();
// nullptr = there is none of that name for laws of so many components.
const LabTest* find_lab_test(std::string_view name, int law_size);
// "triaxial_compression, ..." of those for laws of so many components.
std::string known_lab_tests(int law_size);

// One leg to each of `turns`, the values of the driven quantity, in `steps` steps.  start: stresses.
std::vector<Leg> legs_of(const LabTest& test, bool undrained, std::span<const double> start,
                         std::span<const double> turns, int steps);

// Names of the components' columns: stress_yy, strain_yy; normal, relative_normal.
std::string_view stress_column(int law_size, int component);
std::string_view strain_column(int law_size, int component);
// Of what the test drives.
std::string_view driven_column(const LabTest& test);

}  // namespace sage::drive
