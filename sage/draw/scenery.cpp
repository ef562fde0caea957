#include "sage/draw/scenery.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/draw/diagram.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

namespace {

constexpr double kRight = 130.0, kMostHeight = 620.0;  // beside the frame; of the frame

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (double factor : {5.0, 2.0})
    if (factor * power <= value) return factor * power;
  return power;
}

// diagrams: room for them around the mesh.
View make_view(const Model& model, const Solution& s, const NodalLayout& layout, const PictureOptions& options,
               bool diagrams) {
  View view;
  if (layout.node.empty()) return view;
  constexpr double kRounding = rounding::kRun;  // of the mesh's size
  view.low = view.high = model.mesh.x.col(layout.node.front());
  double& largest = view.largest;
  for (int node : layout.node) {
    view.low = view.low.cwiseMin(model.mesh.x.col(node));
    view.high = view.high.cwiseMax(model.mesh.x.col(node));
    largest = std::max(largest, s.u->segment<2>(DofMap::displacement(node)).norm());
  }
  const double size = (view.high - view.low).maxCoeff();
  view.left = view.low.x();
  view.bottom = view.low.y();
  view.mirror_left = options.mirror_left;
  view.mirror_down = options.mirror_down;
  view.rounding = largest > 0.0 && largest < kRounding * size;
  if (options.deformed && largest > 0.0 && !view.rounding)
    view.deformation = options.scale > 0.0 ? options.scale : std::max(1.0, round_down(0.05 * size / largest));
  for (int node : layout.node) {
    const Vector2 x = model.mesh.x.col(node) + view.deformation * s.u->segment<2>(DofMap::displacement(node));
    view.low = view.low.cwiseMin(x);
    view.high = view.high.cwiseMax(x);
  }
  if (diagrams) {
    constexpr double kRoom = 0.16;
    view.low.array() -= kRoom * size;
    view.high.array() += kRoom * size;
  }
  if (options.mirror_left) view.low.x() = 2.0 * view.left - view.high.x();
  if (options.mirror_down) view.low.y() = 2.0 * view.bottom - view.high.y();
  const Vector2 room = (view.high - view.low).cwiseMax(1e-6 * size);
  view.scale = std::min((options.width - kPictureLeft - kRight) / room.x(), kMostHeight / room.y());
  if (options.paper > 0.0) view.scale = options.paper;
  view.height = std::max(view.scale * room.y(), 60.0);
  return view;
}

}  // namespace

Scenery make_scenery(const Model& model, const Solution& solution, std::string_view field,
                     const PictureOptions& options) {
  Scenery scenery{model, solution, nodal_layout(model, *solution.activity), {}, fields_of(model), {}, {}};
  scenery.field = picture_field(scenery.table, field);
  scenery.view = make_view(model, solution, scenery.layout, options, diagram_of(field) >= 0);
  scenery.parts = field_parts(model, solution, scenery.layout, *scenery.field.entry, options.rule);
  if (scenery.view.rounding && std::holds_alternative<DisplacementField>(scenery.field.entry->value))
    scenery.parts.at.setZero();
  return scenery;
}

const SubGrid& grid_for(Scenery& scenery, const Group& group, const Eigen::Matrix2Xd& nodes) {
  const Element& element = *group.element;
  std::array<double, 2> longest{};  // of the sides along xi and along eta
  const bool triangle = group.entry->triangle();
  const auto& parents = group.entry->parent_nodes;
  for (const std::vector<int>& edge : element.edges()) {
    const auto &a = parents[edge[0]], &b = parents[edge[1]];
    double& side = longest[triangle || a[1] == b[1] ? 0 : 1];
    side = std::max(side, (nodes.col(edge[0]) - nodes.col(edge[1])).norm());
  }
  const int degree = element.traits().degree;
  const int xi = sub_grid_cells(longest[0], degree), eta = triangle ? xi : sub_grid_cells(longest[1], degree);
  const auto [at, added] = scenery.grids.try_emplace({&element, xi, eta});
  if (added) at->second = sub_grid(group, xi, eta);
  return at->second;
}

