// The active elements whose law is asked in every pass.
#pragma once

#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"

namespace sage {

class Tangent;

class ChangingRegion {
 public:
  // All arguments must outlive it.
  ChangingRegion(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);

  void size_forces(int dofs) { forces_.setZero(dofs); }

  // Internal forces at committed state + du.  With a tangent, within Tangent::assemble, matrices too.
  Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent);

  // Every dof; no size where no group is of this kind.
  const Eigen::VectorXd& forces() const { return forces_; }
  const FieldSums& sums() const { return sums_; }

 private:
  Outcome evaluate_by_four(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);
  Outcome evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);

  std::vector<GroupData>* groups_;
  ElementWork* element_;
  WorkCounters* work_;
  Eigen::VectorXd forces_;
  FieldSums sums_{};
};

}  // namespace sage
