// Pore pressures and undrained groups: columns and homogeneous specimens in closed form.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/record/field_reader.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

constexpr double kSoilE = 1e4, kSoilNu = 0.3, kSoilWeight = 20.0, kWaterWeight = 9.81;
constexpr double kHeight = 8.0, kLine = 6.0;  // of the column and of the phreatic line in it
const double kConstrained = kSoilE * (1 - kSoilNu) / ((1 + kSoilNu) * (1 - 2 * kSoilNu));

// A point of a solid at the end of an increment, compression positive.
struct WetPoint {
  Vector2 place = Vector2::Zero();
  Vector4 effective = Vector4::Zero(), total = Vector4::Zero();
  double pressure = 0.0;
};

// Points of all solids at the end of every increment.
class WetPoints final : public Observer {
 public:
  void on_increment(const Model& model, const StepReport&, const Solution& now) override {
    const FieldTable table = fields_of(model);
    std::vector<WetPoint>& points = increments.emplace_back();
    Eigen::Matrix2Xd x;
    for (const GroupData& data : now.groups()) {
      const int count = data.group->element->traits().points;
      for (int e = 0; e < data.group->elements(); ++e) {
        element_coordinates(model.mesh, *data.group, e, x);
        for (int p = 0; p < count; ++p) {
          const PointState state(model.mesh, data, static_cast<std::size_t>(e * count + p));
          WetPoint& point = points.emplace_back();
          point.place = data.group->element->position(x, p);
          read_field(*table.find("stress"), state, point.effective.data());
          read_field(*table.find("total_stress"), state, point.total.data());
          read_field(*table.find("pore_pressure"), state, &point.pressure);
        }
      }
    }
  }
  std::vector<std::vector<WetPoint>> increments;
};

template <class Miss>
double largest_of(const std::vector<WetPoint>& points, Miss miss) {
  double largest = 0.0;
  for (const WetPoint& point : points) largest = std::max(largest, std::abs(miss(point)));
  return largest;
}

// A column 1 x kHeight that can't widen, on a fixed base; weight under gravity from the first stage on.
Ground wet_column(int geometry, Cell cell, int formulation) {
  Ground ground(geometry, cell, 1, 4);
  ground.block.place = rectangle(0.0, 1.0, 0.0, kHeight);
  ground.deck = DeckWriter(geometry);
  ground.block.write_nodes(ground.deck);
  ground.deck.water_unit_weight = kWaterWeight;
  ground.deck.material(1, 1, {kSoilE, kSoilNu}, kSoilWeight);
  ground.deck.group(1, static_cast<int>(cell), formulation, 1);
  ground.block.write_elements(ground.deck, 1);
  for (const int node : ground.block.left()) ground.deck.fix(node, 1, 0);
  for (const int node : ground.block.right()) ground.deck.fix(node, 1, 0);
  for (const int node : ground.block.bottom()) ground.deck.fix(node, 1, 1);
  return ground;
}

struct WetCell {
  const char* name;
  Cell cell;
  int formulation;
};
constexpr WetCell kWetCells[] = {{"quad4 full", Cell::quad4, 1}, {"quad8 reduced", Cell::quad8, 1}};

