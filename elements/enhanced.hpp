// Enhanced assumed strain of a four-node quadrilateral: its points have the strain B du + G a, and the element solves
// for a.  docs/theory/elements.md has the equations, docs/decisions/0063 the reasons.        [Simo & Rifai 1990]
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <variant>

#include "elements/kinematics.hpp"
#include "elements/point_kernel.hpp"
#include "elements/shapes.hpp"

namespace sage {

// G of one point: a column a mode.
template <int Modes>
using EnhancedOperator = Eigen::Matrix<double, 4, Modes>;

// Modes of Quad4 in parent coordinates: e_11 = xi, e_22 = eta, g_12 = xi and eta; of a ring hoop = xi eta too, without
// which rings lock as nu -> 1/2.
template <class Kinematics>
struct EnhancedModes {
  static constexpr int kCount = Kinematics::geometry == Geometry::axisymmetric ? 5 : 4;

  // G of the points of a rule whose points have equal weights.  det: of the Jacobian, measure: of the volume,
  // both at the points; J: Jacobian at the centre.
  // The mean of G over the volume is zero, so that a uniform stress does no work on it (patch test): the modes are
  // scaled by det J(centre) / det J(point), and lose their mean weighted by the measure.
  template <std::size_t Points>
  static void write(const std::array<RulePoint, Points>& rule, const std::array<double, Points>& det,
                    const std::array<double, Points>& measure, const Matrix2& J, double* to) {
    double sum = 0.0, xi = 0.0, eta = 0.0, both = 0.0;
    for (std::size_t p = 0; p < Points; ++p) {
      sum += measure[p];
      xi += measure[p] * rule[p].xi;
      eta += measure[p] * rule[p].eta;
      both += measure[p] * rule[p].xi * rule[p].eta;
    }
    const double det_centre = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
    // d(xi, eta)/d(x, y) times the root of det J: the modes have no dimension.
    const Matrix2 I =
        (Matrix2() << J(1, 1), -J(0, 1), -J(1, 0), J(0, 0)).finished() / std::sqrt(std::abs(det_centre));
    for (std::size_t p = 0; p < Points; ++p) {
      Eigen::Map<EnhancedOperator<kCount>> G(to + p * 4 * kCount);
      G.setZero();
      const double scale = det_centre / det[p];
      const double a = scale * (rule[p].xi - xi / sum), b = scale * (rule[p].eta - eta / sum);
      const Vector4 first(I(0, 0) * I(0, 0), I(0, 1) * I(0, 1), 0.0, 2.0 * I(0, 0) * I(0, 1));
      const Vector4 second(I(1, 0) * I(1, 0), I(1, 1) * I(1, 1), 0.0, 2.0 * I(1, 0) * I(1, 1));
      const Vector4 shear(I(0, 0) * I(1, 0), I(0, 1) * I(1, 1), 0.0, I(0, 0) * I(1, 1) + I(0, 1) * I(1, 0));
      G.col(0) = a * first;
      G.col(1) = b * second;
      G.col(2) = a * shear;
      G.col(3) = b * shear;
      if constexpr (kCount == 5) G(2, 4) = scale * (rule[p].xi * rule[p].eta - both / sum);
    }
  }
};

// One call of an element with enhanced strains: finds a so that the stress that the increment adds does no work on
// the modes, sum w G^T (sigma - sigma0) = 0.  sigma0 itself may do some: initial stresses that grow with depth are
// in equilibrium as they are.  a starts from zero at each call, because committed strains contain what it was.
template <int Dofs, int Points, int Modes>
class EnhancedSolve {
 public:
  EnhancedSolve(const ElementIn& in, ElementOut& out) : in_(in), out_(out), law_(law_of(in)) {
    const Eigen::Map<const Vector<Dofs>> du(in.du);
    for (int p = 0; p < Points; ++p) compatible_[at(p)] = Bt(p).transpose().lazyProduct(du);
  }

  Outcome run() {
    if (!solve()) return Outcome::cut_step;
    write();
    return Outcome::ok;
  }

