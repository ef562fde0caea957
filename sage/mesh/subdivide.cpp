#include "sage/mesh/subdivide.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "sage/deck/text.hpp"
#include "sage/math/rounding.hpp"

namespace sage::mesh {

namespace {

constexpr double kTiny = rounding::kResult;  // of parent coordinates
constexpr double kMaxElements = 1e7;         // 40 GB and more
constexpr double kManyNodes = 2e5;           // seconds, and a GB
constexpr double kBytesPerNode = 4000.0;     // 4-node elements, linear and symmetric: measured 3.8 to 4.0

// Side of the parent square or triangle that a local edge lies on.
int side_of(const Group& group, int edge) {
  return group.interface() ? 2 * edge : edge;
}

bool same(const Place& a, const Place& b) {
  return std::abs(a[0] - b[0]) < kTiny && std::abs(a[1] - b[1]) < kTiny;
}

// Place of q on the side from a to z; nothing off the side.
std::optional<double> place_on(const Place& q, const Place& a, const Place& z) {
  const double dx = z[0] - a[0], dy = z[1] - a[1], px = q[0] - a[0], py = q[1] - a[1];
  if (std::abs(dx * py - dy * px) > kTiny) return {};
  return (px * dx + py * dy) / (dx * dx + dy * dy);
}

Place halfway(const Place& a, const Place& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
}

// Corners and mid-side nodes only: other nodes that cards give would be lost.
void check_nodes(Work& b, const Group& group, int corners) {
  std::vector<char> known(group.node_count(), 0);
  std::fill(known.begin(), known.begin() + corners, 1);
  for (const auto& edge : group.element->edges())
    if (middle_of(edge) >= 0) known[middle_of(edge)] = 1;
  for (int e = 0; e < group.elements(); ++e)
    for (std::size_t i = 0; i < known.size(); ++i)
      if (!known[i] && group.nodes_of(e)[i] >= 0) {
        b.error("S402", {b.deck.file, group.element_lines[e], 0, 0},
                "element " + std::to_string(group.element_numbers[e]) + " (" + group.element_name +
                    ") can't be refined: its card gives more nodes than corners and mid-side nodes");
        throw InputError(b.problems);
      }
}

// Sizes after every element was split into four and every interface into two, so many times; structures, split
// along them or whole, are few.
struct Refined {
  double elements = 0.0, nodes = 0.0;
};

Refined refined(const Model& model, int times) {
  Refined size;
  for (const Group& group : model.groups) {
    if (group.structure()) {
      size.elements += group.elements();
      continue;
    }
    const double elements = group.elements() * std::pow(group.interface() ? 2.0 : 4.0, times);
    size.elements += elements;
    if (group.interface()) continue;
    // Each edge belongs to two elements; the angles of the elements around a node sum to a full circle.
    const auto edges = static_cast<double>(group.element->edges().size());
    const double inside_edge = static_cast<double>(group.element->edges().front().size()) - 2.0;
    const double inside = group.element->traits().nodes - edges * (1.0 + inside_edge);
    size.nodes += elements * ((edges - 2.0) / 2.0 + edges / 2.0 * inside_edge + inside);
  }
  return size;
}

std::string whole(double count) {
  return std::to_string(std::llround(count));
}

// Before anything is made: refuses what is no use to anybody, announces what takes its time.
void check_size(Work& b, int times, const std::string& name) {
  const Refined size = refined(b.model, times);
  const std::string option = name + ' ' + std::to_string(times);
  if (size.elements > kMaxElements) {
    int most = times;
    while (most > 0 && refined(b.model, most).elements > kMaxElements) --most;
    b.error("S402", b.at_line(0),
            option + " would make " + whole(size.elements) + " elements, more than " + whole(kMaxElements) +
                "; " + name + ' ' + std::to_string(most) + " makes " + whole(refined(b.model, most).elements) +
                ". Layers at corners (--grade) and elements of high degree (--element) need far fewer");
    throw InputError(b.problems);
  }
  if (b.meshing.say && size.nodes > kManyNodes)
    b.meshing.say(option + " makes " + whole(size.elements) + " elements with about " + whole(size.nodes) +
                      " nodes: expect " + rounded_text(size.nodes * kBytesPerNode / 1e9, 2) +
                      " GB of memory, and a multiple of it where the equations are unsymmetric or degrees high",
                  "S409");
}

}  // namespace

// One element while it is split.
struct Subdivision::SplitElement {
  const Group* group;
  int element, corners, sides;
  std::vector<int> nodes;
  CoarseShape shape;
  std::vector<std::pair<Place, int>> inner;  // nodes made inside

