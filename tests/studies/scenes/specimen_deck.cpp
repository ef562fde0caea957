#include "tests/studies/scenes/specimen_deck.hpp"

#include <algorithm>

namespace sage::scenes {

namespace {

int renumbered(const SpecimenVariant& v, int plain) {
  return v.number ? v.number(plain) : plain;
}

// A body seen from below is numbered clockwise: turn the order around, first node first.
std::vector<int> oriented(std::vector<int> nodes, bool mirrored) {
  if (mirrored) std::reverse(nodes.begin() + 1, nodes.end());
  return nodes;
}

}  // namespace

std::vector<int> SpecimenDeck::platen() const {
  std::vector<int> list;
  const int first = (columns + 1) * (has_platen() ? rows + 1 : rows) + 1;
  for (int i = 0; i <= columns; ++i) list.push_back(renumbered(variant, first + i));
  return list;
}

std::vector<int> SpecimenDeck::solid_nodes() const {
  std::vector<int> list;
  for (int n = 1; n <= (columns + 1) * (rows + 1); ++n) list.push_back(renumbered(variant, n));
  return list;
}

void SpecimenDeck::write_materials(DeckWriter& deck) const {
  const double E = young * variant.stress, kn = normal_stiffness * variant.stress / variant.length;
  const PlatenFriction platen = friction.value_or(PlatenFriction{28.5, drucker_prager ? 120.0 : 5000.0, 0.9});
  if (drucker_prager) {
    std::vector<double> parameters{E, poisson.value_or(0.495), 0.0, 36.87, 0.0, 1.0, 1.0};
    if (elastic_beyond_apex) parameters.insert(parameters.end(), {-1.0, 1.0});
    deck.material(1, 3, parameters);
  } else {
    deck.material(1, 1, {E, poisson.value_or(0.25)});
  }
  if (has_platen())
    deck.material(2, 22, {0.0, platen.phi, 0.0, 0.0, platen.k_j, platen.exponent, kn, kn, 0.0, 1.0});
  deck.group(1, 1, formulation.value_or(drucker_prager ? 2 : 1), 1);
  if (has_platen()) deck.group(2, 11, 0, 2);
}

void SpecimenDeck::write_elements(DeckWriter& deck) const {
  const SpecimenVariant& v = variant;
  const int across = columns + 1,
            top_row = across * rows;  // the plain number of the row's first node, less one
  const auto node = [&](int plain) { return renumbered(v, plain); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int n = across * j + i + 1;
      deck.element(columns * j + i + 1, 1,
                   oriented({node(n), node(n + 1), node(n + across + 1), node(n + across)}, v.mirrored));
    }
  for (int i = 0; i < columns && has_platen(); ++i) {
    const int a = node(top_row + i + 1), b = node(top_row + i + 2);
    const int c = node(top_row + across + i + 2), d = node(top_row + across + i + 1);
    deck.element(columns * rows + i + 1, 2,
                 v.mirrored ? std::vector<int>{d, c, b, a} : std::vector<int>{a, b, c, d});
  }
  if (v.elements_backwards) std::reverse(deck.elements.begin(), deck.elements.end());
}

void SpecimenDeck::write_supports(DeckWriter& deck) const {
  for (int i = 0; i <= columns; ++i) deck.fix(renumbered(variant, i + 1), 0, 1);
  for (int j = 0; j <= rows; ++j) deck.fix(renumbered(variant, (columns + 1) * j + 1), 1, 0);
  for (int n : platen())
    if (has_platen()) deck.fix(n, 1, 1);
}

void SpecimenDeck::write_cell(StageCards& stage) const {
  const SpecimenVariant& v = variant;
  const double p = cell * v.stress;
  if (cell == 0.0) return;
  // Edges: side 2 and end 3 of a plain element; of a mirrored one 3 and 2, both counter-clockwise from node 1.
  for (int j = 0; j < rows; ++j) stage.pressure(columns * (j + 1), v.mirrored ? 3 : 2, p, p);
  for (int i = 0; i < columns; ++i) stage.pressure(columns * (rows - 1) + i + 1, v.mirrored ? 2 : 3, p, p);
}

// An end without platen is held only after the cell pressure stands: what holds a node would take what the initial
// stress lacks of it.
void SpecimenDeck::write_stages(DeckWriter& deck) const {
  if (!has_platen() && cell != 0.0) write_cell(deck.stage(1));
  StageCards& stage = deck.stage(increments);
  stage.method = method;
  stage.max_iterations = max_iterations;
  stage.output_every = output_every;
  const double moved = (variant.mirrored ? 1.0 : -1.0) * variant.length * axial_strain * height;
  for (int n : platen()) stage.fix(n, end == SpecimenEnd::pinned ? 1 : 0, 1, 0.0, moved);
  if (has_platen()) write_cell(stage);
}

std::string SpecimenDeck::text() const {
  const SpecimenVariant& v = variant;
  const double sign = v.mirrored ? -1.0 : 1.0;
  const int across = columns + 1;
  DeckWriter deck(2);
  deck.atmospheric_pressure = 14.696 * v.stress;
  deck.water_unit_weight = 0.036111 * v.stress / v.length;
  const auto z = [&](double up) { return v.length * (sign * up + v.shift); };
  const auto node = [&](int plain) { return renumbered(v, plain); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      deck.node(node(across * j + i + 1), v.length * radius * i / columns, z(height * j / rows));
  for (int i = 0; i <= columns && has_platen(); ++i)
    deck.node(node(across * (rows + 1) + i + 1), v.length * radius * i / columns, z(height));
  write_materials(deck);
  write_elements(deck);
  write_supports(deck);
  const double p = cell * v.stress;
  if (cell != 0.0) deck.initial(1, 0, p, p, p);
  write_stages(deck);
  return deck.text();
}

}  // namespace sage::scenes
