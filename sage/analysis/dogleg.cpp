#include "sage/analysis/dogleg.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

std::span<const double> view(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> view(Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// Where the way from `from` (inside) to `to` (outside) leaves the ball of a radius: part of the way.
double exit_of_ball(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double radius) {
  const Eigen::VectorXd way = to - from;
  const double a = way.squaredNorm(), b = from.dot(way), c = from.squaredNorm() - radius * radius;
  return (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
}

}  // namespace

void Dogleg::choose(const LinearSolver& solver, const Eigen::VectorXd& residual, const Eigen::VectorXd& newton,
                    Eigen::VectorXd& step) {
  const double newton_size = newton.norm();
  if (radius_ < 0.0) radius_ = newton_size;
  Eigen::VectorXd product(residual.size());
  if (newton_size <= radius_) {
    step = newton;
  } else {
    Eigen::VectorXd descent(residual.size());
    solver.multiply_transposed(view(residual), view(descent));  // -d(|R|^2 / 2) / du
    solver.multiply(view(descent), view(product));
    const Eigen::VectorXd cauchy = descent * (descent.squaredNorm() / product.squaredNorm());
    if (cauchy.norm() >= radius_)
      step = cauchy * (radius_ / cauchy.norm());
    else
      step = cauchy + exit_of_ball(cauchy, newton, radius_) * (newton - cauchy);
  }
  solver.multiply(view(step), view(product));
  predicted_ = (residual - product).norm();
  size_ = step.norm();
  step_length_ = newton_size > 0.0 ? size_ / newton_size : 1.0;
}

bool Dogleg::accept(double old_norm, double new_norm) {
  const double hoped = old_norm * old_norm - predicted_ * predicted_;
  const double gained = old_norm * old_norm - new_norm * new_norm;
  if (!(gained > 1e-4 * hoped)) {
    radius_ = 0.25 * size_;
    return false;
  }
  if (gained < 0.25 * hoped) radius_ = 0.5 * size_;
  if (gained > 0.75 * hoped) radius_ = std::max(radius_, 2.0 * size_);
  return true;
}

}  // namespace sage
