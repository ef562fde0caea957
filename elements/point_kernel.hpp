// The kernel of every element but Beam2, which solves for its shear strain too.  An element is a list of points, each with a weight w and a strain operator
// B. Full integration, B-bar and interfaces differ only in how geometry() makes w and B.
#pragma once

#include <algorithm>
#include <cassert>
#include <variant>

#include "elements/four_kernel.hpp"

namespace sage {

// B^T of one point, dofs x law_size: a column is a strain component, so that products with
// B^T run down whole columns.
template <int LawSize, int Dofs>
using OperatorT = Eigen::Matrix<double, Dofs, LawSize>;

// Doubles from one point's w to the next one's; B^T follows w.
template <int LawSize, int Dofs>
inline constexpr int kPointStride = 1 + LawSize* Dofs;

// Points taken together: all of them, or for large elements one row of their square, so that the operators stay
// in the cache.
constexpr int points_together(int points) {
  if (points <= 16) return points;
  int row = 5;
  while (row * row < points) ++row;
  return points % row == 0 ? row : points;
}

// B^T and (w D B)^T of some points side by side.  Rows are filled up with zeros to whole vector registers, in
// blocks that one column of K can hold in registers while it is summed.
template <int LawSize, int Dofs, int Points>
struct StackedOperators {
  static constexpr int kBlocks = (Dofs + 55) / 56;
  static constexpr int kBlockRows =
      kBlocks == 1 ? (Dofs + 7) / 8 * 8 : ((Dofs + kBlocks - 1) / kBlocks + 3) / 4 * 4;
  static constexpr int kRows = kBlocks * kBlockRows;
  Eigen::Matrix<double, kRows, LawSize * Points> Bt, wDBt;

  // Always inlined: as a call it costs the elements of quadratic solids a third of their instructions.
  [[gnu::always_inline]] void set(int p, const Eigen::Map<const OperatorT<LawSize, Dofs>>& point_Bt,
                                  const Matrix<LawSize>& wD) {
    auto padded = Bt.template middleCols<LawSize>(p * LawSize);
    padded.template topRows<Dofs>() = point_Bt;
    padded.template bottomRows<kRows - Dofs>().setZero();
    const Matrix<LawSize> wDt = wD.transpose();
    wDBt.template middleCols<LawSize>(p * LawSize).noalias() = padded.lazyProduct(wDt);
  }
};

// K = sum B^T w D B over the points, column by column; added to K where `first` is
// false.  No symmetry is assumed.
template <int LawSize, int Dofs, int Points>
void sum_stiffness(const StackedOperators<LawSize, Dofs, Points>& all, bool first, Eigen::Map<Matrix<Dofs>> K) {
  using Operators = StackedOperators<LawSize, Dofs, Points>;
  constexpr int rows = Operators::kBlockRows;
  for (int top = 0; top < Dofs; top += rows) {
    const int used = std::min(rows, Dofs - top);
    for (int j = 0; j < Dofs; ++j) {
      Vector<rows> column = all.Bt.col(0).template segment<rows>(top) * all.wDBt(j, 0);
      for (int k = 1; k < LawSize * Points; ++k)
        column += all.Bt.col(k).template segment<rows>(top) * all.wDBt(j, k);
      if constexpr (Operators::kBlocks == 1) {
        if (first)
          K.col(j) = column.template head<Dofs>();
        else
          K.col(j) += column.template head<Dofs>();
      } else {
        if (first)
          K.col(j).segment(top, used) = column.head(used);
        else
          K.col(j).segment(top, used) += column.head(used);
      }
    }
  }
}

// f = sum w B^T sigma, K = sum w B^T D B and the trial state.  Allocates nothing.
// lazyProduct: Eigen's blocked product is slower at these sizes.
template <int LawSize, int Dofs, int Points>
Outcome evaluate_points(const ElementIn& in, ElementOut& out) {
  const auto* const* held = std::get_if<const Law<LawSize>*>(&in.law);
  assert(held && "the model builder pairs elements with laws of the same size");
  const Law<LawSize>& law = **held;
  const std::size_t history = law.traits().history.size();
  const Eigen::Map<const Vector<Dofs>> du(in.du);

  Vector<Dofs> f = Vector<Dofs>::Zero();
  constexpr int kTogether = points_together(Points);
  StackedOperators<LawSize, Dofs, kTogether> some;
  PointIn<LawSize> point;
  for (int p = 0; p < Points; ++p) {
    PointOut<LawSize> result;  // one a point: a law that leaves its status out must not find the last point's
    const double* const geometry = in.geometry + p * kPointStride<LawSize, Dofs>;
    const double w = *geometry;
    const Eigen::Map<const OperatorT<LawSize, Dofs>> Bt(geometry + 1);
    const std::size_t h = static_cast<std::size_t>(p) * history;

    point.sigma0 = Eigen::Map<const Vector<LawSize>>(in.sigma0 + p * LawSize);
    point.eps0 = Eigen::Map<const Vector<LawSize>>(in.eps0 + p * LawSize);
    point.deps.noalias() = Bt.transpose().lazyProduct(du);
    point.h0 = {in.h0 + h, history};
    result.h1 = {out.h1 + h, history};
    point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
    if (law.update(point, result) != Outcome::ok) return Outcome::cut_step;

    Eigen::Map<Vector<LawSize>>(out.sigma1 + p * LawSize) = result.sigma;
    Eigen::Map<Vector<LawSize>>(out.eps1 + p * LawSize) = point.eps0 + point.deps;
    out.status[p] = result.status;
    f.noalias() += Bt.lazyProduct(w * result.sigma);
    if (!out.K) continue;
    some.set(p % kTogether, Bt, w * result.D);
    if ((p + 1) % kTogether == 0) sum_stiffness(some, p < kTogether, Eigen::Map<Matrix<Dofs>>(out.K));
  }
  Eigen::Map<Vector<Dofs>>(out.f) = f;
  return Outcome::ok;
}

// FourElements of those that fit; of others nothing.  pointwise: as OperatorOfFour says.
template <int LawSize, int Dofs, int Points, bool pointwise, bool fit = four_fit(LawSize, Dofs, Points)>
class FoursOfPoints {};

template <int LawSize, int Dofs, int Points, bool pointwise>
class FoursOfPoints<LawSize, Dofs, Points, pointwise, true> : public FourElements {
 public:
  int four_geometry_size() const final { return Points * OperatorOfFour<Dofs, pointwise>::kStride / kAbreast; }
  void place_among_four(std::span<const double> geometry, double* among_four) const final {
    place_geometry_among_four<Dofs, Points, pointwise>(geometry.data(), among_four);
  }
  Outcome evaluate_four(const FourElementsIn& in, FourElementsOut& out) const final {
    return evaluate_points_of_four<Dofs, Points, pointwise>(in, out);
  }

 protected:
  ~FoursOfPoints() = default;
};

// What all elements but Beam2 share: traits and the kernel.
template <int LawSize, int Dofs, int Points, bool pointwise = false>
class PointElement : public Element, public FoursOfPoints<LawSize, Dofs, Points, pointwise> {
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
