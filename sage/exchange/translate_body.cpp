#include "sage/exchange/translate_body.hpp"

#include <numbers>
#include <set>
#include <stdexcept>

namespace sage::translate {

void refuse(const Body& body, const CardView& card, std::string_view field, const std::string& message) {
  Diagnostics problems;
  problems.add(card_diagnostic(body.deck, Severity::error, "S701", card.where(field), message));
  throw InputError(problems);
}

namespace {

// Codes of this program.
struct Kind {
  int element, formulation;
};

int flow_code(const Catalogue& catalogue, ParentShape shape, int nodes) {
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.flow() && entry.shape == shape && entry.nodes == nodes) return code;
  throw std::logic_error("the catalogue has no element of flow with " + std::to_string(nodes) + " nodes");
}

int pore_code(const Catalogue& catalogue, int nodes) {
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.has_pores() && entry.square() && entry.nodes == nodes) return code;
  throw std::logic_error("the catalogue has no element of consolidation with " + std::to_string(nodes) +
                         " nodes");
}

// The integration that the deck asks for; blank = 4 points of the 8-node quadrilateral.
Kind element_kind(const Body& body) {
  if (body.flows())
    return {flow_code(body.catalogue, body.triangles ? ParentShape::triangle : ParentShape::square,
                      body.nodes_per_element),
            0};
  const int points = body.card.integer("integration_points", 4);
  const int code =
      body.consolidates()
          ? pore_code(body.catalogue, body.nodes_per_element)
          : solid_code(body.catalogue, body.triangles ? ParentShape::triangle : ParentShape::square,
                       body.nodes_per_element);
  const ElementEntry& entry = *body.catalogue.elements.find(code);
  std::string known;
  for (const Formulation& formulation : entry.formulations) {
    if (!formulation.plain) continue;
    if (formulation.points == points) return {code, formulation.code};
    known += (known.empty() ? "" : ", ") + std::to_string(formulation.points);
  }
  refuse(body, body.card, "integration_points",
         "no " + entry.name + " with " + std::to_string(points) + " integration points; known: " + known);
}

// The law that the columns of a material row tell, and its parameters.
std::string law_of(const CardView& row, std::vector<NewField>& values) {
  if (!row.blank("permeability_x") && row.blank("youngs_modulus")) {
    values = {take(row, "permeability_x", "values"), take(row, "permeability_y", "values")};
    return "darcy";
  }
  values = {take(row, "youngs_modulus", "values"), take(row, "poissons_ratio", "values")};
  if (!row.blank("undrained_strength")) {
    // von Mises: sqrt(J2) = c, which is cone 3 at phi = 0.
    values.push_back(take(row, "undrained_strength", "values"));
    for (double value : {0.0, 0.0, 3.0}) values.push_back({"values", value});
    return "drucker_prager";
  }
  if (row.blank("friction_angle")) return "linear_elastic";
  for (const char* field : {"cohesion", "friction_angle", "dilation_angle"})
    values.push_back(take(row, field, "values"));
  return "mohr_coulomb";
}

void add_materials(const Body& body, CardWriter& out) {
  int number = 0;
  for (const CardView& row : body.deck.all("material_values")) {
    std::vector<NewField> values;
    const std::string law = law_of(row, values);
    if (row.real("bulk_modulus") < 0.0)
      refuse(body, row, "bulk_modulus", "the bulk modulus of the water must not be negative (0: drained)");
    std::vector<NewField> fields{{"number", static_cast<double>(++number)},
                                 {"law", static_cast<double>(law_code(body.catalogue, law))},
                                 {"unit_weight", row.real("unit_weight"), row.where("unit_weight")},
                                 {"name", 0.0, {}, "material " + std::to_string(number)}};
    if (!row.blank("k0")) fields.push_back(take(row, "k0"));
    const int card = out.add("material", row.where(), fields);
    out.add("parameters", row.where(), values, card);
  }
}

// Water in the pores of consolidating soil, by mobilities: the unit weight of water is 1.
void add_pore_flow(const Body& body, CardWriter& out) {
  if (!body.consolidates()) return;
  out.add("units", body.card.where(), {{"water_unit_weight", 1.0}});
  const std::vector<CardView> rows = body.deck.all("material_values");
  int number = static_cast<int>(rows.size());
  for (const CardView& row : rows) {
    const int card = out.add("material", row.where("permeability_x"),
                             {{"number", static_cast<double>(++number)},
                              {"law", static_cast<double>(law_code(body.catalogue, "pore_flow"))},
                              {"unit_weight", 0.0},
                              {"name", 0.0, {}, "pore water"}});
    out.add("parameters", row.where("permeability_x"),
            {take(row, "permeability_x", "values"), take(row, "permeability_y", "values")}, card);
  }
}

