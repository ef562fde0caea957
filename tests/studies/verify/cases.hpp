// The families of cases, each in its own file; book() in book.cpp lists them.
#pragma once

#include "tests/studies/verify/record.hpp"

namespace sage::verify {

inline constexpr double kDegree = kRadiansPerDegree;

Section patch_cases();
Section interface_patch_cases();
Section lame_cases();
Section manufactured_cases();
Section box_cases();
Section restrained_cylinder_cases();
Section interface_cases();
Section cavity_cases();
Section bearing_cases();
Section slope_cases();
Section ground_cases();
Section law_cases();
Section clay_cases();
Section structure_cases();
Section soil_structure_cases();
Section seepage_cases();
Section water_cases();
Section consolidation_cases();

}  // namespace sage::verify
