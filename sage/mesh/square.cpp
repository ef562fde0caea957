// Cuts right through a mesh of quadrilaterals that make the elements at some corners about as long as wide: layers
// around a corner of a long element are long as well, and their degree is wasted on the shorter direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "sage/mesh/subdivide.hpp"

namespace sage::mesh {

namespace {

constexpr double kLong = 1.5;  // length over width from which on an element is cut

struct Place2 {
  int group = 0, element = 0;
  auto operator<=>(const Place2&) const = default;
};

// An element and one of its sides, from corner `side` to the next.
struct OnSide {
  Place2 element;
  int side = 0;
};

// Elements by the ends of their sides.
using Sides = std::map<EdgeKey, std::vector<OnSide>>;

bool is_cut(const Group& group) {
  return group.entry->fills_area() || group.interface();
}

Sides sides_of(const Model& model) {
  Sides sides;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!is_cut(group)) continue;
    const int corners = group.entry->corners;
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      for (int k = 0; k < corners; k += group.interface() ? 2 : 1)
        sides[edge_key(nodes[k], nodes[(k + 1) % corners])].push_back({{static_cast<int>(g), e}, k});
    }
  }
  return sides;
}

// Where a cut crosses each element: at a place of its parent square along xi (across sides 0 and 2) or eta.
struct Crossing {
  bool along_xi = true;
  double at = 0.0;
};
using Cut = std::map<Place2, Crossing>;

bool has_middle(const Group& group, int element, int side) {
  const auto& edges = group.element->edges();
  const auto& edge = edges[group.interface() ? side / 2 : side];
  return middle_of(edge) >= 0 && group.nodes_of(element)[middle_of(edge)] >= 0;
}

// The cut through a side at t from its node `from`, on through the opposite sides; nothing where it ends within the
// mesh (at a triangle) or crosses itself.
std::optional<Cut> follow(const Model& model, const Sides& sides, int from, int to, double t) {
  Cut cut;
  struct Step {
    int a, z;
    double t;
  };
  std::vector<Step> open{{from, to, t}};
  while (!open.empty()) {
    const Step step = open.back();
    open.pop_back();
    for (const OnSide& on : sides.at(edge_key(step.a, step.z))) {
      const Group& group = model.groups[on.element.group];
      if (group.entry->corners != 4) return {};
      const int* nodes = group.nodes_of(on.element.element);
      const double along = nodes[on.side] == step.a ? step.t : 1.0 - step.t;  // from the side's first corner
      const Crossing crossing{on.side % 2 == 0, on.side < 2 ? 2.0 * along - 1.0 : 1.0 - 2.0 * along};
      const auto [known, is_new] = cut.try_emplace(on.element, crossing);
      if (!is_new) {
        if (known->second.along_xi != crossing.along_xi || std::abs(known->second.at - crossing.at) > 1e-12)
          return {};
        continue;
      }
      const int opposite = (on.side + 2) % 4;
      open.push_back({nodes[(opposite + 1) % 4], nodes[opposite], along});
    }
  }
  return cut;
}

// The middle of a side that a card gives stays a node only where the cut passes it.
bool passes_middle(const Model& model, const Cut& cut) {
  return std::ranges::any_of(cut, [&](const auto& one) {
    const Group& group = model.groups[one.first.group];
    const int first = one.second.along_xi ? 0 : 1;
    return has_middle(group, one.first.element, first) || has_middle(group, one.first.element, first + 2);
  });
}

void apply(Work& b, const Cut& cut, const Sides& sides) {
  Subdivision subdivision(b);
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (!group.structure() || group.node_count() < 2) continue;
    for (int e = group.elements() - 1; e >= 0; --e) {
      const int a = group.nodes_of(e)[0], z = group.nodes_of(e)[1];
      const auto along = sides.find(edge_key(a, z));
      if (along == sides.end()) continue;
      const OnSide& on = along->second.front();
      const auto crossed = cut.find(on.element);
      if (crossed == cut.end() || crossed->second.along_xi != (on.side % 2 == 0)) continue;
      const int* nodes = b.model.groups[on.element.group].nodes_of(on.element.element);
      const double t = 0.5 * (1.0 + (on.side < 2 ? crossed->second.at : -crossed->second.at));
      subdivision.split_line(static_cast<int>(g), e, nodes[on.side] == a ? t : 1.0 - t);
    }
  }
  for (const auto& [element, crossing] : cut) {
    const double x = crossing.at;
    if (crossing.along_xi)
      subdivision.split(element.group, element.element,
                        {{{-1, -1}, {x, -1}, {x, 1}, {-1, 1}}, {{x, -1}, {1, -1}, {1, 1}, {x, 1}}});
    else
      subdivision.split(element.group, element.element,
                        {{{-1, -1}, {1, -1}, {1, x}, {-1, x}}, {{-1, x}, {1, x}, {1, 1}, {-1, 1}}});
  }
  subdivision.finish();
}

// A long element at the node, its longer side there, and where to cut that, counted from the node.
struct Long {
  int to = -1;  // the other end of the side; -1: none is too long
  double t = 0.5;
};

Long longest_at(const Model& model, int node) {
  Long longest;
  double most = kLong;
  for (const Group& group : model.groups) {
    if (!group.entry->fills_area() || group.entry->corners != 4) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* n = group.nodes_of(e);
      const auto length = [&](int k) {
        return (model.mesh.x.col(n[(k + 1) % 4]) - model.mesh.x.col(n[k % 4])).norm();
      };
      for (int k = 0; k < 4; ++k) {
        if (n[k] != node) continue;
        // To the next corner and to the one before, each with the opposite side.
        const double next = 0.5 * (length(k) + length(k + 2)), before = 0.5 * (length(k + 1) + length(k + 3));
        const double ratio = std::max(next / before, before / next);
        if (ratio <= most) continue;
        most = ratio;
        constexpr double kSteps = 64.0;  // places that both elements of a side compute alike
        longest = {n[(next > before ? k + 1 : k + 3) % 4], std::min(0.5, std::round(kSteps / ratio) / kSteps)};
      }
    }
  }
  return longest;
}

}  // namespace

bool square_at(Work& b, const std::vector<int>& corners) {
  constexpr int kMostCuts = 100;
  bool any = false;
  for (const int node : corners)
    for (int cuts = 0; cuts < kMostCuts; ++cuts) {
      const Long found = longest_at(b.model, node);
      if (found.to < 0 || found.t <= 0.0) break;
      const Sides sides = sides_of(b.model);
      std::optional<Cut> cut = follow(b.model, sides, node, found.to, found.t);
      if (cut && passes_middle(b.model, *cut)) cut = follow(b.model, sides, node, found.to, 0.5);
      if (!cut) break;
      apply(b, *cut, sides);
      any = true;
    }
  return any;
}

}  // namespace sage::mesh
