// States in columns: nodes, integration points, interface points.  Most of a listing's time is here.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/record/end_forces.hpp"
#include "sage/record/listing_parts.hpp"
#include "sage/record/number.hpp"
#include "sage/record/values.hpp"

namespace sage::listing {

namespace {

constexpr int kWidth = 12, kDigits = 5;
constexpr int kPoint = 4;  // width of the number of a point

void put(std::string& text, double value) {
  append_scientific(text, value, kWidth, kDigits);
}

void column(std::string& text, std::string_view name, int width = kWidth) {
  fmt::format_to(to(text), "{:>{}}", name, width);
}

void left(std::string& text, std::string_view word, std::size_t width) {
  text += word;
  if (word.size() < width) text.append(width - word.size(), ' ');
}

// "   0.725  ": three decimals of a number that stands between 0 and 1.
void append_level(std::string& text, double level) {
  if (std::isnan(level)) {  // of water
    text += "       -  ";
    return;
  }
  if (!(level >= 0.0 && level < 999.0)) {
    fmt::format_to(to(text), "{:8.3g}  ", level);
    return;
  }
  const long thousandths = std::lround(1000.0 * level);
  const auto digit = [&](long unit) { return static_cast<char>('0' + thousandths / unit % 10); };
  const char digits[] = {digit(1000), '.', digit(100), digit(10), digit(1), ' ', ' '};
  if (thousandths < 10'000)
    text += "   ";
  else
    append_integer(text, thousandths / 10'000, 3);
  text.append(digits, sizeof digits);
}

// Least width of history and fields that were asked for.
constexpr int kWide = 22;
constexpr int kBetween = 2;  // blanks before longer names

// What the tables of one group show: components first, then stress level and status, then these.
struct GroupColumns {
  FieldList components, wide;
  const FieldEntry *level, *status;
  std::size_t most = 1;   // values of a field
  std::size_t first = 2;  // values of a place and of all components
};

GroupColumns columns_of(const GroupData& data, const FieldTable& table, const std::vector<FieldEntry>& history,
                        const std::vector<std::string>& asked) {
  GroupColumns columns;
  switch (data.group->entry->kind) {
    case ElementKind::solid:
      columns.components = fields_named(table, {"stress"});
      break;
    case ElementKind::interface:
      columns.components = fields_named(table, {"traction", "relative_displacement"});
      break;
    case ElementKind::flow:
      columns.wide = fields_named(table, {"velocity", "hydraulic_gradient"});
      break;
    case ElementKind::structure:
      for (const FieldEntry& row : table.rows())
        if (row.kind == ElementKind::structure && applies(row, data)) columns.wide.push_back(&row);
      break;
  }
  columns.level = table.find("stress_level");
  columns.status = table.find("status");
  for (const FieldEntry& row : history) columns.wide.push_back(&row);
  for (const std::string& name : asked) {
    const FieldEntry* row = table.find(name);
    const bool there = row == nullptr ||
                       std::ranges::any_of(columns.wide, [&](const FieldEntry* w) { return w->name == name; });
    if (!there && applies(*row, data)) columns.wide.push_back(row);
  }
  for (const FieldEntry* row : columns.components) columns.first += row->size();
  for (const FieldList* list : {&columns.components, &columns.wide})
    for (const FieldEntry* row : *list) columns.most = std::max(columns.most, row->size());
  return columns;
}

// The widths of the columns.
std::vector<int> wide_columns(std::string& text, const FieldList& fields, const UnitSystem& units) {
  std::vector<int> widths;
  for (const FieldEntry* field : fields)
    for (std::size_t c = 0; c < field->size(); ++c) {
      const std::string unit = unit_text(field->dimension, units), name = field->column(c);
      const std::string head = unit == "-" ? name : fmt::format("{} [{}]", name, unit);
      const int length = static_cast<int>(head.size());
      widths.push_back(length < kWide ? kWide : length + kBetween);
      column(text, head, widths.back());
    }
  return widths;
}

std::vector<int> point_columns(std::string& text, const Model& model, const GroupData& data,
                               const GroupColumns& columns) {
  const int number = data.group->number;
  const std::string& name = data.group->name;
  switch (data.group->entry->kind) {
    case ElementKind::solid:
      fmt::format_to(to(text), "\n   Stresses of group {} {} ({}, compression positive)\n", number, name,
                     model.units.stress);
      break;
    case ElementKind::interface:
      fmt::format_to(to(text),
                     "\n   Interface of group {} {} (stress {}, relative displacement {}; compression and "
                     "closing positive)\n",
                     number, name, model.units.stress, model.units.length);
      break;
    case ElementKind::flow:
      fmt::format_to(to(text), "\n   Flow in group {} {} (velocity {}, along +{} and +{})\n", number, name,
                     unit_text(Dimension::velocity, model.units), axis_names(model.geometry).x,
                     axis_names(model.geometry).y);
      break;
    case ElementKind::structure:
      fmt::format_to(to(text), "\n   Structure of group {} {} (force {}, compression positive)\n", number, name,
                     model.units.force);
      break;
  }
  column(text, "element", 9);
  column(text, "pt", kPoint);
  column(text, axis_names(model.geometry).x);
  column(text, axis_names(model.geometry).y);
  for (const FieldEntry* field : columns.components)
    for (std::size_t c = 0; c < field->size(); ++c) column(text, field->label(c, model.geometry));
  text += "   level  status    ";
  std::vector<int> widths = wide_columns(text, columns.wide, model.units);
  text += '\n';
  return widths;
}

// Blank where the value is not known.
void put_wide(std::string& text, double value, int width) {
  if (std::isnan(value))
    text.append(static_cast<std::size_t>(width), ' ');
  else
    append_scientific(text, value, width, kDigits);
}

// Place, components, stress level, status, history and what was asked for, of one point.
void point_values(std::string& text, const Vector2& at, const PointState& point, const GroupColumns& columns,
                  std::span<const int> widths, std::vector<double>& values) {
  values[0] = at.x();
  values[1] = at.y();
  std::size_t filled = 2;
  for (const FieldEntry* field : columns.components) {
    read_field(*field, point, values.data() + filled);
    filled += field->size();
  }
  append_scientific(text, {values.data(), filled}, kWidth, kDigits);
  read_field(*columns.level, point, values.data());
  append_level(text, values[0]);
  read_field(*columns.status, point, values.data());
  left(text, word_of(*columns.status, values[0]), columns.wide.empty() ? 0 : 10);
  auto width = widths.begin();
  for (const FieldEntry* field : columns.wide) {
    read_field(*field, point, values.data());
    for (std::size_t c = 0; c < field->size(); ++c) put_wide(text, values[c], *width++);
  }
  text += '\n';
}

}  // namespace

void nodes(std::string& text, const Model& model, const Solution& solution,
           const std::vector<std::string>& asked) {
  const AxisNames axes = axis_names(model.geometry);
  const std::vector<char> active = active_nodes(model, *solution.activity);
  FieldTable table = model.fields;
  table.add_free(flow_fields(model));
  const FieldEntry &moved = *table.find("displacement"), &reaction = *table.find("reaction");
  const std::vector<FieldEntry> unknowns = unknown_fields(model);
  FieldList wide;
  for (const FieldEntry& row : unknowns) wide.push_back(&row);
  std::size_t most = 2;
  for (const std::string& name : asked) {
    const FieldEntry* row = table.find(name);
    if (row == nullptr || row->place() != FieldPlace::node || row == &moved || row == &reaction) continue;
    wide.push_back(row);
    most = std::max(most, row->size());
  }
  fmt::format_to(to(text),
                 "\n   Nodes (displacement {}, reaction of supports {}, {}; positive along +{}, +{})\n",
                 model.units.length, model.units.force, forces_per(model), axes.x, axes.y);
  column(text, "node", 9);
  column(text, axes.x);
  column(text, axes.y);
  for (const FieldEntry* field : {&moved, &reaction})
    for (std::size_t c = 0; c < 2; ++c) column(text, field->label(c, model.geometry));
  const std::vector<int> widths = wide_columns(text, wide, model.units);
  text += '\n';
  std::vector<double> values(most);
  const NodeViews views(model, solution);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    if (!active[node]) continue;
    const NodeView view = views.at(node);
    append_integer(text, view.number, 9);
    for (int c = 0; c < 2; ++c) put(text, view.place[c]);
    read_field(moved, view, values.data());
    for (std::size_t c = 0; c < 2; ++c) put(text, values[c]);
    read_field(reaction, view, values.data());
    const bool held[2] = {!std::isnan(values[0]), !std::isnan(values[1])};
    if (held[0]) put(text, values[0]);
    if (!held[0] && (held[1] || !wide.empty())) text.append(kWidth, ' ');
    if (held[1]) put(text, values[1]);
    if (!held[1] && !wide.empty()) text.append(kWidth, ' ');
    auto width = widths.begin();
    for (const FieldEntry* field : wide) {
      read_field(*field, view, values.data());
      for (std::size_t c = 0; c < field->size(); ++c) put_wide(text, values[c], *width++);
    }
    text += '\n';
  }
}

void points(std::string& text, const Model& model, const Solution& solution,
            const std::vector<std::string>& asked) {
  const FieldTable table = model.fields;
  Eigen::Matrix2Xd x;
  for (const GroupData& data : solution.groups()) {
    if (!data.active) continue;
    const Group& group = *data.group;
    const int count = group.element->traits().points;
    constexpr std::size_t kRow = 112;  // characters, without a history
    text.reserve(text.size() + static_cast<std::size_t>(group.elements() * count) * kRow);
    const std::vector<FieldEntry> history = history_fields(data.law, group.element->traits());
    const GroupColumns columns = columns_of(data, table, history, asked);
    std::vector<double> values(std::max(columns.first, columns.most));
    const std::vector<int> widths = point_columns(text, model, data, columns);
    std::string number, numbers;  // of the element, and of its points
    for (int p = 0; p < count; ++p) append_integer(numbers, p + 1, kPoint);
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      number.clear();
      append_integer(number, group.element_numbers[e], 9);
      for (int p = 0; p < count; ++p) {
        const Vector2 at = group.element->position(x, p);
        text += number;
        text.append(numbers, static_cast<std::size_t>(p * kPoint), kPoint);
        point_values(text, at, {model.mesh, data, static_cast<std::size_t>(e * count + p)}, columns, widths,
                     values);
      }
    }
  }
}

void ends(std::string& text, const Model& model, const Solution& solution) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const std::vector<ElementEnd> all = element_ends(model, solution, g);
    if (all.empty()) continue;
    const Group& group = model.groups[g];
    FieldList fields;
    std::vector<std::size_t> quantities;
    for (std::size_t q = 0; q < kEndQuantities.size(); ++q)
      if (has_quantity(model, group, q)) {
        quantities.push_back(q);
        fields.push_back(&end_field(q));
      }
    fmt::format_to(to(text),
                   "\n   Ends of group {} {} (in equilibrium with their nodes, compression positive)\n",
                   group.number, group.name);
    column(text, "element", 9);
    column(text, "end", 4);
    column(text, "node", 9);
    column(text, axis_names(model.geometry).x);
    column(text, axis_names(model.geometry).y);
    const std::vector<int> widths = wide_columns(text, fields, model.units);
    text += '\n';
    for (const ElementEnd& end : all) {
      append_integer(text, group.element_numbers[end.element], 9);
      append_integer(text, end.end, 4);
      append_integer(text, model.mesh.number[end.node], 9);
      put(text, end.place.x());
      put(text, end.place.y());
      auto width = widths.begin();
      for (const std::size_t q : quantities) put_wide(text, end.value[q], *width++);
      text += '\n';
    }
  }
}

}  // namespace sage::listing
