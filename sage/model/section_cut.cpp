#include "sage/model/section_cut.hpp"

#include <algorithm>
#include <cmath>

#include "sage/model/locate.hpp"

namespace sage {

namespace {

constexpr double kSame = 1e-9;  // of the length of the cut

// The cut as a line with distances to it.
struct CutLine {
  Vector2 first, along, normal;
  double length;

  CutLine(const Vector2& a, const Vector2& b)
      : first(a), along((b - a).normalized()), normal(-along.y(), along.x()), length((b - a).norm()) {}
  double beside(const Vector2& x) const { return normal.dot(x - first); }
  double way(const Vector2& x) const { return along.dot(x - first); }
};

// The edge through nodes at equal steps, the corners first and second in the list: its place at s = 0 .. 1.
Vector2 place_on_edge(const std::vector<Vector2>& nodes, double s) {
  const auto n = static_cast<int>(nodes.size());
  const auto step_of = [&](int i) { return i == 0 ? 0 : i == 1 ? n - 1 : i - 1; };
  Vector2 place = Vector2::Zero();
  for (int i = 0; i < n; ++i) {
    double N = 1.0;
    for (int j = 0; j < n; ++j)
      if (j != i) N *= (s * (n - 1) - step_of(j)) / (step_of(i) - step_of(j));
    place += N * nodes[static_cast<std::size_t>(i)];
  }
  return place;
}

// Whether the edge is that far from the cut that it can't meet it, even where it is curved between its nodes.
bool is_far(const CutLine& cut, const std::vector<Vector2>& edge) {
  double least = cut.beside(edge[0]), most = least;
  for (const Vector2& node : edge) {
    least = std::min(least, cut.beside(node));
    most = std::max(most, cut.beside(node));
  }
  const double beyond = kSame * cut.length + (edge.size() < 3 ? 0.0 : most - least);
  return least > beyond || most < -beyond;
}

// Where the edge meets the cut, as ways along the cut.
void add_crossings(const CutLine& cut, const std::vector<Vector2>& edge, std::vector<double>& ways) {
  if (is_far(cut, edge)) return;
  const int parts = edge.size() < 3 ? 1 : 4 * static_cast<int>(edge.size() - 1);
  const double near = kSame * cut.length;
  double s0 = 0.0, d0 = cut.beside(edge[0]);
  for (int i = 1; i <= parts; ++i) {
    const double s1 = static_cast<double>(i) / parts;
    const Vector2 place = place_on_edge(edge, s1);
    const double d1 = cut.beside(place);
    if (std::abs(d0) <= near) ways.push_back(cut.way(place_on_edge(edge, s0)));
    if (std::abs(d1) <= near) ways.push_back(cut.way(place));
    if (std::abs(d0) > near && std::abs(d1) > near && d0 * d1 < 0.0) {
      double low = s0, high = s1, d_low = d0, d_high = d1, s = s0;
      for (int k = 0; k < 60 && high - low > 1e-15; ++k) {
        // The secant for straight edges, halves where it does not help.
        s = k % 2 == 0 ? low - d_low * (high - low) / (d_high - d_low) : 0.5 * (low + high);
        const double d = cut.beside(place_on_edge(edge, s));
        if (std::abs(d) <= 1e-14 * cut.length) break;
        (d * d_low < 0.0 ? high : low) = s;
        (d * d_low < 0.0 ? d_high : d_low) = d;
      }
      ways.push_back(cut.way(place_on_edge(edge, s)));
    }
    s0 = s1;
    d0 = d1;
  }
}

// Ends of the cut and where it meets edges of solids; rising.
std::vector<double> crossings(const Model& model, const CutLine& cut, const std::vector<char>& active,
                              int only) {
  std::vector<double> ways{0.0, cut.length};
  std::vector<Vector2> nodes;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.solid() || (!active.empty() && !active[g]) || (only >= 0 && g != static_cast<std::size_t>(only)))
      continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* node = group.nodes_of(e);
      for (const std::vector<int>& edge : group.element->edges()) {
        nodes.clear();
        for (const int local : edge) nodes.emplace_back(model.mesh.x.col(node[local]));
        add_crossings(cut, nodes, ways);
      }
    }
  }
  std::erase_if(ways, [&](double way) { return way < 0.0 || way > cut.length; });
  std::ranges::sort(ways);
  return ways;
}

}  // namespace

std::vector<CutPiece> cut_pieces(const Model& model, const Vector2& first, const Vector2& last,
                                 const std::vector<char>& active, int group) {
  const CutLine cut(first, last);
  const Locator locator(model, ElementKind::solid);
  std::vector<CutPiece> pieces;
  double from = 0.0;
  for (const double way : crossings(model, cut, active, group)) {
    if (way - from <= kSame * cut.length) continue;
    const Vector2 middle = cut.first + 0.5 * (from + way) * cut.along;
    if (!one_body(model, locator.at(middle), active, group).empty()) pieces.push_back({from, way});
    from = way;
  }
  return pieces;
}

}  // namespace sage
