// Stages: null step, earth pressure at rest, excavation in one and several stages, fill in lifts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

constexpr double kWeight = 20.0, kGroundE = 1e4, kGroundNu = 0.3;
const double kOedometer = kGroundE * (1 - kGroundNu) / ((1 + kGroundNu) * (1 - 2 * kGroundNu));

struct NullCase {
  const char* name;
  Cell cell;
  int law;  // 1 elastic, 3 Drucker-Prager, 4 Mohr-Coulomb
  double K0;
  int ring_formulation = 0;
};

// Geostatic stress and gravity in balance: nothing moves.  In a ring tri6 needs its six points: N,r sigma r is
// of third degree, which three points don't integrate.
void null_step(Record& record) {
  const NullCase cases[] = {{"quad4", Cell::quad4, 1, 0.5},
                            {"quad8", Cell::quad8, 1, 0.8},
                            {"quad9", Cell::quad9, 1, 0.5},
                            {"tri6", Cell::tri6, 1, 1.2, 2},
                            {"quad8 Mohr-Coulomb", Cell::quad8, 4, 0.5},
                            {"quad4 Mohr-Coulomb", Cell::quad4, 4, 2.0},
                            {"quad4 Drucker-Prager", Cell::quad4, 3, 0.6},
                            {"quad8 Drucker-Prager", Cell::quad8, 3, 1.5}};
  for (int geometry : {1, 2})
    for (const NullCase& c : cases) {
      Ground ground(geometry, c.cell, 4, 6);
      std::vector<double> parameters{kGroundE, kGroundNu};
      if (c.law != 1) parameters.insert(parameters.end(), {5.0, 30.0, 0.0});
      ground.deck.material(1, c.law, parameters, kWeight);
      ground.deck.group(1, static_cast<int>(c.cell), geometry == 2 ? c.ring_formulation : 0, 1);
      ground.block.write_elements(ground.deck, 1);
      ground.deck.initial(1, 1, 0.0, kWeight, c.K0, 0.0);
      ground.deck.stage(3).gravity_y = -1.0;
      const WholeRun run = record.run(ground.deck);
      const std::string name = fmt::format("{}, K0 = {:g}", c.name, c.K0);
      record.small(where_of(geometry), "largest displacement over H, " + name, run.largest_u() / 6.0, 1e-10);
      const double weight = kWeight * 6.0 * (geometry == 1 ? 4.0 : kPi * 16.0);
      record.near(where_of(geometry), "reaction of the base, " + name,
                  run.reaction(run.last(), ground.block.bottom(), 1), weight, 1e-9);
    }
}

// Gravity on a column that can't widen: sigma_h = nu/(1-nu) sigma_v, settlement gamma H^2/(2 M).
void rest_column(Record& record) {
  for (int geometry : {1, 2})
    for (Cell cell : {Cell::quad4, Cell::quad8}) {
      Ground ground(geometry, cell, 1, 5);
      ground.deck.material(1, 1, {kGroundE, kGroundNu}, kWeight);
      ground.deck.group(1, static_cast<int>(cell), 1, 1);
      ground.block.write_elements(ground.deck, 1);
      ground.deck.stage().gravity_y = -1.0;
      const WholeRun run = record.run(ground.deck);
      const std::string name = cell == Cell::quad4 ? "quad4 full" : "quad8 reduced";
      record.near(where_of(geometry), "settlement, " + name, -run.u(ground.block.top().front()).y(),
                  kWeight * 25.0 / (2 * kOedometer), 1e-10);
      const PointStresses& s = run.stress[0];
      const double ratio = kGroundNu / (1 - kGroundNu);
      record.small(where_of(geometry), "sigma_h - K0 sigma_v over gamma H, " + name,
                   (s.row(0) - ratio * s.row(1)).cwiseAbs().maxCoeff() / (kWeight * 5.0), 1e-10);
      record.small(where_of(geometry), "sigma_z (or hoop) - sigma_h over gamma H, " + name,
                   (s.row(2) - s.row(0)).cwiseAbs().maxCoeff() / (kWeight * 5.0), 1e-10);
    }
}

// A pit, 3 x 4 cells in a ground of 6 x 6, dug in the given portions of rows (a group a row).
WholeRun dig(const Record& record, int geometry, const std::vector<int>& portions, bool initial_stress) {
  const int columns = 6, rows = 6, wide = 3, deep = 4;
  Ground ground(geometry, Cell::quad4, columns, rows);
  ground.deck.material(1, 1, {kGroundE, kGroundNu}, kWeight);
  for (int g = 1; g <= 1 + deep; ++g) ground.deck.group(g, 1, 2, 1);
  const Block& all = ground.block;
  all.write_elements(ground.deck, 1);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < wide; ++i) {
      const int layer = rows - 1 - j;  // 0 at the surface
      if (layer >= deep) continue;
      const int n = all.node(i, j);
      DeckWriter card(1);
      card.element(all.element(i, j), 2 + layer, {n, n + 1, n + 1 + all.across(), n + all.across()});
      ground.deck.elements[all.element(i, j) - 1] = card.elements.front();
    }
  if (initial_stress)
    for (int g = 1; g <= 1 + deep; ++g) ground.deck.initial(g, 1, 0.0, kWeight, 0.7, 0.0);
  ground.deck.stage().gravity_y = -1.0;
  int next = 2;
  for (int portion : portions) {
    StageCards& stage = ground.deck.stage(2);
    for (int k = 0; k < portion; ++k) stage.deaths.push_back(next++);
  }
  return record.run(ground.deck);
}

