#include "sage/core/units.hpp"

#include "sage/core/unit_suffix.hpp"

namespace sage {

std::string unit_text(Dimension dimension, const UnitSystem& units) {
  switch (dimension) {
    case Dimension::none:
      return "-";
    case Dimension::length:
      return units.length;
    case Dimension::angle:
      return "deg";
    case Dimension::force:
      return units.force;
    case Dimension::stress:
      return units.stress;
    case Dimension::stress_per_length:
      return units.stress + "/" + units.length;
    case Dimension::unit_weight:
      return units.force + "/" + units.length + "^3";
    case Dimension::velocity:
      return units.length + "/time";
    case Dimension::discharge:
      return units.length + "^3/time";
    case Dimension::moment:
      return units.force + " " + units.length;
    case Dimension::bending_stiffness:
      return units.force + " " + units.length + "^2";
    case Dimension::volume:
      return units.length + "^3";
  }
  return "-";
}

std::string unit_suffix(const std::string& unit) {
  const bool unknown = unit.find_first_not_of(' ') == std::string::npos || unit.starts_with('-') ||
                       unit.find("/-") != std::string::npos || unit.find(" -") != std::string::npos;
  return unknown ? "" : " [" + unit + "]";
}

}  // namespace sage
