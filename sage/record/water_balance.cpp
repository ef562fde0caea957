#include "sage/record/water_balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace sage {

namespace {

// Nodes at which water may pass in a stage, one flag each.
std::vector<char> permeable_nodes(const Model& model, int stage, const Activity& activity) {
  std::vector<char> flags(static_cast<std::size_t>(model.mesh.nodes()), 0);
  const auto set = [&](int node) { flags[node] = 1; };
  for (const auto& [dof, supported] : activity.pores)
    if (supported) set(activity.dof_map.at(dof).node);
  const int field = model.pore_field();
  for (const Stage& one : std::span(model.stages).first(static_cast<std::size_t>(stage) + 1)) {
    for (const FieldLoad& load : one.field_loads)
      if (load.field == field) set(load.node);
    for (const Exit& exit : one.exits)
      if (exit.field == field) set(exit.node);
  }
  return flags;
}

// A smallest node for each set of nodes that edges of elements join; -1 where no water passes.
std::vector<int> joined_boundaries(const Solution& solution, const std::vector<char>& permeable) {
  std::vector<int> first(permeable.size());
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int node) {
    while (first[node] != node) node = first[node];
    return node;
  };
  std::vector<char> used(permeable.size(), 0);
  for (const GroupData& data : solution.groups()) {
    const Group& group = *data.group;
    if (!data.active || !group.solid() || !group.entry->has_pores()) continue;
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const int a = group.nodes_of(e)[edge[0]], b = group.nodes_of(e)[edge[1]];
        used[a] = used[b] = 1;
        if (!permeable[a] || !permeable[b]) continue;
        const int low = std::min(root(a), root(b)), high = std::max(root(a), root(b));
        first[high] = low;
      }
  }
  for (std::size_t node = 0; node < permeable.size(); ++node)
    first[node] = permeable[node] && used[node] ? root(static_cast<int>(node)) : -1;
  return first;
}

double taken_up_by(const Model& model, const GroupData& data) {
  const Element& element = *data.group->element;
  const ElementTraits& traits = element.traits();
  const std::span<const Quantity> own = traits.history;
  const auto content = std::ranges::find(own, "water_content_change", &Quantity::name);
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const std::size_t place = history - own.size() + static_cast<std::size_t>(content - own.begin());
  std::vector<double> geometry(static_cast<std::size_t>(traits.geometry_size()));
  Eigen::Matrix2Xd x;
  double sum = 0.0;
  for (int e = 0; e < data.group->elements(); ++e) {
    element_coordinates(model.mesh, *data.group, e, x);
    element.geometry(x, geometry);
    for (int p = 0; p < traits.points; ++p) {
      const double w = geometry[p * (1 + traits.law_size * traits.dofs)];
      const auto point = static_cast<std::size_t>(e * traits.points + p);
      sum += w * (content != own.end() ? data.state.committed.h[point * history + place]
                                       : data.state.committed.eps[2 * point + 1]);  // gap of an interface
    }
  }
  return sum;
}

}  // namespace

double WaterBalance::difference() const {
  double sum = elsewhere + taken_up;
  for (const WaterBoundary& boundary : boundaries) sum += boundary.left;
  return sum;
}

WaterBalance water_balance(const Model& model, int stage, const Solution& solution) {
  WaterBalance balance;
  const Activity& activity = *solution.activity;
  const std::vector<int> boundary_of = joined_boundaries(solution, permeable_nodes(model, stage, activity));
  const int field = model.pore_field();
  std::vector<int> place(boundary_of.size(), -1);
  for (std::size_t node = 0; node < boundary_of.size(); ++node) {
    const int dof = activity.dof_map.of(static_cast<int>(node), field);
    if (dof < 0) continue;
    const double left = (*solution.internal)[dof];
    balance.scale += std::abs(left);
    if (boundary_of[node] < 0) {
      balance.elsewhere += left;
      continue;
    }
    int& at = place[boundary_of[node]];
    if (at < 0) {
      at = static_cast<int>(balance.boundaries.size());
      balance.boundaries.emplace_back();
    }
    WaterBoundary& boundary = balance.boundaries[at];
    boundary.nodes.push_back(static_cast<int>(node));
    boundary.left += left;
  }
  for (const GroupData& data : solution.groups())
    if (data.active && data.group->entry != nullptr && data.group->entry->has_pores())
      balance.taken_up += taken_up_by(model, data);
  return balance;
}

std::string water_balance_table(const Model& model, const WaterBalance& balance) {
  std::string text =
      fmt::format("\n   Pore water since the start {}\n", unit_text(Dimension::volume, model.units));
  const auto row = [&](const std::string& what, double value) {
    text += fmt::format("   {:<52}{:>16.8g}\n", what, value);
  };
  for (const WaterBoundary& boundary : balance.boundaries) {
    const auto number = [&](int node) { return model.mesh.number[node]; };
    row(boundary.nodes.size() == 1
            ? fmt::format("left at node {}", number(boundary.nodes.front()))
            : fmt::format("left through nodes {} to {} ({} nodes)", number(boundary.nodes.front()),
                          number(boundary.nodes.back()), boundary.nodes.size()),
        boundary.left);
  }
  if (std::abs(balance.elsewhere) > 1e-10 * balance.scale)
    row("left at nodes that are closed now", balance.elsewhere);
  row("taken up by the ground", balance.taken_up);
  text += fmt::format("   {:<52}{:>16.1e}\n", "sum, as a share of all volumes",
                      balance.scale > 0.0 ? std::abs(balance.difference()) / balance.scale : 0.0);
  return text;
}

}  // namespace sage
