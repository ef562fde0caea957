// The page's states: which fields, of which states, how exactly, so that they find room.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sage/record/end_forces.hpp"
#include "sage/record/field_reader.hpp"
#include "sage/record/values.hpp"
#include "sage/report/run_data.hpp"

namespace sage::report {

namespace {

// With the script of 0.12 MB a page of one run has 4 MB at most, unless its model is large.
constexpr std::size_t kRoom = 3850000, kRoomOfElement = 80;
constexpr std::size_t kMostStates = 200;  // that are read, to keep the page's memory and the time bounded

// From what is looked at most to what is looked at least.
constexpr std::string_view kOrder[] = {"displacement",   "stress",           "head",
                                       "pressure_head",  "excess_pressure",  "pore_pressure",
                                       "traction",       "stress_level",     "status",
                                       "plastic_strain", "velocity",         "relative_displacement",
                                       "strain",         "factor_of_safety", "hydraulic_gradient",
                                       "total_stress"};

// What the script makes of `stress` itself, and what tables of elements and increments are for.
bool shown(const Model& model, const FieldEntry& field) {
  for (const UnknownField& unknown : model.unknowns)
    if (field.name == unknown.name + "_" + unknown.load || field.name == unknown.name + "_reaction" ||
        (unknown.turns && field.name == unknown.name))
      return false;
  constexpr std::string_view kDerived[] = {"mean_stress",          "deviator",        "principal_stress",
                                           "stress_difference",    "principal_angle", "principal_direction_1",
                                           "principal_direction_3"};
  const bool placed = field.place() == FieldPlace::node || field.place() == FieldPlace::point;
  return placed && field.form != FieldForm::integer && field.kind != ElementKind::structure &&
         std::ranges::find(kDerived, field.name) == std::end(kDerived);
}

bool applies_to_area(const Model& model, const Group& group, const FieldEntry& field) {
  return !group.structure() && applies(field, group, model.material_of(group).law_ref());
}

bool has_values(const Model& model, const FieldEntry& field) {
  if (field.place() == FieldPlace::node) return true;
  return std::ranges::any_of(model.groups,
                             [&](const Group& group) { return applies_to_area(model, group, field); });
}

// All components of a field, or one that was asked for.
struct ShownField {
  const FieldEntry* entry = nullptr;
  std::vector<std::size_t> components{};

  void add(std::size_t component) {
    if (std::ranges::find(components, component) == components.end()) components.push_back(component);
    std::ranges::sort(components);
  }
};
using ShownFields = std::vector<ShownField>;

// In the order of their use.
ShownFields fields_to_show(const Model& model, const FieldTable& table, const std::vector<std::string>& asked) {
  ShownFields list;
  const auto add = [&](const FieldEntry* field, int component) {
    if (field == nullptr || !shown(model, *field) || !has_values(model, *field)) return;
    auto there = std::ranges::find(list, field, &ShownField::entry);
    if (there == list.end()) there = list.insert(list.end(), ShownField{field});
    for (std::size_t c = 0; c < field->size(); ++c)
      if (component < 0 || c == static_cast<std::size_t>(component)) there->add(c);
  };
  add(table.find("displacement"), -1);
  for (const std::string& name : asked)
    if (const auto choice = table.choose(name)) add(choice->entry, choice->component);
  if (!asked.empty()) return list;
  for (const std::string_view name : kOrder) add(table.find(name), -1);
  for (const FieldEntry& field : table.rows())
    if (field.name != "external_force" && field.name != "reaction") add(&field, -1);
  return list;
}

// Of one state.
std::size_t numbers_of(const Model& model, const ShownField& of, bool points) {
  const FieldEntry& field = *of.entry;
  std::size_t places = 0;
  if (field.place() == FieldPlace::node) {
    places = static_cast<std::size_t>(model.mesh.nodes());
  } else {
    for (const Group& group : model.groups)
      if (applies_to_area(model, group, field))
        places += static_cast<std::size_t>(group.elements()) *
                  static_cast<std::size_t>(points ? group.element->traits().points : 1);
  }
  return places * of.components.size();
}

// What goes into the page.
struct Plan {
  ShownFields fields;
  std::vector<std::size_t> states;  // places in StoredResult::states()
  Precision precision = Precision::whole;
  bool points = true;  // else means of elements

