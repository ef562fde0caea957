#include "solvers/skyline.hpp"

#include <algorithm>

#include "solvers/choose_kernels.hpp"
#include "solvers/matrix_solver.hpp"
#include "solvers/tile_profile.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// K = L U by columns of tiles (Crout; L has a unit diagonal).  For column J and K = top .. J - 1:
//   U(K,J) = L(K,K)^-1 (A(K,J) - sum L(K,M) U(M,J)),   L(J,K) = (A(J,K) - sum L(J,M) U(M,K)) U(K,K)^-1,
// M from the lower of the two tops to K - 1, and then L(J,J) U(J,J) = A(J,J) - sum L(J,M) U(M,J).
// Where K is symmetric, U = D L^T and L(J,K) = U(K,J)^T D(K)^-1: L is kept, and of U the column in work.
template <bool symmetric>
class Skyline final : public MatrixSolver {
 public:
  Skyline() : MatrixSolver({symmetric ? "skyline_ldlt" : "skyline_lu", symmetric}) {}

  void configure(const SolverSettings& settings) override {
    MatrixSolver::configure(settings);
    kernels_ = &choose_kernels(settings.kernels);
  }

  void factorise_matrix() override {
    PivotCheck check(traits().name, row_maxima());
    const ProfileFactors factors = factors_in_place();
    alignas(64) double maximum[kTile] = {};
    const double largest = check.largest_term(), filling = largest > 0.0 ? largest : 1.0;
    for (int J = 0; J < profile_.tiles; ++J) {
      stop_here_if_asked();
      fill_column(J, filling);
      kernels_->reduce_profile_column(factors, J, maximum);
      const int live = std::min(kTile, profile_.equations - J * kTile);
      for (int k = 0; k < live; ++k)
        check.take(profile_.order[at(J * kTile + k)], diagonal_[J * kTileTerms + k * kTile + k]);
    }
    report_.smallest_pivot_ratio = profile_.equations > 0 ? check.smallest_ratio() : 1.0;
    report_.growth = profile_.equations > 0 ? *std::ranges::max_element(maximum) / largest : 1.0;
    if constexpr (symmetric) report_.negative_pivots = check.negative();
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
    const auto triangle_terms = static_cast<std::size_t>(profile_.terms());
    const auto diagonal_terms = at(profile_.tiles) * kTileTerms;
    tiles_ = AlignedArray((symmetric ? 1 : 2) * triangle_terms + diagonal_terms);
    diagonal_ = tiles_.data() + triangle_terms;
    if constexpr (symmetric) {
      lower_ = tiles_.data();
      unit_ = diagonal_;
      int height = 0;
      for (int J = 0; J < profile_.tiles; ++J) height = std::max(height, profile_.height(J));
      column_ = AlignedArray(at(height) * kTileTerms);
    } else {
      upper_ = tiles_.data();
      lower_ = diagonal_ + diagonal_terms;
      unit_tiles_ = AlignedArray(diagonal_terms);
      unit_ = unit_tiles_.data();
    }
    reciprocal_.assign(at(profile_.tiles) * kTile, 1.0);
    work_ = AlignedArray(at(profile_.tiles) * kTile);
    report_.kernels = kernels_->name;
    report_.factor_entries = static_cast<std::int64_t>(tiles_.size());
    report_.factor_operations = factor_operations(profile_, symmetric);
    report_.solve_operations = (symmetric ? 4.0 : 2.0) * static_cast<double>(report_.factor_entries);
    report_.memory_bytes = (tiles_.size() + unit_tiles_.size() + column_.size()) * sizeof(double) +
                           2 * scatter_.source.size() * sizeof(int);
  }

 private:
  TileTriangle lower() const { return {lower_, unit_, nullptr}; }
  // Of symmetric matrices without D.
  TileTriangle upper() const {
    return symmetric ? lower() : TileTriangle{upper_, diagonal_, reciprocal_.data()};
  }

  // filling: the diagonal of the rows beyond the last equation, of the size of the matrix's own terms: a larger one
  // would pass for terms that grew.
  void fill_column(int J, double filling) {
    const std::int64_t begin = profile_.offset[at(J)], end = profile_.offset[at(J) + 1];
    std::fill(lower_ + begin, lower_ + end, 0.0);
    if constexpr (!symmetric) std::fill(upper_ + begin, upper_ + end, 0.0);
    double* const diagonal = diagonal_ + J * kTileTerms;
    std::fill_n(diagonal, kTileTerms, 0.0);
    const double* value = matrix().value().data();
    for (auto k = at(scatter_.start[at(J)]); k < at(scatter_.start[at(J) + 1]); ++k)
      tiles_.data()[scatter_.target[k]] = value[scatter_.source[k]];
    if constexpr (symmetric) std::copy(lower_ + begin, lower_ + end, column_.data());
    for (int i = profile_.equations - J * kTile; i < kTile; ++i) diagonal[i * kTile + i] = filling;
  }

  ProfileFactors factors_in_place() {
    return {profile_.shape(), symmetric, upper_, lower_, diagonal_, unit_, reciprocal_.data(), column_.data()};
  }

  void solve_triangles(std::span<const double> b, std::span<double> x, const TileTriangle& first,
                       const TileTriangle& second) const {
    double* const w = work_.data();
    for (int p = 0; p < profile_.equations; ++p) w[p] = b[at(profile_.order[at(p)])];
    for (int p = profile_.equations; p < profile_.tiles * kTile; ++p) w[p] = 0.0;
    kernels_->profile_forward(profile_.shape(), first, w);
    if constexpr (symmetric)
      for (int p = 0; p < profile_.equations; ++p) w[p] *= reciprocal_[at(p)];
    kernels_->profile_backward(profile_.shape(), second, w);
    for (int p = 0; p < profile_.equations; ++p) x[at(profile_.order[at(p)])] = w[p];
  }

  const TileKernels* kernels_ = &choose_kernels(Kernels::automatic);
  TileProfile profile_;
  TileScatter scatter_;
  AlignedArray tiles_;          // U, diagonal and L; for symmetric matrices L and diagonal.  L is transposed
  AlignedArray unit_tiles_;     // diagonal tiles of L beside those of U; symmetric: none
  AlignedArray column_;         // symmetric: the column of U in work
  double* upper_ = nullptr;     // in tiles_; symmetric: none
  double* lower_ = nullptr;     // in tiles_
  double* diagonal_ = nullptr;  // in tiles_: of U, or symmetric: of L
  double* unit_ = nullptr;      // diagonal tiles of L, wherever they are
  std::vector<double> reciprocal_;
  mutable AlignedArray work_;  // used by one solution at a time
};

}  // namespace

std::unique_ptr<LinearSolver> make_skyline_lu() {
  return std::make_unique<Skyline<false>>();
}
std::unique_ptr<LinearSolver> make_skyline_ldlt() {
  return std::make_unique<Skyline<true>>();
}

}  // namespace sage
