// Which equation a dof has in a stage.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "sage/model/active_dofs.hpp"

namespace sage {

// Of most equations the unknown is one dof.  That of a combination moves several: each by its share of it.
struct Combination {
  struct Term {
    int dof = 0;
    double share = 1.0;
  };
  std::vector<Term> terms;
};

class Equations {
 public:
  // One for every dof that an active element has and no support holds, by number of the dof.  One alone for both dofs of a
  // node that slides along a line, and for dofs that are tied; it has the number of the first.
  void number(const Model& model, const Activity& activity);
  // Those of the other dofs leave the system.  Not for systems with combinations.
  void keep(std::vector<int> dofs) { take_only(std::move(dofs), of_dof_.size()); }

  int count() const { return static_cast<int>(dofs_.size()); }
  const std::vector<int>& dofs() const { return dofs_; }       // of each equation; of a combination, the first
  const std::vector<int>& of_dofs() const { return of_dof_; }  // of each dof; -1 = none
  int of(int dof) const { return of_dof_[dof]; }
  int dof(int equation) const { return dofs_[equation]; }
  // False: no active element has this dof.
  bool in_use(int dof) const { return used_[dof] != 0; }

  bool combine() const { return !combinations_.empty(); }
  // nullptr: the unknown of the equation is one dof.
  const Combination* combination(int equation) const {
    if (combinations_.empty() || combination_of_[equation] < 0) return nullptr;
    return &combinations_[combination_of_[equation]];
  }
  // By how much a dof moves with the unknown of its equation.
  double share(int dof) const;
  // The force on the unknown of an equation, from those of dofs.
  double force(const Eigen::VectorXd& forces, int equation) const {
    const Combination* const several = combination(equation);
    return several == nullptr ? forces[dofs_[equation]] : force(forces, *several);
  }
  // The unknown of an equation, from dofs that move as it makes them.
  double unknown(const Eigen::VectorXd& u, int equation) const {
    const Combination* const several = combination(equation);
    return several == nullptr ? u[dofs_[equation]] : force(u, *several) / size(*several);
  }
  void move(Eigen::VectorXd& u, int equation, double by) const {
    const Combination* const several = combination(equation);
    if (several == nullptr) {
      u[dofs_[equation]] += by;
      return;
    }
    for (const Combination::Term& term : several->terms) u[term.dof] += term.share * by;
  }
  void set(Eigen::VectorXd& u, int equation, double value) const {
    if (combination(equation) == nullptr)
      u[dofs_[equation]] = value;
    else
      move(u, equation, value - unknown(u, equation));
  }
  // What supports and ties do at a dof, where `unbalanced` are internal less applied forces.
  double constraint_force(const Eigen::VectorXd& unbalanced, int dof) const;

 private:
  static double force(const Eigen::VectorXd& forces, const Combination& several);
  static double size(const Combination& several);  // sum of the squares of its shares
  void take_only(std::vector<int> dofs, std::size_t all);
  void combine(Combination combination);

  std::vector<char> used_;  // one flag per dof
  std::vector<int> dofs_, of_dof_;
  std::vector<Combination> combinations_;
  std::vector<int> combination_of_;  // of each equation; -1 = none
};

// What becomes of the matrices of elements with dofs that share an equation.
class ElementCombinations {
 public:
  // `of` is added to the term `to`, times the share.  of = -1: the term itself is multiplied by it.
  struct Step {
    int to = 0, of = -1;
    double share = 1.0;
  };

  bool empty() const { return of_element_.empty(); }
  bool changes(int element) const {
    return !of_element_.empty() && of_element_[static_cast<std::size_t>(element)].end >
                                       of_element_[static_cast<std::size_t>(element)].begin;
  }
  // The next element: its dofs and their equations, of which each stays once.
  void add(const Equations& equations, const std::vector<int>& dofs, int* element_equations);
  // K of an element, column-major, with rows and columns combined.  Valid until the next call.
  const double* combine(int element, const double* K);

 private:
  struct Piece {
    std::size_t begin = 0, end = 0, dofs = 0;  // of steps_
  };
  std::vector<Piece> of_element_;
  std::vector<Step> steps_;
  std::vector<double> K_;
};

}  // namespace sage