// Total weight from the first stage on under a phreatic line: u is hydrostatic, and the effective vertical stress what is
// left of the weight above.  Four elements over the height put a side of one on the line.
void hydrostatic(Record& record) {
  for (const int geometry : {1, 2})
    for (const WetCell& c : kWetCells) {
      Ground ground = wet_column(geometry, c.cell, c.formulation);
      ground.deck.stage().gravity_y = -1.0;
      ground.deck.water(1, 0, 1, 0, {0.0, kLine});
      WetPoints seen;
      Observer* const observers[] = {&seen};
      const WholeRun run = record.run(record.bench().build(ground.deck.text()), observers);
      const std::vector<WetPoint>& points = seen.increments.back();
      const auto head = [](const WetPoint& p) { return kWaterWeight * std::max(0.0, kLine - p.place.y()); };
      const Where where = where_of(geometry);
      const double bottom = kSoilWeight * kHeight;
      record.small(where, fmt::format("pore pressure over gamma H, {}", c.name),
                   largest_of(points, [&](const WetPoint& p) { return p.pressure - head(p); }) / bottom, 1e-10);
      record.small(where, fmt::format("total - effective - u over gamma H, {}", c.name),
                   largest_of(points,
                              [&](const WetPoint& p) {
                                return (p.total - p.effective).head<3>().maxCoeff() - p.pressure;
                              }) /
                       bottom,
                   1e-10);
      // Settlement: the integral of (gamma (H - y) - u) / M.
      const double settlement =
          (kSoilWeight * kHeight * kHeight - kWaterWeight * kLine * kLine) / 2.0 / kConstrained;
      record.near(where, fmt::format("settlement, {}", c.name), -run.u(ground.block.top().front()).y(),
                  settlement, 1e-9);
      double mean = 0.0, exact = 0.0;  // of the lowest element: stress of quad4 is constant over the height
      for (const WetPoint& p : points)
        if (p.place.y() < kHeight / 4)
          mean += p.effective[1], exact += kSoilWeight * (kHeight - p.place.y()) - head(p);
      record.near(where, fmt::format("effective vertical stress in the lowest element, {}", c.name), mean,
                  exact, 1e-9);
    }
}

// A start by K0 under the line, which then falls by 4 m: the surface settles by the integral of the lost pressure over M.
void drawdown(Record& record) {
  constexpr double kFall = 4.0;
  for (const int geometry : {1, 2}) {
    Ground ground = wet_column(geometry, Cell::quad8, 1);
    ground.deck.initial(1, 1, kHeight, kSoilWeight, 0.5);
    ground.deck.stage().gravity_y = -1.0;
    ground.deck.stage(4);
    ground.deck.water(1, 0, 1, 0, {0.0, kLine});
    ground.deck.water(1, 0, 2, 0, {0.0, kLine - kFall});
    const WholeRun run = record.run(ground.deck);
    const Where where = where_of(geometry);
    const int top = DofMap::displacement(run.index(ground.block.top().front()), 1);
    const double settlement = kWaterWeight * kFall * (kFall / 2.0 + kLine - kFall) / kConstrained;
    record.small(where, "the start, over the settlement: nothing moves",
                 run.increments.front().u.cwiseAbs().maxCoeff() / settlement, 1e-10);
    record.near(where, "settlement of the drawdown", -run.last().u[top], settlement, 1e-9);
    record.near(where, "half of it at half of the stage", -run.increments[2].u[top], 0.5 * settlement, 1e-9);
  }
}

// r_u: u is this share of the weight above, gamma (H - y).
void pressure_ratio(Record& record) {
  constexpr double kRatio = 0.25;
  for (const int geometry : {1, 2}) {
    Ground ground = wet_column(geometry, Cell::quad8, 1);
    ground.deck.stage().gravity_y = -1.0;
    ground.deck.water(2, 0, 1, 0, {}, kRatio);
    WetPoints seen;
    Observer* const observers[] = {&seen};
    const WholeRun run = record.run(record.bench().build(ground.deck.text()), observers);
    const auto above = [](const WetPoint& p) { return kSoilWeight * (kHeight - p.place.y()); };
    const Where where = where_of(geometry);
    record.small(
        where, "u - r_u gamma z over gamma H",
        largest_of(seen.increments.back(), [&](const WetPoint& p) { return p.pressure - kRatio * above(p); }) /
            (kSoilWeight * kHeight),
        1e-9);
    record.small(where, "effective vertical stress - (1 - r_u) gamma z, over gamma H",
                 largest_of(seen.increments.back(),
                            [&](const WetPoint& p) { return p.effective[1] - (1.0 - kRatio) * above(p); }) /
                     (kSoilWeight * kHeight),
                 1e-9);
    record.near(where, "settlement", -run.u(ground.block.top().front()).y(),
                (1.0 - kRatio) * kSoilWeight * kHeight * kHeight / 2.0 / kConstrained, 1e-9);
  }
}

