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

}  // namespace sage::stress
