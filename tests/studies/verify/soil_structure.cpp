// Walls, pipes, tanks, rafts and piles in soil: balances of forces that different parts of the results report, limit
// cases and closed forms.
#include <fmt/format.h>

#include <cmath>

#include "sage/safety/safety.hpp"
#include "tests/studies/scenes/soil_structure.hpp"
#include "tests/studies/scenes/structures.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

// Forces and moments of earth, struts and hoops on a wall at the end of stages, over the outer earth's; the last.
WallForces wall_balance(Record& record, const WallInGround& scene, const std::string& name, int from) {
  WallForces f;
  for (int stage = from; stage <= scene.stages(); ++stage) {
    f = wall_forces(scene, record.run(scene.deck(stage)));
    const Where where = where_of(scene.geometry);
    record.small(where, fmt::format("{}: horizontal forces on the wall, stage {}", name, stage),
                 f.balance() / f.outside.x(), 1e-7);
    record.small(where, fmt::format("{}: moments on the wall, stage {}", name, stage),
                 f.moment_balance() / f.outside_moment, 1e-7);
    record.small(where, fmt::format("{}: vertical forces on the wall, stage {}", name, stage),
                 (f.outside.y() + f.inside.y()) / f.outside.x(), 1e-6);
  }
  return f;
}

void braced(Record& record) {
  for (const int geometry : {1, 2})
    wall_balance(record, braced_excavation(geometry), geometry == 1 ? "struts" : "rings", 1);
  WallInGround hoops = braced_excavation(2);
  hoops.goes_around = true;
  wall_balance(record, hoops, "rings and wall", 5);
}

void sheet_piles(Record& record) {
  for (const bool anchored : {false, true}) {
    const WallInGround scene = anchored ? anchored_sheet_pile() : cantilever_sheet_pile();
    const WallForces f = wall_balance(record, scene, anchored ? "anchored" : "cantilever", scene.stages());
    if (anchored) continue;
    // Nearly smooth, it has given way above its point of rotation: active earth pressure there.
    double thrust = 0.0, rankine = 0.0;
    for (std::size_t z = 0; z <= 5; ++z) {
      const double part = z == 0 || z == 5 ? 0.5 : 1.0;
      thrust += part * f.outer_pressure[z];
      rankine += part * (scene.weight * static_cast<double>(z) / 3.0 - 2.0 * scene.cohesion / std::sqrt(3.0));
    }
    record.near(Where::plane_strain, "cantilever: thrust on the upper 5 m over Rankine's", thrust / rankine,
                1.0, 0.05);
  }
}

// A pipe in a fill: what lies on its upper half against its thrust, and what the last two lifts add to it against a ring
// in infinite ground under their weight and K0 = nu/(1 - nu).
void culvert(Record& record) {
  for (const bool slipping : {false, true}) {
    Culvert scene;
    scene.slipping = slipping;
    const std::string name = slipping ? "slipping" : "bonded";
    const int last = 1 + scene.lifts;
    CulvertForces before, after;
    for (const int stage : {last - 2, last}) {
      const CulvertForces f = culvert_forces(record.run(scene.deck(stage)));
      record.near(Where::plane_strain,
                  fmt::format("thrust against what presses on the upper half, {}, stage {}", name, stage),
                  f.thrust_down, f.down, slipping ? 2e-4 : 1e-7);
      (stage == last ? after : before) = f;
    }
    if (slipping)
      record.small(Where::plane_strain, "range of the thrust over its mean, slipping",
                   2.0 * (after.most - after.least) / (after.most + after.least), 0.02);
    RingInGround ring;
    ring.E = scene.E;
    ring.EA = scene.EA;
    ring.EI = scene.EI;
    ring.GA = 5.0 / 12.0 * scene.EA;
    ring.sv = 2.0 * scene.weight;
    ring.K0 = scene.nu / (1.0 - scene.nu);
    if (slipping) ring.ks = 0.0;
    ring.solve();
    record.near(Where::plane_strain, "two lifts: thrust at the springline, " + name,
                after.springline - before.springline, -ring.axial_force(0.0), 0.03);
    record.near(Where::plane_strain, "two lifts: thrust at the crown, " + name, after.crown - before.crown,
                -ring.axial_force(0.5 * kPi), 0.03);
    if (slipping)
      record.near(Where::plane_strain, "two lifts: moment at the crown, " + name, after.moment - before.moment,
                  ring.moment(0.5 * kPi), 0.03);
  }
}

void pile(Record& record) {
  const PipePile scene;
  const PileForces f = pile_forces(scene, record.run(scene.deck()));
  record.near(Where::axisymmetric, "shaft at its adhesion", f.shaft,
              2.0 * kPi * scene.radius * scene.length * scene.adhesion, 1e-9);
  record.near(Where::axisymmetric, "load against shaft and tip", f.head, f.shaft + f.tip, 1e-7);
}

