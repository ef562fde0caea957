// The program's own law as a plug-in, from the same source (materials/modified_cam_clay.cpp).
#include "materials/modified_cam_clay.hpp"
#include "sage/core/plugin.hpp"

SAGE_PLUGIN("cam_clay", "1.0", "the tests", [](sage::Catalogue& catalogue) {
  sage::MaterialEntry entry = sage::modified_cam_clay_entry();
  entry.name = "cam_clay";
  catalogue.materials.add(1000, std::move(entry));
})
