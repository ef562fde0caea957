// The field of the excess pressure of pore water.
#pragma once

#include "sage/core/unknown.hpp"

namespace sage {

inline UnknownField excess_pressure_field() {
  return {.name = "excess_pressure",
          .dimension = Dimension::stress,
          .load = "outflow",
          .load_dimension = Dimension::volume,
          .balanced = false,
          .of_pores = true};
}

}  // namespace sage
