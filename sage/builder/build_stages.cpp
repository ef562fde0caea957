// Fixities, loads, initial stress and stages.
#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <numbers>
#include <optional>
#include <sstream>

#include "sage/builder/builder.hpp"
#include "sage/core/time_scheme.hpp"
#include "sage/math/rounding.hpp"
#include "sage/messages/parse_number.hpp"

namespace sage::builder {

namespace {

FixityCode fixity_code(Builder& b, const CardView& card, std::string_view field) {
  const int code = card.integer(field);
  if (code == 0) return FixityCode::unchanged;
  if (code == 1) return FixityCode::fixed;
  if (code == -1) return FixityCode::released;
  b.error("S210", card.where(field),
          "code " + std::to_string(code) + " is unknown; 0 unchanged, 1 fixed, -1 released");
  return FixityCode::unchanged;
}

}  // namespace

// Nodes first, first+step ... last.
std::vector<int> node_range(Builder& b, const CardView& card) {
  const NumberRange range = b.range(card, "first");
  std::vector<int> nodes;
  for (std::int64_t number = range.first; number <= range.last; number += range.step) {
    const int node = b.node(card, number == range.first ? "first" : "last", number);
    if (node < 0) return {};
    nodes.push_back(node);
  }
  return nodes;
}

namespace {

// Which field of unknowns a card is about: 0 = displacement, -1 after an error.
int read_unknown(Builder& b, const CardView& card) {
  if (card.blank("unknown")) return 0;
  const std::string name = b.text(card, "unknown");
  const int field = find_unknown(b.model.unknowns, name);
  if (field >= 0 || !b.groups_known) return field;
  std::string known;
  for (const UnknownField& unknown : b.model.unknowns) known += (known.empty() ? "" : ", ") + unknown.name;
  b.error("S235", card.where("unknown"), "no element of the deck solves for " + name + "; it has: " + known);
  return field;
}

// The fields of a card that belong to the second component of a displacement.
void require_one_component(Builder& b, const CardView& card, std::initializer_list<const char*> fields) {
  for (const char* field : fields)
    if (card.real(field) != 0.0)
      b.error("S235", card.where(field),
              "the " + card.label(field) + " must be blank: " + b.text(card, "unknown") +
                  " is one number a node, in the columns of x");
}

// False: no element gives the node that field, which is an error.
bool has_unknown(Builder& b, const CardView& card, int node, int field) {
  if (b.dof_map.of(node, field) >= 0) return true;
  b.error("S235", card.where("unknown"),
          "node " + std::to_string(b.model.mesh.number[node]) + " has no " + b.model.unknowns[field].name +
              ": no element there solves for it");
  return false;
}

// Numbers of a text with blanks between; nothing where a word is none.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  for (std::string word; words >> word;) {
    const std::optional<double> number = parse_number<double>(word);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

constexpr std::size_t kColumnsOfText = 80;

// The times of a table that has rows.
bool ascends_from_zero(const TimeTable& table) {
  const auto falls = [](const auto& one, const auto& next) { return !(one.first < next.first); };
  return !(table.front().first < 0.0) && std::ranges::adjacent_find(table, falls) == table.end();
}

// Of a displacement, a force or an edge load.  duration: of the stage of the card; 0 = it is on no card of a stage.
void check_mechanical_table(Builder& b, const CardView& card, const TimeTable& table, bool legible,
                            double duration) {
  const auto error = [&](const std::string& text) { b.error("S591", card.where("history"), text); };
  if (duration <= 0.0)
    error("a table of time belongs on a load, pressure or fixity card of a stage");
  else if (!legible)
    error("a table of time is pairs of a time and a factor, with blanks between, of 80 characters at most");
  else if (!ascends_from_zero(table))
    error("the times of a table count from the start of the stage and must ascend");
  else if (table.back().first > duration)
    error("the last time of the table, " + rounded_text(table.back().first, 6) +
          ", is behind the end of the stage, whose duration is " + rounded_text(duration, 6));
  else if (table.front().first == 0.0 && table.front().second != 0.0)
    error("the factor at time 0 must be 0: what acts at once belongs in a stage before");
}

// field: of unknowns, 0 = displacement.
TimeTable read_history_of_time(Builder& b, const CardView& card, int field, double duration) {
  if (card.blank("history")) return {};
  const std::string text = b.text(card, "history");
  const std::optional<std::vector<double>> numbers = numbers_of(text);
  TimeTable table;
  for (std::size_t i = 0; numbers && i + 1 < numbers->size(); i += 2)
    table.emplace_back((*numbers)[i], (*numbers)[i + 1]);
  if (field == 0)
    check_mechanical_table(
        b, card, table, numbers && numbers->size() % 2 == 0 && !table.empty() && text.size() <= kColumnsOfText,
        duration);
  else if (!b.model.unknowns[field].of_pores)
    b.error("S579", card.where("history"),
            "a history is for displacements, forces, stresses on edges and the unknown excess_pressure");
  else if (!numbers || numbers->size() % 2 != 0 || table.empty() || text.size() > kColumnsOfText)
    b.error("S579", card.where("history"),
            "a history is pairs of a time and a share, with blanks between, of 80 characters at most");
  else if (!ascends_from_zero(table))
    b.error("S579", card.where("history"),
            "the times of a history count from the start of the stage and must ascend");
  return table;
}

void read_field_fixity(Builder& b, const CardView& card, int field, const Fixity& fixity,
                       std::vector<FieldFixity>& out) {
  require_one_component(b, card, {"y_code", "y_value"});
  const TimeTable history = read_history_of_time(b, card, field, 0.0);
  for (int node : node_range(b, card)) {
    if (!has_unknown(b, card, node, field)) return;
    out.push_back({field, node, fixity.code[0], fixity.value[0], fixity.line, history});
  }
}

// Code 2 of a head: an exit.  False: the card is about something else.
bool read_exit(Builder& b, const CardView& card, int field, std::vector<Exit>* out) {
  constexpr int kExit = 2;
  if (card.integer("x_code") != kExit || field == 0) return false;
  const UnknownField& unknown = b.model.unknowns[field];
  if (unknown.name != "head" && !unknown.of_pores) return false;
  if (out == nullptr) {
    b.error("S233", card.where("x_code"), "an exit of water (code 2) belongs on a fixity card of a stage");
    return true;
  }
  require_one_component(b, card, {"y_code", "y_value"});
  const double pressure_head = card.real("x_value");
  b.usable(card, "x_value", pressure_head);
  for (const int node : node_range(b, card)) {
    if (!has_unknown(b, card, node, field)) return true;
    out->push_back({node, pressure_head, card.card().line, unknown.of_pores ? field : -1});
  }
  return true;
}

// The codes of x are those along the line, the codes of y those normal to it.  By quarters of a turn the one becomes the other.
void read_turned_fixity(Builder& b, const CardView& card, int field, Fixity fixity, std::vector<Fixity>& out,
                        std::vector<TurnedFixity>& out_turned) {
  constexpr double kQuarter = 90.0;
  const double angle = card.real("angle");
  if (!b.usable(card, "angle", angle)) return;
  if (std::abs(angle) > 360.0)
    return b.error("S367", card.where("angle"), "the angle of a support must lie between -360 and 360 degrees");
  if (field > 0)
    return b.error("S367", card.where("angle"),
                   "an angle is for supports of displacements; the field " + b.text(card, "unknown") +
                       " has no direction");
  if (!card.blank("history"))
    return b.error("S367", card.where("history"),
                   "a support with an angle can't follow a table of time; give its displacements by stages");
  const double quarters = std::floor(angle / kQuarter);
  for (int i = 0; i < static_cast<int>(quarters) + 4; ++i) {
    fixity.code = {fixity.code[1], fixity.code[0]};
    fixity.value = {0.0 - fixity.value[1], fixity.value[0]};
  }
  const double rest = angle - kQuarter * quarters;
  for (const int node : node_range(b, card)) {
    fixity.node = node;
    if (rest == 0.0)
      out.push_back(fixity);
    else
      out_turned.push_back({fixity, rest});
  }
}

// Code 3 in x, y or both: the nodes move as others do.
constexpr int kTied = 3;

// Only where the layout has the field: elsewhere the code is unknown.
bool ties(const CardView& card) {
  const bool can = std::ranges::find(card.spec().fields, "tie", &FieldSpec::name) != card.spec().fields.end();
  return can && (card.integer("x_code") == kTied || card.integer("y_code") == kTied || !card.blank("tie") ||
                 !card.blank("tie_step"));
}

void read_tie(Builder& b, const CardView& card, bool in_stage) {
  const auto error = [&](std::string_view field, const std::string& text) {
    b.error("S370", card.where(field), text);
  };
  if (in_stage) return error("tie", "a tie holds in every stage: its card belongs before the stages");
  if (card.blank("tie"))
    return error("tie", "a tie (code 3) needs the number of the node to which the first node is tied");
  Tie tie;
  tie.line = card.card().line;
  const char* const codes[] = {"x_code", "y_code"};
  for (std::size_t c = 0; c < 2; ++c) {
    const int code = card.integer(codes[c]);
    if (code != 0 && code != kTied) return error(codes[c], "a card with a tie has codes 0 and 3 (tied) alone");
    tie.component[c] = code == kTied ? 1 : 0;
  }
  if (!tie.component[0] && !tie.component[1])
    return error("x_code", "the tie needs code 3 in x, in y or in both");
  for (const char* field : {"x_value", "y_value", "angle"})
    if (card.real(field) != 0.0) return error(field, "the " + card.label(field) + " of a tie must be blank");
  for (const char* field : {"unknown", "history"})
    if (!card.blank(field)) return error(field, "the " + card.label(field) + " of a tie must be blank");
  std::int64_t to = card.integer("tie");
  for (const int node : node_range(b, card)) {
    tie.node = node;
    tie.to = b.node(card, "tie", to);
    if (tie.to < 0) return;
    to += card.integer("tie_step");
    if (tie.node != tie.to) b.model.ties.push_back(tie);
  }
}

// exits: of a stage; nullptr before the first.  duration: of the stage, else 0.
void read_fixity(Builder& b, const CardView& card, std::vector<Exit>* exits, double duration,
                 std::vector<Fixity>& out, std::vector<TurnedFixity>& out_turned,
                 std::vector<FieldFixity>& out_fields) {
  const bool in_stage = exits != nullptr;
  if (ties(card)) return read_tie(b, card, in_stage);
  const int field = read_unknown(b, card);
  if (field < 0 || read_exit(b, card, field, exits)) return;
  Fixity fixity;
  fixity.code = {fixity_code(b, card, "x_code"), fixity_code(b, card, "y_code")};
  fixity.value = {card.real("x_value"), card.real("y_value")};
  fixity.line = card.card().line;
  const char* const codes[] = {"x_code", "y_code"};
  const char* const values[] = {"x_value", "y_value"};
  for (std::size_t c = 0; c < 2; ++c) {
    b.usable(card, values[c], fixity.value[c]);
    const bool own_value = b.model.unknowns[field].of_pores;
    if (in_stage && !own_value && fixity.code[c] == FixityCode::fixed && card.blank(values[c]))
      b.note("S234", card.where(values[c]),
             "the " + card.label(values[c]) + " is left blank: held where it is" +
                 (field > 0 ? "" : ", displacement 0"));
    if (fixity.value[c] == 0.0) continue;
    if (!in_stage)
      b.error("S233", card.where(values[c]),
              std::string(field > 0 ? "a value" : "a displacement") +
                  " other than zero belongs on a fixity card of a stage");
    else if (const int code = card.integer(codes[c]); code == 0 || code == -1)
      b.error(
          "S233", card.where(codes[c]),
          std::string(field > 0 ? "a value" : "a displacement") + " is given but the code is not 1 (fixed)");
  }
  if (fixity.code[0] == FixityCode::unchanged && fixity.code[1] == FixityCode::unchanged)
    b.note("S234", card.where(),
           std::string("this fixity card changes nothing: ") +
               (field > 0 ? "its code is" : "both its codes are") + " 0 or blank");
  for (std::size_t c = 0; c < 2; ++c)
    if (!in_stage && fixity.code[c] == FixityCode::released)
      b.error("S233", card.where(codes[c]), "only a stage can release a fixity (code -1)");
  if (card.real("angle") != 0.0) return read_turned_fixity(b, card, field, fixity, out, out_turned);
  if (field > 0) return read_field_fixity(b, card, field, fixity, out_fields);
  fixity.history = read_history_of_time(b, card, field, duration);
  for (int node : node_range(b, card)) {
    fixity.node = node;
    out.push_back(fixity);
  }
}

}  // namespace

void read_load(Builder& b, const CardView& card, std::vector<NodalLoad>& out,
               std::vector<FieldLoad>& out_fields, double duration) {
  const int field = read_unknown(b, card);
  if (field < 0) return;
  NodalLoad load{0, {card.real("x_force"), card.real("y_force")}, card.card().line};
  b.usable(card, "x_force", load.force.x());
  b.usable(card, "y_force", load.force.y());
  if (field > 0) {
    require_one_component(b, card, {"y_force"});
    const TimeTable history = read_history_of_time(b, card, field, duration);
    for (int node : node_range(b, card)) {
      if (!has_unknown(b, card, node, field)) return;
      out_fields.push_back({field, node, load.force.x(), load.line, history});
    }
    return;
  }
  load.history = read_history_of_time(b, card, field, duration);
  for (int node : node_range(b, card)) {
    load.node = node;
    out.push_back(load);
  }
}

void read_pressure(Builder& b, const CardView& card, std::vector<EdgeLoad>& out) {
  EdgeLoad load;
  load.normal = {card.real("normal1"), card.real("normal2")};
  load.shear = {card.real("shear1"), card.real("shear2")};
  for (const char* name : {"normal1", "normal2", "shear1", "shear2"}) b.usable(card, name, card.real(name));
  const int edge = card.integer("edge") - 1;
  load.line = card.card().line;
  const NumberRange range = b.range(card, "element");
  for (std::int64_t number = range.first; number <= range.last; number += range.step) {
    const ElementPlace* place = b.element_place.find(static_cast<int>(number));
    if (place == nullptr) {
      if (b.elements_known)
        b.error("S202", card.where(number == range.first ? "element" : "last"),
                "element " + std::to_string(number) + " is not defined by any element card");
      return;
    }
    const Group& group = b.model.groups[place->group];
    const int folded = place->folded;
    // Edges count as the element's card lists its nodes.
    const int edges = static_cast<int>(group.element->edges().size()) + (folded >= 0 ? 1 : 0);
    if (edge < 0 || edge >= edges || edge == folded) {
      const std::string numbers =
          edge == folded && edge >= 0
              ? " has no such edge: both of its nodes are the same, the quadrilateral is a triangle"
          : edges == 0 ? std::string(" has no edges")
                       : " has edges 1 to " + std::to_string(edges);
      b.error("S230", card.where("edge"),
              "edge " + std::to_string(edge + 1) + ": element " + std::to_string(number) + " (" +
                  group.element_name + ")" + numbers);
      return;
    }
    if (group.flow() && !load.shear.isZero(0.0)) {
      b.error("S230", card.where("shear1"),
              "element " + std::to_string(number) + " (" + group.element_name +
                  ") takes an inflow through its edge, in the columns of the pressure, and no shear");
      return;
    }
    load.edge = folded >= 0 && edge > folded ? edge - 1 : edge;
    load.group = place->group;
    load.element = place->element;
    out.push_back(load);
  }
}

namespace {

// Shares of what a flow has brought in: its own shares over the time, each interval with the mean of both ends.
TimeTable sum_over_time(const TimeTable& flow, double duration) {
  TimeTable sum{{0.0, 0.0}};
  const auto go_to = [&](double time) {
    const double from = sum.back().first;
    if (time > from)
      sum.emplace_back(time,
                       sum.back().second + 0.5 * (time - from) * (share_at(flow, from) + share_at(flow, time)));
  };
  for (const auto& [time, share] : flow) go_to(std::min(time, duration));
  go_to(duration);
  return sum;
}

// What an inflow of q1 to q2 per area along an edge is at its two corners, where pressures are linear.
std::array<double, 2> inflow_at_corners(const Model& model, const Group& group, int element, int edge,
                                        const Vector2& q) {
  const std::vector<int>& local = group.element->edges()[edge];
  const auto at = [&](int i) -> Vector2 { return model.mesh.x.col(group.nodes_of(element)[i]); };
  const Vector2 first = at(local[0]), last = at(local[1]);
  const int middle = middle_of(local);
  const Vector2 bend = middle < 0 ? Vector2(Vector2::Zero()) : Vector2(at(middle) - 0.5 * (first + last));
  std::array<double, 2> sums{};
  for (const auto& [s, weight] :
       {std::pair{-std::sqrt(0.6), 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {std::sqrt(0.6), 5.0 / 9.0}}) {
    const std::array<double, 2> N{0.5 * (1.0 - s), 0.5 * (1.0 + s)};
    const Vector2 place = N[0] * first + N[1] * last + (1.0 - s * s) * bend;
    const double length = (0.5 * (last - first) - 2.0 * s * bend).norm();
    const double measure = model.geometry == Geometry::axisymmetric ? 2.0 * kPi * place.x() : 1.0;
    for (std::size_t i = 0; i < 2; ++i)
      sums[i] += weight * measure * length * N[i] * (N[0] * q[0] + N[1] * q[1]);
  }
  return sums;
}

// An edge of soil with pore water takes an inflow in place of a pressure: loads on its corners.
void add_inflow(Builder& b, const CardView& card, const EdgeLoad& edge, int field, Stage& stage) {
  const Group& group = b.model.groups[edge.group];
  const int element = group.element_numbers[edge.element];
  if (!group.solid() || !group.entry->has_pores() || !edge.shear.isZero(0.0))
    return b.error(
        "S230", card.where("unknown"),
        "element " + std::to_string(element) + " (" + group.element_name +
            "): an inflow of pore water, without shear, is for edges of solids that solve for its pressure");
  const TimeTable flow = read_history_of_time(b, card, field, stage.duration);
  const std::array<double, 2> inflow = inflow_at_corners(b.model, group, edge.element, edge.edge, edge.normal);
  const std::vector<int>& local = group.element->edges()[edge.edge];
  for (std::size_t i = 0; i < 2; ++i) {
    const int node = group.nodes_of(edge.element)[local[i]];
    const double value = -inflow[i] * (flow.empty() ? stage.duration : 1.0);
    stage.field_loads.push_back(
        {field, node, value, edge.line, flow.empty() ? flow : sum_over_time(flow, stage.duration)});
  }
}

// Loads of these edges are found from their sums at both ends of a stage.
void refuse_table_on_followed_edge(Builder& b, const CardView& card, const EdgeLoad& load) {
  if (b.model.large_strain || b.model.groups[load.group].structure())
    b.error("S591", card.where("history"),
            std::string("a pressure on ") +
                (b.model.large_strain ? "an edge at large strains" : "a structure") +
                " cannot follow a table; divide the stage where its rate changes");
}

// A pressure, or an inflow of pore water in its columns.
void read_edge_action(Builder& b, const CardView& card, Stage& stage) {
  const int field = read_unknown(b, card);
  if (field < 0) return;
  if (field == 0) {
    const std::size_t before = stage.pressures.size();
    read_pressure(b, card, stage.pressures);
    const TimeTable history = read_history_of_time(b, card, field, stage.duration);
    for (std::size_t i = before; i < stage.pressures.size(); ++i) stage.pressures[i].history = history;
    if (!history.empty() && before < stage.pressures.size())
      refuse_table_on_followed_edge(b, card, stage.pressures[before]);
    return;
  }
  if (!b.model.unknowns[field].of_pores)
    return b.error("S230", card.where("unknown"),
                   "what acts on an edge is a pressure (blank) or an inflow of pore water (excess_pressure)");
  std::vector<EdgeLoad> edges;
  read_pressure(b, card, edges);
  for (const EdgeLoad& edge : edges) add_inflow(b, card, edge, field, stage);
}

// Values of an initial card that mean something; those of a history stand apart.
int values_of(InitialKind kind, const Group* group) {
  const bool known = group != nullptr && group->element;
  if (kind == InitialKind::uniform) return known ? group->entry->law_size : 4;
  if (kind == InitialKind::geostatic || kind == InitialKind::at_rest) return 4;
  if (kind == InitialKind::parameter) return 4;
  const bool one =
      kind == InitialKind::traction || kind == InitialKind::lock_off || kind == InitialKind::material;
  return one ? 1 : kind == InitialKind::history ? 6 : 0;
}

// A value that nothing reads is mostly one that was meant for something.
void note_unused_values(Builder& b, const CardView& card, InitialKind kind, const Group* group) {
  std::string unused;
  for (int i = values_of(kind, group) + 1; i <= 6; ++i)
    if (card.real("v" + std::to_string(i)) != 0.0)
      unused += (unused.empty() ? "" : ", ") + card.label("v" + std::to_string(i));
  if (unused.empty()) return;
  b.note("S237", card.where(),
         "not used of this initial stress card: " + unused +
             (kind == InitialKind::uniform && group != nullptr && group->element
                  ? "; " + group->entry->name + " has " + std::to_string(values_of(kind, group)) +
                        (values_of(kind, group) == 1 ? " component" : " components") + " of stress"
                  : std::string()));
}

// Values that this kind of initial stress takes and the card leaves blank.
void note_blank_stresses(Builder& b, const CardView& card, InitialKind kind, const Group* known) {
  const bool line = known != nullptr && known->element && !known->solid();
  const int components = line ? known->entry->law_size : 3;  // of a solid xy is mostly zero
  const int values = kind == InitialKind::uniform ? components : kind == InitialKind::geostatic ? 3 : 0;
  std::string blank;
  if (card.blank("kind")) blank = "kind (0, uniform)";
  for (int i = 1; i <= values; ++i)
    if (card.blank("v" + std::to_string(i)))
      blank += (blank.empty() ? "" : ", ") + std::string("value ") + std::to_string(i);
  if (!blank.empty())
    b.note("S237", card.where(), "left blank on this initial stress card, which reads as 0: " + blank);
}

// Quantities that a card of InitialKind::history states, by their places in the law's history.
std::vector<std::size_t> stated_quantities(const InitialStress& initial) {
  std::vector<std::size_t> places;
  for (std::size_t i = 1; i < initial.value.size(); ++i)
    if (!std::isnan(initial.value[i])) places.push_back(static_cast<std::size_t>(initial.value[0]) + i - 2);
  return places;
}

std::string known_quantities(std::span<const Quantity> quantities) {
  std::string text;
  for (std::size_t i = 0; i < quantities.size(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(i + 1) + " " + std::string(quantities[i].name);
  return text.empty() ? "has no history" : "has the history " + text;
}

// False, and an error, where the law of a group lacks what the card states, or another card states it too.
bool fits_history(Builder& b, const CardView& card, const InitialStress& initial,
                  const std::vector<InitialStress>& before) {
  const Group& group = b.model.groups[initial.group];
  const Material& material = b.model.material_of(group);
  const std::string name = "group " + std::to_string(group.number);
  const std::span<const Quantity> quantities = history_of(material.law_ref());
  const auto first = static_cast<std::size_t>(initial.value[0]) - 1;
  for (const std::size_t place : stated_quantities(initial)) {
    const std::string field = "v" + std::to_string(place - first + 2);
    if (place >= quantities.size()) {
      b.error("S236", card.where(field),
              name + ": " + material.law_name + " " + known_quantities(quantities) + ": there is no quantity " +
                  std::to_string(place + 1));
      return false;
    }
    for (const InitialStress& other : before) {
      if (other.group != initial.group || other.kind != InitialKind::history) continue;
      const std::vector<std::size_t> stated = stated_quantities(other);
      if (std::find(stated.begin(), stated.end(), place) == stated.end()) continue;
      b.error("S236", card.where(field),
              name + ": the card in line " + std::to_string(other.where.line) + " states its " +
                  std::string(quantities[place].name) + " already");
      return false;
    }
  }
  return true;
}

// Blank values become NaN.  False, and an error, without a number of the first quantity or without values.
bool read_history(Builder& b, const CardView& card, InitialStress& initial) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double first = initial.value[0];
  if (!(first >= 1.0 && first <= 1e6 && first == std::floor(first))) {
    b.error("S236", card.where("v1"),
            "value 1 of a history card (kind 4) is the number of the first quantity that it states, 1 or more; "
            "`sagefe list materials` counts them");
    return false;
  }
  for (std::size_t i = 1; i < initial.value.size(); ++i)
    if (card.blank("v" + std::to_string(i + 1))) initial.value[i] = kNone;
  if (!stated_quantities(initial).empty()) return true;
  b.error("S236", card.where("v2"), "a history card (kind 4) states at least one value, from value 2 on");
  return false;
}

// Blank or 0: K0 by Jaky from the law's angle of friction, OCR 1.  False, and an error, where a value is impossible.
bool read_at_rest(Builder& b, const CardView& card, const Group& group, InitialStress& initial) {
  double &K0 = initial.value[0], &ocr = initial.value[1], &pop = initial.value[2];
  const auto reject = [&](const char* field, const std::string& wanted) {
    b.error("S236", card.where(field),
            "group " + std::to_string(group.number) + ", earth pressure at rest: " + wanted);
    return false;
  };
  if (group.element && !group.solid()) return reject("kind", "kind 8 is for solids; interfaces take kind 3");
  if (ocr == 0.0) ocr = 1.0;
  if (!(ocr >= 1.0)) return reject("v2", "OCR (value 2) is 1 or more");
  if (!(pop >= 0.0)) return reject("v3", "POP (value 3) is a stress of 0 or more");
  if (K0 == 0.0 && b.materials_known) {
    const std::optional<double> angle = b.model.material_of(group).parameter(ParameterRole::friction_angle);
    if (!angle || !(*angle > 0.0))
      return reject("v1",
                    "K0 of normally consolidated soil (value 1) is blank and the law has no angle of friction "
                    "to find it from (1 - sin phi)");
    K0 = 1.0 - std::sin(*angle * std::numbers::pi / 180.0);
  }
  if (b.materials_known && !(K0 > 0.0 && K0 <= 1.0))
    return reject("v1",
                  "K0 of normally consolidated soil (value 1) is above 0 and at most 1; OCR or POP raise it");
  return true;
}

void read_initial(Builder& b, const CardView& card, bool in_stage, std::vector<InitialStress>& out) {
  InitialStress initial;
  initial.where = card.where();
  const int kind = card.integer("kind");
  const int number = card.integer("group");
  if (kind < 0 || kind > 8) {
    b.error(
        "S210", card.where("kind"),
        "initial stress kind " + std::to_string(kind) +
            " is unknown; 0 uniform, 1 geostatic, 2 zero, 3 traction of the neighbours, 4 history of the law, "
            "5 lock-off, 6 another material, 7 a parameter that grows with depth or stress, 8 at rest");
    return;
  }
  initial.kind = static_cast<InitialKind>(kind);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string field = "v" + std::to_string(i + 1);
    initial.value[i] = card.real(field);
    b.usable(card, field, initial.value[i]);
  }
  if (initial.kind == InitialKind::history && !read_history(b, card, initial)) return;
  const auto first = b.group_index.find(number);
  const Group* const group = first == b.group_index.end() ? nullptr : &b.model.groups[first->second];
  note_blank_stresses(b, card, initial.kind, group);
  note_unused_values(b, card, initial.kind, group);
  bool found = false;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    if (b.model.groups[g].number != number) continue;
    found = true;
    if (initial.kind == InitialKind::traction && b.model.groups[g].element && !b.model.groups[g].interface())
      b.error("S236", card.where("kind"), "kind 3 (traction of the neighbours) is for interface groups");
    if (b.model.groups[g].element && b.model.groups[g].flow())
      b.error("S236", card.where("group"),
              "elements of flow start without a card: their heads follow from those that are held");
    if (initial.kind == InitialKind::geostatic && b.model.groups[g].element && b.model.groups[g].structure())
      b.error("S236", card.where("kind"), "kind 1 (geostatic) is for solids; structures take kind 0 or 2");
    initial.group = static_cast<int>(g);
    if (initial.kind == InitialKind::at_rest && !read_at_rest(b, card, b.model.groups[g], initial)) return;
    const bool of_law = is_about_law(initial.kind) || initial.kind == InitialKind::lock_off;
    if (of_law && !read_law_card(b, card, in_stage, initial, out)) return;
    if (initial.kind == InitialKind::history && b.materials_known && b.model.groups[g].element &&
        !fits_history(b, card, initial, out))
      return;
    out.push_back(initial);
  }
  if (!found) b.group_missing(card.where("group"), number);
}

// An interface can take the traction of a group only if that group's stress is stated.
void check_traction(Builder& b, const CardView& card) {
  if (card.integer("kind") != static_cast<int>(InitialKind::traction)) return;
  const int wanted = card.integer("v1");
  const auto stated = [&](const std::vector<InitialStress>& list) {
    return std::ranges::any_of(list, [&](const InitialStress& initial) {
      const Group& group = b.model.groups[initial.group];
      return (states_stress(initial.kind) || initial.kind == InitialKind::zero) && group.number == wanted &&
             group.element && group.solid();
    });
  };
  if (stated(b.model.initials)) return;
  for (const Stage& stage : b.model.stages) {
    if (stated(stage.initials)) return;
    if (stage.where.line > card.card().line) break;  // its soil comes later
  }
  if (b.groups_known)
    b.error("S236", card.where("v1"),
            "group " + std::to_string(wanted) +
                ", whose traction the interface should take, has no initial card of its own "
                "or is no solid");
}

void read_groups(Builder& b, const CardView& card, bool death, std::vector<int>& out) {
  for (const FieldValue& value : card.list("groups")) {
    bool found = false;
    const auto same = [&](int g) { return static_cast<double>(b.model.groups[g].number) == value.number; };
    if (death && std::any_of(out.begin(), out.end(), same)) {
      b.note("S239", card.where(value),
             "group " + std::to_string(static_cast<int>(value.number)) +
                 " is listed twice among the deaths of this stage");
      continue;
    }
    for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
      if (static_cast<double>(b.model.groups[g].number) != value.number) continue;
      found = true;
      out.push_back(static_cast<int>(g));
    }
    if (!found) b.group_missing(card.where(value), static_cast<int>(std::clamp(value.number, -2e9, 2e9)));
  }
}

// What pore water does, and how its time is divided.
void read_pores(Builder& b, const CardView& card, Stage& stage) {
  const int code = card.integer("pore_water");
  if (code < 0 || code > 2)
    b.error(
        "S361", card.where("pore_water"),
        "code " + std::to_string(code) + " is unknown; 0 excess pressures stay, 1 undrained, 2 consolidation");
  else
    stage.pores = static_cast<PoreWater>(code);
  if (code != 0 && b.groups_known && !b.model.has_pores())
    b.error("S361", card.where("pore_water"),
            "no element of the deck solves for the pressure of pore water; quad8p4, quad9p4 and tri6p3 do");
  if (card.real("theta") != 0.0) stage.theta = card.real("theta");
  if (b.usable(card, "theta", stage.theta) && !(stage.theta >= 0.5 && stage.theta <= 1.0))
    b.error("S362", card.where("theta"), "theta must lie between 0.5 and 1 (blank = 1)");
  if (card.real("grading") != 0.0) stage.grading = card.real("grading");
  if (b.usable(card, "grading", stage.grading) && !(stage.grading >= 0.01 && stage.grading <= 100.0))
    b.error("S362", card.where("grading"),
            "an increment over the one before must lie between 0.01 and 100 (blank = 1)");
}

// Times of the text "0.5 2 10", ascending; an error where it is none.
std::vector<double> read_times(Builder& b, const CardView& card, double duration) {
  const std::string text = b.text(card, "output_times");
  std::vector<double> times = numbers_of(text).value_or(std::vector{-1.0});
  std::ranges::sort(times);
  const auto is_outside = [&](double time) { return !(time > 0.0 && time <= duration * (1.0 + 1e-12)); };
  if (std::ranges::any_of(times, is_outside)) {
    b.error("S579", card.where("output_times"),
            "output times are numbers above 0 and at most the duration of the stage, with blanks between");
    return {};
  }
  for (double& time : times) time = std::min(time, duration);
  if (text.size() > kColumnsOfText)
    b.error("S579", card.where("output_times"), "the output times of a stage have more than 80 characters");
  return times;
}

// Times within a stage at which a table of time changes its slope.  Those of pore water count where steps are chosen by their
// error.
std::vector<double> corners_of_tables(const Stage& stage) {
  std::vector<double> times;
  const auto add = [&](const auto& cards) {
    for (const auto& card : cards)
      for (const auto& [time, share] : card.history)
        if (time > 0.0 && time < stage.duration) times.push_back(time);
  };
  add(stage.fixities);
  add(stage.loads);
  add(stage.pressures);
  if (stage.time_error == 0.0) return times;
  add(stage.field_fixities);
  add(stage.field_loads);
  return times;
}

// Each output time and each corner of a table is the end of an increment, besides those of the card.
void divide_at_times(Stage& stage) {
  constexpr double kSame = rounding::kText;
  std::vector<double> all = corners_of_tables(stage);
  all.insert(all.begin(), stage.output_times.begin(), stage.output_times.end());
  if (all.empty() || stage.increments < 1 || !(stage.grading > 0.0)) return;
  const GradedIncrements graded(stage.grading);
  std::vector<double> ends;
  for (int i = 1; i <= stage.increments; ++i) ends.push_back(graded.load_factor(0, i, stage.increments));
  const auto known = [&](double end) {
    return std::ranges::any_of(ends, [&](double one) { return std::abs(one - end) <= kSame * end; });
  };
  for (const double time : all)
    if (!known(time / stage.duration)) ends.push_back(time / stage.duration);
  std::ranges::sort(ends);
  stage.divisions = stage.increments;
  stage.increments = static_cast<int>(ends.size());
  for (const double time : stage.output_times) {
    const auto at = std::ranges::find_if(
        ends, [&](double one) { return std::abs(one - time / stage.duration) <= kSame * one; });
    stage.output_at.push_back(static_cast<int>(at - ends.begin()) + 1);
  }
  stage.output_at.erase(std::unique(stage.output_at.begin(), stage.output_at.end()), stage.output_at.end());
  stage.ends = std::move(ends);
}

// Steps and end of a stage of consolidation, beside its increments and its time.
void read_time_steps(Builder& b, const CardView& card, Stage& stage) {
  const auto share = [&](const char* field, double most, const std::string& range) {
    const double value = card.real(field);
    if (b.usable(card, field, value) && !(value >= 0.0 && value < most))
      b.error("S579", card.where(field), "the " + card.label(field) + " must lie between 0 and " + range);
    if (value != 0.0 && stage.pores != PoreWater::flows)
      b.error("S579", card.where(field), "it needs a stage of consolidation (pore_water 2)");
    return value;
  };
  stage.time_error = share("time_error", 0.5, "0.5");
  stage.end_degree = share("end_degree", 1.0, "1");
  stage.end_pressure = share("end_pressure", std::numeric_limits<double>::max(), "the largest number");
  const auto of_pores = [](const Exit& exit) { return exit.field >= 0; };
  const auto has_exits = [&](const Stage& one) { return std::ranges::any_of(one.exits, of_pores); };
  if (stage.time_error > 0.0 && (has_exits(stage) || std::ranges::any_of(b.model.stages, has_exits)))
    b.error("S579", card.where("time_error"),
            "steps cannot be chosen by their error where water leaves through exits (code 2)");
  if (stage.time_error > 0.0 && stage.theta != 1.0)
    b.error("S579", card.where("theta"),
            "theta must be blank where steps are chosen by their error: their method has its own");
  stage.output_times = read_times(b, card, stage.duration);
  divide_at_times(stage);
}

// What grows over a stage must not be cut short.
void check_early_end(Builder& b, const CardView& card, const Stage& stage) {
  if (!stage.may_end_early()) return;
  const auto moves = [](const Fixity& f) {
    return f.value[0] != 0.0 || f.value[1] != 0.0 || std::ranges::count(f.code, FixityCode::released) > 0;
  };
  const auto changes = [](const FieldFixity& f) { return f.value != 0.0; };
  if (stage.loads.empty() && stage.field_loads.empty() && stage.pressures.empty() && stage.births.empty() &&
      stage.deaths.empty() && stage.gravity.isZero(0.0) && std::ranges::none_of(stage.fixities, moves) &&
      std::ranges::none_of(stage.turned_fixities, moves) && std::ranges::none_of(stage.field_fixities, changes))
    return;
  b.error("S579", card.where(stage.end_degree > 0.0 ? "end_degree" : "end_pressure"),
          "a stage that ends by degree or pressure must not change loads, supports or groups, since these "
          "changes take the whole duration; make them in the stage before");
}

Stage read_stage(Builder& b, const CardView& card, int number) {
  Stage stage;
  stage.number = number;
  stage.where = card.where();
  stage.increments = card.integer("increments", 1) == 0 ? 1 : card.integer("increments", 1);
  if (stage.increments < 0 || stage.increments > 10'000'000)
    b.error("S238", card.where("increments"), "the number of increments must be between 1 and 10000000");
  if (card.real("duration") != 0.0) stage.duration = card.real("duration");
  if (b.usable(card, "duration", stage.duration) && !(stage.duration > 0.0))
    b.error("S238", card.where("duration"), "the duration of a stage must not be negative (blank = 1)");
  read_pores(b, card, stage);
  const int method = card.integer("method");
  if (method < 0 || method > 3)
    b.error("S210", card.where("method"),
            "method " + std::to_string(method) +
                " is unknown; 0 Newton, 1 modified Newton, 2 initial stiffness, 3 dogleg");
  else
    stage.method = static_cast<Method>(method);
  if (card.integer("max_iterations") != 0) stage.max_iterations = card.integer("max_iterations");
  if (stage.max_iterations < 1)
    b.error("S207", card.where("max_iterations"), "the number of iterations must not be negative");
  stage.output_every = card.integer("output_every");
  if (stage.output_every < 0)
    b.error("S207", card.where("output_every"), "the output interval must not be negative");
  stage.gravity = {card.real("gravity_x"), card.real("gravity_y")};
  b.usable(card, "gravity_x", stage.gravity.x());
  b.usable(card, "gravity_y", stage.gravity.y());
  if (card.real("tolerance") != 0.0) stage.tolerance = card.real("tolerance");
  if (!(stage.tolerance > 0.0 && stage.tolerance < 1.0))
    b.error("S238", card.where("tolerance"), "the tolerance must lie between 0 and 1 (blank = 1e-8)");
  stage.strength_factor = card.real("strength_factor");
  if (b.usable(card, "strength_factor", stage.strength_factor) && stage.strength_factor < 0.0)
    b.error("S207", card.where("strength_factor"),
            "the strength factor of a stage must not be negative (blank = none)");
  const int reset = card.integer("reset_displacements");
  stage.resets_displacements = reset == 1;
  if (reset != 0 && reset != 1)
    b.error(
        "S210", card.where("reset_displacements"),
        "code " + std::to_string(reset) + " is unknown; 0 displacements go on, 1 they count from this stage");
  for (const CardView& c : b.deck.all("fixity", card))
    read_fixity(b, c, &stage.exits, stage.duration, stage.fixities, stage.turned_fixities,
                stage.field_fixities);
  for (const CardView& c : b.deck.all("load", card))
    read_load(b, c, stage.loads, stage.field_loads, stage.duration);
  for (const CardView& c : b.deck.all("pressure", card)) read_edge_action(b, c, stage);
  for (const CardView& c : b.deck.all("edge_load", card)) read_edge_load(b, c, stage.pressures, stage.loads);
  for (const CardView& c : b.deck.all("birth", card)) read_groups(b, c, false, stage.births);
  for (const CardView& c : b.deck.all("death", card)) read_groups(b, c, true, stage.deaths);
  for (const CardView& c : b.deck.all("initial", card)) read_initial(b, c, true, stage.initials);
  for (const CardView& c : b.deck.all("removal", card))
    if (const auto found = b.removed.find(c.index()); found != b.removed.end())
      stage.deaths.insert(stage.deaths.end(), found->second.begin(), found->second.end());
  read_time_steps(b, card, stage);
  check_early_end(b, card, stage);
  read_control(b, card, stage);
  return stage;
}

}  // namespace

