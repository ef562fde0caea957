#include "sage/record/field_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sage/analysis/shown_status.hpp"
#include "sage/analysis/stream_function.hpp"
#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Place of a quantity in a history; -1 = it has none of the name.
int find_quantity(std::span<const Quantity> quantities, std::string_view name) {
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (quantities[i].name == name) return static_cast<int>(i);
  return -1;
}

FieldEntry history_row(const Quantity& quantity, const PointField& value) {
  const std::string name(quantity.name);
  return {.name = name, .meaning = name, .dimension = quantity.dimension, .value = value};
}

FieldEntry law_history_row(const Quantity& quantity) {
  const std::string name(quantity.name);
  const auto value = [name](const PointView& point, double* result) {
    const std::span<const Quantity> quantities = history_of(point.law);
    const int i = find_quantity(quantities, name);
    const auto at = static_cast<std::size_t>(i);
    *result = i < 0 ? kNone : outward(quantities[at], point.history[at]);
  };
  FieldEntry row = history_row(quantity, PointField{value});
  row.has_law = [name](LawRef law) { return find_quantity(history_of(law), name) >= 0; };
  return row;
}

FieldEntry element_history_row(const Quantity& quantity) {
  const std::string name(quantity.name);
  const auto value = [name](const PointView& point, double* result) {
    const int i = find_quantity(point.element_history, name);
    const auto at = static_cast<std::size_t>(i);
    *result =
        i < 0 ? kNone : outward(point.element_history[at], point.history[history_of(point.law).size() + at]);
  };
  FieldEntry row = history_row(quantity, PointField{value});
  row.element_history = name;
  return row;
}

void add_history_rows(const LawRef& law, const ElementTraits& element, std::vector<FieldEntry>& rows) {
  const auto add = [&](FieldEntry row) {
    if (std::ranges::none_of(rows, [&](const FieldEntry& other) { return other.name == row.name; }))
      rows.push_back(std::move(row));
  };
  for (const Quantity& quantity : history_of(law)) add(law_history_row(quantity));
  for (const Quantity& quantity : element.history) add(element_history_row(quantity));
}

void set_none(const FieldEntry& entry, double* value) {
  std::fill_n(value, entry.size(), kNone);
}

}  // namespace

std::vector<FieldEntry> history_fields(const LawRef& law, const ElementTraits& element) {
  std::vector<FieldEntry> rows;
  add_history_rows(law, element, rows);
  return rows;
}

std::vector<FieldEntry> history_fields(const Model& model, std::optional<ElementKind> kind) {
  std::vector<FieldEntry> rows;
  for (const Group& group : model.groups)
    if (!kind || group.entry->kind == *kind)
      add_history_rows(model.material_of(group).law_ref(), group.element->traits(), rows);
  return rows;
}

// What the nodes have of each further unknown: its value, its loads and what holds it.
std::vector<FieldEntry> unknown_fields(const Model& model) {
  std::vector<FieldEntry> rows;
  for (std::size_t i = 1; i < model.unknowns.size(); ++i) {
    const UnknownField& unknown = model.unknowns[i];
    const auto add = [&](const std::string& name, const std::string& meaning, Dimension dimension, auto part) {
      rows.push_back({.name = name,
                      .meaning = meaning,
                      .dimension = dimension,
                      .value = NodeField{[=](const NodeView& node, double* v) { *v = node.unknowns[i].*part; }},
                      .optional = true});
    };
    add(unknown.name, unknown.name, unknown.dimension, &UnknownView::value);
    add(unknown.name + "_" + unknown.load, unknown.load + " of the " + unknown.name + ", applied",
        unknown.load_dimension, &UnknownView::load);
    add(unknown.name + "_reaction", unknown.load + " of the " + unknown.name + " where it is held",
        unknown.load_dimension, &UnknownView::reaction);
    if (unknown.name == "head")
      rows.push_back({.name = "pressure_head",
                      .meaning = "head above the node's place",
                      .dimension = Dimension::length,
                      .value = NodeField{[=](const NodeView& node, double* v) {
                        *v = node.unknowns[i].value - node.place.y();
                      }},
                      .optional = true});
  }
  return rows;
}

std::vector<FieldEntry> flow_fields(const Model& model) {
  if (find_unknown(model.unknowns, "head") < 0) return {};
  return {{.name = std::string(kStreamFunction),
           .meaning = "stream function: what flows between two places",
           .dimension = Dimension::discharge,
           .value = NodeField{[](const NodeView& node, double* v) {
             *v = node.stream_function != nullptr ? (*node.stream_function)(node.index) : kNone;
           }},
           .optional = true}};
}

FieldTable fields_of(const Model& model) {
  FieldTable table = model.fields;
  table.add_free(unknown_fields(model));
  table.add_free(flow_fields(model));
  table.add_free(history_fields(model));
  return table;
}

FieldList fields_named(const FieldTable& table, std::initializer_list<std::string_view> names) {
  FieldList list;
  for (std::string_view name : names) {
    list.push_back(table.find(name));
    if (list.back() == nullptr) throw std::logic_error("no field " + std::string(name));
  }
  return list;
}

