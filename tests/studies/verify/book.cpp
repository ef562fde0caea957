#include "tests/studies/verify/book.hpp"

#include "tests/studies/verify/cases.hpp"

namespace sage::verify {

std::vector<Section> book() {
  return {patch_cases(),         interface_patch_cases(),
          lame_cases(),          manufactured_cases(),
          box_cases(),           restrained_cylinder_cases(),
          interface_cases(),     cavity_cases(),
          bearing_cases(),       slope_cases(),
          ground_cases(),        law_cases(),
          structure_cases(),     soil_structure_cases(),
          seepage_cases(),       water_cases(),
          consolidation_cases(), clay_cases()};
}

}  // namespace sage::verify
