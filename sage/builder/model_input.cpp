#include "sage/builder/model_input.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "sage/exchange/translate.hpp"

namespace sage {

namespace {

using translate::NewField;

double count_of(const auto& list) {
  return static_cast<double>(list.size());
}

class InputCards {
 public:
  InputCards(const ModelInput& input, const Catalogue& catalogue)
      : input_(input), catalogue_(catalogue), from_(empty_deck(input)), out_(from_) {}

  Deck deck();

 private:
  static Deck empty_deck(const ModelInput& input) {
    Deck deck;
    deck.file = input.name;
    deck.layout = "sage1";
    return deck;
  }
  // A card and its line, in which every field has its place.
  int add(const std::string& card, std::vector<NewField> fields, int owner = -1);
  void error(Code code, const std::string& what) { problems_.error(code, {input_.name, 0, 0, 0}, what); }
  // The code of an entry by name, 0 with an error where there is none.
  template <class Table>
  double code_of(Code message, const Table& table, const std::string& name, const std::string& whose);
  double formulation_code(const GroupInput& group, const std::string& whose);

  void add_head();
  void add_material(const MaterialInput& material, int number);
  void add_group(const GroupInput& group, int number);
  void add_elements();
  void add_support(const SupportInput& support, const std::string& card, int owner);
  void add_initial(const InitialInput& initial, const std::string& card, int owner);
  void add_stage(const StageInput& stage, int number);
  void add_report(const ReportInput& report);

