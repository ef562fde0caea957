#include "sage/draw/picture_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr double kRoundOff = 1e-9;  // of the largest stress or displacement: not worth a colour

constexpr std::pair<Field, std::string_view> kFields[] = {
    {Field::stress_xx, "stress_xx"},           {Field::stress_yy, "stress_yy"},
    {Field::stress_zz, "stress_zz"},           {Field::stress_xy, "stress_xy"},
    {Field::mean_stress, "mean_stress"},       {Field::deviator, "deviator"},
    {Field::stress_level, "stress_level"},     {Field::displacement_x, "displacement_x"},
    {Field::displacement_y, "displacement_y"}, {Field::displacement, "displacement"},
};

bool is_displacement(Field field) {
  return field == Field::displacement_x || field == Field::displacement_y || field == Field::displacement;
}

// sigma (tension +) and stress level of a point; nothing for interfaces.
void stress_values(const GroupData& data, std::size_t point, double* values) {
  const bool solid = data.group->solid();
  for (std::size_t i = 0; i < 4; ++i) values[i] = solid ? data.state.committed.sigma[4 * point + i] : 0.0;
  values[4] = solid ? stress_level(data, point) : 0.0;
}

double scalar(Field field, const double* values) {
  switch (field) {
    case Field::displacement_x:
      return values[0];
    case Field::displacement_y:
      return values[1];
    case Field::displacement:
      return std::hypot(values[0], values[1]);
    case Field::mean_stress:
      return mean_stress(values);
    case Field::deviator:
      return deviator_stress(values);
    case Field::stress_level:
      return std::max(values[4], 0.0);
    default:
      return outward(values[static_cast<std::size_t>(field)]);
  }
}

}  // namespace

std::string_view field_name(Field field) {
  for (const auto& [f, name] : kFields)
    if (f == field) return name;
  return "";
}

std::optional<Field> field_from_name(std::string_view name) {
  for (const auto& [field, n] : kFields)
    if (n == name) return field;
  return std::nullopt;
}

std::string describe_field(const Model& model, Field field) {
  const AxisNames& names = axis_names(model.geometry);
  const std::string &stress = model.units.stress, &length = model.units.length;
  switch (field) {
    case Field::stress_xx:
    case Field::stress_yy:
    case Field::stress_zz:
    case Field::stress_xy:
      return fmt::format("{} [{}], compression positive", names.stress[static_cast<std::size_t>(field)],
                         stress);
    case Field::mean_stress:
      return fmt::format("mean stress p [{}], compression positive", stress);
    case Field::deviator:
      return fmt::format("deviator stress q [{}]", stress);
    case Field::stress_level:
      return "stress level (1 = at strength)";
    case Field::displacement_x:
      return fmt::format("displacement u-{} [{}], positive along +{}", names.x, length, names.x);
    case Field::displacement_y:
      return fmt::format("displacement u-{} [{}], positive along +{}", names.y, length, names.y);
    case Field::displacement:
      return fmt::format("length of displacement [{}]", length);
  }
  return "";
}

FieldParts field_parts(const Model& model, const Solution& s, const NodalLayout& layout, Field field) {
  FieldParts parts;
  const auto entries = static_cast<Eigen::Index>(layout.node.size());
  if (is_displacement(field)) {
    parts.components = 2;
    parts.at.resize(2, entries);
    for (Eigen::Index e = 0; e < entries; ++e)
      parts.at.col(e) = s.u->segment<2>(2 * layout.node[static_cast<std::size_t>(e)]);
    if (entries > 0) parts.largest = parts.at.colwise().norm().maxCoeff();
  } else {
    const std::vector<double> stress = nodal_average(model, s, layout, 5, stress_values);
    parts.components = 5;
    parts.at = Eigen::Map<const Eigen::MatrixXd>(stress.data(), 5, entries);
    if (entries > 0 && field != Field::stress_level) parts.largest = parts.at.topRows(4).cwiseAbs().maxCoeff();
  }
  return parts;
}

double field_value(Field field, const FieldParts& parts, const double* at) {
  const double value = scalar(field, at);
  return std::abs(value) < kRoundOff * parts.largest ? 0.0 : value;
}

}  // namespace sage