// Pore water that can't leave: elements of its own on the same nodes, with the water's bulk modulus and so little
// shear stiffness (1e-9 of it) that its stress is a pressure.  It starts without excess pressure.
void add_pore_water(const Body& body, const std::vector<int>& material, int element, int formulation,
                    CardWriter& out) {
  constexpr double kShear = 1e-9;
  const std::vector<CardView> rows = body.deck.all("material_values");
  const int soils = static_cast<int>(rows.size());
  for (int m = 1; m <= soils; ++m) {
    const CardView& row = rows[static_cast<std::size_t>(m) - 1];
    const double bulk = row.real("bulk_modulus");
    if (!(bulk > 0.0)) continue;
    const std::string name = soils > 1 ? "pore water of material " + std::to_string(m) : "pore water";
    const double number = soils + m;
    const int card = out.add("material", row.where("bulk_modulus"),
                             {{"number", number},
                              {"law", static_cast<double>(law_code(body.catalogue, "linear_elastic_kg"))},
                              {"unit_weight", 0.0},
                              {"name", 0.0, {}, name}});
    out.add("parameters", row.where("bulk_modulus"), {{"values", bulk}, {"values", kShear * bulk}}, card);
    out.add("group", body.card.where(),
            {{"number", number},
             {"element", static_cast<double>(element)},
             {"formulation", static_cast<double>(formulation)},
             {"material", number},
             {"overlay", 1.0},
             {"name", 0.0, {}, name}});
    for (std::size_t e = 0; e < body.elements.size(); ++e) {
      if (material[e] != m) continue;
      std::vector<NewField> fields{{"number", static_cast<double>(body.elements.size() + e) + 1.0},
                                   {"group", number}};
      int n = 0;
      for (int node : body.elements[e].nodes)
        fields.push_back({"n" + std::to_string(++n), static_cast<double>(node)});
      out.add("element", body.elements[e].where, fields);
    }
  }
}

bool any_value(const Deck& deck, std::string_view field) {
  for (const CardView& row : deck.all("material_values"))
    if (row.real(field) != 0.0) return true;
  return false;
}

}  // namespace

bool Body::flows() const {
  return deck.has("heads");
}

bool Body::consolidates() const {
  const CardView row = deck.one("material_values");
  return !row.blank("permeability_x") && !row.blank("youngs_modulus");
}

std::vector<int> element_materials(const Body& body) {
  std::vector<int> of_element(body.elements.size(), 1);
  if (!body.deck.has("element_materials")) return of_element;
  const CardView card = body.deck.one("element_materials");
  const auto list = card.list("materials");
  const double known = static_cast<double>(body.deck.all("material_values").size());
  if (list.size() < of_element.size())
    refuse(body, card, "materials", "there are fewer materials than elements");
  for (std::size_t e = 0; e < of_element.size(); ++e) {
    if (!(list[e].number >= 1.0 && list[e].number <= known)) {
      Diagnostics problems;
      problems.add(card_diagnostic(
          body.deck, Severity::error, "S701", card.where(list[e]),
          "element " + std::to_string(e + 1) + " is of a material that no row of values gives"));
      throw InputError(problems);
    }
    of_element[e] = static_cast<int>(list[e].number);
  }
  return of_element;
}

void add_body(const Body& body, const std::vector<int>& material, const std::string& what, CardWriter& out) {
  out.add("title", body.card.where(), {{"title", 0.0, {}, body.deck.layout + " deck, " + what}});
  out.add("control", body.card.where(),
          {{"geometry", body.axisymmetric ? 2.0 : 1.0, body.card.where("geometry")}});
  for (const BodyNode& node : body.nodes)
    out.add("node", node.where,
            {{"number", static_cast<double>(node.number)}, {"x", node.x.x()}, {"y", node.x.y()}});
  add_materials(body, out);
  add_pore_flow(body, out);
  const double soils = body.consolidates() ? static_cast<double>(body.deck.all("material_values").size()) : 0.0;
  const Kind kind = element_kind(body);
  for (int m : std::set<int>(material.begin(), material.end()))
    out.add("group", body.card.where(),
            {{"number", static_cast<double>(m)},
             {"element", static_cast<double>(kind.element)},
             {"formulation", static_cast<double>(kind.formulation)},
             {"material", static_cast<double>(m)},
             {"second_material", soils > 0.0 ? soils + m : 0.0},
             {"name", 0.0, {}, "material " + std::to_string(m)}});
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    std::vector<NewField> fields{{"number", static_cast<double>(e) + 1.0},
                                 {"group", static_cast<double>(material[e])}};
    int n = 0;
    for (int node : body.elements[e].nodes)
      fields.push_back({"n" + std::to_string(++n), static_cast<double>(node)});
    out.add("element", body.elements[e].where, fields);
  }
  add_pore_water(body, material, kind.element, kind.formulation, out);
}

void add_loading(const Body& body, CardWriter& out) {
  const Deck& deck = body.deck;
  const double circle = body.axisymmetric ? 2.0 * std::numbers::pi : 1.0;
  for (const CardView& load : deck.all("load"))
    out.add("load", load.where(),
            {take(load, "first"), take(load, "x_force", {}, circle), take(load, "y_force", {}, circle)});
  for (const char* card :
       {"displacement", "increments", "increment", "removal", "strength_factors", "gravity", "start_stress"})
    out.copy(card);
  const bool starts = deck.has("start_stress") || any_value(deck, "k0");
  if (starts && !deck.has("start_stress")) out.add("start_stress", deck.one("material_values").where(), {});
  if (deck.has("gravity") || starts) return;
  const bool weight = any_value(deck, "unit_weight");
  // A body that nothing loads is a deck too: its answer is zero.
  if (weight || (!deck.has("load") && !deck.has("displacement")))
    out.add("gravity", deck.one("material_values").where(),
            {{"gravity_x", 0.0}, {"gravity_y", weight ? -1.0 : 0.0}});
}

}  // namespace sage::translate