 private:
  using Amplitudes = Vector<Modes>;
  static constexpr int kMostIterations = 15, kMostCuts = 8;
  static constexpr int kMostRelaxed = 300, kRelaxed = 20;
  static constexpr double kSmallestPart = 1.0 / 16.0;  // of du
  // Of the terms that the residual is the sum of: always good enough, and good enough where steps no longer help.
  static constexpr double kTolerance = 1e-12, kEnough = 1e-10, kEnoughOfParts = 1e-7;
  // Added to H, of what the stiffest point gives it.  The high one keeps steps short where the flow leaves almost no stiffness.
  static constexpr double kFloor = 1e-15, kHighFloor = 1e-8;

  static std::size_t at(int point) { return static_cast<std::size_t>(point); }
  static const Law<4>& law_of(const ElementIn& in) {
    const auto* const* held = std::get_if<const Law<4>*>(&in.law);
    assert(held && "the model builder pairs elements with laws of the same size");
    return **held;
  }
  double weight(int p) const { return in_.geometry[p * kPointStride<4, Dofs>]; }
  Eigen::Map<const OperatorT<4, Dofs>> Bt(int p) const {
    return Eigen::Map<const OperatorT<4, Dofs>>(in_.geometry + p * kPointStride<4, Dofs> + 1);
  }
  Eigen::Map<const EnhancedOperator<Modes>> G(int p) const {
    return Eigen::Map<const EnhancedOperator<Modes>>(in_.geometry + Points * kPointStride<4, Dofs> +
                                                     p * 4 * Modes);
  }

  // The laws at these amplitudes.  False: a law has no answer.
  bool take(const Amplitudes& amplitudes) {
    const std::size_t history = law_.traits().history.size();
    a_ = amplitudes;
    residual_.setZero();
    Amplitudes terms = Amplitudes::Zero();
    PointIn<4> point;
    for (int p = 0; p < Points; ++p) {
      PointOut<4> result;
      const std::size_t h = at(p) * history;
      point.sigma0 = Eigen::Map<const Vector4>(in_.sigma0 + p * 4);
      point.eps0 = Eigen::Map<const Vector4>(in_.eps0 + p * 4);
      point.deps = share_ * compatible_[at(p)] + G(p).lazyProduct(amplitudes);
      point.h0 = {in_.h0 + h, history};
      result.h1 = {out_.h1 + h, history};
      point.context = in_.contexts != nullptr ? in_.contexts + p : nullptr;
      if (law_.update(point, result) != Outcome::ok) return false;
      Eigen::Map<Vector4>(out_.sigma1 + p * 4) = result.sigma;
      Eigen::Map<Vector4>(out_.eps1 + p * 4) = point.eps0 + point.deps;
      out_.status[p] = result.status;
      D_[at(p)] = result.D;
      stiffest_ = std::max(stiffest_, result.D.norm());
      const Vector4 added = result.sigma - point.sigma0;
      const double size = result.sigma.norm() + point.sigma0.norm() + stiffest_ * point.deps.norm();
      residual_ += G(p).transpose().lazyProduct(weight(p) * added);
      terms += weight(p) * size * G(p).colwise().norm().transpose();
    }
    largest_terms_ = largest_terms_.cwiseMax(terms);
    return true;
  }

  // D of the points where they are pressed together: at the tip of a yield surface laws have no stiffness, but round as
  // their elastic stresses do.
  void press() {
    pressed_ = true;
    const std::size_t history = law_.traits().history.size();
    PointIn<4> point;
    for (int p = 0; p < Points; ++p) {
      PointOut<4> result;
      const std::size_t h = at(p) * history;
      point.sigma0 = Eigen::Map<const Vector4>(in_.sigma0 + p * 4);
      point.eps0 = Eigen::Map<const Vector4>(in_.eps0 + p * 4);
      point.deps = -compatible_[at(p)].norm() * Vector4(1.0, 1.0, 1.0, 0.0);
      point.h0 = {in_.h0 + h, history};
      result.h1 = {out_.h1 + h, history};
      point.context = in_.contexts != nullptr ? in_.contexts + p : nullptr;
      if (law_.update(point, result) != Outcome::ok) continue;
      stiffest_ = std::max(stiffest_, result.D.norm());
      elastic_ += G(p).transpose().lazyProduct(result.D.lazyProduct(weight(p) * G(p)).eval());
    }
  }

