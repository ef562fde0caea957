// CANDE Level 3 decks: soil elements by load step.  Beams, interfaces and links have no element here.
#include <algorithm>
#include <map>

#include "sage/core/types.hpp"
#include "sage/model/canonical.hpp"

namespace sage::canonical {

namespace {

constexpr double kCubicInches = 1728.0;  // lengths in inches, densities in lbf/ft^3

void fail(const Deck& deck, const SourcePosition& where, const std::string& message) {
  Diagnostics problems;
  problems.add(card_diagnostic(deck, Severity::error, where, message));
  throw InputError(problems);
}

void add_nodes(const Deck& deck, CardWriter& out) {
  for (const CardView& node : deck.all("node")) {
    for (const char* field : {"reference_code", "generation_x", "generation_y", "increment"})
      if (node.integer(field) != 0)
        fail(deck, node.where(field),
             "node generation (" + node.label(field) + ") is not built; give the coordinates of every node");
    out.add("node", node.where(), {take(node, "number"), take(node, "x"), take(node, "y")});
  }
}

// The law of Duncan et al. (1980) from the cards D-2 to D-4, where these hold its numbers.  Decks may name a
// standard soil instead (SW95 ...), whose numbers stand in CANDE.
std::vector<NewField> duncan_parameters(const CardView& model, const CardView& strength, const CardView& bulk,
                                        CardWriter& out) {
  if (model.integer("model") != 0) {
    out.warning(model.where("model"), "this soil's bulk modulus is that of Selig (code " +
                                          model.text("model", "1") +
                                          "), which is not known here; only code 0, that of Duncan, is");
    return {};
  }
  if (!(bulk.real("bulk_number") > 0.0)) {
    out.warning(bulk.where("bulk_number"),
                "without a bulk modulus number this soil has a constant Poisson's ratio, which "
                "is not known here");
    return {};
  }
  out.warning(strength.where("modulus_number"),
              "computed as duncan_chang_eb; the deck has no modulus for unloading: the modulus number K serves "
              "for both");
  return {take(strength, "modulus_number", "values"), take(strength, "modulus_exponent", "values"),
          take(strength, "failure_ratio", "values"),  take(strength, "modulus_number", "values"),
          take(bulk, "bulk_number", "values"),        take(bulk, "bulk_exponent", "values"),
          take(strength, "cohesion", "values"),       take(strength, "friction_angle", "values"),
          take(strength, "friction_drop", "values")};
}

// The parameters of a material, empty where the deck doesn't give a law that exists here.
std::vector<NewField> parameters(const Deck& deck, const CardView& material, std::string& law,
                                 CardWriter& out) {
  std::vector<NewField> values;
  const auto add = [&](const CardView& card, std::initializer_list<const char*> fields) {
    for (const char* field : fields) values.push_back(take(card, field, "values"));
  };
  const auto isotropic = deck.all("isotropic", material), mohr = deck.all("mohr_coulomb", material);
  if (!isotropic.empty()) {
    law = "linear_elastic";
    add(isotropic.front(), {"youngs_modulus", "poissons_ratio"});
  } else if (!mohr.empty()) {
    law = "mohr_coulomb";
    add(mohr.front(), {"youngs_modulus", "poissons_ratio", "cohesion", "friction_angle"});
  } else if (const auto model = deck.all("duncan", material), strength = deck.all("duncan_strength", material),
             bulk = deck.all("duncan_bulk", material);
             !model.empty() && !strength.empty() && !bulk.empty()) {
    law = "duncan_chang_eb";
    values = duncan_parameters(model.front(), strength.front(), bulk.front(), out);
  }
  return values;
}

// Materials whose law or numbers the deck does not hold are computed as its first elastic material.
void add_materials(const Deck& deck, const Catalogue& catalogue, CardWriter& out) {
  std::vector<NewField> stand_in;
  std::string ignored, stand_in_name;
  for (const CardView& material : deck.all("material")) {
    if (deck.all("isotropic", material).empty()) continue;
    stand_in = parameters(deck, material, ignored, out);
    stand_in_name = material.text("number") + " (" + material.text("name") + ")";
    break;
  }
  for (const CardView& material : deck.all("material")) {
    std::string law;
    std::vector<NewField> values = parameters(deck, material, law, out);
    if (values.empty()) {
      const std::string name = "material " + material.text("number") + " (" + material.text("name") + ")";
      if (material.integer("law") == 6 || material.integer("law") == 7) continue;
      if (stand_in.empty())
        fail(deck, material.where("law"),
             name + ": its law is not known here, and the deck has no isotropic material to stand for it");
      out.warning(material.where("law"), name +
                                             ": its law's numbers are not in the deck or its law is not known "
                                             "here; computed as the elastic material " +
                                             stand_in_name);
      law = "linear_elastic";
      values = stand_in;
    }
    const int card = out.add("material", material.where(),
                             {take(material, "number"),
                              {"law", static_cast<double>(law_code(catalogue, law)), material.where("law")},
                              take(material, "unit_weight", {}, 1.0 / kCubicInches),
                              {"name", 0.0, material.where("name"), material.text("name", "-")}});
    out.add("parameters", material.where(), values, card);
  }
}

struct GroupKey {
  int birth, death, material;
  bool triangle;
  auto operator<=>(const GroupKey&) const = default;
};
using Groups = std::map<GroupKey, double>;  // ordered by load step

GroupKey key_of(const CardView& element) {
  const int n3 = element.integer("n3"), n4 = element.integer("n4");
  return {std::max(1, element.integer("birth")), element.integer("death"), element.integer("material"),
          n4 == 0 || n4 == n3};
}

// Those decks turn elements either way; this program wants them counter-clockwise.
class Turner {
 public:
  explicit Turner(const Deck& deck) {
    for (const CardView& node : deck.all("node"))
      place_.insert_or_assign(node.integer("number"), Vector2(node.real("x"), node.real("y")));
  }
  // The fields n1 ... in counter-clockwise order.
  std::vector<NewField> nodes(const CardView& element, bool triangle) {
    std::vector<NewField> list;
    for (const char* node : {"n1", "n2", "n3", "n4"})
      if (!triangle || node[1] != '4') list.push_back(take(element, node));
    double twice_area = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto a = place_.find(static_cast<int>(list[i].number));
      const auto b = place_.find(static_cast<int>(list[(i + 1) % list.size()].number));
      if (a == place_.end() || b == place_.end()) return list;
      twice_area += a->second.x() * b->second.y() - b->second.x() * a->second.y();
    }
    if (twice_area >= 0.0) return list;
    ++turned_;
    std::reverse(list.begin(), list.end());
    for (std::size_t i = 0; i < list.size(); ++i) list[i].name = "n" + std::to_string(i + 1);
    return list;
  }
  int turned() const { return turned_; }

