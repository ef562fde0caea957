// Every element of a catalogue in both geometries, sample shapes for each, and a run of one element.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage::conformance {

struct ElementCase {
  int code = 0, formulation = 0;
  Geometry geometry = Geometry::plane_strain;
  const ElementEntry* entry = nullptr;
  std::string name;

  std::unique_ptr<Element> make() const { return entry->make(geometry, formulation); }
  bool axisymmetric() const { return geometry == Geometry::axisymmetric; }
};

// All formulations in each geometry that they can be in, of the elements with these codes or, where there are none, of all.  The
// catalogue must outlive the answer.
std::vector<ElementCase> element_cases(const Catalogue& catalogue, const std::vector<int>& codes = {});
// Those of one kind.
std::vector<ElementCase> of_kind(ElementKind kind, const std::vector<ElementCase>& cases);

// Nodes of the parent shape, 2 x nodes; for an interface or a structure (xi, 0).
Eigen::Matrix2Xd parent_nodes(const ElementEntry& entry);

// The straight-sided element over these corners: 2 x 4 or 2 x 3; for an interface or a structure the two ends.
Eigen::Matrix2Xd straight_element(const ElementEntry& entry, const Eigen::Matrix2Xd& corners);

// A distorted straight-sided element away from the axis, one that touches it, and one with curved sides.
// (An element without mid-side nodes stays straight.)
Eigen::Matrix2Xd sample_shape(const ElementEntry& entry);
Eigen::Matrix2Xd sample_shape_on_axis(const ElementEntry& entry);
Eigen::Matrix2Xd sample_shape_curved(const ElementEntry& entry);

// One element with its arrays.
struct ElementRun {
  ElementRun(const Element& element, const Eigen::Matrix2Xd& x, LawRef law);

  Outcome evaluate(const Eigen::VectorXd& du, bool want_stiffness = true);
  int history_size() const { return history; }
  double weight(int point) const;
  Eigen::MatrixXd B(int point) const;  // law_size x dofs

  const Element* element;
  LawRef law, second_law;  // second_law: only of elements that have two
  Eigen::Matrix2Xd x;
  const PointContext* contexts = nullptr;  // one a point, if any
  int history = 0;
  std::vector<double> geometry, sigma0, eps0, h0, sigma1, eps1, h1;
  std::vector<PointStatus> status;
  Eigen::VectorXd u0;  // zero unless it is set
  double dt = 0.0;
  std::vector<EdgeTraction> edges;            // of large strain
  const FourPointLaw<4>* four_law = nullptr;  // likewise
  Eigen::MatrixXd K;
  Eigen::VectorXd f;
};

// K = df/du at `du` by central differences of width `step`: the largest difference of a column, relative to
// |K|.  Exact but for rounding where f is of the second degree in du.  Throws std::runtime_error where the
// element refuses a step.
double tangent_error(ElementRun& run, const Eigen::VectorXd& du, double step = 1e-3);

}  // namespace sage::conformance
