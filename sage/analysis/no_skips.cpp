// In place of the sources in skips/, where the program is built without them.
#include "sage/analysis/stepping_policy.hpp"
#include "sage/analysis/system.hpp"

namespace sage {

std::unique_ptr<Assembly> make_assembly(const Model& model, const Scene& scene, const Skips& /*skips*/,
                                        WorkCounters& work) {
  return std::make_unique<Assembly>(model, scene, work);
}

std::unique_ptr<SteppingPolicy> make_stepping_policy(const Skips& /*skips*/) {
  return std::make_unique<SteppingPolicy>();
}

std::unique_ptr<LinearSolver> make_solver(const Skips& /*skips*/, const SolverEntry& entry,
                                          bool /*one_factorisation*/) {
  return entry.make();
}

}  // namespace sage
