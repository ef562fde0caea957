// Catalogue entries of the triangles.
#include "elements/solid_entry.hpp"

namespace sage {

ElementEntry tri3_entry() {
  return element_entry(
      with_shape<Tri3>({.name = "tri3",
                        .summary = "three-node triangle, constant strain",
                        .side_interface = "interface4",
                        .against_locking = "6-node triangles (three points) do not",
                        .vtk = {5},
                        .gmsh = {2},
                        .calculix = {"3"}}),
      {solid<Tri3, Triangle1>({1, "one point", "centroid; locks as nu -> 1/2"}, "tri3",
                              {.reduced_axisymmetric = true, .locks = true}),
       solid<Tri3, Triangle3>({2, "three points", "for the hoop strain of coarse rings; locks as nu -> 1/2"},
                              "tri3 three points", {.locks = true})});
}

ElementEntry tri6_entry() {
  return element_entry(
      with_shape<Tri6>({.name = "tri6",
                        .summary = "six-node triangle, quadratic",
                        .side_interface = "interface6",
                        .against_locking = "three points (formulation 1) do not",
                        .vtk = {22},
                        .gmsh = {9},
                        .calculix = {"6"}}),
      {solid<Tri6, Triangle3>(
           {1, "three points", "exact on straight sides; does not lock, but loses accuracy as nu -> 1/2"},
           "tri6", {.loses_order = true}),
       solid<Tri6, Triangle6>({2, "six points", "degree 4, exact on curved sides; locks as nu -> 1/2"},
                              "tri6 six points", {.locks = true})});
}

ElementEntry tri15_entry() {
  return element_entry(
      with_shape<Tri15>(
          {.name = "tri15", .summary = "fifteen-node triangle, quartic", .vtk = {69}, .gmsh = {23}}),
      {solid<Tri15, Triangle12>({1, "twelve points", "degree 6"}, "tri15"),
       solid<Tri15, Triangle16>({2, "sixteen points", "degree 8, for curved sides"}, "tri15 sixteen points")});
}

}  // namespace sage
