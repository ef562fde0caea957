// What a run gives to its outputs: listing, CSV, VTU, pictures, tests.  Observers change nothing.
#pragma once

#include <memory>
#include <span>

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/records.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/core/archive.hpp"

namespace sage {

struct StreamFunction;

// Committed state at the end of an increment.
struct Solution {
  const Eigen::VectorXd* u = nullptr;         // every dof: displacement since the start of the run
  const Eigen::VectorXd* internal = nullptr;  // every dof: internal force
  const Eigen::VectorXd* external = nullptr;  // every dof: applied load
  const Assembly* assembly = nullptr;         // of a run that goes on; null of a state that was kept
  const Activity* activity = nullptr;
  std::span<const GroupData> kept{};                       // without an assembly
  int stage = -1;                                          // from 0; -1 = not known
  double load_factor = 1.0;                                // of the stage
  mutable std::shared_ptr<const StreamFunction> stream{};  // from the first use on

  // Stresses, strains and histories of all points, by Model::groups.
  std::span<const GroupData> groups() const {
    return assembly != nullptr ? std::span<const GroupData>(assembly->groups()) : kept;
  }
};

class Observer {
 public:
  virtual ~Observer() = default;
  virtual void on_warning(const Diagnostic&) {}
  virtual void on_start(const Model&, const Scene&, std::string_view /*solver*/, int /*equations*/) {}
  // The state before the first increment of a stage: initial stress, activation and removal are done.
  virtual void on_stage_start(const Model&, int /*stage*/, const Solution&) {}
  virtual void on_increment(const Model&, const StepReport&, const Solution&) {}
  // Whether the observer reads stresses and strains after this increment (0: at the start of the stage; the last: at its
  // end, too).  Those of linear elements are up to date only then, and after a failure.
  virtual bool wants_states(const Model&, const StepReport&) const { return true; }
  // For observers that do not: whether they read stresses of structures.
  virtual bool wants_structures(const Model&, const StepReport&) const { return false; }
  // Whether it reads displacements or forces of a flagged node (one flag per node) after this increment.  An observer that
  // returns false finds values of an earlier increment there; the last increment of a stage is always up to date.
  virtual bool wants_nodes(const Model&, const StepReport&, std::span<const char> /*behind*/) const {
    return true;
  }
  virtual void on_stage_end(const Model&, int /*stage*/, const EquilibriumAudit&, const Solution&) {}
  virtual void on_failure(const Model&, const StepReport&, const std::string& /*reason*/, const Solution&) {}
  virtual void on_finish(const Model&, const RunResult&) {}
  // What the observer has gathered, to a checkpoint or back from it.  Reading comes after on_start of the
  // resumed run and replaces all that was gathered before.
  virtual void exchange(Archive&) {}
};

}  // namespace sage
