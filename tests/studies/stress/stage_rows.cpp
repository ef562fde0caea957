// Stages: initial stress that can't be, excavation of everything, a step that failed, sums of forces.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/scenes/lame.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

constexpr double kWeight = 20.0, kGroundE = 1e4, kGroundNu = 0.3;

// phi = 30, c = 0: between Ka = 1/3 and Kp = 3.
void initial_stress(Sweep& s) {
  for (double K0 : {0.0, 0.1, 0.2, 0.3, 0.33, 0.334, 0.5, 1.0, 2.0, 2.99, 3.01, 5.0}) {
    Ground ground(1, Cell::quad4, 4, 4);
    ground.deck.material(1, 4, {kGroundE, kGroundNu, 0.0, 30.0, 0.0}, kWeight);
    ground.deck.group(1, 1, 0, 1);
    ground.block.write_elements(ground.deck, 1);
    ground.deck.initial(1, 1, 0.0, kWeight, K0, 0.0);
    ground.deck.stage(4).gravity_y = -1.0;
    const Ran ran = s.run(ground.deck.text());
    const std::string label = fmt::format("K0 = {:g}", K0);
    if (K0 < 1.0 / 3.0 || K0 > 3.0)
      s.says(label, kUnknown, ran, "outside the yield surface");
    else
      s.right(label + ": nothing moves", kUnknown, ran, ran.completed() ? ran.run->largest_u() / 4.0 : kUnknown,
              1e-10);
  }
}

// The ground on top of a layer that stays is taken away and filled again, several times.
void everything_dug(Sweep& s) {
  for (int cycles : {1, 2, 5}) {
    Ground ground(1, Cell::quad4, 4, 4);
    DeckWriter& deck = ground.deck;
    const Block& block = ground.block;
    const int groups = 2 + cycles;
    deck.material(1, 1, {kGroundE, kGroundNu}, kWeight);
    for (int g = 1; g <= groups; ++g) deck.group(g, 1, 1, 1);
    // Rows 0 and 1 are the layer; rows 2 and 3 are there once for each time they are filled.
    int number = 1;
    for (int g = 1; g <= groups; ++g)
      for (int j = g == 1 ? 0 : 2; j < (g == 1 ? 2 : 4); ++j)
        for (int i = 0; i < 4; ++i) {
          const int n = block.node(i, j);
          deck.element(number++, g, {n, n + 1, n + 1 + block.across(), n + block.across()});
        }
    StageCards& first = deck.stage();
    first.gravity_y = -1.0;
    for (int c = 0; c < cycles; ++c) {
      deck.stage().deaths = {2 + c};
      deck.stage().births = {3 + c};
    }
    const Ran ran = s.run(deck.text());
    const std::string label = fmt::format("{} time(s)", cycles);
    // A confined column: sigma_v = gamma z in the layer; in new ground gamma z too,
    // sigma_h = nu/(1-nu) sigma_v.
    double stress = kUnknown, settled = kUnknown, stale = kUnknown;
    if (ran.completed()) {
      const auto& top = ran.run->stress[groups - 1];
      const auto& layer = ran.run->stress[0];
      stress = std::abs(layer.row(1).mean() + 3.0 * kWeight) / (3.0 * kWeight);
      stale = std::abs(top.row(1).mean() + 1.0 * kWeight) / kWeight +
              (top.row(0) - kGroundNu / (1.0 - kGroundNu) * top.row(1)).cwiseAbs().maxCoeff() / kWeight;
      // The layer is elastic: after a whole cycle it is where it was.
      const int node = block.node(0, 2);
      const double M = kGroundE * (1 - kGroundNu) / ((1 + kGroundNu) * (1 - 2 * kGroundNu));
      settled = ran.run->u(node).y() / (-kWeight * (2.0 * 2.0 + 0.5 * 4.0) / M) - 1.0;
    }
    s.right(label + ": stress of the layer that stayed", kUnknown, ran, stress, 1e-10);
    s.right(label + ": new ground started without stress", kUnknown, ran, stale, 1e-10);
    s.right(label + ": settlement of the layer", kUnknown, ran, settled, 1e-10);
  }
  // Nothing at all is left.
  Ground ground(1, Cell::quad4, 4, 4);
  ground.deck.material(1, 1, {kGroundE, kGroundNu}, kWeight);
  ground.deck.group(1, 1, 0, 1);
  ground.block.write_elements(ground.deck, 1);
  ground.deck.stage().gravity_y = -1.0;
  ground.deck.stage().deaths = {1};
  s.clean("the whole mesh is taken away", kUnknown, s.run(ground.deck.text()));
}

