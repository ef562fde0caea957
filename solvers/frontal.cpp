#include "solvers/frontal.hpp"

#include <algorithm>

#include "solvers/front_tree.hpp"
#include "solvers/matrix_solver.hpp"
#include "solvers/tile_kernels.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Largest part of the mesh that becomes one dense front.
constexpr int kLeafEquations = 32;

// A front while it is in work.  K counts tiles of pivots; J counts tiles of pivots, then of the border.
struct Arms {
  double* upper;
  double* lower;       // its diagonal tiles are those of L, those of U are in `upper`
  double* reciprocal;  // of the pivots
  int pivot_tiles;
  double* u(int K, int J) const {
    return upper + (static_cast<std::ptrdiff_t>(J) * pivot_tiles + K) * kTileTerms;
  }
  double* l(int K, int I) const {
    return lower + (static_cast<std::ptrdiff_t>(I) * pivot_tiles + K) * kTileTerms;
  }
};

class Frontal final : public MatrixSolver {
 public:
  Frontal() : MatrixSolver({"frontal", false}) {}

  void factorise() override {
    PivotCheck check(traits().name, matrix().row_maxima());
    Lanes maximum{};
    for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
      assemble(static_cast<int>(f));
      eliminate(tree_.fronts[f], check, maximum);
    }
    const bool any = matrix().equations() > 0;
    report_.smallest_pivot_ratio = any ? check.smallest_ratio() : 1.0;
    report_.growth = any ? largest(maximum) / check.largest_term() : 1.0;
  }

  void solve(std::span<const double> b, std::span<double> x) const override { solve_fronts(b, x, false); }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    solve_fronts(b, x, true);
  }

 protected:
  void analyse_matrix(const EquationGraph& graph) override {
    tree_ = make_front_tree(graph, matrix(), kLeafEquations);
    factors_ = AlignedArray(static_cast<std::size_t>(tree_.factor_terms));
    workspace_ = AlignedArray(static_cast<std::size_t>(tree_.workspace_terms));
    first_tile_.assign(1, 0);
    widest_ = 0;
    for (const Front& front : tree_.fronts) {
      first_tile_.push_back(first_tile_.back() + front.pivot_tiles);
      widest_ = std::max(widest_, front.pivot_tiles + front.border_tiles);
    }
    reciprocal_.assign(at(first_tile_.back()) * kTile, 1.0);
    report_.factor_entries = tree_.factor_terms;
    report_.memory_bytes = matrix().memory_bytes() + (factors_.size() + workspace_.size()) * sizeof(double) +
                           tree_.entry_source.size() * (sizeof(int) + sizeof(std::int64_t));
  }

 private:
  Arms arms(int f) {
    const Front& front = tree_.fronts[at(f)];
    double* upper = factors_.data() + front.arms;
    return {upper, upper + front.arm_terms(), reciprocal_.data() + first_tile_[at(f)] * kTile,
            front.pivot_tiles};
  }

  // Original terms and the border matrices of the children.
  void assemble(int f) {
    const Front& front = tree_.fronts[at(f)];
    double* terms = factors_.data() + front.arms;
    std::fill_n(terms, 2 * front.arm_terms(), 0.0);
    std::fill_n(workspace_.data() + front.workspace, front.border_terms(), 0.0);
    const double* value = matrix().value().data();
    for (auto s = at(tree_.entry_start[at(f)]); s < at(tree_.entry_start[at(f) + 1]); ++s)
      terms[tree_.entry_target[s]] = value[tree_.entry_source[s]];
    for (int i = front.pivots; i < front.pivot_tiles * kTile;
         ++i)  // whole tiles: the last rows are the identity
      *(terms + (static_cast<std::ptrdiff_t>(i / kTile) * front.pivot_tiles * kTile + i) * kTile + i % kTile) =
          1.0;
    for (const int child : tree_.children.of(f)) add_border(tree_.fronts[at(child)], front);
  }

  // Extended addition of a child's border matrix.
  void add_border(const Front& child, const Front& front) {
    const int* to = tree_.in_parent.data() + child.border_begin;
    const int pivot_terms = front.pivot_tiles * kTile;
    double* upper = factors_.data() + front.arms;
    double* lower = upper + front.arm_terms();
    double* border = workspace_.data() + front.workspace;
    const int split = static_cast<int>(std::lower_bound(to, to + child.border, pivot_terms) - to);
    for (int c = 0; c < child.border; ++c) {
      const double* source = workspace_.data() + child.workspace +
                             static_cast<std::ptrdiff_t>(c / kTile) * child.border_tiles * kTileTerms +
                             c % kTile;
      const int j = to[c];
      double* u = upper + static_cast<std::ptrdiff_t>(j / kTile) * front.pivot_tiles * kTileTerms + j % kTile;
      int r = 0;
      if (c < split) {
        // A pivot column: rows up to its own tile belong to U, the others to L.
        const int end_of_tile = (j / kTile + 1) * kTile;
        for (; r < child.border && to[r] < end_of_tile; ++r) u[to[r] * kTile] += source[r * kTile];
        for (; r < child.border; ++r) {
          const std::ptrdiff_t panel =
              static_cast<std::ptrdiff_t>(to[r] / kTile) * front.pivot_tiles * kTileTerms;
          lower[panel + j * kTile + to[r] % kTile] += source[r * kTile];
        }
        continue;
      }
      const int b = j - pivot_terms;
      double* target = border + static_cast<std::ptrdiff_t>(b / kTile) * front.border_tiles * kTileTerms +
                       b % kTile - static_cast<std::ptrdiff_t>(pivot_terms) * kTile;
      for (; r < split; ++r) u[to[r] * kTile] += source[r * kTile];
      for (; r < child.border; ++r) target[to[r] * kTile] += source[r * kTile];
    }
  }

  // Elimination of the pivots: as in the skyline solver with full columns, and then the border matrix.
  void eliminate(const Front& front, PivotCheck& check, Lanes& maximum) {
    const int f = static_cast<int>(&front - tree_.fronts.data());
    const Arms a = arms(f);
    const int P = front.pivot_tiles, Q = front.border_tiles;
    for (int J = 0; J < P; ++J) {
      for (int K = 0; K < J; ++K) reduce_tile(a, K, J, maximum);
      reduce_diagonal(a, front, J, check, maximum);
    }
    for (int J = P; J < P + Q; ++J)
      for (int K = 0; K < P; ++K) reduce_tile(a, K, J, maximum);
    double* border = workspace_.data() + front.workspace;
    constexpr int kBlock = 16;
    for (int K = 0; K < P; K += kBlock)
      for (int J = 0; J < Q; ++J)
        for (int I = 0; I < Q; ++I)
          tile_subtract_product(border + (static_cast<std::ptrdiff_t>(J) * Q + I) * kTileTerms, a.l(K, P + I),
                                a.u(K, P + J), std::min(kBlock, P - K));
  }

  static void reduce_tile(const Arms& a, int K, int J, Lanes& maximum) {
    tile_subtract_product(a.u(K, J), a.l(0, K), a.u(0, J), K);
    tile_subtract_product(a.l(K, J), a.u(0, K), a.l(0, J), K);
    tile_solve<true>(a.u(K, J), a.l(K, K), nullptr, maximum);
    tile_solve<false>(a.l(K, J), a.u(K, K), a.reciprocal + K * kTile, maximum);
  }

  void reduce_diagonal(const Arms& a, const Front& front, int J, PivotCheck& check, Lanes& maximum) {
    double* A = a.u(J, J);
    tile_subtract_product(A, a.l(0, J), a.u(0, J), J);
    const int live = std::min(kTile, front.pivots - J * kTile);
    const int* equation = tree_.order.data() + front.first + J * kTile;
    tile_factorise(A, a.l(J, J), a.reciprocal + J * kTile, maximum, [&](int k, double pivot) {
      if (k < live) check.take(equation[k], pivot);
    });
  }

  void solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const;

  FrontTree tree_;
  AlignedArray factors_, workspace_;
  std::vector<int> first_tile_;  // of every front's pivots, in reciprocal_
  std::vector<double> reciprocal_;
  int widest_ = 0;  // tiles of the widest front
};

