#include "sage/analysis/stage_start.hpp"

#include <algorithm>

#include "sage/analysis/external_loads.hpp"
#include "sage/analysis/initial_balance.hpp"
#include "sage/analysis/initial_states.hpp"
#include "sage/analysis/pore_steps.hpp"
#include "sage/analysis/pore_warnings.hpp"
#include "sage/analysis/stage_warnings.hpp"
#include "sage/model/active_dofs.hpp"

namespace sage {

// Activity at the start matters only to pore pressures.
void StageStart::start_first_states() {
  const Model& model = run_.model;
  choose_laws(0);
  run_.assembly().start_states(has_own_start(model),
                               [&](std::vector<GroupData>& groups) { apply_own_starts(model, groups); });
  Activity first(model);
  first.enter(model.stages.front());
  start_states(0, first, model.initials, false);
}

void StageStart::open(int stage) {
  const Profile::Scope scope(run_.profile(), phase::kStart);
  RunState& state = run_.state;
  start_new_nodes();
  reset_displacements(stage);
  const std::vector<int> stored = free_stored_dofs(stage);
  run_.system.open_stage(stage);
  if (stage > 0) choose_laws(stage);
  start_states(stage, run_.system.activity(), run_.model.stages[stage].initials, true);
  state.du.setZero();
  state.place = {stage, 0};
  state.reached = 0.0;
  state.path.begin();
  evaluate();
  run_.assembly().commit(state.du);
  find_loads(stage);
  for (const int dof : stored) state.path.force_start[dof] = state.external[dof];
  note_imbalance(stage);
  PoreSteps::open_stage(run_);
  take_pressures_of_supports(stage);
}

// Of fields whose elements store what comes in, where the stage before was free to find their balance.  At its end the rate
// of storage was part of that balance.  At rest it is not, and what is missing must not become a load.
std::vector<int> StageStart::free_stored_dofs(int stage) const {
  std::vector<int> dofs;
  const Assembly& assembly = run_.assembly();
  if (stage == 0 || !assembly.wants_step_time()) return dofs;
  const DofMap& map = assembly.dof_map();
  for (int dof = map.displacements(); dof < map.dofs(); ++dof) {
    const UnknownField& field = run_.model.unknowns[map.at(dof).field];
    if (!field.balanced && !field.of_pores && assembly.equation_of(dof) >= 0) dofs.push_back(dof);
  }
  return dofs;
}

// Loads of excess pressures are volumes that have left since the beginning, and so are their internal forces.  What came or
// went where a stage held the pressure is no imbalance where the next one does not.
void StageStart::let_in_what_came(int stage) {
  const System& system = run_.system;
  if (system.activity().pores.empty()) return;
  RunState& state = run_.state;
  StagePath& path = state.path;
  const int dofs = run_.assembly().dof_map().dofs();
  path.let_in.setZero(dofs);
  const Eigen::VectorXd before =
      stage > 0 ? external_force(run_.model, stage - 1) : Eigen::VectorXd(Eigen::VectorXd::Zero(dofs));
  for (const auto& [dof, supported] : system.activity().pores) {
    if (run_.assembly().equation_of(dof) >= 0) path.let_in[dof] = path.force_start[dof] - before[dof];
    state.external[dof] = path.external_start[dof] = before[dof] + path.let_in[dof];
  }
  path.force_end += path.let_in;
}

// A support of an excess pressure has it at once, before any time has passed; the first step balances what that does to the
// soil (docs/decisions/0070).
void StageStart::take_pressures_of_supports(int stage) {
  const Activity& activity = run_.system.activity();
  if (activity.pores.empty() || run_.stage().pores != PoreWater::flows) return;
  RunState& state = run_.state;
  const Eigen::VectorXd values = supported_values(run_.model, stage, activity.dof_map);
  for (const auto& [dof, supported] : activity.pores)
    if (supported) state.du[dof] = values[dof] - state.u[dof];
  run_.warn(closed_part_warnings(run_.model, run_.stage(), activity, run_.system.exits().nodes()));
  if (!state.du.isZero(0.0)) {
    run_.warn(short_step_warnings(run_.model, run_.stage(), run_.assembly(), state.du,
                                  run_.end_of({stage, 1}) * run_.stage().duration));
    if (run_.assembly().evaluate(state.du, nullptr) == Outcome::cut_step)
      throw AnalysisError("S503", "stage " + std::to_string(stage + 1) +
                                      ": a law cannot start from the excess pressures of the supports");
    run_.assembly().commit(state.du);
    state.u += state.du;
    state.du.setZero();
    run_.assembly().evaluate(state.du, nullptr);
  }
}

// Those of the first stage come before any stress.
void StageStart::choose_laws(int stage) {
  if (!chooses_laws(run_.model, stage)) return;
  Diagnostics warnings;
  run_.assembly().start_states(
      true, [&](std::vector<GroupData>& groups) { apply_law_choices(run_.model, stage, groups, warnings); });
  run_.warn(warnings.list());
}

// Displacements alone: strains, stresses and other unknowns stay.
void StageStart::reset_displacements(int stage) {
  if (!run_.model.stages[stage].resets_displacements) return;
  run_.state.u.head(run_.assembly().dof_map().displacements()).setZero();
}

// New nodes have not moved, even where a node of a removed group was.  Before the groups of the stage are activated.
void StageStart::start_new_nodes() {
  if (std::ranges::all_of(run_.system.activity().group, [](char active) { return active != 0; })) return;
  const std::vector<char> borne = active_dofs(run_.model, run_.system.activity());
  for (std::size_t dof = 0; dof < borne.size(); ++dof)
    if (!borne[dof]) run_.state.u[dof] = 0.0;
}

// drainage: apply that of the stage, too.
void StageStart::start_states(int stage, const Activity& activity, const std::vector<InitialStress>& initials,
                              bool drainage) {
  Diagnostics warnings;
  const bool changes = drainage && changes_drainage(run_.model, stage);
  const std::optional<PorePressure> water =
      initials.empty() ? std::nullopt : run_.water_at(stage, activity, stage > 0 ? &run_.state.u : nullptr);
  run_.assembly().start_states(!initials.empty() || changes, [&](std::vector<GroupData>& groups) {
    apply_initials(run_.model, {stage, activity.group}, initials, water ? &*water : nullptr, groups, warnings);
    if (changes) apply_drainage(run_.model, stage, groups);
  });
  run_.warn(warnings.list());
}

// The tangent of laws that depend on time is that of the first increment, where they have an answer for it; the forces
// are those at its start.
void StageStart::evaluate() {
  Assembly& assembly = run_.assembly();
  const double increment = run_.end_of({run_.state.place.stage, 1});
  Tangent* tangent = run_.tangent().current() ? nullptr : &run_.tangent();
  if (assembly.wants_step_time() && tangent != nullptr) {
    run_.set_step_time(increment, increment);
    if (assembly.evaluate(run_.state.du, tangent) == Outcome::ok) tangent = nullptr;
  }
  run_.set_step_time(0.0, 0.0);
  if (assembly.evaluate(run_.state.du, tangent) == Outcome::cut_step)
    throw AnalysisError("S503", "stage " + std::to_string(run_.state.place.stage + 1) +
                                    ": a law cannot start from the state it is given");
}

void StageStart::find_loads(int stage) {
  RunState& state = run_.state;
  StagePath& path = state.path;
  path.force_start = run_.assembly().internal_force();
  path.force_end = external_force(run_.model, stage);
  path.external_start = state.external;
  const std::optional<PorePressure> water = run_.water_at(stage, run_.system.activity(), &state.u);
  begin_water(stage, water ? &*water : nullptr);
  let_in_what_came(stage);
  path.u_start.resize(0);
  if (run_.assembly().eliminated().dofs().empty()) return;
  path.u_start = state.u;
  run_.assembly().set_stage_loads(path.force_end - path.force_start);
}

// The pore pressure at points goes from its last value to that of the stage.  What starts with stress has the pressure of
// the stage from its start: its effective stress is that beside this pressure.
void StageStart::begin_water(int stage, const PorePressure* water) {
  Assembly& assembly = run_.assembly();
  StagePath& path = run_.state.path;
  path.water_force.resize(0);
  if (water == nullptr) return;
  const std::size_t groups = assembly.groups().size();
  path.pore_start.assign(groups, {});
  path.pore_end.assign(groups, {});
  for (std::size_t g = 0; g < groups; ++g) {
    GroupData& data = assembly.groups()[g];
    if (!data.group->solid()) continue;
    const int points = data.group->element->traits().points;
    std::vector<double>& end = path.pore_end[g];
    for (int e = 0; e < data.group->elements(); ++e)
      for (int p = 0; p < points; ++p) end.push_back(water->at_point(g, e, p));
    if (data.pore.empty()) data.pore.assign(end.size(), 0.0);
    path.pore_start[g] = begins_with_stress(stage, g) ? end : data.pore;
  }
  path.water_force = water_of(run_.model, run_.system.activity(), water);
  path.force_end += path.water_force;
  run_.set_water(0.0);
}

bool StageStart::begins_with_stress(int stage, std::size_t group) const {
  const int g = static_cast<int>(group);
  const Stage& here = run_.model.stages[stage];
  const auto stated = [&](const InitialStress& initial) {
    return initial.group == g && states_stress(initial.kind);
  };
  const bool active_from_here = stage == 0 || std::ranges::find(here.births, g) != here.births.end();
  return (stage == 0 && std::ranges::any_of(run_.model.initials, stated)) ||
         std::ranges::any_of(here.initials, stated) ||
         (active_from_here && has_own_stress(run_.model, run_.model.groups[group]));
}

void StageStart::note_imbalance(int stage) {
  const StagePath& path = run_.state.path;
  const InitialImbalance imbalance =
      initial_imbalance(run_.model, run_.system.activity(), stage, path.force_start, path.force_end);
  if (!imbalance.counts()) return;
  run_.observer_list.warn(
      stage_message(run_.stage(), "S528", explain_imbalance(run_.model, stage, imbalance), Severity::note));
}

}  // namespace sage