  // H = sum w G^T D G, with a floor that keeps it regular where points have no stiffness left.
  Matrix<Modes> stiffness_of_modes() const {
    Matrix<Modes> H = Matrix<Modes>::Zero();
    double size = 0.0;
    for (int p = 0; p < Points; ++p) {
      const EnhancedOperator<Modes> wDG = D_[at(p)].lazyProduct(weight(p) * G(p));
      H += G(p).transpose().lazyProduct(wDG);
      size += weight(p) * G(p).squaredNorm();
    }
    H.diagonal().array() += floor_ * stiffest_ * size;
    return H;
  }

  // Against the largest terms of all passes: what the laws round is in proportion to their trial stresses, which may be
  // large where the answer is small.
  bool balanced(double tolerance) const {
    return (residual_.array().abs() <= tolerance * largest_terms_.array()).all();
  }

  // By Newton's method at once where that works, else as du grows in parts, else by steps of the elastic stiffness.
  bool solve() {
    if (newton(Amplitudes::Zero(), 1.0)) return true;
    floor_ = kHighFloor;
    enough_ = kEnoughOfParts;
    const bool found = follow() || relax();
    floor_ = kFloor;
    return found;
  }

  bool follow() {
    double reached = 0.0, part = 0.5;
    Amplitudes known = Amplitudes::Zero();
    while (reached < 1.0) {
      const double tried = std::min(1.0, reached + part);
      if (newton(known, tried)) {
        known = a_;
        reached = tried;
        part *= 2.0;
      } else {
        part = 0.5 * (tried - reached);
        if (part < kSmallestPart) return false;
      }
    }
    return true;
  }

  // Where the flow is not associated a may have to jump as du grows.
  bool relax() {
    if (!pressed_) press();
    share_ = 1.0;
    if (!take(Amplitudes::Zero())) return false;
    const Matrix<Modes> inverse = elastic_.inverse();
    for (int iteration = 1; iteration <= kMostRelaxed; ++iteration) {
      if (!take(a_ - inverse * residual_)) return false;
      if (iteration % kRelaxed == 0) {
        const Amplitudes here = a_;
        if (newton(here, 1.0)) return true;
        if (!take(here)) return false;
      }
    }
    return false;
  }

  bool newton(const Amplitudes& first, double share) {
    share_ = share;
    largest_terms_.setZero();
    if (!take(first)) return false;
    for (int iteration = 0; !balanced(kTolerance); ++iteration) {
      if (iteration == kMostIterations) return balanced(enough_);
      const Amplitudes start = a_, before = residual_;
      const Amplitudes step = -stiffness_of_modes().partialPivLu().solve(before);
      const bool enough = balanced(enough_);
      if (!step.allFinite() || !advance(start, step, before)) return enough && take(start);
      if (residual_.norm() <= 0.5 * before.norm()) continue;
      if (enough) return residual_.norm() <= before.norm() || take(start);
      if (pressed_) continue;
      press();
      if (!take(a_)) return false;
    }
    return true;
  }

  // From `start` along the step.  False: the law has no answer.
  bool advance(const Amplitudes& start, const Amplitudes& step, const Amplitudes& before) {
    return law_.traits().symmetric ? descend(start, step, before) : approach(start, step, before);
  }

