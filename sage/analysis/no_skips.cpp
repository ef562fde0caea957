// In place of the sources in skips/, where the program is built without them.
#include "sage/analysis/stepping_policy.hpp"
#include "sage/analysis/system.hpp"
#include "sage/core/solver_extensions.hpp"

namespace sage {

std::unique_ptr<Assembly> make_assembly(const Model& model, const Scene& scene, const Skips& /*skips*/,
                                        WorkCounters& work) {
  return std::make_unique<Assembly>(model, scene, work);
}

std::unique_ptr<SteppingPolicy> make_stepping_policy(const Skips& /*skips*/) {
  return std::make_unique<SteppingPolicy>();
}

void set_up_solver(const Skips& /*skips*/, LinearSolver& solver) {
  if (auto* repeated = dynamic_cast<RepeatedParts*>(&solver)) repeated->use_repeated_parts(false);
}

}  // namespace sage
