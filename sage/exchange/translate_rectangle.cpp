// Decks whose mesh is a rectangle numbered by rule (Smith and Griffiths): nodes, elements, supports, and the
// stages of two programs that go ways of their own.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "sage/exchange/rectangle.hpp"
#include "sage/exchange/translate_body.hpp"

namespace sage::translate {

namespace {

constexpr int kMostCells = 5'000'000;

struct Source : Body {
  Rectangle mesh;
};

// `intervals`: of the card with this name.
std::vector<double> coordinates(const Source& s, std::string_view name, std::string_view field,
                                std::string_view intervals) {
  const CardView card = s.deck.one(name);
  std::vector<double> at;
  for (const FieldValue& value : card.list(field)) at.push_back(value.number);
  const auto wanted = static_cast<std::size_t>(s.card.integer(intervals)) + 1;
  if (at.size() != wanted)
    refuse(s, card, field,
           std::to_string(wanted) + " coordinates " + std::string(field) + " are needed, one more than " +
               std::string(intervals) + ", and the card has " + std::to_string(at.size()));
  for (std::size_t i = 1; i < at.size(); ++i)
    if (!((at[i] > at[i - 1]) == (at[1] > at[0]) && at[i] != at[i - 1]))
      refuse(s, card, field, "the coordinates " + std::string(field) + " must rise or fall all along");
  return at;
}

// Codes of the layouts; where a program has one kind of mesh only, its cards leave them out.
void read_mesh(Source& s) {
  const CardView& card = s.card;
  const std::int64_t cells = static_cast<std::int64_t>(card.integer("columns")) * card.integer("rows");
  if (card.integer("columns") < 1 || card.integer("rows") < 1 || cells > kMostCells)
    refuse(s, card, "columns", "the mesh needs columns and rows of 1 or more, at most 5000000 cells");
  s.mesh.triangles = card.integer("shape", 2) == 1;
  s.mesh.nodes_per_element = card.integer("nodes_per_element", s.flows() ? 4 : 8);
  s.mesh.along_x = card.integer("direction", s.consolidates() ? 1 : 2) == 1;
  s.axisymmetric = card.integer("geometry", s.deck.one("material_values").blank("consolidation") ? 1 : 2) == 2;
  if (s.mesh.intervals() == 0)
    refuse(s, card, "nodes_per_element",
           "no element with " + std::to_string(s.mesh.nodes_per_element) +
               " nodes: triangles have 3, 6 or 15, quadrilaterals 4, 8 or 9");
  s.mesh.x = coordinates(s, "rectangle_x", "x", "columns");
  s.mesh.y = coordinates(s, "rectangle_y", "y", "rows");
}

void number_mesh(Source& s) {
  const Rectangle& mesh = s.mesh;
  const int k = mesh.intervals();
  const SourcePosition where = s.deck.one("rectangle_y").where("y");
  for (int j = 0; j <= k * mesh.rows(); ++j)
    for (int i = 0; i <= k * mesh.columns(); ++i)
      if (mesh.exists(i, j)) s.nodes.push_back({mesh.number(i, j), mesh.position(i, j), where});
  for (int e = 0; e < mesh.elements(); ++e) s.elements.push_back({mesh.nodes(e), s.card.where()});
  s.triangles = mesh.triangles;
  s.nodes_per_element = mesh.nodes_per_element;
}

// Material of each element; one program lists them row by row although it counts along y.
std::vector<int> materials_by_place(const Source& s) {
  std::vector<int> listed = element_materials(s);
  if (s.card.blank("footing")) return listed;
  std::vector<int> of_element(listed.size());
  for (std::size_t e = 0; e < of_element.size(); ++e) {
    const auto [column, row] = s.mesh.cell_place(s.mesh.cell(static_cast<int>(e)));
    of_element[e] = listed[row * s.mesh.columns() + column];
  }
  return of_element;
}

// Only corners have a pressure; codes of other nodes mean nothing.
void add_fixities_with_pressures(const Source& s, CardWriter& out) {
  std::set<int> corners;
  for (int j = 0; j <= s.mesh.rows(); ++j)
    for (int i = 0; i <= s.mesh.columns(); ++i)
      corners.insert(s.mesh.number(i * s.mesh.intervals(), j * s.mesh.intervals()));
  for (const CardView& card : s.deck.all("fixity")) {
    if (card.integer("x_code") == 1 || card.integer("y_code") == 1)
      out.add("fixity", card.where(), {take(card, "first"), take(card, "x_code"), take(card, "y_code")});
    if (card.integer("pressure_code") == 1 && corners.contains(card.integer("first")))
      out.add("fixity", card.where(),
              {take(card, "first"),
               take(card, "pressure_code", "x_code"),
               {"y_code", 0.0},
               {"unknown", 0.0, {}, "excess_pressure"}});
  }
}

// Programs without restraint cards hold both sides against x and the bottom altogether.
void add_fixities(const Source& s, CardWriter& out) {
  if (s.deck.has("restraints")) {
    if (s.consolidates()) return add_fixities_with_pressures(s, out);
    return out.copy("fixity");
  }
  const int k = s.mesh.intervals(), right = k * s.mesh.columns(), bottom = k * s.mesh.rows();
  for (int j = 0; j <= bottom; ++j)
    for (int i = 0; i <= right; ++i) {
      if (!s.mesh.exists(i, j) || (i != 0 && i != right && j != bottom)) continue;
      out.add("fixity", s.card.where(),
              {{"first", static_cast<double>(s.mesh.number(i, j))},
               {"x_code", 1.0},
               {"y_code", j == bottom ? 1.0 : 0.0}});
    }
}

int add_stage(const Source& s, CardWriter& out, const std::string& title, int increments,
              double gravity = 0.0) {
  out.add("stage_title", s.card.where(), {{"title", 0.0, {}, title}});
  return out.add("stage", s.card.where(),
                 {{"increments", static_cast<double>(increments)}, {"gravity_y", gravity}});
}

void add_displacement(CardWriter& out, const NewField& node, bool along_x, double value, int stage) {
  out.add("fixity", node.where,
          {node,
           {"x_code", along_x ? 1.0 : 0.0},
           {"y_code", along_x ? 0.0 : 1.0},
           {"x_value", along_x ? value : 0.0},
           {"y_value", along_x ? 0.0 : value}},
          stage);
}

// A pressure on a row of elements' outer edges: the first row, or the last column.
void add_pressure(const Source& s, CardWriter& out, bool top, double pressure, int stage) {
  const bool turned = (s.mesh.x[1] > s.mesh.x[0]) == (s.mesh.y[1] > s.mesh.y[0]);
  for (int e = 0; e < s.mesh.elements(); ++e) {
    const auto [column, row] = s.mesh.cell_place(e);
    if (top ? row != 0 : column != s.mesh.columns() - 1) continue;
    out.add("pressure", s.card.where(),
            {{"element", e + 1.0},
             {"edge", top != turned ? 3.0 : 2.0},
             {"normal1", pressure},
             {"normal2", pressure}},
            stage);
  }
}

void add_report(const Source& s, CardWriter& out, std::vector<NewField> fields, const std::vector<int>& nodes) {
  for (int node : nodes) fields.push_back({"nodes", static_cast<double>(node)});
  out.add("report", s.card.where(), fields);
}

// Program 6.3: weight and surcharge first, elastic; then the rigid, smooth footing goes down.
void add_footing(const Source& s, CardWriter& out) {
  int stage = add_stage(s, out, "weight and surcharge", 1, -1.0);
  add_pressure(s, out, true, s.deck.one("surcharge").real("pressure"), stage);
  const CardView steps = s.deck.one("increments");
  const int increments = std::max(1, steps.integer("increments"));
  stage = add_stage(s, out, "footing", increments);
  std::vector<int> nodes;
  const int footing = s.card.integer("footing");
  if (footing < 1 || footing > s.mesh.columns())
    refuse(s, s.card, "footing",
           "the footing must cover 1 to " + std::to_string(s.mesh.columns()) + " columns");
  for (int i = 0; i <= 2 * footing; ++i) nodes.push_back(s.mesh.number(i, 0));
  for (int node : nodes)
    add_displacement(out, {"first", static_cast<double>(node), steps.where("displacement")}, false,
                     increments * steps.real("displacement"), stage);
  add_report(s, out, {{"kind", 2.0}, {"stage", 2.0}}, nodes);
}

// Undrained: the force of the moved nodes, and what soil and water bear in the middle of the first element.
void add_undrained_reports(const Source& s, CardWriter& out, const std::vector<int>& nodes) {
  add_report(s, out, {{"kind", 2.0}, {"stage", 2.0}}, nodes);
  const double x = 0.5 * (s.mesh.x[0] + s.mesh.x[1]), y = 0.5 * (s.mesh.y[0] + s.mesh.y[1]);
  const double soils = static_cast<double>(s.deck.all("material_values").size());
  for (const double group : {1.0, soils + 1.0}) {
    const int report = out.add("report", s.card.where(), {{"kind", 3.0}, {"group", group}, {"stage", 2.0}});
    out.add("point", s.card.where(),
            {{"x", x}, {"y", y}, {"name", 0.0, {}, group == 1.0 ? "soil" : "pore water"}}, report);
  }
}

// Program 6.11: consolidated under the cell pressure, then the listed nodes are displaced.
void add_triaxial(const Source& s, CardWriter& out) {
  const double cell = -s.deck.one("material_values").real("consolidation");
  int stage = add_stage(s, out, "consolidation", 1);
  out.add("initial", s.card.where(), {{"group", 1.0}, {"kind", 0.0}, {"v1", cell}, {"v2", cell}, {"v3", cell}},
          stage);
  add_pressure(s, out, true, cell, stage);
  add_pressure(s, out, false, cell, stage);
  const CardView steps = s.deck.one("iteration");
  const int increments = std::max(1, steps.integer("increments"));
  stage = add_stage(s, out, "compression", increments);
  std::vector<int> nodes;
  for (const CardView& card : s.deck.all("displacement")) {
    nodes.push_back(card.integer("first"));
    add_displacement(out, take(card, "first"), card.integer("direction") == 1,
                     increments * steps.real("displacement"), stage);
  }
  if (s.deck.one("material_values").real("bulk_modulus") > 0.0) return add_undrained_reports(s, out, nodes);
  const double height = std::abs(s.mesh.y.back() - s.mesh.y.front());
  add_report(s, out,
             {{"kind", 1.0}, {"group", 1.0}, {"stage", 2.0}, {"height", height}, {"cell_pressure", cell}},
             nodes);
}

// Program 7.2: heads and wells of steady seepage.
void add_flow(const Source& s, CardWriter& out) {
  const double circle = s.axisymmetric ? 2.0 * std::numbers::pi : 1.0;
  const NewField head{"unknown", 0.0, {}, "head"}, none{"y_code", 0.0};
  const int stage = add_stage(s, out, "steady flow", 1);
  for (const CardView& card : s.deck.all("head"))
    out.add("fixity", card.where(),
            {take(card, "first"), {"x_code", 1.0}, none, take(card, "head", "x_value"), head}, stage);
  for (const CardView& card : s.deck.all("inflow"))
    out.add("load", card.where(),
            {take(card, "first"), take(card, "inflow", "x_force", circle), {"y_force", 0.0}, head}, stage);
}

// Stages between the points of the load function, in steps of one length.
class LoadFunction {
 public:
  LoadFunction(const Source& s, CardWriter& out) : s_(s), out_(out), times_(s.deck.one("times")) {}

