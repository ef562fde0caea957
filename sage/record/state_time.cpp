#include "sage/record/state_time.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace sage {

namespace {

// How much further a stage pushes the report's nodes in, over the specimen's height; 0 where it does not hold
// them all, or pulls them out.
double strain_of(const Report& report, const Mesh& mesh, const Stage& stage) {
  double sum = 0.0;
  int count = 0;
  for (int node : report.nodes) {
    if (node >= mesh.deck_nodes) continue;
    const auto drives = [node](const Fixity& f) { return f.node == node && f.code[1] == FixityCode::fixed; };
    const auto found = std::ranges::find_if(stage.fixities, drives);
    if (found == stage.fixities.end()) return 0.0;
    sum += found->value[1];
    ++count;
  }
  return count > 0 && report.height > 0.0 ? std::max(0.0, -sum / count / report.height) : 0.0;
}

}  // namespace

StateTime::StateTime(const Model& model) {
  for (const Stage& stage : model.stages) controlled_.push_back(stage.is_controlled());
  is_strain_ = use_strain(model);
  if (is_strain_) return;
  bool given = false;
  for (const Stage& stage : model.stages) {
    ends_.push_back((ends_.empty() ? 0.0 : ends_.back()) + stage.duration);
    given = given || stage.duration != 1.0;
  }
  meaning_ = given ? "sum of the durations of the stages" : "stage - 1 + load factor";
  if (!given && std::ranges::find(controlled_, true) != controlled_.end())
    meaning_ += ", of a controlled load the share of its increments";
}

bool StateTime::use_strain(const Model& model) {
  const auto report = std::ranges::find(model.reports, ReportKind::triaxial, &Report::kind);
  if (report == model.reports.end()) return false;
  const auto first = static_cast<std::size_t>(report->stage);
  start_ = -static_cast<double>(report->stage);
  std::vector<double> ends;
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    const bool by_tables = model.stages[s].has_mechanical_histories();
    const double strain = by_tables ? 0.0 : s < first ? 1.0 : strain_of(*report, model.mesh, model.stages[s]);
    if (!(strain > 0.0)) {
      start_ = 0.0;
      return false;
    }
    ends.push_back((ends.empty() ? start_ : ends.back()) + strain);
  }
  ends_ = std::move(ends);
  meaning_ = fmt::format("axial strain of report {}", report - model.reports.begin() + 1);
  if (first > 0) meaning_ += ", its start is 0";
  return true;
}

double StateTime::at(int stage, double load_factor) const {
  const auto s = static_cast<std::size_t>(stage);
  const double before = s == 0 ? start_ : ends_[s - 1];
  return before + load_factor * (ends_[s] - before);
}

}  // namespace sage
