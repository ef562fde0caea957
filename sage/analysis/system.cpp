#include "sage/analysis/system.hpp"

#include <algorithm>

#include "sage/analysis/external_loads.hpp"
#include "sage/core/solver_extensions.hpp"
#include "sage/platform/large_pages.hpp"

namespace sage {

namespace {

constexpr int kManyEquations = 100'000;  // their factors are the bulk of the memory

std::vector<EquationPlace> places_of(const Mesh& mesh, const Assembly& assembly) {
  std::vector<EquationPlace> places;
  for (int eq = 0; eq < assembly.equations(); ++eq) {
    const DofMap::Unknown unknown = assembly.dof_map().at(assembly.dof_of(eq));
    places.push_back({mesh.x.col(unknown.node), unknown.node, unknown.field, unknown.component});
  }
  return places;
}

// All steps of the stage have one size, and K depends on nothing else.
bool has_one_matrix(const Assembly& assembly, const Stage& stage) {
  return stage.grading == 1.0 && stage.time_error == 0.0 && stage.ends.empty() && linear_in_step(assembly);
}

}  // namespace

System::System(const Model& model, const Catalogue& catalogue, const RunSettings& settings, WorkCounters& work)
    : model_(model),
      catalogue_(catalogue),
      settings_(settings),
      work_(work),
      scene_(analyse_scene(model)),
      assembly_(make_assembly(model, scene_, settings.skips, work)),
      activity_(model),
      tangent_(scene_.linear, assembly_->keeps_factors()),
      lived_(model.groups.size(), 0) {
  assembly_->set_stop(settings.stop_asked);
  assembly_->set_threads(settings.threads);
}

const SolverEntry* System::choose_solver(const SystemSize& size) const {
  int code = settings_.solver >= 0 ? settings_.solver : model_.solver;
  if (code == 0 && settings_.choose_solver) code = settings_.choose_solver(size);
  const SolverEntry* entry = catalogue_.solvers.find(code);
  if (entry == nullptr)
    throw AnalysisError("S213",
                        "solver " + std::to_string(code) + " is unknown; " + catalogue_.solvers.known());
  if (entry->symmetric && !size.symmetric)
    throw AnalysisError(
        "S324", "solver " + entry->name + " is for symmetric matrices only; this scene has an unsymmetric law");
  return entry;
}

std::unique_ptr<LinearSolver> System::make(const SolverEntry& entry, bool one_factorisation) const {
  auto solver = make_solver(settings_.skips, entry, one_factorisation);
  solver->configure({.threads = settings_.threads,
                     .kernels = settings_.kernels,
                     .refinement_steps = settings_.refinement,
                     .one_factorisation = one_factorisation,
                     .stop_asked = settings_.stop_asked});
  return solver;
}

void System::analyse(bool one_factorisation) {
  const SolverEntry* entry = choose_solver({assembly_->equations(), scene_.symmetric, model_.has_pores()});
  std::unique_ptr<LinearSolver> solver = make(*entry, one_factorisation);
  if (auto* placed = dynamic_cast<PlacedSolver*>(solver.get()))
    placed->set_places(places_of(model_.mesh, *assembly_));
  ElementEquations elements = assembly_->element_equations();
  ElementCombinations combinations = assembly_->combine(elements);
  tangent_.analyse(std::move(solver), assembly_->equations(), std::move(elements), std::move(combinations),
                   work_);
  if (assembly_->equations() >= kManyEquations) return_freed_memory();
  held_before_ = activity_.held;
  groups_before_ = activity_.group;
  turned_before_ = activity_.turned;
}

// A group that has been active before is activated again without stress and history.
void System::enter(const Stage& stage) {
  activity_.enter(stage);
  for (int g : stage.births)
    if (lived_[g]) assembly_->reset_group(static_cast<std::size_t>(g));
  for (std::size_t g = 0; g < lived_.size(); ++g) lived_[g] = lived_[g] || activity_.group[g];
}

void System::pass_stage(int s) {
  enter(model_.stages[s]);
}

void System::open_stage(int s) {
  const Stage& stage = model_.stages[s];
  rate_ = prescribed_rate(stage, activity_.dof_map);
  enter(stage);
  add_turned_rate(stage, activity_, rate_);
  if (stage.pores != PoreWater::flows)
    for (const auto& [dof, supported] : activity_.pores) rate_[dof] = 0.0;
  const bool eliminated_before = !assembly_->eliminated().dofs().empty();
  // Dofs are eliminated for loads that grow along one line, by shares that are known.
  if (stage.is_controlled() || stage.has_mechanical_histories())
    assembly_->enter_stage(activity_, rate_);
  else
    assembly_->enter_stage(activity_, rate_, stage.increments, [&](int equations, bool symmetric) {
      return make(*choose_solver({equations, symmetric}), true);
    });
  tangent_.set_rate(rate_);
  exits_.enter(model_, activity_, s);
  const bool same_pattern = !eliminated_before && assembly_->eliminated().dofs().empty() &&
                            held_before_ == activity_.held && groups_before_ == activity_.group &&
                            turned_before_ == activity_.turned;
  if (!same_pattern) analyse(tangent_.constant() || has_one_matrix(*assembly_, stage));
  const bool serves = tangent_.constant() && tangent_.factorised() && rate_.isZero(0.0);
  if (!serves) tangent_.forget();
}

void System::start_exits(const Eigen::VectorXd& u, double part) {
  exits_.start(u, activity_.held);
  take_exits(u, part);
}

bool System::switch_exits(const Eigen::VectorXd& u, const Eigen::VectorXd& du, const Eigen::VectorXd& target,
                          double part) {
  if (!exits_.update(u + du, assembly_->internal_force() - target, activity_.held)) return false;
  take_exits(u, part);
  return true;
}

void System::take_histories(const Stage& stage, double from, double to) {
  bool changed = false;
  const auto moves = [](const Fixity& f) { return !f.history.empty(); };
  if (std::ranges::any_of(stage.fixities, moves)) {
    const auto growth = [&](const Fixity& f) {
      return (share_of(f, to, stage.duration) - share_of(f, from, stage.duration)) / (to - from);
    };
    for (const Fixity& f : stage.fixities)
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] == FixityCode::fixed)
          rate_[DofMap::displacement(f.node, static_cast<int>(c))] =
              f.history.empty() ? f.value[c] : growth(f) * f.value[c];
    add_turned_rate(stage, activity_, rate_);
    changed = true;
  }
  for (const FieldFixity& f : stage.field_fixities) {
    const int dof = f.history.empty() ? -1 : activity_.dof_map.of(f.node, f.field);
    if (dof < 0 || f.code != FixityCode::fixed || stage.pores != PoreWater::flows) continue;
    rate_[dof] = (added_at(f, to, stage.duration) - added_at(f, from, stage.duration)) / (to - from);
    changed = true;
  }
  if (!changed) return;
  tangent_.set_rate(rate_);
  tangent_.forget();
}

void System::take_exits(const Eigen::VectorXd& u, double part) {
  exits_.set_rates(u, part, activity_.held, rate_);
  renumber();
}

void System::renumber() {
  assembly_->enter_stage(activity_, rate_);
  tangent_.set_rate(rate_);
  analyse(tangent_.constant());
  tangent_.forget();
}

int System::equations() const {
  return assembly_->equations() + static_cast<int>(assembly_->eliminated().dofs().size());
}

void System::release_solver() {
  last_ = {smallest_pivot(), digits(), kernels()};
  tangent_.release();
}

std::string System::kernels() const {
  return last_ ? last_->kernels : std::string(tangent_.solver().report().kernels);
}

double System::smallest_pivot() const {
  if (last_) return last_->smallest_pivot;
  const double own = tangent_.solver().report().smallest_pivot_ratio;
  const double inner = assembly_->eliminated().smallest_pivot();
  return own < 0.0 || inner < 0.0 ? std::max(own, inner) : std::min(own, inner);
}

DigitsReport System::digits() const {
  if (last_) return last_->digits;
  if (!tangent_.factorised()) return {};
  return report_digits(tangent_.solver(), assembly_->equations(), smallest_pivot(), settings_.condition);
}

}  // namespace sage
