// Modified Cam clay: no pressure, much overconsolidation, huge increments, slopes near each other, cycles, footings.
#include <fmt/format.h>

#include <cmath>

#include "sage/core/point_driver.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

constexpr int kCamClay = 11;
constexpr double kClayM = 1.2, kClayNu = 0.3;
constexpr double kStrainDigits = 2e-6;  // of the stress: a strain has seven digits on its card

std::vector<double> clay(double ocr, double lambda = 0.2, double kappa = 0.04, double shape = 0.0) {
  return {kClayM, lambda, kappa, 2.0, kClayNu, ocr, 0.0, 0.0, shape};
}

TriaxialDeck clay_deck(double cell, double ocr) {
  TriaxialDeck deck;
  deck.law = kCamClay;
  deck.parameters = clay(ocr);
  deck.cell = cell;
  return deck;
}

// A drained path is elastic up to q = 3 (p - 1), (q/M)^2 + p (p - OCR) = 0 in cell pressures, on a straight line of
// strains: eps_a = kappa/v ln p (1/3 + 2 (1 + nu)/(3 (1 - 2 nu))).
double yield_pressure(double ocr) {
  const double a = 9.0 / (kClayM * kClayM);  // a (p - 1)^2 + p^2 - p OCR = 0
  const double half = 0.5 * (2.0 * a + ocr) / (a + 1.0);
  return half + std::sqrt(half * half - a / (a + 1.0));
}
double yield_strain(double p) {
  return 0.02 * std::log(p) * (1.0 / 3.0 + 2.0 * (1.0 + kClayNu) / (3.0 * (1.0 - 2.0 * kClayNu)));
}

void overconsolidation(Sweep& s) {
  for (const double ocr : {1.5, 2.0, 4.0, 8.0, 30.0, 100.0, 1000.0}) {
    const double p = yield_pressure(ocr), strain = yield_strain(p);
    TriaxialDeck deck = clay_deck(100.0, ocr);
    deck.strains = {strain, strain};
    deck.increments = 10;
    const Ran ran = s.run(deck.text());
    const std::string label = fmt::format("OCR {:g}", ocr);
    const double found =
        ran.run && ran.run->increments.size() >= 10 ? axial_stress(deck, *ran.run, 0) : kUnknown;
    const double error = found / (100.0 * (3.0 * p - 2.0)) - 1.0;
    if (ocr < 10.0)
      s.right(label, ocr, ran, error, kStrainDigits);
    else  // beyond the peak the specimen may have no answer of its own
      s.holds(label, kUnknown, std::abs(error) < kStrainDigits && ran.finite(),
              "the peak right to 2e-6, then complete or stopped with a reason",
              fmt::format("peak {:.3e} off, {}", error, ran.completed() ? "complete" : "stopped"));
  }
  TriaxialDeck inside = clay_deck(100.0, 0.0);
  inside.parameters[7] = 50.0;
  s.says("p_c = 50 under 100 all round", kUnknown, s.run(inside.text()),
         "lies outside the yield surface that its parameters state at 16 of 16 point(s)");
}

// Everything grows with the pressures.
void no_pressure(Sweep& s) {
  double reference = kUnknown;
  for (const double cell : {100.0, 1e5, 1.0, 1e-3, 1e-6}) {
    TriaxialDeck deck = clay_deck(cell, 2.0);
    deck.strains = {0.1};
    deck.increments = 50;
    const Ran ran = s.run(deck.text());
    const double ratio = ran.completed() ? axial_stress(deck, *ran.run, 0) / cell : kUnknown;
    if (cell == 100.0) reference = ratio;
    s.right(fmt::format("cell pressure {:g}", cell), cell, ran, ratio / reference - 1.0, 1e-7);
  }
  TriaxialDeck none = clay_deck(0.0, 2.0);
  s.says("cell pressure 0", kUnknown, s.run(none.text()), "can't start without stress");
}

