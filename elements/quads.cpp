// Catalogue entries of the quadrilaterals.
#include "elements/entries.hpp"
#include "elements/solid_entry.hpp"

namespace sage {

ElementEntry quad4_entry() {
  return element_entry(
      "quad4", "four-node quadrilateral, bilinear", 4, 4, 4,
      {{{2, "b-bar", "2x2 Gauss, mean dilatation (weighted by volume): does not lock"},
        solid<Quad4, GaussSquare<2>, Volumetric::mean>("quad4 b-bar")},
       {{1, "full", "2x2 Gauss, as in the source chapter; locks as nu -> 1/2"},
        solid<Quad4, GaussSquare<2>>("quad4 full", {.locks = true})},
       {{3, "selective",
         "2x2 Gauss, dilatation of the centre: b-bar in plane strain, inexact in distorted rings"},
        solid<Quad4, GaussSquare<2>, Volumetric::centre>("quad4 selective")},
       {{4, "full 3x3", "3x3 Gauss, for the hoop strain of coarse rings; locks as nu -> 1/2"},
        solid<Quad4, GaussSquare<3>>("quad4 full 3x3", {.locks = true})}});
}

ElementEntry quad8_entry() {
  return element_entry(
      "quad8", "eight-node quadrilateral, serendipity", 8, 4, 4,
      {{{1, "reduced", "2x2 Gauss; one hourglass that cannot spread"},
        solid<Quad8, GaussSquare<2>>("quad8 reduced", {.reduced_plane = true, .reduced_axisymmetric = true})},
       {{2, "full", "3x3 Gauss; locks as nu -> 1/2"},
        solid<Quad8, GaussSquare<3>>("quad8 full", {.locks = true})}});
}

ElementEntry quad9_entry() {
  return element_entry("quad9", "nine-node quadrilateral, biquadratic", 9, 4, 4,
                       {{{1, "full", "3x3 Gauss; locks as nu -> 1/2"},
                         solid<Quad9, GaussSquare<3>>("quad9 full", {.locks = true})}});
}

}  // namespace sage
