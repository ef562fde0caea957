#include "sage/record/discretisation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/model/arc_sides.hpp"

namespace sage {

namespace {

// The report's nodes are moved along the axis and nothing else happens from its stage on.
bool driven_by_displacement(const Model& model, const Report& report) {
  for (std::size_t s = static_cast<std::size_t>(report.stage); s < model.stages.size(); ++s) {
    const Stage& stage = model.stages[s];
    if (!stage.loads.empty() || !stage.pressures.empty() || stage.gravity != Vector2::Zero() ||
        !stage.births.empty() || !stage.deaths.empty() || !stage.initials.empty())
      return false;
    for (const Fixity& f : stage.fixities) {
      const bool listed = std::find(report.nodes.begin(), report.nodes.end(), f.node) != report.nodes.end();
      if (f.value[0] != 0.0 || (f.value[1] != 0.0 && !listed)) return false;
      if (f.code[0] == FixityCode::released || f.code[1] == FixityCode::released) return false;
    }
  }
  return true;
}

}  // namespace

std::string with_error(double value, double error) {
  if (!(error > 0.0) || !std::isfinite(error) || !std::isfinite(value)) return fmt::format("{:.10g}", value);
  // One digit of the error, rounded up.
  const int power = static_cast<int>(std::floor(std::log10(error)));
  const double unit = std::pow(10.0, power);
  const double shown = std::ceil(error / unit * (1.0 - 1e-9)) * unit;
  const int decimals = std::clamp(-power, 0, 15);
  return fmt::format("{:.{}f} +- {:.{}f}", value, decimals, shown, decimals);
}

void DiscretisationError::on_start(const Model& model, const Scene& scene, std::string_view, int) {
  linear_ = scene.linear;
  for (std::size_t i = 0; i < model.reports.size() && report_ < 0; ++i)
    if (model.reports[i].kind == ReportKind::triaxial) report_ = static_cast<int>(i);
}

void DiscretisationError::on_stage_start(const Model& model, int stage, const Solution& solution) {
  if (report_ >= 0 && stage == model.reports[report_].stage) start_ = stress_state(solution);
}

void DiscretisationError::on_stage_end(const Model& model, int stage, const EquilibriumAudit&,
                                       const Solution& solution) {
  if (stage + 1 == static_cast<int>(model.stages.size())) compute(model, solution);
}

void DiscretisationError::on_failure(const Model& model, const StepReport&, const std::string&,
                                     const Solution& solution) {
  compute(model, solution);
}

void DiscretisationError::compute(const Model& model, const Solution& solution) {
  if (!locking_groups(model).empty()) return;
  estimate_ = estimate_error(model, solution, start_ ? &*start_ : nullptr);
  if (report_ < 0 || !linear_ || !estimate_->energy) return;
  const Report& report = model.reports[report_];
  const std::vector<TriaxialRow>& rows = reports_->triaxial(static_cast<std::size_t>(report_));
  if (rows.empty() || !driven_by_displacement(model, report)) return;
  const TriaxialRow& last = rows.back();
  const double moved = std::abs(last.axial_strain * report.height);
  const double correct_force = std::abs(last.correct_deviator) * report_area(model, report);
  if (moved > 0.0 && correct_force > 0.0) ratio_error_ = estimate_->error / moved / correct_force;
}

void DiscretisationError::exchange(Archive& archive) {
  std::size_t groups = start_ ? start_->sigma.size() : 0;
  archive(groups);
  if (groups == 0) return;
  if (archive.reading()) {
    start_.emplace();
    start_->sigma.resize(groups);
    start_->eps.resize(groups);
  }
  for (std::vector<double>& sigma : start_->sigma) archive(sigma);
  for (std::vector<double>& eps : start_->eps) archive(eps);
  archive(start_->u);
}

std::string DiscretisationError::why_none(const Model& model) {
  const std::vector<int> locking = locking_groups(model);
  if (locking.empty()) return {};
  const Group& group = model.groups[locking.front()];
  return fmt::format(
      "not estimated: group {} ({}) locks near nu = 1/2, and an estimate sees only a part of that [{}]",
      group.number, group.element_name, "S410");
}

std::string DiscretisationError::text(const Model& model) const {
  if (!estimate_) {
    const std::string why = why_none(model);
    return why.empty() ? why : "  error       " + why + "\n";
  }
  std::string text =
      fmt::format("  error       stress {:.2g} % {} (Zienkiewicz-Zhu)", 100.0 * estimate_->relative(),
                  estimate_->energy ? "in the energy norm" : "in the mean-square norm");
  if (estimate_->worst_group >= 0) {
    const Group& group = model.groups[estimate_->worst_group];
    const auto e = static_cast<std::size_t>(estimate_->worst_element);
    const double part = estimate_->element[estimate_->worst_group][e] / estimate_->error;
    text += fmt::format(", {:.0f} % of its square in element {}", 100.0 * part, group.element_numbers[e]);
  }
  text += '\n';
  if (has_curved_sides(model))
    text +=
        "              curved sides count as the deck's parabolas: how far these are from another curve is not "
        "in it\n";
  if (ratio_error_) {
    const double ratio = reports_->triaxial(static_cast<std::size_t>(report_)).back().ratio;
    text += fmt::format("              ratio of report {} at the end {}, from the energy of the error\n",
                        report_ + 1, with_error(ratio, *ratio_error_));
  } else if (!model.reports.empty()) {
    text += "              what it means for the reports does not follow from it here: see --converge\n";
  }
  return text;
}

}  // namespace sage
