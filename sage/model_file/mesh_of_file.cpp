#include "sage/model_file/mesh_of_file.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace sage::model_file {

namespace {

[[noreturn]] void refuse_mesh(Code code, SectionItem item, int index, const std::string& message) {
  throw SectionError({{code, item, index, message}});
}

class MeshTaker {
 public:
  MeshTaker(const ForeignMesh& mesh, Section& section) : mesh_(mesh), section_(section) {}

  GivenMesh take() {
    take_nodes();
    for (const MeshBlock& block : mesh_.blocks)
      if (block.shape.dimension == 2) add_cells(block);
    find_edges();
    std::vector<std::vector<int>> lines;
    for (std::size_t l = 0; l < section_.lines.size(); ++l) lines.push_back(chain_of(static_cast<int>(l)));
    add_points();
    for (std::size_t l = 0; l < lines.size(); ++l)
      for (const int node : lines[l]) section_.lines[l].points.push_back(given_.point[node]);
    for (std::size_t a = 0; a < section_.areas.size(); ++a) add_outline(static_cast<int>(a));
    return std::move(given_);
  }

 private:
  using Edge = std::pair<int, int>;  // from node to node

  void take_nodes() {
    given_.x.resize(mesh_.index.size());
    for (const auto& [number, index] : mesh_.index) given_.x[index] = mesh_.nodes.at(number);
    given_.point.assign(given_.x.size(), -1);
  }

  int area_of(const MeshBlock& block) const {
    for (std::size_t a = 0; a < section_.areas.size(); ++a)
      if (std::ranges::find(block.names, section_.areas[a].name) != block.names.end() ||
          (block.names.empty() && block.otherwise == section_.areas[a].name))
        return static_cast<int>(a);
    refuse_mesh("S628", SectionItem::section, 0,
                "no [[area]] has the name of the mesh's surface " +
                    (block.names.empty() ? block.otherwise : block.names.front()));
  }

  void add_cells(const MeshBlock& block) {
    const int area = area_of(block), corners = section_.shape == ElementShape::triangle ? 3 : 4;
    if (block.shape.element == nullptr || block.shape.element->corners != corners)
      refuse_mesh("S628", SectionItem::area, area,
                  "area " + section_.areas[area].name + ": its elements in the mesh do not have the " +
                      std::to_string(corners) + " corners of the element of [mesh]");
    for (const ForeignMeshElement& element : block.elements) {
      GivenMesh::Cell cell;
      cell.area = area;
      std::copy_n(element.nodes.begin(), corners, cell.nodes.begin());
      double twice = 0.0;
      for (int i = 0; i < corners; ++i) {
        const Vector2 &a = given_.x[cell.nodes[i]], &b = given_.x[cell.nodes[(i + 1) % corners]];
        twice += a.x() * b.y() - a.y() * b.x();
      }
      if (twice < 0.0) std::reverse(cell.nodes.begin() + 1, cell.nodes.begin() + corners);
      given_.cells.push_back(cell);
    }
  }

  // Edges of each area that one of its elements has alone, the area on their left.
  void find_edges() {
    std::map<Edge, std::vector<int>> areas;  // of the elements on the left
    for (const GivenMesh::Cell& cell : given_.cells) {
      const int corners = cell.nodes[3] < 0 ? 3 : 4;
      for (int i = 0; i < corners; ++i)
        areas[{cell.nodes[i], cell.nodes[(i + 1) % corners]}].push_back(cell.area);
    }
    outlines_.resize(section_.areas.size());
    for (const auto& [edge, left] : areas) {
      const auto other = areas.find({edge.second, edge.first});
      const bool inside = other != areas.end() && other->second == left;
      if (inside) continue;
      outlines_[left.front()].push_back(edge);
      on_lines_.insert({edge.first, edge.second});
    }
  }

  // Of a named curve, or of the outlines between the nodes of a set.
  std::set<Edge> edges_of(const std::string& name) const {
    std::set<Edge> edges;
    for (const MeshBlock& block : mesh_.blocks)
      if (block.shape.dimension == 1 && std::ranges::find(block.names, name) != block.names.end())
        for (const ForeignMeshElement& element : block.elements)
          edges.insert(std::minmax(element.nodes[0], element.nodes[1]));
    const auto found = mesh_.sets.find(name);
    if (!edges.empty() || found == mesh_.sets.end()) return edges;
    const std::set<int> nodes(found->second.nodes.begin(), found->second.nodes.end());
    for (const std::vector<Edge>& outline : outlines_)
      for (const Edge& edge : outline)
        if (nodes.contains(edge.first) && nodes.contains(edge.second))
          edges.insert(std::minmax(edge.first, edge.second));
    return edges;
  }