  std::size_t bytes(const Model& model) const {
    std::size_t numbers = 0;
    for (const ShownField& field : fields) numbers += numbers_of(model, field, points);
    return numbers * states.size() * bytes_of(precision) * 4 / 3;
  }
};

// The last of each stage.
std::vector<std::size_t> ends_of_stages(const PageRun& run) {
  std::vector<std::size_t> ends;
  const auto& states = run.states;
  for (std::size_t i = 0; i < states.size(); ++i)
    if (i + 1 == states.size() || states[i + 1].stage != states[i].stage) ends.push_back(i);
  return ends;
}

std::string names_of_fields(const ShownFields& fields, std::size_t first) {
  std::string names;
  for (std::size_t i = first; i < fields.size(); ++i)
    names += (names.empty() ? "" : ", ") + fields[i].entry->name;
  return names;
}

class Planner {
 public:
  // used: bytes of the page so far.
  Planner(const PageRun& run, const PageOptions& options, ShownFields fields, std::size_t used) : run_(run) {
    std::size_t elements = 0, points = 0;
    for (const Group& group : run.model.groups) {
      elements += static_cast<std::size_t>(group.elements());
      points += static_cast<std::size_t>(group.elements() * group.element->traits().points);
    }
    const std::size_t room = options.room > 0 ? options.room : std::max(kRoom, kRoomOfElement * elements);
    room_ = room > used ? room - used : 0;
    plan_.fields = std::move(fields);
    for (std::size_t i = 0; i < run.states.size(); ++i) plan_.states.push_back(i);
    if (points > options.most_points) {
      plan_.points = false;
      say(fmt::format(
          "the model has {} integration points, more than {}: each element shows the mean of its points",
          points, options.most_points));
    }
  }

  // Takes away, the least missed first, until it fits.  The displacement and the first field of the last state always stay.
  Plan plan(bool fields_were_asked) {
    const std::size_t kept =
        fields_were_asked ? plan_.fields.size() : std::min<std::size_t>(plan_.fields.size(), 4);
    if (plan_.states.size() > kMostStates) keep_states(ends_of_stages(run_), "ends of stages");
    if (!fits()) plan_.precision = Precision::fine;
    keep_fields(kept);
    if (!fits()) keep_states(ends_of_stages(run_), "ends of stages");
    if (!fits()) keep_states({plan_.states.back()}, "last state");
    if (!fits()) plan_.precision = Precision::coarse;
    keep_fields(2);
    if (plan_.precision != Precision::whole)
      say(fmt::format("numbers of fields are rounded to one part in {} of their range",
                      plan_.precision == Precision::fine ? 16777214 : 65534));
    return std::move(plan_);
  }
  std::vector<std::string> omitted() && { return std::move(omitted_); }

 private:
  bool fits() const { return plan_.bytes(run_.model) <= room_; }
  void say(std::string words) { omitted_.push_back(std::move(words)); }
  void keep_fields(std::size_t least) {
    const ShownFields before = plan_.fields;
    while (plan_.fields.size() > least && !fits()) plan_.fields.pop_back();
    if (plan_.fields.size() < before.size())
      say("there was no room for these fields: " + names_of_fields(before, plan_.fields.size()) +
          " (sagefe report --field NAME shows them)");
  }
  void keep_states(std::vector<std::size_t> states, const char* words) {
    if (states.empty() || states.size() >= plan_.states.size()) return;
    say(fmt::format("there was no room for all {} states: the page has the {} alone", plan_.states.size(),
                    words));
    plan_.states = std::move(states);
  }

  const PageRun& run_;
  std::size_t room_ = 0;
  Plan plan_;
  std::vector<std::string> omitted_;
};

// Values of one component, one place behind the other.
std::vector<double> at_nodes(const Model& model, const Solution& now, const FieldEntry& field,
                             std::size_t component) {
  const NodeViews views(model, now);
  const std::vector<char> active = active_nodes(model, *now.activity);
  std::vector<double> values(static_cast<std::size_t>(model.mesh.nodes()), NAN), one(field.size());
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    if (active[node] == 0) continue;
    read_field(field, views.at(node), one.data());
    values[node] = one[component];
  }
  return values;
}

// The shown components of a group's points, or the means of its elements; by component.
std::vector<std::vector<double>> at_points(const Model& model, const GroupData& data, const ShownField& field,
                                           bool points) {
  const int count = data.group->element->traits().points, elements = data.group->elements();
  std::vector<std::vector<double>> values(field.components.size());
  std::vector<double> one(field.entry->size());
  for (int e = 0; e < elements; ++e)
    for (int p = 0; p < count; ++p) {
      read_applying(*field.entry, PointState(model.mesh, data, static_cast<std::size_t>(e * count + p)),
                    one.data());
      for (std::size_t c = 0; c < values.size(); ++c) {
        const double value = one[field.components[c]];
        if (points)
          values[c].push_back(value);
        else if (p == 0)
          values[c].push_back(value / count);
        else
          values[c].back() += value / count;
      }
    }
  return values;
}

Json field_json(const Model& model, const ShownField& shown) {
  const FieldEntry& field = *shown.entry;
  constexpr const char* kSigns[] = {"", "compression positive", "along the axes"};
  Json columns = Json::array();
  for (const std::size_t c : shown.components) columns.push_back(field.column(c));
  return {{"name", field.name},
          {"meaning", field.meaning},
          {"unit", clean(unit_text(field.dimension, model.units))},
          {"sign", kSigns[static_cast<std::size_t>(field.sign)]},
          {"place", field.place() == FieldPlace::node ? "node" : "point"},
          {"vector", field.shape == FieldShape::vector && columns.size() == 2},
          {"columns", std::move(columns)},
          {"words", field.words}};
}

// [component] of nodes, or [group][component] of points: null where the group lacks the field or is not there.
Json values_json(const Model& model, const Solution& now, const ShownField& shown, const Plan& plan) {
  const FieldEntry& field = *shown.entry;
  Json all = Json::array();
  if (field.place() == FieldPlace::node) {
    for (const std::size_t c : shown.components)
      all.push_back(packed(at_nodes(model, now, field, c), plan.precision));
    return all;
  }
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    Json group;
    if (now.activity->group[g] != 0 && applies_to_area(model, model.groups[g], field)) {
      group = Json::array();
      for (const std::vector<double>& values : at_points(model, now.groups()[g], shown, plan.points))
        group.push_back(packed(values, plan.precision));
    }
    all.push_back(std::move(group));
  }
  return all;
}

