#include "sage/core/field.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "sage/core/unit_suffix.hpp"

namespace sage {

FieldPlace FieldEntry::place() const {
  constexpr FieldPlace kPlaces[] = {FieldPlace::node,     FieldPlace::node,  FieldPlace::point,
                                    FieldPlace::point,    FieldPlace::point, FieldPlace::element,
                                    FieldPlace::increment};
  static_assert(std::size(kPlaces) == std::variant_size_v<FieldSource>);
  return kPlaces[value.index()];
}

std::string FieldEntry::column(std::size_t component) const {
  if (component < columns.size()) return columns[component];
  return components.empty() ? name : name + "_" + components[component].name;
}

const std::string& FieldEntry::label(std::size_t component, Geometry geometry) const {
  if (components.empty()) return meaning;
  const FieldComponent& one = components[component];
  const std::string& own = one.label[geometry == Geometry::axisymmetric ? 1 : 0];
  return own.empty() ? one.name : own;
}

std::string field_unit(const FieldEntry& entry, const UnitSystem& units) {
  std::string text;
  if (entry.dimension != Dimension::none) text += unit_suffix(unit_text(entry.dimension, units));
  if (entry.sign == FieldSign::compression_positive) text += ", compression positive";
  return text;
}

namespace {

// Columns of CSV files and tables of the result file that are there without a field: what says where a row is.
std::span<const std::string_view> columns_of_places(FieldPlace place) {
  static constexpr std::string_view kIncrements[] = {"stage", "increment"};
  static constexpr std::string_view kPlaces[] = {"stage", "increment", "node",  "group", "element", "point",
                                                 "x",     "y",         "place", "nodes", "active"};
  if (place == FieldPlace::increment) return kIncrements;
  return kPlaces;
}

// Whether columns of both stand in one file: reports have fields of nodes and points, the result file has those of
// elements and points in one folder.
bool share_a_file(FieldPlace a, FieldPlace b) {
  const auto is_point = [](FieldPlace place) { return place == FieldPlace::point; };
  const bool apart = a == FieldPlace::increment || b == FieldPlace::increment;
  return a == b || (!apart && (is_point(a) || is_point(b)));
}

std::vector<std::string> columns_of(const FieldEntry& entry) {
  std::vector<std::string> columns;
  for (std::size_t c = 0; c < entry.size(); ++c) columns.push_back(entry.column(c));
  return columns;
}

}  // namespace

std::string FieldTable::clash(const FieldEntry& entry) const {
  if (find(entry.name) != nullptr) return "field " + entry.name + " is taken";
  std::vector<std::string> own = columns_of(entry);
  const auto refused = [&](const std::string& column, const std::string& owner) {
    return "field " + entry.name + ": its column " + column + " is " + owner;
  };
  for (std::size_t i = 0; i < own.size(); ++i)
    if (std::find(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(i), own[i]) !=
        own.begin() + static_cast<std::ptrdiff_t>(i))
      return refused(own[i], "there twice");
  if (std::find(own.begin(), own.end(), entry.name) == own.end()) own.push_back(entry.name);
  for (std::string_view taken : columns_of_places(entry.place()))
    if (std::find(own.begin(), own.end(), taken) != own.end())
      return refused(std::string(taken), "one that says where a row of the results is");
  for (const FieldEntry& row : rows()) {
    if (!share_a_file(row.place(), entry.place())) continue;
    for (const std::string& column : columns_of(row))
      if (std::find(own.begin(), own.end(), column) != own.end())
        return refused(column, "one of the field " + row.name);
  }
  return {};
}

void FieldTable::add(FieldEntry entry) {
  if (entry.name.empty()) throw std::logic_error("catalogue: a field needs a name");
  if (const std::string reason = clash(entry); !reason.empty()) throw std::logic_error("catalogue: " + reason);
  rows_ = std::make_shared<std::vector<FieldEntry>>(rows().begin(), rows().end());
  rows_->push_back(std::move(entry));
}

void FieldTable::add_free(std::span<const FieldEntry> rows) {
  for (const FieldEntry& row : rows)
    if (clash(row).empty()) add(row);
}

FieldTable FieldTable::without(const std::function<bool(const FieldEntry&)>& left_out) const {
  FieldTable table;
  table.rows_ = std::make_shared<std::vector<FieldEntry>>();
  std::ranges::remove_copy_if(rows(), std::back_inserter(*table.rows_), left_out);
  return table;
}

std::span<const FieldEntry> FieldTable::rows() const {
  return rows_ ? *rows_ : program_fields();
}

const FieldEntry* FieldTable::find(std::string_view name) const {
  const auto all = rows();
  const auto it = std::find_if(all.begin(), all.end(), [&](const FieldEntry& row) { return row.name == name; });
  return it == all.end() ? nullptr : &*it;
}

namespace {

// By the source chapter's names too: sigma_3, sigma_1 - sigma_3, stress level.
std::string_view full_name(std::string_view name) {
  static constexpr std::pair<std::string_view, std::string_view> kShort[] = {
      {"conf", "principal_stress_3"},
      {"dev", "stress_difference"},
      {"SL", "stress_level"},
      {"sigma_1", "principal_stress_1"},
      {"sigma_2", "principal_stress_2"},
      {"sigma_3", "principal_stress_3"},
      {"sigma_1-sigma_3", "stress_difference"}};
  for (const auto& [one, full] : kShort)
    if (name == one) return full;
  return name;
}

}  // namespace

std::optional<FieldChoice> FieldTable::choose(std::string_view name) const {
  for (const FieldEntry& row : rows()) {
    if (row.form == FieldForm::word) continue;
    const bool single = row.size() == 1;
    if (row.name == name && single) return FieldChoice{&row, 0};
    if (row.name == name && row.shape == FieldShape::vector) return FieldChoice{&row, -1};
    for (std::size_t c = 0; c < row.components.size(); ++c)
      if (name.size() == row.name.size() + 1 + row.components[c].name.size() && name.starts_with(row.name) &&
          name[row.name.size()] == '_' && name.ends_with(row.components[c].name))
        return FieldChoice{&row, static_cast<int>(c)};
  }
  const std::string_view full = full_name(name);  // last: a row of that name comes first
  if (full != name) return choose(full);
  return std::nullopt;
}

std::string FieldTable::known() const {
  std::string text;
  for (const FieldEntry& row : rows()) {
    const FieldPlace place = row.place();
    if (row.form != FieldForm::number || (place != FieldPlace::node && place != FieldPlace::point)) continue;
    const auto add = [&](const std::string& name) { text += (text.empty() ? "" : ", ") + name; };
    for (const FieldComponent& component : row.components) add(row.name + "_" + component.name);
    if (row.size() == 1 || row.shape == FieldShape::vector) add(row.name);
  }
  return text;
}

}  // namespace sage
