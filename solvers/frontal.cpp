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
constexpr int kLeafEquations = 16;

// A front while it is in work.  K counts tiles of pivots; J counts tiles of pivots, then of the border.
struct Arms {
  double* upper;       // U; for symmetric matrices D L^T
  double* lower;       // L, transposed; for symmetric matrices in a scratch array that all fronts share
  double* reciprocal;  // of the pivots
  int pivot_tiles;
  double* u(int K, int J) const { return upper + (std::ptrdiff_t{J} * pivot_tiles + K) * kTileTerms; }
  double* l(int K, int I) const { return lower + (std::ptrdiff_t{I} * pivot_tiles + K) * kTileTerms; }
};

// Neighbouring columns of a child that stay neighbours within one tile of the parent.
struct Run {
  int source_lane, target_lane, count;
};

Run find_run(const int* to, int begin, int end, int source_lane) {
  Run run{source_lane, to[begin] % kTile, 1};
  while (begin + run.count < end && to[begin + run.count] == to[begin] + run.count &&
         run.target_lane + run.count < kTile)
    ++run.count;
  return run;
}

// A length known to the compiler becomes one or two vector operations a row.
template <int count>
void add_rows_of(double* target, const double* source, const int* to, int begin, int end) {
  for (int r = begin; r < end; ++r)
    for (int m = 0; m < count; ++m) target[to[r] * kTile + m] += source[r * kTile + m];
}

void add_rows(double* target, const double* source, const int* to, int begin, int end, const Run& run) {
  source += run.source_lane;
  target += run.target_lane;
  switch (run.count) {
    case 1:
      return add_rows_of<1>(target, source, to, begin, end);
    case 2:
      return add_rows_of<2>(target, source, to, begin, end);
    case 3:
      return add_rows_of<3>(target, source, to, begin, end);
    case 4:
      return add_rows_of<4>(target, source, to, begin, end);
    case 5:
      return add_rows_of<5>(target, source, to, begin, end);
    case 6:
      return add_rows_of<6>(target, source, to, begin, end);
    case 7:
      return add_rows_of<7>(target, source, to, begin, end);
    default:
      return add_rows_of<8>(target, source, to, begin, end);
  }
}

void add_transposed(double* lower, int pivot_tiles, const double* source, const int* to, int begin, int end,
                    int column, int columns, int lane) {
  for (int r = begin; r < end; ++r) {
    double* panel = lower + std::ptrdiff_t{to[r] / kTile} * pivot_tiles * kTileTerms + to[r] % kTile;
    for (int m = 0; m < columns; ++m) panel[to[column + m] * kTile] += source[r * kTile + lane + m];
  }
}

// K = L U, or K = U^T D^-1 U with D the diagonal of U where K is symmetric.
class Frontal final : public MatrixSolver {
 public:
  explicit Frontal(SolverTraits solver_traits) : MatrixSolver(solver_traits) {}

  void factorise() override {
    PivotCheck check(traits().name, matrix().row_maxima());
    Lanes maximum{};
    for (int f = 0; f < static_cast<int>(tree_.fronts.size()); ++f) {
      assemble(f);
      eliminate(f, check, maximum);
    }
    const bool any = matrix().equations() > 0;
    report_.smallest_pivot_ratio = any ? check.smallest_ratio() : 1.0;
    report_.growth = any ? largest(maximum) / check.largest_term() : 1.0;
    if (traits().symmetric) report_.negative_pivots = check.negative();
  }

