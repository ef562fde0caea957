#include <algorithm>

#include "sage/model_file/drawing.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/model_file/values.hpp"

namespace sage {

namespace model_file {

namespace {

// A number of a card, 0 where it has none of this name.
double number_of(const std::vector<NewField>& card, std::string_view name) {
  const auto found = std::ranges::find(card, name, &NewField::name);
  return found == card.end() ? 0.0 : found->number;
}

class Reader {
 public:
  Reader(const Deck& from, const Catalogue& catalogue) : values_(from, catalogue), out_(from) {}

  Deck read(const toml::table& root);

 private:
  // Nodes, elements, materials and groups without a number count on from the last one.
  void count_on(std::vector<NewField>& card, double& last, double more = 1.0);

  void add_head(const toml::table& root);
  void add_nodes(const toml::table& root);
  void add_properties(const toml::table& material, std::vector<NewField>& values);
  void add_materials(const toml::table& root);
  void add_elements(const toml::table& root);
  void add_cards(const toml::table& from, std::string_view key, std::string_view table, int owner = -1);
  void add_stages(const toml::table& root);
  void add_reports(const toml::table& root);

  // Cards of fixities and loads at a point or along a line of the drawing, of pressures along one.
  bool add_at_place(const toml::table& one, const Table& table, int owner);
  void add_along(const toml::table& one, const Table& table, int owner);
  bool is_drawn(const toml::node& place);  // an error where it is not
  void add_initial_tractions(const toml::table& from, int owner = -1);
  void draw(const toml::table& root);
  void add_end(const toml::table& one, const char* key, const char* x, const char* y,
               std::vector<NewField>& place);

  Values values_;
  translate::CardWriter out_;
  double last_material_ = 0.0, last_group_ = 0.0, last_node_ = 0.0, last_element_ = 0.0;
  std::optional<Drawing> drawing_;
};

void Reader::count_on(std::vector<NewField>& card, double& last, double more) {
  const auto given = std::ranges::find(card, "number", &NewField::name);
  const double number = given != card.end() ? given->number : last + 1.0;
  if (given == card.end()) card.insert(card.begin(), {"number", number, {}, {}});
  last = number + more - 1.0;
}

// Title, units, geometry and solver.
void Reader::add_head(const toml::table& root) {
  const Table& head = table("");
  values_.know_keys(root, head);
  std::vector<NewField> all = values_.fields(root, head);
  const auto title = std::ranges::find(all, "title", &NewField::name);
  if (title != all.end()) {
    out_.add("title", title->where, {*title});
    all.erase(title);
  }
  if (const toml::node* node = root.get("units")) {
    if (const toml::table* units = node->as_table()) {
      values_.know_keys(*units, table("units"));
      const std::vector<NewField> card = values_.fields(*units, table("units"));
      for (const NewField& field : card) {
        if (field.name == "length") values_.units.length = field.text;
        if (field.name == "force") values_.units.force = field.text;
        if (field.name == "stress") values_.units.stress = field.text;
      }
      out_.add("units", values_.where(*units), card);
    } else {
      values_.error("S152", values_.where(*node), "units is a table: [units]");
    }
  } else {
    values_.error("S155", {values_.file(), 1, 1, 1},
                  "the model needs [units] with its length, force and stress");
  }
  out_.add("control", values_.where(root), all);
  const toml::node* plugins = root.get("plugins");
  if (plugins == nullptr) return;
  if (const toml::array* names = plugins->as_array())
    for (const toml::node& name : *names)
      out_.add("plugin", values_.where(name),
               {{"name", 0.0, values_.where(name), name.value_or(std::string("-"))}});
}

void Reader::add_nodes(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "node")) {
    values_.know_keys(*one, table("node"));
    std::vector<NewField> card = values_.fields(*one, table("node"));
    count_on(card, last_node_);
    out_.add("node", values_.where(*one), card);
  }
  add_cards(root, "fill", "fill");
}

// What a law has behind its parameters: props = [0.2, 0.05].
void Reader::add_properties(const toml::table& material, std::vector<NewField>& values) {
  const toml::node* node = material.get("props");
  if (node == nullptr) return;
  const toml::array* list = node->as_array();
  if (list == nullptr)
    return values_.error("S152", values_.where(*node), "props is a list of numbers: props = [0.2, 0.05]");
  for (const toml::node& one : *list)
    values.push_back({"values", values_.number(one, "props", ""), values_.where(one), {}});
}

void Reader::add_materials(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "material")) {
    std::vector<NewField> card = values_.fields(*one, table("material"));
    count_on(card, last_material_);
    const auto law = std::ranges::find(card, "law", &NewField::name);
    const MaterialEntry* entry =
        law == card.end() ? nullptr : values_.catalogue.materials.find(static_cast<int>(law->number));
    const int owner = out_.add("material", values_.where(*one), card);
    if (entry == nullptr) continue;  // the law is missing or unknown: its parameters can't be told
    values_.know_keys(*one, table("material"), entry);
    std::map<std::string, double>& given = values_.parameters[static_cast<int>(last_material_)];
    std::vector<NewField> values;
    for (const Parameter& parameter : entry->parameters) {
      const toml::node* node = one->get(parameter.name);
      const std::string unit = unit_text(parameter.dimension, values_.units);
      values.push_back({"values",
                        node != nullptr ? values_.number(*node, parameter.name, unit) : Deck::blank_number(),
                        node != nullptr ? values_.where(*node) : values_.where(*one),
                        {}});
    }
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!Deck::is_blank(values[i].number)) given[entry->parameters[i].name] = values[i].number;
    if (entry->open_ended) add_properties(*one, values);
    while (!values.empty() && Deck::is_blank(values.back().number)) values.pop_back();
    if (!values.empty()) out_.add("parameters", values.front().where, values, owner);
  }
  for (const toml::table* one : values_.entries(root, "group")) {
    values_.know_keys(*one, table("group"));
    std::vector<NewField> card = values_.fields(*one, table("group"));
    count_on(card, last_group_);
    out_.add("group", values_.where(*one), card);
  }
}

