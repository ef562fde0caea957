// Slopes by strength reduction, a vertical cut, and Rankine's states.  A slope stands at a factor F if the
// program finds equilibrium with c/F and tan(phi)/F.
#include <fmt/format.h>

#include <cmath>

#include "sage/bounds/bounds.hpp"
#include "sage/bounds/model_domain.hpp"
#include "sage/safety/safety.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

struct Soil {
  double c, phi, weight, E, nu;
  bool associated = true;
  std::vector<double> reduced(double F) const {
    const double angle = std::atan(std::tan(phi * kDegree) / F) / kDegree;
    return {E, nu, c / F, angle, associated ? angle : 0.0};
  }
};

// Gravity on a block whose lower side is fixed and whose vertical sides slide.
bool stands(const Record& record, const Block& block, const Soil& soil, double F, bool right_side) {
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 4, soil.reduced(F), soil.weight);
  deck.group(1, 2, 1, 1);
  block.write_elements(deck, 1);
  for (int n : block.left()) deck.fix(n, 1, 0);
  if (right_side)
    for (int n : block.right()) deck.fix(n, 1, 0);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  deck.stage(4).gravity_y = -1.0;
  return record.try_run(deck).completed();
}

// Griffiths & Lane 1999, example 1: 2:1 slope on a firm base, phi = 20, c = .05 gamma H.
void griffiths_lane(Record& record) {
  const double H = 10.0;
  Block block;
  block.cell = Cell::quad8;
  block.columns = 12;
  block.rows = 8;
  block.straight = true;
  block.place = [=](double s, double t) -> Vector2 { return {s * H * (3.2 - 2.0 * t), H * t}; };
  for (bool associated : {true, false}) {
    const Soil soil{10.0, 20.0, 20.0, 1e5, 0.3, associated};
    record.near(Where::plane_strain, associated ? "factor of safety, psi = phi" : "factor of safety, psi = 0",
                bisect(1.32, 1.48, associated ? 0.02 : 0.04,
                       [&](double F) { return stands(record, block, soil, F, false); }),
                1.4, 0.03);
  }
}

// ACADS 1(a) (Giam & Donald 1989): toe (30, 25), crest (50, 35), base at 20 from x = 20 to 70.
void acads(Record& record) {
  Block block;
  block.cell = Cell::quad8;
  block.columns = 20;
  block.rows = 8;
  block.straight = true;
  block.place = [](double s, double t) -> Vector2 {
    const double x = 20.0 + 50.0 * s, surface = x < 30.0 ? 25.0 : x < 50.0 ? 25.0 + 0.5 * (x - 30.0) : 35.0;
    return {x, 20.0 + t * (surface - 20.0)};
  };
  const Soil soil{3.0, 19.6, 20.0, 1e4, 0.25};
  record.near(Where::plane_strain, "factor of safety",
              bisect(0.92, 1.08, 0.02, [&](double F) { return stands(record, block, soil, F, true); }), 1.0,
              0.03);
}

// Associated flow on firm ground; factor: the least of all log-spirals above the level of the toe, an upper bound.
struct SpiralSlope {
  const char* name;
  double run, phi, c, weight, H, factor;

  DeckWriter deck(int columns, int rows) const {
    Block block;
    block.cell = Cell::quad8;
    block.columns = columns;
    block.rows = rows;
    block.straight = true;
    block.place = [this](double s, double t) -> Vector2 { return {s * H * (run + 1.2 - run * t), H * t}; };
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 4, {1e5, 0.3, c, phi, phi}, weight);
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    deck.stage().gravity_y = -1.0;
    return deck;
  }
};
constexpr SpiralSlope kSpiralSlopes[] = {
    {"2:1, phi = 20, c = .05 gamma H", 2.0, 20.0, 10.0, 20.0, 10.0, 1.37568867},
    {"1:1, phi = 30, c = .0694 gamma H", 1.0, 30.0, 10.0, 18.0, 8.0, 1.36482236}};