namespace {

// A mean of directions is none: an element has the one of its mean stress or strain.
void set_directions(const Scenery& scenery, std::size_t g, std::vector<Patch>& all) {
  const FieldEntry& entry = *scenery.field.entry;
  const std::vector<double> values =
      element_average(scenery.model.mesh, scenery.solution.groups()[g], {&entry});
  const auto elements = static_cast<std::size_t>(scenery.model.groups[g].elements());
  for (std::size_t e = 0; e < elements; ++e)
    for (Corner& corner : all[all.size() - elements + e].places)
      corner.value = chosen(scenery.field, values.data() + e * entry.size());
}

// The corners alone, and no place within.
const CellGrid& tiny_grid(Scenery& scenery, std::size_t corners) {
  const auto [at, added] = scenery.tiny.try_emplace(corners);
  if (added)
    for (int i = 0; i < static_cast<int>(corners); ++i) {
      at->second.outline.push_back(i);
      if (i >= 2) at->second.cells.push_back({{0, i - 1, i}, -1});
    }
  return at->second;
}

// Of a mesh of many elements: one that the eye does not see.
bool is_tiny(const Element& element, const Eigen::Matrix2Xd& nodes) {
  constexpr double kTiny = 2.5;  // px
  return std::ranges::all_of(element.edges(), [&](const std::vector<int>& edge) {
    return (nodes.col(edge[0]) - nodes.col(edge[1])).squaredNorm() < kTiny * kTiny;
  });
}

// numbers: at the entries of the layout.
Patch tiny_patch(Scenery& scenery, const Group& group, int e, const int* entry, const Eigen::Matrix2Xd& nodes,
                 const std::vector<double>& numbers) {
  const auto& edges = group.element->edges();
  Patch patch{&tiny_grid(scenery, edges.size()), {}};
  patch.places.reserve(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const int corner = edges[k][0];
    patch.places.push_back({nodes.col(corner), numbers[entry[corner]]});
    patch.nodes[k] = group.nodes_of(e)[corner];
  }
  return patch;
}

// The field at the layout's entries, where there are many elements.
std::vector<double> numbers_of_many(const Scenery& scenery) {
  std::size_t elements = 0;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g)
    if (scenery.draws(g, ElementKind::solid))
      elements += static_cast<std::size_t>(scenery.model.groups[g].elements());
  std::vector<double> numbers;
  if (elements <= kMostElements) return numbers;
  numbers.reserve(scenery.layout.node.size());
  for (Eigen::Index i = 0; i < scenery.parts.at.cols(); ++i)
    numbers.push_back(field_number(scenery.field, scenery.parts, scenery.parts.at.col(i).data()));
  return numbers;
}

}  // namespace

std::vector<Patch> patches(Scenery& scenery) {
  std::vector<Patch> result;
  const std::vector<double> numbers = numbers_of_many(scenery);
  Eigen::MatrixXd at_nodes, parts;
  Eigen::Matrix2Xd places;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    if (!scenery.draws(g, ElementKind::solid)) continue;
    const Group& group = scenery.model.groups[g];
    const int* entry = scenery.layout.of_group[g].data();
    result.reserve(result.size() + static_cast<std::size_t>(group.elements()));
    at_nodes.resize(scenery.parts.components, static_cast<Eigen::Index>(group.node_count()));
    for (int e = 0; e < group.elements(); ++e, entry += group.node_count()) {
      const Eigen::Matrix2Xd nodes = scenery.nodes_of(group, e, scenery.view.deformation);
      if (!numbers.empty() && is_tiny(*group.element, nodes)) {
        result.push_back(tiny_patch(scenery, group, e, entry, nodes, numbers));
        continue;
      }
      for (Eigen::Index i = 0; i < at_nodes.cols(); ++i) at_nodes.col(i) = scenery.parts.at.col(entry[i]);
      const SubGrid& grid = grid_for(scenery, group, nodes);
      places.noalias() = nodes * grid.N.transpose();
      parts.noalias() = at_nodes * grid.N.transpose();
      Patch& patch = result.emplace_back(Patch{&grid.cells, {}});
      patch.places.reserve(places.cols());
      for (Eigen::Index p = 0; p < places.cols(); ++p)
        patch.places.push_back(
            {places.col(p), field_number(scenery.field, scenery.parts, parts.col(p).data())});
    }
    if (scenery.field.entry->of_mean) set_directions(scenery, g, result);
  }
  std::vector<double*> values;
  if (scenery.field.entry->of_mean)
    for (Patch& patch : result)
      for (Corner& corner : patch.places) values.push_back(&corner.value);
  unfold_angles(*scenery.field.entry, std::move(values));
  return result;
}

}  // namespace sage
