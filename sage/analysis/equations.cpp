#include "sage/analysis/equations.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

void Equations::number(const Model& model, const Activity& activity) {
  const DofMap& map = activity.dof_map;
  used_ = active_dofs(model, activity);
  std::vector<Combination> combinations;
  std::vector<char> follows(static_cast<std::size_t>(map.dofs()), 0);  // has the equation of an earlier dof
  const auto take = [&](Combination one) {
    std::erase_if(one.terms, [&](const Combination::Term& term) { return !in_use(term.dof); });
    for (std::size_t i = 1; i < one.terms.size(); ++i) follows[one.terms[i].dof] = 1;
    if (one.terms.size() > 1) combinations.push_back(std::move(one));
  };
  for (const TurnedNode& node : activity.turned) {
    const int dof = DofMap::displacement(node.node);
    if (node.slides) take({{{dof, node.slide[0]}, {dof + 1, node.slide[1]}}});
  }
  for (const std::vector<TiedDof>& set : activity.tied) {
    if (std::ranges::any_of(set, &TiedDof::supported)) continue;
    Combination tied;
    for (const TiedDof& one : set) tied.terms.push_back({one.dof, 1.0});
    take(std::move(tied));
  }
  std::vector<int> dofs;
  for (int dof = 0; dof < map.dofs(); ++dof)
    if (in_use(dof) && !activity.held[dof] && !follows[dof]) dofs.push_back(dof);
  take_only(std::move(dofs), static_cast<std::size_t>(map.dofs()));
  for (Combination& one : combinations) combine(std::move(one));
}

void Equations::take_only(std::vector<int> dofs, std::size_t all) {
  dofs_ = std::move(dofs);
  of_dof_.assign(all, -1);
  for (std::size_t eq = 0; eq < dofs_.size(); ++eq) of_dof_[dofs_[eq]] = static_cast<int>(eq);
  combinations_.clear();
  combination_of_.clear();
}

void Equations::combine(Combination combination) {
  const int equation = of(combination.terms.front().dof);
  if (combination_of_.empty()) combination_of_.assign(dofs_.size(), -1);
  combination_of_[equation] = static_cast<int>(combinations_.size());
  for (const Combination::Term& term : combination.terms) of_dof_[term.dof] = equation;
  combinations_.push_back(std::move(combination));
}

double Equations::share(int dof) const {
  const Combination* const several = of(dof) < 0 ? nullptr : combination(of(dof));
  if (several == nullptr) return 1.0;
  return std::ranges::find(several->terms, dof, &Combination::Term::dof)->share;
}

double Equations::force(const Eigen::VectorXd& forces, const Combination& several) {
  double sum = 0.0;
  for (const Combination::Term& term : several.terms) sum += term.share * forces[term.dof];
  return sum;
}

double Equations::size(const Combination& several) {
  double sum = 0.0;
  for (const Combination::Term& term : several.terms) sum += term.share * term.share;
  return sum;
}

double Equations::constraint_force(const Eigen::VectorXd& unbalanced, int dof) const {
  const int equation = of(dof);
  if (equation < 0) return unbalanced[dof];
  if (combination(equation) == nullptr) return 0.0;
  return unbalanced[dof] - share(dof) * unknown(unbalanced, equation);
}

void ElementCombinations::add(const Equations& equations, const std::vector<int>& dofs,
                              int* element_equations) {
  Piece piece{steps_.size(), steps_.size(), dofs.size()};
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const int equation = equations.of(dofs[i]);
    if (equation < 0 || equations.combination(equation) == nullptr) continue;
    const double share = equations.share(dofs[i]);
    const auto first = std::find(element_equations, element_equations + i, equation);
    if (first == element_equations + i) {
      if (share != 1.0) steps_.push_back({static_cast<int>(i), -1, share});
      continue;
    }
    steps_.push_back({static_cast<int>(first - element_equations), static_cast<int>(i), share});
    element_equations[i] = -1;
  }
  piece.end = steps_.size();
  of_element_.push_back(piece);
}

const double* ElementCombinations::combine(int element, const double* K) {
  const Piece& piece = of_element_[static_cast<std::size_t>(element)];
  const std::size_t n = piece.dofs;
  K_.assign(K, K + n * n);
  for (std::size_t s = piece.begin; s < piece.end; ++s) {
    const Step& step = steps_[s];
    const auto to = static_cast<std::size_t>(step.to), of = static_cast<std::size_t>(step.of);
    for (std::size_t i = 0; i < n; ++i) {
      double& term = K_[to * n + i];
      term = step.of < 0 ? step.share * term : term + step.share * K_[of * n + i];
    }
    for (std::size_t j = 0; j < n; ++j) {
      double& term = K_[j * n + to];
      term = step.of < 0 ? step.share * term : term + step.share * K_[j * n + of];
    }
  }
  return K_.data();
}

}  // namespace sage