bool same_end(const WholeRun& a, const WholeRun& b) {
  bool same = a.last().u == b.last().u && a.last().internal == b.last().internal;
  for (std::size_t g = 0; g < a.stress.size(); ++g) same = same && a.stress[g] == b.stress[g];
  return same;
}

// A step that fails for want of iterations is halved; the same run with the halves as its increments never
// fails.  What a failed attempt leaves behind would make them differ.
void failed_step(Sweep& s) {
  int found = 0;
  for (int law : {3, 4})
    for (double strain : {0.01, 0.02, 0.03, 0.04, 0.06, 0.08, 0.1, 0.15})
      for (int most : {3, 4, 5, 6, 7, 8}) {
        TriaxialDeck whole;
        whole.law = law;
        whole.parameters = {3000.0, 0.3, 10.0, 30.0, 0.0};
        whole.cell = 50.0;
        whole.rough_base = true;
        whole.columns = 3;
        whole.rows = 6;
        whole.strains = {strain};
        whole.max_iterations = most;
        TriaxialDeck halves = whole;
        halves.increments = 2;
        RunSettings settings;
        settings.skips.prediction = false;  // the second half step would start elsewhere
        const Ran a = s.run(whole.text(), {}, settings), b = s.run(halves.text(), {}, settings);
        if (!a.completed() || !b.completed()) continue;
        const bool cut_once = a.run->last().cuts == 1;
        if (!cut_once || b.run->increments[0].cuts + b.run->increments[1].cuts > 0) continue;
        ++found;
        const bool same = same_end(*a.run, *b.run);
        s.holds(fmt::format("law {}, strain {:g}, at most {} iterations", law, strain, most), kUnknown, same,
                "bit for bit the direct half steps", same ? "the same" : "different");
      }
  s.holds("steps that failed once", kUnknown, found >= 3, "at least 3 found", fmt::format("{} found", found));
}

// Sum of all loads and reactions of every kind of deck here.
void audit(Sweep& s) {
  const auto check = [&](const std::string& label, const std::string& deck) {
    const Ran ran = s.run(deck);
    s.right(label, kUnknown, ran, ran.completed() ? ran.run->out_of_balance : kUnknown, 1e-9);
  };
  LameDeck lame;
  lame.body = LameBody::sector;
  for (double nu : {0.3, 0.49, 0.4999}) {
    lame.nu = nu;
    check(fmt::format("Lame's sector, nu = {:g}", nu), lame.text());
  }
  for (double kn : {1.0, 1e3, 1e6}) {
    TwoRingDeck rings;
    rings.kn = kn;
    rings.sector = true;
    check(fmt::format("two rings, kn = {:g}", kn), rings.text());
  }
  for (int law : {1, 3, 4})
    for (int geometry : {1, 2}) {
      TriaxialDeck deck;
      deck.law = law;
      deck.geometry = geometry;
      deck.parameters =
          law == 1 ? std::vector<double>{3000.0, 0.3} : std::vector<double>{3000.0, 0.3, 10.0, 30.0, 0.0};
      deck.cell = 50.0;
      deck.rough_base = true;
      deck.strains = {0.04};
      deck.increments = 8;
      check(fmt::format("rough specimen, law {}, {}", law, geometry == 1 ? "plane strain" : "axisymmetry"),
            deck.text());
    }
  for (bool drucker_prager : {false, true}) {
    SpecimenDeck deck;
    deck.drucker_prager = drucker_prager;
    deck.columns = 4;
    deck.rows = 8;
    check(fmt::format("specimen on its platen, {}", drucker_prager ? "Drucker-Prager" : "elastic"),
          deck.text());
  }
}

