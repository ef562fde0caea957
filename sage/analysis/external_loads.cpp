#include "sage/analysis/external_loads.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "sage/model/active_dofs.hpp"
#include "sage/model/saturated_weight.hpp"
#include "sage/model/spread_loads.hpp"

namespace sage {

namespace {

// Adds loads of single elements to those of all dofs.
class LoadSum {
 public:
  LoadSum(const Model& model, const DofMap& dof_map, Eigen::VectorXd& force)
      : model_(model), dof_map_(dof_map), force_(force) {}

  // add(x, f): the element's load onto f, which is zero.
  template <class Add>
  void add(const Group& group, int element, Add add_load) {
    element_coordinates(model_.mesh, group, element, x_);
    f_.assign(group.element->traits().dofs, 0.0);
    add_load(x_, f_);
    dof_map_.list(group, element, dofs_);
    for (std::size_t i = 0; i < dofs_.size(); ++i) force_[dofs_[i]] += f_[i];
  }

 private:
  const Model& model_;
  const DofMap& dof_map_;
  Eigen::VectorXd& force_;
  Eigen::Matrix2Xd x_;
  std::vector<double> f_;
  std::vector<int> dofs_;
};

// Of the active groups (a flag each).  share(load): how much of it acts.
template <class Share>
void add_edge_loads(const Model& model, const std::vector<char>& active, const Stage& stage, LoadSum& sum,
                    const Share& share) {
  for (const EdgeLoad& load : stage.pressures) {
    const double acting = active[load.group] ? share(load) : 0.0;
    if (acting == 0.0) continue;
    const Element& element = *model.groups[load.group].element;
    sum.add(model.groups[load.group], load.element, [&](const Eigen::Matrix2Xd& x, std::vector<double>& f) {
      element.edge_load(x, load.edge, acting * load.normal, acting * load.shear, f);
    });
  }
}

// At the stage's end.
void add_edge_loads(const Model& model, const std::vector<char>& active, const Stage& stage, LoadSum& sum) {
  add_edge_loads(model, active, stage, sum,
                 [&](const EdgeLoad& load) { return share_of(load, 1.0, stage.duration); });
}

void add_body_forces(const Model& model, std::size_t g, const Vector2& gravity, int stage, LoadSum& sum) {
  const Group& group = model.groups[g];
  const Vector2 b = gravity * weight_density(model, group);
  for (int e = 0; e < group.elements() && !b.isZero(0.0); ++e)
    sum.add(group, e,
            [&](const Eigen::Matrix2Xd& x, std::vector<double>& f) { group.element->body_load(x, b, f); });
  const WaterCard* const line = gravity.isZero(0.0) ? nullptr : saturating_line(model, stage, g);
  if (line == nullptr) return;
  add_saturation_weight(model, g, *line, gravity, [&](int element, std::span<const double> weight) {
    sum.add(group, element, [&](const Eigen::Matrix2Xd&, std::vector<double>& f) {
      std::copy(weight.begin(), weight.end(), f.begin());
    });
  });
}

// Point loads of a stage, in every field.
void add_point_loads(const Stage& stage, const DofMap& map, Eigen::VectorXd& force) {
  for (const NodalLoad& load : stage.loads)
    force.segment<2>(DofMap::displacement(load.node)) += share_of(load, 1.0, stage.duration) * load.force;
  for (const FieldLoad& load : stage.field_loads)
    force[map.of(load.node, load.field)] += added_at(load, 1.0, stage.duration);
}

void drop_inactive(const std::vector<char>& active, Eigen::VectorXd& force) {
  for (Eigen::Index dof = 0; dof < force.size(); ++dof)
    if (!active[dof]) force[dof] = 0.0;
}

}  // namespace

Eigen::VectorXd weight_of(const Model& model, const std::vector<char>& groups, const Vector2& gravity,
                          int stage) {
  const DofMap map(model);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(map.dofs());
  LoadSum sum(model, map, force);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (groups[g]) add_body_forces(model, g, gravity, stage, sum);
  return force;
}

Eigen::VectorXd external_force(const Model& model, int last) {
  const auto stages = std::span(model.stages).first(static_cast<std::size_t>(last) + 1);
  const auto changes = [](const Stage& stage) { return !stage.births.empty() || !stage.deaths.empty(); };
  const bool lasting = std::none_of(model.stages.begin(), model.stages.end(), changes);
  Activity activity(model);
  std::vector<std::vector<char>> active_groups;  // groups, stage by stage
  Eigen::VectorXd force = Eigen::VectorXd::Zero(activity.dof_map.dofs());
  Vector2 gravity = Vector2::Zero();
  for (const Stage& stage : stages) {
    activity.enter(stage);
    active_groups.push_back(activity.group);
    gravity += stage.gravity;
    add_point_loads(stage, activity.dof_map, force);
    if (!lasting) drop_inactive(active_dofs(model, activity), force);
  }
  // A group is activated once: what it had in the stage of the card and has at the end, it had between.
  LoadSum sum(model, activity.dof_map, force);
  for (std::size_t s = 0; s < active_groups.size(); ++s) {
    std::vector<char>& groups = active_groups[s];
    for (std::size_t g = 0; g < groups.size(); ++g) groups[g] = groups[g] && activity.group[g];
    add_edge_loads(model, groups, stages[s], sum);
  }
  return force + weight_of(model, activity.group, gravity, last);
}

Eigen::VectorXd stage_loads(const Model& model, int stage, const Activity& activity) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(activity.dof_map.dofs());
  const Stage& now = model.stages[stage];
  add_point_loads(now, activity.dof_map, force);
  if (!force.isZero(0.0)) drop_inactive(active_dofs(model, activity), force);
  LoadSum sum(model, activity.dof_map, force);
  add_edge_loads(model, activity.group, now, sum);
  return force;
}

