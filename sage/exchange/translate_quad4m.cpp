// QUAD4M decks: a dynamic program's mesh and small-strain moduli, loaded here by their own weight.
#include <map>

#include "sage/exchange/translate.hpp"

namespace sage::translate {

namespace {

// Unit weights stand in N/m^3 or lbf/ft^3, moduli in kN/m^2 or kips/ft^2 (the program's own echo says so).
constexpr double kThousand = 1000.0;

void add_units(const Deck& deck, CardWriter& out) {
  const CardView card = deck.one("units");
  const bool si = card.text("system") != "E";
  out.add("units", card.where(),
          {{"length", 0.0, {}, si ? "m" : "ft"},
           {"force", 0.0, {}, si ? "kN" : "kips"},
           {"stress", 0.0, {}, si ? "kPa" : "ksf"},
           {"atmospheric_pressure", si ? 101.325 : 2.116},
           {"water_unit_weight", si ? 9.81 : 0.0624}});
}

struct MaterialKey {
  int type;
  double unit_weight, poissons_ratio, shear_modulus;
  bool triangle;
  auto operator<=>(const MaterialKey&) const = default;
};

void add_material(const Catalogue& catalogue, CardWriter& out, const CardView& element, const MaterialKey& key,
                  double number) {
  const std::string name = "type " + std::to_string(key.type);
  const int card = out.add("material", element.where("material"),
                           {{"number", number},
                            {"law", static_cast<double>(law_code(catalogue, "linear_elastic"))},
                            {"unit_weight", key.unit_weight / kThousand, element.where("unit_weight")},
                            {"name", 0.0, {}, name}});
  out.add("parameters", element.where("shear_modulus"),
          {{"values", 2.0 * key.shear_modulus * (1.0 + key.poissons_ratio), element.where("shear_modulus")},
           {"values", key.poissons_ratio, element.where("poissons_ratio")}},
          card);
  out.add("group", element.where("material"),
          {{"number", number},
           {"element", static_cast<double>(corner_element(catalogue, key.triangle))},
           {"material", number},
           {"name", 0.0, {}, name}});
}

// Every element states its own moduli; equal ones share a material.  A triangle repeats node 3.
void add_elements(const Deck& deck, const Catalogue& catalogue, CardWriter& out) {
  std::map<MaterialKey, double> materials;
  for (const CardView& element : deck.all("element")) {
    const bool triangle = element.integer("n3") == element.integer("n4");
    const MaterialKey key{element.integer("material"), element.real("unit_weight"),
                          element.real("poissons_ratio"), element.real("shear_modulus"), triangle};
    const auto [it, added] = materials.try_emplace(key, static_cast<double>(materials.size()) + 1.0);
    if (added) add_material(catalogue, out, element, key, it->second);
    std::vector<NewField> fields{take(element, "number"), {"group", it->second}};
    for (const char* node : {"n1", "n2", "n3", "n4"})
      if (!triangle || node[1] != '4') fields.push_back(take(element, node));
    out.add("element", element.where(), fields);
  }
}

void add_nodes_and_supports(const Deck& deck, CardWriter& out) {
  int transmitting = 0;
  for (const CardView& node : deck.all("node")) {
    out.add("node", node.where(), {take(node, "number"), take(node, "x"), take(node, "y")});
    const int code = node.integer("boundary");
    if (code == 4) ++transmitting;
    if (code == 0) continue;
    const bool x = code == 1 || code >= 3, y = code >= 2;
    out.add("fixity", node.where("boundary"),
            {take(node, "number", "first"), {"x_code", x ? 1.0 : 0.0}, {"y_code", y ? 1.0 : 0.0}});
  }
  if (transmitting > 0)
    out.note("S704", {deck.file, 0, 0, 0},
             std::to_string(transmitting) +
                 " node(s) of a transmitting base are held in x and y: a static analysis "
                 "has no waves to transmit");
}

}  // namespace

Deck quad4m_deck(const Deck& deck, const Catalogue& catalogue) {
  CardWriter out(deck);
  out.copy("title");
  add_units(deck, out);
  const CardView control = deck.one("control");
  out.add(
      "control", control.where(),
      {{"geometry", 1.0}, take(control, "nodes", "total_nodes"), take(control, "elements", "total_elements")});
  add_nodes_and_supports(deck, out);
  add_elements(deck, catalogue, out);
  out.left_out(
      {deck.file, 0, 0, 0}, "earthquake motion and damping",
      "earthquake motion and damping of the deck are not used: its mesh, supports, unit weights and initial "
      "shear moduli are loaded by gravity in one stage",
      false);
  out.add("stage_title", control.where(), {{"title", 0.0, {}, "own weight"}});
  out.add("stage", control.where(), {{"increments", 1.0}, {"gravity_y", -1.0}});
  return out.take();
}

}  // namespace sage::translate