  int edge_of_side(int side) const { return group->interface() ? side / 2 : side; }
  bool has_edge(int side) const { return !group->interface() || side % 2 == 0; }
};

Subdivision::Subdivision(Work& b)
    : b_(&b), nodes_(b.model.mesh), inner_(b.model), arcs_(b.model.mesh), edges_(b.model, false) {
  for (const Stage& stage : b.model.stages)
    for (const EdgeLoad& load : stage.pressures) loaded_.emplace(load.group, load.element);
  for (const Group& group : b.model.groups) {
    check_nodes(b, group, group.entry->corners);
    for (const int number : group.element_numbers) last_number_ = std::max(last_number_, number);
    if (group.structure()) continue;  // they are cut where these are
    const bool outline = counts_for_outline(group);
    for (int e = 0; e < group.elements(); ++e)
      for (const auto& edge : group.element->edges()) {
        const int* nodes = group.nodes_of(e);
        EdgeTable::Edge* known = edges_.find(nodes[edge[0]], nodes[edge[1]]);
        if (known == nullptr) continue;
        known->solids += outline ? 1 : 0;
        const int middle = middle_of(edge) < 0 ? -1 : nodes[middle_of(edge)];
        if (middle >= 0 && known->first < 0) edges_.add(*known, {{0.5, middle}});
      }
  }
  share_middles();
}

// A middle node that only one of the elements of an edge gives is that of the others too.
void Subdivision::share_middles() {
  for (Group& group : b_->model.groups)
    for (int e = 0; e < group.elements(); ++e) {
      int* nodes = group.nodes.data() + static_cast<std::size_t>(e) * group.node_count();
      for (const auto& edge : group.element->edges()) {
        if (middle_of(edge) < 0 || nodes[middle_of(edge)] >= 0) continue;
        const EdgeTable::Edge* known = edges_.find(nodes[edge[0]], nodes[edge[1]]);
        if (known == nullptr || known->first < 0) continue;  // a structure by itself, or no middle
        nodes[middle_of(edge)] = edges_.link(known->first).node;
      }
    }
}

// The node at t on an edge, seen alike from both of its elements: places are counted from the nearer end.
int Subdivision::cut(int a, int z, int middle, double t) {
  std::tie(a, z) = edges_.ends(a, z);
  if (t > 0.5 + kTiny || (t > 0.5 - kTiny && a > z)) {
    std::swap(a, z);
    t = 1 - t;
  }
  if (middle >= 0 && std::abs(t - 0.5) < kTiny) return middle;
  EdgeTable::Edge* edge = edges_.find(a, z);
  if (edge == nullptr) throw std::logic_error("an edge is cut that no element has");
  const long place = std::lround(t * 1e15);
  for (int i = edge->first; i >= 0; i = edges_.link(i).next)
    if (const EdgeTable::Link& link = edges_.link(i); link.near == a && link.place == place) return link.node;
  std::optional<Vector2> m;
  if (middle >= 0) m = nodes_.at(middle);
  const int made = nodes_.add(along_side(nodes_.at(a), nodes_.at(z), m, arcs_.centre(a, z), t));
  edges_.add(*edge, {{a < z ? t : 1 - t, made}, -1, a, place});
  return made;
}

// Node at a place of the parent.  middle: a mid-side node, made only where the parent has a curve to follow
// (else -1).
int Subdivision::node_at(SplitElement& parent, const Place& q, bool middle) {
  const auto& corner = parent_corners(parent.corners);
  for (int k = 0; k < parent.sides; ++k)
    if (same(q, corner[static_cast<std::size_t>(k)])) return parent.nodes[static_cast<std::size_t>(k)];
  for (int k = 0; k < parent.sides; ++k) {
    const auto t = place_on(q, corner[static_cast<std::size_t>(k)], corner[(k + 1) % parent.sides]);
    if (!t) continue;
    if (!parent.has_edge(k)) return -1;
    const auto& edge = parent.group->element->edges()[parent.edge_of_side(k)];
    const int m = middle_of(edge) < 0 ? -1 : parent.nodes[middle_of(edge)];
    if (middle && m < 0) return -1;
    return cut(parent.nodes[edge[0]], parent.nodes[edge[1]], m, *t);
  }
  if (middle && !parent.shape.curved()) return -1;
  for (const auto& [at, node] : parent.inner)
    if (same(at, q)) return node;
  const Vector2 place = parent.shape.at(q);
  const int node = inner_.at(parent.nodes.data(), parent.corners, place, [&] { return nodes_.add(place); });
  parent.inner.emplace_back(q, node);
  return parent.inner.back().second;
}

void Subdivision::split(int g, int e, const std::vector<ChildCorners>& children) {
  Group& group = b_->model.groups[g];
  const std::size_t n = group.node_count();
  const auto& edges = group.element->edges();
  SplitElement parent{
      &group, e, group.entry->corners, 0, std::vector<int>(group.nodes_of(e), group.nodes_of(e) + n), {}, {}};
  parent.sides = parent.corners;
  parent.shape.corners = parent.corners;
  for (std::size_t k = 0; k < static_cast<std::size_t>(parent.corners); ++k)
    parent.shape.corner[k] = nodes_.at(parent.nodes[k]);
  if (!group.interface())
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (const int m = middle_of(edges[k]); m >= 0 && parent.nodes[m] >= 0)
        parent.shape.middle[k] = nodes_.at(parent.nodes[m]);
      parent.shape.centre[k] = arcs_.centre(parent.nodes[edges[k][0]], parent.nodes[edges[k][1]]);
    }

