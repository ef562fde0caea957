// Materials, element groups and element cards (with block generation).
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/locking.hpp"

namespace sage::builder {

namespace {

// The formulation of a group of that material: sections of beams that may yield have one of their own.
int for_law(const ElementEntry& entry, const Formulation& named, const Material& material) {
  const auto yielding = std::ranges::find(entry.formulations, true, &Formulation::yields);
  const bool linear =
      std::visit([](const auto& law) { return law == nullptr || law->traits().linear; }, material.law);
  return linear || yielding == entry.formulations.end() ? named.code : yielding->code;
}

std::string formulations_of(const ElementEntry& entry) {
  std::string text;
  for (const Formulation& f : entry.formulations)
    text += (text.empty() ? "" : ", ") + std::to_string(f.code) + " " + f.name;
  return text;
}

// "solids": what an element's laws are for.
std::string laws_for(const ElementEntry& entry) {
  if (entry.flow()) return "the flow of water";
  if (entry.law_size == 4) return "solids";
  if (entry.law_size == 2) return "interfaces";
  return "structures of " + std::to_string(entry.law_size) +
         (entry.law_size == 1 ? " component" : " components");
}

// The structure that differs from this one by a node in the middle alone; 0 = there is none.
int with_middle_node(const Catalogue& catalogue, const ElementEntry& entry) {
  const auto fields = [](const ElementEntry& of) {
    std::vector<std::string> names;
    for (const ElementUnknown& unknown : of.unknowns) names.push_back(unknown.field.name);
    return names;
  };
  for (const auto& [code, other] : catalogue.elements.entries())
    if (other.structure() && other.corners == entry.corners && other.nodes == entry.nodes + 1 &&
        other.law_size == entry.law_size && other.extends == entry.extends && fields(other) == fields(entry))
      return code;
  return 0;
}

// A structure of two nodes beside sides with a node in the middle.
int chosen_structure(const Builder& b, const ElementEntry& entry, int deck_code) {
  const ElementEntry* wanted = b.catalogue.elements.find(b.options.element);
  if (wanted == nullptr || !entry.only_corners() || entry.nodes != 2 || wanted->makes_nodes()) return deck_code;
  const ElementEntry* joint = b.catalogue.elements.find(b.catalogue.elements.code_of(wanted->side_interface));
  if (joint == nullptr || joint->only_corners()) return deck_code;
  const int code = with_middle_node(b.catalogue, entry);
  return code != 0 ? code : deck_code;
}

// Whether the card of another quadrilateral gives this one its nodes, those inside made.
bool takes_cards_of(const ElementEntry& wanted, const ElementEntry& other) {
  return other.solid() && other.square() && wanted.solid() && wanted.square() &&
         other.nodes <= wanted.card_nodes;
}

// Quadrilaterals that have more nodes on their cards than the element in their place.
void check_replaced(Builder& b, const Group& group) {
  const ElementEntry* wanted = b.catalogue.elements.find(b.options.element);
  if (wanted == nullptr || group.entry == nullptr || group.element_code == b.options.element) return;
  if (!group.entry->solid() || !group.entry->square() || !group.entry->unknowns.empty()) return;
  b.error("S253", group.where,
          "group " + std::to_string(group.number) + " is of " + group.entry->name + ", and " + wanted->name +
              " (--element) can't take its place: its cards give more nodes than that has");
}

// The option must find something to replace.
void check_any_replaced(Builder& b) {
  const ElementEntry* wanted = b.catalogue.elements.find(b.options.element);
  if (b.options.element == 0 || wanted == nullptr || b.model.groups.empty()) return;
  const bool any = std::ranges::any_of(
      b.model.groups, [&](const Group& group) { return group.element_code == b.options.element; });
  if (!any)
    b.error("S253", b.model.groups.front().where,
            "the option --element: the deck has no quadrilaterals that " + wanted->name + " could replace");
}

// The deck's element, or the one that BuildOptions puts in its place.
int chosen_element(const Builder& b, int deck_code) {
  const ElementEntry* deck_entry = b.catalogue.elements.find(deck_code);
  if (b.options.element == 0 || deck_entry == nullptr) return deck_code;
  if (deck_entry->structure()) return chosen_structure(b, *deck_entry, deck_code);
  if (!deck_entry->unknowns.empty()) return deck_code;
  const ElementEntry* wanted = b.catalogue.elements.find(b.options.element);
  if (can_replace(wanted, *deck_entry)) return b.options.element;
  if (wanted == nullptr) return deck_code;
  if (takes_cards_of(*wanted, *deck_entry)) return b.options.element;
  // Quadratic solids need quadratic interfaces beside them.
  const int beside = b.catalogue.elements.code_of(wanted->side_interface);
  return deck_entry->interface() && deck_entry->square() && deck_entry->only_corners() && beside != 0
             ? beside
             : deck_code;
}

int chosen_formulation(const Builder& b, const ElementEntry& entry, int deck_code, bool replaced) {
  if (!entry.solid()) return deck_code;
  if (b.options.formulation >= 0) return b.options.formulation;
  return replaced ? 0 : deck_code;
}

constexpr int kMaxElements = 50'000'000;

// Fields of element cards.
struct ElementFields {
  FieldName number{"number"}, group{"group"}, columns{"columns"}, rows{"rows"}, column_step{"column_step"},
      row_step{"row_step"};
  std::array<FieldName, 15> nodes{FieldName("n1"),  FieldName("n2"),  FieldName("n3"),  FieldName("n4"),
                                  FieldName("n5"),  FieldName("n6"),  FieldName("n7"),  FieldName("n8"),
                                  FieldName("n9"),  FieldName("n10"), FieldName("n11"), FieldName("n12"),
                                  FieldName("n13"), FieldName("n14"), FieldName("n15")};
};

// Node numbers of one element card; trailing blanks are mid-side nodes to be made later (0).
std::vector<int> card_nodes(const CardView& card, ElementFields& fields) {
  std::vector<int> nodes;
  nodes.reserve(fields.nodes.size());
  for (FieldName& field : fields.nodes) nodes.push_back(card.integer(field));
  while (!nodes.empty() && nodes.back() == 0) nodes.pop_back();
  return nodes;
}

struct ElementCard {
  int number = 0, group = 0;
  std::vector<int> nodes;  // deck numbers
  int folded = -1;         // as in ElementPlace
};

// Writes the indices of the card's nodes to `index`, which has a place for each node of the element; -1 stays where
// a mid-side node is to be made.  False after an error.
bool find_nodes(Builder& b, const CardView& card, const ElementCard& element, const Group& group,
                std::span<int> index) {
  const ElementEntry& entry = *group.entry;
  const auto name = [&] { return "element " + std::to_string(element.number); };
  for (std::size_t i = 0; i < element.nodes.size(); ++i) {
    const int number = element.nodes[i];
    if (number == 0) continue;
    const int* node = b.node_index.find(number);
    if (node == nullptr) {
      if (b.nodes_known)
        b.error("S201", card.where("n" + std::to_string(i + 1)),
                name() + ": node " + std::to_string(number) + " is not defined by any node or fill card");
      return false;
    }
    if (std::find(index.begin(), index.end(), *node) != index.end()) {
      b.error("S216", card.where("n" + std::to_string(i + 1)),
              name() + ": node " + std::to_string(number) + " stands twice" +
                  (entry.interface() ? "; a pair of an interface is two nodes at one place, one of each body, "
                                       "also where the interface ends"
                   : entry.square() && entry.folded.empty()
                       ? "; only a 4-node quadrilateral becomes a triangle by that"
                       : ""));
      return false;
    }
    index[node_of_card(group, i, element.nodes.size())] = *node;
  }
  return true;
}

void add_element(Builder& b, const CardView& card, const ElementCard& element) {
  Group& group = b.model.groups[element.group];
  if (!b.element_place
           .try_emplace(element.number, ElementPlace{element.group, group.elements(), element.folded})
           .second) {
    b.error("S205", card.where("number"), "element " + std::to_string(element.number) + " is defined twice");
    return;
  }
  const std::size_t first = group.nodes.size();
  group.nodes.resize(first + static_cast<std::size_t>(group.entry->nodes), -1);
  if (!find_nodes(b, card, element, group, std::span(group.nodes).subspan(first))) {
    group.nodes.resize(first);
    return;
  }
  group.element_numbers.push_back(element.number);
  group.element_lines.push_back(card.card().line);
}

// What a group's elements are where a corner repeats the next: its twin group is made on demand.
int folded_group(Builder& b, int quad_group, int code) {
  const Group& quads = b.model.groups[quad_group];
  const int number = -quads.number;
  const auto found = b.group_index.find(number);
  if (found != b.group_index.end()) return found->second;
  Group group;
  group.number = quads.number;
  group.name = quads.name;
  set_element(group, b.catalogue, code, 0, b.model.geometry);
  group.material = quads.material;
  group.where = quads.where;
  b.group_index.emplace(number, static_cast<int>(b.model.groups.size()));
  b.model.groups.push_back(std::move(group));
  return static_cast<int>(b.model.groups.size()) - 1;
}

void fold(Builder& b, ElementCard& element) {
  const ElementEntry& entry = *b.model.groups[element.group].entry;
  const std::size_t corners = element.nodes.size();
  if (entry.folded.empty() || corners != static_cast<std::size_t>(entry.corners)) return;
  for (std::size_t i = 0; i < corners; ++i) {
    if (element.nodes[i] != element.nodes[(i + 1) % corners]) continue;
    const int code = b.catalogue.elements.code_of(entry.folded);
    if (code == 0) return;
    element.nodes.erase(element.nodes.begin() + static_cast<std::ptrdiff_t>(i));
    element.folded = static_cast<int>(i);
    element.group = folded_group(b, element.group, code);
    return;
  }
}

// A block of elements that starts with the one on the card.
struct Block {
  int columns = 1, rows = 1, column_step = 1, row_step = 0;  // steps of node numbers
};

// False, and an error, where the card's block can't be counted out.
bool read_block(Builder& b, const CardView& card, const ElementCard& element, ElementFields& fields,
                Block& block) {
  const int columns = card.integer(fields.columns), rows = card.integer(fields.rows);
  block = {std::max(1, columns), std::max(1, rows), card.integer(fields.column_step, 1),
           card.integer(fields.row_step)};
  const int before = b.problems.errors();
  for (const auto& [field, count] : {std::pair("columns", columns), std::pair("rows", rows)})
    if (count < 0) b.error("S207", card.where(field), "the " + card.label(field) + " must not be negative");
  const std::int64_t count = std::int64_t{block.columns} * block.rows;
  if (count > kMaxElements)
    b.error("S218", card.where("columns"),
            "the block would have more than " + std::to_string(kMaxElements) + " elements");
  if (block.columns > 1 && block.column_step == 0)
    b.error("S218", card.where("column_step"),
            "more than one column of elements needs the node step along a row");
  if (block.rows > 1 && block.row_step == 0)
    b.error("S218", card.where("row_step"),
            "more than one row of elements needs the node step from row to row");
  if (element.number < 1 || (count <= kMaxElements && element.number + count - 1 > kLargestNumber))
    b.error("S206", card.where("number"),
            "element number " + std::to_string(element.number) +
                (element.number < 1 ? " must be 1 or more" : " is too large for the block"));
  if (b.problems.errors() > before) return false;
  // Every node number of the block lies between those of its corner elements.
  for (const std::int64_t i : {0, block.columns - 1})
    for (const std::int64_t j : {0, block.rows - 1})
      for (const int n : element.nodes) {
        const std::int64_t number = n + i * block.column_step + j * block.row_step;
        if (n == 0 || (number >= 1 && number <= kLargestNumber)) continue;
        b.error("S218", card.where("n1"),
                "element " + std::to_string(element.number) + ": its block leads to node " +
                    std::to_string(number) + ", which can't exist");
        return false;
      }
  return true;
}

void read_element_card(Builder& b, const CardView& card, ElementFields& fields) {
  const int group_number = card.integer(fields.group, 1);
  const auto group = b.group_index.find(group_number);
  if (group == b.group_index.end() || group_number < 1) {
    b.group_missing(card.where("group"), group_number);
    return;
  }
  const Group& target = b.model.groups[group->second];
  if (!target.element) return;  // its own error was reported
  const ElementEntry& entry = *target.entry;
  ElementCard element{card.integer(fields.number), group->second, card_nodes(card, fields)};
  // A card with one node alone reads like one of another kind: that of a ring may give its node twice.
  if (entry.card_nodes == 1 && element.nodes.size() == 2 && element.nodes[0] == element.nodes[1])
    element.nodes.pop_back();
  const int given = static_cast<int>(element.nodes.size());
  if (given < entry.corners || given > entry.card_nodes) {
    b.error("S217", card.where("n1"),
            "element " + std::to_string(element.number) + ": " + entry.name + " has " +
                std::to_string(entry.corners) +
                (entry.nodes > entry.corners ? " to " + std::to_string(entry.card_nodes) : "") +
                " nodes on its card, not " + std::to_string(given));
    return;
  }
  if (std::find(element.nodes.begin() + entry.corners, element.nodes.end(), 0) != element.nodes.end() ||
      (given > entry.corners && given < std::min(entry.nodes, 2 * entry.corners)))
    b.note("S217", card.where(),
           "element " + std::to_string(element.number) +
               ": some of its mid-side nodes are left blank "
               "and will be made, though others are given");
  for (const auto& [step, count] :
       {std::pair(&fields.column_step, &fields.columns), std::pair(&fields.row_step, &fields.rows)}) {
    if (card.blank(*step) || card.integer(*step) == 0 || !card.blank(*count)) continue;
    b.note("S219", card.where(step->name()),
           "the " + card.label(step->name()) + " is given but the number of " + count->name() +
               " is left blank, which reads as 1");
  }
  for (int c = 0; c < entry.corners; ++c) {
    if (element.nodes[c] != 0) continue;
    const std::string field = "n" + std::to_string(c + 1);
    b.error("S217", card.where(field),
            "element " + std::to_string(element.number) + ": corner node " + std::to_string(c + 1) +
                " of the " + entry.name + " is missing");
    return;
  }
  Block block;
  if (!read_block(b, card, element, fields, block)) return;
  const int target_group = group->second;  // folding triangles may add to the index
  ElementCard next;
  for (int j = 0; j < block.rows; ++j) {
    for (int i = 0; i < block.columns; ++i) {
      next.number = element.number + j * block.columns + i;
      next.group = target_group;
      next.nodes = element.nodes;
      next.folded = -1;
      for (int& n : next.nodes)
        if (n != 0) n += i * block.column_step + j * block.row_step;
      fold(b, next);
      const int before = b.problems.errors();
      add_element(b, card, next);
      if (b.problems.errors() > before) return;  // one message a card
    }
  }
}

// Every parameter of a law, from its card or its fallback.  `given` stands on the first of the cards, if any.
void read_parameters(Builder& b, Material& m, const SourcePosition& where, const ValueList& given,
                     const std::vector<CardView>& cards) {
  const std::string name = "material " + std::to_string(m.number);
  for (std::size_t i = 0; i < m.entry->parameters.size(); ++i) {
    const Parameter& p = m.entry->parameters[i];
    const bool present = i < given.size() && !given[i].blank;
    if (!present && p.required)
      b.error("S221", i < given.size() ? cards.front().where(given[i]) : where,
              name + ": parameter " + std::to_string(i + 1) + " of " + m.entry->name + ", " + p.name + " (" +
                  unit_text(p.dimension, b.model.units) + "), is missing");
    const double value = present ? given[i].number : p.fallback;
    if (!present && i < given.size() && !p.required) {
      b.note("S222", cards.front().where(given[i]),
             name + ": parameter " + std::to_string(i + 1) + " of " + m.entry->name + ", " + p.name +
                 ", is left blank: " + rounded_text(p.fallback, 6) + " is used");
    }
    if (!(std::abs(value) < 1e100))
      b.error("S208", cards.front().where(given[i]),
              name + ": " + p.name + " is too large to compute with (beyond 1e100)");
    m.parameters.push_back(value);
  }
  for (std::size_t i = m.entry->parameters.size(); i < given.size(); ++i) {
    if (!(std::abs(given[i].number) < 1e100))
      b.error("S208", cards.front().where(given[i]),
              name + ": parameter " + std::to_string(i + 1) + " is too large to compute with (beyond 1e100)");
    m.parameters.push_back(given[i].blank ? 0.0 : given[i].number);
  }
}

// Of laws with one friction angle and one dilation angle.
void associate(Material& m) {
  const int phi = m.entry->find(ParameterRole::friction_angle),
            psi = m.entry->find(ParameterRole::dilation_angle);
  if (!m.entry->for_solids() || phi < 0 || psi < 0) return;
  m.parameters[psi] = m.parameters[phi];
  const int flow = m.entry->find("flow");  // of cones: 1 without volume change
  if (flow >= 0) m.parameters[flow] = 0.0;
}

void read_material(Builder& b, const CardView& card, const std::vector<CardView>& parameter_cards) {
  Material material;
  material.number = card.integer("number");
  material.name = b.text(card, "name");
  material.code = card.integer("law");
  material.unit_weight = card.real("unit_weight");
  material.saturated_unit_weight = card.real("saturated_unit_weight");
  material.where = card.where();
  const MaterialEntry* entry = b.catalogue.materials.find(material.code);
  const std::string name = "material " + std::to_string(material.number);
  if (material.number < 1) b.error("S206", card.where("number"), "a material number must be 1 or more");
  if (!b.material_index.try_emplace(material.number, static_cast<int>(b.model.materials.size())).second)
    b.error("S205", card.where("number"), name + " is defined twice");
  b.usable(card, "unit_weight", material.unit_weight);
  b.usable(card, "saturated_unit_weight", material.saturated_unit_weight);
  if (material.saturated_unit_weight != 0.0 && !(material.saturated_unit_weight >= material.unit_weight))
    b.error("S210", card.where("saturated_unit_weight"),
            name + ": the saturated unit weight is at least the unit weight, " +
                rounded_text(material.unit_weight));
  if (card.blank("unit_weight")) b.blank_weights.push_back(material.number);
  b.model.materials.push_back(std::move(material));
  Material& m = b.model.materials.back();
  if (entry == nullptr) {
    b.error("S212", card.where("law"),
            name + ": law " + std::to_string(m.code) + " is unknown; known: " + b.catalogue.materials.known() +
                plugin_hint(m.code));
    return;
  }
  m.law_name = entry->name;
  m.entry = b.catalogue.materials.share(m.code);
  ValueList given;
  SourcePosition where = card.where();
  if (!parameter_cards.empty()) {
    given = parameter_cards.front().list("values");
    where = parameter_cards.front().where();
  }
  if (given.size() > entry->parameters.size() && !entry->open_ended) {
    b.error("S223", where,
            name + ": law " + entry->name + " has " + std::to_string(entry->parameters.size()) +
                " parameters, the card gives " + std::to_string(given.size()));
    return;
  }
  const int before = b.problems.errors();
  read_parameters(b, m, where, given, parameter_cards);
  if (b.problems.errors() > before) return;
  if (b.options.associated) associate(m);
  try {
    m.law = entry->law_for(m.parameters, b.model.units, m.name);
  } catch (const ParameterError& e) {
    const auto i = static_cast<std::size_t>(std::max(0, e.parameter()));
    const bool known = e.parameter() >= 0 && i < given.size();
    b.error(e.code(), known ? parameter_cards.front().where(given[i]) : where,
            name + " (" + entry->name + "): " + e.what() +
                (i < entry->parameters.size() && e.parameter() >= 0
                     ? " [" + entry->parameters[i].name + ", " +
                           unit_text(entry->parameters[i].dimension, b.model.units) + "]"
                     : ""));
  }
}

}  // namespace

void build_materials(Builder& b) {
  const int before = b.problems.errors();
  for (const CardView& card : b.deck.all("material")) read_material(b, card, b.deck.all("parameters", card));
  b.materials_known = b.problems.errors() == before;
}

namespace {

// Components of a law; 0 where the material has none.
int law_size_of(const Builder& b, const Material& material) {
  const MaterialEntry* const law = b.catalogue.materials.find(material.code);
  return law != nullptr ? law->law_size : 0;
}

// The second law of elements that have two (ElementTraits::second_law_size).  Where the layout has no such field, a host
// program sets Group::second_material; analyse_scene checks that it is there.
void read_second_law(Builder& b, const CardView& card, Group& group) {
  if (group.element == nullptr) return;
  const int number = card.integer("second_material"), size = group.element->traits().second_law_size;
  const std::string name = "group " + std::to_string(group.number);
  const bool pores = group.entry->has_pores();
  if (number == 0 && !pores) return;
  if (size == 0) {
    b.error("S225", card.where("second_material"), name + ": " + group.entry->name + " has one law only");
    return;
  }
  const auto found = b.material_index.find(number);
  if (found != b.material_index.end()) {
    group.second_material = found->second;
    const Material& second = b.model.materials[found->second];
    const MaterialEntry* const law = b.catalogue.materials.find(second.code);
    if (law_size_of(b, second) == size && law->of_pores == pores && !law->flow) return;
  } else if (number != 0) {
    b.error("S204", card.where("second_material"),
            name + ": second material " + std::to_string(number) + " is not defined by any material card");
    return;
  }
  b.error(
      "S225", card.where("second_material"),
      name + ": " + group.entry->name + " needs a second material, whose law " +
          (pores ? std::string("is for flow of pore water: ") + (group.interface() ? "pore_joint" : "pore_flow")
                 : "has " + std::to_string(size) + (size == 1 ? " component" : " components")));
}

// The element of a group in the formulation that the card names or leaves open.
void read_formulation(Builder& b, const CardView& card, const ElementEntry& entry, bool replaced,
                      bool material_known, Group& group) {
  const std::string name = "group " + std::to_string(group.number);
  const Material* material = material_known ? &b.model.materials[group.material] : nullptr;
  int formulation = chosen_formulation(b, entry, card.integer("formulation"), replaced);
  if (formulation == 0 && material != nullptr && b.options.dilates)
    formulation = default_formulation(entry, b.model.geometry, !dilation_of(*material).none()).code;
  const auto found =
      std::find_if(entry.formulations.begin(), entry.formulations.end(),
                   [&](const Formulation& f) { return f.code == formulation || formulation == 0; });
  if (found == entry.formulations.end()) {
    b.error("S210", card.where("formulation"),
            name + ": formulation " + std::to_string(formulation) + " of " + entry.name +
                " is unknown; 0 default, " + formulations_of(entry));
    return;
  }
  try {
    set_element(group, b.catalogue, group.element_code,
                material == nullptr ? found->code : for_law(entry, *found, *material), b.model.geometry);
  } catch (const ParameterError& error) {
    b.error(error.code(), card.where("element"), name + ": " + error.what());
  }
}

}  // namespace

void build_groups(Builder& b) {
  const int before = b.problems.errors();
  for (const CardView& card : b.deck.all("group")) {
    Group group;
    group.number = card.integer("number");
    group.name = b.text(card, "name");
    group.overlay = card.integer("overlay") == 1;
    group.where = card.where();
    const std::string name = "group " + std::to_string(group.number);
    if (group.number < 1) b.error("S206", card.where("number"), "a group number must be 1 or more");
    if (!b.group_index.try_emplace(group.number, static_cast<int>(b.model.groups.size())).second)
      b.error("S205", card.where("number"), name + " is defined twice");
    const int deck_code = card.integer("element");
    group.element_code = chosen_element(b, deck_code);
    const ElementEntry* entry = b.catalogue.elements.find(group.element_code);
    const auto material = b.material_index.find(card.integer("material"));
    if (entry == nullptr)
      b.error("S211", card.where("element"),
              name + ": element type " + std::to_string(group.element_code) +
                  " is unknown; known: " + b.catalogue.elements.known() + plugin_hint(group.element_code));
    if (material != b.material_index.end())
      group.material = material->second;
    else if (b.materials_known)
      b.error("S204", card.where("material"),
              name + ": material " + std::to_string(card.integer("material")) +
                  " is not defined by any material card");
    if (entry != nullptr) {
      read_formulation(b, card, *entry, group.element_code != deck_code, material != b.material_index.end(),
                       group);
      if (material != b.material_index.end()) {
        const Material& m = b.model.materials[material->second];
        const MaterialEntry* law = b.catalogue.materials.find(m.code);
        if (law != nullptr && (law->law_size != entry->law_size || law->flow != entry->flow() || law->of_pores))
          b.error("S225", card.where("material"),
                  name + ": " + entry->name + " needs a law for " + laws_for(*entry) + ", material " +
                      std::to_string(m.number) + " is " + law->name);
      }
    }
    read_second_law(b, card, group);
    if (b.problems.errors() == before) check_replaced(b, group);
    b.model.groups.push_back(std::move(group));
  }
  if (b.problems.errors() == before) check_any_replaced(b);
  if (b.model.groups.empty())
    b.error("S214", b.deck.one("control").where(), "the deck defines no element groups");
  b.groups_known = b.problems.errors() == before;
}

void build_elements(Builder& b) {
  const int before = b.problems.errors();
  ElementFields fields;
  for (const CardView& card : b.deck.all("element")) read_element_card(b, card, fields);
  b.elements_known = b.nodes_known && b.groups_known && b.problems.errors() == before;
  if (b.element_place.empty() && b.problems.errors() == 0)
    b.error("S214", b.deck.one("control").where(), "the deck defines no elements");
}

}  // namespace sage::builder
