// One row or more for every law of the catalogue: the parameters that the conformance suite runs it with.
#pragma once

#include <vector>

#include "sage/conformance/law_sample.hpp"

namespace sage::test {

inline std::vector<conformance::LawSample> samples() {
  const double none = -1.0;  // no tension limit
  // Without shear stiffness there is nothing to slip, and 89 degrees of friction need more than these increments.
  return {
      {"elastic", 1, {1e4, 0.3}, 0.01, false},
      {"elastic_incompressible", 1, {1e4, 0.4999999}, 0.01, false},
      {"elastic_kg", 2, {1e4, 4e3}, 0.01, false},
      {"dp_chapter", 3, {2e4, 0.495, 0, 36.87, 0, 1, 1}, 0.01, true},
      {"dp_associated", 3, {2e4, 0.3, 10, 30, 30}, 0.01, true},
      {"dp_dilating", 3, {2e4, 0.3, 5, 35, 10, 3}, 0.01, true},
      {"dp_von_mises", 3, {2e4, 0.3, 50, 0}, 0.01, true},
      {"dp_exact", 3, {2e4, 0.3, 5, 30, 0, 4, 1, none, 0, 1}, 0.01, true},
      {"dp_free_mean", 3, {2e4, 0.3, 2, 36.87, 0, 1, 1, none, 1}, 0.01, true},
      {"dp_tension_limit", 3, {2e4, 0.3, 30, 20, 5, 1, 0, 5}, 0.01, true},
      {"dp_strengthless", 3, {2e4, 0.3, 0, 0}, 0.01, true},
      {"dp_89", 3, {2e4, 0.3, 1, 89, 0}, 0.01, true},
      {"mc", 4, {2e4, 0.3, 5, 30, 0}, 0.01, true},
      {"mc_associated", 4, {2e4, 0.3, 5, 30, 30}, 0.01, true},
      {"mc_cohesionless", 4, {2e4, 0.3, 0, 35, 10}, 0.01, true},
      {"mc_tresca", 4, {2e4, 0.49, 40, 0}, 0.01, true},
      {"mc_cut_off", 4, {2e4, 0.3, 20, 30, 10, 3}, 0.01, true},
      {"mc_no_tension", 4, {2e4, 0.3, 20, 30, 0, 0}, 0.01, true},
      {"mc_strengthless", 4, {2e4, 0.3, 0, 0}, 0.01, true},
      {"mc_89", 4, {2e4, 0.3, 1, 89, 0}, 0.01, true},
      {"dc_1970", 5, {400, 0.5, 0.8, 600, 0.4, 0.1, 3.0, 5, 33, 2}, 0.002, false},
      {"dc_eb", 6, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 2}, 0.002, false},
      {"dc_eb_rf1", 6, {400, 0.5, 1.0, 600, 250, 0.3, 0, 33}, 0.002, false},
      {"dc_eb_in_plane", 6, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0.49, 0.01, 0, 1}, 0.002, false},
      {"dc_strengthless", 6, {400, 0.5, 0.8, 600, 250, 0.3, 0, 0}, 0.002, false},
      {"hyperbolic_mc", 7, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33}, 0.004, true},
      {"hyperbolic_mc_curved", 7, {400, 0.5, 0.8, 600, 250, 0.3, 0, 38, 6}, 0.004, true},
      {"hyperbolic_mc_dilating", 7, {400, 0.5, 0.7, 600, 250, 0.3, 5, 33, 0, 8}, 0.004, true},
      {"hyperbolic_mc_cut_off", 7, {400, 0.5, 0.7, 600, 250, 0.3, 20, 33, 0, 0, 2}, 0.004, true},
      {"hyperbolic_mc_coarse",
       7,
       {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 0, none, 0.49, 0.01, 1.0},
       0.004,
       true},
      {"mc_softening", 8, {2e4, 0.3, 10, 35, 10, 0.005, 5, 30, 0}, 0.01, true},
      {"mc_hardening", 8, {2e4, 0.3, 0, 20, 0, 0.02, 5, 35, 10}, 0.01, true},
      {"mc_hardening_softening", 8, {2e4, 0.3, 2, 25, 0, 0.01, 10, 38, 12, 0.06, 0, 30, 0}, 0.01, true},
      {"mc_softening_exponential", 8, {2e4, 0.3, 10, 35, 10, 1e-4, 10, 35, 10, 0.03, 1, 28, 0, 1}, 0.01, true},
      {"mc_softening_tresca", 8, {2e4, 0.49, 40, 0, 0, 0.02, 20, 0, 0}, 0.01, true},
      {"mc_softening_cut_off", 8, {2e4, 0.3, 20, 30, 10, 0.02, 10, 28, 0, -1, -1, -1, -1, 0, 3}, 0.01, true},
      {"hoek_brown", 9, {2e4, 0.3, 200, 5, 0.1}, 0.01, true},
      {"hoek_brown_associated", 9, {2e4, 0.3, 200, 5, 0.1, 0.5, 1}, 0.01, true},
      {"hoek_brown_poor_rock", 9, {2e4, 0.3, 300, 2, 0, 0.6, 0.3}, 0.01, true},
      {"hoek_brown_cut_off", 9, {2e4, 0.3, 200, 2, 0.2, 0.5, 0.5, 5}, 0.01, true},
      {"hoek_brown_straight", 9, {2e4, 0.3, 100, 2, 0.2, 1, 0.2}, 0.01, true},
      {"darcy", 41, {1e-3}, 0.01, false},
      {"darcy_turned", 41, {1e-3, 1e-5, 30}, 0.01, false},
      {"goodman", 21, {2e4, 1e6}, 1e-3, false},
      {"goodman_bonded", 21, {2e4, 1e6, 1}, 1e-3, false},
      {"joint_dilating", 23, {2e4, 1e6, 5, 30, 10}, 1e-3, true},
      {"joint_slip_limit", 23, {5e4, 1e6, 0, 35, 12, 2e-3}, 1e-3, true},
      {"joint_dilating_much", 23, {5e4, 1e6, 2, 25, 24}, 1e-3, true},
      {"joint_without_dilation", 23, {5e4, 1e6, 2, 25}, 1e-3, true},
      {"cd_chapter", 22, {0, 28.5, 0, 0, 5000, 0.9, 1e6, 1e6, 0}, 1e-3, true},
      {"cd_free", 22, {0, 0, 0, 0, 0, 0, 1e6, 1e6, 0}, 1e-3, true, false},
      {"cd_tangent", 22, {5, 30, 10, 0.85, 5000, 0.7, 1e6, 5e5, 0, 0}, 1e-3, true},
      {"cd_midpoint", 22, {5, 30, 10, 0.85, 5000, 0.7, 1e6, 5e5, 100, 1}, 1e-3, true},
      {"cd_exact", 22, {5, 30, 0, 0.85, 5000, 0.7, 1e6, 1e6, 0, 2}, 1e-3, true},
      {"cd_exact_no_memory", 22, {0, 30, 0, 1, 5000, 0.7, 1e6, 1e6, 100, 2, 1e-3, 1}, 1e-3, true},
      {"cd_strengthless", 22, {0, 0, 0, 0.8, 5000, 0.7, 1e6, 1e6, 0, 1}, 1e-3, true},
      {"cd_89", 22, {1, 89, 0, 0.8, 5000, 0.7, 1e6, 1e6, 0, 2}, 1e-3, true, false},
      {"axial_elastic", 31, {2e4}, 0.01, false},
      {"axial_elastic_spaced", 31, {2e4, 2.5}, 0.01, false},
      {"axial_tension", 32, {2e4}, 0.01, false},
      {"axial_compression", 32, {2e4, -1, 3}, 0.01, false},
      {"axial_plastic", 33, {2e4, 80, 50}, 0.01, true},
      {"axial_no_compression", 33, {2e4, 80, 0, 2}, 0.01, true},
      {"plate", 35, {2e7, 0.2, 0.3}, 0.01, false},
      {"plate_strips", 35, {2e7, 0.2, 0.3, 0}, 0.01, false},
      {"section_elastic", 36, {1e6, 2e4, 3e5, 2e4, 30}, 0.01, false},
      {"section_plastic", 37, {1e6, 2e4, 5e3, 100}, 0.01, true},
      {"section_plastic_moment", 37, {1e6, 2e4, 0, 100, 3e5, 2e4, 30}, 0.01, true},
  };
}

}  // namespace sage::test
