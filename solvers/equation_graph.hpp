// Which equations meet in an element, with equations that always meet the same ones taken together.
#pragma once

#include <span>
#include <vector>

#include "sage/core/linear_solver.hpp"

namespace sage {

// Compressed rows: the entries of row i are item[start[i]] .. item[start[i + 1] - 1].
struct IndexLists {
  std::vector<int> start{0};
  std::vector<int> item;
  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> of(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return {item.data() + start[k], static_cast<std::size_t>(start[k + 1] - start[k])};
  }
};

// Equations that belong to exactly the same elements form a group: as a rule the dofs of one node.  Numberings
// work on groups, a quarter of the edges.  An equation of no element is a group of its own.
struct EquationGraph {
  std::vector<int> group_of;   // equation -> group
  IndexLists members;          // group -> its equations, ascending
  IndexLists neighbours;       // group -> groups that share an element with it, ascending, without itself
  std::vector<char> pressure;  // ElementEquations::pressure
};

// The last `border` equations share no group with others.
EquationGraph make_equation_graph(int equations, const ElementEquations& elements, int border = 0);

// Transposed lists: for every item, the rows that hold it, ascending and without repetition.
IndexLists elements_of_equations(int equations, const ElementEquations& elements);

}  // namespace sage