FieldList fields_at_places(const FieldTable& table, std::initializer_list<std::string_view> usual,
                           const std::vector<std::string>& asked) {
  FieldList fields = fields_named(table, usual);
  for (const std::string& name : asked) {
    const FieldEntry* row = table.find(name);
    const bool lives =
        row != nullptr && (row->place() == FieldPlace::node || row->place() == FieldPlace::point);
    if (lives && row->form == FieldForm::number && std::ranges::find(fields, row) == fields.end())
      fields.push_back(row);
  }
  return fields;
}

// 0 - x: no -0 comes out.
PointState::PointState(const Mesh& mesh, const GroupData& data, std::size_t point)
    : view{data.law, {}, {}, {}, shown_status(mesh, data, point)},
      group(data.group),
      kind(data.group->entry->kind),
      solid(kind == ElementKind::solid) {
  const PointStates& state = data.state.committed;
  const auto n = static_cast<std::size_t>(data.state.law_size());
  const auto history = static_cast<std::size_t>(data.state.history_size());
  view.sigma = {state.sigma.data() + point * n, n};
  view.eps = {state.eps.data() + point * n, n};
  view.history = {state.h.data() + point * history, history};
  view.element_history = data.group->element->traits().history;
  if (!solid) return;
  stress = Vector4::Zero() - Vector4::Map(view.sigma.data());
  strain = Vector4::Zero() - Vector4::Map(view.eps.data());
  if (!data.pore.empty()) view.pore_pressure = data.pore[point];
  if (data.group->excess >= 0) {  // the law's stress holds it
    const double excess = view.history[data.group->excess];
    view.pore_pressure += excess;
    stress.head<3>().array() -= excess;
  }
  if (const ElementTraits& traits = data.group->element->traits(); traits.pressure_history >= 0)
    view.pore_pressure += view.history[view.history.size() - traits.history.size() +
                                       static_cast<std::size_t>(traits.pressure_history)];
  view.effective = stress;
}

bool applies(const FieldEntry& entry, ElementKind kind) {
  if (std::holds_alternative<StressField>(entry.value) || std::holds_alternative<StrainField>(entry.value))
    return kind == ElementKind::solid;
  if (kind == ElementKind::flow && (entry.name == "stress_level" || entry.name == "yielded"))
    return false;  // water has no strength to reach
  return std::holds_alternative<PointField>(entry.value) && entry.kind.value_or(kind) == kind;
}

bool applies(const FieldEntry& entry, const Group& group, const LawRef& law) {
  const std::string& own = entry.element_history;
  return applies(entry, group.entry->kind) && (!entry.has_law || entry.has_law(law)) &&
         (own.empty() || find_quantity(group.element->traits().history, own) >= 0);
}

bool applies(const FieldEntry& entry, const GroupData& data) {
  return applies(entry, *data.group, data.law);
}

void read_field(const FieldEntry& entry, const PointState& point, double* value) {
  if (applies(entry, *point.group, point.view.law))
    read_applying(entry, point, value);
  else
    set_none(entry, value);
}

void read_applying(const FieldEntry& entry, const PointState& point, double* value) {
  if (const auto* stress = std::get_if<StressField>(&entry.value))
    stress->of(point.stress, value);
  else if (const auto* strain = std::get_if<StrainField>(&entry.value))
    strain->of(point.strain, value);
  else
    std::get<PointField>(entry.value).of(point.view, value);
}

void read_field(const FieldEntry& entry, const NodeView& node, double* value) {
  if (const auto* moved = std::get_if<DisplacementField>(&entry.value))
    moved->of(node.displacement, value);
  else if (const auto* any = std::get_if<NodeField>(&entry.value))
    any->of(node, value);
  else
    set_none(entry, value);
}

void read_field(const FieldEntry& entry, const ElementView& element, double* value) {
  if (const auto* field = std::get_if<ElementField>(&entry.value))
    field->of(element, value);
  else
    set_none(entry, value);
}

void read_field(const FieldEntry& entry, const IncrementView& increment, double* value) {
  if (const auto* field = std::get_if<IncrementField>(&entry.value))
    field->of(increment, value);
  else
    set_none(entry, value);
}

namespace {

void view_unknowns(const Solution& solution, int node, NodeView& view) {
  const Activity& activity = *solution.activity;
  for (int field = 1; field < activity.dof_map.fields(); ++field) {
    UnknownView& unknown = view.unknowns[field];
    unknown = {kNone, kNone, kNone};
    const int dof = activity.dof_map.of(node, field);
    if (dof < 0) continue;
    unknown.value = (*solution.u)[dof];
    unknown.load = (*solution.external)[dof];
    if (activity.held[dof]) unknown.reaction = reaction(solution, dof);
  }
}

}  // namespace

NodeViews::NodeViews(const Model& model, const Solution& solution)
    : model_(model),
      solution_(solution),
      stream_function_([this](int node) { return sage::stream_function(model_, solution_).value(node); }) {}

