#include "sage/model_file/keys.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "sage/deck/wide_layout.hpp"

namespace sage::model_file {

namespace {

// What a field becomes that does not keep its name or its kind.
struct Change {
  std::string_view card, field;
  Want want;
  std::string_view key = {};
  std::vector<CodeName> codes = {};
};

const std::vector<CodeName> kHold{{0, "free"}, {1, "fixed"}, {-1, "released"}, {2, "exit"}, {3, "tied"}};
const std::vector<CodeName> kInitial{{0, "uniform"},  {1, "geostatic"}, {2, "zero"},
                                     {3, "traction"}, {4, "history"},   {5, "lock off"},
                                     {6, "material"}, {7, "parameter"}, {8, "at rest"}};

const std::vector<Change>& changes() {
  static const std::vector<Change> list{
      {"control", "geometry", Want::code, {}, {{1, "plane strain"}, {2, "axisymmetric"}}},
      {"control", "solver", Want::solver},
      {"control", "strain", Want::code, {}, {{0, "small"}, {1, "large"}}},
      {"node", "system", Want::code, {}, {{0, "cartesian"}, {1, "polar"}}},
      {"material", "law", Want::law},
      {"group", "element", Want::element},
      {"group", "formulation", Want::formulation},
      {"group", "material", Want::material},
      {"group", "second_material", Want::material},
      {"group", "overlay", Want::flag},
      {"element", "group", Want::group},
      {"element", "n1", Want::nodes, "nodes"},
      {"fixity", "x_code", Want::code, "x", kHold},
      {"fixity", "y_code", Want::code, "y", kHold},
      {"initial", "group", Want::group},
      {"initial", "kind", Want::code, {}, kInitial},
      {"initial", "v1", Want::values, "values"},
      {"initial", "material", Want::material},
      {"stage", "reset_displacements", Want::flag},
      {"stage",
       "method",
       Want::code,
       {},
       {{0, "newton"}, {1, "modified newton"}, {2, "initial stiffness"}, {3, "dogleg"}}},
      {"birth", "groups", Want::groups, "birth"},
      {"death", "groups", Want::groups, "death"},
      {"report",
       "kind",
       Want::code,
       {},
       {{1, "triaxial"}, {2, "nodes"}, {3, "point"}, {4, "discharge"}, {5, "uplift"}, {6, "section"}}},
      {"report", "group", Want::group},
      {"report", "nodes", Want::integers},
      {"water",
       "kind",
       Want::code,
       {},
       {{0, "dry"},
        {1, "line"},
        {2, "ratio"},
        {3, "nodes"},
        {4, "heads"},
        {5, "undrained"},
        {6, "drained"},
        {7, "earlier heads"},
        {8, "drawdown"}}},
      {"water", "group", Want::group},
      {"water", "action", Want::code, {}, {{0, "edges"}, {1, "none"}, {2, "force"}}},
      {"water", "values", Want::pairs},
  };
  return list;
}

// Counts of what a list shows by itself, and the end.
bool is_left_out(std::string_view card, std::string_view field) {
  static const std::map<std::string_view, std::vector<std::string_view>> list{
      {"control",
       {"nodes", "fills", "materials", "groups", "elements", "fixities", "initials", "stages", "reports",
        "waters"}},
      {"material", {"parameters"}},
      {"stage", {"fixities", "loads", "pressures", "births", "deaths", "initials"}},
      {"report", {"listed"}},
      {"water", {"listed"}},
      {"end", {"end"}}};
  const auto found = list.find(card);
  return found != list.end() && std::ranges::find(found->second, field) != found->second.end();
}

// n2 of n1, v3 of v1: one list holds them.
bool goes_on(std::string_view field) {
  return field.size() > 1 && (field[0] == 'n' || field[0] == 'v') && field.substr(1) != "1" &&
         field.substr(1).find_first_not_of("0123456789") == std::string_view::npos;
}

Want want_of(FieldKind kind) {
  return kind == FieldKind::integer ? Want::integer : kind == FieldKind::text ? Want::text : Want::real;
}

void add_keys(const CardRule& card, Table& table) {
  const std::string& name = card.spec.name;
  for (std::size_t i = 0; i < card.spec.fields.size(); ++i) {
    const FieldSpec& field = card.spec.fields[i];
    if (is_left_out(name, field.name) || ((name == "element" || name == "initial") && goes_on(field.name)))
      continue;
    Key key{field.name, field.name, want_of(field.kind), field.required, {}, field.label, field.unit, {}, {}};
    if (field.has_fallback) key.fallback = field.fallback;
    const auto change = std::ranges::find_if(
        changes(), [&](const Change& one) { return one.card == name && one.field == field.name; });
    if (change != changes().end()) {
      if (!change->key.empty()) key.key = change->key;
      key.want = change->want;
      key.codes = change->codes;
    } else {
      key.about = card.rules[i].codes;
    }
    if (key.want == Want::nodes || key.want == Want::values) {
      key.field = field.name.substr(0, 1);
      if (key.label.ends_with(" 1"))
        key.label.replace(key.label.size() - 2, 2, "s");  // "node 1" of the card: nodes
    }
    table.keys.push_back(std::move(key));
  }
}

// Cards and the tables that they go to.
struct Place {
  std::string_view label;  // of the card in its layout
  std::string_view table;
  bool many;
};
constexpr Place kPlaces[] = {
    {"title", "", false},
    {"control", "", false},
    {"units", "units", false},
    {"node", "node", true},
    {"fill", "fill", true},
    {"material", "material", true},
    {"group", "group", true},
    {"element", "element", true},
    {"fixity", "fixity", true},
    {"initial", "initial", true},
    {"stage_title", "stage", true},
    {"stage", "stage", true},
    {"birth", "stage", true},
    {"death", "stage", true},
    {"stage_fixity", "stage.fixity", true},
    {"load", "stage.load", true},
    {"pressure", "stage.pressure", true},
    {"stage_initial", "stage.initial", true},
    {"report", "report", true},
    {"point", "report", true},
    {"water", "water", true},
};

Key drawn(const std::string& key, Want want, const std::string& label, const std::string& unit = {},
          std::vector<CodeName> codes = {}) {
  return {key, {}, want, false, {}, label, unit, {}, std::move(codes)};
}

const std::vector<CodeName> kEnds{{0, "automatic"}, {1, "joined"}, {3, "open"}};

Table table_of_lines() {
  Table line{
      "line", "", "A line of the drawing, such as a boundary, a wall, a lining or an interface.", true, {}};
  line.keys = {
      drawn("name", Want::text, "name of the line"),
      drawn("points", Want::points,
            "points of the line, by name or as [x, y]; of an arc its start and its end"),
      drawn("shape", Want::code, "shape of the line", {}, {{0, "polyline"}, {1, "arc"}, {2, "circle"}}),
      drawn("centre", Want::point, "centre of an arc or a circle"),
      drawn("radius", Want::real, "radius of a circle", "length"),
      drawn("start_angle", Want::real, "angle from the x axis at which a circle begins, counter-clockwise",
            "deg"),
      drawn("clockwise", Want::flag, "direction of an arc or a circle: true = clockwise"),
      drawn("size", Want::real, "edge length of elements along the line", "length"),
      drawn("beam", Want::material, "material of a beam along the line (wall, slab, lining)"),
      drawn("bar", Want::material, "material of bars along the line (geogrid, nail)"),
      drawn("interface", Want::table, "interfaces beside the line, see [line.interface]"),
      drawn("first_end", Want::code,
            "connection of both sides at the first end of an interface, if it is inside the ground", {}, kEnds),
      drawn("last_end", Want::code,
            "connection of both sides at the last end of an interface, if it is inside the ground", {}, kEnds)};
  return line;
}

// What the program draws and meshes by itself: sage/section.
std::vector<Table> drawn_tables() {
  Table mesh{"mesh", "", "How sagefe divides areas into elements.", false, {}};
  mesh.keys = {
      {"element", "element", Want::element, true, {}, "element type of all areas", {}, {}, {}},
      {"formulation", "formulation", Want::formulation, false, {}, "formulation of the elements", {}, {}, {}},
      drawn("size", Want::real, "edge length of elements where no point, line or area gives another", "length"),
      drawn("growth", Want::real,
            "growth of the edge length per unit of distance from a place with smaller elements"),
      drawn("mesher", Want::code, "mesh generator", {}, {{0, "automatic"}, {1, "gmsh"}, {2, "blocks"}})};
  Table points{"points",
               "",
               "Points with names: `A = [x, y]`, or `A = {at = [x, y], size = s}` with the edge length s of "
               "elements at the point.",
               false,
               {}};
  Table interface {
    "line.interface", "", "Interfaces between the structure of a line and the ground, or between two areas.",
        false, {}
  };
  interface.keys = {
      drawn("side", Want::code, "side of the line, seen from its first point to its last", {},
            {{1, "left"}, {2, "right"}, {3, "both"}}),
      drawn("material", Want::material, "material of the interface"),
      drawn("factor", Want::real,
            "in place of a material: cohesion and tan(phi) of the interface, divided by those of the ground"),
      drawn("thickness", Want::real,
            "thickness of a layer of ground with the stiffness of the interface; blank = a tenth of the size "
            "of the line",
            "length")};
  Table area{"area", "", "Ground of one material. It becomes a group with the name of the area.", true, {}};
  area.keys = {drawn("name", Want::text, "name of the area"),
               drawn("outline", Want::points, "points around the area, or names of lines"),
               drawn("holes", Want::outlines, "outlines of the holes in the area"),
               drawn("size", Want::real, "largest edge length of elements in the area", "length"),
               drawn("material", Want::material, "material of the area"),
               drawn("second_material", Want::material,
                     "material of the pore water, for element types that need a second material")};
  Table bar{"bar",
            "",
            "An anchor, strut or spring between two points. It becomes a group with the name of the bar.",
            true,
            {}};
  bar.keys = {
      drawn("name", Want::text, "name of the bar"),
      drawn("from", Want::point, "first point of the bar, a name of [points]"),
      drawn("to", Want::point,
            "second point of the bar, a name of [points]; outside the ground it gets a node of its own"),
      drawn("material", Want::material, "material of the bar"),
      {"element", "element", Want::element, false, {}, "bar2 or spring2; blank = bar2", {}, {}, {}}};
  return {mesh, points, table_of_lines(), interface, area, bar};
}

// Places of the drawing in place of numbers of nodes and elements.
void add_places(std::vector<Table>& list) {
  for (Table& one : list) {
    const bool fixity = one.card == "fixity", load = one.card == "load", report = one.card == "report";
    if (fixity || report)
      one.keys.push_back(
          drawn("line", Want::text, "in place of first and last: name of a line, for all nodes along it"));
    if (fixity || report || load)
      one.keys.push_back(drawn("point", Want::text, "in place of first and last: name of a point"));
    if (report) {
      one.keys.push_back(drawn("from", Want::point, "in place of x and y: first end of the cut of a section"));
      one.keys.push_back(drawn("to", Want::point, "in place of end_x and end_y: second end of the cut"));
    }
    if (one.card != "pressure") continue;
    one.keys.push_back(drawn("line", Want::text,
                             "in place of element and edge: name of a line; normal1 and shear1 act at its "
                             "first point, normal2 and shear2 at its last"));
    one.keys.push_back(
        drawn("side", Want::text,
              "side of the line on which the pressure acts, if there is ground on both sides: left or right"));
  }
}

std::vector<Table> make_tables() {
  const Layout layout = load_layout(std::string(kWideLayout));
  std::vector<Table> list;
  for (const Place& place : kPlaces) {
    const auto card = std::ranges::find(layout.cards, place.label, &CardRule::key);
    if (card == layout.cards.end())
      throw std::logic_error("layout sage1 has no card " + std::string(place.label));
    auto at = std::ranges::find(list, place.table, &Table::key);
    if (at == list.end()) {
      list.push_back({std::string(place.table), card->spec.name, card->about, place.many, {}});
      at = std::prev(list.end());
    }
    add_keys(*card, *at);
  }
  add_places(list);
  for (Table& table : drawn_tables()) list.push_back(std::move(table));
  return list;
}

}  // namespace

const Key* Table::find(std::string_view name) const {
  const auto found = std::ranges::find(keys, name, &Key::key);
  return found == keys.end() ? nullptr : &*found;
}

const std::vector<Table>& tables() {
  static const std::vector<Table> list = make_tables();
  return list;
}

const Table& table(std::string_view key) {
  const auto found = std::ranges::find(tables(), key, &Table::key);
  if (found == tables().end()) throw std::logic_error("no table " + std::string(key));
  return *found;
}

}  // namespace sage::model_file
