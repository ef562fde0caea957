// The deck states its units; the program has none of its own.  Numbers pass through unscaled.
#pragma once

#include <string>
#include <string_view>

namespace sage {

// What a quantity measures; turned into text with the deck's own unit names.
enum class Dimension {
  none,               // a pure number
  length,             // in, m
  angle,              // degrees outside, radians inside
  force,              // lbf, kN (full circle when axisymmetric, unit thickness in plane strain)
  stress,             // psi, kPa
  stress_per_length,  // psi/in: stiffness of an interface
  unit_weight,        // lbf/in^3
  velocity,           // m/time: of flow, and permeability; the time unit is that of the deck's permeability
  discharge,          // m^3/time (full circle when axisymmetric, unit thickness in plane strain)
  moment,             // lbf in, kN m
  bending_stiffness,  // lbf in^2, kN m^2
  volume,             // m^3 (full circle when axisymmetric, unit thickness in plane strain)
};

struct UnitSystem {
  std::string length = "-", force = "-", stress = "-";
  double atmospheric_pressure = 0.0;  // p_a, in the deck's stress unit; 0 = not given
  double water_unit_weight = 0.0;     // gamma_w, in force/length^3; 0 = not given
};

// "psi/in" for stress_per_length and so on; "-" for a pure number.
std::string unit_text(Dimension dimension, const UnitSystem& units);

}  // namespace sage
