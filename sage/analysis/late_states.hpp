// The skip 'states': stress and strain of constant groups are computed where an output asks for them.
#pragma once

#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"
#include "sage/core/archive.hpp"

namespace sage {

class LateStates {
 public:
  // The displacement since the states were last up to date, every dof.
  explicit LateStates(int dofs) { behind_.setZero(dofs); }

  // A step was committed.
  void move(const Eigen::VectorXd& du) {
    behind_ += du;
    is_behind_ = true;
  }
  bool behind() const { return is_behind_; }
  // Brings the states of active constant groups up to date, and makes their room where there was none.
  void recover(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);
  void exchange(Archive& archive) {
    archive(behind_);
    archive(is_behind_);
  }

 private:
  Eigen::VectorXd behind_;
  bool is_behind_ = false;
};

}  // namespace sage