void Reader::add_elements(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "element")) {
    values_.know_keys(*one, table("element"));
    std::vector<NewField> card = values_.fields(*one, table("element"));
    double made = 1.0;
    for (const NewField& field : card)
      if (field.name == "columns" || field.name == "rows") made *= std::max(1.0, field.number);
    count_on(card, last_element_, made);
    out_.add("element", values_.where(*one), card);
  }
}

void Reader::add_cards(const toml::table& from, std::string_view key, std::string_view of, int owner) {
  for (const toml::table* one : values_.entries(from, key)) {
    const Table& cards = table(of);
    values_.know_keys(*one, cards);
    if (cards.card == "pressure" && one->contains("line"))
      add_along(*one, cards, owner);
    else if (!add_at_place(*one, cards, owner))
      out_.add(cards.card, values_.where(*one), values_.fields(*one, cards), owner);
  }
}

// Joints take the traction of the ground beside them where that has initial stresses.
void Reader::add_initial_tractions(const toml::table& from, int owner) {
  if (!drawing_) return;
  const Table& initial = table("initial");
  for (const toml::table* one : values_.entries(from, "initial")) {
    const std::vector<NewField> card = values_.fields(*one, initial);
    if (number_of(card, "kind") > 1.0) continue;
    const double group = number_of(card, "group");
    for (const int joint : drawing_->joints_beside(static_cast<int>(group)))
      out_.add("initial", values_.where(*one),
               {{"group", static_cast<double>(joint), {}, {}}, {"kind", 3.0, {}, {}}, {"v1", group, {}, {}}},
               owner);
  }
}

