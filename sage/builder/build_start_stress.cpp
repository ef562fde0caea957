// Stress of the ground before anything is done to it: weight of what lies above, and earth pressure at rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/exchange/boundary_edges.hpp"

namespace sage::builder {

namespace {

// An element by its levels and by what should be one over the whole width.
struct Part {
  double low = 0.0, high = 0.0, value = 0.0;
  int group = 0, element = 0;
};

// Two parts that share levels and differ in value.
struct SideBySide {
  Part one, other;
  double low = 0.0, high = 0.0;
};

// Groups that a birth card names; their stress is not that of the start.
bool is_born_later(const Builder& b, const Group& group) {
  for (const CardView& card : b.deck.all("birth")) {
    const auto groups = card.list("groups");
    for (const FieldValue& value : groups)
      if (value.number == static_cast<double>(group.number)) return true;
  }
  return false;
}

bool is_ground(const Group& group) {
  return group.element && group.solid() && group.elements() > 0;
}

// The card that has the k0 of a material: start_stress, or else the material's; start_stress too without that.
CardView card_of_k0(const Builder& b, const CardView& card, const Material& material) {
  if (!card.blank("k0")) return card;
  for (const CardView& m : b.deck.all("material"))
    if (m.integer("number") == material.number) return m;
  return card;
}

double k0_of(Builder& b, const CardView& card, const Material& material) {
  const CardView with_k0 = card_of_k0(b, card, material);
  if (!with_k0.blank("k0")) return with_k0.real("k0");
  b.error("S245", with_k0.where("k0"),
          "material " + std::to_string(material.number) +
              ": the coefficient of earth pressure at rest, field " +
              "k0, is blank: the start stress needs it on the material card or on the start_stress card");
  return 0.0;
}

// Lowest and highest level of an element's nodes.
std::array<double, 2> levels_of(const Builder& b, const Group& group, int element) {
  double low = 1e300, high = -1e300;
  for (std::size_t i = 0; i < group.node_count(); ++i) {
    const int node = group.nodes_of(element)[i];
    if (node < 0) continue;  // a mid-side node that is still to be made
    low = std::min(low, b.model.mesh.x(1, node));
    high = std::max(high, b.model.mesh.x(1, node));
  }
  return {low, high};
}

// The elements of groups for which value(group) gives one.
template <class Value>
std::vector<Part> parts_of(const Builder& b, const Value& value) {
  std::vector<Part> parts;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (!is_ground(group) || group.overlay || is_born_later(b, group)) continue;
    const std::optional<double> one = value(group);
    if (!one) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const auto [low, high] = levels_of(b, group, e);
      parts.push_back({low, high, *one, static_cast<int>(g), e});
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& c) { return a.high > c.high; });
  return parts;
}

double height_of(const std::vector<Part>& parts) {
  double low = 1e300, high = -1e300;
  for (const Part& part : parts) {
    low = std::min(low, part.low);
    high = std::max(high, part.high);
  }
  return high - low;
}

