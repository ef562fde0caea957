#include "tests/studies/scenes/footing.hpp"

#include <cmath>

namespace sage::scenes {

void Footing::build() {
  const int in = inside, out = outside;
  block.cell = cell;
  block.columns = in + out;
  block.rows = down;
  block.straight = true;
  // Of a side, from the edge: by its share of the cells.
  const auto distance = [p = power](double share, int cells, double g) {
    return g > 0.0 ? (std::pow(g, share * cells) - 1.0) / (std::pow(g, cells) - 1.0) : std::pow(share, p);
  };
  block.place = [=, w = width, d = depth, g = growth, down = down](double s, double t) -> Vector2 {
    const double place = s * (in + out);
    const double x = place <= in ? 1.0 - distance(1.0 - place / in, in, g[0])
                                 : 1.0 + w * distance((place - in) / out, out, g[1]);
    return {x, -d * distance(1.0 - t, down, g[2])};
  };
  deck = DeckWriter(geometry);
  block.write_nodes(deck);
  std::vector<double> strength{E, nu, c, phi, psi};
  if (law == 3) strength.insert(strength.end(), {4.0, 1.0});
  deck.material(1, law, strength);
  deck.group(1, static_cast<int>(cell), formulation, 1);
  block.write_elements(deck, 1);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  for (int n : block.left()) deck.fix(n, 1, 0);
  for (int n : block.right()) deck.fix(n, 1, 0);
  for (int i = 0; i <= block.order() * inside; ++i) base.push_back(block.node(i, block.up() - 1));
  if (surcharge <= 0.0) return;
  deck.initial(1, 0, surcharge, surcharge, surcharge);
  const bool triangles = cell == Cell::tri3 || cell == Cell::tri6;
  StageCards& rest = deck.stage();
  // The upper triangle of a cell is its second, and its first edge is on top.
  for (int i = 0; i < block.columns; ++i)
    rest.pressure(block.element(i, down - 1) + (triangles ? 1 : 0), triangles ? 1 : 3, surcharge, surcharge);
}

void Footing::press(double settlement, int increments) {
  StageCards& stage = deck.stage(increments);
  for (int n : base) stage.fix(n, rough ? 1 : 0, 1, 0.0, -settlement);
}

double Footing::load(const WholeRun& run, const Snapshot& at) const {
  return -run.reaction(at, base, 1) / (geometry == 1 ? 1.0 : kPi);
}

double Footing::pressure(const WholeRun& run) const {
  return load(run, run.last()) + surcharge;
}

double prandtl_Nq(double phi) {
  return std::exp(kPi * std::tan(phi * kRadiansPerDegree)) *
         std::pow(std::tan((45.0 + phi / 2.0) * kRadiansPerDegree), 2);
}

}  // namespace sage::scenes
