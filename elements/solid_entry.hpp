// Catalogue entries of solids: what the shape knows of itself, and a Solid in the geometry asked for.
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "elements/entries.hpp"
#include "elements/large_strain.hpp"
#include "elements/solid.hpp"

namespace sage {

// What traits() says.  reduced: fewer independent strains than deformation modes
// (tests/conformance proves each).
struct SolidFlags {
  bool reduced_plane = false;
  bool reduced_axisymmetric = false;
  bool locks = false;
  bool loses_order = false;
};

// Adds to an entry that says the rest what its shape tells.
template <class Shape>
ElementEntry with_shape(ElementEntry entry) {
  entry.kind = ElementKind::solid;
  entry.shape = Shape::corners == 3 ? ParentShape::triangle : ParentShape::square;
  entry.nodes = Shape::nodes;
  entry.corners = Shape::corners;
  entry.law_size = 4;
  if (entry.card_nodes == 0) entry.card_nodes = Shape::nodes;
  entry.parent_nodes.assign(Shape::node_at.begin(), Shape::node_at.end());
  return entry;
}

template <class Shape, class Rule, AssumedStrain strain = AssumedStrain::none>
auto solid_maker(std::string_view name, SolidFlags flags = {}) {
  return [name, flags](Geometry geometry) -> std::unique_ptr<Element> {
    if (geometry == Geometry::plane_strain)
      return std::make_unique<Solid<Shape, PlaneStrain, Rule, strain>>(name, flags.reduced_plane, flags.locks,
                                                                       flags.loses_order);
    return std::make_unique<Solid<Shape, Axisymmetric, Rule, strain>>(name, flags.reduced_axisymmetric,
                                                                      flags.locks, flags.loses_order);
  };
}

// Large strain: elements of few nodes whose strain is that of their displacements.
template <class Shape, class Rule, AssumedStrain strain>
std::function<std::unique_ptr<Element>(Geometry)> large_strain_maker(std::string_view name, SolidFlags flags) {
  constexpr int kMostNodes = 15;
  if constexpr (strain == AssumedStrain::enhanced || Shape::nodes > kMostNodes)
    return {};
  else
    return [name, flags](Geometry geometry) -> std::unique_ptr<Element> {
      if (geometry == Geometry::plane_strain)
        return std::make_unique<LargeStrain<Shape, PlaneStrain, Rule, strain>>(name, flags.reduced_plane,
                                                                               flags.locks, flags.loses_order);
      return std::make_unique<LargeStrain<Shape, Axisymmetric, Rule, strain>>(name, flags.reduced_axisymmetric,
                                                                              flags.locks, flags.loses_order);
    };
}

// One formulation of a solid.  full_name: what its traits say.
template <class Shape, class Rule, AssumedStrain strain = AssumedStrain::none>
Choice solid(Formulation formulation, std::string_view full_name, SolidFlags flags = {}) {
  formulation.points = static_cast<int>(Rule::points);
  formulation.plain = strain == AssumedStrain::none;
  return {std::move(formulation), solid_maker<Shape, Rule, strain>(full_name, flags),
          large_strain_maker<Shape, Rule, strain>(full_name, flags)};
}

}  // namespace sage
