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

}  // namespace

// Where the line from the Cauchy point (inside) to `to` (outside) leaves the region: share of the line.
double Dogleg::exit_of_region(const Eigen::VectorXd& to) const {
  const double a = (to - cauchy_).squaredNorm(), b = cauchy_.dot(to - cauchy_);
  const double c = cauchy_.squaredNorm() - radius_ * radius_;
  return (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
}

void Dogleg::choose(const KeptMatrix& K, const Eigen::VectorXd& residual, const Eigen::VectorXd& newton,
                    Eigen::VectorXd& step) {
  const double newton_size = newton.norm();
  if (radius_ < 0.0) radius_ = newton_size;
  for (Eigen::VectorXd* v : {&product_, &descent_, &cauchy_}) v->resize(residual.size());
  if (newton_size <= radius_) {
    step = newton;
  } else {
    K.multiply_transposed(view(residual), view(descent_));  // -d(|R|^2 / 2) / du
    K.multiply(view(descent_), view(product_));
    cauchy_ = descent_ * (descent_.squaredNorm() / product_.squaredNorm());
    if (cauchy_.norm() >= radius_)
      step = cauchy_ * (radius_ / cauchy_.norm());
    else
      step = cauchy_ + exit_of_region(newton) * (newton - cauchy_);
  }
  K.multiply(view(step), view(product_));
  predicted_ = (residual - product_).norm();
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
