// Catalogue entries of the interfaces.
#include <utility>

#include "elements/coupled_interface.hpp"
#include "elements/entries.hpp"
#include "elements/interface.hpp"
#include "elements/pore_field.hpp"

namespace sage {

namespace {

template <class Line>
Choice interface(Formulation formulation, std::string_view full_name, InterfaceRule rule) {
  formulation.points = Line::nodes;
  return {std::move(formulation), [full_name, rule](Geometry geometry) -> std::unique_ptr<Element> {
            if (geometry == Geometry::plane_strain)
              return std::make_unique<Interface<Line, PlaneStrain>>(full_name, rule);
            return std::make_unique<Interface<Line, Axisymmetric>>(full_name, rule);
          }};
}

Choice coupled_interface(Formulation formulation, std::string_view full_name, InterfaceRule rule) {
  formulation.points = 3;
  return {std::move(formulation), [full_name, rule](Geometry geometry) -> std::unique_ptr<Element> {
            if (geometry == Geometry::plane_strain)
              return std::make_unique<CoupledInterface<PlaneStrain>>(full_name, rule);
            return std::make_unique<CoupledInterface<Axisymmetric>>(full_name, rule);
          }};
}

// Both sides of one line: the bottom's nodes, then the top's back, then the mid-side nodes of both.
template <class Line>
ElementEntry with_line(ElementEntry entry) {
  static constexpr std::array<std::array<double, 2>, 6> kNodes{
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {0, 1}}};
  entry.kind = ElementKind::interface;
  entry.shape = ParentShape::square;
  entry.nodes = entry.card_nodes = 2 * Line::nodes;
  entry.corners = 4;
  entry.law_size = 2;
  entry.parent_nodes.assign(kNodes.begin(), kNodes.begin() + entry.nodes);
  // As the line of its bottom side: an area of zero thickness is invisible.
  static const ForeignElement<int> kLines[]{{3, {0, 1}}, {21, {0, 1, 4}}};
  entry.vtk = kLines[Line::nodes - 2];
  return entry;
}

}  // namespace

ElementEntry interface4_entry() {
  return element_entry(
      with_line<Line2>({.name = "interface4",
                        .summary = "zero-thickness interface of two node pairs, between four-node elements"}),
      {interface<Line2>(
           {1, "row-sum",
            "points at the pairs, weight integral N dA with r inside: no oscillation, no free pair "
            "at r = 0"},
           "interface4 row-sum", InterfaceRule::row_sum),
       interface<Line2>({2, "Gauss", "two points"}, "interface4 Gauss", InterfaceRule::gauss),
       interface<Line2>({3, "Newton-Cotes", "trapezoid; a pair at r = 0 has no stiffness"},
                        "interface4 Newton-Cotes", InterfaceRule::newton_cotes)});
}

ElementEntry interface6_entry() {
  return element_entry(
      with_line<Line3>(
          {.name = "interface6",
           .summary = "zero-thickness interface of three node pairs, between eight-node elements"}),
      {interface<Line3>(
           {1, "row-sum",
            "points at the pairs, weight integral N dA with r inside; three Gauss points at r = 0"},
           "interface6 row-sum", InterfaceRule::row_sum),
       interface<Line3>({2, "Gauss", "three points"}, "interface6 Gauss", InterfaceRule::gauss),
       interface<Line3>({3, "Newton-Cotes", "Simpson; a pair at r = 0 has no stiffness"},
                        "interface6 Newton-Cotes", InterfaceRule::newton_cotes)});
}

ElementEntry interface6p4_entry() {
  ElementEntry entry = with_line<Line3>(
      {.name = "interface6p4",
       .summary = "consolidation: interface6 with pore pressures on both sides, tight, leaking or open"});
  entry.unknowns = {{displacement_field()}, {excess_pressure_field(), {0, 1, 2, 3}}};
  return element_entry(
      std::move(entry),
      {coupled_interface(
           {1, "row-sum",
            "points at the pairs, weight integral N dA with r inside; three Gauss points at r = 0"},
           "interface6p4 row-sum", InterfaceRule::row_sum),
       coupled_interface({2, "Gauss", "three points"}, "interface6p4 Gauss", InterfaceRule::gauss)});
}

}  // namespace sage
