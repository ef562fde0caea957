// The skip 'elements': groups of linear laws whose matrices are computed once, one for all congruent elements.  Their
// forces are K u, and no law is evaluated.
#pragma once

#include <memory>
#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"
#include "sage/platform/thread_pool.hpp"

namespace sage {

class ConstantRegion {
 public:
  // All arguments must outlive it.
  ConstantRegion(const Model& model, std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);

  // Matrices of large groups are computed on so many threads.
  void set_threads(int threads);

  // The elements solve for displacements only, and K u keeps the digits that B u has.
  static bool suits(const Group& group, const LawRef& law);

  // K of every shape of a group's elements (shapes_of).
  void make_matrices(GroupData& data, const std::vector<int>& shapes);
  // The forces that belong to committed states which were set from outside.
  void take_states();

  // Adds the internal forces at committed state + du.
  void add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& to);
  const FieldSums& sums() const { return sums_; }  // in the last such pass
  void set_sums(const FieldSums& sums) { sums_ = sums; }
  // Adds those at the committed state.
  void add_committed_forces(Eigen::VectorXd& to) const;

 private:
  void make_shifts(GroupData& data, int matrices) const;
  void add_group(GroupData& data, const Eigen::VectorXd& du, Eigen::VectorXd& to);
  void make_force(GroupData& data, int e, const Eigen::VectorXd& du, double* u) const;

  const Model* model_;
  std::vector<GroupData>* groups_;
  ElementWork* element_;
  WorkCounters* work_;
  FieldSums sums_{};
  std::unique_ptr<ThreadPool> pool_;       // none where no group is large
  std::vector<std::vector<double>> room_;  // for the unknowns of an element, of each thread
};

}  // namespace sage
