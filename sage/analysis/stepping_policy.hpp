// What may be decided otherwise from step to step (stepper.cpp): each step begins at the committed state, and is solved by the
// iterations of its stage.
#pragma once

#include <memory>

#include "sage/analysis/skips.hpp"
#include "sage/core/archive.hpp"

namespace sage {

struct NewtonSettings;
struct NewtonStep;
struct RunParts;

// The plain decisions: none.
class SteppingPolicy {
 public:
  virtual ~SteppingPolicy() = default;

  // An attempt at a step of this share of the stage: its settings, and RunState::du where its iterations begin elsewhere.
  virtual void prepare(const RunParts& /*run*/, double /*size*/, NewtonSettings& /*settings*/) {}
  // An attempt from the committed state would begin elsewhere.
  virtual bool begins_elsewhere(const RunParts& /*run*/, double /*size*/) const { return false; }
  // The step of the last attempt has converged, and will be committed.  cut: it is a part of an increment that was cut.
  virtual void accept(const RunParts& /*run*/, const NewtonStep& /*step*/, double /*size*/, bool /*cut*/) {}
  // The last attempt began elsewhere, and failed.
  virtual void fail() {}

  // The steps so far say nothing about the next one: after a step that failed, or (steps of the stage) at all.
  enum class Past { last_step, stage };
  virtual void forget(Past /*past*/) {}
  // To a checkpoint or back.
  virtual void exchange(Archive& /*archive*/) {}
};

// Decides with the skips that are allowed; in a build without skips, plainly.
std::unique_ptr<SteppingPolicy> make_stepping_policy(const Skips& skips);

}  // namespace sage