// The stage cards are owned by nothing or by a block; what belongs to the model as a
// whole has no stage as owner.
bool outside_stages(const Deck& deck, const CardView& card) {
  const int owner = card.card().owner;
  return owner < 0 || CardView(deck, owner).spec().name != "stage";
}

namespace {

// A group is born at most once, and removed at most once after that.
void check_births(Builder& b) {
  struct Life {
    int born = 0, dead = 0;  // stage numbers, 0 = not
  };
  std::vector<Life> lives(b.model.groups.size());
  const auto name = [&](int g) { return "group " + std::to_string(b.model.groups[g].number); };
  for (const Stage& stage : b.model.stages) {
    for (int g : stage.births) {
      Life& life = lives[g];
      if (life.born > 0)
        b.error("S239", stage.where,
                name(g) + " is born twice; a group that was removed needs a twin to be born again");
      else if (life.dead > 0)
        b.error("S239", stage.where,
                name(g) + " is born in stage " + std::to_string(stage.number) + " but removed in stage " +
                    std::to_string(life.dead) +
                    ", before it exists; a group that was removed needs a twin to be born again");
      life.born = stage.number;
    }
    for (int g : stage.deaths) {
      Life& life = lives[g];
      if (life.born == stage.number)
        b.error("S239", stage.where, name(g) + " is born and removed in the same stage");
      else if (life.dead > 0)
        b.note("S239", stage.where,
               name(g) + " is removed again: it is gone since stage " + std::to_string(life.dead));
      if (life.dead == 0) life.dead = stage.number;
    }
  }
}

}  // namespace

void build_stages(Builder& b) {
  collect_unknowns(b.model);
  b.dof_map = DofMap(b.model);
  for (const CardView& card : b.deck.all("fixity"))
    if (outside_stages(b.deck, card))
      read_fixity(b, card, nullptr, 0.0, b.model.fixities, b.model.turned_fixities, b.model.field_fixities);
  for (const CardView& card : b.deck.all("initial"))
    if (outside_stages(b.deck, card)) read_initial(b, card, false, b.model.initials);
  int number = 0;
  const std::vector<CardView> titles = b.deck.all("stage_title");
  for (const CardView& card : b.deck.all("stage")) {
    b.model.stages.push_back(read_stage(b, card, number + 1));
    if (static_cast<std::size_t>(number) < titles.size())
      b.model.stages.back().title = b.text(titles[number], "title");
    ++number;
  }
  for (const CardView& card : b.deck.all("initial")) check_traction(b, card);
  build_steps(b);
  build_strength_stages(b);
  if (b.model.stages.empty())
    b.error("S214", b.deck.one("control").where(), "the deck has no stages: nothing to compute");
  check_births(b);
  check_controls(b);
}

}  // namespace sage::builder
