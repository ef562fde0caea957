#include "sage/core/short_names.hpp"

namespace sage {

namespace {

struct ShortName {
  std::string_view key;
  ParameterRole role;
};
constexpr ShortName kShortNames[] = {
    {"E", ParameterRole::youngs_modulus},  {"nu", ParameterRole::poissons_ratio},
    {"c", ParameterRole::strength},        {"phi", ParameterRole::friction_angle},
    {"gamma", ParameterRole::unit_weight}, {"psi", ParameterRole::dilation_angle},
};

}  // namespace

int parameter_place(const MaterialEntry& entry, std::string_view key) {
  if (const int place = entry.find(key); place >= 0) return place;
  for (const ShortName& known : kShortNames)
    if (known.key == key) return entry.find(known.role);
  return -1;
}

}  // namespace sage
