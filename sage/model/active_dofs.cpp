#include "sage/model/active_dofs.hpp"

#include <algorithm>

namespace sage {

std::vector<char> active_dofs(const Model& model, const Activity& activity) {
  std::vector<char> flags(static_cast<std::size_t>(activity.dof_map.dofs()), 0);
  std::vector<int> listed;
  const auto mark = [&](int dof) { flags[dof] = 1; };
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!activity.group[g]) continue;
    if (group.entry->unknowns.empty()) {
      for (const int node : group.nodes)
        for (int c = 0; c < 2; ++c) mark(DofMap::displacement(node, c));
      continue;
    }
    const auto at_all_nodes = [](const ElementUnknown& unknown) { return unknown.nodes.empty(); };
    if (std::ranges::all_of(group.entry->unknowns, at_all_nodes)) {
      for (const ElementUnknown& unknown : group.entry->unknowns) {
        const int field = find_unknown(model.unknowns, unknown.field.name);
        for (const int node : group.nodes)
          for (int c = 0; c < unknown.field.components(); ++c) mark(activity.dof_map.of(node, field, c));
      }
      continue;
    }
    for (int e = 0; e < group.elements(); ++e) {
      activity.dof_map.list(group, e, listed);
      for (const int dof : listed) mark(dof);
    }
  }
  return flags;
}

}  // namespace sage
