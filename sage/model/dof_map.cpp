#include "sage/model/dof_map.hpp"

#include <numeric>

namespace sage {

namespace {

// Local numbers of an element's nodes that have the field.
std::vector<int> nodes_with(const ElementUnknown& unknown, std::size_t nodes) {
  if (!unknown.nodes.empty()) return unknown.nodes;
  std::vector<int> all(nodes);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// A flag a node: some element has it, and the field there.  Nodes that are still to be made are -1.
std::vector<char> nodes_of_field(const Model& model, const std::string& name) {
  std::vector<char> flags(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups) {
    if (!group.entry) continue;
    for (const ElementUnknown& unknown : group.entry->unknowns) {
      if (unknown.field.name != name) continue;
      const std::vector<int> local = nodes_with(unknown, group.node_count());
      for (int e = 0; e < group.elements(); ++e)
        for (const int i : local)
          if (const int node = group.nodes_of(e)[i]; node >= 0) flags[node] = 1;
    }
  }
  return flags;
}

}  // namespace

DofMap::DofMap(const Model& model)
    : displacements_(displacement(model.mesh.nodes())), unknowns_(model.unknowns) {
  if (unknowns_.size() > kMostFields)
    throw std::logic_error("a model has at most " + std::to_string(kMostFields) + " fields of unknowns");
  for (std::size_t field = 1; field < unknowns_.size(); ++field)
    number(model, static_cast<int>(field), nodes_of_field(model, unknowns_[field].name));
  for (const Group& group : model.groups) {
    if (!group.entry) continue;
    for (const ElementUnknown& unknown : group.entry->unknowns)
      if (find_unknown(unknowns_, unknown.field.name) < 0)
        throw std::logic_error("the model lacks the unknown " + unknown.field.name);
  }
}

void DofMap::number(const Model& model, int field, const std::vector<char>& nodes) {
  std::vector<int>& dof_of = further_.emplace_back(nodes.size(), -1);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    if (!nodes[node]) continue;
    dof_of[node] = dofs();
    others_.push_back({node, field, 0});
  }
}

void DofMap::list(const Group& group, int element, std::vector<int>& dofs) const {
  const int* nodes = group.nodes_of(element);
  const auto add = [&](int field, int components, int node) {
    for (int c = 0; c < components; ++c) dofs.push_back(of(node, field, c));
  };
  dofs.clear();
  if (group.entry->unknowns.empty())
    for (std::size_t i = 0; i < group.node_count(); ++i) add(0, 2, nodes[i]);
  for (const ElementUnknown& unknown : group.entry->unknowns) {
    const int field = find_unknown(unknowns_, unknown.field.name);
    const int components = unknown.field.components();
    if (unknown.nodes.empty())
      for (std::size_t i = 0; i < group.node_count(); ++i) add(field, components, nodes[i]);
    for (const int i : unknown.nodes) add(field, components, nodes[i]);
  }
}

int find_unknown(const std::vector<UnknownField>& unknowns, std::string_view name) {
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (unknowns[i].name == name) return static_cast<int>(i);
  return -1;
}

void collect_unknowns(Model& model) {
  for (const Group& group : model.groups) {
    if (!group.entry) continue;
    for (const ElementUnknown& unknown : group.entry->unknowns)
      if (find_unknown(model.unknowns, unknown.field.name) < 0) model.unknowns.push_back(unknown.field);
  }
}

}  // namespace sage
