// Straight sides of the mesh that are held over a part of their length: half a line of
// symmetry that was forgotten.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/joined.hpp"

namespace sage::builder {

namespace {

constexpr std::size_t kSides = 4;  // lowest and highest x, lowest and highest y

using Edges = std::vector<std::vector<int>>;

// The outer edges of solids, whenever they are active, whose nodes all lie at one of these places.
std::array<Edges, kSides> edges_at(const Model& model, const std::array<double, kSides>& places, double reach) {
  std::vector<unsigned char> sides(static_cast<std::size_t>(model.mesh.nodes()), 0);  // a bit for each
  for (int n = 0; n < model.mesh.nodes(); ++n)
    for (std::size_t s = 0; s < kSides; ++s)
      if (std::abs(model.mesh.x(static_cast<Eigen::Index>(s / 2), n) - places[s]) <= reach)
        sides[n] |= static_cast<unsigned char>(1U << s);
  std::array<std::map<std::pair<int, int>, std::vector<int>>, kSides> directed;
  for (const Group& group : model.groups) {
    if (!group.solid()) continue;
    const auto& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : edges) {
        const int* nodes = group.nodes_of(e);
        unsigned common = (1U << kSides) - 1U;
        for (const int local : edge) common &= sides[nodes[local]];
        if (common == 0) continue;
        std::vector<int> list;
        for (const int local : edge) list.push_back(nodes[local]);
        for (std::size_t s = 0; s < kSides; ++s)
          if ((common >> s & 1U) != 0) directed[s].try_emplace({list[0], list[1]}, list);
      }
  }
  std::array<Edges, kSides> outer;
  for (std::size_t s = 0; s < kSides; ++s)
    for (const auto& [ends, nodes] : directed[s])
      if (directed[s].count({ends.second, ends.first}) == 0) outer[s].push_back(nodes);
  return outer;
}

// What the deck does to a node in one direction, in any stage.
struct Deeds {
  std::vector<char> held, moved, loaded;

  Deeds(const Model& model, std::size_t c)
      : held(static_cast<std::size_t>(model.mesh.nodes()), 0), moved(held), loaded(held) {
    take(model.fixities, c);
    for (const Stage& stage : model.stages) {
      take(stage.fixities, c);
      for (const NodalLoad& load : stage.loads) loaded[load.node] = 1;
      for (const EdgeLoad& load : stage.pressures) {
        const Group& group = model.groups[load.group];
        for (const int local : group.element->edges()[load.edge])
          loaded[group.nodes_of(load.element)[local]] = 1;
      }
    }
  }

  void take(const std::vector<Fixity>& list, std::size_t c) {
    for (const Fixity& f : list) {
      if (f.code[c] != FixityCode::fixed) continue;
      held[f.node] = 1;
      if (f.value[c] != 0.0) moved[f.node] = 1;
    }
  }
  bool supports(int node) const { return held[node] && !moved[node]; }
  // Left to itself: neither held nor loaded.
  bool leaves(int node) const { return !held[node] && !loaded[node]; }
};

// Parts of a straight side that hang together, as lists of edges.
std::vector<std::vector<std::vector<int>>> connected(const std::vector<std::vector<int>>& edges) {
  std::map<int, int> owner;  // of each node, the first edge that has it
  Joined joined(edges.size());
  const auto count = static_cast<int>(edges.size());
  for (int i = 0; i < count; ++i)
    for (const int node : edges[i]) joined.join(i, owner.try_emplace(node, i).first->second);
  std::map<int, std::vector<std::vector<int>>> parts;
  for (int i = 0; i < count; ++i) parts[joined.set_of(i)].push_back(edges[i]);
  std::vector<std::vector<std::vector<int>>> list;
  for (auto& [first, part] : parts) list.push_back(std::move(part));
  return list;
}

// One note where some edges of the part are held across it, and some left alone.
void note_partly_held(Builder& b, const std::vector<std::vector<int>>& part, std::size_t c, double place,
                      const Deeds& deeds) {
  const auto all = [](const std::vector<int>& edge, const auto& of) {
    return std::all_of(edge.begin(), edge.end(), of);
  };
  bool any_held = false, any_left = false;
  std::set<int> held, left;
  for (const std::vector<int>& edge : part) {
    any_held = any_held || all(edge, [&](int node) { return deeds.supports(node); });
    any_left =
        any_left || (std::any_of(edge.begin(), edge.end(), [&](int node) { return deeds.leaves(node); }) &&
                     all(edge, [&](int node) { return deeds.leaves(node) || deeds.supports(node); }));
    for (const int node : edge) {
      if (deeds.supports(node)) held.insert(node);
      if (deeds.leaves(node)) left.insert(node);
    }
  }
  if (!any_held || !any_left) return;
  int line = 0;
  for (const Fixity& f : b.model.fixities)
    if (line == 0 && f.code[c] == FixityCode::fixed && held.count(f.node) != 0) line = f.line;
  const std::string axis =
      b.model.geometry == Geometry::axisymmetric ? (c == 0 ? "r" : "z") : (c == 0 ? "x" : "y");
  b.note("S319", b.at_line(line),
         "the straight side " + axis + " = " + rounded_text(place) +
             " is held in part: " + std::to_string(held.size()) + " nodes held along " + axis + ", " +
             std::to_string(left.size()) + " free, the first is node " +
             std::to_string(b.model.mesh.number[*left.begin()]) + "; a line of symmetry is held all along");
}

}  // namespace

void check_sides(Builder& b) {
  const Model& model = b.model;
  if (model.mesh.nodes() == 0) return;
  const Vector2 low = model.mesh.x.rowwise().minCoeff(), high = model.mesh.x.rowwise().maxCoeff();
  const double reach = 1e-9 * (high - low).maxCoeff();
  const std::array<double, kSides> places{low.x(), high.x(), low.y(), high.y()};
  const std::array<Edges, kSides> edges = edges_at(model, places, reach);
  for (std::size_t c = 0; c < 2; ++c) {
    const Deeds deeds(model, c);
    for (const std::size_t s : {2 * c, 2 * c + 1})
      for (const auto& part : connected(edges[s])) note_partly_held(b, part, c, places[s], deeds);
  }
}

}  // namespace sage::builder
