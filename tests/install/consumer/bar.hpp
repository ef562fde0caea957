// A structure of one's own: the two-node bar and its elastic law.  This is the example of elements/README.md for
// elements that are no solids.
#pragma once

#include <array>

#include "elements/point_kernel.hpp"
#include "materials/parameters.hpp"
#include "sage/core/catalogue.hpp"

namespace own {

// N = E A eps; per unit thickness in plane strain, of all bars around the circle in axisymmetry.
class Rod final : public sage::Law<1> {
 public:
  explicit Rod(const sage::Parameters& p) : EA_(p.positive("youngs_modulus") * p.positive("area")) {}
  sage::LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  sage::Outcome update(const sage::PointIn<1>& in, sage::PointOut<1>& out) const override {
    out.sigma = in.sigma0 + EA_ * in.deps;
    out.D(0, 0) = EA_;
    out.status = sage::PointStatus::elastic;
    return sage::Outcome::ok;
  }

 private:
  double EA_;
};

inline sage::MaterialEntry rod() {
  using sage::Dimension;
  static const std::vector<sage::Parameter> rows = {
      sage::required("youngs_modulus", Dimension::stress, "E"),
      sage::required("area", Dimension::none, "A, of the section")};
  return {"rod", "elastic bar", 1, rows,
          [](std::span<const double> values, const sage::UnitSystem& units) -> sage::LawPtr {
            return std::make_unique<Rod>(sage::Parameters(rows, values, units));
          }};
}

// One point in the middle: the kernel sums w B^T N with w = L, eps = t . (u_2 - u_1) / L.
class Bar2 final : public sage::PointElement<1, 4, 1> {
 public:
  explicit Bar2(sage::Geometry geometry)
      : PointElement(
            {.name = "own_bar2", .geometry = geometry, .nodes = 2, .dofs = 4, .points = 1, .law_size = 1}) {}

  void geometry(const sage::NodeCoordinates& x, std::span<double> out) const override {
    if (traits().geometry == sage::Geometry::axisymmetric && x.row(0).minCoeff() < 0.0)
      throw sage::ElementShapeError("the bar has a node on negative radius; the axis of symmetry is r = 0");
    const sage::Vector2 along = x.col(1) - x.col(0);
    const double L = along.norm();
    if (!(L > 0.0)) throw sage::ElementShapeError("the bar has no length");
    const sage::Vector2 b = along / (L * L);
    const std::array<double, 5> all{L, -b.x(), -b.y(), b.x(), b.y()};
    std::copy(all.begin(), all.end(), out.begin());
  }
  sage::Vector2 position(const sage::NodeCoordinates& x, int /*point*/) const override {
    return 0.5 * (x.col(0) + x.col(1));
  }
  std::span<const double> point_to_node(const sage::NodeCoordinates& /*x*/) const override {
    static constexpr std::array<double, 2> same{1.0, 1.0};
    return same;
  }
};

inline sage::ElementEntry bar2() {
  sage::ElementEntry entry{.name = "own_bar2", .summary = "two-node bar"};
  entry.kind = sage::ElementKind::structure;
  entry.shape = sage::ParentShape::line;
  entry.nodes = entry.corners = entry.card_nodes = 2;
  entry.law_size = 1;
  entry.parent_nodes = {{-1.0, 0.0}, {1.0, 0.0}};
  entry.vtk = {3, {}};
  entry.formulations = {{1, "one point", "exact for a straight bar", 1}};
  entry.make = [](sage::Geometry geometry, int formulation) -> std::unique_ptr<sage::Element> {
    if (formulation > 1) throw sage::ParameterError(-1, "an own_bar2 has no such formulation");
    return std::make_unique<Bar2>(geometry);
  };
  return entry;
}

}  // namespace own
