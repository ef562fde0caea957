#include "sage/record/extremes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

namespace sage {

namespace {

bool is_force(const FieldEntry& row) {
  return row.kind == ElementKind::structure && std::holds_alternative<PointField>(row.value) &&
         row.size() == 1 && (row.dimension == Dimension::force || row.dimension == Dimension::moment);
}

// The least and the largest so far.
void take(ExtremeRow& row, double value, int number) {
  if (value < row.low) row.low = value, row.low_at = number;
  if (value > row.high) row.high = value, row.high_at = number;
}

int element_number(const GroupData& data, int element) {
  return data.group->element_numbers[element];
}

// At the ends of the elements; of a field that ends don't have, at their points.
ExtremeRow extreme_of(const FieldEntry& field, const Model& model, const GroupData& data,
                      const std::vector<ElementEnd>& ends) {
  ExtremeRow row;
  row.low = std::numeric_limits<double>::infinity();
  row.high = -row.low;
  if (const int quantity = end_quantity(field.name); quantity >= 0) {
    for (const ElementEnd& end : ends) take(row, end.value[quantity], element_number(data, end.element));
    return row;
  }
  const int points = data.group->element->traits().points;
  for (int e = 0; e < data.group->elements(); ++e)
    for (int p = 0; p < points; ++p) {
      double value = 0.0;
      read_field(field, PointState(model.mesh, data, static_cast<std::size_t>(e * points + p)), &value);
      take(row, value, element_number(data, e));
    }
  return row;
}

}  // namespace

std::string structure_name(const Group& group) {
  return fmt::format("{} {}", group.number, group.name.empty() ? group.entry->name : group.name);
}

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
    const std::vector<ElementEnd> ends = element_ends(model, solution, g);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (!applies(*fields[f], data)) continue;
      ExtremeRow row = extreme_of(*fields[f], model, data, ends);
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
    return fmt::format("{:>11.5g}{:>8}", number, at) + (with_stages ? fmt::format("{:>6}", stage + 1) : "");
  };
  const std::string stage = with_stages ? fmt::format("{:>6}", "stage") : "";
  std::string text = fmt::format("      {:<23}{:>11}{:>8}{}{:>11}{:>8}{}\n", "quantity", "least", "element",
                                 stage, "largest", "element", stage);
  std::int64_t group = -1;
  for (const ExtremeRow& row : rows) {
    if (row.low == 0.0 && row.high == 0.0) continue;
    if (row.group != group) text += fmt::format("    {}\n", structure_name(model.groups[row.group]));
    group = row.group;
    const FieldEntry& field = *fields[row.field];
    text += fmt::format(
        "      {:<23}{}{}\n", fmt::format("{} [{}]", field.name, unit_text(field.dimension, model.units)),
        value(row.low, row.low_at, row.low_stage), value(row.high, row.high_at, row.high_stage));
  }
  return text;
}

std::string envelope_table(const Model& model, const std::vector<EnvelopeEnd>& rows) {
  std::string text;
  const auto unit = [&](std::size_t q) { return unit_text(end_field(q).dimension, model.units); };
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    const auto number = static_cast<std::int64_t>(g);
    const std::span<const EnvelopeEnd> own(std::ranges::lower_bound(rows, number, {}, &EnvelopeEnd::group),
                                           std::ranges::upper_bound(rows, number, {}, &EnvelopeEnd::group));
    if (own.empty()) continue;
    std::vector<std::size_t> quantities;
    for (std::size_t q = 0; q < kEndQuantities.size(); ++q)
      if (has_quantity(model, group, q)) quantities.push_back(q);
    text += fmt::format(
        "\n   Ends of group {} (least and largest of all stages, each with its stage)\n{:>9}{:>4}{:>9}",
        structure_name(group), "element", "end", "node");
    for (const std::size_t q : quantities)
      text += fmt::format("{:>36}", fmt::format("{} [{}]", kEndQuantities[q], unit(q)));
    text += '\n';
    for (const EnvelopeEnd& row : own) {
      text += fmt::format("{:>9}{:>4}{:>9}", group.element_numbers[row.element], row.end,
                          model.mesh.number[row.node]);
      for (const std::size_t q : quantities)
        text += fmt::format("{:>14.5g}{:>4}{:>14.5g}{:>4}", row.low[q], row.low_stage[q] + 1, row.high[q],
                            row.high_stage[q] + 1);
      text += '\n';
    }
  }
  return text;
}

}  // namespace sage
