// What all solvers of this folder share: the assembled matrix, and the checks on its pivots.
#pragma once

#include <utility>

#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"
#include "sage/messages/error.hpp"
#include "solvers/assembled_matrix.hpp"

namespace sage {

// A pivot below this multiple of the largest term of its original row is rounding error: the matrix is
// singular. Rounding adds up with the number of equations.  Meshes of 8 to 200 000 equations left free gave up
// to 1.9e-14 sqrt(n) with every solver; the factor 3e-14 stands above that (docs/theory/solvers.md).
double singular_pivot_ratio(int equations);

class MatrixSolver : public LinearSolver, public ParallelAssembly, public KeptMatrix {
 public:
  explicit MatrixSolver(SolverTraits traits) : traits_(traits) {}
  const SolverTraits& traits() const final { return traits_; }

  void analyse(int equations, ElementEquations elements) final;
  void clear() final { matrix_.clear(); }
  void add(int element, const double* K) final { matrix_.add(element, K); }
  void add_part(const ElementMatrices& some, int part, int parts) final { matrix_.add_part(some, part, parts); }
  void multiply(std::span<const double> x, std::span<double> y) const final { matrix_.multiply(x, y); }
  void multiply_transposed(std::span<const double> x, std::span<double> y) const final {
    matrix_.multiply_transposed(x, y);
  }
  double norm1() const final { return matrix_.norm1(); }
  FactorReport report() const final;
  void configure(const SolverSettings& settings) override { settings_ = settings; }
  // Where terms grew in an elimination without pivoting, answers are refined even if nobody asked.
  void factorise() final;
  // Inaccurate where refinement can not mend what growth has spoilt.
  SolveStatus solve(std::span<const double> b, std::span<double> x) const final;

 protected:
  // Numbering, symbolic work and storage once matrix() has its pattern.
  virtual void analyse_matrix(const EquationGraph& graph) = 0;
  virtual void factorise_matrix() = 0;
  virtual void solve_matrix(std::span<const double> b, std::span<double> x) const = 0;

  const AssembledMatrix& matrix() const { return matrix_; }
  // For those that keep one: set_border() of the next analyse(), where answers are not refined.
  bool take_border(int equations) {
    const bool possible = settings_.refinement_steps == 0;
    border_ = possible ? equations : 0;
    return possible;
  }
  int border_equations() const { return border_; }
  const SolverSettings& settings() const { return settings_; }
  // Throws Stopped.  To be called every thousand operations or so, from any thread.
  void stop_here_if_asked() const { stop_if_asked(settings_.stop_asked); }
  // Largest |term| of every row of the matrix as it stands; the same array at every call.
  // What the pivots of pressures have to be compared with is what displacements leave of them.
  std::span<const double> row_maxima() {
    matrix_.row_maxima(row_maxima_);
    if (!pressure_.empty()) measure_pressures();
    return row_maxima_;
  }
  mutable FactorReport report_;  // its memory: all but the matrix

 private:
  SolveStatus refine(std::span<double> x) const;
  void measure_pressures();

  SolverTraits traits_;
  SolverSettings settings_;
  AssembledMatrix matrix_;
  std::vector<double> row_maxima_;
  std::vector<char> pressure_;  // ElementEquations::pressure
  int steps_ = 0;
  int border_ = 0;
  double norm_ = 0.0;
  mutable std::vector<double> right_side_, residual_, low_;  // of the refinement
};

// Throws SingularMatrix with a text for people who know neither the solver nor its numbering.
[[noreturn]] void throw_singular(int equation, double pivot_ratio, std::string_view solver);

// Follows the pivots of one factorisation.  Throws SingularMatrix at one that is negligible or not a number.
class PivotCheck {
 public:
  // The row maxima must outlive it.
  PivotCheck(std::string_view solver, std::span<const double> row_maxima)
      : solver_(solver),
        row_maxima_(row_maxima),
        negligible_(singular_pivot_ratio(static_cast<int>(row_maxima_.size()))) {}

  void take(int equation, double pivot) {
    const double size = pivot < 0.0 ? -pivot : pivot;
    const double scale = row_maxima_[equation];
    negative_ += pivot < 0.0;
    // The comparison is written so that a pivot that is not a number fails it.
    if (!(size > negligible_ * scale)) throw_singular(equation, scale > 0.0 ? size / scale : 0.0, solver_);
    if (size < smallest_ratio_ * scale) smallest_ratio_ = size / scale;
  }
  double smallest_ratio() const { return smallest_ratio_; }
  int negative() const { return negative_; }
  double largest_term() const;  // of the original matrix

 private:
  std::string_view solver_;
  std::span<const double> row_maxima_;
  double negligible_;
  double smallest_ratio_ = 1e300;
  int negative_ = 0;
};

}  // namespace sage
