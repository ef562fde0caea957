// A field of one's own: the stress out of the plane as a part of the vertical one.  This is the example of
// docs/manual/own_field.md.
#pragma once

#include <limits>

#include "sage/core/field.hpp"

namespace own {

inline sage::FieldEntry stress_ratio() {
  return {.name = "stress_ratio",
          .meaning = "sigma_zz / sigma_yy",
          .value = sage::StressField{[](const sage::Vector4& stress, double* value) {
            *value = stress[1] != 0.0 ? stress[2] / stress[1] : std::numeric_limits<double>::quiet_NaN();
          }},
          .optional = true};
}

}  // namespace own
