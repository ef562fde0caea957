#include "tests/studies/scenes/scenes.hpp"

#include <cmath>

namespace sage::scenes {

std::vector<double> coulomb(double c, double phi, double ks, double kn) {
  std::vector<double> values(10, 0.0);
  values[0] = c;
  values[1] = phi;
  values[4] = ks;
  values[6] = values[7] = kn;
  return values;
}

Ground::Ground(int geometry, Cell cell, int columns, int rows) : deck(geometry) {
  block.cell = cell;
  block.columns = columns;
  block.rows = rows;
  block.place = rectangle(0.0, columns, -rows, 0.0);
  block.write_nodes(deck);
  for (int n : block.left()) deck.fix(n, 1, 0);
  for (int n : block.right()) deck.fix(n, 1, 0);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
}

BlockOnPlane::BlockOnPlane(const std::vector<double>& joint) {
  block.columns = 8;
  block.rows = 2;
  block.place = rectangle(0.0, 4.0, 0.0, 1.0);
  deck.water_unit_weight = 1.0;
  block.write_nodes(deck);
  const std::vector<int> base = copy_row(deck, block, block.bottom(), 101);
  deck.material(1, 1, {1e5, 0.2}, weight / 4.0);
  deck.material(2, 22, joint);
  deck.group(1, 1, 2, 1);
  deck.group(2, 11, 0, 2);
  block.write_elements(deck, 1);
  join(deck, 101, 2, base, block.bottom(), 1);
  for (int n : base) deck.fix(n, 1, 1);
}

Block TriaxialDeck::block() const {
  Block block;
  block.columns = columns;
  block.rows = rows;
  block.place = rectangle(0.0, 1.0, 0.0, 2.0);
  return block;
}

DeckWriter TriaxialDeck::deck() const {
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
  return deck;
}

double axial_stress(const TriaxialDeck& deck, const WholeRun& run, std::size_t stage) {
  const auto last = static_cast<std::size_t>(deck.increments) * (stage + 1) - 1;
  const double area = deck.geometry == 2 ? kPi : 1.0;
  return -run.reaction(run.increments[last], deck.block().top(), 1) / area;
}

Block RestrainedCylinder::block() const {
  Block block;
  block.cell = cell;
  block.columns = columns;
  block.rows = rows;
  block.straight = true;
  block.place = [h = slenderness, p = power](double s, double t) -> Vector2 {
    return {1.0 - std::pow(1.0 - s, p), h * (1.0 - std::pow(1.0 - t, p))};
  };
  return block;
}

DeckWriter RestrainedCylinder::deck() const {
  const Block mesh = block();
  DeckWriter deck(2);
  mesh.write_nodes(deck);
  if (nu < 0.5)
    deck.material(1, 1, {1.0, nu});
  else
    deck.material(1, 2, {1e6 / 3.0, 1.0 / 3.0});  // K/G = 1e6: nu = 1/2 to 5e-7
  deck.group(1, static_cast<int>(cell), formulation, 1);
  mesh.write_elements(deck, 1);
  for (int n : mesh.bottom()) deck.fix(n, 0, 1);
  for (int n : mesh.left()) deck.fix(n, 1, 0);
  deck.stage();
  return deck;
}

DeckWriter RestrainedCylinder::between_rough_platens(double strain) const {
  DeckWriter deck = this->deck();
  for (int n : block().top()) deck.stages[0].fix(n, 1, 1, 0.0, -slenderness * strain);
  return deck;
}

double RestrainedCylinder::ratio(const WholeRun& run, double strain) const {
  return -run.reaction(run.last(), block().top(), 1) / (kPi * strain);
}

Block CookDeck::block() const {
  Block block;
  block.cell = cell;
  block.columns = block.rows = n;
  block.straight = true;
  block.place = [p = power](double s, double t) -> Vector2 {
    const double a = s <= 0.5 ? 0.5 * std::pow(2.0 * s, p) : 1.0 - 0.5 * std::pow(2.0 - 2.0 * s, p);
    const double b = t <= 0.5 ? t : 1.0 - 0.5 * std::pow(2.0 - 2.0 * t, p);
    return {48.0 * a, 44.0 * a + b * (44.0 - 28.0 * a)};
  };
  return block;
}

DeckWriter CookDeck::deck() const {
  const Block mesh = block();
  DeckWriter deck(1);
  mesh.write_nodes(deck);
  deck.material(1, 1, {E, nu});
  deck.group(1, static_cast<int>(cell), formulation, 1);
  mesh.write_elements(deck, 1);
  for (int node : mesh.left()) deck.fix(node, 1, 1);
  StageCards& stage = deck.stage();
  for (int j = 0; j < n; ++j) stage.pressure(mesh.element(n - 1, j), 2, 0.0, 0.0, F / 16.0, F / 16.0);
  return deck;
}

}  // namespace sage::scenes
