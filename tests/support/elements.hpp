// The elements of the tree as cases for tests.
#pragma once

#include <stdexcept>

#include "elements/register_elements.hpp"
#include "sage/conformance/element_cases.hpp"

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
  return conformance::element_cases(element_catalogue());
}
inline std::vector<ElementCase> solid_cases() {
  return of_kind(ElementKind::solid, element_cases());
}
inline std::vector<ElementCase> interface_cases() {
  return of_kind(ElementKind::interface, element_cases());
}
inline ElementCase element_case(int code, int formulation, Geometry geometry) {
  for (const ElementCase& c : element_cases())
    if (c.code == code && c.formulation == formulation && c.geometry == geometry) return c;
  throw std::logic_error("no such element");
}

}  // namespace sage::test
