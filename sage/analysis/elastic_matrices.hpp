// Element matrices of the elastic K, for corrections that are held back by a share of it (newton_damped.cpp).
#pragma once

#include <cstddef>
#include <vector>

#include "sage/core/law.hpp"
#include "sage/core/linear_solver.hpp"

namespace sage {

class ElasticMatrices {
 public:
  // A new pattern: none are known.
  void analyse(const ElementEquations& elements);
  // All matrices of an assembly in between are kept.
  void begin();
  void end(Outcome pass);
  bool is_taking() const { return is_taking_; }
  bool known() const { return !matrices_.empty() && !is_taking_; }
  void keep(int element, const double* K);
  // Adds that share of them to the solver's K.
  void add(double share, LinearSolver& solver) const;

 private:
  bool is_taking_ = false;
  std::vector<double> matrices_;         // of all elements, one after the other; empty = not known
  std::vector<std::size_t> from_ = {0};  // of each element, and the end
};

class Assembly;
class Tangent;

// The elastic K into the tangent: solids at the committed state, interfaces closed and stuck, structures without force.
// Internal forces then mean nothing until the next evaluation.
Outcome evaluate_elastic(Assembly& assembly, Tangent& tangent);

}  // namespace sage