 private:
  std::map<int, Vector2> place_;
  int turned_ = 0;
};

bool is_soil(const CardView& element) {
  return element.integer("n3") != 0 && element.integer("class") == 0;
}

// Without its beams the pipe would be a hole with loose soil above; its nodes are held: a rigid pipe that
// stays.
void leave_out(const Deck& deck, CardWriter& out) {
  int beams = 0, interfaces = 0, links = 0;
  SourcePosition where;
  for (const CardView& element : deck.all("element")) {
    if (is_soil(element)) continue;
    if (where.line == 0) where = element.where();
    const int kind = element.integer("class");
    ++(kind == 1 ? interfaces : kind > 1 ? links : beams);
    if (kind != 0) continue;
    for (const char* node : {"n1", "n2"})
      out.add("fixity", element.where(node), {take(element, node, "first"), {"x_code", 1.0}, {"y_code", 1.0}});
  }
  if (beams + interfaces + links == 0) return;
  out.warning(where, "left out: " + std::to_string(beams) + " beam element(s) (the pipe), " +
                         std::to_string(interfaces) + " interface(s), " + std::to_string(links) +
                         " link(s); this program has no such elements. The beams' nodes are held in x and y: "
                         "the soil rests on a pipe that does not move");
}

Groups add_groups(const Deck& deck, const Catalogue& catalogue, CardWriter& out) {
  Groups groups;
  int before = 0;
  for (const CardView& element : deck.all("element")) {
    for (const char* field : {"node_increment", "rows", "row_increment"})
      if (element.integer(field) > 1)
        fail(deck, element.where(field),
             "element generation (" + element.label(field) +
                 ") is not built; give every element on a card of its own");
    if (const int number = element.integer("number"); before > 0 && number > before + 1)
      fail(deck, element.where("number"),
           "elements " + std::to_string(before + 1) + " to " + std::to_string(number - 1) +
               " are not given: CANDE fills such a gap by generation, which is not built; give every element "
               "on a card "
               "of its own");
    before = element.integer("number");
    if (is_soil(element)) groups.try_emplace(key_of(element), 0.0);
  }
  double number = 0.0;
  for (auto& [key, group] : groups) {
    group = ++number;
    out.add("group", deck.one("control").where(),
            {{"number", group},
             {"element", static_cast<double>(element_code(catalogue, key.triangle ? "tri3" : "quad4"))},
             {"material", static_cast<double>(key.material)},
             {"name", 0.0, {}, "step " + std::to_string(key.birth)}});
  }
  Turner turner(deck);
  for (const CardView& element : deck.all("element")) {
    if (!is_soil(element)) continue;
    const GroupKey key = key_of(element);
    std::vector<NewField> fields{take(element, "number"), {"group", groups.at(key)}};
    for (NewField& node : turner.nodes(element, key.triangle)) fields.push_back(std::move(node));
    out.add("element", element.where(), fields);
  }
  if (turner.turned() > 0)
    out.note({deck.file, 0, 0, 0},
             std::to_string(turner.turned()) + " element(s) listed clockwise were turned round");
  return groups;
}

// Supports that hold from the start; displacements and forces belong to their load step.
void add_boundary(const Deck& deck, CardWriter& out, int step, int stage) {
  for (const CardView& card : deck.all("fixity")) {
    const bool x = card.integer("x_code") == 1, y = card.integer("y_code") == 1;
    const double vx = card.real("x_value"), vy = card.real("y_value");
    if (card.real("angle") != 0.0) fail(deck, card.where("angle"), "supports along turned axes are not built");
    if (card.real("pressure1") != 0.0 || card.real("pressure2") != 0.0)
      fail(deck, card.where("pressure1"), "pressures between nodes of a boundary card are not built");
    const int of_step = std::max(1, card.integer("load_step"));
    const bool plain = of_step == 1 && vx == 0.0 && vy == 0.0;
    if (plain ? stage >= 0 : stage < 0 || of_step != step) continue;
    const NewField last = take(card, "last"), by = take(card, "step");
    if (x || y)
      out.add("fixity", card.where(),
              {take(card, "first"),
               last,
               by,
               {"x_code", x ? 1.0 : 0.0},
               {"y_code", y ? 1.0 : 0.0},
               {"x_value", x ? vx : 0.0},
               {"y_value", y ? vy : 0.0}},
              stage);
    if ((!x && vx != 0.0) || (!y && vy != 0.0))
      out.add("load", card.where(),
              {take(card, "first"), last, by, {"x_force", x ? 0.0 : vx}, {"y_force", y ? 0.0 : vy}}, stage);
  }
}

void add_stages(const Deck& deck, CardWriter& out, const Groups& groups) {
  const CardView control = deck.one("control");
  int steps = std::max(1, control.integer("load_steps"));
  for (const auto& [key, number] : groups) steps = std::max({steps, key.birth, key.death});
  for (int step = 1; step <= steps; ++step) {
    out.add("stage_title", control.where(), {{"title", 0.0, {}, "load step " + std::to_string(step)}});
    const int stage =
        out.add("stage", control.where(), {{"increments", 1.0}, {"gravity_y", step == 1 ? -1.0 : 0.0}});
    std::vector<NewField> births, deaths;
    for (const auto& [key, number] : groups) {
      if (step > 1 && key.birth == step) births.push_back({"groups", number});
      if (key.death == step) deaths.push_back({"groups", number});
    }
    add_boundary(deck, out, step, stage);
    if (!births.empty()) out.add("birth", control.where(), births, stage);
    if (!deaths.empty()) out.add("death", control.where(), deaths, stage);
  }
}

}  // namespace

Deck cande_deck(const Deck& deck, const Catalogue& catalogue) {
  CardWriter out(deck);
  out.copy("title");
  const CardView control = deck.one("control");
  out.add("units", control.where(),
          {{"length", 0.0, {}, "in"},
           {"force", 0.0, {}, "lbf"},
           {"stress", 0.0, {}, "psi"},
           {"atmospheric_pressure", 14.696},
           {"water_unit_weight", 0.036111}});
  out.add("control", control.where(), {{"geometry", 1.0}, take(control, "total_nodes")});
  add_nodes(deck, out);
  add_materials(deck, catalogue, out);
  leave_out(deck, out);
  const Groups groups = add_groups(deck, catalogue, out);
  add_boundary(deck, out, 0, -1);
  for (const CardView& factor : deck.all("load_factor"))
    if (factor.real("factor", 1.0) != 1.0)
      out.warning(factor.where("factor"), "load factors are not used: every load step has factor 1");
  add_stages(deck, out, groups);
  return out.take();
}

}  // namespace sage::canonical
