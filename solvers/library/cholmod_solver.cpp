#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

#include <cholmod.h>

#include "solvers/library/blas_threads.hpp"
#include "solvers/library/library_solvers.hpp"
#include "solvers/library/long_columns.hpp"
#include "solvers/matrix_solver.hpp"

namespace sage {

namespace {

// CHOLMOD: simplicial L D L^T for small systems, supernodal L L^T for large ones (its own rule: work per term
// of L). A large matrix that is not positive definite is factorised once more by L D L^T, which takes any sign.
class CholmodSolver final : public MatrixSolver {
 public:
  CholmodSolver() : MatrixSolver({"cholmod", true}) {
    cholmod_l_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_AMD;
  }
  ~CholmodSolver() override {
    release();
    cholmod_l_finish(&common_);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  void factorise_matrix() override {
    if (matrix().equations() == 0) return;
    const LibraryCall call(matrix().equations());
    cholmod_sparse K = view();
    if (!factor_->is_super || !factorise_definite(K)) factorise_indefinite(K);
    report_.factor_operations = common_.fl;
    report_.factor_entries = static_cast<std::int64_t>(common_.lnz);
    report_.memory_bytes = columns_.memory_bytes() + common_.memory_inuse;
  }

  void solve_matrix(std::span<const double> b, std::span<double> x) const override {
    const auto n = static_cast<std::size_t>(matrix().equations());
    if (n == 0) return;
    const LibraryCall call(matrix().equations());
    cholmod_dense right_side{};
    right_side.nrow = right_side.d = right_side.nzmax = n;
    right_side.ncol = 1;
    right_side.x = const_cast<double*>(b.data());  // the interface has no const; it only reads
    right_side.xtype = CHOLMOD_REAL;
    right_side.dtype = CHOLMOD_DOUBLE;
    cholmod_l_solve2(CHOLMOD_A, current_, &right_side, nullptr, &solution_, nullptr, &work_y_, &work_e_,
                     &common_);
    throw_unless_ok();
    std::copy_n(static_cast<const double*>(solution_->x), n, x.begin());
  }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override { solve_matrix(b, x); }

 protected:
  void analyse_matrix(const EquationGraph&) override {
    release();
    columns_ = LongColumns(matrix());
    if (matrix().equations() == 0) return;
    common_.supernodal = CHOLMOD_AUTO;
    factor_ = analyse_pattern();
  }

 private:
  cholmod_sparse view() {
    cholmod_sparse K{};
    K.nrow = K.ncol = static_cast<std::size_t>(matrix().equations());
    K.nzmax = columns_.row.size();
    K.p = columns_.start.data();
    K.i = columns_.row.data();
    K.x = const_cast<double*>(matrix().value().data());  // the interface has no const; it only reads
    K.stype = 1;
    K.itype = CHOLMOD_LONG;
    K.xtype = CHOLMOD_REAL;
    K.dtype = CHOLMOD_DOUBLE;
    K.sorted = K.packed = 1;
    return K;
  }

  cholmod_factor* analyse_pattern() {
    cholmod_sparse K = view();
    cholmod_factor* factor = cholmod_l_analyze(&K, &common_);
    throw_unless_ok();
    return factor;
  }

  // False where the matrix is not positive definite.
  bool factorise_definite(cholmod_sparse& K) {
    current_ = factor_;
    cholmod_l_factorize(&K, factor_, &common_);
    if (common_.status == CHOLMOD_NOT_POSDEF) return false;
    throw_unless_ok();
    PivotCheck check(traits().name, row_maxima());
    const auto *first = as_long(factor_->super), *rows = as_long(factor_->pi), *start = as_long(factor_->px);
    const auto* L = static_cast<const double*>(factor_->x);
    for (std::size_t s = 0; s < factor_->nsuper; ++s)
      for (SuiteSparse_long k = 0; k < first[s + 1] - first[s]; ++k) {
        const double root = L[start[s] + k * (rows[s + 1] - rows[s]) + k];
        check.take(equation(factor_, first[s] + k), root * root);
      }
    take_report(check);
    return true;
  }

  void factorise_indefinite(cholmod_sparse& K) {
    if (factor_->is_super && !indefinite_) {
      common_.supernodal = CHOLMOD_SIMPLICIAL;
      indefinite_ = analyse_pattern();
    }
    current_ = factor_->is_super ? indefinite_ : factor_;
    cholmod_l_factorize(&K, current_, &common_);
    const bool stopped = common_.status == CHOLMOD_NOT_POSDEF;
    if (!stopped) throw_unless_ok();
    PivotCheck check(traits().name, row_maxima());
    const auto n = static_cast<SuiteSparse_long>(current_->n);
    const auto minor = std::min(n, static_cast<SuiteSparse_long>(current_->minor));
    const auto* start = as_long(current_->p);
    const auto* L = static_cast<const double*>(current_->x);
    const auto* count = as_long(current_->nz);
    double size = 0.0;  // of the largest term of any reduced matrix: D L^T has them all
    for (SuiteSparse_long j = 0; j < minor; ++j) {
      const double pivot = L[start[j]];
      check.take(equation(current_, j), pivot);
      double factor = 1.0;
      for (SuiteSparse_long k = start[j] + 1; k < start[j] + count[j]; ++k)
        factor = std::max(factor, std::abs(L[k]));
      size = std::max(size, factor * std::abs(pivot));
    }
    if (stopped) throw_singular(equation(current_, std::min(minor, n - 1)), 0.0, traits().name);
    take_report(check);
    report_.growth = size / check.largest_term();
  }

  static const SuiteSparse_long* as_long(const void* p) { return static_cast<const SuiteSparse_long*>(p); }
  static int equation(const cholmod_factor* factor, SuiteSparse_long position) {
    return static_cast<int>(as_long(factor->Perm)[position]);
  }
  void take_report(const PivotCheck& check) {
    report_.smallest_pivot_ratio = check.smallest_ratio();
    report_.negative_pivots = check.negative();
    report_.growth = 1.0;  // of a positive definite matrix: terms never grow
  }

  void throw_unless_ok() const {
    if (common_.status >= CHOLMOD_OK) return;
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common_.status == CHOLMOD_TOO_LARGE) throw std::length_error("CHOLMOD: the factors are too large");
    throw AnalysisError("S504", "CHOLMOD failed with status " + std::to_string(common_.status));
  }

  void release() {
    cholmod_l_free_factor(&factor_, &common_);
    cholmod_l_free_factor(&indefinite_, &common_);
    for (cholmod_dense** dense : {&solution_, &work_y_, &work_e_}) cholmod_l_free_dense(dense, &common_);
    current_ = nullptr;
  }

  mutable cholmod_common common_;
  LongColumns columns_;
  cholmod_factor* factor_ = nullptr;
  cholmod_factor* indefinite_ = nullptr;
  cholmod_factor* current_ = nullptr;  // the one that solves
  mutable cholmod_dense *solution_ = nullptr, *work_y_ = nullptr, *work_e_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod() {
  return std::make_unique<CholmodSolver>();
}

}  // namespace sage
