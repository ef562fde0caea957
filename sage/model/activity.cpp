#include "sage/model/activity.hpp"

#include <numeric>

namespace sage {

namespace {

void apply(const std::vector<Fixity>& fixities, std::vector<char>& held) {
  for (const Fixity& f : fixities)
    for (std::size_t c = 0; c < 2; ++c) {
      const std::size_t dof = 2 * static_cast<std::size_t>(f.node) + c;
      if (f.code[c] == FixityCode::fixed) held[dof] = 1;
      if (f.code[c] == FixityCode::released) held[dof] = 0;
    }
}

int root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& p = parent[static_cast<std::size_t>(i)];
    p = parent[static_cast<std::size_t>(p)];
    i = p;
  }
  return i;
}

}  // namespace

Activity::Activity(const Model& model)
    : group(model.groups.size(), 1), held(static_cast<std::size_t>(model.dofs()), 0) {
  for (const Stage& stage : model.stages)
    for (int g : stage.births) group[static_cast<std::size_t>(g)] = 0;
  apply(model.fixities, held);
}

void Activity::enter(const Stage& stage) {
  for (int g : stage.births) group[static_cast<std::size_t>(g)] = 1;
  for (int g : stage.deaths) group[static_cast<std::size_t>(g)] = 0;
  apply(stage.fixities, held);
}

std::vector<char> active_nodes(const Model& model, const Activity& activity) {
  std::vector<char> active(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (activity.group[g])
      for (int node : model.groups[g].nodes) active[static_cast<std::size_t>(node)] = 1;
  return active;
}

std::vector<int> connected_parts(const Model& model, const Activity& activity) {
  std::vector<int> parent(static_cast<std::size_t>(model.mesh.nodes()));
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<char> used(parent.size(), 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (!activity.group[g]) continue;
    const Group& group = model.groups[g];
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        used[static_cast<std::size_t>(nodes[i])] = 1;
        parent[static_cast<std::size_t>(root(parent, nodes[i]))] = root(parent, nodes[0]);
      }
    }
  }
  std::vector<int> part(parent.size(), -1), number(parent.size(), -1);
  int parts = 0;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    if (!used[i]) continue;
    int& n = number[static_cast<std::size_t>(root(parent, static_cast<int>(i)))];
    if (n < 0) n = parts++;
    part[i] = n;
  }
  return part;
}

}  // namespace sage
