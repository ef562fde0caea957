#include <algorithm>
#include <cmath>
#include <map>

#include "sage/section/flat_mesh.hpp"

namespace sage::section {

namespace {

constexpr int kSamples = 64;  // of the sizes along a piece

// How many edges fit between the piece's first vertex and each sample.
std::vector<double> edges_up_to(const Arrangement& arrangement, const SizeField& sizes, std::size_t piece) {
  const Curve& curve = arrangement.pieces[piece].curve;
  double limit = 1e300;
  for (const bool back : {false, true})
    limit = std::min(limit, sizes.limit_of(arrangement.area_left_of({static_cast<int>(piece), back})));
  std::vector<double> sum(kSamples + 1, 0.0);
  const auto density = [&](int k) { return 1.0 / std::min(limit, sizes.at(curve.at(k * 1.0 / kSamples))); };
  const double step = curve.length() / kSamples;
  double before = density(0);
  for (int k = 1; k <= kSamples; ++k) {
    const double here = density(k);
    sum[static_cast<std::size_t>(k)] = sum[static_cast<std::size_t>(k - 1)] + 0.5 * step * (before + here);
    before = here;
  }
  return sum;
}

double place_of(const std::vector<double>& sum, double value) {
  const auto above = std::upper_bound(sum.begin() + 1, sum.end() - 1, value);
  const double low = *(above - 1), high = *above;
  return (static_cast<double>(above - sum.begin()) - 1.0 + (value - low) / (high - low)) / kSamples;
}

}  // namespace

std::vector<int> edges_by_size(const Arrangement& arrangement, const SizeField& sizes, double factor) {
  // A length of 5 with edges of 1 must be 5 edges whatever the rounding, and 1.02 is no reason for a second one.
  constexpr double kSlack = 0.0237;
  std::vector<int> edges;
  for (std::size_t p = 0; p < arrangement.pieces.size(); ++p) {
    const double wished = edges_up_to(arrangement, sizes, p).back() / factor;
    edges.push_back(std::max(1, static_cast<int>(std::ceil(wished - kSlack))));
  }
  return edges;
}

FlatMesh divide(const Arrangement& arrangement, const SizeField& sizes, const std::vector<int>& edges,
                bool even) {
  FlatMesh mesh;
  mesh.x = arrangement.vertices;
  for (std::size_t p = 0; p < arrangement.pieces.size(); ++p) {
    const Piece& piece = arrangement.pieces[p];
    const int n = edges[p];
    const std::vector<double> sum = even ? std::vector<double>() : edges_up_to(arrangement, sizes, p);
    std::vector<int> nodes{piece.first};
    std::vector<double> places{0.0};
    for (int k = 1; k < n; ++k) {
      places.push_back(even ? k * 1.0 / n : place_of(sum, sum.back() * k / n));
      nodes.push_back(static_cast<int>(mesh.x.size()));
      mesh.x.push_back(piece.curve.at(places.back()));
    }
    nodes.push_back(piece.last);
    places.push_back(1.0);
    mesh.on_piece.push_back(std::move(nodes));
    mesh.places.push_back(std::move(places));
  }
  return mesh;
}

namespace {

// Whether edges that share no more than an end have another place in common.
bool edges_cross(const std::vector<Vector2>& x, const int* one, const int* other) {
  const auto place = [&](int node) -> const Vector2& { return x[node]; };
  const auto side = [&](const int* edge, int node) {
    return cross(place(edge[1]) - place(edge[0]), place(node) - place(edge[0]));
  };
  const auto separate = [&](const int* edge, const int* of) {
    const double a = side(edge, of[0]), b = side(edge, of[1]);
    return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0);
  };
  for (const int i : {0, 1})
    for (const int j : {0, 1})
      if (one[i] == other[j]) {
        // A common end: they overlap only if they leave it in one direction.
        const Vector2 d = place(one[1 - i]) - place(one[i]), e = place(other[1 - j]) - place(one[i]);
        return one[1 - i] == other[1 - j] || (cross(d, e) == 0.0 && d.dot(e) > 0.0);
      }
  return !separate(one, other) && !separate(other, one);
}

bool pieces_cross(const FlatMesh& mesh, std::size_t p, std::size_t q) {
  const std::vector<int>&one = mesh.on_piece[p], &other = mesh.on_piece[q];
  for (std::size_t i = 0; i + 1 < one.size(); ++i)
    for (std::size_t j = 0; j + 1 < other.size(); ++j)
      if (edges_cross(mesh.x, &one[i], &other[j])) return true;
  return false;
}

}  // namespace