  // Corners along a named curve, from one end to the other; around it where it is closed.
  std::vector<int> chain_of(int l) {
    const std::string& name = section_.lines[l].name;
    const std::set<Edge> edges = edges_of(name);
    on_lines_.insert(edges.begin(), edges.end());
    std::map<int, std::vector<int>> next;
    for (const Edge& edge : edges) {
      next[edge.first].push_back(edge.second);
      next[edge.second].push_back(edge.first);
    }
    int first = edges.empty() ? -1 : edges.begin()->first;
    if (first < 0)
      refuse_mesh("S628", SectionItem::line, l, "the mesh has no curve or set of nodes of the name " + name);
    std::size_t ends = 0;
    for (const auto& [node, others] : next) {
      if (others.size() > 2)
        refuse_mesh("S628", SectionItem::line, l,
                    "line " + name + " branches: a line goes from one end to another");
      if (others.size() == 1 && ends++ == 0) first = node;
    }
    std::vector<int> chain{first};
    for (int before = -1, here = first;;) {
      const std::vector<int>& others = next.at(here);
      const int after = others.front() != before ? others.front() : others.back();
      if (after == before || (others.size() == 1 && before >= 0)) break;
      chain.push_back(after);
      before = here;
      here = after;
      if (here == first) break;
    }
    if (chain.size() != next.size() + (ends == 0 ? 1 : 0))
      refuse_mesh("S628", SectionItem::line, l, "line " + name + " has parts that do not hang together");
    return chain;
  }

  // Nodes of outlines and lines, and those at points that the file names.
  void add_points() {
    Vector2 low = given_.x.front(), high = low;
    for (const Vector2& x : given_.x) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const double close = 1e-6 * (high - low).norm();
    for (std::size_t p = 0; p < section_.points.size(); ++p)
      for (std::size_t n = 0; n < given_.x.size(); ++n)
        if ((given_.x[n] - section_.points[p].x).norm() <= close) given_.point[n] = static_cast<int>(p);
    for (const Edge& edge : on_lines_)
      for (const int node : {edge.first, edge.second}) {
        if (given_.point[node] >= 0) continue;
        given_.point[node] = static_cast<int>(section_.points.size());
        SectionPoint point;
        point.x = given_.x[node];
        section_.points.push_back(std::move(point));
      }
  }

  // Loops with the area on their left: one around it, the others around holes.
  void add_outline(int a) {
    std::map<int, int> next;
    const std::string who = "area " + section_.areas[a].name;
    for (const Edge& edge : outlines_[a])
      if (!next.try_emplace(edge.first, edge.second).second)
        refuse_mesh("S628", SectionItem::area, a, who + " touches itself in a node of the mesh");
    if (next.empty())
      refuse_mesh("S628", SectionItem::area, a, "the mesh has no surface of the name of " + who);
    while (!next.empty()) {
      Outline loop;
      double twice = 0.0;
      const int start = next.begin()->first;
      for (int here = start;;) {
        const auto way = next.find(here);
        if (way == next.end()) break;
        const Vector2 &from = given_.x[here], &to = given_.x[way->second];
        twice += from.x() * to.y() - from.y() * to.x();
        loop.push_back({given_.point[here], -1});
        here = way->second;
        next.erase(way);
      }
      SectionArea& area = section_.areas[a];
      if (twice < 0.0)
        area.holes.push_back(std::move(loop));
      else if (area.outline.empty())
        area.outline = std::move(loop);
      else
        refuse_mesh("S628", SectionItem::area, a, who + " has parts that do not hang together");
    }
  }

  const ForeignMesh& mesh_;
  Section& section_;
  GivenMesh given_;
  std::vector<std::vector<Edge>> outlines_;  // by area
  std::set<Edge> on_lines_;
};

}  // namespace

GivenMesh take_mesh(const ForeignMesh& mesh, Section& section) {
  return MeshTaker(mesh, section).take();
}

}  // namespace sage::model_file
