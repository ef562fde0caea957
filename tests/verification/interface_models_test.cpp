// Interfaces in whole models: shear column, block on a plane, two rings in contact, cylinder with elastic ends.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// Hyperbolic interface without hyperbola: k_s constant until slip at c + sigma_n tan phi.  gamma_w must be 1.
std::vector<double> coulomb(double c, double phi, double ks, double kn) {
  return {c, phi, 0.0, 0.0, ks, 0.0, kn, kn, 0.0, 0.0};
}

// Interface elements between `lower` (node 1 to 2) and `upper` (on their left), linear or quadratic.
void join(DeckWriter& deck, int first, int group, const std::vector<int>& lower, const std::vector<int>& upper,
          int order) {
  const auto step = static_cast<std::size_t>(order);
  for (std::size_t i = 0; i + step < lower.size(); i += step) {
    std::vector<int> nodes{lower[i], lower[i + step], upper[i + step], upper[i]};
    if (order == 2) nodes.insert(nodes.end(), {lower[i + 1], upper[i + 1]});
    deck.element(first++, group, nodes);
  }
}

// A copy of a row of nodes, numbered from `first`.
std::vector<int> copy_row(DeckWriter& deck, const Block& block, const std::vector<int>& row, int first) {
  std::vector<int> copy;
  for (int j = 0; j < block.up(); ++j)
    for (int i = 0; i < block.across(); ++i)
      for (int n : row)
        if (block.node(i, j) == n) {
          deck.node(first, block.at(i, j).x(), block.at(i, j).y(), block.polar);
          copy.push_back(first++);
        }
  return copy;
}

// Block H = 2 in pure shear (u_y = 0 everywhere) on an interface: delta = tau (H/G + 1/k_s); beyond
// c + sigma_n tan phi it slides as a rigid body; on the way back only the elastic part returns.  Closed form.
TEST(ShearColumn, ElasticSlipAndReturn) {
  const double H = 2.0, E = 1000.0, nu = 0.25, G = E / (2 * (1 + nu)), ks = 500.0, c = 3.0, sigma_n = 20.0;
  const double strength = c + sigma_n * std::tan(30.0 * M_PI / 180.0), flexibility = H / G + 1.0 / ks;
  Block block;
  block.columns = 2;
  block.rows = 3;
  block.place = rectangle(0.0, 1.0, 0.0, H);
  DeckWriter deck(1);
  deck.water_unit_weight = 1.0;
  block.write_nodes(deck);
  const std::vector<int> base = copy_row(deck, block, block.bottom(), 101);
  deck.material(1, 1, {E, nu});
  deck.material(2, 22, coulomb(c, 30.0, ks, 1e6));
  deck.group(1, 1, 1, 1);
  deck.group(2, 11, 0, 2);
  block.write_elements(deck, 1);
  join(deck, 101, 2, base, block.bottom(), 1);
  for (int j = 0; j < block.up(); ++j)
    for (int i = 0; i < block.across(); ++i) deck.fix(block.node(i, j), 0, 1);
  for (int n : base) deck.fix(n, 1, 1);
  deck.initial(1, 0, 0.0, sigma_n, 0.0, 0.0);  // the sides are free
  deck.initial(2, 0, 0.0, sigma_n);
  const double moves[] = {0.05, 0.06, -0.04}, yield = strength * flexibility;
  const double stress[] = {moves[0] / flexibility, strength, strength + moves[2] / flexibility};
  for (double move : moves) {
    StageCards& stage = deck.stage(2);
    for (int n : block.top()) stage.fix(n, 1, 0, move);
  }
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  for (std::size_t s = 0; s < 3; ++s)
    EXPECT_NEAR(run.reaction(run.increments[2 * s + 1], block.top(), 0), stress[s], 1e-8 * strength)
        << "stage " << s + 1;
  // The foot has moved by what slid and by the interface's elastic part.
  const double slid = moves[0] + moves[1] - yield;
  EXPECT_NEAR(run.u(block.node(1, 0)).x(), slid + stress[2] / ks, 1e-10);
}

// A heavy block of weight W on a horizontal or tilted plane.
struct BlockOnPlane {
  Block block;
  DeckWriter deck{1};
  BlockOnPlane() {
    block.columns = 8;
    block.rows = 2;
    block.place = rectangle(0.0, 4.0, 0.0, 1.0);
    deck.water_unit_weight = 1.0;
    block.write_nodes(deck);
    const std::vector<int> base = copy_row(deck, block, block.bottom(), 101);
    deck.material(1, 1, {1e5, 0.2}, 20.0);
    deck.material(2, 22, coulomb(0.0, 25.0, 1e5, 1e6));
    deck.group(1, 1, 2, 1);
    deck.group(2, 11, 0, 2);
    block.write_elements(deck, 1);
    join(deck, 101, 2, base, block.bottom(), 1);
    for (int n : base) deck.fix(n, 1, 1);
  }
};

