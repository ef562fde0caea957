// A loose tolerance with a tangent that is kept: corrections are small because they are many, and a step must not end
// before the ground flows.  Each deck's load at the end against Newton's with a tolerance of 1e-6.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// A strip or circle of half width 1 that is pushed down, quad8 reduced, cells finer towards its edge.
struct Footing {
  const char* name;
  int geometry = 1;
  bool rough = false;
  int law = 4;
  double phi = 0.0, psi = 0.0, c = 1.0, E = 298.0, nu = 0.49, weight = 0.0;
  double width = 4.0, depth = 3.0, settlement = 0.15;
  int increments = 12;

  double load(int method, double tolerance) const {
    constexpr int kInside = 5, kOutside = 7;
    constexpr double kPower = 2.2;
    Block block;
    block.cell = Cell::quad8;
    block.columns = kInside + kOutside;
    block.rows = 6;
    block.straight = true;
    block.place = [this](double s, double t) -> Vector2 {
      const double at = s * (kInside + kOutside);
      const double x = at <= kInside ? 1.0 - std::pow(1.0 - at / kInside, kPower)
                                     : 1.0 + width * std::pow((at - kInside) / kOutside, kPower);
      return {x, -depth * std::pow(1.0 - t, kPower)};
    };
    DeckWriter deck(geometry);
    block.write_nodes(deck);
    std::vector<double> strength{E, nu, c, phi, psi};
    if (law == 3) strength.insert(strength.end(), {4.0, 1.0});
    deck.material(1, law, strength, weight);
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.right()) deck.fix(n, 1, 0);
    if (weight > 0.0) deck.initial(1, 1, 0.0, weight, 0.5, 0.0);
    StageCards& stage = deck.stage(increments);
    stage.method = method;
    stage.max_iterations = 2000;
    stage.tolerance = tolerance;
    if (weight > 0.0) stage.gravity_y = -1.0;  // in step with the initial stress that is let go
    std::vector<int> base;
    for (int i = 0; i <= 2 * kInside; ++i) base.push_back(block.node(i, block.up() - 1));
    for (int n : base) stage.fix(n, rough ? 1 : 0, 1, 0.0, -settlement);
    const WholeRun run = run_text(deck.text());
    return run.completed() ? -run.reaction(run.last(), base, 1) : std::nan("");
  }
};

class KeptTangents : public testing::TestWithParam<Footing> {};

TEST_P(KeptTangents, LooseToleranceFindsTheCollapseLoad) {
  const double right = GetParam().load(0, 1e-6);
  for (int method = 0; method < 4; ++method)
    EXPECT_NEAR(GetParam().load(method, 1e-2), right, 0.02 * right) << "method " << method;
}

Footing sand() {
  Footing f{"sand"};
  f.rough = true;
  f.phi = f.psi = 30.0;
  f.c = 0.0;
  f.weight = 20.0;
  f.E = 2e4;
  f.nu = 0.3;
  f.width = 5.0;
  f.settlement = 0.1;
  f.increments = 60;
  return f;
}
Footing frictional(const char* name, double phi, double psi) {
  Footing f{name};
  f.rough = true;
  f.phi = phi;
  f.psi = psi;
  f.E = 1000.0;
  f.nu = 0.3;
  f.width = 7.0;
  f.depth = 4.0;
  f.settlement = 0.2;
  return f;
}
Footing clay(const char* name, int geometry, int law, bool rough) {
  Footing f{name};
  f.geometry = geometry;
  f.law = law;
  f.rough = rough;
  return f;
}

INSTANTIATE_TEST_SUITE_P(Decks, KeptTangents,
                         testing::Values(sand(), clay("smooth_strip", 1, 4, false),
                                         clay("rough_circle", 2, 4, true), clay("von_mises", 1, 3, false),
                                         frictional("associated", 20.0, 20.0),
                                         frictional("dilating_little", 25.0, 5.0)),
                         [](const auto& deck) { return deck.param.name; });

}  // namespace
}  // namespace sage::test
