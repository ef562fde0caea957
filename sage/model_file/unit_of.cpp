#include "sage/model_file/unit_of.hpp"

#include <cmath>
#include <numbers>

namespace sage::model_file {

namespace {

struct Named {
  std::string_view name;
  Unit unit;
};

constexpr double kInch = 0.0254, kFoot = 0.3048, kPound = 4.4482216152605, kDay = 86400.0;

constexpr Named kUnits[] = {
    {"m", {1.0, 1}},
    {"mm", {1e-3, 1}},
    {"cm", {1e-2, 1}},
    {"km", {1e3, 1}},
    {"in", {kInch, 1}},
    {"ft", {kFoot, 1}},
    {"N", {1.0, 0, 1}},
    {"kN", {1e3, 0, 1}},
    {"MN", {1e6, 0, 1}},
    {"kgf", {9.80665, 0, 1}},
    {"tf", {9806.65, 0, 1}},
    {"lbf", {kPound, 0, 1}},
    {"lb", {kPound, 0, 1}},
    {"kip", {1e3 * kPound, 0, 1}},
    {"Pa", {1.0, -2, 1}},
    {"kPa", {1e3, -2, 1}},
    {"MPa", {1e6, -2, 1}},
    {"GPa", {1e9, -2, 1}},
    {"bar", {1e5, -2, 1}},
    {"psi", {kPound / (kInch * kInch), -2, 1}},
    {"ksi", {1e3 * kPound / (kInch * kInch), -2, 1}},
    {"psf", {kPound / (kFoot * kFoot), -2, 1}},
    {"ksf", {1e3 * kPound / (kFoot * kFoot), -2, 1}},
    {"s", {1.0, 0, 0, 1}},
    {"min", {60.0, 0, 0, 1}},
    {"h", {3600.0, 0, 0, 1}},
    {"d", {kDay, 0, 0, 1}},
    {"day", {kDay, 0, 0, 1}},
    {"days", {kDay, 0, 0, 1}},
    {"year", {365.25 * kDay, 0, 0, 1}},
    {"years", {365.25 * kDay, 0, 0, 1}},
    {"deg", {std::numbers::pi / 180.0, 0, 0, 0, 1}},
    {"degrees", {std::numbers::pi / 180.0, 0, 0, 0, 1}},
    {"rad", {1.0, 0, 0, 0, 1}},
};

void multiply(Unit& by, const Unit& unit, int power) {
  by.size *= std::pow(unit.size, power);
  by.length += power * unit.length;
  by.force += power * unit.force;
  by.time += power * unit.time;
  by.angle += power * unit.angle;
}

// "m^3" or "m3".
bool take_factor(std::string_view text, int sign, Unit& by) {
  int power = 1;
  if (const char last = text.empty() ? ' ' : text.back(); last >= '1' && last <= '9') {
    power = last - '0';
    text.remove_suffix(1);
    if (!text.empty() && text.back() == '^') text.remove_suffix(1);
  }
  for (const Named& one : kUnits) {
    if (one.name != text) continue;
    multiply(by, one.unit, sign * power);
    return true;
  }
  return false;
}

}  // namespace

std::optional<Unit> unit_of(std::string_view text) {
  Unit unit;
  int sign = 1;
  bool any = false;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find_first_of(" */", at), text.size());
    if (const std::string_view factor = text.substr(at, end - at); !factor.empty()) {
      if (!take_factor(factor, sign, unit)) return std::nullopt;
      any = true;
    }
    if (end < text.size() && text[end] == '/') {
      if (sign < 0) return std::nullopt;
      sign = -1;
    }
    at = end + 1;
  }
  return any ? std::optional(unit) : std::nullopt;
}

}  // namespace sage::model_file