// Pushed at the foot of its left side: P = W tan phi once all of it slides.  Closed form.
TEST(SlidingBlock, PushEqualsFriction) {
  BlockOnPlane model;
  model.deck.stage(2).gravity_y = -1.0;
  StageCards& push = model.deck.stage(10);
  push.fix(model.block.node(0, 0), 1, 0, 0.05);
  const WholeRun run = run_text(model.deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double W = 20.0 * 4.0 * 1.0, P = W * std::tan(25.0 * M_PI / 180.0);
  EXPECT_NEAR(run.reaction(model.block.node(0, 0)).x(), P, 1e-6 * P);
  EXPECT_NEAR(run.reaction(run.increments[10], {model.block.node(0, 0)}, 0), P, 1e-6 * P);  // a plateau
}

// On a slope it stays exactly as long as tan(slope) < tan phi, and a run that can't go on ends with a reason.
TEST(SlidingBlock, StaysBelowTheFrictionAngleOnly) {
  for (double slope : {24.9, 25.1}) {
    BlockOnPlane model;
    StageCards& stage = model.deck.stage(4);
    stage.gravity_x = std::sin(slope * M_PI / 180.0);
    stage.gravity_y = -std::cos(slope * M_PI / 180.0);
    const WholeRun run = run_text(model.deck.text());
    EXPECT_EQ(run.completed(), slope < 25.0) << slope << " " << run.failure;
    EXPECT_TRUE(run.last().u.allFinite());
    EXPECT_EQ(run.failure.empty(), slope < 25.0);
  }
}

// Two rings, a = 1, c = 1.5, b = 2, with an interface of normal stiffness kn at c.  Lame on both rings:
// u_out(c; pc) - u_in(c; p, pc) = -pc/kn, and the displacement of the inner face.
struct TwoRings {
  double contact = 0.0, u_a = 0.0;
};

TwoRings two_rings(double E, double nu, double p, double kn) {
  const double a = 1.0, b = 2.0, c = 1.5, f = (1 + nu) / E;
  const double outer = f * c * c / (b * b - c * c) * ((1 - 2 * nu) * c + b * b / c);  // u_out(c) by pc
  const double g = f / (c * c - a * a);
  const auto u_in = [&](double r, double pc) {
    return g * ((1 - 2 * nu) * r * (p * a * a - pc * c * c) + a * a * c * c / r * (p - pc));
  };
  // u_in(c, pc) = u0 - u1 pc.
  const double u0 = u_in(c, 0.0), u1 = u0 - u_in(c, 1.0);
  TwoRings answer;
  answer.contact = u0 / (outer + u1 + 1.0 / kn);
  answer.u_a = u_in(a, answer.contact);
  return answer;
}

class TwoRingModel : public testing::TestWithParam<double> {
 protected:
  // Inner ring below, outer ring from node 1001; quad8 reduced, quadratic interface.
  WholeRun solve(bool sector, double kn) {
    const auto place = [&](double from, double to) {
      return sector ? rectangle(from, to, 0.0, 90.0) : rectangle(from, to, 0.0, 0.5);
    };
    inner_.cell = outer_.cell = Cell::quad8;
    inner_.columns = outer_.columns = 4;
    inner_.rows = outer_.rows = sector ? 8 : 2;
    inner_.polar = outer_.polar = sector;
    inner_.place = place(1.0, 1.5);
    outer_.place = place(1.5, 2.0);
    outer_.first_node = outer_.first_element = 1001;
    DeckWriter deck(sector ? 1 : 2);
    inner_.write_nodes(deck);
    outer_.write_nodes(deck);
    deck.material(1, 1, {1.0, 0.3});
    deck.material(2, 21, {kn, kn, 1.0});
    deck.group(1, 2, 1, 1);
    deck.group(2, 12, 0, 2);
    inner_.write_elements(deck, 1);
    outer_.write_elements(deck, 1);
    join(deck, 2001, 2, outer_.left(), inner_.right(), 2);
    for (const Block* ring : {&inner_, &outer_}) {
      for (int n : ring->bottom()) deck.fix(n, 0, 1);
      for (int n : ring->top()) deck.fix(n, sector ? 1 : 0, sector ? 0 : 1);
    }
    StageCards& stage = deck.stage();
    for (int j = 0; j < inner_.rows; ++j) stage.pressure(inner_.element(0, j), 4, 1.0, 1.0);
    return run_text(deck.text());
  }
  Block inner_, outer_;
};

// Strip: quad8 reduced is exact at its nodes there, so what remains is rounding: displacements of size 1 and
// gaps pc/kn.  Sector: the mesh's error, 1e-4 with 4 x 8 elements a ring.
TEST_P(TwoRingModel, ContactPressureAndDisplacement) {
  const double kn = GetParam();
  const TwoRings exact = two_rings(1.0, 0.3, 1.0, kn);
  for (bool sector : {false, true}) {
    const WholeRun run = solve(sector, kn);
    ASSERT_TRUE(run.completed()) << run.failure;
    const auto traction = -run.stress[1].row(1).array();
    const double pressure = (traction - exact.contact).abs().maxCoeff() / exact.contact;
    const double u = std::abs(run.u(inner_.node(0, 0)).x() / exact.u_a - 1.0);
    std::printf("    %-6s kn/E %.0e: error of contact pressure %.1e, of u(a) %.1e\n",
                sector ? "sector" : "strip", kn, pressure, u);
    EXPECT_LT(u, sector ? 1e-4 : 1e-9 + 1e-15 * kn);
    EXPECT_LT(pressure, (sector ? 5e-3 : 1e-9) + 1e-15 * kn);
  }
}

INSTANTIATE_TEST_SUITE_P(NormalStiffness, TwoRingModel, testing::Values(1.0, 1e3, 1e6, 1e9, 1e12),
                         [](const auto& one) {
                           return "E" + std::to_string(int(std::log10(one.param) + 0.5));
                         });

// Cylinder L/D = 2 between platens without friction but with shear springs k_s on u_r: ratio of its apparent
// modulus to E.  Reference: independent hp finite-element solution.  k_n = 1e7 E/a adds 1e-7.
struct ElasticEnds {
  double nu, ks, ratio;
};

class RestrainedCylinder : public testing::TestWithParam<ElasticEnds> {};

TEST_P(RestrainedCylinder, ApparentModulus) {
  const ElasticEnds c = GetParam();
  for (bool quadratic : {false, true}) {
    Block block;
    block.cell = quadratic ? Cell::quad8 : Cell::quad4;
    block.columns = quadratic ? 8 : 20;
    block.rows = 2 * block.columns;
    block.place = rectangle(0.0, 1.0, 0.0, 2.0);
    DeckWriter deck(2);
    block.write_nodes(deck);
    const std::vector<int> platen = copy_row(deck, block, block.top(), 5001);
    deck.material(1, 1, {1.0, c.nu});
    deck.material(2, 21, {c.ks, 1e7, 1.0});
    deck.group(1, static_cast<int>(block.cell), quadratic ? 1 : 2, 1);
    deck.group(2, quadratic ? 12 : 11, 0, 2);
    block.write_elements(deck, 1);
    join(deck, 5001, 2, block.top(), platen, block.order());
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : platen) deck.fix(n, 1, 1);
    StageCards& stage = deck.stage();
    for (int n : platen) stage.fix(n, 1, 1, 0.0, -0.02);  // 1 % of the height
    const WholeRun run = run_text(deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    const double ratio = -run.reaction(run.last(), platen, 1) / (M_PI * 0.01);
    std::printf("    nu %.3f ks a/E %4.1f %s: %.7f, error %.1e\n", c.nu, c.ks,
                quadratic ? "quad8 reduced" : "b-bar", ratio, ratio / c.ratio - 1.0);
    EXPECT_NEAR(ratio, c.ratio, 1e-3);
    EXPECT_NEAR(ratio - 1.0, c.ratio - 1.0, 0.02 * (c.ratio - 1.0));  // the effect of the ends itself
  }
}

INSTANTIATE_TEST_SUITE_P(ElasticEnds, RestrainedCylinder,
                         testing::Values(ElasticEnds{.25, .1, 1.0014332}, ElasticEnds{.25, 1., 1.0082251},
                                         ElasticEnds{.25, 10., 1.0157548}, ElasticEnds{.495, .1, 1.0057063},
                                         ElasticEnds{.495, 1., 1.0353785}, ElasticEnds{.495, 10., 1.0746696}),
                         [](const auto& one) {
                           return "Nu" + std::to_string(int(1000 * one.param.nu)) + "Ks" +
                                  std::to_string(int(10 * one.param.ks));
                         });

}  // namespace
}  // namespace sage::test