bool Reader::is_drawn(const toml::node& place) {
  if (!drawing_)
    values_.error("S153", values_.where(place), "points and lines need a drawing: [mesh], [points], [[area]]");
  return drawing_.has_value();
}

// False: its nodes are given by their numbers.
bool Reader::add_at_place(const toml::table& one, const Table& cards, int owner) {
  const toml::node* point = cards.find("point") != nullptr ? one.get("point") : nullptr;
  const toml::node* line = cards.find("line") != nullptr ? one.get("line") : nullptr;
  if (point == nullptr && line == nullptr) return false;
  const toml::node& place = point != nullptr ? *point : *line;
  if (!is_drawn(place)) return true;
  std::vector<int> nodes = point != nullptr ? drawing_->nodes_at(place) : drawing_->nodes_along(place);
  if (const toml::node* unknown = one.get("unknown"); unknown != nullptr && !nodes.empty()) {
    const std::string name = unknown->value_or(std::string());
    nodes = drawing_->with_unknown(std::move(nodes), name);
    if (nodes.empty())
      values_.error("S235", values_.where(*unknown),
                    "no element at this place of the drawing has the unknown " + name);
  }
  std::vector<NewField> card = values_.fields(one, cards, {"first", "last", "step"});
  card.insert(card.begin(), {"first", 0.0, values_.where(place), {}});
  for (const int node : nodes) {
    card.front().number = node;
    out_.add(cards.card, values_.where(one), card, owner);
    if (cards.card == "load") break;  // one force on one place
  }
  return true;
}

// Pressure and shear change in proportion to the way along the line, from the values 1 at its first point to the values 2
// at its last one.
void Reader::add_along(const toml::table& one, const Table& cards, int owner) {
  const toml::node& line = *one.get("line");
  if (!is_drawn(line)) return;
  const std::vector<NewField> given = values_.fields(one, cards, {"element", "edge", "last", "step"});
  for (const DrawnEdge& edge : drawing_->edges_along(line, one.get("side"))) {
    std::vector<NewField> card{{"element", static_cast<double>(edge.element), values_.where(line), {}},
                               {"edge", static_cast<double>(edge.edge), values_.where(line), {}}};
    for (const char* kind : {"normal", "shear"}) {
      const double first = number_of(given, std::string(kind) + "1"),
                   last = number_of(given, std::string(kind) + "2");
      card.push_back({std::string(kind) + "1", first + edge.first * (last - first), values_.where(one), {}});
      card.push_back({std::string(kind) + "2", first + edge.last * (last - first), values_.where(one), {}});
    }
    out_.add("pressure", values_.where(one), card, owner);
  }
}

void Reader::draw(const toml::table& root) {
  if (!Drawing::is_drawn(root)) return;
  drawing_.emplace(values_, out_, static_cast<int>(last_material_), static_cast<int>(last_group_),
                   static_cast<int>(last_node_), static_cast<int>(last_element_));
  drawing_->add(root);
}

void Reader::add_stages(const toml::table& root) {
  int number = 0;
  for (const toml::table* one : values_.entries(root, "stage")) {
    const Table& stage = table("stage");
    values_.know_keys(*one, stage);
    const toml::node* title = one->get("title");
    std::vector<NewField> name;
    if (title != nullptr) values_.add_value(*stage.find("title"), *one, *title, name);
    if (name.empty())
      name.push_back({"title", 0.0, values_.where(*one), "stage " + std::to_string(number + 1)});
    ++number;
    out_.add("stage_title", values_.where(*one), name);
    const int owner =
        out_.add("stage", values_.where(*one), values_.fields(*one, stage, {"title", "birth", "death"}));
    for (const char* key : {"fixity", "load", "pressure"})
      add_cards(*one, key, std::string("stage.") + key, owner);
    for (const char* key : {"birth", "death"}) {
      const toml::node* node = one->get(key);
      std::vector<NewField> groups;
      if (node != nullptr) values_.add_value(*stage.find(key), *one, *node, groups);
      if (!groups.empty()) out_.add(key, values_.where(*node), groups, owner);
    }
    add_cards(*one, "initial", "stage.initial", owner);
    add_initial_tractions(*one, owner);
  }
}

