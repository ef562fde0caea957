// The skip 'prediction': a step that was not linear is followed by one much like it, which starts in its direction.  Where
// that fails, the next 1, 2, 4, ... steps of the stage start from the committed state.
#pragma once

#include <algorithm>

#include "sage/analysis/skips/wrapped_policy.hpp"
#include "sage/core/archive.hpp"

namespace sage {

class Prediction {
 public:
  // After a step that was solved.  cut: steps of its increment were, as near a limit.
  void take(bool cut) {
    due_ = !cut && pause_ == 0;
    pause_ = std::max(0, pause_ - 1);
  }
  void forget() { due_ = false; }
  // The step that started in the direction of the last one was not solved.
  void fail() {
    pause_ = next_pause_;
    next_pause_ *= 2;
  }
  bool due() const { return due_; }
  void exchange(Archive& archive) {
    archive(due_);
    archive(pause_);
    archive(next_pause_);
  }

 private:
  bool due_ = false;
  int pause_ = 0, next_pause_ = 1;  // steps
};

// Iterations that begin in the direction of the last step: du is that step, scaled to the size of this one.
class PredictedIteration final : public WrappedPolicy {
 public:
  bool begin(StepIteration& step, const Eigen::VectorXd& rate) override;
  bool makes_K(const StepIteration& step, Pass pass) const override;
  bool gives_up(const StepIteration& step) const override;
  void end(StepIteration& step) override;
};

}  // namespace sage
