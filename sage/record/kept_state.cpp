#include "sage/record/kept_state.hpp"

namespace sage {

KeptState::KeptState(const Model& model, const Solution& now)
    : u_(*now.u),
      internal_(*now.internal),
      external_(*now.external),
      scene_(analyse_scene(model)),
      assembly_(model, scene_, Skips{}, work_),
      activity_(*now.activity) {
  assembly_.groups() = now.assembly->groups();
}

}  // namespace sage
