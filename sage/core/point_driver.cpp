#include "sage/core/point_driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "sage/math/dense.hpp"
#include "sage/messages/error.hpp"

namespace sage {

namespace {

constexpr double kTolerance = 1e-12;  // of the largest stress of start, target and answer
constexpr double kLoose = 1e-9;       // the same where rounding of the law's own leaves no more
constexpr double kRounding = 1e-15;   // of a matrix
constexpr double kSingular = 1e-8;    // of the stiffness at the start: such a tangent is none
constexpr double kNoise = 1e-15;      // of stiffness times strain increment: rounding of a trial stress
constexpr int kIterations = 40;
constexpr int kCuts = 8;  // of a correction that makes things worse
constexpr int kHalvings = 12;

}  // namespace

namespace {

// left: PointDriver::left_.
std::string why_lost(double left) {
  std::array<char, 200> text{};
  if (std::isnan(left))
    std::snprintf(text.data(), text.size(), "the law gives no stress for the smallest part of the step");
  else
    std::snprintf(
        text.data(), text.size(),
        "no strains give the held stresses, even in 4096 parts of the step: the nearest leave %.1e of the "
        "largest stress (a stress beyond the law's strength, or lost contact)",
        left);
  return text.data();
}

}  // namespace

template <int N>
PointDriver<N>::PointDriver(const Law<N>& law, const Vector<N>& sigma, std::span<const double> history)
    : law_(law), sigma_(sigma), eps_(Vector<N>::Zero()), h_(initial_values(law.traits().history)) {
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
  return {sigma_, eps_, deps, h_, law_.traits().wants_context ? &context_ : nullptr};
}

template <int N>
struct PointDriver<N>::Aim {
  const std::array<Control, N>& control;
  Vector<N> target;
  const Vector<N>& springs;
  // Strains for stresses of the controlled components, by the law's stiffness at the start of the attempt.
  Matrix<N> softness{};
  bool invertible = false;  // that stiffness: no direction is without softness

  bool holds_stress(int i) const { return control[i] == Control::stress; }

  // What the stress-controlled components still lack; zero for the others.
  Vector<N> lack(const Vector<N>& deps, const Vector<N>& sigma) const {
    Vector<N> r = Vector<N>::Zero();
    for (int i = 0; i < N; ++i)
      if (holds_stress(i)) r[i] = target[i] - sigma[i] - springs[i] * deps[i];
    return r;
  }

  // deps with the strains that are given.
  Vector<N> with_strains(Vector<N> deps) const {
    for (int i = 0; i < N; ++i)
      if (!holds_stress(i)) deps[i] = target[i];
    return deps;
  }

  // D with the strains that are given as unknowns with a row each, times `size`.
  Matrix<N> bordered(Matrix<N> D, double size) const {
    D += Matrix<N>(springs.asDiagonal());
    for (int i = 0; i < N; ++i)
      if (!holds_stress(i)) D.row(i) = size * Vector<N>::Unit(i).transpose();
    return D;
  }

  // Strains for stresses `r` of the stress-controlled components; the given ones for the others.
  Vector<N> strains_for(Vector<N> r, const Matrix<N>& D, const Vector<N>& given) const {
    const double largest = D.cwiseAbs().maxCoeff(), size = largest > 0.0 ? largest : 1.0;
    for (int i = 0; i < N; ++i)
      if (!holds_stress(i)) r[i] = size * given[i];
    return dense_matrix::smallest_solution(bordered(D, size), r, kRounding);
  }

  void enter_stiffness(const Matrix<N>& D) {
    const Vector<N> zero = Vector<N>::Zero();
    softness = Matrix<N>::Zero();
    for (int i = 0; i < N; ++i)
      if (holds_stress(i)) softness.col(i) = strains_for(Vector<N>::Unit(i), D, zero);
    invertible = true;
    const Matrix<N> one = softness * bordered(D, 0.0);
    for (int i = 0; i < N; ++i)
      if (holds_stress(i)) invertible = invertible && std::abs(one(i, i) - 1.0) < 0.5;
  }

  // Newton's correction for a lack `r`: the smallest where the tangent is singular, as on an edge of a yield surface,
  // where the split between two equal principal strains is free.  In shares of the stiffness at the start, rounding of
  // D is told from a soft direction near nu = 1/2 too.
  Vector<N> correction(const Vector<N>& r, const Matrix<N>& D) const {
    if (!invertible) return strains_for(r, D, Vector<N>::Zero());
    Matrix<N> shares = softness * bordered(D, 0.0);
    for (int i = 0; i < N; ++i)
      if (!holds_stress(i)) shares.row(i) = Vector<N>::Unit(i).transpose();
    return dense_matrix::smallest_solution(shares, softness * r, kSingular);
  }

