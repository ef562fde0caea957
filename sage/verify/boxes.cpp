// Elastic boxes under flexible and rigid loads, and Cook's membrane: converged references without truncation
// error.
#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "sage/study/scenes.hpp"
#include "sage/verify/cases.hpp"
#include "sage/verify/fields.hpp"

namespace sage::verify {

namespace {

// Box R = H = 5, E = 1, load on 0 <= x <= 1: base fixed, sides on rollers.  Cells get finer towards the load's
// edge (1, 0); a row of nodes lies at depth 1.
struct Box {
  int inside = 20, outside = 16, near = 20, below = 8;
  double power = 3.0;
  Block block;
  DeckWriter deck;

  Box(int geometry, double nu) : deck(geometry) {
    const int in = inside, out = outside, top = near, rest = below;
    const double g = power;
    block.cell = Cell::quad8;
    block.columns = in + out;
    block.rows = rest + top;
    block.straight = true;
    block.place = [=](double s, double t) -> Vector2 {
      const double i = s * (in + out), j = t * (rest + top);
      const double x = i <= in ? 1.0 - std::pow(1.0 - i / in, g) : 1.0 + 4.0 * std::pow((i - in) / out, g);
      const double y =
          j <= rest ? -1.0 - 4.0 * std::pow(1.0 - j / rest, 1.5) : -std::pow(1.0 - (j - rest) / top, g);
      return {x, y};
    };
    block.write_nodes(deck);
    deck.material(1, 1, {1.0, nu});
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.right()) deck.fix(n, 1, 0);
    deck.stage();
  }
  int surface(int i) const { return block.node(i, block.up() - 1); }
  std::vector<int> loaded() const {
    std::vector<int> list;
    for (int i = 0; i <= 2 * inside; ++i) list.push_back(surface(i));
    return list;
  }
};

struct BoxReference {
  int geometry;
  double nu, centre, edge, work, smooth, rough;
};

// Settlements and forces of an independent hp finite-element computation.
const BoxReference kBoxes[] = {
    {2, 0.0, 1.7510580, 1.028636, 0.72544246, 2.37018, 2.62069},
    {2, 0.3, 1.5561672, 0.899316, 0.64164475, 2.68665, 2.76991},
    {2, 0.495, 1.167385, 0.623338, 0.4707263, 3.70818, 3.70820},
    {1, 0.0, 2.8271753, 1.974388, 2.59120047, 0.814289, 0.873617},
    {1, 0.3, 2.3855905, 1.613403, 2.1721543, 0.975394, 0.996298},
    {1, 0.495, 1.35987, 0.725506, 1.1849123, 1.84178, 1.84240},
};

void flexible(Record& record) {
  for (const BoxReference& b : kBoxes) {
    Box box(b.geometry, b.nu);
    for (int i = 0; i < box.inside; ++i)
      box.deck.stages[0].pressure(box.block.element(i, box.block.rows - 1), 3, 1.0, 1.0);
    const WholeRun run = record.run(box.deck);
    const Where where = where_of(b.geometry);
    const double per = b.geometry == 2 ? 2.0 * kPi : 1.0;  // the reference's work is per radian
    record.near(where, fmt::format("settlement of the centre, nu = {:g}", b.nu), -run.u(box.surface(0)).y(),
                b.centre, 1e-4);
    record.near(where, fmt::format("settlement of the load's edge, nu = {:g}", b.nu),
                -run.u(box.surface(2 * box.inside)).y(), b.edge, 1e-4);
    record.near(where, fmt::format("work of the load, nu = {:g}", b.nu),
                run.last().external.dot(run.last().u) / per, b.work, 1e-4);
    if (b.nu != 0.3) continue;
    const Vector4 s = stress_at_node(run, 0, box.block.node(0, 2 * box.below));
    const Vector4 exact = b.geometry == 2 ? Vector4(-0.049021, -0.648203, -0.049021, 0.0)
                                          : Vector4(-0.094899, -0.823424, -0.275497, 0.0);
    const char* names[] = {"horizontal", "vertical", "hoop or out-of-plane"};
    for (int c = 0; c < 3; ++c)
      record.within(where, fmt::format("{} stress at depth 1 of the centre line (tension +)", names[c]), s[c],
                    exact[c], 2e-3);
  }
}

void rigid(Record& record) {
  for (bool rough : {false, true})
    for (const BoxReference& b : kBoxes) {
      Box box(b.geometry, b.nu);
      for (int n : box.loaded()) box.deck.stages[0].fix(n, rough ? 1 : 0, 1, 0.0, -1.0);
      const WholeRun run = record.run(box.deck);
      // Full strip or full circle, per unit settlement.
      const double whole = b.geometry == 2 ? 1.0 : 2.0;
      const double force = -whole * run.reaction(run.last(), box.loaded(), 1);
      record.near(where_of(b.geometry), fmt::format("P/w, {}, nu = {:g}", rough ? "rough" : "smooth", b.nu),
                  force, rough ? b.rough : b.smooth, 2e-3);
    }
}

struct CookAnswer {
  double top, middle, work;  // rise of the right side's upper end and middle, work of the load
};

CookAnswer run_cook(const Record& record, const CookDeck& cook) {
  const WholeRun result = record.run(cook.deck());
  const std::vector<int> side = cook.block().right();
  return {result.u(side.back()).y(), result.u(side[side.size() / 2]).y(),
          result.last().external.dot(result.last().u)};
}

void cook(Record& record) {
  struct Reference {
    double E, nu, F, top, middle, work;
  };
  const Reference references[] = {{1, 1.0 / 3, 1, 22.61049, 21.52457, 21.59023},
                                  {1, 0.4999, 1, 19.4279, 18.5117, 18.567},
                                  {250, 0.4999, 100, 7.7712, 7.4047, 742.68},
                                  {240.565, 0.4999, 100, 8.0760, 7.6951, 771.82}};
  for (const Reference& r : references) {
    const std::string name = fmt::format("E = {:g}, nu = {:.4g}", r.E, r.nu);
    const CookAnswer graded = run_cook(record, {r.E, r.nu, r.F, Cell::quad8, 1, 32, 2.0});
    record.near(Where::plane_strain, "v of the top corner, " + name, graded.top, r.top, 1e-3);
    record.near(Where::plane_strain, "v of the right middle, " + name, graded.middle, r.middle, 1e-3);
    record.near(Where::plane_strain, "work, " + name, graded.work, r.work, 1e-3);
    const CookAnswer coarse = run_cook(record, {r.E, r.nu, r.F, Cell::quad4, 2, 16});
    record.near(Where::plane_strain, "v of the top corner, " + name + ", 16 x 16 b-bar", coarse.top, r.top,
                0.03);
  }
}

// What locking elements give on given meshes is a number too.
void cook_locking(Record& record) {
  const double quad4[] = {5.2072, 5.3502, 5.7785, 7.0826}, quad9[] = {16.7726, 18.2440, 18.8731, 19.1640};
  for (int level = 0; level < 4; ++level) {
    const int n = 4 << level;
    for (const auto& [cell, formulation, reference, name] :
         {std::tuple{Cell::quad4, 4, quad4[level], "quad4 full 3x3"},
          {Cell::quad9, 1, quad9[level], "quad9 full"}}) {
      const CookAnswer mesh = run_cook(record, {1.0, 0.4999, 1.0, cell, formulation, n});
      record.near(Where::plane_strain, fmt::format("v of the top corner, {}, {} x {}", name, n, n), mesh.top,
                  reference, 1e-5);
    }
  }
}

}  // namespace

Section box_cases() {
  const std::string hp = "independent hp finite-element computation, 6 to 8 digits";
  return {"Elastic boxes and Cook's membrane",
          {
              {"box.flexible", "uniform load on a box: settlements, work and stress", hp, Grade::computed,
               "graded mesh of 36 x 28 quad8; stress at a node is extrapolated: 2e-3 q", flexible},
              {"box.rigid", "rigid smooth and rough plates on a box", hp, Grade::computed,
               "the contact pressure is singular at the plate's edge: 0.2 % with a graded mesh", rigid},
              {"cook.converged", "Cook's membrane in plane strain, nu = 1/3 and .4999", hp, Grade::computed,
               "singular corner: 0.1 % on a graded mesh of 32 x 32 quad8; b-bar within 3 % at n = 16", cook},
              {"cook.locking", "what fully integrated elements give for nu = .4999",
               "the same meshes in an independent program", Grade::computed, "five digits are printed",
               cook_locking},
          }};
}

}  // namespace sage::verify
