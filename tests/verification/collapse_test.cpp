// Plasticity in whole models: triaxial test, thick cylinder, cavity in an infinite medium, strip footing.
// Closed forms; symbols as in the comments.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

enum class Strength { drucker_prager = 3, mohr_coulomb = 4 };

const char* name_of(Strength law) {
  return law == Strength::mohr_coulomb ? "Mohr-Coulomb" : "Drucker-Prager";
}

// Both laws: cone of triaxial compression where it is Drucker-Prager, no volume change.
std::vector<double> parameters(double E, double nu, double c, double phi) {
  return {E, nu, c, phi, 0.0};
}

class Triaxial : public testing::TestWithParam<Strength> {};

// sigma3 = 50, E = 3000, sin phi = 3/5, c = 0: q_f = 150, yield at 5 %, from there no plastic volume change:
// eps_r = -nu eps_y - (eps_a - eps_y)/2.  Exact with any step.
TEST_P(Triaxial, CompressionToTenPercent) {
  const double nu = 0.3, phi = std::asin(0.6) * 180.0 / M_PI;
  for (int increments : {1, 2, 20})
    for (Cell cell : {Cell::quad4, Cell::quad8, Cell::tri6}) {
      Block block;
      block.cell = cell;
      block.columns = block.rows = 2;
      block.place = rectangle(0.0, 1.0, 0.0, 2.0);
      DeckWriter deck(2);
      block.write_nodes(deck);
      deck.material(1, static_cast<int>(GetParam()), parameters(3000.0, nu, 0.0, phi));
      deck.group(1, static_cast<int>(cell), 0, 1);
      block.write_elements(deck, 1);
      for (int n : block.bottom()) deck.fix(n, 0, 1);
      for (int n : block.left()) deck.fix(n, 1, 0);
      deck.initial(1, 0, 50.0, 50.0, 50.0, 0.0);
      for (double strain : {0.04, 0.06}) {
        StageCards& stage = deck.stage(increments);
        for (int n : block.top()) stage.fix(n, 0, 1, 0.0, -2.0 * strain);
        const bool triangle = cell == Cell::tri6;
        if (deck.stages.size() == 1)
          for (int j = 0; j < 2; ++j)
            stage.pressure(block.element(1, j) + (triangle ? 1 : 0), triangle ? 3 : 2, 50.0, 50.0);
      }
      const WholeRun run = run_text(deck.text());
      ASSERT_TRUE(run.completed()) << run.failure;
      const auto axial = [&](const Snapshot& s) { return -run.reaction(s, block.top(), 1) / M_PI; };
      EXPECT_NEAR(axial(run.increments[static_cast<std::size_t>(increments - 1)]), 50.0 + 120.0, 1e-6);
      EXPECT_NEAR(axial(run.last()), 50.0 + 150.0, 1e-5);
      EXPECT_NEAR(run.u(block.node(block.across() - 1, 0)).x(), nu * 0.05 + 0.5 * 0.05, 1e-7);
    }
}

INSTANTIATE_TEST_SUITE_P(Laws, Triaxial, testing::Values(Strength::drucker_prager, Strength::mohr_coulomb),
                         [](const auto& one) {
                           return one.param == Strength::drucker_prager ? "DruckerPrager" : "MohrCoulomb";
                         });

// A strip of a ring a = 1, b = 2 in plane strain (u_z = 0), pushed from inside by `u` in `increments`.  Returns
// the pressure after each.
struct PushedRing {
  Cell cell = Cell::quad8;
  int formulation = 1;
  double k = 1.0, G = 100.0;

  std::vector<double> pressures(const std::vector<double>& u, int increments) const {
    const double nu = 0.4999;
    Block block;
    block.cell = cell;
    block.columns = 10;
    block.place = rectangle(1.0, 2.0, 0.0, 0.1);
    DeckWriter deck(2);
    block.write_nodes(deck);
    deck.material(1, 4, parameters(2 * G * (1 + nu), nu, k, 0.0));
    deck.group(1, static_cast<int>(cell), formulation, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.top()) deck.fix(n, 0, 1);
    double before = 0.0;
    for (double u_a : u) {
      StageCards& stage = deck.stage(increments);
      for (int n : block.left()) stage.fix(n, 1, 0, u_a - before);
      before = u_a;
    }
    const WholeRun run = run_text(deck.text());
    EXPECT_TRUE(run.completed()) << run.failure;
    std::vector<double> p;
    for (const Snapshot& s : run.increments)
      if (s.load_factor > 1.0 - 1e-12) p.push_back(run.reaction(s, block.left(), 0) / (2 * M_PI * 0.1));
    return p;
  }
};

