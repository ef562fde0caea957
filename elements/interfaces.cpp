// Catalogue entries of the interfaces.
#include "elements/entries.hpp"
#include "elements/interface.hpp"

namespace sage {

namespace {

template <class Line>
auto interface(std::string_view name, InterfaceRule rule) {
  return [name, rule](Geometry geometry) -> std::unique_ptr<Element> {
    if (geometry == Geometry::plane_strain) return std::make_unique<Interface<Line, PlaneStrain>>(name, rule);
    return std::make_unique<Interface<Line, Axisymmetric>>(name, rule);
  };
}

}  // namespace

ElementEntry interface4_entry() {
  return element_entry(
      "interface4", "zero-thickness interface of two node pairs, between four-node elements", 4, 4, 2,
      {{{1, "row-sum",
         "points at the pairs, weight integral N dA with r inside: no oscillation, no free pair at r = 0"},
        interface<Line2>("interface4 row-sum", InterfaceRule::row_sum)},
       {{2, "Gauss", "two points"}, interface<Line2>("interface4 Gauss", InterfaceRule::gauss)},
       {{3, "Newton-Cotes", "trapezoid; a pair at r = 0 has no stiffness"},
        interface<Line2>("interface4 Newton-Cotes", InterfaceRule::newton_cotes)}});
}

ElementEntry interface6_entry() {
  return element_entry(
      "interface6", "zero-thickness interface of three node pairs, between eight-node elements", 6, 4, 2,
      {{{1, "row-sum", "points at the pairs, weight integral N dA with r inside; three Gauss points at r = 0"},
        interface<Line3>("interface6 row-sum", InterfaceRule::row_sum)},
       {{2, "Gauss", "three points"}, interface<Line3>("interface6 Gauss", InterfaceRule::gauss)},
       {{3, "Newton-Cotes", "Simpson; a pair at r = 0 has no stiffness"},
        interface<Line3>("interface6 Newton-Cotes", InterfaceRule::newton_cotes)}});
}

}  // namespace sage
