// The skip 'repeats': after a step that was linear to the last digit, the next one of the same size is tried as its
// repetition, which costs one force pass.  In a linear scene all steps of a stage are such.
#pragma once

#include <algorithm>
#include <cmath>

#include "sage/analysis/skips/wrapped_policy.hpp"
#include "sage/core/archive.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

class Repeats {
 public:
  // After a step that was solved.  size: its share of the stage.  linear: one correction, and the very same K at its
  // end.  force: its relative residual.
  void take(bool linear, double size, double force) {
    size_ = linear ? size : 0.0;
    force_ = force;
  }
  void forget() { size_ = 0.0; }
  bool due(double size) const { return size_ > 0.0 && std::abs(size - size_) < 1e-12; }
  void exchange(Archive& archive) {
    archive(size_);
    archive(force_);
  }

  // Share of the forces that a repetition may leave: rounding, as beyond it would be another answer than that of a
  // correction.  Where K never changes a correction itself leaves more in large meshes.
  double limit(double tolerance, bool constant) const {
    return std::min(constant ? std::max(kRounding, 2.0 * force_) : kRounding, 1e-3 * tolerance);
  }

 private:
  static constexpr double kRounding = rounding::kSolution;
  double size_ = 0.0;   // of the last step, where it was linear; 0 = it was not
  double force_ = 0.0;  // of the last step that was solved
};

// The step before once more, if it leaves next to nothing unbalanced.
class RepeatedStep final : public WrappedPolicy {
 public:
  // limit: relative residual that it may leave.  Nothing has been repeated yet.
  void set_limit(double limit) {
    limit_ = limit;
    done_ = false;
  }
  bool done() const { return done_; }
  void forget() { done_ = false; }
  bool begin(StepIteration& step, const Eigen::VectorXd& rate) override;

 private:
  bool try_it(StepIteration& step) const;

  double limit_ = 0.0;
  bool done_ = false;
};

}  // namespace sage