// The load alone against the elastic box, and the wall against the differential equation from where its foot has gone.
void tank_on_soil(Record& record) {
  TankOnSoil load;
  load.shell = false;
  load.columns = 10;
  load.rows = 16;
  const WholeRun soft = record.run(load.deck());
  const double scale = 60.0 * TankOnSoil::radius / load.E_soil;
  record.near(Where::axisymmetric, "settlement of the centre, load without tank",
              -soft.u(load.surface(0)).y() / scale, 1.5561672, 5e-4);
  record.near(Where::axisymmetric, "settlement of the edge, load without tank",
              -soft.u(load.surface(load.columns)).y() / scale, 0.899316, 5e-4);
  const TankOnSoil scene;
  const WholeRun run = record.run(scene.deck());
  const double t = scene.wall, E = 3e7, nu = 0.2, a = TankOnSoil::radius;
  BeamOnSprings wall(E * t * t * t / (12.0 * (1.0 - nu * nu)), 5.0 / 6.0 * E * t / (2.0 * (1.0 + nu)),
                     E * t / (a * a), TankOnSoil::height);
  wall.q0 = -60.0;
  wall.q1 = 10.0;
  using B = BeamOnSprings;
  const int foot = scene.surface(scene.columns);
  wall.solve({B::deflection, -run.u(foot).x()}, {B::slope, rotation_of(run, foot)}, {B::moment, 0.0},
             {B::shear, 0.0});
  for (const int j : {2, 5, 9, 13})
    record.near(Where::axisymmetric, fmt::format("radial displacement of the wall at {:g}", 0.25 * (j - 1)),
                run.u(scene.wall_node(j)).x(), -wall.at(0.25 * (j - 1))[B::deflection], 1e-3);
}

void raft(Record& record) {
  for (const int finer : {1, 2}) {
    RaftOnGround scene;
    scene.columns = scene.outside = 5 * finer;
    scene.rows = 8 * finer;
    const std::string mesh = fmt::format(", {} elements", scene.columns);
    scene.EA = scene.EI = 1e-6;
    const WholeRun soft = record.run(scene.deck());
    record.near(Where::plane_strain, "settlement of the middle, EI -> 0" + mesh, -soft.u(scene.surface(0)).y(),
                2.3855905, 1e-4);
    record.near(Where::plane_strain, "settlement of the edge, EI -> 0" + mesh,
                -soft.u(scene.surface(scene.columns)).y(), 1.613403, finer == 1 ? 1e-3 : 2e-4);
    scene.EA = scene.EI = 1e6;
    const WholeRun stiff = record.run(scene.deck());
    record.near(Where::plane_strain, "load over settlement, EI -> infinity" + mesh,
                -2.0 / stiff.u(scene.surface(0)).y(), 0.996298, finer == 1 ? 1e-2 : 5e-3);
  }
  // From side to side: one-dimensional compression of the layers.
  RaftOnGround wide;
  wide.whole_width = true;
  wide.moduli = {1.0, 4.0};
  const double M = 0.7 / (1.3 * 0.4);
  const WholeRun run = record.run(wide.deck());
  record.near(Where::plane_strain, "settlement of layers under a raft from side to side",
              -run.u(wide.surface(2)).y(), 2.5 / M + 2.5 / (4.0 * M), 1e-7);
}

// Joints that slip on both faces leave the wall without a hold along its own axis.  A spring below its tip holds it
// there: stiff enough for every single iterate, and too soft to carry a part of a thousandth of the earth.
void walls_by_safety(Record& record) {
  const auto factor = [&](double spring) {
    WallInGround scene = cantilever_sheet_pile();
    scene.tip_spring = spring;
    safety::Options options;
    options.limits.start = 1.5;
    options.limits.tolerance = 0.004;
    Model model = record.bench().build(scene.deck().text());
    const safety::Safety found =
        safety::find_safety(model, record.bench().catalogue(), record.bench().settings(), options);
    if (!found.complete()) throw AnalysisError("S515", found.incomplete);
    return 0.5 * (*found.lower + *found.upper);
  };
  const double held = factor(100.0);
  record.near(Where::plane_strain, "factor of safety, tip held by 100 kN/m", held, 1.8475, 4e-3);
  record.near(Where::plane_strain, "factor of safety, tip on nothing", factor(0.0), held, 4e-3);
  record.near(Where::plane_strain, "factor of safety, tip held by 0.01 kN/m", factor(0.01), held, 4e-3);
}

}  // namespace

Section soil_structure_cases() {
  const std::string balance = "equilibrium of forces that different parts of the results report";
  const std::string rounding = "rounding and the step's tolerance, 1e-8";
  return {
      "Soil and structures",
      {
          {"soil_structure.braced_excavation", "cut with struts and shaft with rings, five stages", balance,
           Grade::twofold, rounding, braced},
          {"soil_structure.sheet_piles", "cantilever and anchored sheet pile: earth against earth and anchor",
           balance + "; Rankine 1857", Grade::twofold, rounding + "; Rankine's limit 5 %, nodes 1 m apart",
           sheet_piles},
          {"soil_structure.culvert", "pipe under a fill in lifts, bonded and slipping",
           balance + "; Burns and Richard 1964 for what two lifts add", Grade::twofold,
           rounding + "; 2e-4 where forces are those of Gauss points; 3 %: the fill ends 3 radii from the pipe",
           culvert},
          {"soil_structure.tank", "circular tank on soil",
           "independent hp computation of the load alone; differential equation of the wall", Grade::computed,
           "10 and 5 elements along the bottom", tank_on_soil},
          {"soil_structure.raft", "raft on layered ground: without stiffness, rigid, from side to side",
           "independent hp computation; one-dimensional compression", Grade::computed,
           "the rigid raft's edge is singular: 1 % and less with 5 and 10 elements", raft},
          {"soil_structure.pile", "closed pipe pile pushed into clay: shaft at its adhesion, and its tip",
           "adhesion times area; " + balance, Grade::exact, rounding, pile},
          {"soil_structure.safety_with_walls", "cantilever sheet pile by strength reduction",
           "the same wall held at its tip, and 1.84 to 1.855 by stages with divided strengths", Grade::twofold,
           "brackets of .004", walls_by_safety},
      }};
}

}  // namespace sage::verify
