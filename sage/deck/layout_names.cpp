#include "sage/deck/layout_names.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "sage/messages/near_names.hpp"

namespace sage {

namespace {

// One card that the model builder knows (sage/builder/build_*.cpp and sage/exchange/translate_*.cpp).  Names
// stand between blanks; "a|b": one of them is enough.
struct KnownCard {
  std::string_view family, name;
  bool card_needed;
  std::string_view needed, others;
  // The card that it is looked for under; "?" before it: or on its own; "!": on its own where the layout has no
  // such card.
  std::string_view owner;
};

// Families whose mesh is of one kind of element: they share the cards of "body".
constexpr std::string_view kBodies[] = {"rectangle", "slope", "mesh"};

constexpr std::string_view kElement = "n3 n4 n5 n6 n7 n8 group columns rows column_step row_step";

// n9 and more: as many as the element has.
bool is_node_name(std::string_view name) {
  return name.size() > 1 && name[0] == 'n' && name.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

constexpr KnownCard kKnown[] = {
    {"sage1", "title", false, "", "title", ""},
    {"sage1", "units", false, "", "length force stress atmospheric_pressure water_unit_weight", ""},
    {"sage1", "control", true, "", "geometry solver total_nodes total_elements middle_nodes strain", ""},
    {"sage1", "node", true, "number x y", "step system ratio", ""},
    {"sage1", "fill", false, "first columns rows row_step", "column_step column_ratio row_ratio", ""},
    {"sage1", "material", true, "number law", "unit_weight name k0 saturated_unit_weight", ""},
    {"sage1", "parameters", false, "values", "", "material"},
    {"sage1", "group", true, "number element material", "formulation name overlay second_material", ""},
    {"sage1", "element", true, "number n1 n2", kElement, ""},
    {"sage1", "fixity", false, "first x_code|y_code",
     "last step x_code y_code x_value y_value unknown history angle tie tie_step", "?stage"},
    {"sage1", "initial", false, "group v1", "kind v2 v3 v4 v5 v6 material parameter", "?stage"},
    {"sage1", "stage_title", false, "title", "", ""},
    {"sage1", "stage", true, "",
     "increments duration method max_iterations output_every gravity_x gravity_y tolerance "
     "strength_factor pore_water theta grading reset_displacements time_error end_degree end_pressure "
     "output_times load_control",
     ""},
    {"sage1", "load", false, "first x_force|y_force", "last step x_force y_force unknown history", "!stage"},
    {"sage1", "pressure", false, "element edge normal1 normal2", "last step shear1 shear2 unknown history",
     "!stage"},
    {"sage1", "edge_load", false, "n1 n2 normal1 normal2", "n3 element sense normal3 shear1 shear2 shear3",
     "!stage"},
    {"sage1", "birth", false, "groups", "", "stage"},
    {"sage1", "death", false, "groups", "", "stage"},
    {"sage1", "report", false, "first|nodes|kind",
     "kind first last step listed nodes group stage height area cell_pressure", ""},
    {"sage1", "point", false, "x y", "name end_x end_y", "report"},
    {"sage1", "water", false, "kind", "group stage action value1 value2 listed values file", ""},

    {"any", "left_out", false, "what", "of partial instead", ""},

    {"quad4m", "title", false, "", "title", ""},
    {"quad4m", "units", true, "system", "", ""},
    {"quad4m", "control", true, "", "nodes elements", ""},
    {"quad4m", "node", true, "number x y boundary", "", ""},
    {"quad4m", "element", true, "number n1 n2 n3 n4 unit_weight poissons_ratio shear_modulus", "material", ""},

    {"cande", "title", false, "", "title method", ""},
    {"cande", "control", true, "", "load_steps total_nodes", ""},
    {"cande", "load_scaling", false, "", "text", ""},
    {"cande", "pipe", false, "type", "elements", ""},
    {"cande", "pipe_steel", false, "youngs_modulus poissons_ratio", "density joint_slip behaviour deformation",
     "pipe"},
    {"cande", "pipe_section", false, "area inertia", "", "pipe"},
    {"cande", "pipe_alum", false, "youngs_modulus poissons_ratio", "density behaviour deformation", "pipe"},
    {"cande", "pipe_alum_section", false, "area inertia", "", "pipe"},
    {"cande", "pipe_plastic", false, "wall duration", "deformation", "pipe"},
    {"cande", "pipe_plastic_moduli", false, "short_modulus long_modulus poissons_ratio", "density", "pipe"},
    {"cande", "pipe_plastic_section", false, "height area inertia", "", "pipe"},
    {"cande", "pipe_basic", false, "first last youngs_modulus poissons_ratio area inertia load", "", "pipe"},
    {"cande", "node", true, "number x y", "reference_code generation_x generation_y increment", ""},
    {"cande", "element", true, "number n1 n2 n3 n4 material class",
     "birth death node_increment rows row_increment", ""},
    {"cande", "fixity", true, "first x_code y_code",
     "x_value y_value angle load_step last step pressure1 pressure2", ""},
    {"cande", "material", true, "number law", "unit_weight name", ""},
    {"cande", "isotropic", false, "youngs_modulus poissons_ratio", "", "material"},
    {"cande", "mohr_coulomb", false, "youngs_modulus poissons_ratio cohesion friction_angle", "", "material"},
    {"cande", "duncan", false, "model", "unloading", "material"},
    {"cande", "interface", false, "angle friction", "tension gap", "material"},
    {"cande", "duncan_strength", false,
     "cohesion friction_angle friction_drop modulus_number modulus_exponent failure_ratio", "", "material"},
    {"cande", "duncan_bulk", false, "bulk_number bulk_exponent", "", "material"},
    {"cande", "load_factor", false, "factor", "first last", ""},

    {"rectangle", "rectangle", true, "columns rows",
     "geometry shape nodes_per_element direction integration_points footing harmonic", ""},
    {"rectangle", "rectangle_x", true, "x", "", ""},
    {"rectangle", "rectangle_y", true, "y", "", ""},
    {"rectangle", "surcharge", false, "pressure", "", ""},
    {"rectangle", "cell", false, "stress", "", ""},
    {"rectangle", "times", false, "time_step steps", "theta print_every print_node", ""},
    {"rectangle", "load_function", false, "", "points", ""},
    {"rectangle", "load_time", false, "time factor", "", ""},
    {"rectangle", "iteration", false, "", "increments displacement", ""},

    {"slope", "slope", true, "crest slope toe height depth columns toe_columns rows foundation_rows",
     "integration_points", ""},

    {"mesh", "mesh", true, "nodes elements", "geometry dimensions shape nodes_per_element integration_points",
     ""},
    {"mesh", "mesh_nodes", true, "coordinates", "", ""},
    {"mesh", "mesh_elements", true, "nodes", "", ""},

    {"body", "material_values", true, "youngs_modulus|permeability_x poissons_ratio|permeability_y",
     "youngs_modulus poissons_ratio undrained_strength friction_angle cohesion dilation_angle bulk_modulus "
     "unit_weight consolidation k0 permeability_x permeability_y",
     ""},
    {"body", "head", false, "first head", "", ""},
    {"body", "inflow", false, "first inflow", "", ""},
    {"body", "element_materials", false, "materials", "", ""},
    {"body", "restraints", false, "", "count", ""},
    {"body", "fixity", false, "first x_code|y_code", "last step x_code y_code x_value y_value pressure_code",
     ""},
    {"body", "load", false, "first x_force|y_force", "x_force y_force", ""},

    {"steps", "gravity", false, "gravity_x|gravity_y", "gravity_x gravity_y", ""},
    {"steps", "displacement", false, "first direction", "last step value", ""},
    {"steps", "increments", false, "factors|totals|displacement|increments",
     "increments factors totals displacement", ""},
    {"steps", "increment", false, "factor|total", "factor total", ""},
    {"steps", "removal", false, "elements", "", ""},
    {"steps", "strength_factors", false, "factors", "", ""},
    {"steps", "start_stress", false, "", "level k0", ""},

    {"embankment", "foundation", true, "columns rows", "increments", ""},
    {"embankment", "embankment", true, "lifts columns rows", "slope pressure_at_rest", ""},
    {"embankment", "material_values", true,
     "youngs_modulus poissons_ratio cohesion friction_angle dilation_angle unit_weight", "", ""},
    {"embankment", "foundation_x", true, "x", "", ""},
    {"embankment", "foundation_y", true, "y", "", ""},
    {"embankment", "embankment_x", true, "x", "", ""},
    {"embankment", "embankment_y", true, "y", "", ""},
    {"embankment", "restraints", false, "", "count", ""},
    {"embankment", "fixity", false, "first x_code|y_code", "last step x_code y_code x_value y_value", ""},
};

std::vector<std::string_view> words(std::string_view text, char separator = ' ') {
  std::vector<std::string_view> all;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (end > 0) all.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return all;
}

std::vector<std::string_view> known_fields(const KnownCard& card) {
  std::vector<std::string_view> all = words(card.others);
  for (const std::string_view group : words(card.needed))
    for (const std::string_view name : words(group, '|')) all.push_back(name);
  return all;
}

std::string nearest(std::string_view name, const std::vector<std::string_view>& known) {
  if (known.empty()) return {};
  const auto best = std::min_element(known.begin(), known.end(), [&](std::string_view a, std::string_view b) {
    return distance(name, a) < distance(name, b);
  });
  return "; the nearest name is \"" + std::string(*best) + "\"";
}

class NameCheck {
 public:
  explicit NameCheck(const Layout& layout) : layout_(layout), family_(family()) {
    for_each_expression(layout, [this](const Expression& expression) {
      for (const ExpressionNode& node : expression.nodes)
        if (node.field >= 0) in_expressions_.insert({node.card, node.field});
    });
    owners_.assign(layout_.cards.size(), -1);
    find_owners(layout_.entries, -1);
  }

  Diagnostics problems() {
    for (std::size_t i = 0; i < layout_.cards.size(); ++i)
      if (!layout_.cards[i].ignored) check_card(static_cast<int>(i));
    for (const KnownCard& known : kKnown)
      if (belongs(known) && known.card_needed && !has_card(known.name) && !replaced(known))
        error(0, "the layout has no card \"" + std::string(known.name) + "\", which every model needs");
    return problems_;
  }

  std::string listing() const {
    std::string out;
    for (std::size_t i = 0; i < layout_.cards.size(); ++i) list_card(static_cast<int>(i), out);
    std::string missing;
    for (const KnownCard& one : kKnown) {
      if (!belongs(one) || has_card(one.name)) continue;
      const bool needed = one.card_needed && !replaced(one);
      const std::string also = one.needed.empty() || one.others.empty() ? "" : "; also ";
      missing += listed(std::string(one.name) + (needed ? " (needed)" : ""),
                        std::string(one.needed) + also + std::string(one.others));
    }
    if (!missing.empty()) out += "cards that the program knows too, with their fields\n" + missing;
    return out;
  }

  NameUse use_of(int index, int field) const {
    const CardRule& card = rule(index);
    const auto f = static_cast<std::size_t>(field);
    const KnownCard* meaning = known(card.spec.name);
    const std::vector<std::string_view> names =
        meaning ? known_fields(*meaning) : std::vector<std::string_view>();
    if (!card.ignored && means_something(meaning, names, card.spec.fields[f].name)) return NameUse::program;
    if (in_expressions_.contains({index, field}) || !card.rules[f].must_equal.empty() ||
        card.rules[f].allowed.size() + card.rules[f].allowed_texts.size() == 1)
      return NameUse::layout;
    return card.ignored || card.rules[f].ignored ? NameUse::ignored : NameUse::nothing;
  }

 private:
  static std::string listed(std::string title, const std::string& names) {
    if (names.empty()) return {};
    title.resize(std::max<std::size_t>(title.size() + 1, 22), ' ');
    return "  " + title + names + '\n';
  }
  // Names of one card by what becomes of them.
  void list_card(int index, std::string& out) const {
    const CardRule& card = rule(index);
    const KnownCard* meaning = known(card.spec.name);
    const std::vector<std::string_view> names =
        meaning ? known_fields(*meaning) : std::vector<std::string_view>();
    out += card.key + (card.spec.name != card.key ? ", as " + card.spec.name : "") +
           (card.spec.made ? ", made" : "") + (card.ignored ? ", ignored" : "") + '\n';
    std::string used, expressions, ignored, unused;
    for (std::size_t f = 0; f < card.spec.fields.size(); ++f) {
      const std::string& name = card.spec.fields[f].name;
      const NameUse use = use_of(index, static_cast<int>(f));
      std::string& list = use == NameUse::program   ? used
                          : use == NameUse::layout  ? expressions
                          : use == NameUse::ignored ? ignored
                                                    : unused;
      list += (list.empty() ? "" : ", ") + name;
      const std::string hint = &list == &unused ? nearest(name, not_given(card, names)) : "";
      if (!hint.empty()) list += " (" + hint.substr(2) + ")";
    }
    std::string others;
    if (!card.ignored)
      for (const std::string_view name : not_given(card, names))
        others += (others.empty() ? "" : ", ") + std::string(name);
    out += listed("used by the program", used) + listed("used by the layout", expressions) +
           listed("ignored", ignored) + listed("used by nothing", unused) +
           listed("could be given too", others);
  }
  bool means_something(const KnownCard* meaning, const std::vector<std::string_view>& names,
                       const std::string& name) const {
    return std::find(names.begin(), names.end(), name) != names.end() ||
           (meaning && meaning->name == "element" && family_ == "sage1" && is_node_name(name));
  }
  const CardRule& rule(int card) const { return layout_.cards[card]; }
  bool has_card(std::string_view name) const {
    return std::any_of(layout_.cards.begin(), layout_.cards.end(),
                       [&](const CardRule& c) { return c.spec.name == name; });
  }
  bool has_field(const CardRule& card, std::string_view name) const {
    return std::any_of(card.spec.fields.begin(), card.spec.fields.end(),
                       [&](const FieldSpec& f) { return f.name == name; });
  }
  // A card of that name in another sense has none of these fields.
  bool has_body(std::string_view name, std::string_view field, std::string_view other) const {
    return std::ranges::any_of(layout_.cards, [&](const CardRule& c) {
      return c.spec.name == name && (has_field(c, field) || has_field(c, other));
    });
  }
  bool element_has(std::string_view field) const {
    return std::any_of(layout_.cards.begin(), layout_.cards.end(),
                       [&](const CardRule& c) { return c.spec.name == "element" && has_field(c, field); });
  }
  // As the model builder tells them apart.
  std::string_view family() const {
    if (has_body("foundation", "columns", "rows")) return "embankment";
    if (has_body("rectangle", "columns", "rows")) return "rectangle";
    if (has_body("slope", "crest", "toe")) return "slope";
    if (has_body("mesh", "nodes", "elements")) return "mesh";
    if (element_has("shear_modulus")) return "quad4m";
    return element_has("class") ? "cande" : "sage1";
  }
  bool is_body() const {
    return std::find(std::begin(kBodies), std::end(kBodies), family_) != std::end(kBodies);
  }
  bool belongs(const KnownCard& card) const {
    return card.family == family_ || card.family == "any" || (card.family == "body" && is_body()) ||
           (card.family == "steps" && (is_body() || family_ == "sage1"));
  }
  // Stages are made from these cards where the layout has none.
  bool replaced(const KnownCard& card) const {
    return card.name == "stage" && std::any_of(std::begin(kKnown), std::end(kKnown), [&](const KnownCard& one) {
             return (one.family == "steps" || (belongs(one) && one.owner == "!stage")) && has_card(one.name);
           });
  }
  const KnownCard* known(std::string_view name) const {
    for (const KnownCard& card : kKnown)
      if (belongs(card) && card.name == name) return &card;
    return nullptr;
  }

  // A card made from another belongs to it if that opens, otherwise to what that belongs to.
  int owner_of(const LayoutEntry& entry, int owner) const {
    if (entry.made_from < 0) return owner;
    return opening_.contains(entry.made_from) ? entry.made_from : owners_[entry.made_from];
  }
  void find_owners(const std::vector<LayoutEntry>& entries, int owner) {
    for (const LayoutEntry& entry : entries) {
      if (entry.card >= 0) {
        owners_[entry.card] = owner_of(entry, owner);
        const int item = rule(entry.card).items_card;
        if (item >= 0) owners_[item] = entry.opens ? entry.card : owner;
      }
      find_owners(entry.entries, owner);
      if (!entry.opens || entry.card < 0) continue;
      opening_.insert(entry.card);
      if (entry.made_from < 0) owner = entry.card;
    }
  }

  void error(int line, const std::string& message) {
    problems_.add({Severity::error, "S147", {layout_.file, line, 0, 0}, message, {}});
  }

  bool is_used(int card, int field) const {
    const FieldRule& one = rule(card).rules[field];
    return one.ignored || in_expressions_.contains({card, field}) || !one.must_equal.empty() ||
           one.allowed.size() + one.allowed_texts.size() == 1;  // checked, and then it says nothing more
  }

  // What the card could still mean.
  std::vector<std::string_view> not_given(const CardRule& card, std::vector<std::string_view> names) const {
    std::erase_if(names, [&](std::string_view name) { return has_field(card, name); });
    return names;
  }

  void check_card(int index) {
    const CardRule& card = rule(index);
    const KnownCard* meaning = known(card.spec.name);
    const std::vector<std::string_view> names =
        meaning ? known_fields(*meaning) : std::vector<std::string_view>();
    for (std::size_t f = 0; f < card.spec.fields.size(); ++f) {
      const int field = static_cast<int>(f);
      const std::string& name = card.spec.fields[f].name;
      if (is_used(index, field) || means_something(meaning, names, name)) continue;
      if (!meaning && !has_used_field(index)) return unknown_card(card);
      error(card.rules[f].line, "field \"" + name + "\" of card \"" + card.spec.name + "\" is used by nothing" +
                                    nearest(name, not_given(card, names)) + " (or mark it: ignored = true)");
    }
    if (!meaning) return;
    for (const std::string_view group : words(meaning->needed)) {
      const std::vector<std::string_view> choice = words(group, '|');
      const bool given = std::any_of(choice.begin(), choice.end(), [&](auto n) { return has_field(card, n); });
      if (given) continue;
      std::string wanted;
      for (const std::string_view name : choice)
        wanted += (wanted.empty() ? "\"" : " or \"") + std::string(name) + "\"";
      error(card.line, "card \"" + card.spec.name + "\" has no field " + wanted + ", which it needs");
    }
    check_owner(index, *meaning);
  }

  // The layout itself makes use of the card: what is left of it is a matter of fields.
  bool has_used_field(int index) const {
    for (std::size_t f = 0; f < rule(index).spec.fields.size(); ++f)
      if (in_expressions_.contains({index, static_cast<int>(f)})) return true;
    return false;
  }
  void unknown_card(const CardRule& card) {
    std::vector<std::string_view> names;
    for (const KnownCard& one : kKnown)
      if (belongs(one)) names.push_back(one.name);
    error(card.line, "card \"" + card.spec.name + "\" is used by nothing" + nearest(card.spec.name, names) +
                         " (as = \"...\" renames it, ignored = true passes over it)");
  }

  void check_owner(int index, const KnownCard& meaning) {
    if (meaning.owner.empty()) return;
    const bool marked = meaning.owner[0] == '?' || meaning.owner[0] == '!';
    const std::string wanted(meaning.owner.substr(marked ? 1 : 0));
    const int owner = owners_[index];
    // Where the layout has no such card, what belongs to another stands on its own.
    if (marked && !has_card(wanted)) return;
    if (meaning.owner[0] == '?' && (owner < 0 || rule(index).is_item)) return;
    if (owner >= 0 && rule(owner).spec.name == wanted) return;
    const std::string found = owner < 0 ? "to none" : "to card \"" + rule(owner).spec.name + "\"";
    error(rule(index).line, "card \"" + rule(index).spec.name + "\" must belong to a card \"" + wanted +
                                "\" and belongs " + found + ": put opens = true on the \"" + wanted +
                                "\" card of its block");
  }

  const Layout& layout_;
  std::set<std::pair<int, int>> in_expressions_;
  std::string_view family_;
  std::vector<int> owners_;
  std::set<int> opening_;  // cards that those behind them belong to
  Diagnostics problems_;
};

}  // namespace

void check_names(const Layout& layout) {
  Diagnostics problems = NameCheck(layout).problems();
  if (problems.errors() > 0) throw InputError(std::move(problems));
}

Diagnostics name_problems(const Layout& layout) {
  return NameCheck(layout).problems();
}

std::vector<std::vector<NameUse>> name_uses(const Layout& layout) {
  const NameCheck check(layout);
  std::vector<std::vector<NameUse>> uses;
  for (std::size_t i = 0; i < layout.cards.size(); ++i) {
    uses.emplace_back();
    for (std::size_t f = 0; f < layout.cards[i].spec.fields.size(); ++f)
      uses.back().push_back(check.use_of(static_cast<int>(i), static_cast<int>(f)));
  }
  return uses;
}

std::string names_listing(const Layout& layout) {
  return NameCheck(layout).listing();
}

}  // namespace sage
