// Acceleration of modified Newton and initial stiffness: the next correction is combined with the last few so
// that the part of it that they can undo is undone.  Anderson (1965), J. ACM 12:547; the same idea as
// Krylov-Newton, Scott & Fenves (2010), J. Struct. Eng. 136:476.
#pragma once

#include <Eigen/Core>

namespace sage {

class Acceleration {
 public:
  // correction: in, g = K0^-1 R at the place reached; out, the step to take:
  //   g - sum_j gamma_j (step_j + change of g by step_j),  gamma = argmin |g - sum_j gamma_j change_j|.
  void improve(Eigen::VectorXd& correction);
  // Forgets what it knows, e.g. after a bad step.
  void restart() { count_ = 0; }

 private:
  static constexpr int kMost = 8;  // steps that it remembers
  using Factors = Eigen::Matrix<double, kMost, 1>;

  Factors least_squares(int known, const Eigen::VectorXd& correction);

  Eigen::MatrixXd steps_, changes_, basis_;
  Eigen::VectorXd last_correction_, last_step_, rest_;
  int count_ = 0;  // corrections seen since the start
};

}  // namespace sage
