// Catalogue entries of soil with flowing pore water.  docs/theory/consolidation.md
#include "elements/coupled.hpp"

#include <numeric>

#include "elements/pore_field.hpp"
#include "elements/solid_entry.hpp"

namespace sage {

namespace {

template <class Shape>
ElementEntry coupled_shape(ElementEntry entry) {
  entry = with_shape<Shape>(std::move(entry));
  std::vector<int> corners(static_cast<std::size_t>(Shape::corners));
  std::iota(corners.begin(), corners.end(), 0);
  entry.unknowns = {{displacement_field()}, {excess_pressure_field(), corners}};
  entry.side_interface = "interface6";
  return entry;
}

// full_name, flags: of the solid of the same shape and rule.
template <class Shape, class Pressure, class Rule>
Choice coupled(Formulation formulation, std::string_view full_name, SolidFlags flags = {}) {
  formulation.points = static_cast<int>(Rule::points);
  return {std::move(formulation), [full_name, flags](Geometry geometry) -> std::unique_ptr<Element> {
            if (geometry == Geometry::plane_strain)
              return std::make_unique<Coupled<Shape, Pressure, PlaneStrain, Rule>>(
                  full_name, flags.reduced_plane, flags.locks, flags.loses_order);
            return std::make_unique<Coupled<Shape, Pressure, Axisymmetric, Rule>>(
                full_name, flags.reduced_axisymmetric, flags.locks, flags.loses_order);
          }};
}

}  // namespace

ElementEntry quad8p4_entry() {
  return element_entry(
      coupled_shape<Quad8>({.name = "quad8p4",
                            .summary = "consolidation: quad8 with pore pressures at its corners",
                            .against_locking = "reduced integration (formulation 1) does not",
                            .vtk = {23}}),
      {coupled<Quad8, Quad4, GaussSquare<2>>({1, "reduced", "2x2 Gauss"}, "quad8p4 reduced",
                                             {.reduced_plane = true, .reduced_axisymmetric = true}),
       coupled<Quad8, Quad4, GaussSquare<3>>({2, "full", "3x3 Gauss; drained it locks as nu -> 1/2"},
                                             "quad8p4 full", {.locks = true})});
}

ElementEntry quad9p4_entry() {
  return element_entry(
      coupled_shape<Quad9>({.name = "quad9p4",
                            .summary = "consolidation: quad9 with pore pressures at its corners",
                            .vtk = {28}}),
      {coupled<Quad9, Quad4, GaussSquare<3>>({1, "full", "3x3 Gauss; drained it locks as nu -> 1/2"},
                                             "quad9p4 full", {.locks = true})});
}

ElementEntry tri6p3_entry() {
  return element_entry(
      coupled_shape<Tri6>({.name = "tri6p3",
                           .summary = "consolidation: tri6 with pore pressures at its corners",
                           .against_locking = "three points (formulation 1) do not",
                           .vtk = {22}}),
      {coupled<Tri6, Tri3, Triangle3>({1, "three points", "exact on straight sides in plane strain"}, "tri6p3",
                                      {.loses_order = true}),
       coupled<Tri6, Tri3, Triangle6>({2, "six points", "degree 4: exact in rings, and for curved sides"},
                                      "tri6p3 six points", {.locks = true})});
}

}  // namespace sage
