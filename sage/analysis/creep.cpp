#include "sage/analysis/creep.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

constexpr double kFades = 0.9;  // what counts of a correction after the next one: the last ten matter

}  // namespace

void Creep::take(const Eigen::VectorXd& du, double residual) {
  if (du_.size() == 0) du_ = recent_ = Eigen::VectorXd::Zero(du.size());
  const Eigen::VectorXd correction = du - du_;
  recent_ = kFades * recent_ + correction;
  path_ = kFades * path_ + length(correction);
  du_ = du;
  residuals_.push_back(residual);
}

bool Creep::flows() const {
  const double moved = largest(true);
  return moved > size_ || !std::isfinite(moved);
}

bool Creep::spares_ground() const {
  constexpr double kTakesPart = 0.1;
  return largest(true) < kTakesPart * largest(false);
}

bool Creep::is_shaken() const {
  constexpr std::size_t kPatience = 40;
  constexpr double kCancels = 0.1, kFalls = 0.8;
  if (residuals_.size() < kPatience || length(recent_) > kCancels * path_) return false;
  const auto middle = residuals_.end() - static_cast<std::ptrdiff_t>(kPatience / 2);
  return *std::min_element(middle, residuals_.end()) > kFalls * *std::min_element(residuals_.begin(), middle);
}

double Creep::largest(bool of_solids) const {
  double most = 0.0;
  for (std::size_t dof = 0; dof < of_solids_->size(); ++dof) {
    if (of_solids && (*of_solids_)[dof] == 0) continue;
    const auto at = static_cast<Eigen::Index>(dof);
    const double moved = std::abs(recent_[at]);
    if (!(moved <= most)) most = moved;  // not a number counts
  }
  return most;
}

double Creep::length(const Eigen::VectorXd& motion) const {
  return motion.head(static_cast<Eigen::Index>(of_solids_->size())).norm();
}

}  // namespace sage
