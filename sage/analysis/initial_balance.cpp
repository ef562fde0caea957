#include "sage/analysis/initial_balance.hpp"

#include <algorithm>
#include <optional>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/external_loads.hpp"
#include "sage/analysis/initial_states.hpp"

namespace sage {

namespace {

// Groups that begin with stress in this stage.
std::vector<char> stressed_groups(const Model& model, const Activity& activity, int stage) {
  const Stage& now = model.stages[stage];
  std::vector<char> flags(model.groups.size(), 0);
  const auto mark = [&](const InitialStress& initial) {
    if (is_about_law(initial.kind) || initial.kind == InitialKind::history ||
        initial.kind == InitialKind::lock_off)
      return;
    const auto g = static_cast<std::size_t>(initial.group);
    flags[g] = initial.kind != InitialKind::zero && activity.group[g];
  };
  const auto begins = [&](int group) {
    return stage == 0 || std::find(now.births.begin(), now.births.end(), group) != now.births.end();
  };
  for (std::size_t g = 0; g < flags.size(); ++g)
    flags[g] = activity.group[g] && begins(static_cast<int>(g)) && has_own_stress(model, model.groups[g]);
  for (const InitialStress& initial : model.initials)
    if (begins(initial.group)) mark(initial);
  for (const InitialStress& initial : now.initials) mark(initial);
  return flags;
}

void mark_nodes(const Group& group, char flag, std::vector<char>& nodes) {
  for (const int node : group.nodes) nodes[node] = flag;
}

}  // namespace

InitialImbalance initial_imbalance(const Model& model, const Activity& activity, int stage,
                                   const Eigen::VectorXd& internal, const Eigen::VectorXd& external) {
  InitialImbalance worst;
  const Stage& now = model.stages[stage];
  const std::vector<char> stressed = stressed_groups(model, activity, stage);
  if (std::none_of(stressed.begin(), stressed.end(), [](char flag) { return flag != 0; })) return worst;
  std::vector<char> looked_at(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (std::size_t g = 0; g < stressed.size(); ++g)
    if (stressed[g]) mark_nodes(model.groups[g], 1, looked_at);
  for (std::size_t g = 0; stage > 0 && g < stressed.size(); ++g)  // what was there before takes a new load
    if (activity.group[g] && !stressed[g]) mark_nodes(model.groups[g], 0, looked_at);
  for (const int g : now.deaths) mark_nodes(model.groups[g], 0, looked_at);
  for (const Fixity& f : now.fixities)
    if (stage > 0 && (f.code[0] == FixityCode::released || f.code[1] == FixityCode::released))
      looked_at[f.node] = 0;
  for (const TurnedFixity& f : now.turned_fixities)
    if (stage > 0) looked_at[f.node] = 0;
  const Eigen::VectorXd added = stage_loads(model, stage, activity);
  for (int dof = 0; dof < activity.dof_map.displacements(); ++dof) {
    if (!looked_at[activity.dof_map.at(dof).node]) continue;
    worst.largest = std::max(worst.largest, std::abs(internal[dof]));
    if (activity.is_constrained(dof)) continue;
    const auto [low, high] = std::minmax({external[dof] - added[dof], external[dof]});
    const double off = internal[dof] - std::clamp(internal[dof], low, high);
    if (worst.dof >= 0 && std::abs(off) <= std::abs(worst.force)) continue;
    worst.dof = dof;
    worst.force = -off;  // what pushes the node once the stress is let go
  }
  return worst;
}

InitialImbalance initial_imbalance(const Model& model) {
  if (model.stages.empty()) return {};
  const Stage& first = model.stages.front();
  // A history has no forces, but the law may refuse it.
  const auto stressed = [](const InitialStress& initial) {
    return states_stress(initial.kind) || initial.kind == InitialKind::history;
  };
  if (!std::ranges::any_of(model.initials, stressed) && !std::ranges::any_of(first.initials, stressed) &&
      !has_own_start(model))
    return {};
  const Scene scene = analyse_scene(model);
  WorkCounters work;
  const std::unique_ptr<Assembly> owned = make_assembly(model, scene, {}, work);
  Assembly& assembly = *owned;
  Activity activity(model);
  activity.enter(first);
  assembly.enter_stage(activity, prescribed_rate(first, activity.dof_map));
  Diagnostics refused;  // the run tells of it
  std::optional<PorePressure> water;
  if (!model.water.empty()) water.emplace(model, 0, activity.group, activity.dof_map, nullptr);
  const PorePressure* const pressed = water ? &*water : nullptr;
  assembly.start_states(true, [&](std::vector<GroupData>& groups) {
    apply_own_starts(model, groups);
    for (const std::vector<InitialStress>* list : {&model.initials, &first.initials})
      apply_initials(model, {0, activity.group}, *list, pressed, groups, refused);
  });
  if (assembly.evaluate(Eigen::VectorXd::Zero(activity.dof_map.dofs()), nullptr) == Outcome::cut_step)
    return {};
  return initial_imbalance(model, activity, 0, assembly.internal_force(),
                           external_force(model, 0) + water_of(model, activity, pressed));
}

std::string explain_imbalance(const Model& model, int stage, const InitialImbalance& imbalance) {
  if (!imbalance.counts()) return {};
  const Stage& now = model.stages[stage];
  const std::string share = imbalance.largest > 0.0
                                ? short_number(100.0 * std::abs(imbalance.force) / imbalance.largest) +
                                      " % of the largest force that it puts on a node"
                                : "it puts no force on any node itself";
  return "the initial stress is out of balance by up to " + short_number(std::abs(imbalance.force)) + " " +
         model.units.force + " (" + share + ") at " + unknown_name(model, DofMap(model).at(imbalance.dof)) +
         "; what is not balanced is let go in proportion over the " +
         (now.increments == 1 ? "one increment" : std::to_string(now.increments) + " increments") +
         " of the stage";
}

}  // namespace sage
