#include "sage/analysis/system.hpp"

#include <algorithm>

#include "sage/analysis/loads.hpp"

namespace sage {

System::System(const Model& model, const Catalogue& catalogue, const RunSettings& settings, WorkCounters& work)
    : model_(model),
      catalogue_(catalogue),
      settings_(settings),
      work_(work),
      scene_(analyse_scene(model)),
      assembly_(model, scene_, settings.skips, work),
      activity_(model),
      lived_(model.groups.size(), 0) {
  assembly_.set_stop(settings.stop_asked);
}

const SolverEntry* System::choose_solver(int equations, bool symmetric) const {
  int code = settings_.solver >= 0 ? settings_.solver : model_.solver;
  if (code == 0 && settings_.choose_solver) code = settings_.choose_solver(equations, symmetric);
  const SolverEntry* entry = catalogue_.solvers.find(code);
  if (entry == nullptr)
    throw AnalysisError("solver " + std::to_string(code) + " is unknown; " + catalogue_.solvers.known());
  if (entry->symmetric && !symmetric)
    throw AnalysisError("solver " + entry->name +
                        " is for symmetric matrices only; this scene has an unsymmetric law");
  return entry;
}

std::unique_ptr<LinearSolver> System::make(const SolverEntry& entry) const {
  auto solver = entry.make();
  solver->set_threads(settings_.threads);
  solver->set_refinement(settings_.refinement);
  solver->set_stop(settings_.stop_asked);
  return solver;
}

void System::make_solver() {
  const SolverEntry* entry = choose_solver(assembly_.equations(), scene_.symmetric);
  solver_ = make(*entry);
  solver_name_ = entry->name;
  stiffness_ = {};
  stiffness_.solver = solver_.get();
  const Timer timer(work_.analyse_seconds);
  ++work_.analyses;
  solver_->analyse(assembly_.equations(), assembly_.element_equations());
}

// A group that has lived before comes back without stress and history.
void System::enter(const Stage& stage) {
  activity_.enter(stage);
  for (int g : stage.births)
    if (lived_[static_cast<std::size_t>(g)]) assembly_.reset_group(static_cast<std::size_t>(g));
  for (std::size_t g = 0; g < lived_.size(); ++g) lived_[g] = lived_[g] || activity_.group[g];
}

void System::pass_stage(int s) {
  enter(model_.stages[static_cast<std::size_t>(s)]);
}

bool System::open_stage(int s) {
  const Stage& stage = model_.stages[static_cast<std::size_t>(s)];
  rate_ = prescribed_rate(model_, stage);
  enter(stage);
  const bool condensed_before = assembly_.condensation() != nullptr;
  assembly_.enter_stage(activity_, rate_);
  assembly_.condense(stage.increments,
                     [&](int equations, bool symmetric) { return make(*choose_solver(equations, symmetric)); });
  const bool same_pattern = solver_ && !condensed_before && !assembly_.condensation() &&
                            held_before_ == activity_.held && groups_before_ == activity_.group;
  if (!same_pattern) {
    make_solver();
    held_before_ = activity_.held;
    groups_before_ = activity_.group;
  }
  stiffness_.constant = scene_.linear && settings_.skips.factors;
  return same_pattern;
}

int System::equations() const {
  return assembly_.equations() + (assembly_.condensation() ? assembly_.condensation()->condensed() : 0);
}

double System::smallest_pivot() const {
  const double own = solver_->report().smallest_pivot_ratio;
  if (!assembly_.condensation()) return own;
  const double inner = assembly_.condensation()->report().smallest_pivot_ratio;
  return own < 0.0 || inner < 0.0 ? std::max(own, inner) : std::min(own, inner);
}

DigitsReport System::digits() const {
  if (!stiffness_.factorised) return {};
  return report_digits(*solver_, assembly_.equations(), smallest_pivot(), settings_.condition);
}

}  // namespace sage
