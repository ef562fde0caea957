#include "sage/stress/decks.hpp"

#include <cmath>

namespace sage::stress {

using study::rectangle;

std::vector<double> coulomb(double c, double phi, double ks, double kn) {
  std::vector<double> values(10, 0.0);
  values[0] = c;
  values[1] = phi;
  values[4] = ks;
  values[6] = values[7] = kn;
  return values;
}

Block TriaxialDeck::block() const {
  Block block;
  block.columns = columns;
  block.rows = rows;
  block.place = rectangle(0.0, 1.0, 0.0, 2.0);
  return block;
}

std::string TriaxialDeck::text() const {
  const Block mesh = block();
  DeckWriter deck(geometry);
  mesh.write_nodes(deck);
  deck.material(1, law, parameters);
  deck.group(1, 1, 2, 1);
  mesh.write_elements(deck, 1);
  for (int n : mesh.bottom()) deck.fix(n, rough_base ? 1 : 0, 1);
  for (int n : mesh.left()) deck.fix(n, 1, 0);
  if (cell != 0.0) deck.initial(1, 0, cell, cell, cell);
  for (std::size_t s = 0; s < strains.size(); ++s) {
    StageCards& stage = deck.stage(increments);
    stage.method = method;
    stage.max_iterations = max_iterations;
    for (int n : mesh.top()) stage.fix(n, 0, 1, 0.0, -2.0 * strains[s]);
    if (s == 0 && cell != 0.0)
      for (int j = 0; j < rows; ++j) stage.pressure(mesh.element(columns - 1, j), 2, cell, cell);
  }
  return deck.text();
}

double axial_stress(const TriaxialDeck& deck, const study::WholeRun& run, std::size_t stage) {
  const auto last = static_cast<std::size_t>(deck.increments) * (stage + 1) - 1;
  const double area = deck.geometry == 2 ? kPi : 1.0;
  return -run.reaction(run.increments[last], deck.block().top(), 1) / area;
}

double LameDeck::u(double nu, double r) {
  return (1.0 + nu) / 3.0 * ((1.0 - 2.0 * nu) * r + 4.0 / r);
}

std::string LameDeck::text() const {
  Block block;
  block.cell = cell;
  block.columns = n;
  block.rows = sector ? n : std::max(1, n / 2);
  block.polar = sector;
  block.place = sector ? rectangle(1.0, 2.0, 0.0, 90.0) : rectangle(1.0, 2.0, 0.0, 0.5);
  DeckWriter deck(sector ? 1 : 2);
  block.write_nodes(deck);
  deck.material(1, 1, {1.0, nu});
  deck.group(1, static_cast<int>(cell), formulation, 1);
  block.write_elements(deck, 1);
  for (int node : block.bottom()) deck.fix(node, 0, 1);
  for (int node : block.top()) deck.fix(node, sector ? 1 : 0, sector ? 0 : 1);
  StageCards& stage = deck.stage();
  for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(0, j), 4, 1.0, 1.0);
  return deck.text();
}

std::vector<int> TwoRingDeck::inner_face() const {
  Block block;
  block.cell = Cell::quad8;
  block.columns = 4;
  block.rows = sector ? 8 : 2;
  return block.left();
}

std::string TwoRingDeck::text() const {
  Block inner, outer;
  inner.cell = outer.cell = Cell::quad8;
  inner.columns = outer.columns = 4;
  inner.rows = outer.rows = sector ? 8 : 2;
  inner.polar = outer.polar = sector;
  const double height = sector ? 90.0 : 0.5;
  inner.place = rectangle(1.0, 1.5, 0.0, height);
  outer.place = rectangle(1.5, 2.0, 0.0, height);
  outer.first_node = outer.first_element = 1001;
  DeckWriter deck(sector ? 1 : 2);
  inner.write_nodes(deck);
  outer.write_nodes(deck);
  deck.material(1, 1, {1.0, 0.3});
  deck.material(2, 21, {kn, kn, 1.0});
  deck.group(1, 2, 1, 1);
  deck.group(2, 12, 0, 2);
  inner.write_elements(deck, 1);
  outer.write_elements(deck, 1);
  join(deck, 2001, 2, outer.left(), inner.right(), 2);
  for (const Block* ring : {&inner, &outer}) {
    for (int n : ring->bottom()) deck.fix(n, 0, 1);
    for (int n : ring->top()) deck.fix(n, sector ? 1 : 0, sector ? 0 : 1);
  }
  StageCards& stage = deck.stage();
  for (int j = 0; j < inner.rows; ++j) stage.pressure(inner.element(0, j), 4, 1.0, 1.0);
  return deck.text();
}

// u_out(c; pc) - u_in(c; p, pc) = -pc/kn with E = p = a = 1, b = 2, c = 1.5.
TwoRingAnswer two_ring_answer(double kn) {
  const double nu = 0.3, c = 1.5, f = 1.0 + nu;
  const double outer = f * c * c / (4.0 - c * c) * ((1 - 2 * nu) * c + 4.0 / c);
  const double g = f / (c * c - 1.0);
  const auto u_in = [&](double r, double pc) {
    return g * ((1 - 2 * nu) * r * (1.0 - pc * c * c) + c * c / r * (1.0 - pc));
  };
  const double u0 = u_in(c, 0.0), u1 = u0 - u_in(c, 1.0);
  TwoRingAnswer answer;
  answer.contact = u0 / (outer + u1 + 1.0 / kn);
  answer.u_a = u_in(1.0, answer.contact);
  return answer;
}

}  // namespace sage::stress