  // The residual is the gradient of a convex function: where that grows again at the end of the step, its least value lies
  // between (regula falsi, Illinois).
  bool descend(const Amplitudes& start, const Amplitudes& step, const Amplitudes& before) {
    const double slope = before.dot(step), small = 0.3 * std::abs(slope);
    double low = 0.0, at_low = slope, high = 1.0, length = 1.0;
    bool known = take(start + step);
    double at_high = known ? residual_.dot(step) : std::numeric_limits<double>::infinity(), now = at_high;
    for (int cut = 0; cut < kMostCuts; ++cut) {
      if (known && (now <= small && (cut == 0 || now >= -small))) return true;
      if (known && residual_.norm() <= 0.3 * before.norm()) return true;
      const double share = std::isfinite(at_high) ? at_low / (at_low - at_high) : 0.25;
      length = low + std::clamp(share, 0.02, 0.98) * (high - low);
      known = take(start + length * step);
      now = known ? residual_.dot(step) : std::numeric_limits<double>::infinity();
      if (now > 0.0) {
        high = length;
        at_high = now;
        at_low *= 0.5;
      } else {
        low = length;
        at_low = now;
        at_high *= 0.5;
      }
    }
    return known;
  }

  // No function is there to descend on: the residual itself gets smaller, or the step is taken whole.
  bool approach(const Amplitudes& start, const Amplitudes& step, const Amplitudes& before) {
    double length = 1.0;
    for (int cut = 0; cut < kMostCuts; ++cut, length *= 0.5)
      if (take(start + length * step) && residual_.norm() <= (1.0 - 0.1 * length) * before.norm()) return true;
    return take(start + step);
  }

  // f, and K with the amplitudes eliminated: sum w B^T D B - (sum w B^T D G) H^-1 (sum w G^T D B).
  void write() {
    Vector<Dofs> f = Vector<Dofs>::Zero();
    for (int p = 0; p < Points; ++p)
      f.noalias() += Bt(p).lazyProduct(weight(p) * Eigen::Map<const Vector4>(out_.sigma1 + p * 4));
    Eigen::Map<Vector<Dofs>>(out_.f) = f;
    if (out_.K == nullptr) return;
    StackedOperators<4, Dofs, Points> all;
    Eigen::Matrix<double, Dofs, Modes> right = Eigen::Matrix<double, Dofs, Modes>::Zero();
    Eigen::Matrix<double, Modes, Dofs> left = Eigen::Matrix<double, Modes, Dofs>::Zero();
    for (int p = 0; p < Points; ++p) {
      const Matrix4 wD = weight(p) * D_[at(p)];
      all.set(p, Bt(p), wD);
      const EnhancedOperator<Modes> wDG = wD.lazyProduct(G(p)), wDtG = wD.transpose().lazyProduct(G(p));
      right += Bt(p).lazyProduct(wDG);
      left += wDtG.transpose().lazyProduct(Bt(p).transpose());
    }
    Eigen::Map<Matrix<Dofs>> K(out_.K);
    sum_stiffness(all, true, K);
    if (!left.isZero(0.0)) K -= right.lazyProduct(stiffness_of_modes().partialPivLu().solve(left));
  }

  const ElementIn& in_;
  ElementOut& out_;
  const Law<4>& law_;
  std::array<Vector4, Points> compatible_;  // B du
  double share_ = 1.0;                      // of du that is taken
  double stiffest_ = 0.0;                   // largest norm of D so far
  bool pressed_ = false;
  double floor_ = kFloor, enough_ = kEnough;
  Matrix<Modes> elastic_ = Matrix<Modes>::Zero();
  std::array<Matrix4, Points> D_;
  Amplitudes a_, residual_, largest_terms_ = Amplitudes::Zero();
};

// Traits and evaluate() of an element that writes, behind its points, G of each of them.
template <int Dofs, int Points, int Modes>
class EnhancedElement : public Element {
 public:
  explicit EnhancedElement(ElementTraits traits) : traits_(traits) { traits_.own_doubles = Points * 4 * Modes; }
  const ElementTraits& traits() const final { return traits_; }
  Outcome evaluate(const ElementIn& in, ElementOut& out) const final {
    return EnhancedSolve<Dofs, Points, Modes>(in, out).run();
  }

 private:
  ElementTraits traits_;
};

}  // namespace sage