// A weightless column under p: water of bulk B = K_w/n in it bears p B / (M + B); drained, it leaves, and the settlement is
// p H / M.
void undrained_column(Record& record) {
  constexpr double kPressed = 100.0;
  for (const int geometry : {1, 2})
    for (const double bulk : {1e4, 2.2e6}) {
      Ground ground = wet_column(geometry, Cell::quad8, 1);
      ground.deck.stage().pressure(ground.block.element(0, 3), 3, kPressed, kPressed);
      ground.deck.stage(2);
      ground.deck.water(5, 1, 1, 0, {}, bulk);
      ground.deck.water(6, 1, 2, 0, {});
      WetPoints seen;
      Observer* const observers[] = {&seen};
      const WholeRun run = record.run(record.bench().build(ground.deck.text()), observers);
      const int top = DofMap::displacement(run.index(ground.block.top().front()), 1);
      const std::string name = fmt::format(", K_w/n = {:g} M", std::round(bulk / kConstrained * 10.0) / 10.0);
      const Where where = where_of(geometry);
      const double excess = kPressed * bulk / (kConstrained + bulk);
      record.near(where, "excess pressure, shut in" + name, seen.increments.front().front().pressure, excess,
                  1e-9);
      record.near(where, "settlement, shut in" + name, -run.increments.front().u[top],
                  kPressed * kHeight / (kConstrained + bulk), 1e-8);
      record.small(where, "excess pressure, drained, over p" + name,
                   largest_of(seen.increments.back(), [](const WetPoint& p) { return p.pressure; }) / kPressed,
                   1e-9);
      record.near(where, "settlement, drained" + name, -run.last().u[top], kPressed * kHeight / kConstrained,
                  1e-9);
    }
}

// A specimen 1 x 2 between smooth plates, consolidated to p0 all round and then sheared with its water shut in.  Elastic
// soil keeps its mean effective stress (in plane strain that of the plane: the stress out of it does not change, because
// nothing strains there), and plastic flow at constant volume too: Mohr-Coulomb with psi = 0 then fails at
//   plane strain  q = 2 (c cos(phi) + p0 sin(phi)),   triaxial  q = 6 (c cos(phi) + p0 sin(phi)) / (3 - sin(phi)).
// The cell pressure is constant, so that u = p0 + q / 2 or q / 3, less the constant mean effective stress p0.
void undrained_strength(Record& record) {
  constexpr double kCell = 100.0, kCohesion = 5.0, kFriction = 30.0 * kDegree;
  for (const int geometry : {1, 2}) {
    Block block;
    block.columns = block.rows = 1;
    block.cell = Cell::quad8;
    block.place = rectangle(0.0, 1.0, 0.0, 2.0);
    DeckWriter deck(geometry);
    block.write_nodes(deck);
    deck.material(1, 4, {kSoilE, kSoilNu, kCohesion, 30.0, 0.0});
    deck.group(1, static_cast<int>(block.cell), 1, 1);
    block.write_elements(deck, 1);
    for (const int node : block.left()) deck.fix(node, 1, 0);
    for (const int node : block.bottom()) deck.fix(node, 0, 1);
    deck.initial(1, 0, kCell, kCell, kCell, 0.0);
    StageCards& consolidate = deck.stage();
    consolidate.pressure(block.element(0, 0), 2, kCell, kCell);
    consolidate.pressure(block.element(0, 0), 3, kCell, kCell);
    StageCards& shear = deck.stage(8);
    for (const int node : block.top()) shear.fix(node, 0, 1, 0.0, -0.08);
    deck.water(5, 0, 2, 0, {}, 0.0, 0.5);
    WetPoints seen;
    Observer* const observers[] = {&seen};
    const WholeRun run = record.run(record.bench().build(deck.text()), observers);
    const Where where = where_of(geometry);
    const double strength = kCohesion * std::cos(kFriction) + kCell * std::sin(kFriction);
    const double q = geometry == 1 ? 2.0 * strength : 6.0 * strength / (3.0 - std::sin(kFriction));
    const double area = geometry == 1 ? 1.0 : kPi;
    record.small(where, "consolidated: displacement over the height",
                 run.increments.front().u.cwiseAbs().maxCoeff() / 2.0, 1e-12);
    record.near(where, "q at failure", -run.reaction(run.last(), block.top(), 1) / area, q, 1e-6);
    record.near(where, "excess pore pressure at failure", seen.increments.back().front().pressure,
                geometry == 1 ? q / 2.0 : q / 3.0, 1e-6);
    // The first of the eight increments is elastic: q = 4 G strain in the plane, 3 G strain in triaxial compression.
    const double G = kSoilE / (2.0 * (1.0 + kSoilNu)), strain = 0.01 / 2.0;
    const double elastic = (geometry == 1 ? 4.0 : 3.0) * G * strain;
    record.near(where, "elastic q", -run.reaction(run.increments[1], block.top(), 1) / area, elastic, 1e-6);
    record.near(where, "elastic excess pore pressure", seen.increments[1].front().pressure,
                geometry == 1 ? elastic / 2.0 : elastic / 3.0, 1e-6);
  }
}

