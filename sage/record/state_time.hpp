// What the time of a state means in files that others play as a film.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/records.hpp"
#include "sage/model/model.hpp"

namespace sage {

// A specimen whose report's nodes are pushed in from its stage on: the axial strain of the report, which grows
// with every increment; stages before it count up to 0.  Everything else: the durations of the stages, each 1
// where the deck gives none, so that stage n ends at n.
class StateTime {
 public:
  explicit StateTime(const Model& model);

  // stage: from 0; load_factor: part of it that is applied.
  double at(int stage, double load_factor) const;
  // A load that a displacement controls may fall: there the share of the increments counts.
  double at(const StepReport& report) const {
    const double part = controlled_[static_cast<std::size_t>(report.stage)]
                            ? static_cast<double>(report.increment) / report.increments
                            : report.load_factor;
    return at(report.stage, part) - (is_strain_ ? 0.0 : report.early);
  }
  const std::string& meaning() const { return meaning_; }

 private:
  bool use_strain(const Model& model);

  std::vector<bool> controlled_;  // stages whose load a displacement controls
  std::vector<double> ends_;      // of the stages
  double start_ = 0.0;            // of the first
  std::string meaning_;
  bool is_strain_ = false;
};

}  // namespace sage
