#include "sage/scenes/specimen_deck.hpp"

#include <algorithm>

namespace sage::scenes {

namespace {

// Sizes whose parts are short decimals: ten columns of a card then hold them exactly.
constexpr double kRadius = 1.5, kHeight = 3.0, kCell = 50.0;

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
  const int first = (columns + 1) * (rows + 1) + 1;
  for (int i = 0; i <= columns; ++i) list.push_back(renumbered(variant, first + i));
  return list;
}

std::vector<int> SpecimenDeck::solid_nodes() const {
  std::vector<int> list;
  for (int n = 1; n <= (columns + 1) * (rows + 1); ++n) list.push_back(renumbered(variant, n));
  return list;
}

std::string SpecimenDeck::text() const {
  const SpecimenVariant& v = variant;
  const double sign = v.mirrored ? -1.0 : 1.0;
  const int across = columns + 1,
            top_row = across * rows;  // the plain number of the row's first node, less one
  DeckWriter deck(2);
  deck.atmospheric_pressure = 14.696 * v.stress;
  deck.water_unit_weight = 0.036111 * v.stress / v.length;
  const auto z = [&](double height) { return v.length * (sign * height + v.shift); };
  const auto node = [&](int plain) { return renumbered(v, plain); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      deck.node(node(across * j + i + 1), v.length * kRadius * i / columns, z(kHeight * j / rows));
  for (int i = 0; i <= columns; ++i)
    deck.node(node(across * (rows + 1) + i + 1), v.length * kRadius * i / columns, z(kHeight));

  const double E = 3000.0 * v.stress, kn = normal_stiffness * v.stress / v.length;
  if (drucker_prager)
    deck.material(1, 3, {E, 0.495, 0.0, 36.87, 0.0, 1.0, 1.0});
  else
    deck.material(1, 1, {E, 0.25});
  deck.material(2, 22, {0.0, 28.5, 0.0, 0.0, drucker_prager ? 120.0 : 5000.0, 0.9, kn, kn, 0.0, 1.0});
  deck.group(1, 1, drucker_prager ? 2 : 1, 1);
  deck.group(2, 11, 0, 2);

  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int n = across * j + i + 1;
      deck.element(columns * j + i + 1, 1,
                   oriented({node(n), node(n + 1), node(n + across + 1), node(n + across)}, v.mirrored));
    }
  for (int i = 0; i < columns; ++i) {
    const int a = node(top_row + i + 1), b = node(top_row + i + 2);
    const int c = node(top_row + across + i + 2), d = node(top_row + across + i + 1);
    deck.element(columns * rows + i + 1, 2,
                 v.mirrored ? std::vector<int>{d, c, b, a} : std::vector<int>{a, b, c, d});
  }
  if (v.elements_backwards) std::reverse(deck.elements.begin(), deck.elements.end());

  for (int i = 0; i <= columns; ++i) deck.fix(node(i + 1), 0, 1);
  for (int j = 0; j <= rows; ++j) deck.fix(node(across * j + 1), 1, 0);
  for (int n : platen()) deck.fix(n, 1, 1);
  const double p = kCell * v.stress;
  deck.initial(1, 0, p, p, p);

  StageCards& stage = deck.stage(increments);
  stage.method = method;
  stage.max_iterations = max_iterations;
  stage.output_every = output_every;
  for (int n : platen()) stage.fix(n, 0, 1, 0.0, -sign * v.length * axial_strain * kHeight);
  // Edges: side 2 and end 3 of a plain element; of a mirrored one 3 and 2, both counter-clockwise from node 1.
  for (int j = 0; j < rows; ++j) stage.pressure(columns * (j + 1), v.mirrored ? 3 : 2, p, p);
  for (int i = 0; i < columns; ++i) stage.pressure(columns * (rows - 1) + i + 1, v.mirrored ? 2 : 3, p, p);
  return deck.text();
}

}  // namespace sage::scenes
