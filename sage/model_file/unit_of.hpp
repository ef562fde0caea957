// Units that a number may bear: "50 MPa", "18 kN/m^3".
#pragma once

#include <optional>
#include <string_view>

namespace sage::model_file {

// A unit as powers of metre, newton, second and radian, and its size in them.
struct Unit {
  double size = 1.0;
  int length = 0, force = 0, time = 0, angle = 0;

  bool same_kind(const Unit& other) const {
    return length == other.length && force == other.force && time == other.time && angle == other.angle;
  }
};

// Products, one quotient and whole powers of m mm cm km in ft, N kN MN kgf tf lbf kip, Pa kPa MPa GPa bar psi ksf psf ksi,
// s min h d day year, deg rad: "kN/m^3", "kN m^2/m".  Nothing for any other text.
std::optional<Unit> unit_of(std::string_view text);

}  // namespace sage::model_file
