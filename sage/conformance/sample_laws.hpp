// Laws for tests of elements: linear with any D, and a smooth nonlinear unsymmetric one with history.
#pragma once

#include <array>

#include "sage/core/four_at_a_time.hpp"
#include "sage/core/law.hpp"

namespace sage::conformance {

template <int N>
class LinearLaw final : public Law<N> {
 public:
  explicit LinearLaw(const Matrix<N>& D) : D_(D) {}
  LawTraits traits() const override { return {.symmetric = D_.isApprox(D_.transpose()), .linear = true}; }
  Outcome update(const PointIn<N>& in, PointOut<N>& out) const override {
    out.sigma.noalias() = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  Matrix<N> D_;
};

// Shear and normal stiffness of an interface, uncoupled.                                    [chapter 7,
// Eq 7.14]
inline LinearLaw<2> interface_law(double k_s, double k_n) {
  Matrix2 k = Matrix2::Zero();
  k.diagonal() << k_s, k_n;
  return LinearLaw<2>(k);
}

// sigma = sigma0 + A deps + c (b . deps)^2, D = A + 2 c (b . deps) b^T: D is unsymmetric.
// History: {sum of deps so far, number of updates}.  Refuses deps with a component beyond `limit`.
template <int N>
class SmoothLaw : public Law<N> {
 public:
  explicit SmoothLaw(double limit = 1e9) : limit_(limit) {
    for (int i = 0; i < N; ++i) {
      c_(i) = 30.0 - 7.0 * i;
      b_(i) = 1.0 + 0.4 * i * i;
      for (int j = 0; j < N; ++j) A_(i, j) = (i == j ? 50.0 : 0.0) + 3.0 * i - 5.0 * j + 2.0 * i * j;
    }
  }
  LawTraits traits() const override { return {.history = kHistory}; }
  Outcome update(const PointIn<N>& in, PointOut<N>& out) const override {
    if (in.deps.cwiseAbs().maxCoeff() > limit_) return Outcome::cut_step;
    const double s = b_.dot(in.deps);
    out.sigma = in.sigma0 + A_ * in.deps + c_ * (s * s);
    out.D = A_ + 2.0 * s * c_ * b_.transpose();
    out.h1[0] = in.h0[0] + in.deps.sum();
    out.h1[1] = in.h0[1] + 1.0;
    out.status = PointStatus::yielded;
    return Outcome::ok;
  }

 private:
  static constexpr std::array<Quantity, 2> kHistory{
      {{"sum", Dimension::none, 0.25}, {"updates", Dimension::none, 0.0}}};
  double limit_;
  Matrix<N> A_;
  Vector<N> b_, c_;
};

// A law of solids, four points at once by asking it four times; what it says of its D is up to the test.
template <class L>
class InFours : public L, public FourPointLaw<4> {
 public:
  using L::L;
  InFours(double first, bool constant_D) : L(first), constant_D_(constant_D) {}
  Outcome update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const override {
    for (std::size_t p = 0; p < in.size(); ++p)
      for (std::size_t l = 0; l < kAbreast; ++l)
        if (update_one(in[p], l, out[p]) != Outcome::ok) return Outcome::cut_step;
    for (FourPointsOut<4>& answer : out) answer.constant_D = constant_D_;
    return Outcome::ok;
  }

 private:
  Outcome update_one(const FourPointsIn<4>& in, std::size_t l, FourPointsOut<4>& out) const {
    const std::size_t history = this->traits().history.size();
    PointIn<4> point;
    PointOut<4> result;
    point.h0 = {in.h0[l], history};
    result.h1 = {out.h1[l], history};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      point.sigma0[at] = one_of_four(in.sigma0[i], l);
      point.eps0[at] = one_of_four(in.eps0[i], l);
      point.deps[at] = one_of_four(in.deps[i], l);
    }
    if (this->update(point, result) != Outcome::ok) return Outcome::cut_step;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      one_of_four(out.sigma[i], l) = result.sigma[at];
      for (std::size_t j = 0; j < 4; ++j)
        one_of_four(out.D[i][j], l) = result.D(at, static_cast<Eigen::Index>(j));
    }
    out.status[l] = result.status;
    return Outcome::ok;
  }

  bool constant_D_ = false;
};

// Elastic with D = 1; says that the first point yields, and of the others nothing.
template <int N>
class SilentLaw final : public Law<N> {
 public:
  LawTraits traits() const override { return {.wants_context = true}; }
  Outcome update(const PointIn<N>& in, PointOut<N>& out) const override {
    out.sigma = in.sigma0 + in.deps;
    out.D.setIdentity();
    if (in.context->point == 0) out.status = PointStatus::yielded;
    return Outcome::ok;
  }
};

// Elastic with D = 1; writes the number of the point that its context names into its history, -1 without one.
template <int N>
class ContextLaw final : public Law<N> {
 public:
  LawTraits traits() const override { return {.history = kHistory, .symmetric = true, .wants_context = true}; }
  Outcome update(const PointIn<N>& in, PointOut<N>& out) const override {
    out.sigma = in.sigma0 + in.deps;
    out.D.setIdentity();
    out.h1[0] = in.context != nullptr ? in.context->point : -1.0;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  static constexpr std::array<Quantity, 1> kHistory{{{"point", Dimension::none, 0.0}}};
};

}  // namespace sage::conformance
