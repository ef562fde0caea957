#include "sage/model/strength.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

bool is_strength(ParameterRole role) {
  return role == ParameterRole::strength || role == ParameterRole::friction_angle;
}

// Degrees to degrees.
double divided_angle(double angle, double factor) {
  return std::atan(std::tan(angle * kRadiansPerDegree) / factor) / kRadiansPerDegree;
}

double reduced_dilation(double psi, double phi_left, const StrengthFactors& factors) {
  switch (factors.dilation) {
    case DilationRule::reduced:
      return divided_angle(psi, factors.friction);
    case DilationRule::kept:
      return std::min(psi, phi_left);
    case DilationRule::none:
      return 0.0;
  }
  return psi;
}

ModelPart part_of_law(int components) {
  switch (components) {
    case 4:
      return ModelPart::soil;
    case 2:
      return ModelPart::joints;
    case 1:
      return ModelPart::anchors;
    default:
      return ModelPart::walls;
  }
}

// Some angle of friction of the law is above zero.
bool has_friction(std::span<const double> parameters, const MaterialEntry& entry) {
  for (std::size_t i = 0; i < std::min(parameters.size(), entry.parameters.size()); ++i)
    if (entry.parameters[i].role == ParameterRole::friction_angle && parameters[i] > 0.0) return true;
  return false;
}

}  // namespace

std::string_view name_of(ModelPart part) {
  for (const PartName& row : kParts)
    if (row.part == part) return row.name;
  return {};
}

std::optional<ModelPart> part_of(const MaterialEntry& entry) {
  if (entry.flow || entry.of_pores) return {};
  return part_of_law(entry.law_size);
}

std::optional<ModelPart> part_of(const Group& group) {
  if (group.flow()) return {};
  return part_of_law(group.element->traits().law_size);
}

bool is_soil_or_joint(const MaterialEntry& entry) {
  const std::optional<ModelPart> part = part_of(entry);
  return !part || *part == ModelPart::soil || *part == ModelPart::joints;
}

bool has_strength(const MaterialEntry& entry) {
  return std::ranges::any_of(entry.parameters, [](const Parameter& p) { return is_strength(p.role); });
}

bool has_strength(const Material& material) {
  return has_strength(*material.entry) ||
         std::ranges::any_of(material.variants, [](const LawVariant& one) { return has_strength(*one.entry); });
}

bool has_less_dilation(const Model& model) {
  return std::ranges::any_of(model.groups, [&](const Group& group) {
    if (group.material < 0 || !group.solid()) return false;
    const Material& material = model.materials[group.material];
    const std::vector<Parameter>& rows = material.entry->parameters;
    double phi = 0.0;
    for (std::size_t i = 0; i < std::min(material.parameters.size(), rows.size()); ++i) {
      if (rows[i].role == ParameterRole::friction_angle) phi = material.parameters[i];
      if (rows[i].role == ParameterRole::dilation_angle && material.parameters[i] < phi) return true;
    }
    return false;
  });
}

bool divide_strength(std::span<double> parameters, const MaterialEntry& entry, const StrengthFactors& factors) {
  if (!has_strength(entry)) return false;
  const double F = has_friction(parameters, entry) ? factors.cohesion : factors.undrained;
  double phi = 0.0, phi_left = 0.0;  // of the rows so far: others refer to the friction angle before them
  for (std::size_t i = 0; i < std::min(parameters.size(), entry.parameters.size()); ++i) {
    double& value = parameters[i];
    switch (entry.parameters[i].role) {
      case ParameterRole::strength:
      case ParameterRole::tension_limit:
        if (value > 0.0) value /= F;
        break;
      case ParameterRole::friction_angle:
        // A softening law's -1 stands for the angle before it.
        if (value < 0.0) break;
        phi = value;
        value = phi_left = divided_angle(value, factors.friction);
        break;
      case ParameterRole::friction_loss:
        // The angle at ten times the pressure is divided like any other.
        if (value != 0.0) value = phi_left - divided_angle(phi - value, factors.friction);
        break;
      case ParameterRole::dilation_angle:
        if (value > 0.0) value = reduced_dilation(value, phi_left, factors);
        break;
      default:
        break;
    }
  }
  return true;
}

bool reduce_strength(std::span<double> parameters, const MaterialEntry& entry,
                     const StrengthReduction& reduction) {
  const double F = reduction.factor;
  return divide_strength(parameters, entry, {F, F, F, reduction.dilation});
}

bool reduce_strength(Material& material, const StrengthReduction& reduction) {
  bool any = reduce_strength(material.parameters, *material.entry, reduction);
  for (LawVariant& one : material.variants) any = reduce_strength(one.parameters, *one.entry, reduction) || any;
  return any;
}

}  // namespace sage
