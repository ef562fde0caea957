#include "sage/bounds/dependent_equations.hpp"

#include <algorithm>
#include <map>

#include "sage/math/dense.hpp"
#include "sage/math/rounding.hpp"

namespace sage::bounds {

namespace {

struct Term {
  int equation = 0, column = 0;
  double value = 0.0;
};

std::vector<std::vector<Term>> terms_by_node(const ConeProgram& program, const std::vector<int>& node_of) {
  std::vector<std::vector<Term>> terms;
  for (const Part& part : program.parts)
    for (std::size_t i = 0; i < part.equations.size(); ++i) {
      const int node = node_of[part.equations[i]];
      if (node < 0) continue;
      if (static_cast<std::size_t>(node) >= terms.size()) terms.resize(static_cast<std::size_t>(node) + 1);
      for (Eigen::Index k = 0; k < part.A.cols(); ++k)
        if (const double value = part.A(static_cast<Eigen::Index>(i), k); value != 0.0)
          terms[node].push_back({part.equations[i], 3 * part.first_point + static_cast<int>(k), value});
    }
  return terms;
}

}  // namespace

std::vector<int> dependent_equations(const ConeProgram& program, const std::vector<int>& node_of) {
  constexpr double kRounding = rounding::kText;  // of coordinates, beside the sides of a triangle
  std::vector<int> dependent;
  for (const std::vector<Term>& terms : terms_by_node(program, node_of)) {
    std::map<int, Eigen::Index> row, column;
    for (const Term& term : terms) {
      row.try_emplace(term.equation, static_cast<Eigen::Index>(row.size()));
      column.try_emplace(term.column, static_cast<Eigen::Index>(column.size()));
    }
    if (row.empty()) continue;
    Eigen::MatrixXd transposed =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(column.size()), static_cast<Eigen::Index>(row.size()));
    for (const Term& term : terms) transposed(column.at(term.column), row.at(term.equation)) = term.value;
    transposed.colwise().normalize();
    const std::vector<Eigen::Index> columns = dense_matrix::dependent_columns(transposed, kRounding);
    for (const auto& [equation, place] : row)
      if (std::ranges::find(columns, place) != columns.end()) dependent.push_back(equation);
  }
  return dependent;
}

}  // namespace sage::bounds
