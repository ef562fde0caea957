// Makes one Solid in the geometry asked for.
#pragma once

#include <memory>
#include <string_view>

#include "elements/solid.hpp"

namespace sage {

// What traits() says.  reduced: fewer independent strains than deformation modes (tests/conformance proves
// each).
struct SolidFlags {
  bool reduced_plane = false;
  bool reduced_axisymmetric = false;
  bool locks = false;
  bool loses_order = false;
};

template <class Shape, class Rule, Volumetric volumetric = Volumetric::pointwise>
auto solid(std::string_view name, SolidFlags flags = {}) {
  return [name, flags](Geometry geometry) -> std::unique_ptr<Element> {
    if (geometry == Geometry::plane_strain)
      return std::make_unique<Solid<Shape, PlaneStrain, Rule, volumetric>>(name, flags.reduced_plane,
                                                                           flags.locks, flags.loses_order);
    return std::make_unique<Solid<Shape, Axisymmetric, Rule, volumetric>>(name, flags.reduced_axisymmetric,
                                                                          flags.locks, flags.loses_order);
  };
}

}  // namespace sage