// Elastic: the order of removal can't matter (Ishihara 1970; Brown & Booker 1985).  Nodes of the ground that is
// left; those inside the pit stop where they were when they went.
void excavation(Record& record) {
  for (int geometry : {1, 2})
    for (bool initial_stress : {false, true}) {
      const WholeRun once = dig(record, geometry, {4}, initial_stress);
      const WholeRun thrice = dig(record, geometry, {1, 2, 1}, initial_stress);
      const std::string name = initial_stress ? "K0 = .7" : "gravity turned on";
      double difference = 0.0, size = 0.0;
      for (int node : once.model->groups[0].nodes) {
        const Vector2 a = once.last().u.segment<2>(DofMap::displacement(node)),
                      b = thrice.last().u.segment<2>(DofMap::displacement(node));
        difference = std::max(difference, (a - b).norm());
        size = std::max(size, a.norm());
      }
      const Where where = where_of(geometry);
      record.small(where, "displacement, one stage - three, " + name, difference / size, 1e-10);
      record.small(where, "stress, one stage - three, over gamma H, " + name,
                   (once.stress[0] - thrice.stress[0]).cwiseAbs().maxCoeff() / (kWeight * 6.0), 1e-10);
      const int floor =
          DofMap::displacement(once.index(2 * 7 + 1), 1);  // on the left side, two rows above the base
      record.within(where, "floor of the pit rises, " + name,
                    once.last().u[floor] > once.increments[0].u[floor] ? 1.0 : 0.0, 1.0, 0.5);
      double up = 0.0;
      for (int number : once.model->mesh.number) up += once.reaction(number).y();
      const double left = geometry == 1 ? 36.0 - 12.0 : kPi * (36.0 * 6.0 - 9.0 * 4.0);
      record.near(where, "reactions carry the weight that is left, " + name, up, kWeight * left, 1e-9);
    }
}

// A column of three lifts that can't widen, each placed stress-free and then heavy.
void lifts(Record& record) {
  for (int geometry : {1, 2}) {
    Ground ground(geometry, Cell::quad4, 1, 3);
    ground.deck.material(1, 1, {kGroundE, kGroundNu}, kWeight);
    const Block& block = ground.block;
    for (int g = 1; g <= 3; ++g) ground.deck.group(g, 1, 1, 1);
    for (int j = 0; j < 3; ++j)
      ground.deck.element(j + 1, j + 1,
                          {block.node(0, j), block.node(1, j), block.node(1, j + 1), block.node(0, j + 1)});
    for (int g = 1; g <= 3; ++g) ground.deck.stage().births = {g};
    ground.deck.stages[0].gravity_y = -1.0;
    const WholeRun run = record.run(ground.deck);
    const double one = kWeight / kOedometer;  // a lift's own pressure over M
    // A lift settles by half its own weight and the lifts above it, from the time it was placed on.
    const double settlement[] = {(0.5 + 2) * one, 2 * one + 1.5 * one, 1 * one + 1 * one + 0.5 * one};
    for (int lift = 0; lift < 3; ++lift) {
      record.near(where_of(geometry), fmt::format("settlement of the top of lift {}", lift + 1),
                  -run.u(block.node(0, lift + 1)).y(), settlement[lift], 1e-10);
      record.near(where_of(geometry), fmt::format("mean vertical stress in lift {} (tension +)", lift + 1),
                  run.stress[lift].row(1).mean(), -kWeight * (2.5 - lift), 1e-9);
    }
  }
}

}  // namespace

Section ground_cases() {
  return {"Stages",
          {
              {"stage.null_step", "geostatic stress and gravity in balance", "nothing moves", Grade::exact,
               "rounding: 1e-10 H", null_step},
              {"stage.rest_column", "gravity on a column that can't widen",
               "sigma_h = nu/(1 - nu) sigma_v, gamma H^2/(2 M)", Grade::exact, "rounding: 1e-10", rest_column},
              {"stage.excavation", "a pit dug in one stage and in three",
               "uniqueness: Ishihara 1970; Brown & Booker 1985", Grade::twofold, "rounding: 1e-10; weight 1e-9",
               excavation},
              {"stage.lifts", "fill in three lifts, each placed without stress",
               "half a lift's own weight and the lifts above it", Grade::exact, "rounding: 1e-10 (stress 1e-9)",
               lifts},
          }};
}

}  // namespace sage::verify