  // Children share corners.
  std::vector<std::pair<Place, int>>& known = corners_;
  known.clear();
  const auto corner_at = [&](const Place& q) {
    for (const auto& [place, node] : known)
      if (place == q) return node;
    return known.emplace_back(q, node_at(parent, q, false)).second;
  };
  const auto& corner = parent_corners(parent.corners);
  const bool loaded = loaded_.contains({g, e});
  for (std::size_t c = 0; c < children.size(); ++c) {
    const ChildCorners& at = children[c];
    std::vector<int>& nodes = child_;
    nodes.assign(n, -1);
    for (std::size_t k = 0; k < at.size(); ++k) nodes[k] = corner_at(at[k]);
    int child = e;
    if (c == 0) {
      std::copy(nodes.begin(), nodes.end(),
                group.nodes.begin() + static_cast<std::ptrdiff_t>(e) * static_cast<std::ptrdiff_t>(n));
    } else {
      child = group.elements();
      group.element_numbers.push_back(++last_number_);
      group.element_lines.push_back(group.element_lines[e]);
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    }
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const auto k = static_cast<std::size_t>(side_of(group, static_cast<int>(i)));
      const Place &a = at[k], &z = at[(k + 1) % at.size()];
      if (const int m = middle_of(edges[i]); m >= 0)
        group.nodes[static_cast<std::size_t>(child) * n + static_cast<std::size_t>(m)] =
            node_at(parent, halfway(a, z), true);
      for (int side = 0; loaded && side < parent.sides; ++side) {
        const Place &from = corner[side], &to = corner[(side + 1) % parent.sides];
        const auto ta = place_on(a, from, to), tz = place_on(z, from, to);
        if (parent.has_edge(side) && ta && tz)
          segments_[{g, e, parent.edge_of_side(side)}].push_back({child, static_cast<int>(i), *ta, *tz});
      }
    }
  }
}

// The second part of an element with a hinge at its first node would need another kind of element.
void Subdivision::refuse_hinge(const Group& group, int element) const {
  const auto& unknowns = group.entry->unknowns;
  if (std::ranges::all_of(unknowns, [](const ElementUnknown& u) { return u.nodes.empty(); })) return;
  b_->error("S402", {b_->deck.file, group.element_lines[element], 0, 0},
            "element " + std::to_string(group.element_numbers[element]) + " (" + group.element_name +
                ") lies along elements that are to be refined, and has a hinge: give it and its neighbours the "
                "size that is wanted");
  throw InputError(b_->problems);
}

void Subdivision::split_line(int g, int e, double t) {
  Group& group = b_->model.groups[g];
  const std::size_t n = group.node_count();
  const std::vector<int> nodes(group.nodes_of(e), group.nodes_of(e) + n);
  if (n < 2 || edges_.find(nodes[0], nodes[1]) == nullptr) return;
  refuse_hinge(group, e);
  const int middle = n > 2 ? nodes[2] : -1, at = cut(nodes[0], nodes[1], middle, t), child = group.elements();
  std::vector<int> first{nodes[0], at}, second{at, nodes[1]};
  if (n > 2) {
    first.push_back(middle < 0 ? -1 : cut(nodes[0], nodes[1], middle, 0.5 * t));
    second.push_back(middle < 0 ? -1 : cut(nodes[0], nodes[1], middle, 0.5 * (1.0 + t)));
  }
  std::copy(first.begin(), first.end(),
            group.nodes.begin() + static_cast<std::ptrdiff_t>(e) * static_cast<std::ptrdiff_t>(n));
  group.element_numbers.push_back(++last_number_);
  group.element_lines.push_back(group.element_lines[e]);
  group.nodes.insert(group.nodes.end(), second.begin(), second.end());
  if (loaded_.contains({g, e})) segments_[{g, e, 0}] = {{e, 0, 0.0, t}, {child, 0, t, 1.0}};
}

