// The groups of a model with the states of their points, and the equations of a stage.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "sage/analysis/equations.hpp"
#include "sage/analysis/group_data.hpp"
#include "sage/analysis/records.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/core/archive.hpp"

namespace sage {

class StageGroups {
 public:
  virtual ~StageGroups() = default;

  const Scene& scene() const { return *scene_; }
  std::vector<GroupData>& groups() { return groups_; }
  const std::vector<GroupData>& groups() const { return groups_; }

  // Equations and element order of a stage.  rate: displacement of every prescribed dof over the stage.
  virtual void enter_stage(const Activity& activity, const Eigen::VectorXd& rate);
  const DofMap& dof_map() const { return dof_map_; }
  int equations() const { return equations_.count(); }
  int equation_of(int dof) const { return equations_.of(dof); }
  int dof_of(int equation) const { return equations_.dof(equation); }
  const Equations& numbering() const { return equations_; }
  // False: no active element has the node of this dof.
  bool in_use(int dof) const { return equations_.in_use(dof); }
  // Of the elements of the system.
  virtual ElementEquations element_equations() const;
  // ... whose matrices are combined before they go there; `list` is without the equations that others stand for.
  ElementCombinations combine(ElementEquations& list) const;

  // A group is activated: free of stress, with its first history.
  void reset_group(std::size_t group);
  // The laws of the model's materials have been replaced, each by one of the same kind: same history, same stiffness as
  // long as nothing yields.
  virtual void take_laws();
  // Sets committed states from outside (initial stress): `set` gets all groups.  any: it will set some.
  template <class Set>
  void start_states(bool any, Set set) {
    if (!begin_states(any)) return;
    set(groups_);
    end_states();
  }
  // States of all groups and what goes with them.  before_step: those of active groups as they were before the
  // last commit (reading gives them back as committed).
  virtual void exchange(Archive& archive, bool before_step);
  std::array<long, kStatuses> count_points() const;  // committed states of active groups

 protected:
  // What a group is besides, before its states are allocated.
  using Prepare = std::function<void(GroupData&, std::size_t group)>;
  // All but `prepare` must outlive it.
  StageGroups(const Model& model, const Scene& scene, const Prepare& prepare);

  virtual bool in_system(const GroupData& data) const { return data.active; }
  virtual bool begin_states(bool /*any*/) { return true; }
  virtual void end_states() {}
  void number_elements();
  static void exchange_states(GroupData& data, Archive& archive, bool before_step);

  const Model* model_;
  const Scene* scene_;
  DofMap dof_map_;
  std::vector<GroupData> groups_;
  Equations equations_;
  int elements_ = 0;  // of the system
};

}  // namespace sage
