// The one kernel of every element.  An element is a list of points, each with a weight w and an operator B
// (law_size x dofs).  Full integration, B-bar and interfaces differ only in how geometry() makes w and B.
#pragma once

#include <cassert>
#include <variant>

#include "sage/core/element.hpp"

namespace sage {

// Doubles from one point's w to the next one's; B follows w, column-major.
template <int LawSize, int Dofs>
inline constexpr int kPointStride = 1 + LawSize* Dofs;

// K += B^T (w D) B.  No symmetry is assumed.  lazyProduct: Eigen's blocked product is slower at these sizes.
template <int LawSize, int Dofs>
void add_stiffness(Eigen::Map<Matrix<Dofs>>& K, const Eigen::Matrix<double, LawSize, Dofs>& B,
                   const Matrix<LawSize>& wD) {
  const Eigen::Matrix<double, Dofs, LawSize> Bt = B.transpose();
  const Eigen::Matrix<double, LawSize, Dofs> wDB = wD.lazyProduct(B);
  for (int j = 0; j < Dofs; ++j) K.col(j).noalias() += Bt.lazyProduct(wDB.col(j));
}

// f = sum w B^T sigma, K = sum w B^T D B and the trial state.  Allocates nothing.
template <int LawSize, int Dofs, int Points>
Outcome evaluate_points(const ElementIn& in, ElementOut& out) {
  const auto* const* held = std::get_if<const Law<LawSize>*>(&in.law);
  assert(held && "the model builder pairs elements with laws of the same size");
  const Law<LawSize>& law = **held;
  const std::size_t history = law.history().size();

  const Eigen::Map<const Vector<Dofs>> du(in.du);
  Eigen::Map<Vector<Dofs>> f(out.f);
  f.setZero();
  if (out.K) Eigen::Map<Matrix<Dofs>>(out.K).setZero();

  PointIn<LawSize> point;
  PointOut<LawSize> result;
  for (int p = 0; p < Points; ++p) {
    const double* const geometry = in.geometry + p * kPointStride<LawSize, Dofs>;
    const double w = *geometry;
    const Eigen::Matrix<double, LawSize, Dofs> B =
        Eigen::Map<const Eigen::Matrix<double, LawSize, Dofs>>(geometry + 1);
    const std::size_t h = static_cast<std::size_t>(p) * history;

    point.sigma0 = Eigen::Map<const Vector<LawSize>>(in.sigma0 + p * LawSize);
    point.eps0 = Eigen::Map<const Vector<LawSize>>(in.eps0 + p * LawSize);
    point.deps = B.lazyProduct(du);
    point.h0 = {in.h0 + h, history};
    result.h1 = {out.h1 + h, history};
    if (law.update(point, result) != Outcome::ok) return Outcome::cut_step;

    Eigen::Map<Vector<LawSize>>(out.sigma1 + p * LawSize) = result.sigma;
    Eigen::Map<Vector<LawSize>>(out.eps1 + p * LawSize) = point.eps0 + point.deps;
    out.status[p] = result.status;

    f.noalias() += B.transpose().lazyProduct(w * result.sigma);
    if (out.K) {
      Eigen::Map<Matrix<Dofs>> K(out.K);
      add_stiffness<LawSize, Dofs>(K, B, w * result.D);
    }
  }
  return Outcome::ok;
}

// What all elements share: traits and the kernel.
template <int LawSize, int Dofs, int Points>
class PointElement : public Element {
 public:
  explicit PointElement(const ElementTraits& traits) : traits_(traits) {
    assert(traits.law_size == LawSize && traits.dofs == Dofs && traits.points == Points);
  }
  const ElementTraits& traits() const final { return traits_; }
  Outcome evaluate(const ElementIn& in, ElementOut& out) const final {
    return evaluate_points<LawSize, Dofs, Points>(in, out);
  }

 private:
  ElementTraits traits_;
};

}  // namespace sage