// Tresca, nu = 1/2: plastic to radius c at p = k (2 ln(c/a) + 1 - c^2/b^2), u_a = k c^2/(2 G a); collapse at
// 2 k ln(b/a).  Gate 0.5 % with ten quad8.
TEST(ThickCylinder, PressureAgainstDisplacementAndCollapse) {
  const PushedRing ring;
  const double radii[] = {1.2, 1.5, 1.8};
  std::vector<double> u;
  for (double c : radii) u.push_back(c * c / (2 * ring.G));
  u.push_back(0.2);  // far beyond collapse
  const std::vector<double> p = ring.pressures(u, 5);
  ASSERT_EQ(p.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = radii[i], exact = 2 * std::log(c) + 1 - c * c / 4.0;
    std::printf("    plastic to %.1f: p/k = %.6f, exact %.6f\n", c, p[i], exact);
    EXPECT_NEAR(p[i], exact, 0.005 * exact);
  }
  std::printf("    collapse: p/k = %.6f, exact %.6f\n", p[3], 2 * std::log(2.0));
  EXPECT_NEAR(p[3], 2 * std::log(2.0), 0.005 * 2 * std::log(2.0));
}

// The source chapter's element has no collapse load: it locks against plastic flow without volume change
// (Nagtegaal, Parks & Rice 1974).  b-bar has one.
TEST(ThickCylinder, FullQuad4OverestimatesCollapse) {
  const double exact = 2 * std::log(2.0);
  const double full = PushedRing{Cell::quad4, 1}.pressures({0.2}, 20)[0];
  const double bbar = PushedRing{Cell::quad4, 2}.pressures({0.2}, 20)[0];
  std::printf("    collapse p/k: quad4 full %.4f, b-bar %.4f, exact %.4f\n", full, bbar, exact);
  EXPECT_GT(full, 1.05 * exact);
  EXPECT_NEAR(bbar, exact, 0.01 * exact);
}

// Spherical cavity in an infinite Mohr-Coulomb medium, c = 0, sin phi = 3/5, p0 = 50 (Yu & Houlsby 1991, small
// strain): with A = (1+sin phi)/(1-sin phi) = 4, delta = 2 p0/(2+A), the plastic zone reaches c where
// (c/a)^(2(A-1)/A) = p/(p0+delta).  Outside u = delta c/(4G) (c/r)^2, which gives c from a displacement.  All
// of it is a state of triaxial compression, so Drucker-Prager with that cone must agree.
TEST(SphericalCavity, PlasticRadiusAgainstPressure) {
  const double b = 40.0, p0 = 50.0, E = 3000.0, nu = 0.3, G = E / (2 * (1 + nu)), delta = 50.0;
  const double phi = std::asin(0.6) * 180.0 / M_PI;
  for (Strength law : {Strength::mohr_coulomb, Strength::drucker_prager}) {
    Block block;
    block.cell = Cell::quad8;
    block.columns = 24;
    block.rows = 3;
    block.polar = true;
    block.place = [&](double s, double t) { return Vector2(std::pow(b, s), 90.0 * t); };
    DeckWriter deck(2);
    block.write_nodes(deck);
    deck.material(1, static_cast<int>(law), parameters(E, nu, 0.0, phi));
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.top()) deck.fix(n, 1, 0);
    deck.initial(1, 0, p0, p0, p0, 0.0);
    StageCards& rest = deck.stage();
    for (int j = 0; j < block.rows; ++j) {
      rest.pressure(block.element(0, j), 4, p0, p0);
      rest.pressure(block.element(block.columns - 1, j), 2, p0, p0);
    }
    double before = p0;
    const double pressures[] = {183.711731, 282.842712}, reach[] = {1.5, 2.0};
    for (double p : pressures) {
      StageCards& stage = deck.stage(10);
      for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(0, j), 4, p - before, p - before);
      before = p;
    }
    const WholeRun run = run_text(deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    for (std::size_t i = 0; i < 2; ++i) {
      const int node = block.node(28, 0);  // r = 40^(28/48) = 8.6: outside the plastic zone
      const double r = run.position(node).x();
      const Snapshot& at = run.increments[10 * (i + 1)];
      const double u = at.u[2 * run.index(node)] - run.increments[0].u[2 * run.index(node)];
      const double c = std::cbrt(u * r * r * 4 * G / delta);
      std::printf("    %s: p = %.4f, plastic radius %.5f, exact %.1f\n", name_of(law), pressures[i], c,
                  reach[i]);
      EXPECT_NEAR(c, reach[i], 0.01 * reach[i]);
    }
  }
}

