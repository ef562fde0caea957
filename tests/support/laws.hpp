// Laws out of the catalogue by code, for tests.
#pragma once

#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "materials/register_materials.hpp"
#include "sage/conformance/law_driver.hpp"

namespace sage::test {

using namespace conformance;

// psi and lbf/in^3: the units of the source chapter.
inline UnitSystem psi_units() {
  return {"in", "lbf", "psi", 14.696, 0.036111};
}
inline const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue c;
    register_materials(c);
    return c;
  }();
  return all;
}

inline LawPtr make_law(int code, const std::vector<double>& values, const UnitSystem& units) {
  return catalogue().materials.find(code)->make(values, units);
}
inline std::unique_ptr<SolidLaw> solid(int code, const std::vector<double>& values,
                                       const UnitSystem& units = kpa_units()) {
  return std::get<std::unique_ptr<SolidLaw>>(make_law(code, values, units));
}
inline std::unique_ptr<InterfaceLaw> interface(int code, const std::vector<double>& values,
                                               const UnitSystem& units = psi_units()) {
  return std::get<std::unique_ptr<InterfaceLaw>>(make_law(code, values, units));
}

}  // namespace sage::test