  void add() {
    const double dt = times_.real("time_step"), end = dt * times_.integer("steps");
    if (!(dt > 0.0 && end > 0.0)) refuse(s_, times_, "time_step", "steps and their length must be above 0");
    double time = 0.0, factor = 0.0;
    for (const CardView& point : s_.deck.all("load_time")) {
      const double to = std::min(point.real("time"), end);
      if (!(to >= time)) refuse(s_, point, "time", "the times of the load function must rise");
      const double share = point.real("time") > time ? (to - time) / (point.real("time") - time) : 1.0;
      const double reached = factor + share * (point.real("factor") - factor);
      if (to == time && reached != factor) refuse(s_, point, "time", "the load function must not jump");
      add_part(point, steps_in(point, to - time), reached - factor);
      time = to;
      factor = reached;
    }
    add_part(times_, steps_in(times_, end - time), 0.0);
  }

 private:
  int steps_in(const CardView& card, double duration) const {
    const double steps = duration / times_.real("time_step");
    if (std::abs(steps - std::round(steps)) > 1e-6 * std::max(1.0, steps))
      refuse(s_, card, card.spec().name == "times" ? "time_step" : "time",
             "the points of the load function must stand at the ends of steps");
    return static_cast<int>(std::round(steps));
  }
  void add_part(const CardView& card, int steps, double factor) {
    if (steps == 0) return;
    out_.add("stage_title", card.where(), {{"title", 0.0, {}, factor != 0.0 ? "loading" : "consolidation"}});
    const int stage = out_.add("stage", card.where(),
                               {{"increments", static_cast<double>(steps)},
                                {"output_every", static_cast<double>(times_.integer("print_every"))},
                                {"duration", steps * times_.real("time_step")},
                                {"pore_water", 2.0},
                                {"theta", times_.real("theta")}});
    if (factor == 0.0) return;
    for (const CardView& load : s_.deck.all("load"))
      out_.add("load", load.where(),
               {take(load, "first"), take(load, "x_force", {}, factor), take(load, "y_force", {}, factor)},
               stage);
  }