  void solve(std::span<const double> b, std::span<double> x) const override {
    solve_fronts(b, x, traits().symmetric);
  }
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
    std::int64_t largest_arm = 0;
    for (const Front& front : tree_.fronts) {
      first_tile_.push_back(first_tile_.back() + front.pivot_tiles);
      widest_ = std::max(widest_, front.pivot_tiles + front.border_tiles);
      largest_arm = std::max(largest_arm, front.arm_terms());
    }
    scratch_ = AlignedArray(traits().symmetric ? static_cast<std::size_t>(largest_arm) : 0);
    reciprocal_.assign(at(first_tile_.back()) * kTile, 1.0);
    report_.factor_entries = tree_.factor_terms;
    report_.memory_bytes = matrix().memory_bytes() +
                           (factors_.size() + workspace_.size() + scratch_.size()) * sizeof(double) +
                           tree_.entry_source.size() * (sizeof(int) + sizeof(std::int64_t));
  }

 private:
  Arms arms(int f) {
    const Front& front = tree_.fronts[at(f)];
    double* upper = factors_.data() + front.arms;
    double* lower = traits().symmetric ? scratch_.data() : upper + front.arm_terms();
    return {upper, lower, reciprocal_.data() + first_tile_[at(f)] * kTile, front.pivot_tiles};
  }

  // Original terms and the border matrices of the children.  Of a symmetric matrix only the upper triangle is
  // assembled; what lands below the diagonal of a diagonal tile is never read.
  void assemble(int f) {
    const Front& front = tree_.fronts[at(f)];
    double* terms = factors_.data() + front.arms;
    std::fill_n(terms, (traits().symmetric ? 1 : 2) * front.arm_terms(), 0.0);
    std::fill_n(workspace_.data() + front.workspace, front.border_terms(), 0.0);
    const double* value = matrix().value().data();
    for (auto s = at(tree_.entry_start[at(f)]); s < at(tree_.entry_start[at(f) + 1]); ++s)
      terms[tree_.entry_target[s]] = value[tree_.entry_source[s]];
    const Arms a = arms(f);
    for (int i = front.pivots; i < front.pivot_tiles * kTile;
         ++i)  // whole tiles: the last rows are the identity
      a.u(i / kTile, i / kTile)[(i % kTile) * kTile + i % kTile] = 1.0;
    for (const int child : tree_.children.of(f)) add_border(tree_.fronts[at(child)], front, a);
  }

  // Extended addition of a child's border matrix, eight columns at a time.
  void add_border(const Front& child, const Front& front, const Arms& a) {
    const int* to = tree_.in_parent.data() + child.border_begin;
    const int pivot_rows = front.pivot_tiles * kTile;
    double* border = workspace_.data() + front.workspace;
    const auto rows_below = [&](int end) {
      return static_cast<int>(std::lower_bound(to, to + child.border, end) - to);
    };
    const int split = rows_below(pivot_rows);
    for (int c = 0; c < child.border; c += kTile) {
      const double* source =
          workspace_.data() + child.workspace + std::ptrdiff_t{c} * child.border_tiles * kTile;
      const int end = std::min(c + kTile, child.border);
      for (int s = c; s < end;) {
        const Run run = find_run(to, s, end, s - c);
        const int J = to[s] / kTile, rows = traits().symmetric ? s + run.count : child.border;
        if (s < split) {  // a pivot column: rows up to its own tile belong to U, the others to L
          const int own = std::min(rows, rows_below((J + 1) * kTile));
          add_rows(a.u(0, J), source, to, 0, own, run);
          if (!traits().symmetric)
            add_transposed(a.lower, front.pivot_tiles, source, to, own, rows, s, run.count, s - c);
        } else {
          const std::ptrdiff_t panel = std::ptrdiff_t{J - front.pivot_tiles} * front.border_tiles * kTileTerms;
          add_rows(a.u(0, J), source, to, 0, split, run);
          add_rows(border + panel - std::ptrdiff_t{pivot_rows} * kTile, source, to, split, rows, run);
        }
        s += run.count;
      }
    }
  }

  // Elimination of the pivots: as in the skyline solver with full columns, and then the border matrix.
  void eliminate(int f, PivotCheck& check, Lanes& maximum) {
    const Front& front = tree_.fronts[at(f)];
    const Arms a = arms(f);
    const int P = front.pivot_tiles, Q = front.border_tiles;
    for (int J = 0; J < P; ++J) {
      reduce_columns<1>(a, J, J, maximum);
      reduce_diagonal(a, front, J, check, maximum);
    }
    int J = P;
    for (; J + kWidth <= P + Q; J += kWidth) reduce_columns<kWidth>(a, P, J, maximum);
    for (; J < P + Q; ++J) reduce_columns<1>(a, P, J, maximum);
    double* border = workspace_.data() + front.workspace;
    // Blocks of pivots whose arms stay in the nearest cache.
    constexpr int kBlock = 16;
    for (int K = 0; K < P; K += kBlock) {
      for (J = 0; J + kWidth <= Q; J += kWidth)
        update_border<kWidth>(a, border, Q, K, std::min(kBlock, P - K), J);
      for (; J < Q; ++J) update_border<1>(a, border, Q, K, std::min(kBlock, P - K), J);
    }
  }

  // Tile rows 0 .. rows - 1 of U in `width` tile columns beginning at J, and the same of L.
  template <int width>
  void reduce_columns(const Arms& a, int rows, int J, Lanes& maximum) const {
    const std::ptrdiff_t stride = std::ptrdiff_t{a.pivot_tiles} * kTileTerms;
    for (int K = 0; K < rows; ++K) {
      tile_subtract_products<width>(a.u(K, J), stride, a.l(0, K), a.u(0, J), stride, K);
      if (!traits().symmetric)
        tile_subtract_products<width>(a.l(K, J), stride, a.u(0, K), a.l(0, J), stride, K);
      const double* reciprocal = a.reciprocal + K * kTile;
      for (int w = J; w < J + width; ++w) {
        tile_solve<true>(a.u(K, w), a.l(K, K), nullptr, maximum);
        if (!traits().symmetric)
          tile_solve<false>(a.l(K, w), a.u(K, K), reciprocal, maximum);
        else
          tile_scale_rows(a.l(K, w), a.u(K, w), reciprocal);
      }
    }
  }

  void reduce_diagonal(const Arms& a, const Front& front, int J, PivotCheck& check, Lanes& maximum) const {
    double* A = a.u(J, J);
    if (traits().symmetric) tile_mirror(A);
    tile_subtract_product(A, a.l(0, J), a.u(0, J), J);
    const int live = std::min(kTile, front.pivots - J * kTile);
    const int* equation = tree_.order.data() + front.first + J * kTile;
    tile_factorise(A, a.l(J, J), a.reciprocal + J * kTile, maximum, [&](int k, double pivot) {
      if (k < live) check.take(equation[k], pivot);
    });
  }

  // Border columns J .. J + width - 1 take the product of `tiles` pivot tiles beginning at K.
  template <int width>
  void update_border(const Arms& a, double* border, int Q, int K, int tiles, int J) const {
    const std::ptrdiff_t arm_stride = std::ptrdiff_t{a.pivot_tiles} * kTileTerms,
                         stride = std::ptrdiff_t{Q} * kTileTerms;
    const int P = a.pivot_tiles, rows = traits().symmetric ? J + width : Q;
    for (int I = 0; I < rows; ++I)
      tile_subtract_products<width>(border + J * stride + I * kTileTerms, stride, a.l(K, P + I), a.u(K, P + J),
                                    arm_stride, tiles);
  }

  void solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const;
  void forward(const Front& front, const double* arm, const double* reciprocal, double* w, double* y) const;
  void backward(const Front& front, const double* arm, const double* reciprocal, double* w, double* y) const;

  FrontTree tree_;
  AlignedArray factors_, workspace_, scratch_;
  std::vector<int> first_tile_;  // of every front's pivots, in reciprocal_
  std::vector<double> reciprocal_;
  int widest_ = 0;  // tiles of the widest front
};

