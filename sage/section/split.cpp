// Copies of nodes along lines with interfaces.  Around a node the elements form a fan.  Edges with interfaces cut it into
// sectors; each sector has a node of its own, and so have the beams that pass, unless they are bonded to one.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>

#include "sage/section/flat_mesh.hpp"

namespace sage::section {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

using Pair = std::pair<int, int>;

Pair sorted(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

struct WorkElement {
  int area = -1, number = -1;  // its place in the AreaMesh
  int corners = 0;
  std::vector<int> nodes;  // before the split
  std::vector<int> out;    // after
};

struct Body {
  int element = -1, edge = -1;
  bool there() const { return element >= 0; }
};

struct Segment {
  int line = -1, number = -1;  // of the segment on its line
  int a = -1, b = -1, middle = -1;
  Body left, right;
  bool left_split = false, right_split = false;
  bool cuts() const { return left.there() && right.there() && (left_split || right_split); }
};

// Sectors and beams around one node; those that share a node are of one class.
class Around {
 public:
  explicit Around(int items) : parent_(at(items)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int of(int i) const {
    while (parent_[at(i)] != i) i = parent_[at(i)];
    return i;
  }
  void join(int i, int j) {
    const int a = of(i), b = of(j);
    parent_[at(std::max(a, b))] = std::min(a, b);
  }
  void keep_apart(int i, int j) {
    if (of(i) != of(j)) apart_.emplace_back(i, j);
  }
  // False where two that an interface joins would become one.
  bool join_if_allowed(int i, int j) {
    const int a = of(i), b = of(j);
    if (a == b) return true;
    for (const auto& [u, v] : apart_)
      if ((of(u) == a && of(v) == b) || (of(u) == b && of(v) == a)) return false;
    join(i, j);
    return true;
  }

 private:
  std::vector<int> parent_;
  std::vector<Pair> apart_;
};

class Splitter {
 public:
  Splitter(const Section& section, const Arrangement& arrangement, const FlatMesh& mesh)
      : section_(section), a_(arrangement), flat_(mesh), x_(mesh.x) {
    out_.shape = section.shape;
    out_.nodes_per_edge = section.nodes_per_edge;
  }

  SectionMesh split() {
    number_elements();
    if (quadratic()) add_middle_nodes();
    index_edges();
    follow_lines();
    for (const int node : split_nodes_) split_node(node);
    fill_areas();
    for (std::size_t i = 0; i < section_.lines.size(); ++i) fill_line(static_cast<int>(i));
    fill_points();
    compact();
    return std::move(out_);
  }

 private:
  bool quadratic() const { return section_.nodes_per_edge == 3; }

  int add_node(const Vector2& x) {
    x_.push_back(x);
    return static_cast<int>(x_.size()) - 1;
  }

  void number_elements() {
    out_.areas.resize(section_.areas.size());
    std::vector<int> count(section_.areas.size(), 0);
    for (const Cell& cell : flat_.cells) {
      WorkElement element;
      element.area = cell.area;
      element.number = count[at(cell.area)]++;
      element.corners = cell.corners();
      element.nodes.assign(cell.nodes.begin(), cell.nodes.begin() + element.corners);
      elements_.push_back(std::move(element));
    }
  }

  int middle_of(int a, int b) {
    const auto [it, made] = middles_.try_emplace(sorted(a, b), -1);
    if (made) it->second = add_node(0.5 * (x_[at(a)] + x_[at(b)]));
    return it->second;
  }

  // On arcs they lie on the arc, elsewhere in the middle of the edge.
  void add_middle_nodes() {
    for (std::size_t p = 0; p < a_.pieces.size(); ++p) {
      const std::vector<int>& nodes = flat_.on_piece[p];
      for (std::size_t k = 0; a_.pieces[p].curve.arc && k + 1 < nodes.size(); ++k) {
        const double place = 0.5 * (flat_.places[p][k] + flat_.places[p][k + 1]);
        middles_[sorted(nodes[k], nodes[k + 1])] = add_node(a_.pieces[p].curve.at(place));
      }
    }
    for (WorkElement& element : elements_)
      for (int i = 0; i < element.corners; ++i)
        element.nodes.push_back(middle_of(element.nodes[at(i)], element.nodes[at((i + 1) % element.corners)]));
  }

  void index_edges() {
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      WorkElement& element = elements_[e];
      element.out = element.nodes;
      for (int i = 0; i < element.corners; ++i)
        edges_[{element.nodes[at(i)], element.nodes[at((i + 1) % element.corners)]}] = {static_cast<int>(e), i};
    }
  }

  Body left_of(int a, int b) const {
    const auto found = edges_.find({a, b});
    return found == edges_.end() ? Body() : found->second;
  }

  void follow_lines() {
    for (std::size_t l = 0; l < section_.lines.size(); ++l) {
      std::vector<Segment>& segments = segments_.emplace_back();
      for (const Way& way : a_.lines[l]) {
        std::vector<int> nodes = flat_.on_piece[at(way.piece)];
        if (way.back) std::reverse(nodes.begin(), nodes.end());
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
          segments.push_back(make_segment(static_cast<int>(l), static_cast<int>(segments.size()), nodes[k],
                                          nodes[k + 1], way));
      }
    }
    for (const std::vector<Segment>& segments : segments_)
      for (const Segment& segment : segments) note_segment(segment);
  }

  Segment make_segment(int line, int number, int a, int b, Way way) {
    const SectionLine& of = section_.lines[at(line)];
    Segment segment;
    segment.line = line;
    segment.number = number;
    segment.a = a;
    segment.b = b;
    if (quadratic()) segment.middle = middle_of(a, b);
    segment.left = left_of(a, b);
    segment.right = left_of(b, a);
    if (segment.left.there() != (a_.area_left_of(way) >= 0) ||
        segment.right.there() != (a_.area_left_of({way.piece, !way.back}) >= 0))
      throw SectionError({{"S261", SectionItem::line, line,
                           name_of(section_, SectionItem::line, line) + " has elements across it around " +
                               text_of(0.5 * (x_[at(a)] + x_[at(b)]))}});
    const bool joint =
        !of.beam && of.interface != InterfaceSide::none && segment.left.there() && segment.right.there();
    const bool both = of.interface == InterfaceSide::both;
    segment.left_split =
        joint || (of.beam && segment.left.there() && (both || of.interface == InterfaceSide::left));
    segment.right_split =
        joint || (of.beam && segment.right.there() && (both || of.interface == InterfaceSide::right));
    return segment;
  }

  void note_segment(const Segment& segment) {
    if (segment.cuts()) cut_.insert(sorted(segment.a, segment.b));
    for (const int node : {segment.a, segment.middle, segment.b}) {
      if (node < 0) continue;
      passing_[node].push_back(&segment);
      if (segment.left_split || segment.right_split) split_nodes_.insert(node);
    }
  }

  // Elements at nodes that may be split.
  const std::vector<int>& fan_of(int node) {
    if (fans_.empty())
      for (std::size_t e = 0; e < elements_.size(); ++e)
        for (const int n : elements_[e].nodes)
          if (split_nodes_.contains(n)) fans_[n].push_back(static_cast<int>(e));
    return fans_[node];
  }

  // Edges of an element at one of its nodes: two at a corner, one at a middle node.
  static std::vector<Pair> edges_at(const WorkElement& element, int node) {
    std::vector<Pair> edges;
    const int n = element.corners;
    const int k =
        static_cast<int>(std::find(element.nodes.begin(), element.nodes.end(), node) - element.nodes.begin());
    if (k >= n) return {sorted(element.nodes[at(k - n)], element.nodes[at((k - n + 1) % n)])};
    for (const int other : {(k + 1) % n, (k + n - 1) % n})
      edges.push_back(sorted(node, element.nodes[at(other)]));
    return edges;
  }

  // The sector of each element of the fan.
  std::vector<int> sectors_of(int node, const std::vector<int>& fan, const std::set<Pair>& further_cuts) const {
    std::vector<int> sector(fan.size());
    std::iota(sector.begin(), sector.end(), 0);
    std::map<Pair, std::size_t> first;
    const auto root = [&](std::size_t i) {
      while (at(sector[i]) != i) i = at(sector[i]);
      return i;
    };
    for (std::size_t i = 0; i < fan.size(); ++i)
      for (const Pair& edge : edges_at(elements_[at(fan[i])], node)) {
        if (cut_.contains(edge) || further_cuts.contains(edge)) continue;
        const auto [it, made] = first.try_emplace(edge, i);
        if (made) continue;
        const std::size_t one = root(i), other = root(it->second);
        sector[std::max(one, other)] = static_cast<int>(std::min(one, other));
      }
    std::map<std::size_t, int> number;
    std::vector<int> numbered;
    for (std::size_t i = 0; i < fan.size(); ++i)
      numbered.push_back(number.try_emplace(root(i), static_cast<int>(number.size())).first->second);
    return numbered;
  }

  LineEnd end_at(const Segment& segment, int node) const {
    const SectionLine& line = section_.lines[at(segment.line)];
    const bool last =
        segment.b == node && segment.number + 1 == static_cast<int>(segments_[at(segment.line)].size());
    const bool first = segment.a == node && segment.number == 0;
    if (!first && !last) return LineEnd::joined;
    const LineEnd end = last ? line.last_end : line.first_end;
    if (end != LineEnd::automatic) return end;
    return line.beam && line.interface == InterfaceSide::both ? LineEnd::joined : LineEnd::open;
  }

  // The edge that goes on from an open end, straight ahead as far as the mesh has one.
  std::optional<Pair> edge_ahead(const Segment& segment, int node, const std::vector<int>& fan) const {
    const int behind = segment.a == node ? segment.b : segment.a;
    const Vector2 ahead = (x_[at(node)] - x_[at(behind)]).normalized();
    std::optional<Pair> best;
    double most = -2.0;
    std::map<Pair, int> count;
    for (const int e : fan)
      for (const Pair& edge : edges_at(elements_[at(e)], node)) ++count[edge];
    for (const auto& [edge, elements] : count) {
      if (elements != 2 || cut_.contains(edge)) continue;
      const int to = edge.first == node ? edge.second : edge.first;
      const double cosine = (x_[at(to)] - x_[at(node)]).normalized().dot(ahead);
      if (cosine > most + 1e-9) {
        most = cosine;
        best = edge;
      }
    }
    return best;
  }

  struct Sides {
    int left = -1, right = -1;  // sectors; -1: no body
  };

  static int sector_at(const Body& body, const std::vector<int>& fan, const std::vector<int>& sector) {
    if (!body.there()) return -1;
    return sector[at(static_cast<int>(std::find(fan.begin(), fan.end(), body.element) - fan.begin()))];
  }

  static Sides sides_of(const Segment& segment, const std::vector<int>& fan, const std::vector<int>& sector) {
    return {sector_at(segment.left, fan, sector), sector_at(segment.right, fan, sector)};
  }

  void split_node(int node) {
    const std::vector<int>& fan = fan_of(node);
    const std::vector<const Segment*>& passing = passing_[node];
    std::vector<int> sector = sectors_of(node, fan, {});
    for (const Segment* segment : passing) {
      const Sides sides = sides_of(*segment, fan, sector);
      if (!segment->cuts() || sides.left != sides.right || end_at(*segment, node) != LineEnd::open) continue;
      if (const auto edge = edge_ahead(*segment, node, fan)) sector = sectors_of(node, fan, {*edge});
    }
    const int sectors = sector.empty() ? 0 : *std::max_element(sector.begin(), sector.end()) + 1;
    const int beam = std::any_of(passing.begin(), passing.end(), [&](const Segment* s) { return has_beam(*s); })
                         ? sectors
                         : -1;
    Around around(sectors + (beam >= 0 ? 1 : 0));
    for (const Segment* segment : passing) keep_apart(*segment, sides_of(*segment, fan, sector), beam, around);
    std::vector<NodePair> bonds;
    for (const Segment* segment : passing) bond(*segment, sides_of(*segment, fan, sector), beam, around, bonds);
    give_nodes(node, fan, sector, beam, around, bonds);
  }

  bool has_beam(const Segment& segment) const { return section_.lines[at(segment.line)].beam; }

  void keep_apart(const Segment& segment, Sides sides, int beam, Around& around) const {
    if (!has_beam(segment)) {
      if (segment.left_split) around.keep_apart(sides.left, sides.right);
      return;
    }
    if (segment.left_split) around.keep_apart(sides.left, beam);
    if (segment.right_split) around.keep_apart(sides.right, beam);
  }

  // A beam shares the nodes of the ground on a side without interfaces.
  void bond(const Segment& segment, Sides sides, int beam, Around& around, std::vector<NodePair>& bonds) const {
    if (!has_beam(segment)) return;
    for (const auto& [side, split] :
         {std::pair(sides.left, segment.left_split), {sides.right, segment.right_split}}) {
      if (side < 0 || split || around.join_if_allowed(beam, side)) continue;
      const auto same = [&, side = side](const NodePair& tie) { return tie.second == side; };
      if (std::none_of(bonds.begin(), bonds.end(), same))
        bonds.push_back({beam, side, segment.line, NodePair::Kind::bond});
    }
  }

  void give_nodes(int node, const std::vector<int>& fan, const std::vector<int>& sector, int beam,
                  const Around& around, const std::vector<NodePair>& bonds) {
    std::map<int, int> node_of_class;
    std::vector<int>& copies = copies_[node];
    const int items =
        (sector.empty() ? 0 : *std::max_element(sector.begin(), sector.end()) + 1) + (beam >= 0 ? 1 : 0);
    std::vector<int> node_of(at(items));
    for (int i = 0; i < items; ++i) {
      const auto [it, made] = node_of_class.try_emplace(around.of(i), node);
      if (made) {
        if (!copies.empty()) it->second = add_node(Vector2(x_[at(node)]));
        copies.push_back(it->second);
      }
      node_of[at(i)] = it->second;
    }
    for (std::size_t i = 0; i < fan.size(); ++i) {
      WorkElement& element = elements_[at(fan[i])];
      const auto k = std::find(element.nodes.begin(), element.nodes.end(), node) - element.nodes.begin();
      element.out[static_cast<std::size_t>(k)] = node_of[at(sector[i])];
    }
    if (beam >= 0) beam_nodes_[node] = node_of[at(beam)];
    for (const NodePair& tie : bonds) {
      const int first = node_of[at(tie.first)], second = node_of[at(tie.second)];
      if (first != second) out_.ties.push_back({first, second, tie.line, tie.kind});
    }
  }

  void fill_areas() {
    for (const WorkElement& element : elements_) {
      std::vector<int>& nodes = out_.areas[at(element.area)].nodes;
      nodes.insert(nodes.end(), element.out.begin(), element.out.end());
    }
  }

  // Nodes of a body along a segment: first, last, middle.
  std::array<int, 3> nodes_of(const Body& body, bool turned) const {
    if (!body.there()) return {-1, -1, -1};
    const WorkElement& element = elements_[at(body.element)];
    const int a = element.out[at(body.edge)], b = element.out[at((body.edge + 1) % element.corners)];
    const int middle = quadratic() ? element.out[at(element.corners + body.edge)] : -1;
    return turned ? std::array{b, a, middle} : std::array{a, b, middle};
  }

  std::array<int, 3> beam_of(const Segment& segment) const {
    const auto one = [&](int node) {
      const auto found = beam_nodes_.find(node);
      return found == beam_nodes_.end() ? node : found->second;
    };
    return {one(segment.a), one(segment.b), segment.middle < 0 ? -1 : one(segment.middle)};
  }

  AreaEdge edge_of(const Body& body) const {
    if (!body.there()) return {};
    const WorkElement& element = elements_[at(body.element)];
    return {element.area, element.number, body.edge};
  }

  void fill_line(int l) {
    LineMesh& line = out_.lines.emplace_back();
    const std::vector<Segment>& segments = segments_[at(l)];
    std::vector<std::array<int, 3>> left, right, beam;
    for (const Segment& segment : segments) {
      line.segments.push_back({edge_of(segment.left), edge_of(segment.right)});
      left.push_back(nodes_of(segment.left, false));
      right.push_back(nodes_of(segment.right, true));
      beam.push_back(beam_of(segment));
      add_interfaces(segment, left.back(), right.back(), beam.back(), line);
    }
    line.left = row(left);
    line.right = row(right);
    if (section_.lines[at(l)].beam) line.beam = row(beam);
    for (const Segment& segment : segments)
      for (const int node : {segment.a, segment.middle, segment.b}) add_copies(node, line.nodes);
    tie_ends(l);
  }

  // Where two segments give different nodes, that of the second counts.
  std::vector<int> row(const std::vector<std::array<int, 3>>& segments) const {
    std::vector<int> nodes;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const auto& [first, last, middle] = segments[i];
      const int before = i > 0 ? segments[i - 1][1] : -1;
      nodes.push_back(first >= 0 ? first : before);
      if (quadratic()) nodes.push_back(middle);
      if (i + 1 == segments.size()) nodes.push_back(last);
    }
    return nodes;
  }

  // A pair is two nodes also where the bodies are one.
  int other_of_pair(int node, int same, int line, int original) {
    if (node != same) return same;
    const int twin = add_node(Vector2(x_[at(node)]));
    copies_[original].push_back(twin);
    out_.ties.push_back({node, twin, line, NodePair::Kind::end});
    return twin;
  }

  void add_interface(const Segment& segment, const std::array<int, 3>& right, const std::array<int, 3>& left,
                     std::vector<InterfaceElement>& list) {
    InterfaceElement element;
    element.segment = segment.number;
    element.nodes = {right[0],
                     right[1],
                     other_of_pair(right[1], left[1], segment.line, segment.b),
                     other_of_pair(right[0], left[0], segment.line, segment.a),
                     right[2],
                     left[2]};
    list.push_back(element);
  }

  void add_interfaces(const Segment& segment, const std::array<int, 3>& left, const std::array<int, 3>& right,
                      const std::array<int, 3>& beam, LineMesh& line) {
    if (!has_beam(segment)) {
      if (segment.left_split) add_interface(segment, right, left, line.left_interfaces);
      return;
    }
    if (segment.left_split) add_interface(segment, beam, left, line.left_interfaces);
    if (segment.right_split) add_interface(segment, right, beam, line.right_interfaces);
  }

  void add_copies(int node, std::vector<int>& nodes) const {
    if (node < 0) return;
    const auto found = copies_.find(node);
    const std::vector<int> all = found == copies_.end() ? std::vector<int>{node} : found->second;
    for (const int copy : all)
      if (std::find(nodes.begin(), nodes.end(), copy) == nodes.end()) nodes.push_back(copy);
  }

  void tie_ends(int l) {
    const SectionLine& line = section_.lines[at(l)];
    const std::vector<Segment>& segments = segments_[at(l)];
    if (!line.beam || segments.empty()) return;
    for (const bool last : {false, true}) {
      if ((last ? line.last_end : line.first_end) != LineEnd::tied) continue;
      const Segment& segment = last ? segments.back() : segments.front();
      const std::size_t k = last ? 1 : 0;
      const int left = nodes_of(segment.left, false)[k], right = nodes_of(segment.right, true)[k];
      const int beam = beam_of(segment)[k];
      if (left >= 0 && left == right && left != beam) out_.ties.push_back({beam, left, l, NodePair::Kind::toe});
    }
  }

  void fill_points() {
    std::vector<char> used(x_.size(), 0);
    for (const AreaMesh& area : out_.areas)
      for (const int node : area.nodes) used[at(node)] = 1;
    for (const LineMesh& line : out_.lines)
      for (const int node : line.nodes) used[at(node)] = 1;
    for (const int vertex : a_.vertex_of_point) {
      PointMesh& point = out_.points.emplace_back();
      if (used[at(vertex)] == 0) continue;
      add_copies(vertex, point.nodes);
      const auto passing = passing_.find(vertex);
      if (passing == passing_.end()) continue;
      for (const Segment* segment : passing->second)
        if (has_beam(*segment)) point.beam = beam_of(*segment)[segment->a == vertex ? 0 : 1];
      const auto beam = std::find(point.nodes.begin(), point.nodes.end(), point.beam);
      if (beam != point.nodes.end()) std::rotate(point.nodes.begin(), beam, beam + 1);
    }
    used_ = std::move(used);
  }

  // Leaves out nodes that nothing has: centres, and pieces outside of areas.
  void compact() {
    std::vector<int> number(x_.size(), -1);
    for (std::size_t node = 0; node < x_.size(); ++node) {
      if (used_[node] == 0) continue;
      number[node] = static_cast<int>(out_.x.size());
      out_.x.push_back(x_[node]);
    }
    const auto renumber = [&](int& node) {
      if (node >= 0) node = number[at(node)];
    };
    for (AreaMesh& area : out_.areas) std::for_each(area.nodes.begin(), area.nodes.end(), renumber);
    for (LineMesh& line : out_.lines) {
      for (std::vector<int>* list : {&line.left, &line.right, &line.beam, &line.nodes})
        std::for_each(list->begin(), list->end(), renumber);
      for (std::vector<InterfaceElement>* list : {&line.left_interfaces, &line.right_interfaces})
        for (InterfaceElement& element : *list)
          std::for_each(element.nodes.begin(), element.nodes.end(), renumber);
    }
    for (PointMesh& point : out_.points) {
      std::for_each(point.nodes.begin(), point.nodes.end(), renumber);
      renumber(point.beam);
    }
    for (NodePair& tie : out_.ties) {
      renumber(tie.first);
      renumber(tie.second);
    }
  }

  const Section& section_;
  const Arrangement& a_;
  const FlatMesh& flat_;
  std::vector<Vector2> x_;
  SectionMesh out_;
  std::vector<WorkElement> elements_;
  std::map<Pair, int> middles_;
  std::map<Pair, Body> edges_;  // directed: the element to the left
  std::vector<std::vector<Segment>> segments_;
  std::map<int, std::vector<const Segment*>> passing_;
  std::set<Pair> cut_;  // edges that separate the bodies beside them
  std::set<int> split_nodes_;
  std::unordered_map<int, std::vector<int>> fans_;
  std::map<int, std::vector<int>> copies_;  // by node before the split: all nodes there
  std::map<int, int> beam_nodes_;
  std::vector<char> used_;
};

}  // namespace

SectionMesh split(const Section& section, const Arrangement& arrangement, const FlatMesh& mesh) {
  return Splitter(section, arrangement, mesh).split();
}

}  // namespace sage::section