NodeView NodeViews::at(int node) const {
  NodeView view;
  view.number = model_.mesh.number[node];
  view.place = model_.mesh.x.col(node);
  const int first = DofMap::displacement(node);
  view.displacement = solution_.u->segment<2>(first);
  view.load = solution_.external->segment<2>(first);
  for (int c = 0; c < 2; ++c)
    view.reaction[c] = solution_.activity->has_reaction(first + c) ? reaction(solution_, first + c) : kNone;
  view_unknowns(solution_, node, view);
  view.index = node;
  view.stream_function = &stream_function_;
  return view;
}

ElementView element_view(const Model& model, const Group& group, int element, const Eigen::Matrix2Xd& x) {
  return {group.element_numbers[element], group.number, model.material_of(group).number, *group.element, x};
}

IncrementView increment_view(const Model& model, const StepReport& r) {
  const IterationRecord last = r.iterations.empty() ? IterationRecord{} : r.iterations.back();
  IncrementView view{r.stage + 1, r.increment, r.load_factor,     r.converged, r.total_iterations, r.cuts,
                     r.substeps,  last.force,  last.displacement, last.energy, std::span(r.points)};
  const bool worst = r.worst.node >= 0;
  view.worst_node = worst ? model.mesh.number[r.worst.node] : kNone;
  view.worst_component = worst ? r.worst.component + (r.worst.field > 0 ? 1 + r.worst.field : 0) : kNone;
  view.worst_residual = worst ? r.worst.residual : kNone;
  view.pivot_ratio = r.smallest_pivot_ratio >= 0.0 ? r.smallest_pivot_ratio : kNone;
  view.motion = r.motion;
  return view;
}

std::size_t carried_size(const FieldEntry& entry) {
  if (std::holds_alternative<DisplacementField>(entry.value)) return 2;
  if (std::holds_alternative<StressField>(entry.value) || std::holds_alternative<StrainField>(entry.value))
    return 4;
  return entry.size();
}

void carry(const FieldEntry& entry, const PointState& point, double* parts) {
  if (std::holds_alternative<StressField>(entry.value) || std::holds_alternative<StrainField>(entry.value)) {
    const bool stress = std::holds_alternative<StressField>(entry.value);
    Vector4::Map(parts) = !point.solid ? Vector4(Vector4::Constant(kNone))
                          : stress     ? point.stress
                                       : point.strain;
    return;
  }
  read_field(entry, point, parts);
}

void carry(const FieldEntry& entry, const NodeView& node, double* parts) {
  if (std::holds_alternative<DisplacementField>(entry.value))
    Vector2::Map(parts) = node.displacement;
  else
    read_field(entry, node, parts);
}

void value_of_carried(const FieldEntry& entry, const double* parts, double* value) {
  if (const auto* moved = std::get_if<DisplacementField>(&entry.value))
    moved->of(Vector2::Map(parts), value);
  else if (const auto* stress = std::get_if<StressField>(&entry.value))
    stress->of(Vector4::Map(parts), value);
  else if (const auto* strain = std::get_if<StrainField>(&entry.value))
    strain->of(Vector4::Map(parts), value);
  else
    for (std::size_t c = 0; c < entry.size(); ++c) value[c] = parts[c] < entry.least ? entry.least : parts[c];
}

double chosen(const FieldChoice& choice, const double* value) {
  if (!choice.length()) return value[choice.component];
  return choice.entry->size() == 2 ? std::hypot(value[0], value[1]) : std::hypot(value[0], value[1], value[2]);
}

std::vector<double> field_at(const FieldEntry& entry, const Model& model, const Probe& probe,
                             const Solution& solution) {
  std::vector<double> value(entry.size(), kNone), parts(carried_size(entry), 0.0), one(parts.size());
  const FieldPlace place = entry.place();
  if (!probe.active() || (place != FieldPlace::node && place != FieldPlace::point)) return value;
  const auto add = [&](double weight) {
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] += weight * one[i];
  };
  if (place == FieldPlace::node)
    for (const Probe::Node& n : probe.nodes) {
      carry(entry, NodeViews(model, solution).at(n.node), one.data());
      add(n.weight);
    }
  else
    for (const Probe::Point& p : probe.points) {
      carry(entry, PointState(model.mesh, solution.groups()[p.group], p.point), one.data());
      add(p.weight);
    }
  value_of_carried(entry, parts.data(), value.data());
  return value;
}

std::string describe(const FieldChoice& choice, const Model& model) {
  const FieldEntry& entry = *choice.entry;
  const std::string unit = field_unit(entry, model.units);
  if (choice.length()) return "length of " + entry.meaning + unit;
  const auto component = static_cast<std::size_t>(choice.component);
  const std::string& label = entry.label(component, model.geometry);
  if (entry.sign != FieldSign::along_axes || component > 1) return label + unit;
  const AxisNames axes = axis_names(model.geometry);
  return fmt::format("{} {}{}, positive along +{}", entry.meaning, label, unit,
                     component == 0 ? axes.x : axes.y);
}

std::string_view word_of(const FieldEntry& entry, double value) {
  if (!(value >= 0.0 && value < static_cast<double>(entry.words.size()))) return {};
  return entry.words[static_cast<std::size_t>(value)];
}

}  // namespace sage