  const ModelInput& input_;
  const Catalogue& catalogue_;
  Deck from_;
  translate::CardWriter out_;
  std::string text_;
  int line_ = 0;
  Diagnostics problems_;
};

int InputCards::add(const std::string& card, std::vector<NewField> fields, int owner) {
  constexpr std::size_t kLastColumn = 60000;  // columns are kept in 16 bits
  std::string line = card;
  ++line_;
  for (NewField& field : fields) {
    line += "  " + field.name + ' ';
    const std::size_t begin = line.size();
    line += !field.text.empty()            ? field.text
            : Deck::is_blank(field.number) ? "-"
                                           : fmt::format("{}", field.number);
    field.where = {input_.name, line_, static_cast<int>(std::min(begin + 1, kLastColumn)),
                   static_cast<int>(std::min(line.size(), kLastColumn))};
  }
  // Texts may hold anything, lines end here alone.
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  text_ += line + '\n';
  const SourcePosition where{input_.name, line_, 1, static_cast<int>(std::min(line.size(), kLastColumn))};
  return out_.add(card, where, fields, owner);
}

template <class Table>
double InputCards::code_of(Code message, const Table& table, const std::string& name,
                           const std::string& whose) {
  const int code = table.code_of(name);
  if (code == 0) error(message, whose + " '" + name + "' is unknown; known: " + table.known());
  return code;
}

double InputCards::formulation_code(const GroupInput& group, const std::string& whose) {
  const ElementEntry* entry = catalogue_.elements.find(catalogue_.elements.code_of(group.element));
  if (group.formulation.empty() || entry == nullptr) return 0.0;
  std::string known;
  for (const Formulation& formulation : entry->formulations) {
    if (formulation.name == group.formulation) return formulation.code;
    known += (known.empty() ? "" : ", ") + formulation.name;
  }
  error("S210", whose + " '" + group.formulation + "' of " + group.element + " is unknown; known: " + known);
  return 0.0;
}

void InputCards::add_head() {
  if (!input_.title.empty()) add("title", {{"title", 0.0, {}, input_.title}});
  const UnitSystem& units = input_.units;
  std::vector<NewField> fields;
  for (const auto& [name, unit] :
       {std::pair{"length", units.length}, {"force", units.force}, {"stress", units.stress}})
    if (!unit.empty()) fields.push_back({name, 0.0, {}, unit});
  fields.push_back({"atmospheric_pressure", units.atmospheric_pressure});
  fields.push_back({"water_unit_weight", units.water_unit_weight});
  add("units", fields);
  const double solver =
      input_.solver.empty() ? 0.0 : code_of("S213", catalogue_.solvers, input_.solver, "the solver");
  add("control", {{"geometry", input_.geometry == Geometry::axisymmetric ? 2.0 : 1.0},
                  {"solver", solver},
                  {"strain", input_.large_strain ? 1.0 : 0.0}});
}

void InputCards::add_material(const MaterialInput& material, int number) {
  const std::string whose = fmt::format("material {}: ", number);
  const double code = code_of("S212", catalogue_.materials, material.law, whose + "the law");
  std::vector<NewField> fields{
      {"number", static_cast<double>(number)}, {"law", code}, {"unit_weight", material.unit_weight}};
  if (!material.name.empty()) fields.push_back({"name", 0.0, {}, material.name});
  if (material.saturated_unit_weight != 0.0)
    fields.push_back({"saturated_unit_weight", material.saturated_unit_weight});
  const int card = add("material", fields);
  const MaterialEntry* entry = catalogue_.materials.find(static_cast<int>(code));
  if (entry == nullptr) return;
  std::vector<NewField> values;
  for (const Parameter& parameter : entry->parameters) {
    const auto given = material.parameters.find(parameter.name);
    values.push_back({"values", given == material.parameters.end() ? Deck::blank_number() : given->second});
  }
  while (!values.empty() && Deck::is_blank(values.back().number)) values.pop_back();
  for (const auto& [name, value] : material.parameters) {
    if (entry->find(name) >= 0) continue;
    std::string known;
    for (const Parameter& parameter : entry->parameters) known += (known.empty() ? "" : ", ") + parameter.name;
    error("S223", whose + "parameter '" + name + "' of " + material.law + " is unknown; known: " + known);
  }
  if (!values.empty()) add("parameters", values, card);
}

void InputCards::add_group(const GroupInput& group, int number) {
  const std::string whose = fmt::format("group {}: ", number);
  std::vector<NewField> fields{
      {"number", static_cast<double>(number)},
      {"element", code_of("S211", catalogue_.elements, group.element, whose + "the element")},
      {"formulation", formulation_code(group, whose + "the formulation")},
      {"material", static_cast<double>(group.material)},
      {"overlay", group.overlay ? 1.0 : 0.0}};
  if (group.second_material != 0)
    fields.push_back({"second_material", static_cast<double>(group.second_material)});
  if (!group.name.empty()) fields.push_back({"name", 0.0, {}, group.name});
  add("group", fields);
}

void InputCards::add_elements() {
  int number = 0;
  for (std::size_t g = 0; g < input_.groups.size(); ++g)
    for (const std::vector<int>& nodes : input_.groups[g].elements) {
      std::vector<NewField> fields{{"number", static_cast<double>(++number)},
                                   {"group", static_cast<double>(g + 1)}};
      for (std::size_t n = 0; n < nodes.size(); ++n)
        fields.push_back({fmt::format("n{}", n + 1), static_cast<double>(nodes[n])});
      add("element", fields);
    }
}

void InputCards::add_support(const SupportInput& support, const std::string& card, int owner) {
  const auto code = [](FixityCode held) {
    return held == FixityCode::unchanged ? 0.0 : held == FixityCode::fixed ? 1.0 : -1.0;
  };
  for (const int node : support.nodes) {
    std::vector<NewField> fields{{"first", static_cast<double>(node)},
                                 {"x_code", support.exit ? 2.0 : code(support.x)},
                                 {"y_code", code(support.y)},
                                 {"x_value", support.x_value},
                                 {"y_value", support.y_value}};
    if (!support.unknown.empty()) fields.push_back({"unknown", 0.0, {}, support.unknown});
    if (!support.history.empty()) fields.push_back({"history", 0.0, {}, history_text(support.history)});
    if (support.angle != 0.0) fields.push_back({"angle", support.angle});
    add(card, fields, owner);
  }
}

void InputCards::add_initial(const InitialInput& initial, const std::string& card, int owner) {
  constexpr std::size_t kMostValues = 6;
  if (initial.values.size() > kMostValues)
    error("S236", fmt::format("group {}: {} initial values, at most {} are possible", initial.group,
                              initial.values.size(), kMostValues));
  std::vector<NewField> fields{{"group", static_cast<double>(initial.group)},
                               {"kind", static_cast<double>(initial.kind)}};
  for (std::size_t i = 0; i < initial.values.size(); ++i)
    fields.push_back({fmt::format("v{}", i + 1), initial.values[i]});
  add(card, fields, owner);
}

void InputCards::add_stage(const StageInput& stage, int number) {
  add("stage_title", {{"title", 0.0, {}, stage.title.empty() ? fmt::format("stage {}", number) : stage.title}});
  std::vector<NewField> own{{"increments", static_cast<double>(stage.increments)},
                            {"method", static_cast<double>(stage.method)},
                            {"max_iterations", static_cast<double>(stage.max_iterations)},
                            {"births", count_of(stage.births)},
                            {"deaths", count_of(stage.deaths)},
                            {"gravity_x", stage.gravity.x()},
                            {"gravity_y", stage.gravity.y()},
                            {"tolerance", stage.tolerance},
                            {"duration", stage.duration}};
  if (stage.pores != PoreWater::kept) own.push_back({"pore_water", static_cast<double>(stage.pores)});
  if (stage.theta != 1.0) own.push_back({"theta", stage.theta});
  if (stage.grading != 1.0) own.push_back({"grading", stage.grading});
  for (const auto& [name, value] : {std::pair{"time_error", stage.time_error},
                                    {"end_degree", stage.end_degree},
                                    {"end_pressure", stage.end_pressure}})
    if (value != 0.0) own.push_back({name, value});
  if (!stage.output_times.empty())
    own.push_back({"output_times", 0.0, {}, fmt::format("{}", fmt::join(stage.output_times, " "))});
  if (!stage.load_control.empty()) own.push_back({"load_control", 0.0, {}, stage.load_control});
  const int card = add("stage", own);
  for (const SupportInput& support : stage.supports) add_support(support, "fixity", card);
  for (const LoadInput& load : stage.loads)
    for (const int node : load.nodes) {
      std::vector<NewField> fields{
          {"first", static_cast<double>(node)}, {"x_force", load.x}, {"y_force", load.y}};
      if (!load.unknown.empty()) fields.push_back({"unknown", 0.0, {}, load.unknown});
      if (!load.history.empty()) fields.push_back({"history", 0.0, {}, history_text(load.history)});
      add("load", fields, card);
    }
  for (const PressureInput& pressure : stage.pressures)
    for (const int element : pressure.elements) {
      std::vector<NewField> fields{{"element", static_cast<double>(element)},
                                   {"edge", static_cast<double>(pressure.edge)},
                                   {"normal1", pressure.normal1},
                                   {"normal2", pressure.normal2},
                                   {"shear1", pressure.shear1},
                                   {"shear2", pressure.shear2}};
      if (!pressure.unknown.empty()) fields.push_back({"unknown", 0.0, {}, pressure.unknown});
      if (!pressure.history.empty()) fields.push_back({"history", 0.0, {}, history_text(pressure.history)});
      add("pressure", fields, card);
    }
  for (const auto& [name, groups] : {std::pair{"birth", &stage.births}, {"death", &stage.deaths}}) {
    std::vector<NewField> fields;
    for (const int group : *groups) fields.push_back({"groups", static_cast<double>(group)});
    if (!fields.empty()) add(name, fields, card);
  }
  for (const InitialInput& initial : stage.initials) add_initial(initial, "initial", card);
}

void InputCards::add_report(const ReportInput& report) {
  std::vector<NewField> fields{{"kind", static_cast<double>(report.kind)},
                               {"group", static_cast<double>(report.group)},
                               {"stage", static_cast<double>(report.stage)}};
  const bool placed = report.kind == ReportKind::point || report.kind == ReportKind::section;
  if (!placed) {
    fields.push_back({"height", report.height});
    fields.push_back({"area", report.area});
    fields.push_back({"cell_pressure", report.cell_pressure});
    for (const int node : report.nodes) fields.push_back({"nodes", static_cast<double>(node)});
  }
  const int card = add("report", fields);
  if (!placed) return;
  std::vector<NewField> place{{"x", report.place.x()}, {"y", report.place.y()}};
  if (report.kind == ReportKind::section)
    place.insert(place.end(), {{"end_x", report.end.x()}, {"end_y", report.end.y()}});
  if (!report.name.empty()) place.push_back({"name", 0.0, {}, report.name});
  add("point", place, card);
}

Deck InputCards::deck() {
  add_head();
  int number = 0;
  for (const Vector2& x : input_.nodes)
    add("node", {{"number", static_cast<double>(++number)}, {"x", x.x()}, {"y", x.y()}});
  number = 0;
  for (const MaterialInput& material : input_.materials) add_material(material, ++number);
  number = 0;
  for (const GroupInput& group : input_.groups) add_group(group, ++number);
  add_elements();
  for (const SupportInput& support : input_.supports) add_support(support, "fixity", -1);
  for (const TieInput& tie : input_.ties)
    for (std::size_t i = 0; i < tie.nodes.size(); ++i)
      add("fixity", {{"first", static_cast<double>(tie.nodes[i])},
                     {"x_code", tie.x ? 3.0 : 0.0},
                     {"y_code", tie.y ? 3.0 : 0.0},
                     {"tie", static_cast<double>(tie.to + static_cast<int>(i) * tie.to_step)}});
  for (const InitialInput& initial : input_.initials) add_initial(initial, "initial", -1);
  number = 0;
  for (const StageInput& stage : input_.stages) add_stage(stage, ++number);
  for (const ReportInput& report : input_.reports) add_report(report);
  if (problems_.errors() > 0) throw InputError(problems_);
  Deck deck = out_.take();
  deck.source = SourceText(std::move(text_), input_.name);
  return deck;
}

}  // namespace

Deck make_deck(const ModelInput& input, const Catalogue& catalogue) {
  return InputCards(input, catalogue).deck();
}

Model build_model(const ModelInput& input, const Catalogue& catalogue, const BuildOptions& options) {
  return build_model(make_deck(input, catalogue), catalogue, options);
}

}  // namespace sage