void Subdivision::carry_loads(Stage& stage) const {
  std::vector<EdgeLoad> carried;
  for (const EdgeLoad& load : stage.pressures) {
    const auto it = segments_.find({load.group, load.element, load.edge});
    if (it == segments_.end()) {
      carried.push_back(load);
      continue;
    }
    for (const Segment& s : it->second) {
      EdgeLoad part = load;
      part.element = s.element;
      part.edge = s.edge;
      const auto at = [](const Vector2& ends, double t) { return (1 - t) * ends.x() + t * ends.y(); };
      part.normal = {at(load.normal, s.from), at(load.normal, s.to)};
      part.shear = {at(load.shear, s.from), at(load.shear, s.to)};
      carried.push_back(part);
    }
  }
  stage.pressures = std::move(carried);
}

// The corners that were made on sides that follow a circle end the sides that follow it now.
void Subdivision::divide_arcs() {
  Mesh& mesh = b_->model.mesh;
  if (mesh.arcs.empty()) return;
  std::vector<char> corner(static_cast<std::size_t>(mesh.nodes()), 0);
  for (const Group& group : b_->model.groups) {
    if (group.structure()) continue;
    for (int e = 0; e < group.elements(); ++e)
      for (int k = 0; k < group.entry->corners; ++k) corner[group.nodes_of(e)[k]] = 1;
  }
  for (Arc& arc : mesh.arcs) {
    std::vector<std::pair<int, int>> ends;
    for (const auto& [a, z] : arc.ends) {
      const EdgeTable::Edge* const edge = edges_.find(a, z);
      std::vector<OnEdge> inside;
      for (int l = edge != nullptr ? edge->first : -1; l >= 0; l = edges_.link(l).next)
        if (corner[edges_.link(l).node] != 0) inside.push_back(edges_.link(l));
      std::ranges::sort(inside, {}, &OnEdge::at);
      const auto [of_a, of_z] = edges_.ends(a, z);
      int last = of_a < of_z ? a : z;  // places count from the smaller end
      for (const OnEdge& node : inside) ends.emplace_back(std::exchange(last, node.node), node.node);
      ends.emplace_back(last, of_a < of_z ? z : a);
    }
    arc.ends = std::move(ends);
  }
}

void Subdivision::finish() {
  const int first_made = nodes_.append();
  divide_arcs();
  inherit_along_edges(b_->model, edges_, first_made);
  for (Stage& stage : b_->model.stages) carry_loads(stage);
}

void refine(Work& b, int times, const std::string& option) {
  if (times <= 0) return;
  static const std::vector<ChildCorners> quad{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}},
                                              {{0, -1}, {1, -1}, {1, 0}, {0, 0}},
                                              {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                                              {{-1, 0}, {0, 0}, {0, 1}, {-1, 1}}};
  static const std::vector<ChildCorners> triangle{{{0, 0}, {.5, 0}, {0, .5}},
                                                  {{.5, 0}, {1, 0}, {.5, .5}},
                                                  {{0, .5}, {.5, .5}, {0, 1}},
                                                  {{.5, 0}, {.5, .5}, {0, .5}}};
  static const std::vector<ChildCorners> interface {
    {{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {
      {0, -1}, {1, -1}, {1, 1}, {
        0, 1
      }
    }
  };
  check_size(b, times, option);
  for (int i = 0; i < times; ++i) {
    Subdivision subdivision(b);
    subdivision.reserve(4 * b.model.mesh.nodes());
    for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
      Group& group = b.model.groups[g];
      if (group.structure()) {
        for (int e = group.elements() - 1; e >= 0; --e) subdivision.split_line(static_cast<int>(g), e, 0.5);
        continue;
      }
      const auto& children = group.interface() ? interface : group.entry->triangle() ? triangle : quad;
      const int before = group.elements();
      const std::size_t after = static_cast<std::size_t>(before) * children.size();
      group.nodes.reserve(after * group.node_count());
      group.element_numbers.reserve(after);
      group.element_lines.reserve(after);
      for (int e = 0; e < before; ++e) subdivision.split(static_cast<int>(g), e, children);
    }
    subdivision.finish();
  }
}

}  // namespace sage::mesh