// An end of a cut: [x, y], or a point of the drawing.
void Reader::add_end(const toml::table& one, const char* key, const char* x, const char* y,
                     std::vector<NewField>& place) {
  const toml::node* end = one.get(key);
  if (end == nullptr) return;
  if (one.contains(x) || one.contains(y))
    values_.error("S152", values_.where(*end),
                  std::string("give ") + key + ", or " + x + " and " + y + ", but not both");
  const toml::array* list = end->as_array();
  if (list == nullptr) {
    if (!is_drawn(*end)) return;
    if (const std::optional<Vector2> at = drawing_->point_at(*end)) {
      place.push_back({x, at->x(), values_.where(*end), {}});
      place.push_back({y, at->y(), values_.where(*end), {}});
    }
    return;
  }
  if (list->size() != 2) {
    values_.error("S152", values_.where(*end), std::string(key) + " is [x, y], or the name of a point");
    return;
  }
  place.push_back({x, values_.number(*list->get(0), key, "length"), values_.where(*end), {}});
  place.push_back({y, values_.number(*list->get(1), key, "length"), values_.where(*end), {}});
}

void Reader::add_reports(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "report")) {
    const Table& report = table("report");
    values_.know_keys(*one, report);
    std::vector<NewField> card = values_.fields(*one, report, {"x", "y", "name", "end_x", "end_y", "nodes"});
    if (const toml::node* nodes = one->get("nodes"))
      values_.add_value(*report.find("nodes"), *one, *nodes, card);
    for (const char* key : {"line", "point"}) {
      const toml::node* place = one->get(key);
      if (place == nullptr || !is_drawn(*place)) continue;
      for (const int node : key[0] == 'l' ? drawing_->nodes_along(*place) : drawing_->nodes_at(*place))
        card.push_back({"nodes", static_cast<double>(node), values_.where(*place), {}});
    }
    const int owner = out_.add("report", values_.where(*one), card);
    std::vector<NewField> place;
    for (const char* key : {"x", "y", "name", "end_x", "end_y"})
      if (const toml::node* node = one->get(key)) values_.add_value(*report.find(key), *one, *node, place);
    add_end(*one, "from", "x", "y", place);
    add_end(*one, "to", "end_x", "end_y", place);
    if (!place.empty()) out_.add("point", values_.where(*one), place, owner);
  }
}

Deck Reader::read(const toml::table& root) {
  values_.list_names(root, values_.materials);
  values_.list_names(root, values_.groups);
  add_head(root);
  add_nodes(root);
  add_materials(root);
  add_elements(root);
  draw(root);
  add_cards(root, "fixity", "fixity");
  add_cards(root, "initial", "initial");
  add_initial_tractions(root);
  add_stages(root);
  add_reports(root);
  add_cards(root, "water", "water");
  if (values_.problems.errors() > 0) throw InputError(values_.problems);
  return out_.take();
}

}  // namespace
}  // namespace model_file

Deck model_file_deck(const Deck& as_read, const Catalogue& catalogue) {
  const std::string& text = *as_read.source.text();
  try {
    const toml::table root = toml::parse(std::string_view(text), as_read.file);
    return model_file::Reader(as_read, catalogue).read(root);
  } catch (const toml::parse_error& broken) {
    const toml::source_position at = broken.source().begin;
    const int column = static_cast<int>(std::min<unsigned>(at.column, 60000));
    Diagnostics problems;
    problems.add(card_diagnostic(as_read, Severity::error, "S150",
                                 {as_read.file, static_cast<int>(at.line), column, column},
                                 "this is no TOML: " + std::string(broken.description())));
    throw InputError(std::move(problems));
  }
}

}  // namespace sage
