#include "sage/draw/sub_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sage {

namespace {

// The integer places of a grid in the parent shape, numbered as they are asked for.
class Places {
 public:
  Places(bool triangle, int along_xi, int along_eta)
      : triangle_(triangle),
        cells_{along_xi, triangle ? along_xi : along_eta},
        index_(static_cast<std::size_t>((cells_[0] + 1) * (cells_[1] + 1)), -1) {}

  int at(int i, int j) {
    int& index = index_[j * (cells_[0] + 1) + i];
    if (index < 0) index = add(parent(i, j));
    return index;
  }
  // The middle of the cell whose lowest place is (i, j).
  int middle(int i, int j) { return add(parent(i + 0.5, j + 0.5)); }
  const std::vector<Vector2>& all() const { return places_; }
  std::array<int, 2> grid_of(const std::array<double, 2>& parent_node) const {
    std::array<int, 2> at{};
    for (std::size_t c = 0; c < 2; ++c)
      at[c] = static_cast<int>(
          std::lround((triangle_ ? parent_node[c] : 0.5 * (parent_node[c] + 1.0)) * cells_[c]));
    return at;
  }

 private:
  Vector2 parent(double i, double j) const {
    const Vector2 part(i / cells_[0], j / cells_[1]);
    return triangle_ ? part : Vector2(2.0 * part.array() - 1.0);
  }
  int add(const Vector2& place) {
    places_.push_back(place);
    return static_cast<int>(places_.size()) - 1;
  }

  bool triangle_;
  std::array<int, 2> cells_;
  std::vector<int> index_;
  std::vector<Vector2> places_;
};

std::vector<int> edge_places(Places& places, const std::array<int, 2>& a, const std::array<int, 2>& b) {
  const int steps = std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1]));
  std::vector<int> edge;
  for (int k = 0; k <= steps; ++k)
    edge.push_back(places.at(a[0] + (b[0] - a[0]) / steps * k, a[1] + (b[1] - a[1]) / steps * k));
  return edge;
}

std::vector<GridCell> square_cells(Places& places, int along_xi, int along_eta) {
  std::vector<GridCell> cells;
  for (int j = 0; j < along_eta; ++j)
    for (int i = 0; i < along_xi; ++i)
      cells.push_back({{places.at(i, j), places.at(i + 1, j), places.at(i + 1, j + 1), places.at(i, j + 1)},
                       places.middle(i, j)});
  return cells;
}

std::vector<GridCell> triangle_cells(Places& places, int along) {
  std::vector<GridCell> cells;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i + j < along; ++i) {
      cells.push_back({{places.at(i, j), places.at(i + 1, j), places.at(i, j + 1)}, -1});
      if (i + j + 1 < along)
        cells.push_back({{places.at(i + 1, j), places.at(i + 1, j + 1), places.at(i, j + 1)}, -1});
    }
  return cells;
}

}  // namespace

SubGrid sub_grid(const Group& group, int along_xi, int along_eta) {
  const Element& element = *group.element;
  const auto& edges = element.edges();
  const std::span<const std::array<double, 2>> nodes = group.entry->parent_nodes;
  const bool triangle = group.entry->triangle();
  Places places(triangle, along_xi, along_eta);
  SubGrid grid;
  for (const std::vector<int>& edge : edges) {
    const auto corner = [&](std::size_t end) { return places.grid_of(nodes[edge[end]]); };
    grid.edges.push_back(edge_places(places, corner(0), corner(1)));
    const std::vector<int>& along = grid.edges.back();
    grid.cells.outline.insert(grid.cells.outline.end(), along.begin(), along.end() - 1);
  }
  grid.cells.cells = triangle ? triangle_cells(places, along_xi) : square_cells(places, along_xi, along_eta);

  const auto count = static_cast<Eigen::Index>(nodes.size());
  std::vector<double> N(nodes.size()), dN(2 * nodes.size());
  grid.N.resize(places.all().size(), count);
  for (std::size_t p = 0; p < places.all().size(); ++p) {
    element.shape_functions(places.all()[p], N, dN);
    grid.N.row(static_cast<Eigen::Index>(p)) = Eigen::Map<const Eigen::RowVectorXd>(N.data(), count);
  }
  return grid;
}

int sub_grid_cells(double length, int degree) {
  constexpr double kCell = 12.0;
  const int least = degree > 1 ? 2 : 1, most = std::min(8 * degree, 32);
  if (!(length > kCell)) return least;
  return static_cast<int>(std::clamp(std::ceil(length / kCell), 1.0 * least, 1.0 * most));
}

}  // namespace sage
