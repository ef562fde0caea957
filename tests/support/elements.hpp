// The elements of the tree as cases for tests.
#pragma once

#include <stdexcept>

#include "elements/register_elements.hpp"
#include "sage/conformance/element_cases.hpp"
#include "sage/conformance/sample_laws.hpp"

namespace sage::test {

using namespace conformance;

inline const Catalogue& element_catalogue() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    register_elements(c);
    return c;
  }();
  return catalogue;
}
inline std::vector<ElementCase> element_cases() {
  // Those with pore pressures have two laws and tests of their own.
  std::vector<ElementCase> cases = conformance::element_cases(element_catalogue());
  std::erase_if(cases, [](const ElementCase& one) { return one.entry->has_pores(); });
  return cases;
}
inline std::vector<ElementCase> solid_cases() {
  return of_kind(ElementKind::solid, element_cases());
}
// Those with pairs of nodes, which contact has none of.
inline std::vector<ElementCase> interface_cases() {
  std::vector<ElementCase> cases = of_kind(ElementKind::interface, element_cases());
  std::erase_if(cases, [](const ElementCase& one) { return !one.entry->square(); });
  return cases;
}
// A nonlinear law for any element; refuses components beyond `limit`.
struct AnySmoothLaw {
  explicit AnySmoothLaw(double limit = 1e9) : one(limit), two(limit), three(limit), four(limit), five(limit) {}
  LawRef of(const ElementCase& c) const {
    switch (c.entry->law_size) {
      case 1:
        return static_cast<const Law<1>*>(&one);
      case 2:
        return static_cast<const InterfaceLaw*>(&two);
      case 3:
        return static_cast<const Law<3>*>(&three);
      case 5:
        return static_cast<const Law<5>*>(&five);
      default:
        return static_cast<const SolidLaw*>(&four);
    }
  }
  SmoothLaw<1> one;
  SmoothLaw<2> two;
  SmoothLaw<3> three;
  SmoothLaw<4> four;
  SmoothLaw<5> five;
};
inline ElementCase element_case(int code, int formulation, Geometry geometry) {
  for (const ElementCase& c : element_cases())
    if (c.code == code && c.formulation == formulation && c.geometry == geometry) return c;
  throw std::logic_error("no such element");
}

}  // namespace sage::test