// Stretched in all directions, pressed together again, twice: p stays at its least value of 1e-4 of the first p_c, and
// returns along the line of unloading.
void stretched(Sweep& s) {
  for (const double ocr : {1.0, 8.0}) {
    Block block;
    block.columns = block.rows = 2;
    block.place = rectangle(0.0, 1.0, 0.0, 1.0);
    DeckWriter deck(2);
    block.write_nodes(deck);
    deck.material(1, kCamClay, clay(ocr));
    deck.group(1, 1, 2, 1);
    block.write_elements(deck, 1);
    for (const int n : block.bottom()) deck.fix(n, 0, 1);
    for (const int n : block.left()) deck.fix(n, 1, 0);
    deck.initial(1, 0, 100.0, 100.0, 100.0, 0.0);
    for (const double step : {0.2, -0.05, 0.05}) {
      StageCards& stage = deck.stage(2);
      for (const int n : block.top()) stage.fix(n, 0, 1, 0.0, step);
      for (const int n : block.right()) stage.fix(n, 1, 0, step);
    }
    const Ran ran = s.run(deck.text());
    const double least = 1e-4 * 100.0 * ocr;
    const double error =
        ran.completed() ? (ran.run->stress[0].topRows(3).array() / least + 1.0).abs().maxCoeff() : kUnknown;
    s.right(fmt::format("OCR {:g}", ocr), kUnknown, ran, error, 1e-8);
    s.says(fmt::format("OCR {:g}", ocr), kUnknown, ran, "cut off in tension, in element(s)");
  }
}

// One increment, whatever its size; parts that the run makes of it keep the answer within 1 % of 400 increments.
void huge_increments(Sweep& s) {
  for (const double ocr : {1.0, 4.0})
    for (const double strain : {0.01, 0.1, 0.5, 2.0}) {
      TriaxialDeck deck = clay_deck(100.0, ocr);
      deck.strains = {strain};
      deck.increments = 400;
      const Ran fine = s.run(deck.text());
      const double reference = fine.completed() ? axial_stress(deck, *fine.run, 0) : kUnknown;
      deck.increments = 1;
      const Ran ran = s.run(deck.text());
      const double found = ran.completed() ? axial_stress(deck, *ran.run, 0) : kUnknown;
      Trial& t = s.right(fmt::format("OCR {:g}, {:g} % in one increment", ocr, 100.0 * strain), strain, ran,
                         found / reference - 1.0, 0.01);
      t.series = fmt::format("OCR {:g}", ocr);
    }
}

// Undrained compression of a point ends at p_f = 100 (OCR/2)^(1 - kappa/lambda).
void slopes(Sweep& s) {
  for (const double share : {1e-6, 1e-4, 0.01, 0.2, 0.5, 0.9, 0.99, 0.9999, 1.0 - 1e-6}) {
    const double ocr = 4.0, exact = 100.0 * std::pow(0.5 * ocr, 1.0 - share);
    const LawPtr made = s.catalogue().materials.find(kCamClay)->make(clay(ocr, 0.2, 0.2 * share),
                                                                     {"m", "kN", "kPa", 101.325, 9.81});
    PointDriver<4> point(*std::get<std::unique_ptr<SolidLaw>>(made), {-100.0, -100.0, -100.0, 0.0});
    for (int i = 0; i < 400; ++i)
      point.advance({Control::strain, Control::strain, Control::strain, Control::strain},
                    {5e-3, -1e-2, 5e-3, 0.0});
    const double p = -point.sigma().head<3>().mean();
    s.holds(fmt::format("kappa/lambda = {:.8g}", share), kUnknown, std::abs(p / exact - 1.0) <= 2e-3,
            "mean stress of the critical state right to 2e-3", fmt::format("{:.3e}", p / exact - 1.0));
  }
  for (const double share : {0.0, 1.0}) {
    TriaxialDeck deck = clay_deck(100.0, 2.0);
    deck.parameters = clay(2.0, 0.2, 0.2 * share);
    s.says(fmt::format("kappa/lambda = {:g}", share), kUnknown, s.run(deck.text()), "kappa must be");
  }
}

