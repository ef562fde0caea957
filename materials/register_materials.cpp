// The page that lists every law.  A new law = its own file, one line here, one in CMakeLists.txt, one test.
#include "materials/register_materials.hpp"

#include "materials/axial.hpp"
#include "materials/clough_duncan.hpp"
#include "materials/darcy.hpp"
#include "materials/darcy_free_surface.hpp"
#include "materials/dilating_joint.hpp"
#include "materials/drucker_prager.hpp"
#include "materials/duncan_chang.hpp"
#include "materials/duncan_selig.hpp"
#include "materials/goodman.hpp"
#include "materials/hoek_brown.hpp"
#include "materials/hyperbolic_mohr_coulomb.hpp"
#include "materials/linear_elastic.hpp"
#include "materials/modified_cam_clay.hpp"
#include "materials/mohr_coulomb.hpp"
#include "materials/mohr_coulomb_softening.hpp"
#include "materials/pore_flow.hpp"
#include "materials/section.hpp"

namespace sage {

void register_materials(Catalogue& catalogue) {
  // Solids
  catalogue.materials.add(1, linear_elastic_entry());
  catalogue.materials.add(2, linear_elastic_kg_entry());
  catalogue.materials.add(3, drucker_prager_entry());
  catalogue.materials.add(4, mohr_coulomb_entry());
  catalogue.materials.add(5, duncan_chang_1970_entry());
  catalogue.materials.add(6, duncan_chang_eb_entry());
  catalogue.materials.add(7, hyperbolic_mohr_coulomb_entry());
  catalogue.materials.add(8, mohr_coulomb_softening_entry());
  catalogue.materials.add(9, hoek_brown_entry());
  catalogue.materials.add(10, duncan_selig_entry());
  catalogue.materials.add(11, modified_cam_clay_entry());
  // Interfaces
  catalogue.materials.add(21, goodman_entry());
  catalogue.materials.add(22, clough_duncan_entry());
  catalogue.materials.add(23, dilating_joint_entry());
  // Structures
  catalogue.materials.add(31, axial_elastic_entry());
  catalogue.materials.add(32, axial_one_way_entry());
  catalogue.materials.add(33, axial_plastic_entry());
  catalogue.materials.add(35, plate_entry());
  catalogue.materials.add(36, section_elastic_entry());
  catalogue.materials.add(37, section_plastic_entry());
  // Water
  catalogue.materials.add(41, darcy_entry());
  catalogue.materials.add(42, darcy_free_surface_entry());
  catalogue.materials.add(43, pore_flow_entry());
  catalogue.materials.add(44, pore_joint_entry());
}

}  // namespace sage
