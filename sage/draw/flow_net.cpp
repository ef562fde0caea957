#include "sage/draw/flow_net.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sage/analysis/free_surface.hpp"
#include "sage/analysis/stream_function.hpp"
#include "sage/draw/svg.hpp"

namespace sage {

namespace {

constexpr const char *kHeadColour = "#ffffff", *kStreamColour = "#000000", *kSurfaceColour = "#d7191c";

// Elements that water flows through, with a number of their nodes; also those that lie on solids.  Not those that are
// dry: `wet` (of all nodes) is negative at each of their nodes.
std::vector<Patch> flow_patches(Scenery& scenery, const Eigen::VectorXd& at_node,
                                const Eigen::VectorXd* wet = nullptr) {
  std::vector<Patch> result;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    const Group& group = scenery.model.groups[g];
    if (!group.flow() || scenery.solution.activity->group[g] == 0) continue;
    Eigen::RowVectorXd values(static_cast<Eigen::Index>(group.node_count()));
    for (int e = 0; e < group.elements(); ++e) {
      const int* own = group.nodes_of(e);
      if (wet != nullptr &&
          std::all_of(own, own + group.node_count(), [&](int node) { return (*wet)[node] < 0.0; }))
        continue;
      for (Eigen::Index i = 0; i < values.cols(); ++i) values[i] = at_node[group.nodes_of(e)[i]];
      const Eigen::Matrix2Xd nodes = scenery.nodes_of(group, e, scenery.view.deformation);
      const SubGrid& grid = grid_for(scenery, group, nodes);
      const Eigen::Matrix2Xd places = nodes * grid.N.transpose();
      const Eigen::RowVectorXd at = values * grid.N.transpose();
      Patch& patch = result.emplace_back(Patch{&grid.cells, {}});
      for (Eigen::Index p = 0; p < places.cols(); ++p) patch.places.push_back({places.col(p), at[p]});
    }
  }
  return result;
}

void draw_lines(std::string& out, const std::vector<Patch>& patches, const std::vector<double>& limits,
                const char* colour, double width) {
  for (const std::string& path : line_paths(patches, limits))
    if (!path.empty())
      fmt::format_to(std::back_inserter(out),
                     "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" d=\"{}\"/>\n", colour, width, path);
}

// Between 0 and the largest, not at these ends.
std::vector<double> steps(double low, double high, double step) {
  std::vector<double> list;
  const double slack = 1e-6 * step;
  for (int i = 1; low + i * step < high - slack; ++i) list.push_back(low + i * step);
  return list;
}

// A tube of this flow has squares of head lines and stream lines; 0 where there is no such: rings, soil of several
// permeabilities or with two of them.
double square_tube(const Model& model, double drop) {
  if (model.geometry != Geometry::plane_strain) return 0.0;
  double k = 0.0;
  for (const Group& group : model.groups) {
    if (!group.flow()) continue;
    const std::vector<double>& own = model.material_of(group).parameters;
    const bool isotropic = !own.empty() && (own.size() < 2 || own[1] == 0.0 || own[1] == own[0]);
    if (!isotropic || (k != 0.0 && k != own[0])) return 0.0;
    k = own[0];
  }
  return k * drop;
}

}  // namespace

std::string draw_flow_net(std::string& out, Scenery& scenery, int drops) {
  constexpr int kMostTubes = 200;
  const Model& model = scenery.model;
  const Solution& solution = scenery.solution;
  const int field = find_unknown(model.unknowns, "head");
  Eigen::VectorXd head = Eigen::VectorXd::Constant(model.mesh.nodes(), NAN), pressure = head;
  double low = INFINITY, high = -INFINITY;
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const int dof = solution.activity->dof_map.of(node, field);
    if (dof < 0) continue;
    head[node] = (*solution.u)[dof];
    pressure[node] = head[node] - model.mesh.x(1, node);
  }
  const bool surface = std::ranges::any_of(solution.groups(), has_free_surface);
  const Eigen::VectorXd* const wet = surface ? &pressure : nullptr;
  const std::vector<Patch> heads = flow_patches(scenery, head, wet);
  for (const Patch& patch : heads)
    for (const Corner& c : patch.places) {
      low = std::min(low, c.value);
      high = std::max(high, c.value);
    }
  if (!(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)))) return "no head is lost: no flow net";
  const StreamFunction& stream = stream_function(model, solution);
  const double drop = (high - low) / drops;
  double tube = square_tube(model, drop);
  const bool squares = tube > 0.0 && stream.largest / tube > 1.0 && stream.largest / tube < kMostTubes;
  if (!squares) tube = stream.largest / drops;
  draw_lines(out, heads, steps(low, high, drop), kHeadColour, 1.2);
  if (stream.largest > 0.0)
    draw_lines(out, flow_patches(scenery, stream.at_node, wet), steps(0.0, stream.largest, tube), kStreamColour,
               1.0);
  std::string note = fmt::format(
      "flow net: white lines of equal head, {} drops of {:.4g} {}; black stream lines, {:.4g} {} "
      "between two{} ({:.4g} in all)",
      drops, drop, unit_text(Dimension::length, model.units), tube,
      unit_text(Dimension::discharge, model.units), squares ? ", squares" : "", stream.largest);
  if (surface) {
    draw_lines(out, flow_patches(scenery, pressure, wet), {0.0}, kSurfaceColour, 2.2);
    note += "; red: the free surface, pressure 0";
  }
  if (stream.jump > StreamFunction::kLeastJump)
    note += "; stream lines jump along a line from what is put in or taken out inside";
  return note;
}

}  // namespace sage
