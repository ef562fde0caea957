// Which groups hardly change their volume, so that elements which lock do.
#pragma once

#include "sage/model/model.hpp"

namespace sage {

// Poisson's ratio above 0.45, or undrained.
bool nearly_incompressible(const Model& model, const Group& group);
// Four-node elements resist a flow that dilates, unless they have a strain of their own, which they solve for.
bool resists_dilation(const ElementEntry& entry, const ElementTraits& traits);
// The formulation that a group gets where its deck leaves it open: the first of the entry, or for a law that dilates
// the first that such a flow is possible with.
const Formulation& default_formulation(const ElementEntry& entry, Geometry geometry, bool dilates);
// By how much the ground of a material grows while it flows: its largest dilation angle in degrees, or the share of the
// associated flow for laws without that angle.  Both 0: it keeps its volume.
struct Dilation {
  double angle = 0.0, share = 0.0;
  bool none() const { return angle <= 0.0 && share <= 0.0; }
};
Dilation dilation_of(const Material& material);
// Poisson's ratio of a material, 0 where its law has none.
double poissons_ratio(const Material& material);

}  // namespace sage
