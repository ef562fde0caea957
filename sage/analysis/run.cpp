#include "sage/analysis/run.hpp"

#include "sage/analysis/analysis.hpp"

namespace sage {

RunResult run(const Model& model, const Catalogue& catalogue, const RunSettings& settings,
              std::span<Observer* const> observers) {
  Analysis analysis(model, catalogue, settings, observers);
  analysis.open();
  while (analysis.advance()) {
  }
  return analysis.close();
}

}  // namespace sage
