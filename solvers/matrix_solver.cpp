#include "solvers/matrix_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace sage {

void MatrixSolver::analyse(int equations, const ElementEquations& elements) {
  report_ = {};
  const EquationGraph graph = make_equation_graph(equations, elements);
  matrix_.analyse(graph, elements, traits_.symmetric);
  analyse_matrix(graph);
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
