// The skip 'states': stress and strain of constant groups are computed where an output needs them.
#pragma once

#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"
#include "sage/core/archive.hpp"

namespace sage {

// Structures have a motion of their own: tables of their forces are written where no output needs the soil.
class DeferredStates {
 public:
  // structures: some group is one.
  explicit DeferredStates(bool structures) : has_structures_(structures) {}

  // A step was committed.
  void move(const Eigen::VectorXd& du) {
    add(du, others_);
    if (has_structures_) add(du, structures_);
    is_behind_ = true;
  }
  bool behind() const { return is_behind_; }
  // Brings the states of active constant groups up to date, and allocates them at the first call.  Large groups use so many
  // threads; results do not depend on it.
  void recover(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work, int threads);
  // The same of structures alone.
  void recover_structures(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);
  void exchange(Archive& archive) {
    archive(others_);
    archive(is_behind_);
    if (has_structures_) archive(structures_);
  }

 private:
  static void add(const Eigen::VectorXd& du, Eigen::VectorXd& sum) {
    if (sum.size() == 0) sum.setZero(du.size());
    sum += du;
  }

  Eigen::VectorXd others_, structures_;  // the displacement since then, every dof; no entries: nothing moved
  bool has_structures_ = false, is_behind_ = false;
};

}  // namespace sage
