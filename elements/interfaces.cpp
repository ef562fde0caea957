// Catalogue entries of the interfaces.
#include <utility>

#include "elements/contact.hpp"
#include "elements/coupled_interface.hpp"
#include "elements/entries.hpp"
#include "elements/interface.hpp"
#include "elements/large_interface.hpp"
#include "elements/pore_field.hpp"

namespace sage {

namespace {

template <template <class, class> class Kind, class Line>
std::unique_ptr<Element> make_interface(Geometry geometry, std::string_view full_name, InterfaceRule rule) {
  if (geometry == Geometry::plane_strain) return std::make_unique<Kind<Line, PlaneStrain>>(full_name, rule);
  return std::make_unique<Kind<Line, Axisymmetric>>(full_name, rule);
}

template <class Line>
Choice interface(Formulation formulation, std::string_view full_name, InterfaceRule rule) {
  formulation.points = Line::nodes;
  Choice choice{std::move(formulation), [full_name, rule](Geometry geometry) {
                  return make_interface<Interface, Line>(geometry, full_name, rule);
                }};
  if (rule != InterfaceRule::row_sum)  // its weights would need the derivatives of integrals
    choice.make_large = [full_name, rule](Geometry geometry) {
      return make_interface<LargeInterface, Line>(geometry, full_name, rule);
    };
  return choice;
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

// An edge, then the line that it may touch.  A shape of its own: what pairs nodes of interfaces leaves it alone.
template <class Line>
ElementEntry contact_entry(std::string name, std::string_view full_name, std::string summary) {
  ElementEntry entry{.name = std::move(name), .summary = std::move(summary)};
  entry.kind = ElementKind::interface;
  entry.shape = ParentShape::line;
  entry.nodes = entry.card_nodes = entry.corners = Line::nodes + 2;  // no node of a card is made
  entry.law_size = 2;
  for (const double xi : Line::node_xi) entry.parent_nodes.push_back({xi, 0.0});
  entry.parent_nodes.push_back({1.0, 0.0});
  entry.parent_nodes.push_back({-1.0, 0.0});
  static const ForeignElement<int> kLines[]{{3, {0, 1}}, {21, {0, 1, 2}}};
  entry.vtk = kLines[Line::nodes - 2];
  const auto make = [full_name](Geometry geometry) -> std::unique_ptr<Element> {
    if (geometry == Geometry::plane_strain) return std::make_unique<Contact<Line, PlaneStrain>>(full_name);
    return std::make_unique<Contact<Line, Axisymmetric>>(full_name);
  };
  return element_entry(std::move(entry),
                       {{{1, "Gauss", "Gauss points of the moved edge", Line::nodes}, make, make}});
}

}  // namespace

ElementEntry contact4_entry() {
  return contact_entry<Line2>("contact4", "contact4 Gauss",
                              "large strain: edge of two nodes that may touch a rigid line of two nodes");
}

ElementEntry contact5_entry() {
  return contact_entry<Line3>("contact5", "contact5 Gauss",
                              "large strain: edge of three nodes that may touch a rigid line of two nodes");
}

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
