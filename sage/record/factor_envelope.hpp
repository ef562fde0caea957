// Section forces of structures under several sets of partial factors: of each set the least and the largest of all stages,
// times its factor on effects, and those of all sets together.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/observer.hpp"
#include "sage/model/partial_factors.hpp"
#include "sage/record/end_forces.hpp"

namespace sage {

// Gathers the envelope of the run of one set.
class FactorEnvelope : public Observer {
 public:
  void on_stage_end(const Model& model, int stage, const EquilibriumAudit&, const Solution& solution) override {
    envelope_.add(model, stage, solution);
  }
  bool wants_states(const Model&, const StepReport& report) const override {
    return report.increment == report.increments;
  }
  bool wants_nodes(const Model&, const StepReport& report, std::span<const char>) const override {
    return report.increment == report.increments;
  }
  void exchange(Archive& archive) override { envelope_.exchange(archive); }
  std::vector<EnvelopeEnd> rows() const { return envelope_.rows(); }

 private:
  Envelope envelope_;
};

struct FactoredEnds {
  PartialFactors set;
  std::vector<EnvelopeEnd> rows;
};

// One extreme of a quantity of a group.
struct FactoredExtreme {
  double value = 0.0;
  std::size_t set = 0;         // index
  int stage = 0, element = 0;  // stage from 1; number of the element
};

struct FactoredRange {
  std::size_t group = 0, quantity = 0;  // index; place in kEndQuantities
  FactoredExtreme least, largest;
};

// By group and quantity, over all sets.  The models of all sets have the same groups.
std::vector<FactoredRange> factored_ranges(const Model& model, const std::vector<FactoredEnds>& sets);
// A table for people, and a row per set and end for programs.
std::string factored_text(const Model& model, const std::vector<FactoredEnds>& sets);
std::string factored_csv(const Model& model, const std::vector<FactoredEnds>& sets, int digits);

}  // namespace sage