// But for the rounding of a layout's factors.
bool same_value(double a, double b) {
  return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

// Layers of one value from the top down; parts come in the order of their upper ends.
std::vector<GroundLayer> layers_of(const std::vector<Part>& parts, std::optional<SideBySide>& uneven) {
  const double close = 1e-9 * height_of(parts);
  std::vector<GroundLayer> layers;
  Part lowest;  // of the last layer
  for (const Part& part : parts) {
    const bool below = layers.empty() || part.high <= layers.back().bottom + close;
    if (!below && !same_value(part.value, layers.back().unit_weight)) {
      uneven = {lowest, part, std::max(lowest.low, part.low), std::min(lowest.high, part.high)};
      return layers;
    }
    const bool goes_on = !layers.empty() && same_value(part.value, layers.back().unit_weight) &&
                         part.high >= layers.back().bottom - close;
    if (!goes_on) layers.push_back({part.high, part.low, part.value, 0.0});
    if (!goes_on || part.low < layers.back().bottom) lowest = part;
    layers.back().bottom = std::min(layers.back().bottom, part.low);
  }
  for (std::size_t i = 1; i < layers.size(); ++i) {
    const GroundLayer& above = layers[i - 1];
    layers[i].stress = above.stress + above.unit_weight * (above.top - above.bottom);
  }
  return layers;
}

std::string element_name(const Builder& b, const Part& part) {
  const Group& group = b.model.groups[part.group];
  return "element " + std::to_string(group.element_numbers[part.element]);
}

// "element 3 (20) and element 7 (16), both between y = 4 and y = 5"
std::string place_of(const Builder& b, const SideBySide& two) {
  return element_name(b, two.one) + " (" + rounded_text(two.one.value) + ") and " + element_name(b, two.other) +
         " (" + rounded_text(two.other.value) + "), both between y = " + rounded_text(two.low) +
         " and y = " + rounded_text(two.high);
}

// The layer in the middle of an element's height.
int layer_at(const std::vector<GroundLayer>& layers, double y) {
  int layer = 0;
  while (layer + 1 < static_cast<int>(layers.size()) && y < layers[layer].bottom) ++layer;
  return layer;
}

double middle_of_element(const Builder& b, const Group& group, int element) {
  const auto [low, high] = levels_of(b, group, element);
  return 0.5 * (low + high);
}

// A part keeps the life of its group: where that is removed, it is too.
void keep_removed(Builder& b, int group, int piece) {
  for (auto& [card, groups] : b.removed)
    if (std::find(groups.begin(), groups.end(), group) != groups.end()) {
      groups.push_back(piece);
      return;
    }
}

// Layers that a group with a part in the first of them has besides.
void split_by_layers(Builder& b, int g) {
  const Group& group = b.model.groups[g];
  std::vector<int> keys;
  for (int e = 0; e < group.elements(); ++e) keys.push_back(layer_at(b.layers, middle_of_element(b, group, e)));
  if (keys.empty()) return;
  const int first = *std::min_element(keys.begin(), keys.end());
  std::replace(keys.begin(), keys.end(), first, -1);
  for (const auto& [key, piece] : split_group(b, g, keys, "layer")) {
    b.layer_pieces.push_back(piece);
    keep_removed(b, g, piece);
  }
}

// The smallest number of a node of the ground at this level.
int node_at(const Builder& b, double y) {
  int least = std::numeric_limits<int>::max();
  for (const Group& group : b.model.groups)
    for (const int node : group.nodes)
      if (is_ground(group) && node >= 0 && b.model.mesh.x(1, node) == y)
        least = std::min(least, b.model.mesh.number[node]);
  return least;
}

// The level of the ground's surface: the top layer reaches up to it.
void raise_to_level(Builder& b, const CardView& card) {
  GroundLayer& top = b.layers.front();
  const double level = card.real("level", top.top);
  if (!b.usable(card, "level", level)) return;
  const double close = 1e-9 * std::max({top.top - b.layers.back().bottom, std::abs(level), std::abs(top.top)});
  if (level < top.top - close)
    return b.error("S245", card.where("level"),
                   "the level of the ground, " + rounded_text(level) + ", is below node " +
                       std::to_string(node_at(b, top.top)) + ", the highest of the ground, y = " +
                       rounded_text(top.top) + ": the start stress between them would be tension");
  const double lift = level - top.top;
  top.top = level;
  for (std::size_t i = 1; i < b.layers.size(); ++i) b.layers[i].stress += lift * top.unit_weight;
}

// Neighbours of different k0 push each other with different stress.
void warn_of_sides(Builder& b, const CardView& card) {
  const std::vector<Part> parts = parts_of(b, [&](const Group& group) {
    const CardView with_k0 = card_of_k0(b, card, b.model.material_of(group));
    return with_k0.blank("k0") ? std::optional<double>() : with_k0.real("k0");
  });
  std::optional<SideBySide> uneven;
  layers_of(parts, uneven);
  if (uneven)
    b.warning("S246", card.where(),
              "the start stress is not in balance: coefficients of earth pressure at rest differ "
              "on one level: " +
                  place_of(b, *uneven));
}

// Which directions each node is held in at the start.
std::vector<std::array<char, 2>> held_nodes(const Builder& b, const Stage& stage) {
  std::vector<std::array<char, 2>> held(static_cast<std::size_t>(b.model.mesh.nodes()));
  for (const std::vector<Fixity>* list : {&b.model.fixities, &stage.fixities})
    for (const Fixity& f : *list)
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] == FixityCode::fixed) held[f.node][c] = 1;
  return held;
}

// An interface would start without the pressure of the ground on both of its sides.
void refuse_interfaces(Builder& b, const CardView& card) {
  for (const Group& group : b.model.groups)
    if (group.element && group.interface() && group.elements() > 0 && !is_born_later(b, group))
      return b.error("S245", card.where(),
                     "group " + std::to_string(group.number) +
                         " holds interfaces, to which start_stress gives no pressure of the ground; "
                         "initial cards in its place do: kind 1 for the ground, kind 3 for interfaces");
}

