// Stress and strain paths from a table.
#pragma once

#include <filesystem>

#include "sage/drive/lab_test.hpp"

namespace sage::drive {

// A leg a row of a CSV file whose first line names columns: stress_xx ... stress_xy and strain_xx ... strain_xy
// (shear, normal, relative_shear, relative_normal for joints), compression positive; optional steps and duration.
// Of the two columns of a component a row fills one, or none: then its strain stays.  undrained: the one normal
// strain that has no column follows from the volume, which stays.  steps: where the file says nothing.
// Throws InputError with line and column.
std::vector<Leg> read_path(const std::filesystem::path& file, int law_size, bool undrained, int steps);

}  // namespace sage::drive
