// How a run goes on from its checkpoint, and how it ends when it is interrupted.
#pragma once

#include <atomic>

#include "sage/app/checkpoint.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/run_deck.hpp"

namespace sage::app {

// deck_sum: of its text, so that what a fingerprint of the model may not know counts too.
Checkpoint checkpoint_of(const RunRequest& request, const Model& model, std::uint64_t deck_sum,
                         const Catalogue& catalogue, ResultFiles& results);

// The bytes to go on from; empty, with a note, where there are none.
std::string resume_from(Checkpoint& checkpoint, const RunRequest& request);

// When an interrupted run ends: behind the checkpoint of the increment in hand, if there can be one and the
// increment ends soon.  A run that goes on from a checkpoint ends no sooner than all outputs have gone on with their
// files: what stands in those would be lost.  Asked by the thread that runs the analysis only; the last observer.
class EndOfInterrupted final : public Observer {
 public:
  EndOfInterrupted(bool checkpoints, double patience)
      : checkpoints_(checkpoints), patience_(patience), before_start_(interrupted()) {}

  void go_on_from_checkpoint() { outputs_wait_ = true; }
  void exchange(Archive&) override { outputs_wait_ = false; }

  bool checkpoint_wanted() const { return checkpoints_ && interrupted(); }
  void saved() { ready_ = ready_ || interrupted(); }
  bool stop_now() { return interrupted() && (before_start_ || !checkpoints_ || ready_ || waited_enough()); }
  bool outputs_wait() const { return outputs_wait_; }

  // With initial stiffness checkpoints stand between stages only: there is nothing to wait for.
  void on_increment(const Model& model, const StepReport& report, const Solution&) override {
    const Stage& stage = model.stages[report.stage];
    if (stage.method == Method::initial_stiffness && report.increment < report.increments) saved();
  }
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }

 private:
  bool waited_enough() const { return seconds_since_interrupt() >= patience_; }

  bool checkpoints_;
  double patience_;  // s
  bool before_start_, outputs_wait_ = false;
  std::atomic<bool> ready_{false};
};

}  // namespace sage::app
