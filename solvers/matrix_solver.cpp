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
  pressure_ = elements.pressure;
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

// A unit of pressure is any number of units of force over displacement: K_up and K_pp mean nothing beside K_uu.  The row of a
// displacement is measured by K_uu alone, that of a pressure by K_pp and K_pu^2 / K_uu, which scale as its pivot does.
void MatrixSolver::measure_pressures() {
  const std::size_t n = pressure_.size();
  std::vector<double> diagonal(n, 0.0);
  const auto visit = [&](auto&& use) {
    for (std::size_t column = 0; column < n; ++column)
      for (int k = matrix_.column_start()[column]; k < matrix_.column_start()[column + 1]; ++k)
        use(static_cast<std::size_t>(matrix_.row()[static_cast<std::size_t>(k)]), column,
            std::abs(matrix_.value()[static_cast<std::size_t>(k)]));
  };
  visit([&](std::size_t i, std::size_t j, double size) {
    if (i == j) diagonal[i] = size;
  });
  std::ranges::fill(row_maxima_, 0.0);
  const auto raise = [&](std::size_t i, double size) { row_maxima_[i] = std::max(row_maxima_[i], size); };
  visit([&](std::size_t i, std::size_t j, double size) {
    if (pressure_[i] == pressure_[j]) return raise(i, size), raise(j, size);
    const std::size_t p = pressure_[i] != 0 ? i : j, u = pressure_[i] != 0 ? j : i;
    if (diagonal[u] > 0.0) raise(p, size / diagonal[u] * size);
  });
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