// Pivots of one front by forward substitution; their share of the border goes to w.
void Frontal::forward(const Front& front, const double* arm, const double* reciprocal, double* w,
                      double* y) const {
  const int* border = tree_.border.data() + front.border_begin;
  const int P = front.pivot_tiles;
  std::copy_n(w + front.first, front.pivots, y);
  std::fill(y + front.pivots, y + (P + front.border_tiles) * kTile, 0.0);
  for (int J = 0; J < P + front.border_tiles; ++J) {
    const double* panel = arm + std::ptrdiff_t{J} * P * kTileTerms;
    tile_forward_panel(panel, y, std::min(J, P), y + J * kTile);
    if (J < P)
      tile_forward_diagonal(panel + J * kTileTerms, reciprocal ? reciprocal + J * kTile : nullptr,
                            y + J * kTile);
  }
  std::copy_n(y, front.pivots, w + front.first);
  for (int k = 0; k < front.border; ++k) w[border[k]] += y[P * kTile + k];
}

// Pivots of one front by back substitution; the border is known.
void Frontal::backward(const Front& front, const double* arm, const double* reciprocal, double* w,
                       double* y) const {
  const int* border = tree_.border.data() + front.border_begin;
  const int P = front.pivot_tiles, all = P + front.border_tiles;
  std::fill(y, y + all * kTile, 0.0);
  std::copy_n(w + front.first, front.pivots, y);
  for (int k = 0; k < front.border; ++k) y[P * kTile + k] = w[border[k]];
  for (int K = P - 1; K >= 0; --K) {
    Lanes row[kTile] = {};
    for (int J = K + 1; J < all; ++J)
      tile_multiply_rows(arm + (std::ptrdiff_t{J} * P + K) * kTileTerms, y + J * kTile, row);
    tile_subtract_sums(row, y + K * kTile);
    tile_backward_diagonal(arm + (std::ptrdiff_t{K} * P + K) * kTileTerms,
                           reciprocal ? reciprocal + K * kTile : nullptr, y + K * kTile);
  }
  std::copy_n(y, front.pivots, w + front.first);
}

// L then U; transposed: U^T, then L^T.  For symmetric matrices L^T = D^-1 U.
void Frontal::solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const {
  std::vector<double> w(at(matrix().equations()));
  AlignedArray local(at(widest_) * kTile);
  for (std::size_t p = 0; p < w.size(); ++p) w[p] = b[at(tree_.order[p])];
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
    const Front& front = tree_.fronts[f];
    const double* upper = factors_.data() + front.arms;
    const double* reciprocal = reciprocal_.data() + first_tile_[f] * kTile;
    if (transposed)
      forward(front, upper, reciprocal, w.data(), local.data());
    else
      forward(front, upper + front.arm_terms(), nullptr, w.data(), local.data());
    if (traits().symmetric)
      for (int k = 0; k < front.pivots; ++k) w[at(front.first + k)] /= reciprocal[k];
  }
  for (std::size_t f = tree_.fronts.size(); f-- > 0;) {
    const Front& front = tree_.fronts[f];
    const double* upper = factors_.data() + front.arms;
    const double* reciprocal = reciprocal_.data() + first_tile_[f] * kTile;
    if (transposed && !traits().symmetric)
      backward(front, upper + front.arm_terms(), nullptr, w.data(), local.data());
    else
      backward(front, upper, reciprocal, w.data(), local.data());
  }
  for (std::size_t p = 0; p < w.size(); ++p) x[at(tree_.order[p])] = w[p];
}

}  // namespace

std::unique_ptr<LinearSolver> make_frontal() {
  return std::make_unique<Frontal>(SolverTraits{"frontal", false});
}
std::unique_ptr<LinearSolver> make_frontal_ldlt() {
  return std::make_unique<Frontal>(SolverTraits{"frontal_ldlt", true});
}

}  // namespace sage