  const Source& s_;
  CardWriter& out_;
  CardView times_;
};

// Programs 9.4 and 9.6: loads that follow a function of time.
void add_consolidation(const Source& s, CardWriter& out) {
  if (s.deck.has("cell")) {
    const double cell = -s.deck.one("cell").real("stress");
    const int stage = add_stage(s, out, "cell pressure", 1);
    for (std::size_t group = 1; group <= s.deck.all("material_values").size(); ++group)
      out.add("initial", s.card.where(),
              {{"group", static_cast<double>(group)}, {"kind", 0.0}, {"v1", cell}, {"v2", cell}, {"v3", cell}},
              stage);
    add_pressure(s, out, true, cell, stage);
    add_pressure(s, out, false, cell, stage);
  }
  LoadFunction(s, out).add();
  if (const int node = s.deck.one("times").integer("print_node"); node > 0)
    add_report(s, out, {{"kind", 2.0}, {"stage", 1.0}}, {node});
}

}  // namespace

Deck rectangle_deck(const Deck& deck, const Catalogue& catalogue) {
  Source s{{deck, catalogue, deck.one("rectangle")}, {}};
  if (!s.card.blank("harmonic"))
    refuse(
        s, s.card, "harmonic",
        "a body of revolution under a harmonic load has three displacements a node: no model is built from it");
  read_mesh(s);
  number_mesh(s);
  CardWriter out(deck);
  add_body(s, materials_by_place(s), "mesh numbered by rule", out);
  if (s.flows()) {
    add_flow(s, out);
    return out.take();
  }
  add_fixities(s, out);
  if (s.consolidates()) {
    add_consolidation(s, out);
    return out.take();
  }
  if (!s.card.blank("footing"))
    add_footing(s, out);
  else if (!deck.one("material_values").blank("consolidation"))
    add_triaxial(s, out);
  else
    add_loading(s, out);
  return out.take();
}

}  // namespace sage::translate
