// The active elements whose law is evaluated in every pass.
#pragma once

#include <memory>
#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"
#include "sage/analysis/skips/four_abreast.hpp"
#include "sage/platform/thread_pool.hpp"

namespace sage {

class Tangent;

class ChangingRegion {
 public:
  // All arguments must outlive it.
  ChangingRegion(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);

  void size_forces(int dofs) { forces_.setZero(dofs); }
  // Passes over large groups may use so many threads.  Results do not depend on it, to the last bit.
  void set_threads(int threads);

  // Internal forces at committed state + du.  With a tangent, within Tangent::assemble, matrices too.
  Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent);
  // Adds the matrices that a group keeps of its elements.
  void add_kept(const GroupData& data, Tangent& tangent) const;

  // Every dof; no size where no group is of this kind.
  const Eigen::VectorXd& forces() const { return forces_; }
  const FieldSums& sums() const { return sums_; }

 private:
  struct Block {
    int first, last;  // elements of a group, the last one not among them
  };
  bool divides(const GroupData& data) const;
  Outcome evaluate_four_abreast(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);
  Outcome evaluate_in_units(GroupData& data, const PassFourAbreast& pass, Tangent* tangent);
  Outcome evaluate_on_threads(GroupData& data, const PassFourAbreast& pass, Tangent* tangent);
  Outcome evaluate_and_add(GroupData& data, const PassFourAbreast& pass, Tangent& tangent);
  Outcome evaluate_unit(GroupData& data, const PassFourAbreast& pass, int first, double* f, bool with_K,
                        bool& changed) const;
  Outcome evaluate_one_by_one(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);
  Outcome evaluate_in_turn(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);
  Outcome evaluate_side_by_side(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);
  Outcome evaluate_block(GroupData& data, const Eigen::VectorXd& du, Block block, bool with_K, bool& changed);
  // K: of the block's elements, one after the other.
  void add_matrices(const GroupData& data, Block block, const double* K, Tangent& tangent) const;
  void add_forces(const GroupData& data, int first, int last, const double* f);

  std::vector<GroupData>* groups_;
  ElementWork* element_;
  WorkCounters* work_;
  std::unique_ptr<ThreadPool> pool_;  // none: one thread
  std::vector<ElementWork> own_;      // buffers of each thread
  Eigen::VectorXd forces_;
  FieldSums sums_{};
  std::vector<double> element_forces_, element_matrices_;  // work space
};

}  // namespace sage
