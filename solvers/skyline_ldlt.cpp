#include "solvers/skyline_ldlt.hpp"

#include <algorithm>

#include "solvers/matrix_solver.hpp"
#include "solvers/tile_kernels.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// K = L D L^T by columns of tiles.  With G = D L^T, for column J and K = top .. J - 1:
//   G(K,J) = L(K,K)^-1 (A(K,J) - sum L(K,M) G(M,J)),   then L(J,K) = G(K,J)^T D(K)^-1,
// and L(J,J) D(J) L(J,J)^T = A(J,J) - sum L(J,M) G(M,J).
class SkylineLdlt final : public MatrixSolver {
 public:
  SkylineLdlt() : MatrixSolver({"skyline_ldlt", true}) {}

  void factorise_matrix() override {
    PivotCheck check(traits().name, row_maxima());
    Lanes maximum{};
    for (int J = 0; J < profile_.tiles; ++J) {
      stop_here_if_asked();
      fill_column(J);
      for (int K = profile_.top[at(J)]; K < J; ++K) reduce_tile(K, J, maximum);
      for (int K = profile_.top[at(J)]; K < J; ++K) scale_tile(K, J);
      reduce_diagonal(J, check, maximum);
    }
    report_.smallest_pivot_ratio = profile_.equations > 0 ? check.smallest_ratio() : 1.0;
    report_.growth = profile_.equations > 0 ? largest(maximum) / check.largest_term() : 1.0;
    report_.negative_pivots = check.negative();
  }

  void solve_matrix(std::span<const double> b, std::span<double> x) const override {
    double* const w = work_.data();
    for (int p = 0; p < profile_.equations; ++p) w[p] = b[at(profile_.order[at(p)])];
    for (int p = profile_.equations; p < profile_.tiles * kTile; ++p) w[p] = 0.0;
    const TileTriangle L{tiles_.data(), diagonal_, nullptr};
    tile_forward(profile_, L, w);
    for (int p = 0; p < profile_.equations; ++p) w[p] *= reciprocal_[at(p)];
    tile_backward(profile_, L, w);
    for (int p = 0; p < profile_.equations; ++p) x[at(profile_.order[at(p)])] = w[p];
  }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override { solve_matrix(b, x); }

 protected:
  void analyse_matrix(const EquationGraph& graph) override {
    profile_ = make_tile_profile(graph);
    scatter_ = make_tile_scatter(profile_, matrix());
    tiles_ = AlignedArray(static_cast<std::size_t>(profile_.terms()) + at(profile_.tiles) * kTileTerms);
    diagonal_ = tiles_.data() + profile_.terms();
    int height = 0;
    for (int J = 0; J < profile_.tiles; ++J) height = std::max(height, profile_.height(J));
    column_ = AlignedArray(at(height) * kTileTerms);
    reciprocal_.assign(at(profile_.tiles) * kTile, 1.0);
    work_ = AlignedArray(at(profile_.tiles) * kTile);
    report_.factor_entries = static_cast<std::int64_t>(tiles_.size());
    report_.memory_bytes =
        (tiles_.size() + column_.size()) * sizeof(double) + 2 * scatter_.source.size() * sizeof(int);
  }

 private:
  void fill_column(int J) {
    const std::int64_t begin = profile_.offset[at(J)], end = profile_.offset[at(J) + 1];
    std::fill(tiles_.data() + begin, tiles_.data() + end, 0.0);
    double* diagonal = diagonal_ + J * kTileTerms;
    std::fill_n(diagonal, kTileTerms, 0.0);
    const double* value = matrix().value().data();
    for (auto k = at(scatter_.start[at(J)]); k < at(scatter_.start[at(J) + 1]); ++k)
      tiles_.data()[scatter_.target[k]] = value[scatter_.source[k]];
    std::copy(tiles_.data() + begin, tiles_.data() + end, column_.data());
    for (int i = std::max(0, profile_.equations - J * kTile); i < kTile; ++i)  // whole tiles: identity
      diagonal[i * kTile + i] = 1.0;
  }

  void reduce_tile(int K, int J, Lanes& maximum) {
    const int top = profile_.top[at(J)], first = std::max(profile_.top[at(K)], top);
    double* G = column_.data() + (K - top) * kTileTerms;
    const double* earlier = column_.data() + (first - top) * kTileTerms;
    tile_subtract_product(G, tiles_.data() + profile_.tile(first, K), earlier, K - first);
    tile_solve<true>(G, diagonal_ + K * kTileTerms, nullptr, maximum);
  }

  void scale_tile(int K, int J) {
    const double* G = column_.data() + (K - profile_.top[at(J)]) * kTileTerms;
    double* L = tiles_.data() + profile_.tile(K, J);
    tile_scale_rows(L, G, reciprocal_.data() + K * kTile);
  }

  // Elimination of the upper triangle of the diagonal tile; leaves L, transposed, in its place.
  void reduce_diagonal(int J, PivotCheck& check, Lanes& maximum) {
    double* A = diagonal_ + J * kTileTerms;
    tile_subtract_product(A, tiles_.data() + profile_.offset[at(J)], column_.data(), profile_.height(J));
    for (int k = 0; k < kTile; ++k) {
      const int position = J * kTile + k;
      if (position < profile_.equations) check.take(profile_.order[at(position)], A[k * kTile + k]);
      tile_raise_maximum(maximum, Lanes{} + A[k * kTile + k]);
      const double reciprocal = 1.0 / A[k * kTile + k];
      reciprocal_[at(position)] = reciprocal;
      for (int i = k + 1; i < kTile; ++i) {
        const double factor = A[k * kTile + i] * reciprocal;
        for (int j = i; j < kTile; ++j) A[i * kTile + j] -= factor * A[k * kTile + j];
      }
      for (int i = k + 1; i < kTile; ++i) A[k * kTile + i] *= reciprocal;
    }
  }

  TileProfile profile_;
  TileScatter scatter_;
  AlignedArray tiles_;  // L transposed, then the diagonal tiles
  double* diagonal_ = nullptr;
  AlignedArray column_;  // the column of D L^T in work
  std::vector<double> reciprocal_;
  mutable AlignedArray work_;  // used by one solution at a time
};

}  // namespace

std::unique_ptr<LinearSolver> make_skyline_ldlt() {
  return std::make_unique<SkylineLdlt>();
}

}  // namespace sage
