// The soils that CANDE knows by name, as published.
#pragma once

#include <string_view>

namespace sage::translate {

// Numbers of the hyperbolic laws; cohesion in psi, angles in degrees.
struct NamedSoil {
  std::string_view name;
  double K, n, R_f, cohesion, friction_angle, friction_loss;
  // bulk: K_b and m of Duncan et al. (1980), or B_i/p_a and eps_u of Selig (1988)
  double bulk, bulk_other;
};

// `selig`: the soils of Selig's bulk modulus, code 1 on card D-2.Duncan; else those of Duncan, code 0.  The name is
// the first word of `text`.  nullptr: unknown.
const NamedSoil* named_soil(bool selig, std::string_view text);

}  // namespace sage::translate
