#include "sage/record/strength.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sage {

namespace {

double factor_of(const Model& model, int stage) {
  return model.stages[stage].strength_factor;
}

}  // namespace

void StrengthRows::start(const Model& model, int stage, const Solution& solution) {
  now_ = {};
  now_.factor = factor_of(model, stage);
  from_.clear();
  if (now_.factor > 0.0) from_.assign(solution.u->data(), solution.u->data() + solution.u->size());
}

void StrengthRows::increment(const Model& model, const StepReport& report) {
  if (factor_of(model, report.stage) > 0.0) now_.iterations += report.total_iterations;
}

void StrengthRows::finish(const Model& model, const Solution& solution) {
  for (int node = 0; node < model.mesh.nodes() && !from_.empty(); ++node)
    for (int c = 0; c < 2; ++c) {
      const int dof = DofMap::displacement(node, c);
      const double moved = std::abs((*solution.u)[dof] - from_[dof]);
      if (moved <= now_.largest) continue;
      now_.largest = moved;
      now_.node = node;
    }
  rows_.push_back(now_);
}

void StrengthRows::end(const Model& model, int stage, const Solution& solution) {
  if (factor_of(model, stage) <= 0.0) return;
  now_.equilibrium = 1;
  now_.load_factor = 1.0;
  finish(model, solution);
}

void StrengthRows::failed(const Model& model, const StepReport& report, const Solution& solution) {
  if (factor_of(model, report.stage) <= 0.0) return;
  now_.iterations += report.total_iterations;
  now_.load_factor = report.load_factor;
  finish(model, solution);
}

void StrengthRows::exchange(Archive& archive) {
  archive(from_);
  archive(now_);
  archive(rows_);
}

std::string strength_table(const Model& model, const std::vector<StrengthRow>& rows) {
  if (rows.empty()) return {};
  std::string text = fmt::format("{:>12}{:>18}{:>24}{:>8}{:>12}\n", "factor", "equilibrium",
                                 "largest displ. [" + model.units.length + "]", "node", "iterations");
  for (const StrengthRow& row : rows)
    text += fmt::format(
        "{:>12.6g}{:>18}{:>24.4E}{:>8}{:>12}\n", row.factor,
        row.equilibrium != 0 ? "found" : fmt::format("none above {:.3g}", row.load_factor), row.largest,
        row.node < 0 ? std::string("-") : std::to_string(model.mesh.number[row.node]), row.iterations);
  std::size_t asked = 0;
  for (const Stage& stage : model.stages) asked += stage.strength_factor > 0.0 ? 1 : 0;
  if (rows.size() < asked) text += fmt::format("{:>12}\n", fmt::format("{} not tried", asked - rows.size()));
  return text;
}

}  // namespace sage