// Forward through the fronts and back: the first triangle is L (U^T when transposed), the second U (L^T).
void Frontal::solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const {
  std::vector<double> w(at(matrix().equations()));
  AlignedArray local(at(widest_) * kTile);
  double* y = local.data();
  for (std::size_t p = 0; p < w.size(); ++p) w[p] = b[at(tree_.order[p])];
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
    const Front& front = tree_.fronts[f];
    const int* border = tree_.border.data() + front.border_begin;
    const double* arm = factors_.data() + front.arms + (transposed ? 0 : front.arm_terms());
    const double* reciprocal = transposed ? reciprocal_.data() + first_tile_[f] * kTile : nullptr;
    const int P = front.pivot_tiles;
    std::copy_n(w.data() + front.first, front.pivots, y);
    std::fill(y + front.pivots, y + (P + front.border_tiles) * kTile, 0.0);
    for (int J = 0; J < P; ++J) {
      const double* panel = arm + static_cast<std::ptrdiff_t>(J) * P * kTileTerms;
      tile_forward_panel(panel, y, J, y + J * kTile);
      tile_forward_diagonal(panel + J * kTileTerms, reciprocal ? reciprocal + J * kTile : nullptr,
                            y + J * kTile);
    }
    for (int J = P; J < P + front.border_tiles; ++J)
      tile_forward_panel(arm + static_cast<std::ptrdiff_t>(J) * P * kTileTerms, y, P, y + J * kTile);
    std::copy_n(y, front.pivots, w.data() + front.first);
    for (int k = 0; k < front.border; ++k) w[at(border[k])] += y[P * kTile + k];
  }
  for (std::size_t f = tree_.fronts.size(); f-- > 0;) {
    const Front& front = tree_.fronts[f];
    const int* border = tree_.border.data() + front.border_begin;
    const double* arm = factors_.data() + front.arms + (transposed ? front.arm_terms() : 0);
    const double* reciprocal = transposed ? nullptr : reciprocal_.data() + first_tile_[f] * kTile;
    const int P = front.pivot_tiles, all = P + front.border_tiles;
    std::fill(y, y + all * kTile, 0.0);
    std::copy_n(w.data() + front.first, front.pivots, y);
    for (int k = 0; k < front.border; ++k) y[P * kTile + k] = w[at(border[k])];
    for (int K = P - 1; K >= 0; --K) {
      Lanes row[kTile] = {};
      for (int J = K + 1; J < all; ++J)
        tile_multiply_rows(arm + (static_cast<std::ptrdiff_t>(J) * P + K) * kTileTerms, y + J * kTile, row);
      lanes(y + K * kTile) -= tile_sums(row);
      tile_backward_diagonal(arm + (static_cast<std::ptrdiff_t>(K) * P + K) * kTileTerms,
                             reciprocal ? reciprocal + K * kTile : nullptr, y + K * kTile);
    }
    std::copy_n(y, front.pivots, w.data() + front.first);
  }
  for (std::size_t p = 0; p < w.size(); ++p) x[at(tree_.order[p])] = w[p];
}

}  // namespace

std::unique_ptr<LinearSolver> make_frontal() {
  return std::make_unique<Frontal>();
}

}  // namespace sage
