// What all outputs to files have in common.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

class Output : public Observer {
 public:
  // Files show nodes in the states that they show points in.
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return wants_states(model, report);
  }
  // The complete files, in the order of writing.
  virtual std::vector<std::filesystem::path> files() const = 0;
  // For a run that an exception ended, so that on_finish never comes: the file says so and gets its name.
  virtual void stop(const std::string& reason) = 0;
};

// Asked for by `run --states`, whatever the deck chooses.
inline bool is_asked_increment(const Stage& stage, const StepReport& report) {
  return std::ranges::binary_search(stage.output_at, report.increment);
}

// The deck's choice (every n-th increment), what was asked for besides, and always the last of a stage.
inline bool is_output_increment(const Stage& stage, const StepReport& report) {
  return report.increment == report.increments || is_asked_increment(stage, report) ||
         (stage.output_every > 0 && report.increment > 0 && report.increment % stage.output_every == 0);
}

inline const Stage& stage_of(const Model& model, int stage) {
  return model.stages[stage];
}

}  // namespace sage
