#include "sage/analysis/run_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sage/analysis/external_loads.hpp"

namespace sage {

// Loads and forces of the moved edges.
Solution RunParts::solution() const {
  const Eigen::VectorXd *internal = &assembly().internal_force(), *external = &state.external;
  if (assembly().load_change().size() > 0) {
    state.moved_internal = *internal + assembly().load_change();
    state.moved_external = *external + assembly().load_change();
    internal = &state.moved_internal;
    external = &state.moved_external;
  }
  return {&state.u, internal, external, &assembly(), &system.activity(), {}, state.place.stage, load_share()};
}

void RunParts::warn(const std::vector<Diagnostic>& list) const {
  for (const Diagnostic& diagnostic : list) observer_list.warn(diagnostic);
}

void RunParts::set_step_time(double load_factor, double share) const {
  if (assembly().wants_step_time()) assembly().set_step_time(step_time(state.place, load_factor, share));
}

StepTime RunParts::step_time(const RunPlace& place, double load_factor, double share) const {
  constexpr double kRounding = 1e-5;
  const PorePath& pores = state.path.pores;
  const bool planned = std::abs(share - pores.theta_share) <= kRounding * pores.theta_share;
  StepTime time = step_time_at(model, place.stage, place.increment, load_factor,
                               planned ? pores.theta_share : share, state.easing);
  time.time -= state.early;
  time.stage_start -= state.early;
  if (pores.theta_share > 0.0) time.theta = planned ? pores.theta : 1.0;
  return time;
}

void RunParts::set_water(double load_factor) const {
  const StagePath& path = state.path;
  for (std::size_t g = 0; g < path.pore_end.size(); ++g) {
    std::vector<double>& now = assembly().groups()[g].pore;
    for (std::size_t p = 0; p < path.pore_end[g].size(); ++p)
      now[p] = (1.0 - load_factor) * path.pore_start[g][p] + load_factor * path.pore_end[g][p];
  }
}

std::optional<PorePressure> RunParts::water_at(int stage, const Activity& activity,
                                               const Eigen::VectorXd* u) const {
  std::optional<PorePressure> water;
  if (!model.water.empty()) water.emplace(model, stage, activity.group, activity.dof_map, u);
  return water;
}

double RunParts::end_of(const RunPlace& place) const {
  const Stage& stage_of_place = model.stages[place.stage];
  const int increments = stage_of_place.increments;
  if (settings.time_scheme == nullptr && !stage_of_place.ends.empty())
    return place.increment == 0 ? 0.0 : stage_of_place.ends[place.increment - 1];
  if (settings.time_scheme == nullptr)
    return GradedIncrements(stage_of_place.grading).load_factor(place.stage, place.increment, increments);
  if (place.increment == 0) return 0.0;
  const double end = settings.time_scheme->load_factor(place.stage, place.increment, increments);
  const bool is_last = place.increment == increments;
  if (is_last ? end != 1.0 : !(end > end_of({place.stage, place.increment - 1}) && end < 1.0))
    throw std::logic_error("the load factors of a time scheme do not increase from 0 to 1");
  return end;
}

Eigen::VectorXd RunParts::loads_at(double load_factor) const {
  Eigen::VectorXd loads = (1.0 - load_factor) * state.path.force_start + load_factor * state.path.force_end;
  add_histories(load_factor, loads);
  return loads;
}

void RunParts::add_histories(double load_factor, Eigen::VectorXd& loads) const {
  const Stage& now = stage();
  if (now.has_mechanical_histories()) {
    const Eigen::VectorXd force = table_loads(model, state.place.stage, system.activity(), load_factor);
    for (Eigen::Index dof = 0; dof < force.size(); ++dof)
      if (assembly().in_use(static_cast<int>(dof))) loads[dof] += force[dof];
  }
  for (const FieldLoad& load : now.field_loads) {
    const int dof = load.history.empty() ? -1 : system.activity().dof_map.of(load.node, load.field);
    if (dof >= 0 && assembly().in_use(dof))
      loads[dof] += added_at(load, load_factor, now.duration) - load_factor * added_at(load, 1.0, now.duration);
  }
}

void RunParts::collect_at_exits() const {
  StagePath& path = state.path;
  for (const int dof : system.exits().open_pores(system.activity().held)) {
    const double left = assembly().internal_force()[dof] - state.external[dof];
    for (Eigen::VectorXd* load :
         {&state.external, &path.external_start, &path.force_start, &path.force_end, &path.let_in})
      (*load)[dof] += left;
  }
}

std::string RunParts::keep_state() const {
  Archive archive;
  state.exchange_totals(archive);
  assembly().exchange(archive, false);
  return archive.take();
}

void RunParts::restore_state(const std::string& kept) const {
  Archive archive(kept);
  state.exchange_totals(archive);
  assembly().exchange(archive, false);
  state.du.setZero();
  tangent().forget();
}

void RunParts::show_progress(const StepReport& report, double load_factor) const {
  Pulse* const pulse = settings.pulse;
  if (pulse == nullptr) return;
  double all = 0.0, before = 0.0;
  for (int s = 0; s < static_cast<int>(model.stages.size()); ++s) {
    const int increments = model.stages[s].increments;
    all += increments;
    if (s < report.stage) before += increments;
  }
  pulse->share = (before + load_factor * report.increments) / all;
  pulse->stage = report.stage + 1;
  pulse->stages = static_cast<int>(model.stages.size());
  pulse->increment = report.increment;
  pulse->increments = report.increments;
  pulse->iterated(0, std::numeric_limits<double>::quiet_NaN());
}

bool is_flow_alone(const Model& model) {
  return !model.groups.empty() && std::ranges::all_of(model.groups, [](const Group& group) {
    return group.entry != nullptr && group.flow();
  });
}

}  // namespace sage
