// The skip 'elements': groups of linear laws whose matrices are computed once, one for all congruent elements.  Their
// forces are K u, and no law is evaluated.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/records.hpp"
#include "sage/core/archive.hpp"
#include "sage/platform/thread_pool.hpp"

namespace sage {

// Of a constant group whose K depends on the step of consolidation: what flows in a unit of time from the pressures of an element,
// which are its last unknowns; a matrix of pressures^2 for each that the group keeps.  Those are K where no water moves.
struct PoreFlow {
  std::size_t pressures = 0;  // of an element; 0 = K is that of all steps
  std::vector<double> flow;

  const double* of(const GroupData& data, int element) const {
    return flow.data() + static_cast<std::size_t>(data.matrix[element]) * pressures * pressures;
  }
};

class ConstantRegion {
 public:
  // All arguments must outlive it.
  ConstantRegion(const Model& model, std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work);

  // Matrices of large groups are computed on so many threads.
  void set_threads(int threads);

  // The elements solve for displacements only, and K u keeps the digits that B u has.
  static bool suits(const Group& group, const LawRef& law);
  // So, but for the pore pressures of solids that are there in all stages: matrices of a step (has_matrix_of_step).
  static bool suits_in_step(const Model& model, const GroupData& data);

  // K of every shape of a group's elements (shapes_of).
  void make_matrices(GroupData& data, const std::vector<int>& shapes);
  // The forces that belong to committed states which were set from outside.
  void take_states();
  // Whether matrix_of() gives others than in the step before.
  bool take_step();
  // K of an element in the step in hand; room: for one.
  const double* matrix_of(const GroupData& data, int element, double* room) const;
  // Whether K of this constant group depends on the step.
  bool flows(const GroupData& data) const {
    return data.constant && flows_[&data - groups_->data()].pressures > 0;
  }
  bool any_flows() const {
    return std::ranges::any_of(*groups_, [this](const GroupData& data) { return flows(data); });
  }

  // Adds the internal forces at committed state + du.
  void add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& to);
  const FieldSums& sums() const { return sums_; }  // in the last such pass
  void set_sums(const FieldSums& sums) { sums_ = sums; }
  // A step is committed.  Where water flows, forces depend on the pressures before it.
  void commit(const Eigen::VectorXd& du);
  const Eigen::VectorXd& before_commit() const {
    return u_before_;
  }  // the unknowns; no entries: no water flows
  // before_step: as Assembly::exchange.
  void exchange(Archive& archive, bool before_step);
  // Adds those at the committed state.
  void add_committed_forces(Eigen::VectorXd& to) const;

 private:
  void make_flows(GroupData& data, int matrices);
  void make_shifts(GroupData& data, int matrices) const;
  void add_group(GroupData& data, const Eigen::VectorXd& du, Eigen::VectorXd& to);
  void make_force(GroupData& data, int e, const Eigen::VectorXd& du, double* u) const;
  void add_flow(const GroupData& data, int e, const double* dp, double* f) const;
  PoreFlow& flow_in(const GroupData& data) { return flows_[&data - groups_->data()]; }
  const PoreFlow& flow_in(const GroupData& data) const { return flows_[&data - groups_->data()]; }

  const Model* model_;
  std::vector<GroupData>* groups_;
  ElementWork* element_;
  WorkCounters* work_;
  std::vector<PoreFlow> flows_;   // by group
  Eigen::VectorXd u_, u_before_;  // where water flows: committed unknowns, now and before the last commit
  FieldSums sums_{};
  std::unique_ptr<ThreadPool> pool_;       // none where no group is large
  std::vector<std::vector<double>> room_;  // for the unknowns of an element, of each thread
};

}  // namespace sage
