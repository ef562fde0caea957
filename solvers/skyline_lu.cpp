#include "solvers/skyline_lu.hpp"

#include <algorithm>

#include "solvers/matrix_solver.hpp"
#include "solvers/tile_kernels.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// K = L U by columns of tiles (Crout; L has a unit diagonal).  For column J and K = top .. J - 1:
//   U(K,J) = L(K,K)^-1 (A(K,J) - sum L(K,M) U(M,J)),   L(J,K) = (A(J,K) - sum L(J,M) U(M,K)) U(K,K)^-1,
// M from the lower of the two tops to K - 1, and then L(J,J) U(J,J) = A(J,J) - sum L(J,M) U(M,J).
class SkylineLu final : public MatrixSolver {
 public:
  SkylineLu() : MatrixSolver({"skyline_lu", false}) {}

  void factorise_matrix() override {
    PivotCheck check(traits().name, row_maxima());
    Lanes maximum{};
    for (int J = 0; J < profile_.tiles; ++J) {
      stop_here_if_asked();
      fill_column(J);
      for (int K = profile_.top[at(J)]; K < J; ++K) reduce_tile(K, J, maximum);
      reduce_diagonal(J, check, maximum);
    }
    report_.smallest_pivot_ratio = profile_.equations > 0 ? check.smallest_ratio() : 1.0;
    report_.growth = profile_.equations > 0 ? largest(maximum) / check.largest_term() : 1.0;
  }

  void solve_matrix(std::span<const double> b, std::span<double> x) const override {
    solve_triangles(b, x, lower(), upper());
  }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    solve_triangles(b, x, upper(), lower());
  }

 protected:
  void analyse_matrix(const EquationGraph& graph) override {
    profile_ = make_tile_profile(graph);
    scatter_ = make_tile_scatter(profile_, matrix());
    const auto diagonal_terms = at(profile_.tiles) * kTileTerms;
    tiles_ = AlignedArray(2 * static_cast<std::size_t>(profile_.terms()) + diagonal_terms);
    upper_ = tiles_.data();
    diagonal_ = upper_ + profile_.terms();
    lower_ = diagonal_ + diagonal_terms;
    unit_ = AlignedArray(diagonal_terms);
    reciprocal_.assign(at(profile_.tiles) * kTile, 1.0);
    work_ = AlignedArray(at(profile_.tiles) * kTile);
    report_.factor_entries = static_cast<std::int64_t>(tiles_.size());
    report_.memory_bytes =
        (tiles_.size() + unit_.size()) * sizeof(double) + 2 * scatter_.source.size() * sizeof(int);
  }

 private:
  TileTriangle lower() const { return {lower_, unit_.data(), nullptr}; }
  TileTriangle upper() const { return {upper_, diagonal_, reciprocal_.data()}; }

  void fill_column(int J) {
    const std::int64_t begin = profile_.offset[at(J)], end = profile_.offset[at(J) + 1];
    std::fill(upper_ + begin, upper_ + end, 0.0);
    std::fill(lower_ + begin, lower_ + end, 0.0);
    std::fill_n(diagonal_ + J * kTileTerms, kTileTerms, 0.0);
    const double* value = matrix().value().data();
    for (auto k = at(scatter_.start[at(J)]); k < at(scatter_.start[at(J) + 1]); ++k)
      tiles_.data()[scatter_.target[k]] = value[scatter_.source[k]];
    for (int i = profile_.equations - J * kTile; i < kTile; ++i)  // whole tiles: the last rows are the identity
      diagonal_[J * kTileTerms + i * kTile + i] = 1.0;
  }

  void reduce_tile(int K, int J, Lanes& maximum) {
    const int first = std::max(profile_.top[at(K)], profile_.top[at(J)]);
    const std::int64_t kj = profile_.tile(K, J), mj = profile_.tile(first, J), mk = profile_.tile(first, K);
    tile_subtract_product(upper_ + kj, lower_ + mk, upper_ + mj, K - first);
    tile_subtract_product(lower_ + kj, upper_ + mk, lower_ + mj, K - first);
    tile_solve<true>(upper_ + kj, unit_.data() + K * kTileTerms, nullptr, maximum);
    tile_solve<false>(lower_ + kj, diagonal_ + K * kTileTerms, reciprocal_.data() + K * kTile, maximum);
  }

  void reduce_diagonal(int J, PivotCheck& check, Lanes& maximum) {
    double* A = diagonal_ + J * kTileTerms;
    const std::int64_t column = profile_.offset[at(J)];
    tile_subtract_product(A, lower_ + column, upper_ + column, profile_.height(J));
    const int live = std::min(kTile, profile_.equations - J * kTile);
    const int* equation = profile_.order.data() + J * kTile;
    tile_factorise(A, unit_.data() + J * kTileTerms, reciprocal_.data() + J * kTile, maximum,
                   [&](int k, double pivot) {
                     if (k < live) check.take(equation[k], pivot);
                   });
  }

  void solve_triangles(std::span<const double> b, std::span<double> x, const TileTriangle& first,
                       const TileTriangle& second) const {
    double* const w = work_.data();
    for (int p = 0; p < profile_.equations; ++p) w[p] = b[at(profile_.order[at(p)])];
    for (int p = profile_.equations; p < profile_.tiles * kTile; ++p) w[p] = 0.0;
    tile_forward(profile_, first, w);
    tile_backward(profile_, second, w);
    for (int p = 0; p < profile_.equations; ++p) x[at(profile_.order[at(p)])] = w[p];
  }

  TileProfile profile_;
  TileScatter scatter_;
  AlignedArray tiles_;  // upper, diagonal and lower tiles
  double* upper_ = nullptr;
  double* diagonal_ = nullptr;
  double* lower_ = nullptr;
  AlignedArray unit_;  // diagonal tiles of L, transposed; those of U stay in diagonal_
  std::vector<double> reciprocal_;
  mutable AlignedArray work_;  // used by one solution at a time
};

}  // namespace

std::unique_ptr<LinearSolver> make_skyline_lu() {
  return std::make_unique<SkylineLu>();
}

}  // namespace sage
