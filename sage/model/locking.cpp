#include "sage/model/locking.hpp"

namespace sage {

double poissons_ratio(const Material& material) {
  return material.parameter(ParameterRole::poissons_ratio).value_or(0.0);
}

bool nearly_incompressible(const Model& model, const Group& group) {
  return poissons_ratio(model.material_of(group)) > 0.45 || group.excess >= 0;
}

}  // namespace sage
