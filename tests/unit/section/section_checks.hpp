// What every mesh of a section must satisfy.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sage/section/section_mesh.hpp"

namespace sage::test {

#define SAGE_NEEDS_GMSH()                                                          \
  if (std::string why; !gmsh_available(&why)) {                                    \
    GTEST_SKIP() << "Gmsh is missing, and so is what this test is about: " << why; \
  }

inline int add_point(Section& section, double x, double y, double size = 0.0) {
  section.points.push_back({"", {x, y}, size});
  return static_cast<int>(section.points.size()) - 1;
}

inline SectionArea polygon(Section& section, const std::string& name, const std::vector<Vector2>& corners) {
  SectionArea area;
  area.name = name;
  for (const Vector2& x : corners) area.outline.push_back({add_point(section, x.x(), x.y()), -1});
  return area;
}

inline void add_rectangle(Section& section, const std::string& name, double x0, double y0, double x1,
                          double y1) {
  section.areas.push_back(polygon(section, name, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}));
}

inline SectionLine& add_line(Section& section, const std::string& name, const std::vector<Vector2>& points,
                             InterfaceSide interface, bool beam) {
  SectionLine line;
  line.name = name;
  for (const Vector2& x : points) line.points.push_back(add_point(section, x.x(), x.y()));
  line.interface = interface;
  line.beam = beam;
  section.lines.push_back(line);
  return section.lines.back();
}