// Bounds by limit analysis: the lower one lies below the spiral, and both are close to it.
void slope_bounds(Record& record) {
  for (const SpiralSlope& slope : kSpiralSlopes) {
    const Model model = record.bench().build(slope.deck(12, 8).text());
    bounds::Options options;
    options.quantity = bounds::Quantity::strength;
    options.elements = 1000;
    const bounds::Bounds found = bounds::find_bounds(bounds::make_ground(model, 0, 0).domain, options);
    if (!found.lower.value || !found.upper.value)
      throw AnalysisError("S575", found.lower.reason + found.upper.reason);
    record.within(Where::plane_strain,
                  fmt::format("{}: lower bound over the log spiral, at most 1", slope.name),
                  *found.lower.value / slope.factor, 0.99, 0.01);
    record.within(Where::plane_strain, fmt::format("{}: upper over lower bound", slope.name),
                  *found.upper.value / *found.lower.value, 1.015, 0.015);
  }
}

// Within -1 % and +2 % of the log-spiral, an upper bound for associated flow: elements of finite size smear the slip
// line.
void log_spirals(Record& record) {
  for (const SpiralSlope& slope : kSpiralSlopes) {
    const DeckWriter deck = slope.deck(24, 16);
    safety::Options options;
    options.limits.tolerance = 0.004;
    Model model = record.bench().build(deck.text());
    const safety::Safety found =
        safety::find_safety(model, record.bench().catalogue(), record.bench().settings(), options);
    if (!found.complete()) throw AnalysisError("S515", found.incomplete);
    // +2 % and -1 %: the middle of both, give or take half of their distance.
    record.near(Where::plane_strain, slope.name, 0.5 * (*found.lower + *found.upper), 1.005 * slope.factor,
                0.015 / 1.005);
  }
}

// Vertical cut of height 1 in Tresca clay, c_u = 1, square cells of 1/n: gamma H/c_u at
// collapse under growing weight.
double vertical_cut_load(const Record& record, int n, bool& completed) {
  const int cut = 3 * n / 4, columns = 5 * n / 2, below = 3 * n / 4,
            rows = below + n;  // cells left of the face, below the foot
  Block block;
  block.cell = Cell::quad8;
  block.columns = columns;
  block.rows = rows;
  block.place = rectangle(-0.75, 1.75, -0.75, 1.0);
  DeckWriter deck(1);
  block.write_nodes(deck);
  const double largest = 4.4;
  deck.material(1, 4, {200.0, 0.49, 1.0, 0.0, 0.0}, largest);
  deck.group(1, 2, 1, 1);
  DeckWriter all(1);
  block.write_elements(all, 1);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      if (i >= cut || j < below) deck.elements.push_back(all.elements[j * columns + i]);
  for (int j = 0; j <= 2 * below; ++j) deck.fix(block.left()[j], 1, 0);
  for (int node : block.right()) deck.fix(node, 1, 0);
  for (int node : block.bottom()) deck.fix(node, 1, 1);
  deck.stage(11).gravity_y = -1.0;
  const WholeRun run = record.try_run(deck, 8);
  completed = run.completed();
  return largest * run.last().load_factor;
}

// 3.7752 <= gamma H/c_u <= 3.7776.  A slip line smears over a cell, so the error is of order 1 in its size.
void vertical_cut(Record& record) {
  bool coarse_done = false, fine_done = false;
  const double coarse = vertical_cut_load(record, 8, coarse_done),
               fine = vertical_cut_load(record, 16, fine_done);
  record.within(Where::plane_strain, "runs completed at gamma H/c_u = 4.4",
                coarse_done || fine_done ? 1.0 : 0.0, 0.0, 0.5);
  record.order(Where::plane_strain, "gamma H/c_u at collapse, cells of 1/8 and 1/16", {1.0 / 8, 1.0 / 16},
               {coarse / 3.7764 - 1.0, fine / 3.7764 - 1.0}, 1.0);
  record.near(Where::plane_strain, "extrapolated from cells of 1/8 and 1/16", 2 * fine - coarse, 3.7764, 0.01);
}