// nu_u = .49 with E and nu of effective stress is an elastic soil of that ratio and the same shear modulus.
void undrained_ratio(Record& record) {
  constexpr double kUndrained = 0.49;
  for (const int geometry : {1, 2}) {
    WholeRun runs[2];
    for (const bool shut : {true, false}) {
      Ground ground(geometry, Cell::quad8, 4, 4);
      const double G = 5000.0,
                   E = 2.0 * G * (1.0 + (shut ? kSoilNu : kUndrained));  // of few digits: a card has ten
      ground.deck.material(1, 1, {E, shut ? kSoilNu : kUndrained}, kSoilWeight);
      ground.deck.group(1, static_cast<int>(Cell::quad8), 1, 1);
      ground.block.write_elements(ground.deck, 1);
      StageCards& stage = ground.deck.stage();
      stage.gravity_y = -1.0;
      stage.pressure(ground.block.element(0, 3), 3, 50.0, 50.0);
      if (shut) ground.deck.water(5, 0, 1, 0, {}, 0.0, kUndrained);
      runs[shut ? 0 : 1] = record.run(ground.deck);
    }
    record.small(where_of(geometry), "displacement, water shut in - elastic soil of nu_u, over the largest",
                 (runs[0].last().u - runs[1].last().u).cwiseAbs().maxCoeff() / runs[1].largest_u(), 1e-9);
  }
}

}  // namespace

Section water_cases() {
  return {
      "Pore water",
      {
          {"water.hydrostatic", "gravity on a column under a phreatic line",
           "u = gamma_w (h - y); the weight above less u, over the constrained modulus", Grade::exact,
           "rounding: 1e-9", hydrostatic},
          {"water.drawdown", "the line falls by 4 m after a start by K0",
           "the integral of the lost pressure over the constrained modulus", Grade::exact, "rounding: 1e-9",
           drawdown},
          {"water.ratio", "gravity on a column with r_u = .25", "u = r_u gamma z", Grade::exact,
           "rounding: 1e-9", pressure_ratio},
          {"water.undrained_column", "a column loaded with its water shut in, then drained",
           "p B/(M + B) of the load is borne by water of bulk B = K_w/n", Grade::exact, "rounding: 1e-8",
           undrained_column},
          {"water.undrained_strength", "a consolidated Mohr-Coulomb specimen sheared undrained to failure",
           "constant mean effective stress; q = 2 (c cos phi + p0 sin phi) in the plane, 6 (c cos phi + p0 sin "
           "phi)/(3 - sin phi) in the triaxial cell",
           Grade::exact, "1e-6: the change of volume that nu_u = 1/2 leaves", undrained_strength},
          {"water.undrained_ratio", "a block with nu_u = .49 and an elastic one of that ratio",
           "same shear modulus, same ratio: the same displacement", Grade::twofold, "rounding: 1e-9",
           undrained_ratio},
      }};
}

}  // namespace sage::verify