inline double cross2(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

class MeshCheck {
 public:
  explicit MeshCheck(const SectionMesh& mesh) : mesh_(mesh) {
    for (const LineMesh& line : mesh.lines)
      if (!line.left_interfaces.empty() || !line.right_interfaces.empty())
        split_.insert(line.nodes.begin(), line.nodes.end());
    check_elements();
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) check_line(mesh.lines[l], "line " + std::to_string(l));
    check_used();
  }

  // Of the area, its curved edges taken as parabolas through three nodes.
  double area(int a) const { return areas_[a]; }
  // Of all edges that one element alone has.
  double free_length() const {
    double sum = 0.0;
    for (const auto& [edge, body] : left_)
      if (!left_.contains({edge.second, edge.first})) sum += (x(edge.first) - x(edge.second)).norm();
    return sum;
  }
  int elements(int a) const {
    return static_cast<int>(mesh_.areas[a].nodes.size()) / mesh_.nodes_per_element();
  }

 private:
  const Vector2& x(int node) const { return mesh_.x[node]; }

  void check_elements() {
    const int corners = mesh_.corners(), n = mesh_.nodes_per_element();
    std::map<std::pair<int, int>, int> middle;
    for (std::size_t a = 0; a < mesh_.areas.size(); ++a) {
      areas_.push_back(0.0);
      const std::vector<int>& nodes = mesh_.areas[a].nodes;
      ASSERT_EQ(nodes.size() % static_cast<std::size_t>(n), 0U);
      for (std::size_t e = 0; e * static_cast<std::size_t>(n) < nodes.size(); ++e) {
        const int* of = nodes.data() + e * static_cast<std::size_t>(n);
        for (int i = 0; i < corners; ++i) {
          const int p = of[i], q = of[(i + 1) % corners], r = of[(i + corners - 1) % corners];
          EXPECT_GT(cross2(x(q) - x(p), x(r) - x(p)), 0.0) << "area " << a << " element " << e;
          areas_.back() += 0.5 * cross2(x(p), x(q));
          const bool fresh =
              left_.emplace(std::pair(p, q), std::pair(static_cast<int>(a), static_cast<int>(e))).second;
          EXPECT_TRUE(fresh) << "two elements to the left of one edge";
          if (n == corners) continue;
          const int m = of[corners + i];
          areas_.back() += 2.0 / 3.0 * cross2(x(m) - 0.5 * (x(p) + x(q)), x(q) - x(p));
          const int known = middle.try_emplace({std::min(p, q), std::max(p, q)}, m).first->second;
          // A line of one edge between joined ends is open in its middle.
          if (!split_.contains(m)) {
            EXPECT_EQ(known, m) << "an edge has two middle nodes";
          }
        }
      }
    }
  }

  void check_line(const LineMesh& line, const std::string& who) {
    const std::size_t step = static_cast<std::size_t>(mesh_.nodes_per_edge - 1);
    const std::size_t rows = line.segments.size() * step + 1;
    ASSERT_EQ(line.left.size(), rows) << who;
    ASSERT_EQ(line.right.size(), rows) << who;
    for (std::size_t i = 0; i < line.segments.size(); ++i) {
      check_edge(line.segments[i].left, line, line.left[i * step], false, who);
      check_edge(line.segments[i].right, line, line.right[i * step], true, who);
    }
    for (const auto* list : {&line.left_interfaces, &line.right_interfaces})
      for (const InterfaceElement& element : *list)
        check_interface(element, line, list == &line.left_interfaces, who);
  }

  void check_edge(const AreaEdge& edge, const LineMesh& line, int first, bool turned, const std::string& who) {
    if (!edge.there()) return;
    const int n = mesh_.nodes_per_element();
    const int* of = mesh_.areas[edge.area].nodes.data() + edge.element * n;
    const int corner = of[(edge.edge + (turned ? 1 : 0)) % mesh_.corners()];
    EXPECT_EQ(corner, first) << who;
    EXPECT_TRUE(std::count(line.nodes.begin(), line.nodes.end(), corner)) << who;
  }

  void check_interface(const InterfaceElement& element, const LineMesh& line, bool on_left,
                       const std::string& who) {
    const auto& n = element.nodes;
    for (const auto& [i, j] : {std::pair(0, 3), std::pair(1, 2), std::pair(4, 5)}) {
      if (n[i] < 0) continue;
      const int one = n[i], other = n[j];
      EXPECT_NE(one, other) << who;
      EXPECT_EQ(x(one), x(other)) << who;
    }
    const LineSegment& segment = line.segments[element.segment];
    const bool joint = line.beam.empty();
    // The body to the right has its own edge from node 2 to node 1, the body to the left from node 4 to node 3.
    if (joint || !on_left) {
      ASSERT_TRUE(left_.contains({n[1], n[0]})) << who;
      EXPECT_EQ(left_.at({n[1], n[0]}).first, segment.right.area) << who;
    }
    if ((joint && !ends_in_twin(n)) || (!joint && on_left)) {
      ASSERT_TRUE(left_.contains({n[3], n[2]})) << who;
      EXPECT_EQ(left_.at({n[3], n[2]}).first, segment.left.area) << who;
    }
    if (joint) return;
    const std::size_t step = static_cast<std::size_t>(mesh_.nodes_per_edge - 1);
    const std::size_t k = static_cast<std::size_t>(element.segment) * step;
    EXPECT_EQ(line.beam[k], on_left ? n[0] : n[3]) << who;
    EXPECT_EQ(line.beam[k + step], on_left ? n[1] : n[2]) << who;
    if (step == 2) {
      EXPECT_EQ(line.beam[k + 1], on_left ? n[4] : n[5]) << who;
    }
  }

  bool ends_in_twin(const std::array<int, 6>& n) const {
    return std::any_of(mesh_.ties.begin(), mesh_.ties.end(), [&](const NodePair& tie) {
      return tie.kind == NodePair::Kind::end && (tie.second == n[2] || tie.second == n[3]);
    });
  }

  void check_used() const {
    std::set<int> used;
    for (const AreaMesh& area : mesh_.areas) used.insert(area.nodes.begin(), area.nodes.end());
    for (const LineMesh& line : mesh_.lines) used.insert(line.nodes.begin(), line.nodes.end());
    EXPECT_EQ(used.size(), mesh_.x.size());
  }

  const SectionMesh& mesh_;
  std::set<int> split_;  // nodes on lines with interfaces
  std::vector<double> areas_;
  std::map<std::pair<int, int>, std::pair<int, int>> left_;  // by directed edge: area and element
};

}  // namespace sage::test
