#include "sage/record/extremes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sage {

namespace {

bool is_force(const FieldEntry& row) {
  return row.kind == ElementKind::structure && std::holds_alternative<PointField>(row.value) &&
         row.size() == 1 && (row.dimension == Dimension::force || row.dimension == Dimension::moment);
}

ExtremeRow extreme_of(const FieldEntry& field, const Model& model, const GroupData& data) {
  ExtremeRow row;
  row.low = std::numeric_limits<double>::infinity();
  row.high = -row.low;
  const int points = data.group->element->traits().points;
  for (int e = 0; e < data.group->elements(); ++e)
    for (int p = 0; p < points; ++p) {
      double value = 0.0;
      read_field(field, PointState(model.mesh, data, static_cast<std::size_t>(e * points + p)), &value);
      const int number = data.group->element_numbers[static_cast<std::size_t>(e)];
      if (value < row.low) row.low = value, row.low_at = number;
      if (value > row.high) row.high = value, row.high_at = number;
    }
  return row;
}

std::string group_name(const Group& group) {
  return fmt::format("{} {}", group.number, group.name.empty() ? group.entry->name : group.name);
}

}  // namespace

FieldList structure_forces(const Model& model) {
  FieldList list;
  for (const FieldEntry& row : model.fields.rows())
    if (is_force(row)) list.push_back(&row);
  return list;
}

bool has_structures(const Model& model) {
  return std::ranges::any_of(model.groups, [](const Group& group) { return group.structure(); });
}

std::vector<ExtremeRow> extremes(const Model& model, int stage, const Solution& solution) {
  std::vector<ExtremeRow> rows;
  if (!has_structures(model)) return rows;
  const FieldList fields = structure_forces(model);
  const std::span<const GroupData> groups = solution.groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const GroupData& data = groups[g];
    if (!data.active || !data.group->structure() || data.group->elements() == 0) continue;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (!applies(*fields[f], data)) continue;
      ExtremeRow row = extreme_of(*fields[f], model, data);
      row.stage = row.low_stage = row.high_stage = stage;
      row.group = static_cast<std::int64_t>(g);
      row.field = static_cast<std::int64_t>(f);
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<ExtremeRow> envelope(const std::vector<ExtremeRow>& rows) {
  std::vector<ExtremeRow> all;
  for (const ExtremeRow& row : rows) {
    const auto same = std::ranges::find_if(
        all, [&](const ExtremeRow& one) { return one.group == row.group && one.field == row.field; });
    if (same == all.end()) {
      all.push_back(row);
      continue;
    }
    if (row.low < same->low) {
      same->low = row.low;
      same->low_at = row.low_at;
      same->low_stage = row.stage;
    }
    if (row.high > same->high) {
      same->high = row.high;
      same->high_at = row.high_at;
      same->high_stage = row.stage;
    }
  }
  std::ranges::stable_sort(all, {}, &ExtremeRow::group);
  return all;
}

std::string extremes_table(const Model& model, const std::vector<ExtremeRow>& rows, bool with_stages) {
  if (rows.empty()) return {};
  const FieldList fields = structure_forces(model);
  const auto value = [&](double number, std::int64_t at, std::int64_t stage) {
    return fmt::format("{:>14.5g}{:>9}", number, at) + (with_stages ? fmt::format("{:>7}", stage + 1) : "");
  };
  const std::string stage = with_stages ? fmt::format("{:>7}", "stage") : "";
  std::string text = fmt::format("    {:<20}{:<24}{:>14}{:>9}{}{:>14}{:>9}{}\n", "structure", "quantity",
                                 "least", "element", stage, "largest", "element", stage);
  for (const ExtremeRow& row : rows) {
    const FieldEntry& field = *fields[static_cast<std::size_t>(row.field)];
    text +=
        fmt::format("    {:<20.20}{:<24}{}{}\n", group_name(model.groups[static_cast<std::size_t>(row.group)]),
                    fmt::format("{} [{}]", field.name, unit_text(field.dimension, model.units)),
                    value(row.low, row.low_at, row.low_stage), value(row.high, row.high_at, row.high_stage));
  }
  return text;
}

}  // namespace sage
