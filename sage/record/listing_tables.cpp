// States in columns: nodes, integration points, interface points.  Most of a listing's time is here.
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "sage/analysis/shown_status.hpp"
#include "sage/record/listing_parts.hpp"
#include "sage/record/number.hpp"

namespace sage::listing {

namespace {

constexpr int kWidth = 12, kDigits = 5;

void put(std::string& text, double value) {
  append_scientific(text, value, kWidth, kDigits);
}

void column(std::string& text, std::string_view name, int width = kWidth) {
  fmt::format_to(std::back_inserter(text), "{:>{}}", name, width);
}

void left(std::string& text, std::string_view word, std::size_t width) {
  text += word;
  if (word.size() < width) text.append(width - word.size(), ' ');
}

// "   0.725": three decimals of a number that stands between 0 and 1.
void append_level(std::string& text, double level) {
  if (!(level >= 0.0 && level < 999.0)) {
    fmt::format_to(std::back_inserter(text), "{:8.3g}", level);
    return;
  }
  const long thousandths = std::lround(1000.0 * level);
  append_integer(text, thousandths / 1000, 4);
  const char digits[4] = {'.', static_cast<char>('0' + thousandths / 100 % 10),
                          static_cast<char>('0' + thousandths / 10 % 10),
                          static_cast<char>('0' + thousandths % 10)};
  text.append(digits, 4);
}

void history_columns(std::string& text, const GroupData& data, const UnitSystem& units) {
  for (const Quantity& quantity : history_of(data)) {
    const std::string unit = unit_text(quantity.dimension, units);
    column(text, unit == "-" ? std::string(quantity.name) : fmt::format("{} [{}]", quantity.name, unit), 22);
  }
}

void history(std::string& text, const GroupData& data, std::size_t point) {
  const std::span<const Quantity> quantities = history_of(data);
  const double* h = data.state.committed.h.data() + point * quantities.size();
  for (std::size_t i = 0; i < quantities.size(); ++i)
    append_scientific(text, outward(quantities[i], h[i]), 22, kDigits);
}

void solid_columns(std::string& text, const Model& model, const GroupData& data) {
  const AxisNames& names = axis_names(model.geometry);
  fmt::format_to(std::back_inserter(text), "\n   Stresses of group {} {} ({}, compression positive)\n",
                 data.group->number, data.group->name, model.units.stress);
  column(text, "element", 9);
  column(text, "pt", 4);
  column(text, names.x);
  column(text, names.y);
  for (std::string_view name : names.stress) column(text, name);
  text += "   level  status    ";
  history_columns(text, data, model.units);
  text += '\n';
}

void interface_columns(std::string& text, const Model& model, const GroupData& data) {
  const AxisNames& names = axis_names(model.geometry);
  fmt::format_to(
      std::back_inserter(text),
      "\n   Interface of group {} {} (stress {}, relative displacement {}; compression and closing positive)\n",
      data.group->number, data.group->name, model.units.stress, model.units.length);
  column(text, "element", 9);
  column(text, "pt", 4);
  for (std::string_view name : {names.x, names.y, std::string_view("shear"), std::string_view("normal"),
                                std::string_view("rel.shear"), std::string_view("rel.normal")})
    column(text, name);
  text += "   level  status    ";
  history_columns(text, data, model.units);
  text += '\n';
}

// Components, stress level, status and history of one point.
void point_values(std::string& text, const Mesh& mesh, const GroupData& data, std::size_t point) {
  const PointStates& state = data.state.committed;
  const auto n = static_cast<std::size_t>(data.state.law_size());
  for (std::size_t i = 0; i < n; ++i) put(text, outward(state.sigma[point * n + i]));
  if (n == 2)
    for (std::size_t i = 0; i < n; ++i) put(text, outward(state.eps[point * n + i]));
  append_level(text, stress_level(data, point));
  text += "  ";
  if (history_of(data).empty()) {
    text += status_name(shown_status(mesh, data, point));
  } else {
    left(text, status_name(shown_status(mesh, data, point)), 10);
    history(text, data, point);
  }
  text += '\n';
}

}  // namespace

void nodes(std::string& text, const Model& model, const Solution& solution) {
  const AxisNames& names = axis_names(model.geometry);
  const std::vector<char> active = active_nodes(model, *solution.activity);
  fmt::format_to(std::back_inserter(text),
                 "\n   Nodes (displacement {}, reaction of supports {}; positive along +{}, +{})\n",
                 model.units.length, model.units.force, names.x, names.y);
  column(text, "node", 9);
  for (const std::string& name :
       {std::string(names.x), std::string(names.y), fmt::format("u-{}", names.x), fmt::format("u-{}", names.y),
        fmt::format("react-{}", names.x), fmt::format("react-{}", names.y)})
    column(text, name);
  text += '\n';
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const auto n = static_cast<std::size_t>(node);
    if (!active[n]) continue;
    append_integer(text, model.mesh.number[n], 9);
    for (int c = 0; c < 2; ++c) put(text, model.mesh.x(c, node));
    for (int c = 0; c < 2; ++c) put(text, (*solution.u)[2 * node + c]);
    const bool held[2] = {solution.activity->held[2 * n] != 0, solution.activity->held[2 * n + 1] != 0};
    if (held[0]) put(text, reaction(solution, 2 * node));
    if (!held[0] && held[1]) text.append(kWidth, ' ');
    if (held[1]) put(text, reaction(solution, 2 * node + 1));
    text += '\n';
  }
}

void points(std::string& text, const Model& model, const Solution& solution) {
  Eigen::Matrix2Xd x;
  for (const GroupData& data : solution.assembly->groups()) {
    if (!data.active) continue;
    const Group& group = *data.group;
    const int count = group.element->traits().points;
    constexpr std::size_t kRow = 112;  // characters, without a history
    text.reserve(text.size() + static_cast<std::size_t>(group.elements() * count) * kRow);
    data.group->solid() ? solid_columns(text, model, data) : interface_columns(text, model, data);
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      for (int p = 0; p < count; ++p) {
        const Vector2 at = group.element->position(x, p);
        append_integer(text, group.element_numbers[static_cast<std::size_t>(e)], 9);
        append_integer(text, p + 1, 4);
        put(text, at.x());
        put(text, at.y());
        point_values(text, model.mesh, data, static_cast<std::size_t>(e * count + p));
      }
    }
  }
}

}  // namespace sage::listing