std::vector<int> crossed_arcs(const Arrangement& arrangement, const FlatMesh& mesh) {
  std::vector<int> crossed;
  for (std::size_t p = 0; p < arrangement.pieces.size(); ++p) {
    const Curve& arc = arrangement.pieces[p].curve;
    if (!arc.arc) continue;
    bool any = false;
    for (std::size_t q = 0; q < arrangement.pieces.size() && !any; ++q) {
      const Curve& other = arrangement.pieces[q].curve;
      // Curves that are farther apart than they are long can't cross.
      const double reach = 0.5 * (arc.length() + other.length());
      any = p != q && (arc.at(0.5) - other.at(0.5)).norm() <= reach && pieces_cross(mesh, p, q);
    }
    if (any) crossed.push_back(static_cast<int>(p));
  }
  return crossed;
}

namespace {

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

FlatMesh into_quadrilaterals(const Arrangement& arrangement, const FlatMesh& coarse) {
  FlatMesh fine;
  fine.x = coarse.x;
  std::map<Edge, int> middle;
  const auto add = [&](const Vector2& x) {
    fine.x.push_back(x);
    return static_cast<int>(fine.x.size()) - 1;
  };
  for (std::size_t p = 0; p < coarse.on_piece.size(); ++p) {
    std::vector<int> nodes;
    std::vector<double> places;
    for (std::size_t k = 0; k < coarse.on_piece[p].size(); ++k) {
      nodes.push_back(coarse.on_piece[p][k]);
      places.push_back(coarse.places[p][k]);
      if (k + 1 == coarse.on_piece[p].size()) break;
      places.push_back(0.5 * (coarse.places[p][k] + coarse.places[p][k + 1]));
      nodes.push_back(add(arrangement.pieces[p].curve.at(places.back())));
      middle[edge_of(coarse.on_piece[p][k], coarse.on_piece[p][k + 1])] = nodes.back();
    }
    fine.on_piece.push_back(std::move(nodes));
    fine.places.push_back(std::move(places));
  }
  for (const Cell& cell : coarse.cells) {
    const int n = cell.corners();
    std::array<int, 4> mid{};
    Vector2 sum = Vector2::Zero();
    for (int i = 0; i < n; ++i) {
      const int a = cell.nodes[i], b = cell.nodes[(i + 1) % n];
      const auto [it, made] = middle.try_emplace(edge_of(a, b), -1);
      if (made) it->second = add(0.5 * (coarse.x[a] + coarse.x[b]));
      mid[i] = it->second;
      sum += fine.x[it->second];
    }
    const int centre = add(sum / n);
    for (int i = 0; i < n; ++i)
      fine.cells.push_back({{cell.nodes[i], mid[i], centre, mid[(i + n - 1) % n]}, cell.area});
  }
  return fine;
}

namespace {

struct Join {
  double quality;
  int first, second;  // triangles
  std::array<int, 4> nodes;
};

// Of the four corners of a quadrilateral: 1 where all are right angles, below 0 where it is not convex.
double squareness(const FlatMesh& mesh, const std::array<int, 4>& nodes) {
  double worst = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2& here = mesh.x[nodes[i]];
    const Vector2 out = mesh.x[nodes[(i + 1) % 4]] - here;
    const Vector2 in = mesh.x[nodes[(i + 3) % 4]] - here;
    const double angle = std::atan2(cross(out, in), out.dot(in));
    worst = std::min(worst, 1.0 - std::abs(angle - 0.5 * kPi) / (0.5 * kPi));
  }
  return worst;
}

}  // namespace

namespace {

// Edges on arcs.  Two that meet on one circle are the straighter, the finer they become.
class EdgesOfCircles {
 public:
  EdgesOfCircles(const Arrangement& arrangement, const FlatMesh& mesh) {
    for (std::size_t p = 0; p < mesh.on_piece.size(); ++p) {
      const Curve& curve = arrangement.pieces[p].curve;
      const std::vector<int>& nodes = mesh.on_piece[p];
      for (std::size_t k = 0; curve.arc && k + 1 < nodes.size(); ++k)
        circle_[edge_of(nodes[k], nodes[k + 1])] = &curve;
    }
  }
  bool any_flat(const std::array<int, 4>& nodes) const {
    for (std::size_t i = 0; i < 4; ++i)
      if (flat(nodes[i], nodes[(i + 1) % 4], nodes[(i + 2) % 4])) return true;
    return false;
  }

