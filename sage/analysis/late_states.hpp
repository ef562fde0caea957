// The skip 'states': stress and strain of constant groups are computed where an output asks for them.
#pragma once

#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"
#include "sage/core/archive.hpp"

namespace sage {

// Structures have a date of their own: tables of their forces are asked for where nobody looks at the soil.
class LateStates {
 public:
  // The displacement since the states were last up to date, every dof.
  // structures: some group is one.
  LateStates(int dofs, bool structures) {
    others_.setZero(dofs);
    if (structures) structures_.setZero(dofs);
  }

  // A step was committed.
  void move(const Eigen::VectorXd& du) {
    others_ += du;
    if (structures_.size() > 0) structures_ += du;
    is_behind_ = true;
  }
  bool behind() const { return is_behind_; }
  // Brings the states of active constant groups up to date, and makes their room where there was none.  Large groups
  // take so many threads; answers do not depend on it.
  void recover(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work, int threads);
  // The same of structures alone.
  void recover_structures(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);
  void exchange(Archive& archive) {
    archive(others_);
    archive(is_behind_);
    if (structures_.size() > 0) archive(structures_);
  }

 private:
  Eigen::VectorXd others_, structures_;
  bool is_behind_ = false;
};

}  // namespace sage