// Soil of height H between a smooth wall that moves and a fixed end, on a smooth base, gamma and a surcharge:
// all of it comes into Rankine's state.  P = K (gamma H^2/2 + q H).
void rankine(Record& record) {
  const double H = 4.0, weight = 18.0, q = 10.0, phi = 30.0, K0 = 0.5;
  const double Ka = (1 - std::sin(phi * kDegree)) / (1 + std::sin(phi * kDegree));
  for (int code : {4, 3})
    for (bool passive : {false, true}) {
      Block block;
      block.cell = Cell::quad8;
      block.columns = 4;
      block.rows = 8;
      block.place = rectangle(0.0, 2.0, -H, 0.0);
      DeckWriter deck(1);
      block.write_nodes(deck);
      std::vector<double> parameters{2e4, 0.3, 0.0, phi, 0.0};
      if (code == 3) parameters.insert(parameters.end(), {4.0, 1.0});  // plane strain cone, no volume change
      deck.material(1, code, parameters, weight);
      deck.group(1, 2, 1, 1);
      block.write_elements(deck, 1);
      for (int n : block.bottom()) deck.fix(n, 0, 1);
      for (int n : block.left()) deck.fix(n, 1, 0);
      for (int n : block.right()) deck.fix(n, 1, 0);
      deck.initial(1, 1, 0.0, weight, K0, q);
      StageCards& rest = deck.stage();
      rest.gravity_y = -1.0;
      for (int i = 0; i < block.columns; ++i) rest.pressure(block.element(i, block.rows - 1), 3, q, q);
      StageCards& move = deck.stage(20);
      move.method = 2;  // everywhere at the limit: no tangent has an inverse
      move.max_iterations = 1000;
      for (int n : block.left()) move.fix(n, 1, 0, passive ? 0.4 : -0.4);
      const WholeRun run = record.run(deck);
      const double K = passive ? 1 / Ka : Ka, P = K * (weight * H * H / 2 + q * H);
      record.near(Where::plane_strain,
                  fmt::format("{} thrust, {}", passive ? "passive" : "active",
                              code == 4 ? "Mohr-Coulomb" : "Drucker-Prager"),
                  run.reaction(run.last(), block.left(), 0), P, 1e-6);
    }
}

}  // namespace

Section slope_cases() {
  return {
      "Slopes and walls",
      {
          {"slope.griffiths_lane", "2:1 slope, phi = 20, c = .05 gamma H",
           "Griffiths & Lane 1999, example 1: about 1.4 (Bishop & Morgenstern: 1.380)", Grade::published,
           "3 %: two digits are printed; 12 x 8 quad8, F within .01 (psi = 0: .02)", griffiths_lane},
          {"slope.acads_1a", "ACADS example 1(a)", "1.00, Giam & Donald 1989: limit equilibrium, so psi = phi",
           Grade::published, "3 %; 20 x 8 quad8, F within .01", acads},
          {"slope.bounds", "slopes by bounds of limit analysis",
           "upper bounds by log-spirals, as in slope.log_spirals", Grade::computed,
           "lower bound below the spiral, bounds 3 % apart, 1000 triangles", slope_bounds},
          {"slope.log_spirals", "slopes by sagefe safety, psi = phi",
           "least upper bound by log-spirals (Chen 1975) that do not pass below the level of the toe: "
           "1.37568867 "
           "(touches that level, ends above the toe), 1.36482236 (ends at the toe)",
           Grade::computed, "-1 to +2 % of the upper bound; 24 x 16 quad8, bracket .004", log_spirals},
          {"slope.vertical_cut", "vertical cut in Tresca clay",
           "3.7752 <= gamma H/c_u <= 3.7776 (Kammoun et al. 2010; Pastor et al. 2009)", Grade::published,
           "approached from above, a slip line smears over a cell: order 1, and 1 % extrapolated",
           vertical_cut},
          {"wall.rankine", "smooth wall, active and passive", "P = K (gamma H^2/2 + q H)", Grade::exact,
           "flow to the limit: 1e-6", rankine},
      }};
}

}  // namespace sage::verify
