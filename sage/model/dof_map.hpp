// Numbers of the unknowns: the one place that knows them.  A dof is an unknown of a node, whether it is solved
// for or prescribed.  Displacements come first, two a node whatever its elements are; behind them stand the
// other fields, of the nodes whose elements have them.
#pragma once

#include "sage/model/model.hpp"

namespace sage {

class DofMap {
 public:
  struct Unknown {
    int node = 0, field = 0, component = 0;  // field: of Model::unknowns, 0 = displacement
  };

  DofMap() = default;
  // Throws std::logic_error for an element with a field that Model::unknowns lacks.
  explicit DofMap(const Model& model);

  int dofs() const { return displacements_ + static_cast<int>(others_.size()); }
  int fields() const { return 1 + static_cast<int>(further_.size()); }
  bool only_displacement() const { return further_.empty(); }
  int displacements() const { return displacements_; }  // dofs below are displacements

  // The first of the two displacements of a node.
  static constexpr int displacement(int node) { return 2 * node; }
  static constexpr int displacement(int node, int component) { return 2 * node + component; }
  // -1: no element gives the node that field.
  int of(int node, int field, int component = 0) const {
    if (field == 0) return displacement(node, component);
    return further_[static_cast<std::size_t>(field) - 1][node];
  }
  Unknown at(int dof) const {
    if (dof < displacements_) return {dof / 2, 0, dof % 2};
    return others_[dof - displacements_];
  }

  // The dofs of an element, in its own order.
  void list(const Group& group, int element, std::vector<int>& dofs) const;

 private:
  void number(const Model& model, int field, const std::vector<char>& nodes);

  int displacements_ = 0;
  std::vector<UnknownField> unknowns_;
  std::vector<std::vector<int>> further_;  // of each field but the first: dof of each node
  std::vector<Unknown> others_;            // of each dof behind the displacements
};

// Place of a field in Model::unknowns; -1 = the model has none of the name.
int find_unknown(const std::vector<UnknownField>& unknowns, std::string_view name);
// Lists the fields of the model's elements in Model::unknowns.
void collect_unknowns(Model& model);

}  // namespace sage
