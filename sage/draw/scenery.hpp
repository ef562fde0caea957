// A model's state laid out on the paper: what pictures are drawn from.
#pragma once

#include <cmath>
#include <map>
#include <tuple>

#include "sage/draw/contour.hpp"
#include "sage/draw/picture.hpp"
#include "sage/draw/picture_field.hpp"
#include "sage/draw/sub_grid.hpp"
#include "sage/record/nodal_values.hpp"

namespace sage {

inline constexpr double kPictureLeft = 70.0, kPictureTop = 108.0;  // of the frame, for axis and heading
inline constexpr std::size_t kMostElements = 6000;  // whose edges are drawn, and which are drawn one by one
inline constexpr double kDiagramShare = 0.1;        // of the frame's longer side, that the largest force has

// Where the deformed mesh stands on the paper.
struct View {
  Vector2 low = Vector2::Zero(), high = Vector2::Zero();  // of the deformed and the undeformed mesh
  double scale = 1.0;                                     // screen units a unit of length
  double deformation = 0.0;
  double largest = 0.0;   // displacement
  bool rounding = false;  // displacements are nothing but that: neither the mesh nor arrows show them
  bool mirror_left = false, mirror_down = false;
  double height = 0.0;              // of the frame
  double left = 0.0, bottom = 0.0;  // sides of the mesh: low, but for the other halves of a symmetric model

  // On a line of symmetry that the picture is reflected about.
  bool on_seam(const Vector2& x) const {
    const double near = 1e-6 * (high - low).maxCoeff();
    return (mirror_left && std::abs(x.x() - left) < near) || (mirror_down && std::abs(x.y() - bottom) < near);
  }
  Vector2 at(const Vector2& x) const {
    return {kPictureLeft + scale * (x.x() - low.x()), kPictureTop + scale * (high.y() - x.y())};
  }
};

// Everything that a picture is drawn from.
struct Scenery {
  const Model& model;
  const Solution& solution;
  NodalLayout layout;
  View view;
  FieldTable table;  // that the field is of
  FieldChoice field;
  FieldParts parts;
  std::map<std::tuple<const Element*, int, int>, SubGrid> grids = {};  // patches point into them
  std::map<std::size_t, CellGrid> tiny = {};                           // by corners; patches point into them

  bool draws(std::size_t g, ElementKind kind) const {
    return !layout.of_group[g].empty() && drawn_as(model.groups[g]) == kind;
  }
  Vector2 moved(int node, double deformation) const {
    return view.at(model.mesh.x.col(node) + deformation * solution.u->segment<2>(DofMap::displacement(node)));
  }
  // On the paper: one column a node of the element.
  Eigen::Matrix2Xd nodes_of(const Group& group, int e, double deformation) const {
    Eigen::Matrix2Xd at(2, static_cast<Eigen::Index>(group.node_count()));
    for (Eigen::Index i = 0; i < at.cols(); ++i) at.col(i) = moved(group.nodes_of(e)[i], deformation);
    return at;
  }
};

Scenery make_scenery(const Model& model, const Solution& solution, std::string_view field,
                     const PictureOptions& options);

// The grid that an element of this size on the paper is drawn on.
const SubGrid& grid_for(Scenery& scenery, const Group& group, const Eigen::Matrix2Xd& nodes);

// Of all solids that are active.
std::vector<Patch> patches(Scenery& scenery);

}  // namespace sage