// A thousand loops below the surface.
void cycles(Sweep& s) {
  TriaxialDeck deck = clay_deck(100.0, 1.0);
  deck.rows = deck.columns = 1;
  deck.strains = {0.05};
  for (int cycle = 0; cycle < 1000; ++cycle) deck.strains.insert(deck.strains.end(), {-0.002, 0.002});
  const Ran ran = s.run(deck.text());
  const double first = ran.completed() ? axial_stress(deck, *ran.run, 0) : kUnknown;
  const double last = ran.completed() ? axial_stress(deck, *ran.run, 2000) : kUnknown;
  s.right("1000 cycles of .2 %", kUnknown, ran, last / first - 1.0, 1e-7);
}

// Rigid rough circular footing, radius 1, surcharge 20 kPa, settlement .2, default settings.
Ran footing(const Sweep& s, double ocr, double shape, bool undrained, int increments) {
  constexpr double kSurcharge = 20.0, kClayWeight = 8.0, kAtRest = 0.65;
  Block block;
  block.cell = Cell::quad8;
  block.columns = 9;
  block.rows = 7;
  block.place = [](double a, double b) {
    const double at = 9.0 * a, x = at <= 4.0 ? at / 4.0 : 1.0 + 7.0 * std::pow((at - 4.0) / 5.0, 1.8);
    return Vector2(x, -8.0 * std::pow(1.0 - b, 1.8));
  };
  DeckWriter deck(2);
  block.write_nodes(deck);
  deck.material(1, kCamClay, clay(ocr, 0.2, 0.04, shape), kClayWeight);
  deck.group(1, 2, 1, 1);
  block.write_elements(deck, 1);
  for (const int n : block.bottom()) deck.fix(n, 1, 1);
  for (const int n : block.left()) deck.fix(n, 1, 0);
  for (const int n : block.right()) deck.fix(n, 1, 0);
  deck.initial(1, 1, 0.0, kClayWeight, kAtRest, kSurcharge);
  StageCards& rest = deck.stage();
  rest.gravity_y = -1.0;
  for (int i = 0; i < block.columns; ++i)
    rest.pressure(block.element(i, block.rows - 1), 3, kSurcharge, kSurcharge);
  StageCards& push = deck.stage(increments);
  for (int i = 0; i <= 8; ++i) push.fix(block.node(i, block.up() - 1), 1, 1, 0.0, -0.2);
  if (undrained) deck.water(5, 0, 2, 0, {}, 2.2e6);
  return s.run(deck.text());
}

void footings(Sweep& s) {
  for (const double ocr : {1.2, 8.0})
    for (const double shape : {0.0, 1.0})
      for (const bool undrained : {true, false})
        for (const int increments : {2, 20}) {
          const Ran ran = footing(s, ocr, shape, undrained, increments);
          s.holds(fmt::format("OCR {:g}, {}, {}, {} increments", ocr, shape > 0.0 ? "Matsuoka-Nakai" : "circle",
                              undrained ? "undrained" : "drained", increments),
                  kUnknown, ran.completed() && ran.finite(), "runs to the end",
                  ran.completed() ? "complete" : ran.words());
        }
}

}  // namespace

std::vector<Row> clay_rows() {
  const std::string family = "Modified Cam clay";
  return {
      {"clay-ocr", family, "OCR to 1000: the peak of drained compression",
       "yield of an elastic path, closed form. Allowed: 2e-6, the digits of the strain on its card", "OCR [-]",
       true, overconsolidation},
      {"clay-pressure", family, "pressures to 1e-6 kPa", "the answer at 100 kPa, which scales. Allowed: 1e-7",
       "cell pressure [kPa]", true, no_pressure},
      {"clay-stretched", family, "stretched in all directions, cycles",
       "least mean stress, 1e-4 of the first p_c. Allowed: 1e-8", "", false, stretched},
      {"clay-huge", family, "axial strains to 200 % in one increment", "400 increments. Allowed: 1 %",
       "strain [-]", true, huge_increments},
      {"clay-slopes", family, "kappa/lambda from 1e-6 to 1 - 1e-6",
       "critical state of undrained paths, closed form", "", false, slopes},
      {"clay-cycles", family, "1000 cycles of unloading and reloading", "the stress before them. Allowed: 1e-7",
       "", false, cycles},
      {"clay-footing", family, "circular footing, drained and undrained, default settings", "runs to the end",
       "", false, footings},
  };
}

}  // namespace sage::stress
