#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "sage/section/flat_mesh.hpp"

namespace sage::section {

namespace {

using Sides = std::array<std::vector<Way>, 4>;

Vector2 direction(const Curve& curve, bool back, bool at_end) {
  constexpr double kStep = 1e-4;
  const double from = at_end ? 1.0 - kStep : 0.0, to = at_end ? 1.0 : kStep;
  const Vector2 d =
      back ? Vector2(curve.at(1.0 - to) - curve.at(1.0 - from)) : Vector2(curve.at(to) - curve.at(from));
  return d.normalized();
}

// The four sides of a face in their order around; nothing for other faces.  A corner turns by 36 degrees or more.
std::optional<Sides> sides_of(const Arrangement& a, const Face& face) {
  constexpr double kTurn = 0.2 * kPi;
  if (!face.inner.empty() || !face.vertices.empty()) return std::nullopt;
  const std::size_t n = face.outer.size();
  std::vector<std::size_t> corners;  // ways that start at one
  for (std::size_t i = 0; i < n; ++i) {
    const Way before = face.outer[(i + n - 1) % n], way = face.outer[i];
    if (a.face_left_of(way) == a.face_left_of({way.piece, !way.back})) return std::nullopt;
    const Vector2 in = direction(a.pieces[before.piece].curve, before.back, true);
    const Vector2 out = direction(a.pieces[way.piece].curve, way.back, false);
    const double turn = std::atan2(cross(in, out), in.dot(out));
    if (turn < -kTurn) return std::nullopt;
    if (turn > kTurn) corners.push_back(i);
  }
  if (corners.size() != 4) return std::nullopt;
  Sides sides;
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t i = corners[s]; i % n != corners[(s + 1) % 4]; ++i) sides[s].push_back(face.outer[i % n]);
  return sides;
}

std::vector<int> nodes_along(const FlatMesh& mesh, const std::vector<Way>& ways) {
  std::vector<int> nodes;
  for (const Way& way : ways) {
    std::vector<int> piece = mesh.on_piece[way.piece];
    if (way.back) std::reverse(piece.begin(), piece.end());
    nodes.insert(nodes.end(), piece.begin() + (nodes.empty() ? 0 : 1), piece.end());
  }
  return nodes;
}

class Classes {
 public:
  explicit Classes(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int of(int i) {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void join(int i, int j) {
    const int a = of(i), b = of(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

// Nodes of a block by row and column.
class Grid {
 public:
  Grid(FlatMesh& mesh, const Sides& sides)
      : bottom_(nodes_along(mesh, sides[0])),
        right_(nodes_along(mesh, sides[1])),
        top_(nodes_along(mesh, sides[2])),
        left_(nodes_along(mesh, sides[3])) {
    std::reverse(top_.begin(), top_.end());
    std::reverse(left_.begin(), left_.end());
    columns_ = bottom_.size() - 1;
    rows_ = left_.size() - 1;
    inner_ = static_cast<int>(mesh.x.size());
    for (std::size_t j = 1; j < rows_; ++j)
      for (std::size_t i = 1; i < columns_; ++i) mesh.x.push_back(between(mesh, i, j));
  }

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }

  int node(std::size_t i, std::size_t j) const {
    if (j == 0) return bottom_[i];
    if (j == rows_) return top_[i];
    if (i == 0) return left_[j];
    if (i == columns_) return right_[j];
    return inner_ + static_cast<int>((j - 1) * (columns_ - 1) + i - 1);
  }

 private:
  // By transfinite interpolation between the four sides (Gordon and Hall 1973).
  Vector2 between(const FlatMesh& mesh, std::size_t i, std::size_t j) const {
    const double s = static_cast<double>(i) / static_cast<double>(columns_);
    const double t = static_cast<double>(j) / static_cast<double>(rows_);
    const auto x = [&](int node) -> const Vector2& { return mesh.x[node]; };
    return (1 - t) * x(bottom_[i]) + t * x(top_[i]) + (1 - s) * x(left_[j]) + s * x(right_[j]) -
           (1 - s) * (1 - t) * x(bottom_.front()) - s * (1 - t) * x(bottom_.back()) - s * t * x(top_.back()) -
           (1 - s) * t * x(top_.front());
  }

  std::vector<int> bottom_, right_, top_, left_;
  std::size_t columns_ = 0, rows_ = 0;
  int inner_ = 0;
};

}  // namespace

std::vector<int> edges_of_blocks(const Arrangement& arrangement, const std::vector<int>& wished, int& area) {
  Classes classes(arrangement.pieces.size());
  for (const Face& face : arrangement.faces) {
    if (face.area < 0) continue;
    area = face.area;
    const std::optional<Sides> sides = sides_of(arrangement, face);
    if (!sides) return {};
    for (const std::size_t s : {0U, 1U}) {
      const std::vector<Way>&one = (*sides)[s], &other = (*sides)[s + 2];
      if (one.size() != other.size()) return {};
      for (std::size_t i = 0; i < one.size(); ++i)
        classes.join(one[i].piece, other[other.size() - 1 - i].piece);
    }
  }
  std::vector<int> most(wished.size(), 1);
  const auto class_of = [&](std::size_t p) {
    return static_cast<std::size_t>(classes.of(static_cast<int>(p)));
  };
  for (std::size_t p = 0; p < wished.size(); ++p) most[class_of(p)] = std::max(most[class_of(p)], wished[p]);
  std::vector<int> edges;
  for (std::size_t p = 0; p < wished.size(); ++p) edges.push_back(most[class_of(p)]);
  return edges;
}

void fill_blocks(const Arrangement& arrangement, FlatMesh& mesh, bool triangles) {
  for (const Face& face : arrangement.faces) {
    if (face.area < 0) continue;
    const Grid grid(mesh, *sides_of(arrangement, face));
    for (std::size_t j = 0; j < grid.rows(); ++j)
      for (std::size_t i = 0; i < grid.columns(); ++i) {
        const int a = grid.node(i, j), b = grid.node(i + 1, j), c = grid.node(i + 1, j + 1),
                  d = grid.node(i, j + 1);
        if (!triangles) {
          mesh.cells.push_back({{a, b, c, d}, face.area});
        } else if ((i + j) % 2 == 0) {
          mesh.cells.push_back({{a, b, c, -1}, face.area});
          mesh.cells.push_back({{a, c, d, -1}, face.area});
        } else {
          mesh.cells.push_back({{a, b, d, -1}, face.area});
          mesh.cells.push_back({{b, c, d, -1}, face.area});
        }
      }
  }
}

std::vector<Curve> cuts_through(const Arrangement& arrangement) {
  Vector2 low = Vector2::Constant(1e300), high = Vector2::Constant(-1e300);
  std::set<double> xs, ys;
  for (const Piece& piece : arrangement.pieces) {
    const Vector2 d = (piece.curve.b - piece.curve.a).cwiseAbs();
    if (piece.curve.arc || d.minCoeff() > arrangement.tolerance) return {};
    for (const int v : {piece.first, piece.last}) {
      low = low.cwiseMin(arrangement.vertices[v]);
      high = high.cwiseMax(arrangement.vertices[v]);
    }
  }
  for (std::size_t v = 0; v < arrangement.vertices.size(); ++v) {
    const Vector2& x = arrangement.vertices[v];
    if ((x.array() < low.array()).any() || (x.array() > high.array()).any()) continue;
    xs.insert(x.x());
    ys.insert(x.y());
  }
  std::vector<Curve> cuts;
  const auto far = [&](double& last, double value) {
    const bool is = value - last > arrangement.tolerance;
    if (is) last = value;
    return is;
  };
  double last = -1e300;
  for (const double x : xs)
    if (far(last, x)) cuts.push_back(straight({x, low.y()}, {x, high.y()}));
  last = -1e300;
  for (const double y : ys)
    if (far(last, y)) cuts.push_back(straight({low.x(), y}, {high.x(), y}));
  return cuts;
}

}  // namespace sage::section
