#include "sage/analysis/condition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "sage/analysis/checked_solve.hpp"
#include "sage/core/solver_extensions.hpp"

namespace sage {

namespace {

using Values = std::vector<double>;

double sum_of_sizes(const Values& x) {
  double sum = 0.0;
  for (const double term : x) sum += std::abs(term);
  return sum;
}

std::size_t largest_place(const Values& x) {
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return static_cast<std::size_t>(std::max_element(x.begin(), x.end(), smaller) - x.begin());
}

// Higham's vector of alternating, growing terms, which defeats cancellations that fool the iteration.
double alternating_estimate(const LinearSolver& solver, std::size_t n) {
  Values x(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double size = 1.0 + static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(n - 1, 1));
    x[i] = i % 2 == 0 ? size : -size;
  }
  checked_solve(solver, x, x);
  return 2.0 * sum_of_sizes(x) / (3.0 * static_cast<double>(n));
}

std::string power_of_ten(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

}  // namespace

double reciprocal_condition(const LinearSolver& solver, int equations) {
  if (equations == 0) return 1.0;
  const auto* matrix = dynamic_cast<const KeptMatrix*>(&solver);
  if (matrix == nullptr) return 0.0;
  const auto n = static_cast<std::size_t>(equations);
  Values x(n, 1.0 / static_cast<double>(n)), z(n);
  double estimate = 0.0;
  for (int step = 0; step < 5; ++step) {
    checked_solve(solver, x, x);
    const double size = sum_of_sizes(x);
    if (step > 0 && size <= estimate) break;
    estimate = size;
    for (std::size_t i = 0; i < n; ++i) z[i] = std::signbit(x[i]) ? -1.0 : 1.0;
    matrix->solve_transposed(z, z);
    const std::size_t place = largest_place(z);
    std::ranges::fill(x, 0.0);
    x[place] = 1.0;
  }
  estimate = std::max(estimate, alternating_estimate(solver, n));
  const double condition = estimate * matrix->norm1();
  return std::isfinite(condition) && condition > 0.0 ? 1.0 / condition : 0.0;
}

DigitsReport report_digits(const LinearSolver& solver, int equations, double smallest_pivot, bool asked) {
  constexpr double kPoorPivot = 1e-9, kLargeGrowth = 1e3, kDigits = 16.0;
  const FactorReport factors = solver.report();
  const bool small_pivot = smallest_pivot > 0.0 && smallest_pivot < kPoorPivot;
  const bool grown = factors.growth > kLargeGrowth;
  if (!asked && !small_pivot && !grown) return {};
  if (dynamic_cast<const KeptMatrix*>(&solver) == nullptr)
    return {"the condition number is not known: the solver " + std::string(solver.traits().name) +
                " keeps no matrix",
            false};
  const double reciprocal = reciprocal_condition(solver, equations);
  double lost = reciprocal > 0.0 ? std::max(0.0, -std::log10(reciprocal)) : kDigits;
  if (small_pivot) lost = std::max(lost, -std::log10(smallest_pivot));
  lost = std::min(lost, kDigits);
  DigitsReport report;
  report.poor = lost >= 9.0;
  report.words = "the condition number of the equations is about " +
                 (reciprocal > 0.0 ? power_of_ten(1.0 / reciprocal) : std::string("infinite")) + ": about " +
                 std::to_string(static_cast<int>(std::lround(lost))) + " of 16 digits are lost";
  if (small_pivot)
    report.words += " (smallest pivot " + power_of_ten(smallest_pivot) +
                    " of its row: very stiff beside very soft parts, or nearly a mechanism)";
  if (grown)
    report.words +=
        "; terms grew by " + power_of_ten(factors.growth) +
        " in an elimination without pivoting, so that answers were refined: the solvers umfpack and "
        "mumps pivot";
  if (factors.backward_error >= 0.0)
    report.words += "; refined answers leave " + power_of_ten(factors.backward_error) + " of the forces";
  return report;
}

}  // namespace sage
