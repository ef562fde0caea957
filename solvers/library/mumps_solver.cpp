#include <algorithm>
#include <cmath>
#include <new>
#include <string>

#include <dmumps_c.h>

#include "solvers/library/blas_threads.hpp"
#include "solvers/library/library_solvers.hpp"
#include "solvers/matrix_solver.hpp"

namespace sage {

namespace {

// Sequential MUMPS, multifrontal L U with threshold pivoting.  Numbers of controls are
// those of its user's guide.
class MumpsSolver final : public MatrixSolver {
 public:
  MumpsSolver() : MatrixSolver({"mumps", false}) {
    const std::lock_guard lock(LibraryCall::mutex());
    mumps_.par = 1;
    mumps_.sym = 0;
    mumps_.comm_fortran = -987654;  // the guide's number for MPI_COMM_WORLD
    run(kStart);
    for (const int silent : {1, 2, 3, 4}) control(silent) = 0;
    control(10) = 0;  // no iterative refinement
    control(24) = 1;  // find null pivots
  }
  ~MumpsSolver() override {
    const std::lock_guard lock(LibraryCall::mutex());
    mumps_.job = kEnd;
    dmumps_c(&mumps_);
  }
  MumpsSolver(const MumpsSolver&) = delete;
  MumpsSolver& operator=(const MumpsSolver&) = delete;

  void factorise_matrix() override {
    const int n = matrix().equations();
    if (n == 0) return;
    for (const double term : matrix().value())
      if (!std::isfinite(term)) throw AnalysisError("S504", "the matrix holds a term that is not a number");
    // MUMPS compares with the norm of the scaled matrix; a zero matrix has none.
    const std::span<const double> maxima = row_maxima();
    for (int i = 0; i < n; ++i)
      if (maxima[i] == 0.0) throw_singular(i, 0.0, traits().name);
    const LibraryCall call(n);
    mumps_.cntl[2] = singular_pivot_ratio(n);
    control(14) = 30;  // per cent of working space beyond the estimate
    while (!run(kFactorise)) control(14) *= 2;
    if (mumps_.infog[27] > 0) throw_singular(mumps_.pivnul_list[0] - 1, 0.0, traits().name);
    report_.factor_operations = mumps_.rinfog[2];
    report_.factor_entries = mumps_.infog[28] >= 0 ? mumps_.infog[28] : -1000000LL * mumps_.infog[28];
    report_.memory_bytes =
        (row_.size() + column_.size()) * sizeof(int) + static_cast<std::size_t>(mumps_.infog[21]) * 1000000;
  }

  void solve_matrix(std::span<const double> b, std::span<double> x) const override { solve_system(1, b, x); }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    solve_system(0, b, x);
  }

 protected:
  void analyse_matrix(const EquationGraph&) override {
    const int n = matrix().equations();
    row_.clear();
    column_.clear();
    for (int column = 0; column < n; ++column)
      for (int k = matrix().column_start()[column];
           k < matrix().column_start()[static_cast<std::size_t>(column) + 1]; ++k) {
        row_.push_back(matrix().row()[static_cast<std::size_t>(k)] + 1);
        column_.push_back(column + 1);
      }
    if (n == 0) return;
    mumps_.n = n;
    mumps_.nnz = static_cast<MUMPS_INT8>(row_.size());
    mumps_.irn = row_.data();
    mumps_.jcn = column_.data();
    mumps_.a = const_cast<double*>(matrix().value().data());  // the interface has no const; it only reads
    const LibraryCall call(n);
    control(6) = 0;  // no permutation to a heavy diagonal: it is heavy
    run(kAnalyse);
  }

 private:
  enum Job { kStart = -1, kEnd = -2, kAnalyse = 1, kFactorise = 2, kSolve = 3 };

  int& control(int number) const { return mumps_.icntl[number - 1]; }

  // False where the working space was too small.  Throws where MUMPS fails for good.
  bool run(Job job) const {
    mumps_.job = job;
    dmumps_c(&mumps_);
    const int status = mumps_.infog[0];
    if (status >= 0) return true;
    if (status == -8 || status == -9) return false;
    if (status == -7 || status == -13 || status == -19) throw std::bad_alloc();
    throw AnalysisError("S504", "MUMPS failed with status " + std::to_string(status));
  }

  void solve_system(int original, std::span<const double> b, std::span<double> x) const {
    if (matrix().equations() == 0) return;
    if (b.data() != x.data()) std::ranges::copy(b, x.begin());
    const LibraryCall call(matrix().equations());
    control(9) = original;
    mumps_.nrhs = 1;
    mumps_.lrhs = mumps_.n;
    mumps_.rhs = x.data();
    run(kSolve);
  }

  mutable DMUMPS_STRUC_C mumps_{};
  std::vector<int> row_, column_;  // of every term, from 1
};

}  // namespace

std::unique_ptr<LinearSolver> make_mumps() {
  return std::make_unique<MumpsSolver>();
}

}  // namespace sage
