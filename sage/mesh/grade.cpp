// Layers of smaller and smaller elements around a node, without hanging nodes: every element that has the node
// as a corner is split alike, so that the edges it shares with its neighbours are cut at the same place.
#include <algorithm>

#include "sage/mesh/subdivide.hpp"

namespace sage::mesh {

namespace {

// The node and those that interfaces pair with it, for both sides of an interface must be cut alike.
std::vector<int> with_partners(const Model& model, int node) {
  std::vector<int> found{node};
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Group& group : model.groups) {
      if (!group.interface()) continue;
      for (int e = 0; e < group.elements(); ++e)
        for (const auto& [a, z] : {std::pair{0, 3}, std::pair{1, 2}}) {
          const int *n = group.nodes_of(e), p = n[a], q = n[z];
          const int partner = p == found[i] ? q : q == found[i] ? p : -1;
          if (partner >= 0 && std::find(found.begin(), found.end(), partner) == found.end())
            found.push_back(partner);
        }
    }
  return found;
}

Place between(const Place& a, const Place& z, double t) {
  return {(1 - t) * a[0] + t * z[0], (1 - t) * a[1] + t * z[1]};
}

// A small element like the whole at corner k, and two beside it.
std::vector<ChildCorners> around_corner(int corners, int k, double ratio) {
  const auto& parent = parent_corners(corners);
  const auto at = [&](int i) { return parent[(k + i) % corners]; };
  const Place c = at(0), m1 = between(c, at(1), ratio), m2 = between(c, at(corners - 1), ratio);
  if (corners == 3) return {{c, m1, m2}, {m1, at(1), at(2)}, {m1, at(2), m2}};
  const Place p = between(c, at(2), ratio);
  return {{c, m1, p, m2}, {m1, at(1), at(2), p}, {p, at(2), at(3), m2}};
}

// An interface is cut at the end that the node belongs to.
std::vector<ChildCorners> interface_end(int pair, double ratio) {
  const double x = pair == 0 ? 2 * ratio - 1 : 1 - 2 * ratio;
  const ChildCorners left{{-1, -1}, {x, -1}, {x, 1}, {-1, 1}}, right{{x, -1}, {1, -1}, {1, 1}, {x, 1}};
  return pair == 0 ? std::vector<ChildCorners>{left, right} : std::vector<ChildCorners>{right, left};
}

// A structure along the sides that are cut goes with them.
template <class IsCentre>
void cut_structures(const Group& group, int g, const IsCentre& is_centre, double ratio,
                    Subdivision& subdivision) {
  for (int e = group.elements() - 1; e >= 0; --e) {
    const int* nodes = group.nodes_of(e);
    if (is_centre(nodes[0]))
      subdivision.split_line(g, e, ratio);
    else if (group.node_count() > 1 && is_centre(nodes[1]))
      subdivision.split_line(g, e, 1.0 - ratio);
  }
}

bool add_layer(Work& b, const std::vector<int>& centre, double ratio) {
  const auto is_centre = [&](int node) {
    return std::find(centre.begin(), centre.end(), node) != centre.end();
  };
  Subdivision subdivision(b);
  bool any = false;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const int before = b.model.groups[g].elements();
    const int corners = b.model.groups[g].entry->corners;
    const bool interface = b.model.groups[g].interface();
    if (b.model.groups[g].structure()) {
      cut_structures(b.model.groups[g], static_cast<int>(g), is_centre, ratio, subdivision);
      continue;
    }
    for (int e = 0; e < before; ++e) {
      const int* nodes = b.model.groups[g].nodes_of(e);
      for (int k = 0; k < (interface ? 2 : corners); ++k) {
        if (!is_centre(nodes[k])) continue;
        subdivision.split(static_cast<int>(g), e,
                          interface ? interface_end(k, ratio) : around_corner(corners, k, ratio));
        any = true;
        break;
      }
    }
  }
  subdivision.finish();
  return any;
}

}  // namespace

void grade(Work& b, int node, int layers, double ratio) {
  const std::vector<int> centre = with_partners(b.model, node);
  for (int i = 0; i < layers; ++i)
    if (!add_layer(b, centre, ratio)) {
      b.error("S403", b.deck.one("control").where(),
              "the mesh can't be graded towards node " + std::to_string(b.model.mesh.number[node]) +
                  ": it is not the corner of an element");
      return;
    }
}

}  // namespace sage::mesh
