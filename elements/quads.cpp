// Catalogue entries of the quadrilaterals.
#include "elements/solid_entry.hpp"

namespace sage {

ElementEntry quad4_entry() {
  return element_entry(
      with_shape<Quad4>({.name = "quad4",
                         .summary = "four-node quadrilateral, bilinear",
                         .side_interface = "interface4",
                         .folded = "tri3",
                         .against_locking = "b-bar (formulation 2) does not",
                         .vtk = {9},
                         .gmsh = {3},
                         .calculix = {"4"}}),
      {solid<Quad4, GaussSquare<2>, AssumedStrain::mean_dilatation>(
           {2, "b-bar", "2x2 Gauss, mean dilatation (weighted by volume): does not lock"}, "quad4 b-bar"),
       solid<Quad4, GaussSquare<2>>({1, "full", "2x2 Gauss, as in the source chapter; locks as nu -> 1/2"},
                                    "quad4 full", {.locks = true}),
       // One point for the dilatation is the mean in plane strain, and only the mean is in equilibrium with loaded
       // edges in a ring (docs/decisions/0038).
       solid<Quad4, GaussSquare<2>, AssumedStrain::mean_dilatation>(
           {3, "selective", "the same element as b-bar, under the name of selective integration"},
           "quad4 selective"),
       solid<Quad4, GaussSquare<2>, AssumedStrain::enhanced>(
           {5, "enhanced",
            "2x2 Gauss, enhanced assumed strain: locks neither in flow that dilates nor as nu -> 1/2"},
           "quad4 enhanced"),
       solid<Quad4, GaussSquare<3>>(
           {4, "full 3x3", "3x3 Gauss, for the hoop strain of coarse rings; locks as nu -> 1/2"},
           "quad4 full 3x3", {.locks = true})});
}

ElementEntry quad8_entry() {
  return element_entry(
      with_shape<Quad8>({.name = "quad8",
                         .summary = "eight-node quadrilateral, serendipity",
                         .side_interface = "interface6",
                         .against_locking = "reduced integration (formulation 1) does not",
                         .vtk = {23},
                         .gmsh = {16},
                         .calculix = {"8"},
                         .calculix_reduced = "8R"}),
      {solid<Quad8, GaussSquare<2>>({1, "reduced", "2x2 Gauss; one hourglass that cannot spread"},
                                    "quad8 reduced", {.reduced_plane = true, .reduced_axisymmetric = true}),
       solid<Quad8, GaussSquare<3>>({2, "full", "3x3 Gauss; locks as nu -> 1/2"}, "quad8 full",
                                    {.locks = true})});
}

ElementEntry quad9_entry() {
  return element_entry(with_shape<Quad9>({.name = "quad9",
                                          .summary = "nine-node quadrilateral, biquadratic",
                                          .side_interface = "interface6",
                                          .vtk = {28},
                                          .gmsh = {10}}),
                       {solid<Quad9, GaussSquare<3>>({1, "full", "3x3 Gauss; locks as nu -> 1/2"}, "quad9 full",
                                                     {.locks = true})});
}

}  // namespace sage
