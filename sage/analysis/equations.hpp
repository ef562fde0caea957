// Which equation a dof has in a stage.
#pragma once

#include <utility>
#include <vector>

#include "sage/model/active_dofs.hpp"

namespace sage {

class Equations {
 public:
  // One for every dof that an active element has and no support holds, by number of the dof.
  void number(const Model& model, const Activity& activity) {
    const DofMap& map = activity.dof_map;
    used_ = active_dofs(model, activity);
    std::vector<int> dofs;
    for (int dof = 0; dof < map.dofs(); ++dof)
      if (in_use(dof) && !activity.held[dof]) dofs.push_back(dof);
    take_only(std::move(dofs), static_cast<std::size_t>(map.dofs()));
  }
  // Those of the other dofs leave the system.
  void keep(std::vector<int> dofs) { take_only(std::move(dofs), of_dof_.size()); }

  int count() const { return static_cast<int>(dofs_.size()); }
  const std::vector<int>& dofs() const { return dofs_; }       // of each equation
  const std::vector<int>& of_dofs() const { return of_dof_; }  // of each dof; -1 = none
  int of(int dof) const { return of_dof_[dof]; }
  int dof(int equation) const { return dofs_[equation]; }
  // False: no active element has this dof.
  bool in_use(int dof) const { return used_[dof] != 0; }

 private:
  void take_only(std::vector<int> dofs, std::size_t all) {
    dofs_ = std::move(dofs);
    of_dof_.assign(all, -1);
    for (std::size_t eq = 0; eq < dofs_.size(); ++eq) of_dof_[dofs_[eq]] = static_cast<int>(eq);
  }

  std::vector<char> used_;  // one flag per dof
  std::vector<int> dofs_, of_dof_;
};

}  // namespace sage