// Ground of two layers, the lower one with a level of water that is below, in and above it, the upper one dry or
// wet as well.  The top settles by the integral of the effective stress over the constrained modulus.
void dry_and_submerged(Sweep& s) {
  constexpr double kHeight = 8.0, kGammaWater = 9.81;
  constexpr double kModulus = kGroundE * (1.0 - kGroundNu) / ((1.0 + kGroundNu) * (1.0 - 2.0 * kGroundNu));
  for (const Cell cell : {Cell::quad4, Cell::quad8})
    for (const bool all : {false, true})
      for (const double level : {0.0, 2.0, 3.0, 4.0, 6.0, 8.0, 20.0}) {
        Block block;
        block.cell = cell;
        block.columns = 1;
        block.rows = 4;
        block.place = rectangle(0.0, 2.0, 0.0, kHeight);
        DeckWriter deck(1);
        block.write_nodes(deck);
        deck.material(1, 1, {kGroundE, kGroundNu}, kWeight);
        for (int g = 1; g <= 2; ++g) deck.group(g, static_cast<int>(cell), 0, 1);
        Block low = block, high = block;
        low.write_elements(deck, 1);
        high.write_elements(deck, 2);
        // The upper two rows of the first copy and the lower two of the second go.
        deck.elements.erase(deck.elements.begin() + 2, deck.elements.begin() + 6);
        for (const int n : block.bottom()) deck.fix(n, 1, 1);
        for (const int n : block.left()) deck.fix(n, 1, 0);
        for (const int n : block.right()) deck.fix(n, 1, 0);
        deck.stage().gravity_y = -1.0;
        deck.water(1, all ? 0 : 1, 1, 0, {0.0, level});
        const double wet = all ? kHeight : 0.5 * kHeight, below = std::min(level, wet);
        const double above = all ? kGammaWater * std::max(0.0, level - kHeight) : 0.0;
        const double pressures = kGammaWater * (level * below - 0.5 * below * below);
        // Total stress is that of all weights; only in what is wet the water carries a part.
        const double settlement = (0.5 * kWeight * kHeight * kHeight + above * kHeight - pressures) / kModulus;
        const Ran ran = s.run(deck.text());
        const double error =
            ran.completed() ? std::abs(-ran.run->u(block.top()[0]).y() / settlement - 1.0) : kUnknown;
        // 3 m is within an element: the rule meets a kink.
        s.right(fmt::format("{}, {}, level {:g}", cell == Cell::quad4 ? "quad4" : "quad8",
                            all ? "all wet below it" : "upper layer dry", level),
                kUnknown, ran, error, level == 3.0 ? 1e-2 : 1e-10);
      }
}

// Grains with nu = .3 and water in them are an elastic body of a larger ratio: Lame's cylinder of that one.
void water_bulk(Sweep& s) {
  constexpr double kStiffest = 1e8;  // beyond, a multiplier holds the volume
  constexpr double kRigid = 1e30;    // nu_u = 1/2
  for (const double share : {1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12, kRigid}) {  // K_w/n over G
    LameDeck lame;
    DeckWriter deck = lame.deck();
    const bool rigid = share == kRigid;
    const double K = 2.0 * 1.3 / (3.0 * 0.4) + share;  // over G
    lame.nu = rigid ? 0.5 : (3.0 * K - 2.0) / (2.0 * (3.0 * K + 1.0));
    const double G = 1.0 / (2.0 * (1.0 + lame.nu));
    deck.materials.clear();
    deck.material(1, 1, {2.6 * G, 0.3});
    deck.water(5, 0, 1, 0, {}, rigid ? 0.0 : share * G, rigid ? 0.5 : 0.0);
    const Ran ran = s.run(deck.text());
    const std::string label = rigid ? "nu_u = 1/2" : fmt::format("K_w/n = {:g} G", share);
    const double multiplied = share > kStiffest ? 1.0 / kStiffest : 0.0;
    s.right(label, rigid ? kUnknown : share, ran,
            ran.completed() ? scenes::lame_error(*ran.run, lame.body, lame.nu) : kUnknown,
            100.0 * kUnit * std::min(share, kStiffest) + 1e-8 + multiplied);
  }
}

}  // namespace

std::vector<Row> stage_rows() {
  const std::string family = "Stages";
  return {
      {"initial-stress", family, "K0 from 0 to 5 in sand of phi = 30",
       "Ka = 1/3 <= K0 <= Kp = 3: nothing moves (1e-10 H); outside: announced", "", false, initial_stress},
      {"excavate-and-refill", family, "ground dug out and filled again",
       "stress of a confined column, closed form; new elements start without stress. Allowed: 1e-10", "", false,
       everything_dug},
      {"failed-step", family, "a step that fails and is halved", "the direct half steps, bit for bit", "",
       false, failed_step},
      {"water-bulk", family, "bulk of pore water to 1e12 of the shear modulus",
       "Lame's cylinder with the undrained Poisson's ratio; quad8 reduced. Allowed: 100 u K_w/n / G up to 1e8, "
       "and 1e-8, since a number on a card has ten columns",
       "K_w/n over G", true, water_bulk},
      {"dry-and-submerged", family, "ground that is dry above and wet below a level, layer by layer",
       "settlement of a column, closed form. Allowed: 1e-10; 1e-2 where the level lies within an element", "",
       false, dry_and_submerged},
      {"audit", family, "equilibrium of the whole model",
       "sum of loads and reactions, 1e-9 of the largest force", "", false, audit},
  };
}

}  // namespace sage::stress