Json state_json(const Model& model, const Frame& frame, const Plan& plan) {
  const Solution now = frame.view();
  const StepReport& step = frame.report();
  Json values = Json::object(), active = Json::array();
  for (const ShownField& field : plan.fields) values[field.entry->name] = values_json(model, now, field, plan);
  for (const char there : now.activity->group) active.push_back(there != 0 ? 1 : 0);
  return {{"stage", step.stage + 1},         {"increment", step.increment}, {"increments", step.increments},
          {"load_factor", step.load_factor}, {"active", std::move(active)}, {"values", std::move(values)}};
}

Json quantities_json(const Model& model) {
  Json list = Json::array();
  for (const std::size_t q : end_quantities(model))
    list.push_back({{"name", kEndQuantities[q]},
                    {"meaning", end_field(q).meaning},
                    {"unit", clean(unit_text(end_field(q).dimension, model.units))}});
  return list;
}

// By group that is there: the quantities of its ends, one end behind the other.
Json ends_json(const Model& model, const Solution& now) {
  Json groups = Json::array();
  const std::vector<std::size_t> quantities = end_quantities(model);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const std::vector<ElementEnd> ends = element_ends(model, now, g);
    if (ends.empty()) continue;
    Json element = Json::array(), end = Json::array(), node = Json::array(), values = Json::array();
    for (const ElementEnd& one : ends) {
      element.push_back(one.element);
      end.push_back(one.end);
      node.push_back(one.node);
    }
    for (const std::size_t q : quantities) {
      std::vector<double> column;
      for (const ElementEnd& one : ends) column.push_back(one.value[q]);
      values.push_back(packed(column, Precision::whole));
    }
    groups.push_back({{"group", g},
                      {"element", std::move(element)},
                      {"end", std::move(end)},
                      {"node", std::move(node)},
                      {"values", std::move(values)}});
  }
  return groups;
}

// Least and largest at every end, of the ends of all stages.
Json envelope_json(const Model& model, const Envelope& envelope) {
  const std::vector<std::size_t> quantities = end_quantities(model);
  Json rows = Json::array();
  for (const EnvelopeEnd& row : envelope.rows()) {
    Json low = Json::array(), high = Json::array();
    for (const std::size_t q : quantities) low.push_back(row.low[q]), high.push_back(row.high[q]);
    rows.push_back({{"group", row.group},
                    {"element", row.element},
                    {"end", row.end},
                    {"low", std::move(low)},
                    {"high", std::move(high)}});
  }
  return rows;
}

}  // namespace

std::vector<std::string> page_fields(const Model& model) {
  std::vector<std::string> names;
  const FieldTable table = fields_of(model);
  for (const FieldEntry& field : table.rows())
    if (shown(model, field) && has_values(model, field)) {
      names.push_back(field.name);
      for (std::size_t c = 0; c < field.size() && field.size() > 1; ++c)
        names.push_back(field.name + "_" + field.components[c].name);
    }
  return names;
}

std::vector<std::string> add_states(const PageRun& run, const PageOptions& options, Json& json) {
  const FieldTable table = fields_of(run.model);
  Planner planner(run, options, fields_to_show(run.model, table, options.fields), json.dump().size());
  const Plan plan = planner.plan(!options.fields.empty());
  Json fields = Json::array(), states = Json::array();
  for (const ShownField& field : plan.fields) fields.push_back(field_json(run.model, field));
  Envelope envelope;
  const std::vector<std::size_t> ends = ends_of_stages(run);
  const bool structures = !end_quantities(run.model).empty();
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const bool wanted = std::ranges::binary_search(plan.states, i);
    const bool of_stage = structures && std::ranges::binary_search(ends, i);
    if (!wanted && !of_stage) continue;
    const Frame frame = run.frame(i);
    const bool open = i + 1 == run.states.size() && (run.goes_on || !run.failure.empty());
    if (of_stage && !open) envelope.add(run.model, frame.report().stage, frame.view());
    if (!wanted) continue;
    states.push_back(state_json(run.model, frame, plan));
    if (structures) states.back()["ends"] = ends_json(run.model, frame.view());
  }
  json["fields"] = std::move(fields);
  json["means"] = !plan.points;
  json["exact"] = plan.precision == Precision::whole;
  json["states"] = std::move(states);
  json["quantities"] = quantities_json(run.model);
  json["envelope"] = envelope_json(run.model, envelope);
  return std::move(planner).omitted();
}

}  // namespace sage::report
