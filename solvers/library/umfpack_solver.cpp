#include <new>
#include <string>

#include <umfpack.h>

#include "solvers/library/blas_threads.hpp"
#include "solvers/library/library_solvers.hpp"
#include "solvers/library/long_columns.hpp"
#include "solvers/matrix_solver.hpp"

namespace sage {

namespace {

struct FreeSymbolic {
  void operator()(void* p) const { umfpack_dl_free_symbolic(&p); }
};
struct FreeNumeric {
  void operator()(void* p) const { umfpack_dl_free_numeric(&p); }
};

// UMFPACK's multifrontal L U with its symmetric strategy: the patterns of finite-element matrices are symmetric
// and their diagonals heavy.  No refinement steps: the iteration around the solver does that.
class UmfpackSolver final : public MatrixSolver {
 public:
  UmfpackSolver() : MatrixSolver({"umfpack", false}) {
    umfpack_dl_defaults(control_);
    control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control_[UMFPACK_IRSTEP] = 0;
  }

  void factorise_matrix() override {
    const int n = matrix().equations();
    if (n == 0) return;
    const LibraryCall call(n);
    numeric_.reset();
    void* numeric = nullptr;
    double info[UMFPACK_INFO];
    const auto status = umfpack_dl_numeric(columns_.start.data(), columns_.row.data(), matrix().value().data(),
                                           symbolic_.get(), &numeric, control_, info);
    numeric_.reset(numeric);
    if (status != UMFPACK_WARNING_singular_matrix) throw_unless_ok(status);
    check_pivots(status == UMFPACK_WARNING_singular_matrix);
    report_.factor_operations = info[UMFPACK_FLOPS];
    report_.factor_entries = static_cast<std::int64_t>(info[UMFPACK_LNZ] + info[UMFPACK_UNZ]);
    report_.memory_bytes = columns_.memory_bytes() +
                           static_cast<std::size_t>(info[UMFPACK_NUMERIC_SIZE] * info[UMFPACK_SIZE_OF_UNIT]);
  }

  void solve_matrix(std::span<const double> b, std::span<double> x) const override {
    solve_system(UMFPACK_A, b, x);
  }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    solve_system(UMFPACK_At, b, x);
  }

 protected:
  void analyse_matrix(const EquationGraph&) override {
    numeric_.reset();
    symbolic_.reset();
    columns_ = LongColumns(matrix());
    const int n = matrix().equations();
    if (n == 0) return;
    void* symbolic = nullptr;
    double info[UMFPACK_INFO];
    const auto status = umfpack_dl_symbolic(n, n, columns_.start.data(), columns_.row.data(), nullptr,
                                            &symbolic, control_, info);
    symbolic_.reset(symbolic);
    throw_unless_ok(status);
    // Its other strategy has cost seven digits: it must not come back by a default of another version.
    if (info[UMFPACK_STRATEGY_USED] != UMFPACK_STRATEGY_SYMMETRIC)
      throw AnalysisError("S504", "UMFPACK did not take its symmetric strategy");
  }

 private:
  static void throw_unless_ok(SuiteSparse_long status) {
    if (status == UMFPACK_OK) return;
    if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
    throw AnalysisError("S504", "UMFPACK failed with status " + std::to_string(status));
  }

  // UMFPACK factorises P R K Q with R = 1 / row sums; pivots go back to the scale of K.
  void check_pivots(bool known_singular) {
    const auto n = static_cast<std::size_t>(matrix().equations());
    std::vector<double> pivot(n), row_scale(n);
    std::vector<SuiteSparse_long> row(n);
    SuiteSparse_long multiply = 0;
    throw_unless_ok(umfpack_dl_get_numeric(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, row.data(),
                                           nullptr, pivot.data(), &multiply, row_scale.data(), numeric_.get()));
    PivotCheck check(traits().name, row_maxima());
    for (std::size_t k = 0; k < n; ++k) {
      const double scale = row_scale[row[k]];
      check.take(static_cast<int>(row[k]), multiply ? pivot[k] / scale : pivot[k] * scale);
    }
    if (known_singular)
      throw AnalysisError("S504", "UMFPACK calls the matrix singular but shows no small pivot");
    report_.smallest_pivot_ratio = check.smallest_ratio();
  }

  void solve_system(SuiteSparse_long system, std::span<const double> b, std::span<double> x) const {
    if (matrix().equations() == 0) return;
    const std::vector<double> right_side(b.begin(), b.end());  // b and x may be the same vector
    const LibraryCall call(matrix().equations());
    throw_unless_ok(umfpack_dl_solve(system, columns_.start.data(), columns_.row.data(),
                                     matrix().value().data(), x.data(), right_side.data(), numeric_.get(),
                                     control_, nullptr));
  }

  double control_[UMFPACK_CONTROL];
  LongColumns columns_;
  std::unique_ptr<void, FreeSymbolic> symbolic_;
  std::unique_ptr<void, FreeNumeric> numeric_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_umfpack() {
  return std::make_unique<UmfpackSolver>();
}

}  // namespace sage
