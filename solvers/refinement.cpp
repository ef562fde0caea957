#include "solvers/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sage {

namespace {

using Vector = std::vector<double>;

double sum_of_sizes(const Vector& x) {
  double sum = 0.0;
  for (const double term : x) sum += std::abs(term);
  return sum;
}

double largest_size(std::span<const double> x) {
  double largest = 0.0;
  for (const double term : x) largest = std::max(largest, std::abs(term));
  return largest;
}

std::size_t largest_place(const Vector& x) {
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return static_cast<std::size_t>(std::max_element(x.begin(), x.end(), smaller) - x.begin());
}

// Higham's vector of alternating, growing terms, which defeats cancellations that fool the iteration.
double alternating_estimate(const LinearSolver& solver, std::size_t n) {
  Vector x(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double size = 1.0 + static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(n - 1, 1));
    x[i] = i % 2 == 0 ? size : -size;
  }
  solver.solve(x, x);
  return 2.0 * sum_of_sizes(x) / (3.0 * static_cast<double>(n));
}

double residual(const LinearSolver& solver, std::span<const double> b, std::span<const double> x, Vector& r) {
  solver.multiply(x, r);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
  return largest_size(r);
}

}  // namespace

double reciprocal_condition(const LinearSolver& solver, int equations) {
  if (equations == 0) return 1.0;
  const auto n = static_cast<std::size_t>(equations);
  Vector x(n, 1.0 / static_cast<double>(n)), z(n);
  double estimate = 0.0;
  for (int step = 0; step < 5; ++step) {
    solver.solve(x, x);
    const double size = sum_of_sizes(x);
    if (step > 0 && size <= estimate) break;
    estimate = size;
    for (std::size_t i = 0; i < n; ++i) z[i] = std::signbit(x[i]) ? -1.0 : 1.0;
    solver.solve_transposed(z, z);
    const std::size_t place = largest_place(z);
    std::ranges::fill(x, 0.0);
    x[place] = 1.0;
  }
  estimate = std::max(estimate, alternating_estimate(solver, n));
  const double condition = estimate * solver.norm1();
  return std::isfinite(condition) && condition > 0.0 ? 1.0 / condition : 0.0;
}

double refine(const LinearSolver& solver, std::span<const double> b, std::span<double> x, int steps) {
  Vector r(b.size()), better(x.begin(), x.end());
  double size = residual(solver, b, x, r);
  for (int step = 0; step < steps && size > 0.0; ++step) {
    solver.solve(r, r);
    for (std::size_t i = 0; i < r.size(); ++i) better[i] = x[i] + r[i];
    const double next = residual(solver, b, better, r);
    if (!(next < size)) break;
    std::ranges::copy(better, x.begin());
    const bool slow = next > 0.5 * size;
    size = next;
    if (slow) break;
  }
  const double scale = largest_size(b);
  return scale > 0.0 ? size / scale : size;
}

}  // namespace sage