// Faces that the start stress pulls or pushes and nothing holds get the pressure that balances it there: such
// programs count from a state that they take to be in equilibrium.
int hold_free_faces(Builder& b, const std::vector<const InitialStress*>& of_group, Stage& stage) {
  const std::vector<std::array<char, 2>> held = held_nodes(b, stage);
  double largest = 0.0;
  std::vector<EdgeLoad> faces;
  for (const BoundaryEdge& edge : boundary_edges(b.model)) {
    const InitialStress* initial = of_group[edge.group];
    if (initial == nullptr) continue;
    std::array<bool, 2> holds{true, true};
    for (const int node : edge.nodes)
      for (std::size_t c = 0; node >= 0 && c < 2; ++c) holds[c] = holds[c] && held[node][c] != 0;
    const Vector2 ends[] = {b.model.mesh.x.col(edge.nodes[0]), b.model.mesh.x.col(edge.nodes[1])};
    const Vector2 along = (ends[1] - ends[0]).normalized(), out(along.y(), -along.x());
    EdgeLoad face{edge.group, edge.element, edge.edge, Vector2::Zero(), Vector2::Zero(), stage.where.line};
    for (int i = 0; i < 2; ++i) {
      const double vertical = initial->value[3] + initial->value[1] * (initial->value[0] - ends[i].y());
      Vector2 traction(-initial->value[2] * vertical * out.x(), -vertical * out.y());
      largest = std::max(largest, vertical);
      for (int c = 0; c < 2; ++c)
        if (holds[c]) traction[c] = 0.0;
      face.normal[i] = -traction.dot(out);
      face.shear[i] = traction.dot(along);
    }
    faces.push_back(face);
  }
  std::erase_if(faces, [largest](const EdgeLoad& face) {
    return std::max(face.normal.cwiseAbs().maxCoeff(), face.shear.cwiseAbs().maxCoeff()) <= 1e-12 * largest;
  });
  stage.pressures.insert(stage.pressures.end(), faces.begin(), faces.end());
  return static_cast<int>(faces.size());
}

// The stress of a group, all of which lies in one layer.
InitialStress stress_of(Builder& b, const CardView& card, int g) {
  const Group& group = b.model.groups[g];
  const Material& material = b.model.material_of(group);
  GroundLayer layer{b.layers.front().top, 0.0, material.unit_weight, 0.0};
  if (!group.overlay) layer = b.layers[layer_at(b.layers, middle_of_element(b, group, 0))];
  InitialStress initial;
  initial.group = g;
  initial.kind = InitialKind::geostatic;
  initial.value = {layer.top, layer.unit_weight, k0_of(b, card, material), layer.stress, 0.0, 0.0};
  initial.where = card.where();
  return initial;
}

}  // namespace

void split_layers(Builder& b) {
  const std::vector<CardView> cards = b.deck.all("start_stress");
  if (cards.empty() || b.problems.errors() > 0) return;
  const CardView& card = cards.front();
  if (cards.size() > 1) return b.error("S245", cards[1].where(), "there is a start_stress card already");
  std::optional<SideBySide> uneven;
  b.layers = layers_of(
      parts_of(b, [&](const Group& group) { return std::optional(b.model.material_of(group).unit_weight); }),
      uneven);
  if (uneven)
    return b.error("S245", card.where(),
                   "the start stress needs horizontal layers, each of one unit weight over the "
                   "whole width; here unit weights differ on one level: " +
                       place_of(b, *uneven) +
                       "; a gravity card in place of start_stress puts the weight on any ground");
  if (b.layers.empty()) return;
  raise_to_level(b, card);
  const int groups = static_cast<int>(b.model.groups.size());
  for (int g = 0; b.problems.errors() == 0 && g < groups; ++g) {
    const Group& group = b.model.groups[g];
    if (is_ground(group) && !group.overlay && !is_born_later(b, group)) split_by_layers(b, g);
  }
}

void add_start_stress(Builder& b, Stage stage) {
  if (b.layers.empty() || b.problems.errors() > 0) {  // nothing to say about a deck without stages as well
    b.model.stages.insert(b.model.stages.begin(), std::move(stage));
    return;
  }
  const CardView card = b.deck.all("start_stress").front();
  refuse_interfaces(b, card);
  std::vector<const InitialStress*> of_group(b.model.groups.size(), nullptr);
  b.model.initials.reserve(b.model.initials.size() + b.model.groups.size());
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (!is_ground(group) || is_born_later(b, group)) continue;
    b.model.initials.push_back(stress_of(b, card, static_cast<int>(g)));
    of_group[g] = &b.model.initials.back();
  }
  stage.gravity = {0.0, -1.0};
  if (b.problems.errors() == 0) {
    warn_of_sides(b, card);
    const int faces = hold_free_faces(b, of_group, stage);
    if (faces > 0)
      b.note("S246", card.where(),
             std::to_string(faces) +
                 " free edge(s) are under the start stress: pressures balance it there, "
                 "so that the start is in equilibrium");
  }
  b.model.stages.insert(b.model.stages.begin(), std::move(stage));
}

}  // namespace sage::builder
