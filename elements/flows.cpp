// Catalogue entries of the elements that water flows through.  docs/theory/seepage.md
#include "elements/flow.hpp"
#include "elements/solid_entry.hpp"

namespace sage {

namespace {

UnknownField head_field() {
  return {
      .name = "head", .dimension = Dimension::length, .load = "inflow", .load_dimension = Dimension::discharge};
}

template <class Shape>
ElementEntry flow_shape(ElementEntry entry) {
  entry = with_shape<Shape>(std::move(entry));
  entry.kind = ElementKind::flow;
  entry.law_size = 3;
  entry.unknowns = {{head_field()}};
  return entry;
}

template <class Shape, class Rule>
Choice flow(Formulation formulation, std::string_view full_name) {
  formulation.points = static_cast<int>(Rule::points);
  return {std::move(formulation), [full_name](Geometry geometry) -> std::unique_ptr<Element> {
            if (geometry == Geometry::plane_strain)
              return std::make_unique<Flow<Shape, PlaneStrain, Rule>>(full_name);
            return std::make_unique<Flow<Shape, Axisymmetric, Rule>>(full_name);
          }};
}

}  // namespace

ElementEntry flow_quad4_entry() {
  return element_entry(flow_shape<Quad4>({.name = "flow_quad4",
                                          .summary = "steady flow, four-node quadrilateral",
                                          .folded = "flow_tri3",
                                          .vtk = {9}}),
                       {flow<Quad4, GaussSquare<2>>({1, "full", "2x2 Gauss"}, "flow quad4")});
}

ElementEntry flow_quad8_entry() {
  return element_entry(
      flow_shape<Quad8>(
          {.name = "flow_quad8", .summary = "steady flow, eight-node quadrilateral", .vtk = {23}}),
      {flow<Quad8, GaussSquare<3>>({1, "full", "3x3 Gauss"}, "flow quad8")});
}

ElementEntry flow_quad9_entry() {
  return element_entry(
      flow_shape<Quad9>({.name = "flow_quad9", .summary = "steady flow, nine-node quadrilateral", .vtk = {28}}),
      {flow<Quad9, GaussSquare<3>>({1, "full", "3x3 Gauss"}, "flow quad9")});
}

ElementEntry flow_tri3_entry() {
  return element_entry(
      flow_shape<Tri3>({.name = "flow_tri3", .summary = "steady flow, three-node triangle", .vtk = {5}}),
      {flow<Tri3, Triangle1>({1, "one point", "exact"}, "flow tri3")});
}

ElementEntry flow_tri6_entry() {
  return element_entry(
      flow_shape<Tri6>({.name = "flow_tri6", .summary = "steady flow, six-node triangle", .vtk = {22}}),
      {flow<Tri6, Triangle3>({1, "three points", "exact on straight sides in plane strain"}, "flow tri6"),
       flow<Tri6, Triangle6>({2, "six points", "degree 4: exact in rings, and for curved sides"},
                             "flow tri6 six points")});
}

}  // namespace sage