 private:
  bool flat(int a, int b, int c) const {
    constexpr double kSame = 1e-6;  // of the radius
    const auto one = circle_.find(edge_of(a, b)), other = circle_.find(edge_of(b, c));
    if (one == circle_.end() || other == circle_.end()) return false;
    const Curve &x = *one->second, &y = *other->second;
    return (x.centre - y.centre).norm() <= kSame * x.radius &&
           std::abs(x.radius - y.radius) <= kSame * x.radius;
  }

  std::map<Edge, const Curve*> circle_;
};

}  // namespace

void join_triangles(const Arrangement& arrangement, FlatMesh& mesh) {
  const EdgesOfCircles circles(arrangement, mesh);
  std::map<Edge, std::vector<std::pair<int, int>>> of_edge;  // triangle and its corner across
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 3; ++i)
      of_edge[edge_of(mesh.cells[c].nodes[(i + 1) % 3], mesh.cells[c].nodes[(i + 2) % 3])].emplace_back(
          static_cast<int>(c), static_cast<int>(i));
  for (const std::vector<int>& nodes : mesh.on_piece)
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) of_edge.erase(edge_of(nodes[k], nodes[k + 1]));
  std::vector<Join> joins;
  for (const auto& [edge, two] : of_edge) {
    if (two.size() != 2) continue;
    const Cell& cell = mesh.cells[two[0].first];
    const Cell& other = mesh.cells[two[1].first];
    const auto i = static_cast<std::size_t>(two[0].second);
    const std::array<int, 4> nodes{cell.nodes[i], cell.nodes[(i + 1) % 3], other.nodes[two[1].second],
                                   cell.nodes[(i + 2) % 3]};
    // Rounded, so that equal pairs keep their order on any processor.
    const double quality = std::round(1e6 * squareness(mesh, nodes));
    if (quality > 0.15e6 && !circles.any_flat(nodes))
      joins.push_back({quality, two[0].first, two[1].first, nodes});
  }
  std::stable_sort(joins.begin(), joins.end(),
                   [](const Join& a, const Join& b) { return a.quality > b.quality; });
  std::vector<char> gone(mesh.cells.size(), 0);
  for (const Join& join : joins) {
    if (gone[join.first] != 0 || gone[join.second] != 0) continue;
    gone[join.first] = 2;
    gone[join.second] = 1;
    mesh.cells[join.first].nodes = join.nodes;
  }
  std::size_t kept = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (gone[c] != 1) mesh.cells[kept++] = mesh.cells[c];
  mesh.cells.resize(kept);
}

double worst_corner(const FlatMesh& mesh, const Cell& cell) {
  const int n = cell.corners();
  double worst = 1.0;
  for (int i = 0; i < n; ++i) {
    const auto node = [&](int k) { return mesh.x[cell.nodes[static_cast<std::size_t>(k % n)]]; };
    const Vector2 out = node(i + 1) - node(i), in = node(i + n - 1) - node(i);
    worst = std::min(worst, cross(out, in) / std::max(out.norm() * in.norm(), 1e-300));
  }
  return worst;
}

void smooth(FlatMesh& mesh, std::size_t fixed_nodes) {
  std::vector<std::vector<int>> cells_of(mesh.x.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (int i = 0; i < mesh.cells[c].corners(); ++i)
      cells_of[mesh.cells[c].nodes[i]].push_back(static_cast<int>(c));
  std::vector<char> fixed(mesh.x.size(), 0);
  std::fill(fixed.begin(), fixed.begin() + static_cast<std::ptrdiff_t>(fixed_nodes), 1);
  for (const std::vector<int>& nodes : mesh.on_piece)
    for (const int node : nodes) fixed[node] = 1;
  const auto worst_around = [&](std::size_t v) {
    double worst = 1.0;
    for (const int c : cells_of[v]) worst = std::min(worst, worst_corner(mesh, mesh.cells[c]));
    return worst;
  };
  for (int round = 0; round < 4; ++round)
    for (std::size_t v = 0; v < mesh.x.size(); ++v) {
      if (fixed[v] != 0 || cells_of[v].empty()) continue;
      Vector2 sum = Vector2::Zero();
      int count = 0;
      for (const int c : cells_of[v]) {
        const Cell& cell = mesh.cells[c];
        for (int i = 0; i < cell.corners(); ++i) {
          if (cell.nodes[i] != static_cast<int>(v)) continue;
          const int n = cell.corners();
          sum += mesh.x[cell.nodes[(i + 1) % n]];
          sum += mesh.x[cell.nodes[(i + n - 1) % n]];
          count += 2;
        }
      }
      const double before = worst_around(v);
      const Vector2 old = mesh.x[v];
      mesh.x[v] = sum / count;
      if (worst_around(v) < std::min(before, 0.5)) mesh.x[v] = old;
    }
}

}  // namespace sage::section
