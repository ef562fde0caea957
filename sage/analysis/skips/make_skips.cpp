// The skips that a run is made with (no_skips.cpp: none).
#include "sage/analysis/skips/condensed_assembly.hpp"
#include "sage/analysis/skips/stepping_skips.hpp"
#include "sage/analysis/system.hpp"

namespace sage {

std::unique_ptr<Assembly> make_assembly(const Model& model, const Scene& scene, const Skips& skips,
                                        WorkCounters& work) {
  if (skips.condensation && !scene.linear && DofMap(model).only_displacement() && !model.combines_dofs())
    return std::make_unique<CondensedAssembly>(model, scene, skips, work);
  return std::make_unique<AssemblyByRegions>(model, scene, skips, work);
}

std::unique_ptr<SteppingPolicy> make_stepping_policy(const Skips& skips) {
  return std::make_unique<SteppingSkips>(skips);
}

std::unique_ptr<LinearSolver> make_solver(const Skips& skips, const SolverEntry& entry,
                                          bool one_factorisation) {
  const bool with_repeats = skips.twins && one_factorisation && entry.make_with_repeats;
  return with_repeats ? entry.make_with_repeats() : entry.make();
}

}  // namespace sage
