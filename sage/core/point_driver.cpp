#include "sage/core/point_driver.hpp"

#include <algorithm>
#include <cmath>

#include "sage/core/dense.hpp"
#include "sage/core/error.hpp"

namespace sage {

namespace {

constexpr double kTolerance = 1e-12;  // of the largest stress in play
constexpr int kIterations = 40;
constexpr int kHalvings = 12;

}  // namespace

template <int N>
PointDriver<N>::PointDriver(const Law<N>& law, const Vector<N>& sigma, std::span<const double> history)
    : law_(law), sigma_(sigma), eps_(Vector<N>::Zero()) {
  for (const Quantity& quantity : law.history()) h_.push_back(quantity.initial);
  h_trial_ = h_;
  if (!law_.initialise(sigma_, h_))
    throw AnalysisError("S503", "point driver: the law can't carry the initial stress");
  for (std::size_t i = 0; i < std::min(history.size(), h_.size()); ++i)
    if (!std::isnan(history[i])) h_[i] = history[i];
  if (!history.empty() && !law_.accepts_history(sigma_, h_))
    throw AnalysisError("S503", "point driver: the law can't go on from this history");
}

template <int N>
Outcome PointDriver<N>::call(const Vector<N>& deps, PointOut<N>& out) {
  ++iterations_;
  return law_.update(input(deps), out);
}

template <int N>
PointIn<N> PointDriver<N>::input(const Vector<N>& deps) const {
  return {sigma_, eps_, deps, h_, law_.wants_context() ? &context_ : nullptr};
}

namespace {

// What the stress-controlled components still lack; zero for the others.  sigma: with that of the springs.
template <int N>
Vector<N> lack(const std::array<Control, N>& control, const Vector<N>& target, const Vector<N>& sigma) {
  Vector<N> r = Vector<N>::Zero();
  for (int i = 0; i < N; ++i)
    if (control[static_cast<std::size_t>(i)] == Control::stress) r[i] = target[i] - sigma[i];
  return r;
}

// Strain correction for a lack of stress; none for strain-controlled components.  The smallest one
// where the tangent is singular, as on an edge of a yield surface, where the split between two equal
// principal strains is free.
template <int N>
Vector<N> correction_for(const std::array<Control, N>& control, const Vector<N>& r, Matrix<N> D) {
  const double size = D.cwiseAbs().maxCoeff();
  for (int i = 0; i < N; ++i)
    if (control[static_cast<std::size_t>(i)] == Control::strain)
      D.row(i) = size * Vector<N>::Unit(i).transpose();
  return dense_matrix::smallest_solution(D, r);
}

}  // namespace

// User materials may return an elastic stiffness, or one of a step of no length: differences of the stress stand for
// it in the columns of the unknown strains.
template <int N>
void PointDriver<N>::put_differences(const std::array<Control, N>& control, const Vector<N>& deps,
                                     PointOut<N>& out) {
  const double step = std::max(1e-4 * deps.cwiseAbs().maxCoeff(), 1e-9);
  std::vector<double> history(h_trial_.size());
  PointOut<N> beside;
  beside.h1 = history;
  for (int i = 0; i < N; ++i) {
    if (control[static_cast<std::size_t>(i)] == Control::strain) continue;
    const double change = std::copysign(step, deps[i]);
    if (call(deps + change * Vector<N>::Unit(i), beside) == Outcome::ok && beside.sigma.allFinite())
      out.D.col(i) = (beside.sigma - out.sigma) / change;
  }
}

// Newton; unknowns are the strain increments of the stress-controlled components.  A correction that makes
// things worse is halved, seven times at most.
template <int N>
bool PointDriver<N>::attempt(const std::array<Control, N>& control, const Vector<N>& target,
                             const Vector<N>& springs, bool may_divide) {
  PointOut<N> out;
  out.h1 = h_trial_;
  Vector<N> deps = Vector<N>::Zero();
  for (int i = 0; i < N; ++i)
    if (control[static_cast<std::size_t>(i)] == Control::strain) deps[i] = target[i];
  if (call(deps, out) != Outcome::ok) return false;

  double scale = sigma_.cwiseAbs().maxCoeff();  // largest stress met on the way
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Vector<N> r = lack<N>(control, target, out.sigma + springs.cwiseProduct(deps));
    scale = std::max(scale, out.sigma.cwiseAbs().maxCoeff());
    if (!r.allFinite()) return false;
    if (r.cwiseAbs().maxCoeff() <= kTolerance * scale) {
      if (may_divide && law_.path_error(input(deps), out.sigma, h_trial_) > kPathTolerance) return false;
      sigma_ = out.sigma;
      eps_ += deps;
      h_.swap(h_trial_);
      status_ = out.status;
      ++steps_;
      return true;
    }
    if (differences_) put_differences(control, deps, out);
    const Matrix<N> stiffness = out.D + Matrix<N>(springs.asDiagonal());
    const Vector<N> base = deps, correction = correction_for<N>(control, r, stiffness);
    for (int cut = 0; cut < 8; ++cut) {
      deps = base + std::ldexp(1.0, -cut) * correction;
      if (call(deps, out) == Outcome::ok &&
          lack<N>(control, target, out.sigma + springs.cwiseProduct(deps)).norm() < r.norm())
        break;
    }
  }
  return false;
}

template <int N>
void PointDriver<N>::advance(const std::array<Control, N>& control, const Vector<N>& target, double duration,
                             const Vector<N>& springs) {
  double done = 0.0, share = 1.0;  // of the step
  const double start = context_.time;
  ++context_.increment;
  const Vector<N> sigma_start = sigma_, eps_start = eps_;
  const double smallest = std::ldexp(1.0, -kHalvings);
  while (done < 1.0) {
    Vector<N> part;
    for (int i = 0; i < N; ++i)
      part[i] = control[static_cast<std::size_t>(i)] == Control::strain
                    ? share * target[i]
                    : sigma_start[i] + (done + share) * (target[i] - sigma_start[i]) -
                          springs[i] * (eps_[i] - eps_start[i]);
    context_.dt = share * duration;
    context_.time = start + (done + share) * duration;
    if (attempt(control, part, springs, share > kSmallestPart)) {
      done += share;
    } else {
      share *= 0.5;
      context_.time = start + done * duration;
      if (share < smallest && !differences_) {  // the tangent may be no derivative of the stress
        differences_ = true;
        share = 1.0 - done;
      }
      if (share < smallest) throw AnalysisError("S501", "point driver: the path can't be followed further");
    }
  }
}

template class PointDriver<1>;
template class PointDriver<2>;
template class PointDriver<3>;
template class PointDriver<4>;
template class PointDriver<5>;

std::vector<TriaxialPoint> triaxial_test(const SolidLaw& law, double cell_pressure, double axial_strain,
                                         int steps) {
  constexpr std::array<Control, 4> kTriaxial{Control::stress, Control::strain, Control::stress,
                                             Control::strain};
  const Vector4 isotropic{-cell_pressure, -cell_pressure, -cell_pressure, 0.0};
  const Vector4 step{-cell_pressure, -axial_strain / steps, -cell_pressure, 0.0};
  PointDriver<4> driver(law, isotropic);
  std::vector<TriaxialPoint> path = {{0.0, 0.0, 0.0, driver.status()}};
  for (int i = 0; i < steps; ++i) {
    driver.advance(kTriaxial, step);
    const Vector4 &eps = driver.eps(), &sigma = driver.sigma();
    path.push_back({-eps[1], -eps.head<3>().sum(), sigma[0] - sigma[1], driver.status()});
  }
  return path;
}

}  // namespace sage
