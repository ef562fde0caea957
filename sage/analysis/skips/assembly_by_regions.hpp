// The skips 'factors', 'elements' and 'states' in a pass over the elements.  Active groups form two regions: changing ones, whose
// laws are evaluated, and constant ones, whose forces are K u.
#pragma once

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/skips/changing_region.hpp"
#include "sage/analysis/skips/constant_region.hpp"
#include "sage/analysis/skips/deferred_states.hpp"

namespace sage {

class AssemblyByRegions : public Assembly {
 public:
  // All arguments but the skips must outlive it.
  AssemblyByRegions(const Model& model, const Scene& scene, const Skips& skips, WorkCounters& work);

  void set_threads(int threads) override;
  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate) override;
  using Assembly::enter_stage;
  void take_laws() override;
  bool keeps_factors() const override { return skips_.factors; }
  Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent) override;
  void commit(const Eigen::VectorXd& du) override;
  void commit_again(const Eigen::VectorXd& du) override;
  void recover_states() override { deferred_.recover(groups_, element_, *work_, threads()); }
  void recover_structures() override { deferred_.recover_structures(groups_, element_, *work_); }
  void exchange(Archive& archive, bool before_step) override;

 protected:
  bool begin_states(bool any) override;
  void end_states() override { constant_.take_states(); }
  // The last evaluation has the forces of constant groups.
  virtual bool has_constant_forces() const { return true; }
  // All kept matrices into the tangent (those of other groups are added as they are made).
  virtual void fill(Tangent& tangent) const;
  // to: forces of all elements.
  virtual void add_constant(const Eigen::VectorXd& du, Eigen::VectorXd& to);
  // Forces and matrices of the groups that are not constant, and all kept matrices.
  Outcome evaluate_changing(const Eigen::VectorXd& du, Tangent* tangent);
  void commit_changing();
  void commit_constant();

  Skips skips_;
  ChangingRegion changing_;
  ConstantRegion constant_;
  DeferredStates deferred_;

 private:
  bool constant_groups_change(const Activity& activity) const;
  void make_room_for_matrices(std::size_t group);
};

}  // namespace sage
