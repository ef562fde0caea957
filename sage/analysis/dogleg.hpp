// Powell's dogleg for  R = F - f(u) = 0: a step between the steepest descent of |R|^2 / 2 and Newton's, as long
// as the region in which the linearised residual has proved itself.  Powell (1970); Dennis & Schnabel (1983),
// ch. 6.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "sage/core/solver_extensions.hpp"
#include "sage/model/model.hpp"

namespace sage {

// Tolerance to which a stage is solved.  Dogleg steps lower the residual: below a loose tolerance it may have a minimum
// that is no equilibrium, so they are held to 1e-3.
inline double held_tolerance(Method method, double tolerance) {
  return method == Method::dogleg ? std::min(tolerance, 1e-3) : tolerance;
}

class Dogleg {
 public:
  // newton = K^-1 R.  Writes the step to take.
  void choose(const KeptMatrix& K, const Eigen::VectorXd& residual, const Eigen::VectorXd& newton,
              Eigen::VectorXd& step);
  // After the residual at the step is known.  True: the step stays.  False: take it back and choose again.
  bool accept(double old_norm, double new_norm);

  double step_length() const { return step_length_; }  // |step| / |newton|

 private:
  double exit_of_region(const Eigen::VectorXd& to) const;

  Eigen::VectorXd product_, descent_, cauchy_;
  double radius_ = -1.0;    // of trust; < 0 = not set yet
  double size_ = 0.0;       // |step|
  double predicted_ = 0.0;  // |R - K step|
  double step_length_ = 1.0;
};

}  // namespace sage