Eigen::VectorXd table_loads(const Model& model, int stage, const Activity& activity, double load_factor) {
  const Stage& now = model.stages[stage];
  Eigen::VectorXd force = Eigen::VectorXd::Zero(activity.dof_map.dofs());
  const auto beside_line = [&](const auto& card) {
    return share_of(card, load_factor, now.duration) - load_factor * share_of(card, 1.0, now.duration);
  };
  for (const NodalLoad& load : now.loads)
    if (!load.history.empty())
      force.segment<2>(DofMap::displacement(load.node)) += beside_line(load) * load.force;
  LoadSum sum(model, activity.dof_map, force);
  add_edge_loads(model, activity.group, now, sum, beside_line);
  return force;
}

Eigen::VectorXd prescribed_rate(const Stage& stage, const DofMap& map) {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(map.dofs());
  for (const Fixity& f : stage.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed)
        rate[DofMap::displacement(f.node, static_cast<int>(c))] = share_of(f, 1.0, stage.duration) * f.value[c];
  for (const FieldFixity& f : stage.field_fixities)
    if (const int dof = map.of(f.node, f.field); dof >= 0 && f.code == FixityCode::fixed)
      rate[dof] = added_at(f, 1.0, stage.duration);
  return rate;
}

// Of the directions that are held each card of the stage moves its own; the others stay.
void add_turned_rate(const Stage& stage, const Activity& activity, Eigen::VectorXd& rate) {
  for (const TurnedNode& node : activity.turned) {
    if (std::ranges::none_of(node.axes, &TurnedNode::Axis::held)) continue;
    const int dof = DofMap::displacement(node.node);
    const Vector2 by_xy = rate.segment<2>(dof);
    rate.segment<2>(dof) = held_motion(stage, node, by_xy);
  }
  for (const std::vector<TiedDof>& set : activity.tied) {
    const auto own = std::ranges::find_if(set, &TiedDof::supported);
    if (own == set.end()) continue;
    const double value = rate[own->dof];
    for (const TiedDof& one : set) rate[one.dof] = value;
  }
}

Eigen::VectorXd supported_values(const Model& model, int stage, const DofMap& map) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(map.dofs());
  for (const Stage& before : std::span(model.stages).first(static_cast<std::size_t>(stage))) {
    values += prescribed_rate(before, map);
    for (const FieldFixity& f : before.field_fixities)
      if (const int dof = map.of(f.node, f.field); dof >= 0 && f.code == FixityCode::released)
        values[dof] = 0.0;
  }
  const Stage& now = model.stages[stage];
  for (const FieldFixity& f : now.field_fixities)
    if (const int dof = map.of(f.node, f.field); dof >= 0 && f.code == FixityCode::fixed)
      values[dof] += added_at(f, 0.0, now.duration);
  return values;
}

Eigen::VectorXd water_of(const Model& model, const Activity& activity, const PorePressure* water) {
  if (water == nullptr || !water->any()) return Eigen::VectorXd::Zero(activity.dof_map.dofs());
  return water_force(model, activity, *water);
}

}  // namespace sage