  // Largest stress that a lack is measured by: never that of an iterate on the way.
  double scale(const Vector<N>& start, const Vector<N>& answer) const {
    double largest = std::max(start.cwiseAbs().maxCoeff(), answer.cwiseAbs().maxCoeff());
    for (int i = 0; i < N; ++i)
      if (holds_stress(i)) largest = std::max(largest, std::abs(target[i]));
    return largest;
  }
};

// User materials may return an elastic stiffness, or one of a step of no length: differences of the stress stand for
// it in the columns of the unknown strains.
template <int N>
void PointDriver<N>::put_differences(const Aim& aim, const Vector<N>& deps, PointOut<N>& out) {
  const double step = std::max(1e-4 * deps.cwiseAbs().maxCoeff(), 1e-9);
  std::vector<double> history(h_trial_.size());
  PointOut<N> beside;
  beside.h1 = history;
  for (int i = 0; i < N; ++i) {
    if (!aim.holds_stress(i)) continue;
    const double change = std::copysign(step, deps[i]);
    if (call(deps + change * Vector<N>::Unit(i), beside) == Outcome::ok && beside.sigma.allFinite())
      out.D.col(i) = (beside.sigma - out.sigma) / change;
  }
}

// One correction of Newton's.  Its merit is the lack of stress in strains of the stiffness at the start: near nu = 1/2
// the lack itself would weigh the change of volume alone.  Where no part of it helps, that stiffness gives the
// correction, which no corner of a yield surface sends astray.
template <int N>
bool PointDriver<N>::improve(const Aim& aim, Vector<N>& deps, PointOut<N>& out) {
  const Vector<N> base = deps, r = aim.lack(deps, out.sigma);
  const double least = 1.0 / std::max(out.D.cwiseAbs().maxCoeff(), 1e-300);
  const auto merit = [&](const Vector<N>& lack) { return (aim.softness * lack).norm() + least * lack.norm(); };
  const double before = merit(r);
  if (differences_) put_differences(aim, deps, out);
  const Vector<N> newton = aim.correction(r, out.D);
  for (int cut = 0; cut < kCuts; ++cut) {
    deps = base + std::ldexp(1.0, -cut) * newton;
    if (call(deps, out) == Outcome::ok && merit(aim.lack(deps, out.sigma)) < before) return true;
  }
  deps = base + aim.softness * r;
  return call(deps, out) == Outcome::ok;
}

// From `deps`, whose answer is in `out`, to one that leaves nothing of the held stresses.
template <int N>
bool PointDriver<N>::search(const Aim& aim, Vector<N>& deps, PointOut<N>& out) {
  Vector<N> best = deps;
  double stiffest = 0.0;
  left_ = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    const Vector<N> r = aim.lack(deps, out.sigma);
    if (!r.allFinite() || !out.D.allFinite()) break;
    stiffest = std::max(stiffest, out.D.cwiseAbs().maxCoeff());
    const double scale = aim.scale(sigma_, out.sigma), worst = r.cwiseAbs().maxCoeff();
    const double noise = kNoise * stiffest * deps.cwiseAbs().maxCoeff();
    if (worst <= std::max(kTolerance * scale, std::min(noise, kLoose * scale))) return true;
    if (worst < left_ * scale) {
      left_ = worst / scale;
      best = deps;
    }
    if (iteration < kIterations && !improve(aim, deps, out)) break;
  }
  deps = best;
  return left_ <= kLoose && call(deps, out) == Outcome::ok;
}

// Unknowns are the strain increments of the stress-controlled components.  They are first those of the law's stiffness
// at the start; where that leads nowhere, zero.
template <int N>
bool PointDriver<N>::attempt(Aim& aim, bool may_divide) {
  PointOut<N> out;
  out.h1 = h_trial_;
  const Vector<N> zero = Vector<N>::Zero();
  left_ = std::numeric_limits<double>::quiet_NaN();
  if (call(zero, out) != Outcome::ok || !out.D.allFinite()) return false;
  aim.enter_stiffness(out.D);
  const Vector<N> given = aim.with_strains(zero);
  const Vector<N> predicted = aim.with_strains(aim.strains_for(aim.lack(zero, out.sigma), out.D, given));
  for (Vector<N> deps : {predicted, given}) {
    if (call(deps, out) != Outcome::ok || !search(aim, deps, out)) continue;
    if (may_divide && path_error(law_, input(deps), out.sigma, h_trial_) > kPathTolerance) return false;
    sigma_ = out.sigma;
    eps_ += deps;
    h_.swap(h_trial_);
    status_ = out.status;
    ++steps_;
    return true;
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
    Aim aim{control, share * target, springs};
    for (int i = 0; i < N; ++i)
      if (aim.holds_stress(i))
        aim.target[i] = sigma_start[i] + (done + share) * (target[i] - sigma_start[i]) -
                        springs[i] * (eps_[i] - eps_start[i]);
    context_.dt = share * duration;
    context_.time = start + (done + share) * duration;
    if (attempt(aim, share > kSmallestPart)) {
      done += share;
    } else {
      share *= 0.5;
      context_.time = start + done * duration;
      if (share < smallest && !differences_) {  // the tangent may be no derivative of the stress
        differences_ = true;
        share = 1.0 - done;
      }
      if (share < smallest) throw AnalysisError("S501", why_lost(left_));
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
