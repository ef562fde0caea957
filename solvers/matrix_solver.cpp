#include "solvers/matrix_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace sage {

namespace {

double largest_size(std::span<const double> x) {
  double largest = 0.0;
  for (const double term : x)
    if (!(std::abs(term) <= largest)) largest = std::abs(term);  // what is not a number stays
  return largest;
}

}  // namespace

void MatrixSolver::analyse(int equations, ElementEquations elements) {
  report_ = {};
  stop_here_if_asked();
  const EquationGraph graph = make_equation_graph(equations, elements, border_);
  matrix_.analyse(graph, std::move(elements), traits_.symmetric);
  stop_here_if_asked();
  analyse_matrix(graph);
}

FactorReport MatrixSolver::report() const {
  FactorReport report = report_;
  report.memory_bytes += matrix_.memory_bytes();
  return report;
}

void MatrixSolver::factorise() {
  // A growth of 1e3 costs three digits: less than most matrices cost by themselves.
  constexpr double kLargeGrowth = 1e3;
  constexpr int kMendingSteps = 10;
  stop_here_if_asked();
  report_.backward_error = -1.0;
  steps_ = 0;
  factorise_matrix();
  const int wanted = settings_.refinement_steps;
  steps_ = report_.growth > kLargeGrowth ? std::max(kMendingSteps, wanted) : wanted;
  if (steps_ == 0) return;
  norm_ = matrix_.norm1();
  for (auto* vector : {&right_side_, &residual_, &low_})
    vector->resize(static_cast<std::size_t>(matrix_.equations()));
}

SolveStatus MatrixSolver::solve(std::span<const double> b, std::span<double> x) const {
  stop_here_if_asked();
  const bool refined = steps_ > 0 && !b.empty();
  if (refined) std::ranges::copy(b, right_side_.begin());
  solve_matrix(b, x);
  return refined ? refine(x) : SolveStatus::ok;
}

// A correction is taken as long as it is at most half of the one before (Higham 2002, chapter 12).
SolveStatus MatrixSolver::refine(std::span<double> x) const {
  constexpr double kRounding = std::numeric_limits<double>::epsilon(), kPoor = 1e-10;
  double last = largest_size(x);
  for (int step = 0; step < steps_; ++step) {
    matrix_.residual(right_side_, x, residual_, low_);
    solve_matrix(residual_, residual_);
    const double size = largest_size(residual_);
    if (!(size <= 0.5 * last)) break;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += residual_[i];
    last = size;
    if (size <= 0.5 * kRounding * largest_size(x)) break;
  }
  matrix_.residual(right_side_, x, residual_, low_);
  const double scale = norm_ * largest_size(x) + largest_size(right_side_);
  const double error = scale > 0.0 ? largest_size(residual_) / scale : 0.0;
  report_.backward_error = std::max(report_.backward_error, error);
  return error <= kPoor ? SolveStatus::ok : SolveStatus::inaccurate;
}

double singular_pivot_ratio(int equations) {
  return 3e-14 * std::sqrt(static_cast<double>(equations));
}

void throw_singular(int equation, double pivot_ratio, std::string_view solver) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the matrix is singular at equation %d: its pivot is %.1e of the largest term of its row (solver %.*s)",
      equation, pivot_ratio, static_cast<int>(solver.size()), solver.data());
  throw SingularMatrix(equation, pivot_ratio, text);
}

double PivotCheck::largest_term() const {
  return row_maxima_.empty() ? 0.0 : *std::ranges::max_element(row_maxima_);
}

}  // namespace sage
