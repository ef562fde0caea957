#include "sage/analysis/stage_groups.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "sage/analysis/shown_status.hpp"

namespace sage {

namespace {

// Dofs and fields of elements with unknowns of their own.
void list_dofs(GroupData& data, const DofMap& dof_map) {
  if (data.group->entry->unknowns.empty()) return;
  std::vector<int> dofs;
  for (int e = 0; e < data.group->elements(); ++e) {
    dof_map.list(*data.group, e, dofs);
    if (dofs.size() != data.dofs())
      throw std::logic_error(data.group->element_name + ": its entry lists " + std::to_string(dofs.size()) +
                             " unknowns, its traits have " + std::to_string(data.dofs()) + " dofs");
    data.dof_list.insert(data.dof_list.end(), dofs.begin(), dofs.end());
  }
  for (const int dof : dofs) data.field_of_dof.push_back(dof_map.at(dof).field);
}

// Which elements the prescribed motion of a stage reaches.
void mark_moved(GroupData& data, const Eigen::VectorXd& rate) {
  const auto elements = static_cast<std::size_t>(data.group->elements());
  data.moved.assign(elements, 0);
  for (std::size_t e = 0; e < elements; ++e) {
    const ElementDofs dofs = data.dofs_of(static_cast<int>(e));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (rate[dofs[i]] != 0.0) data.moved[e] = 1;
  }
}

}  // namespace

StageGroups::StageGroups(const Model& model, const Scene& scene, const Prepare& prepare)
    : model_(&model), scene_(&scene), dof_map_(model) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    GroupData data(model.groups[g]);
    data.law = model.material_of(model.groups[g]).law_ref();
    data.second_law = model.second_law_of(model.groups[g]);
    data.wants_context = wants_context(data.law);
    data.sees_spread = sees_spread_loads(*data.group, data.law);
    list_dofs(data, dof_map_);
    if (prepare) prepare(data, g);
    groups_.push_back(std::move(data));
    reset_group(g);
  }
}

void StageGroups::reset_group(std::size_t group) {
  GroupData& data = groups_[group];
  const ElementTraits& traits = data.group->element->traits();
  data.state = StateStore(static_cast<std::size_t>(data.group->elements() * traits.points), traits.law_size,
                          history_of(data.law, traits), !data.constant);
}

void StageGroups::take_laws() {
  for (GroupData& data : groups_) {
    data.law = model_->material_of(*data.group).law_ref();
    data.second_law = model_->second_law_of(*data.group);
  }
}

void StageGroups::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].active = activity.group[g] != 0;
    if (groups_[g].active) mark_moved(groups_[g], rate);
  }
  equations_.number(*model_, activity);
  number_elements();
}

void StageGroups::number_elements() {
  elements_ = 0;
  for (GroupData& data : groups_) {
    if (!in_system(data)) continue;
    data.first_element = elements_;
    elements_ += data.group->elements();
  }
}

ElementEquations StageGroups::element_equations() const {
  ElementEquations list;
  std::size_t terms = 0;
  for (const GroupData& data : groups_)
    if (in_system(data)) terms += static_cast<std::size_t>(data.group->elements()) * data.dofs();
  list.equations.reserve(terms);
  list.offset.reserve(static_cast<std::size_t>(elements_) + 1);
  for (const GroupData& data : groups_)
    if (in_system(data)) append_equations(data, equations_.of_dofs(), list);
  if (model_->has_pores())
    for (int eq = 0; eq < equations(); ++eq) {
      const auto field = static_cast<std::size_t>(dof_map_.at(dof_of(eq)).field);
      list.pressure.push_back(model_->unknowns[field].of_pores ? 1 : 0);
    }
  return list;
}

ElementCombinations StageGroups::combine(ElementEquations& list) const {
  ElementCombinations all;
  if (!equations_.combine()) return all;
  std::vector<int> dofs;
  int* own = list.equations.data();
  for (const GroupData& data : groups_) {
    if (!in_system(data)) continue;
    for (int e = 0; e < data.group->elements(); ++e) {
      const ElementDofs of_element = data.dofs_of(e);
      dofs.clear();
      for (std::size_t i = 0; i < of_element.size(); ++i) dofs.push_back(of_element[i]);
      all.add(equations_, dofs, own);
      own += dofs.size();
    }
  }
  return all;
}

void StageGroups::exchange(Archive& archive, bool before_step) {
  for (GroupData& data : groups_) exchange_states(data, archive, before_step);
}

void StageGroups::exchange_states(GroupData& data, Archive& archive, bool before_step) {
  const bool trial = before_step && data.active && !data.constant && !archive.reading();
  PointStates& states = trial ? data.state.trial : data.state.committed;
  archive(states.sigma);
  archive(states.eps);
  archive(states.h);
  archive(states.status);
}

std::array<long, kStatuses> StageGroups::count_points() const {
  std::array<long, kStatuses> counts{};
  for (const GroupData& data : groups_) {
    if (!data.active) continue;
    for (std::size_t p = 0; p < data.state.committed.status.size(); ++p)
      ++counts[static_cast<std::size_t>(shown_status(model_->mesh, data, p))];
  }
  return counts;
}

}  // namespace sage