// Strip footing, half width 1, on weightless Tresca clay, c_u = 1, quad8 reduced.  Columns and rows get finer
// towards the footing's edge.
struct Footing {
  int inside = 10, outside = 14, down = 14;
  Block block;
  DeckWriter deck{1};
  std::vector<int> base;  // nodes under the footing

  void build() {
    const int in = inside, out = outside;
    block.cell = Cell::quad8;
    block.columns = in + out;
    block.rows = down;
    block.place = [in, out](double s, double t) {
      const double place = s * (in + out);
      const double in_part = 1.0 - place / in, out_part = (place - in) / out;
      const double x = place <= in ? 1.0 - std::pow(in_part, 1.7) : 1.0 + 4.0 * std::pow(out_part, 1.7);
      return Vector2(x, -3.0 * std::pow(1.0 - t, 1.7));
    };
    block.write_nodes(deck);
    deck.material(1, 4, parameters(298.0, 0.49, 1.0, 0.0));
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.right()) deck.fix(n, 1, 0);
    for (int i = 0; i <= 2 * inside; ++i) base.push_back(block.node(i, block.up() - 1));
  }
};

// Prandtl: q/c_u = 2 + pi.
TEST(StripFooting, PrandtlLoad) {
  Footing footing;
  footing.build();
  StageCards& stage = footing.deck.stage(10);
  for (int n : footing.base) stage.fix(n, 0, 1, 0.0, -0.15);
  const auto start = std::chrono::steady_clock::now();
  const WholeRun run = run_text(footing.deck.text());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ASSERT_TRUE(run.completed()) << run.failure;
  const double q = -run.reaction(run.last(), footing.base, 1);
  const double q_before = -run.reaction(run.increments[run.increments.size() - 2], footing.base, 1);
  std::printf("    N_c = %.4f, exact %.4f, error %.2f %%; %d iterations, %.2f s\n", q, 2 + M_PI,
              100 * (q / (2 + M_PI) - 1), run.iterations(), seconds);
  EXPECT_NEAR(q, 2 + M_PI, 0.015 * (2 + M_PI));
  EXPECT_NEAR(q, q_before, 0.002 * q);  // a plateau
}

// The same under a flexible load that grows past collapse: the run ends, says between which loads, keeps the
// last state in equilibrium, and does not call itself complete.
TEST(StripFooting, LoadControlEndsWithABracket) {
  Footing footing;
  footing.inside = 4;
  footing.outside = 5;
  footing.down = 6;
  footing.build();
  StageCards& stage = footing.deck.stage(12);
  for (int i = 0; i < footing.inside; ++i)
    stage.pressure(footing.block.element(i, footing.down - 1), 3, 6.0, 6.0);
  const WholeRun run = run_text(footing.deck.text());
  EXPECT_FALSE(run.completed());  // exit status 3
  // The bracket of the message: the load reached, and one a little above it that was not.
  double from = 0.0, to = 0.0;
  const std::size_t at = run.failure.find("limit load: between");
  ASSERT_NE(at, std::string::npos) << run.failure;
  ASSERT_EQ(std::sscanf(run.failure.c_str() + at, "limit load: between %lf and %lf", &from, &to), 2);
  std::printf("    load between %.4f and %.4f, Prandtl %.4f; %d increments\n", 6 * from, 6 * to, 2 + M_PI,
              run.result.increments_done);
  EXPECT_NEAR(from, run.last().load_factor, 1e-3);
  EXPECT_LT(from, to);
  EXPECT_LT(to - from, 0.01);
  EXPECT_NEAR(6.0 * from, 2 + M_PI, 0.05 * (2 + M_PI));
  EXPECT_TRUE(run.last().u.allFinite());
}

}  // namespace
}  // namespace sage::test
