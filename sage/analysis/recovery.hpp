// Forces, displacements and states that steps do not compute, and their recovery.
#pragma once

#include <Eigen/Core>

namespace sage {

// The answers where every step computes all of them.
class Recovery {
 public:
  Recovery() = default;
  Recovery(const Recovery&) = delete;
  Recovery& operator=(const Recovery&) = delete;
  virtual ~Recovery() = default;

  // Forces and displacements of eliminated dofs are those of an earlier step.
  virtual bool is_behind() const { return false; }
  // The step in hand will not be committed.
  virtual void drop_step() {}
  // Then, where dofs are behind: recovers them at the committed state u, whose loads are `target`, at that load factor of
  // the stage, which started with the unknowns `start`.
  virtual void catch_up(const Eigen::VectorXd& /*target*/, double /*load_factor*/,
                        const Eigen::VectorXd& /*start*/, Eigen::VectorXd& /*u*/) {}
  // The committed state as if it were recovered: the motion that eliminated dofs still lack, and internal forces.  A copy:
  // it changes nothing in the run.  After the commit of the step in hand.
  virtual void show_recovered(Eigen::VectorXd& /*motion*/, Eigen::VectorXd& /*forces*/) {}
  // Recovers states that are not computed in every step: at the committed state plus that motion, ...
  virtual void recover_states_at(const Eigen::VectorXd& /*motion*/) {}
  // ... and for good at the committed state.  Before the first call, stress and strain of such groups may not be allocated.
  virtual void recover_states() {}
  // The same for structures alone.
  virtual void recover_structures() {}
};

}  // namespace sage
