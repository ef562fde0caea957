// Catalogue entries of the triangles.
#include "elements/entries.hpp"
#include "elements/solid_entry.hpp"

namespace sage {

ElementEntry tri3_entry() {
  return element_entry("tri3", "three-node triangle, constant strain", 3, 3, 4,
                       {{{1, "one point", "centroid; locks as nu -> 1/2"},
                         solid<Tri3, Triangle1>("tri3", {.reduced_axisymmetric = true, .locks = true})},
                        {{2, "three points", "for the hoop strain of coarse rings; locks as nu -> 1/2"},
                         solid<Tri3, Triangle3>("tri3 three points", {.locks = true})}});
}

ElementEntry tri6_entry() {
  return element_entry(
      "tri6", "six-node triangle, quadratic", 6, 3, 4,
      {{{1, "three points", "exact on straight sides; does not lock, but loses accuracy as nu -> 1/2"},
        solid<Tri6, Triangle3>("tri6", {.loses_order = true})},
       {{2, "six points", "degree 4, exact on curved sides; locks as nu -> 1/2"},
        solid<Tri6, Triangle6>("tri6 six points", {.locks = true})}});
}

ElementEntry tri15_entry() {
  return element_entry("tri15", "fifteen-node triangle, quartic", 15, 3, 4,
                       {{{1, "twelve points", "degree 6"}, solid<Tri15, Triangle12>("tri15")},
                        {{2, "sixteen points", "degree 8, for curved sides"},
                         solid<Tri15, Triangle16>("tri15 sixteen points")}});
}

}  // namespace sage
