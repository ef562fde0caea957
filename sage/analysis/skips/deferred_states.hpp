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
  // structures: some group is one.  seeps: in some group water flows.
  DeferredStates(bool structures, bool seeps) : has_structures_(structures), seeps_(seeps) {}

  // A step was committed.
  void move(const Eigen::VectorXd& du) {
    add(du, others_);
    if (has_structures_) add(du, structures_);
    is_behind_ = true;
  }
  // before: where water flows, the unknowns at the start of the step.
  void move(const Eigen::VectorXd& du, const Eigen::VectorXd& before, const StepTime& time) {
    if (seeps_) seep(du, before, time);
    move(du);
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
    if (seeps_) archive(start_);
    if (seeps_) archive(seepage_);
  }

 private:
  static void add(const Eigen::VectorXd& du, Eigen::VectorXd& sum) {
    if (sum.size() == 0) sum.setZero(du.size());
    sum += du;
  }

  void seep(const Eigen::VectorXd& du, const Eigen::VectorXd& before, const StepTime& time);
  void bring_up_to_date(GroupData& data, const Eigen::VectorXd& behind, const ElementWork& element,
                        WorkCounters& work, int threads) const;

  Eigen::VectorXd others_, structures_;  // the displacement since then, every dof; no entries: nothing moved
  // Where water flows: the unknowns then, and the integral over the time since of those that steps have let flow.
  Eigen::VectorXd start_, seepage_;
  bool has_structures_ = false, seeps_ = false, is_behind_ = false;
};

}  // namespace sage
