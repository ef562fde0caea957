// Beams and shells: cantilevers, a beam on springs, plates, the wall of a tank.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <utility>

#include "sage/math/quadrature.hpp"
#include "tests/studies/scenes/structures.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

// B1 of the numbers: L = 10, a unit square, E = 1e4, nu = .25, unit force at the tip.
void cantilever(Record& record) {
  for (const auto& [across, exact] : {std::pair{0.0, 0.403}, {1.0, 0.378}})
    for (const int n : {1, 8}) {
      BeamRow row(1, kBeam2, n, {0.0, 0.0}, {10.0, 0.0}, kPlate, {1e4, 0.25, 1.0, across});
      row.clamp(1);
      row.deck.stage().load(row.last(), 0.0, 1.0);
      const WholeRun run = record.run(row.deck);
      record.near(Where::plane_strain,
                  fmt::format("deflection, {}, {} element(s)", across == 0.0 ? "E" : "E/(1-nu^2)", n),
                  run.u(row.last()).y(), exact, 1e-11);
      record.near(Where::plane_strain, "moment at the clamp", run.stress[0](3, 0), 10.0, 1e-10);
    }
}

// A run, and the section forces at the ends of its first group's elements.
struct RunWithEnds {
  WholeRun run;
  std::vector<EndForces> ends;
};

RunWithEnds run_with_ends(const Record& record, Model model, std::size_t group = 0) {
  EndReader reader(group);
  Observer* const observers[] = {&reader};
  WholeRun run = record.run(std::move(model), observers);
  return {std::move(run), reader.ends()};
}

RunWithEnds run_with_ends(const Record& record, const DeckWriter& deck, std::size_t group = 0) {
  return run_with_ends(record, record.bench().build(deck.text()), group);
}

// The last of a sequence of errors, and its order.
struct Errors {
  std::string what;
  double theory, gate;
  double rounding =
      0.0;  // errors below it show no order: meshes beyond the second that have them are left out of it
  std::vector<double> size = {}, error = {};

  void add(double h, double computed, double exact) {
    size.push_back(h);
    error.push_back(std::abs(computed / exact - 1.0));
  }
  void rows(Record& record, Where where, double slack = 0.15) const {
    std::size_t shown = size.size();
    while (shown > 2 && error[shown - 1] < rounding) --shown;
    record.order(where, what, {size.begin(), size.begin() + static_cast<std::ptrdiff_t>(shown)},
                 {error.begin(), error.begin() + static_cast<std::ptrdiff_t>(shown)}, theory, slack);
    record.small(where, what + ", finest mesh, relative", error.back(), gate);
  }
};

void slender(Record& record) {
  const double h = 1e-3, E = 1e4, EI = E * h * h * h / 12.0, GA = 5.0 / 6.0 * 0.5 * E * h;
  const double exact = 1000.0 / (3.0 * EI) + 10.0 / GA;
  const auto deflection = [&](int code, int n) {
    BeamRow row(1, code, n, {0.0, 0.0}, {10.0, 0.0}, kPlate, {E, 0.0, h, 0.0});
    row.clamp(1);
    row.deck.stage().load(row.last(), 0.0, 1e-9);
    return 1e9 * record.run(row.deck).u(row.last()).y();
  };
  record.near(Where::plane_strain, "deflection, L/h = 1e4, beam2", deflection(kBeam2, 4), exact, 1e-6);
  record.near(Where::plane_strain, "deflection, L/h = 1e4, beam3", deflection(kBeam3, 16), exact, 1e-6);
}

// B2 of the numbers: EI = 1000, length 10 with free ends, on springs of 100 for each unit of length and width; force 1 down
// in the middle.  Without shear (the numbers), and with GA = 2000 (the differential equation, for one half).
void hetenyi(Record& record) {
  const double numbers[] = {0.0021484346093, -0.00046278522147, 0.66344563524};
  using B = BeamOnSprings;
  for (const double GA : {1e9, 2000.0}) {
    BeamOnSprings half(1000.0, GA, 100.0, 5.0);
    half.solve({B::slope, 0.0}, {B::shear, 0.5}, {B::moment, 0.0}, {B::shear, 0.0});
    const double exact[] = {-half.at(0.0)[B::deflection], -half.at(5.0)[B::deflection],
                            half.at(0.0)[B::moment]};
    if (GA == 1e9)
      for (int i = 0; i < 3; ++i)
        record.near(Where::plane_strain, "differential equation against Hetenyi", exact[i], numbers[i], 1e-6);
    const std::string shear = GA == 1e9 ? "no shear" : "GA = 2000";
    for (const auto& [code, name, theory] : {std::tuple{kBeam2, "beam2", 2.0}, {kBeam3, "beam3", 4.0}}) {
      if (code == kBeam3 && GA == 1e9) continue;  // rounding of shear 1e6 times as stiff as bending
      Errors middle{fmt::format("deflection in the middle, {}, {}", name, shear), theory, 1e-6},
          end{fmt::format("deflection of the ends, {}, {}", name, shear), theory, 1e-6},
          moment{fmt::format("moment in the middle, {}, {}", name, shear), theory, 1e-6};
      for (const int n : code == kBeam2 ? std::vector{1000, 2000, 4000} : std::vector{16, 32, 64}) {
        BeamRow row(1, code, n, {0.0, 0.0}, {10.0, 0.0}, kSection, {1e9, 1000.0, GA});
        row.stand_on(1.0, 100.0, 2);
        row.deck.fix(1, 1, 0);
        row.deck.stage().load(row.node(n / 2), 0.0, -1.0);
        const auto [run, ends] = run_with_ends(record, row.deck);
        middle.add(10.0 / n, -run.u(row.node(n / 2)).y(), exact[0]);
        end.add(10.0 / n, -run.u(1).y(), exact[1]);
        moment.add(10.0 / n, ends[n].M, exact[2]);
      }
      middle.rows(record, Where::plane_strain);
      end.rows(record, Where::plane_strain);
      moment.rows(record, Where::plane_strain);
    }
  }
}

// The right half of a beam without end under a force of 1, and a beam from 0 to infinity under 1 at its end: 60 long, 24
// times 1/lambda.  Without shear the numbers, with GA = 2000 the differential equation.
void hetenyi_long(Record& record) {
  const double L = 60.0;
  using B = BeamOnSprings;
  for (const bool infinite : {true, false}) {
    const std::string kind = infinite ? "infinite" : "semi-infinite";
    BeamOnSprings thin(1000.0, 1e12, 100.0, L), exact(1000.0, 2000.0, 100.0, L);
    for (BeamOnSprings* beam : {&thin, &exact})
      beam->solve({infinite ? B::slope : B::moment, 0.0}, {B::shear, infinite ? 0.5 : 1.0}, {B::moment, 0.0},
                  {B::shear, 0.0});
    const auto against = [&](const std::string& what, double computed, double number) {
      record.near(Where::plane_strain, "differential equation against Hetenyi, " + what, computed, number,
                  1e-8);
    };
    if (infinite) {
      against("deflection under the force", -thin.at(0.0)[B::deflection], 0.00198817682192);
      against("moment under the force", thin.at(0.0)[B::moment], 0.628716714841);
      against("deflection at 2", -thin.at(2.0)[B::deflection], 0.00126930838812);
      against("moment at 2", thin.at(2.0)[B::moment], -0.00396288325415);
      against("shear force at 2", -thin.at(2.0)[B::shear], -0.158031297453);
    } else {
      against("deflection of the end", -thin.at(0.0)[B::deflection], 0.00795270728767);
    }
    Errors w{"deflection under the force, " + kind, 4.0, 1e-6}, away{"deflection at 2, " + kind, 4.0, 1e-6};
    for (const int n : {60, 120, 240}) {
      BeamRow row(1, kBeam3, n, {0.0, 0.0}, {L, 0.0}, kSection, {1e9, 1000.0, 2000.0});
      row.stand_on(1.0, 100.0, 2);
      row.deck.fix(1, 1, 0);
      if (infinite) row.deck.fixities.push_back(rotation_held(1));
      row.deck.stage().load(1, 0.0, infinite ? -0.5 : -1.0);
      const WholeRun run = record.run(row.deck);
      w.add(L / n, run.u(1).y(), exact.at(0.0)[B::deflection]);
      away.add(L / n, run.u(row.node(n / 30)).y(), exact.at(2.0)[B::deflection]);
    }
    w.rows(record, Where::plane_strain);
    away.rows(record, Where::plane_strain);
  }
  // Nearly without shear beam2, 40 long, 16 times 1/lambda; GA = 1e9 alone makes 3e-7 of the deflection.
  const double shorter = 40.0;
  BeamOnSprings exact(1000.0, 1e9, 100.0, shorter);
  exact.solve({B::slope, 0.0}, {B::shear, 0.5}, {B::moment, 0.0}, {B::shear, 0.0});
  Errors w{"deflection under the force, no shear, beam2", 2.0, 1e-6},
      moment{"moment under the force, no shear, beam2", 2.0, 1e-6};
  for (const int n : {1250, 2500, 5000}) {
    BeamRow row(1, kBeam2, n, {0.0, 0.0}, {shorter, 0.0}, kSection, {1e9, 1000.0, 1e9});
    row.stand_on(1.0, 100.0, 2);
    row.deck.fix(1, 1, 0);
    row.deck.fixities.push_back(rotation_held(1));
    row.deck.stage().load(1, 0.0, -0.5);
    const auto [run, ends] = run_with_ends(record, row.deck);
    w.add(shorter / n, run.u(1).y(), exact.at(0.0)[B::deflection]);
    moment.add(shorter / n, ends.front().M, exact.at(0.0)[B::moment]);
  }
  w.rows(record, Where::plane_strain);
  moment.rows(record, Where::plane_strain);
}

// B3: H = 6, EI = 1000, clamped at its foot, pressed by a triangle of 60 there; its top held, or on a spring of 50.
void propped(Record& record) {
  for (const int n : {1, 3, 6})
    for (const bool spring : {false, true}) {
      BeamRow row(1, kBeam2, n, {0.0, 0.0}, {0.0, 6.0}, kSection, {1e6, 1000.0, 1e12});
      row.clamp(1);
      if (spring) {
        row.deck.node(100, 1.0, 6.0);
        row.deck.fix(100, 1, 1);
        row.deck.material(2, kAxial, {50.0});
        row.deck.group(2, 33, 0, 2);
        row.deck.element(100, 2, {row.last(), 100});
      } else {
        row.deck.fix(row.last(), 1, 0);
      }
      StageCards& stage = row.deck.stage();
      for (int e = 0; e < n; ++e)  // to the right: edges push to the left
        stage.pressure(e + 1, 1, -60.0 * (1.0 - static_cast<double>(e) / n),
                       -60.0 * (1.0 - static_cast<double>(e + 1) / n));
      const WholeRun run = record.run(row.deck);
      const std::string name = fmt::format("{}, {} element(s)", spring ? "on a spring" : "propped", n);
      if (spring) {
        record.near(Where::plane_strain, "force of the spring, " + name, -run.stress[1](0, 0), 28.1739130435,
                    1e-10);
        record.near(Where::plane_strain, "displacement of the top, " + name, run.u(row.last()).x(),
                    0.56347826087, 1e-10);
        continue;
      }
      record.near(Where::plane_strain, "force of the prop, " + name, -run.reaction(row.last()).x(), 36.0,
                  1e-10);
      record.near(Where::plane_strain, "shear force at the foot, " + name, -run.reaction(1).x(), 144.0, 1e-10);
    }
}

// B5: two beams of height 1, E = 1e4, one on the other, simply supported over L = 20 under sin(pi x/L), joined by a shear
// stiffness of ks where they touch.  Stiff arms reach from their axes to the joint, since a beam is a line.
//
// Deflection W sin, rotation T cos, axial displacements -+U cos; slip = 2 U - h T.
double composite_theory(double ks, double GA) {
  const double beta = kPi / 20.0, E = 1e4, h = 1.0, EI = E * h * h * h / 12.0;
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d shear(beta, -1.0, 0.0), bending(0.0, beta, 0.0), axial(0.0, 0.0, beta),
      slip(0.0, -h, 2.0);
  K = 2.0 * (GA * shear * shear.transpose() + EI * bending * bending.transpose() +
             E * h * axial * axial.transpose()) +
      ks * slip * slip.transpose();
  return K.fullPivLu().solve(Eigen::Vector3d(1.0, 0.0, 0.0))[0];
}

double composite_deflection(const Record& record, double ks, int n) {
  const double L = 20.0, E = 1e4;
  DeckWriter deck(1);
  deck.material(1, kSection, {E, E / 12.0, 5e3});
  deck.material(2, kSection, {1e9, 1e9, 1e9});
  deck.material(3, kGoodman, {ks, 1e6, 1.0});
  deck.group(1, kBeam3, 0, 1);
  deck.group(2, kBeam2, 0, 2);
  deck.group(3, kInterface6, 2, 3);
  const int last = 2 * n,
            row = 1000;  // numbers of rows: axis and joint of the lower, joint and axis of the upper
  const double y[] = {-0.5, 0.0, 0.0, 0.5};
  std::vector<int> sides[4];
  int element = 1;
  for (int r = 0; r < 4; ++r)
    for (int i = 0; i <= last; ++i) {
      deck.node(row * r + i + 1, L * i / last, y[r]);
      sides[r].push_back(row * r + i + 1);
    }
  for (const int r : {0, 3})
    for (int e = 0; e < n; ++e) {
      const int at = row * r + 2 * e + 1;
      deck.element(element++, 1, {at, at + 2, at + 1});
    }
  for (const int r : {0, 2})
    for (int i = 1; i <= last + 1; ++i) deck.element(element++, 2, {row * r + i, row * (r + 1) + i});
  join(deck, element, 3, sides[1], sides[2], 2);
  for (const int r : {0, 3}) {  // both: else the upper one's reaction would go through the joint
    deck.fix(row * r + 1, 0, 1);
    deck.fix(row * r + last + 1, 0, 1);
  }
  deck.fix(n + 1, 1, 0);
  deck.fix(3 * row + n + 1, 1, 0);
  StageCards& stage = deck.stage();
  Model model = record.bench().build(deck.text());
  // The load, shared by both, as consistent forces of the quadratic line.
  std::vector<double> force(static_cast<std::size_t>(last + 1), 0.0);
  const double h = L / n;
  for (int e = 0; e < n; ++e)
    for (const auto& [xi, w] : GaussLine<3>::table) {
      const double q = std::sin(kPi * (e + 0.5 * (1.0 + xi)) / n) * w * 0.5 * h;
      const auto at = static_cast<std::size_t>(2 * e);
      force[at] += q * 0.5 * xi * (xi - 1.0);
      force[at + 1] += q * (1.0 - xi * xi);
      force[at + 2] += q * 0.5 * xi * (xi + 1.0);
    }
  (void)stage;
  for (int r : {0, 3})
    for (int i = 0; i <= last; ++i)
      for (int node = 0; node < model.mesh.nodes(); ++node)
        if (model.mesh.number[node] == row * r + i + 1)
          model.stages[0].loads.push_back({node, {0.0, -0.5 * force[i]}, 0});
  const WholeRun run = record.run(std::move(model));
  return -run.u(n + 1).y();
}

void composite(Record& record) {
  for (const auto& [ks, exact] :
       {std::pair{1e-6, 0.98553429645}, {1.0, 0.96232159635}, {100.0, 0.42061796984}, {1e6, 0.24640637068}}) {
    record.near(Where::plane_strain, fmt::format("energy's minimum against the numbers, ks = {:g}", ks),
                composite_theory(ks, 1e8), exact, 1e-6);
    Errors w{fmt::format("deflection in the middle, GA = 5000, ks = {:g}", ks), 4.0, 1e-6};
    for (const int n : {8, 16, 32})
      w.add(20.0 / n, composite_deflection(record, ks, n), composite_theory(ks, 5e3));
    w.rows(record, Where::plane_strain);
  }
}

// B7: a ring in ground under 100 and 50, E = 1e4, nu = .3; its numbers are thrust at crown and springline, moment at the
// crown.
struct RingNumbers {
  double EA, EI;
  bool excavation, bonded;
  double crown, springline, moment;
};
const RingNumbers kRings[] = {
    {1e6, 1e4, false, true, -66.1894553876, -142.207491177, 17.928350007},
    {1e6, 1e4, false, false, -83.9462477632, -124.450698802, 20.2522255193},
    {1e6, 1e4, true, true, -49.9931122693, -98.8618495627, 11.5253678617},
    {1e6, 1e4, true, false, -61.4081930822, -87.4467687499, 13.0192878338},
    {2e5, 20.0, false, true, -72.1849990924, -130.03722313, 0.44600967911},
    {2e5, 20.0, false, false, -100.578407396, -101.643814826, 0.532703715267},
};

RunWithEnds run_ring(const Record& record, const RingDeck& ring) {
  Model model = record.bench().build(ring.deck().text());
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const Vector2 at = model.mesh.x.col(node);
    if (at.norm() < ring.outer * (1.0 - 1e-9)) continue;
    Fixity fixity;
    fixity.node = node;
    fixity.code = {FixityCode::fixed, FixityCode::fixed};
    const Vector2 u = ring.exact.ground_displacement(at);
    fixity.value = {std::abs(at.x()) < 1e-9 ? 0.0 : u.x(), std::abs(at.y()) < 1e-9 ? 0.0 : u.y()};
    model.stages.back().fixities.push_back(fixity);
  }
  return run_with_ends(record, std::move(model), 1);
}

// NOLINTNEXTLINE(readability-function-size): one table of numbers after the other
void ring(Record& record) {
  for (const RingNumbers& r : kRings) {
    RingDeck scene;
    RingInGround& exact = scene.exact;
    exact.E = 1e4;
    exact.EA = r.EA;
    exact.EI = r.EI;
    exact.sv = 100.0;
    exact.K0 = 0.5;
    exact.excavation = r.excavation;
    if (!r.bonded) exact.ks = 0.0;
    exact.of_curvature = true;
    exact.solve();
    const std::string name =
        fmt::format("{}, {}, {}", r.EA > 5e5 ? "stiff" : "flexible",
                    r.excavation ? "excavation" : "overpressure", r.bonded ? "bonded" : "slipping");
    record.near(Where::plane_strain, "closed form against the numbers: crown, " + name,
                exact.axial_force(0.5 * kPi), r.crown, 1e-7);
    record.near(Where::plane_strain, "closed form against the numbers: springline, " + name,
                exact.axial_force(0.0), r.springline, 1e-7);
    record.near(Where::plane_strain, "closed form against the numbers: moment, " + name,
                exact.moment(0.5 * kPi), r.moment, 1e-7);
    exact.of_curvature = false;
    exact.solve();
    const double rounding = r.bonded ? 0.0 : 5e-7;  // springs of 1e6 across and 1e-3 along: nine digits apart
    const double between = std::max(std::abs(r.crown), std::abs(r.springline)) * r.EI / r.EA;  // N EI/(EA a)
    record.within(Where::plane_strain, "moment from theta' and from curvature, " + name,
                  exact.moment(0.5 * kPi), r.moment, between);
    if (!r.bonded) {
      scene.joined = true;
      exact.ks = 1e-3;
      exact.kn = 1e6;
      exact.solve();
    }
    Errors down{"displacement of the crown, " + name, 4.0, 1e-6, rounding},
        out{"displacement of the springline, " + name, 4.0, 1e-6, rounding};
    Errors thrust{"thrust at nodes, " + name, 4.0, 1e-6, rounding},
        moment{"moment at nodes, " + name, 4.0, 1e-6, rounding};
    Errors thrust_inside{"thrust at all points, " + name, 3.0, 1e-6, rounding},
        moment_inside{"moment at all points, " + name, 3.0, 1e-6, rounding};
    for (const int n : {15, 30, 60}) {
      scene.around = n;
      scene.out = 2 * n / 3;
      const auto [run, ends] = run_ring(record, scene);
      const std::vector<int> nodes = scene.ring();
      down.add(1.0 / n, run.u(nodes.front()).y(), exact.ring_displacement(0.5 * kPi).y());
      out.add(1.0 / n, run.u(nodes.back()).x(), exact.ring_displacement(0.0).x());
      double N = 0.0, M = 0.0;  // largest errors
      const auto see = [&](const Vector2& at, double thrust_there, double moment_there) {
        const double angle = std::atan2(at.y(), at.x());
        N = std::max(N, std::abs(thrust_there - exact.axial_force(angle)));
        M = std::max(M, std::abs(moment_there - exact.moment(angle)));
      };
      const auto add = [&](Errors& of_thrust, Errors& of_moment) {
        of_thrust.add(1.0 / n, 1.0 + std::exchange(N, 0.0) / std::abs(exact.axial_force(0.0)), 1.0);
        of_moment.add(1.0 / n, 1.0 + std::exchange(M, 0.0) / exact.moment(0.5 * kPi), 1.0);
      };
      // Ground pulls along the ring between nodes; its share of a node stands between the ends that meet there.
      for (std::size_t i = 1; i + 1 < ends.size(); i += 2) {
        const Vector2& at = ends[i].place;
        const Vector2 along = Vector2(at.y(), -at.x()).normalized();  // down from the crown
        see(at, 0.5 * (ends[i].N(along) + ends[i + 1].N(along)), 0.5 * (ends[i].M + ends[i + 1].M));
      }
      see(ends.front().place, ends.front().N(Vector2::UnitX()), ends.front().M);
      see(ends.back().place, ends.back().N(-Vector2::UnitY()), ends.back().M);
      add(thrust, moment);
      for (Eigen::Index p = 0; p < run.stress[1].cols(); ++p)
        see(point_position(*run.model, 1, p), run.stress[1](scenes::kAxialForce, p),
            run.stress[1](scenes::kMoment, p));
      add(thrust_inside, moment_inside);
    }
    down.rows(record, Where::plane_strain);
    out.rows(record, Where::plane_strain);
    for (const Errors* errors : {&thrust, &moment, &thrust_inside, &moment_inside})
      errors->rows(record, Where::plane_strain);
  }
}

double plate_deflection(const Record& record, int code, int n, bool clamped) {
  BeamRow row(2, code, n, {0.0, 0.0}, {1.0, 0.0}, kPlate, {1000.0, 0.3, 0.1});
  row.deck.fix(row.last(), 1, 1);
  if (clamped) row.deck.fixities.push_back(rotation_held(row.last()));
  StageCards& stage = row.deck.stage();
  for (int e = 1; e <= n; ++e) stage.pressure(e, 1, -1.0, -1.0);
  return -record.run(row.deck).u(1).y();
}

void plates(Record& record) {
  for (const auto& [code, name, theory] : {std::tuple{kBeam2, "beam2", 2.0}, {kBeam3, "beam3", 4.0}})
    for (const auto& [clamped, exact] : {std::pair{true, 0.178425}, {false, 0.703425}}) {
      Errors w{fmt::format("{}, {}", clamped ? "clamped" : "simply supported", name), theory, 1e-6};
      for (const int n : code == kBeam2 ? std::vector{50, 100, 200} : std::vector{8, 16, 32})
        w.add(1.0 / n, plate_deflection(record, code, n, clamped), exact);
      w.rows(record, Where::axisymmetric, 0.25);
    }
}

// B6: a = 5, H = 6, t = .25, E = 2e7, nu = .2, weight of the water 10; base clamped, top free.  The numbers are those of
// a wall that does not shear: the differential equation takes over from there.
BeamOnSprings tank_theory(double shear_share, double H) {
  const double E = 2e7, nu = 0.2, t = 0.25, a = 5.0;
  return {E * t * t * t / (12.0 * (1.0 - nu * nu)), shear_share * E * t / (2.0 * (1.0 + nu)), E * t / (a * a),
          H};
}

void tank(Record& record) {
  const double H = 6.0, numbers[] = {1.39410377647e-4, 2.01960761189e-4, 1.61248811436e-4, -7.27454025e-7};
  const int places[] = {1, 2, 3, 6};
  using B = BeamOnSprings;
  // w is to the left of the way up: inwards.
  BeamOnSprings thin = tank_theory(1e12, H), thick = tank_theory(5.0 / 6.0, H);
  for (BeamOnSprings* wall : {&thin, &thick}) {
    wall->q0 = -10.0 * H;
    wall->q1 = 10.0;
    wall->solve({B::deflection, 0.0}, {B::slope, 0.0}, {B::moment, 0.0}, {B::shear, 0.0});
  }
  for (int i = 0; i < 4; ++i)
    record.near(Where::axisymmetric, fmt::format("differential equation against the numbers at {}", places[i]),
                -thin.at(places[i])[B::deflection], numbers[i], i == 3 ? 1e-7 : 1e-8);
  record.near(Where::axisymmetric, "differential equation against the numbers, moment",
              std::abs(thin.at(0.0)[B::moment]), 18.9362636344, 1e-9);
  record.near(Where::axisymmetric, "differential equation against the numbers, shear force",
              std::abs(thin.at(0.0)[B::shear]), 47.8112434912, 1e-9);
  for (const auto& [code, name, theory] : {std::tuple{kBeam2, "beam2", 2.0}, {kBeam3, "beam3", 4.0}})
    for (const bool shears : {false, true}) {
      const std::string kind = fmt::format("{}, {}", name, shears ? "with shear" : "without shear");
      std::vector<Errors> w;
      for (int i = 0; i < 4; ++i)
        w.push_back({fmt::format("radial displacement at {} over 2e-4, {}", places[i], kind), theory, 1e-6});
      Errors moment{"moment at the base, " + kind, theory, 1e-6},
          shear{"shear force at the base, " + kind, theory, 1e-6};
      const BeamOnSprings& exact = shears ? thick : tank_theory(1e6, H);
      BeamOnSprings used = exact;
      used.q0 = -10.0 * H;
      used.q1 = 10.0;
      used.solve({B::deflection, 0.0}, {B::slope, 0.0}, {B::moment, 0.0}, {B::shear, 0.0});
      for (const int n : code == kBeam2 ? std::vector{192, 384, 768} : std::vector{24, 48, 96}) {
        std::vector<double> section{2e7, 0.2, 0.25, 1.0};
        if (!shears) section.push_back(1e6);
        BeamRow row(2, code, n, {5.0, 0.0}, {5.0, H}, kPlate, section);
        row.clamp(1);
        StageCards& stage = row.deck.stage();
        for (int e = 0; e < n; ++e)
          stage.pressure(e + 1, 1, -10.0 * (H - H * e / n), -10.0 * (H - H * (e + 1) / n));
        const auto [run, ends] = run_with_ends(record, row.deck);
        for (std::size_t i = 0; i < 4; ++i)
          w[i].add(H / n,
                   1.0 + (run.u(row.node(n * places[i] / 6)).x() + used.at(places[i])[B::deflection]) / 2e-4,
                   1.0);
        moment.add(H / n, ends.front().M, used.at(0.0)[B::moment]);
        shear.add(H / n, ends.front().Q(Vector2::UnitY()), used.at(0.0)[B::shear]);
      }
      for (const Errors& e : w) e.rows(record, Where::axisymmetric);
      moment.rows(record, Where::axisymmetric);
      if (shears || code == kBeam2)
        shear.rows(record, Where::axisymmetric);
      else  // rounding on all meshes
        record.small(Where::axisymmetric, shear.what, shear.error.back(), 1e-9);
    }
}

// The same wall, 20 high, under a force or a moment of 1 around its lower edge.
void edge_loads(Record& record) {
  const double H = 20.0, around = 10.0, share_of_one = around / (2.0 * kPi * 5.0);
  using B = BeamOnSprings;
  const double numbers[] = {1.1651802521e-5, 1.35764501988e-5};
  for (const bool moment : {false, true}) {
    BeamOnSprings thin = tank_theory(1e12, H);
    thin.solve({B::moment, moment ? -1.0 : 0.0}, {B::shear, moment ? 0.0 : 1.0}, {B::moment, 0.0},
               {B::shear, 0.0});
    record.near(Where::axisymmetric, moment ? "Hetenyi, moment" : "Hetenyi, force",
                std::abs(thin.at(0.0)[B::deflection]), numbers[moment ? 1 : 0], 1e-8);
    if (moment)
      record.near(Where::axisymmetric, "Hetenyi, slope under the moment", std::abs(thin.at(0.0)[B::slope]),
                  3.16380233304e-5, 1e-8);
    for (const double share : {1e6, 5.0 / 6.0}) {
      BeamOnSprings exact = tank_theory(share, H);
      exact.solve({B::moment, moment ? -1.0 : 0.0}, {B::shear, moment ? 0.0 : 1.0}, {B::moment, 0.0},
                  {B::shear, 0.0});
      Errors edge{fmt::format("displacement under the {}, {}", moment ? "moment" : "force",
                              share > 1.0 ? "without shear" : "with shear"),
                  4.0, 1e-6};
      const std::string loaded = edge.what;
      edge.what += ", 1 from the edge";
      double at_edge = 0.0;
      for (const int n : {80, 160, 320}) {
        BeamRow row(2, kBeam3, n, {5.0, 0.0}, {5.0, H}, kPlate, {2e7, 0.2, 0.25, 1.0, share});
        row.deck.fix(1, 0, 1);
        StageCards& stage = row.deck.stage();
        if (moment)
          stage.loads.push_back(fmt::format("{:5}{:5}{:5}{}{:10}rotation", 1, 0, 0, ten_columns(around), ""));
        else
          stage.load(1, around, 0.0);
        const WholeRun run = record.run(row.deck);
        edge.add(H / n, -run.u(row.node(n / 20)).x() / share_of_one, exact.at(1.0)[B::deflection]);
        at_edge = -run.u(1).x() / share_of_one;
      }
      // Two Gauss points conserve quadratic first integrals: a long wall's edge is exact.
      record.near(Where::axisymmetric, loaded, at_edge, exact.at(0.0)[B::deflection], 1e-9);
      edge.rows(record, Where::axisymmetric);
    }
  }
}

// A meridian of a sphere, a = 1, from the equator (node 1) up to an angle in degrees, under a pressure of 1 inside; plate:
// E, nu, t.
DeckWriter sphere_deck(int code, int n, double angle, const std::vector<double>& plate) {
  DeckWriter deck(2);
  const int order = code == kBeam2 ? 1 : 2, last = order * n + 1;
  for (int i = 0; i < last; ++i) deck.node(i + 1, 1.0, angle * i / (last - 1), true);
  deck.material(1, kPlate, plate);
  deck.group(1, code, 0, 1);
  StageCards& stage = deck.stage();
  for (int e = 0; e < n; ++e) {
    std::vector<int> nodes{order * e + 1, order * (e + 1) + 1};
    if (order == 2) nodes.push_back(2 * e + 2);
    deck.element(e + 1, 1, nodes);
    stage.pressure(e + 1, 1, -1.0, -1.0);
  }
  deck.fixities.push_back(rotation_held(1));
  return deck;
}

// t = .1, E = 1000, nu = .3: membrane alone.
void spherical_shell(Record& record) {
  for (const auto& [code, name, theory] : {std::tuple{kBeam2, "beam2", 2.0}, {kBeam3, "beam3", 4.0}}) {
    Errors w{fmt::format("radial displacement of the equator, {}", name), theory, 1e-6};
    for (const int n : code == kBeam2 ? std::vector{250, 500, 1000} : std::vector{16, 32, 64}) {
      DeckWriter deck = sphere_deck(code, n, 90.0, {1000.0, 0.3, 0.1});
      deck.fix(1, 0, 1);
      deck.fix(static_cast<int>(deck.nodes.size()), 1, 0);
      w.add(1.0 / n, record.run(deck).u(1).x(), 0.0035);
    }
    w.rows(record, Where::axisymmetric);
  }
}

// Bending at the edges of a sphere under a pressure of 1: clamped at the equator, a round opening 60 degrees above it.
void sphere_edge(Record& record) {
  ClampedSphere exact, finer;
  finer.degree = 80;
  exact.solve();
  finer.solve();
  record.near(Where::axisymmetric, "collocation of degree 60 against 80, moment at the clamp", exact.at(0.0).M,
              finer.at(0.0).M, 1e-9);
  record.near(Where::axisymmetric, "collocation of degree 60 against 80, displacement of the opening",
              exact.at(60.0).u, finer.at(60.0).u, 1e-9);
  // Geckeler's edge of a thin shell that would move by w = (p a - (1 + nu) N) a/(E t): M = E t w/(2 lambda^2), Q = E t w/
  // (a lambda).  N is half of p a less what is missing above the opening; his error is of order 1/lambda^2.
  ClampedSphere thin;
  thin.t = 0.01;
  thin.shear_share = 1e6;
  thin.degree = 90;
  thin.solve();
  const double lambda = std::pow(3.0 * (1.0 - 0.09), 0.25) / std::sqrt(thin.t), cut = std::cos(kPi / 3.0);
  const double free = 1.0 - 1.3 * 0.5 * (1.0 - cut * cut);
  record.near(Where::axisymmetric, "collocation against Geckeler, t/a = 1/100, moment at the clamp",
              std::abs(thin.at(0.0).M), free / (2.0 * lambda * lambda), 1.0 / (lambda * lambda));
  record.near(Where::axisymmetric, "collocation against Geckeler, t/a = 1/100, shear force at the clamp",
              std::abs(thin.at(0.0).Q), free / lambda, 1.0 / (lambda * lambda));
  for (const auto& [code, name, theory] : {std::tuple{kBeam2, "beam2", 2.0}, {kBeam3, "beam3", 4.0}}) {
    const auto errors = [&, of = std::string(name), rate = theory](const std::string& what) {
      return Errors{what + ", " + of, rate, 1e-6};
    };
    Errors near = errors("radial displacement 10 degrees above the clamp"),
           opening = errors("radial displacement of the opening"), moment = errors("moment at the clamp"),
           shear = errors("shear force at the clamp");
    double thrust = 0.0;
    for (const int n : code == kBeam2 ? std::vector{600, 1200, 2400} : std::vector{24, 48, 96}) {
      DeckWriter deck = sphere_deck(code, n, exact.opening, {exact.E, exact.nu, exact.t});
      deck.fix(1, 1, 1);
      const int last = static_cast<int>(deck.nodes.size());
      const auto [run, ends] = run_with_ends(record, deck);
      near.add(1.0 / n, run.u((last - 1) / 6 + 1).x(), exact.at(10.0).u);
      opening.add(1.0 / n, run.u(last).x(), exact.at(60.0).u);
      moment.add(1.0 / n, ends.front().M, exact.at(0.0).M);
      shear.add(1.0 / n, ends.front().Q(Vector2::UnitY()), exact.at(0.0).Q);
      thrust = ends.front().N(Vector2::UnitY());
    }
    for (const Errors* one : {&near, &opening, &moment, &shear}) one->rows(record, Where::axisymmetric);
    // Statics alone: the pressure on the ring seen from above.
    record.near(Where::axisymmetric, fmt::format("meridian's force at the clamp, {}", name), thrust,
                0.5 * (1.0 - cut * cut), 1e-10);
  }
}

// M_p = 10 and N_p of a section with EA = 1e6 and EI = 1e3; 0: no limit.
constexpr double kMp = 10.0, kStrong = 100.0;
std::vector<double> yielding(double axial_strength = 0.0) {
  return {1e6, 1e3, axial_strength, kMp, 1e9};
}

// The largest |M| at ends and middles of elements, and within them, where a parabola goes through the three.
struct LargestMoment {
  double at_points = 0.0, within = 0.0;

  explicit LargestMoment(const PointStresses& stress) {
    for (Eigen::Index e = 0; e + 2 < stress.cols(); e += 3) {
      const double a = stress(kMoment, e), b = stress(kMoment, e + 1), c = stress(kMoment, e + 2);
      const double bend = a - 2.0 * b + c, slope = 0.5 * (c - a), xi = bend != 0.0 ? -slope / bend : 2.0;
      at_points = std::max({at_points, std::abs(a), std::abs(b), std::abs(c)});
      if (std::abs(xi) <= 1.0) within = std::max(within, std::abs(b + 0.5 * slope * xi));
    }
    within = std::max(within, at_points);
  }
};

// A node is pushed until a mechanism forms, in one direction; what that takes.
double collapse_force(Record& record, DeckWriter deck, int node, int component, double by,
                      const std::string& what, double exact, std::size_t groups = 1) {
  StageCards& stage = deck.stage(12);
  stage.fix(node, component == 0 ? 1 : 0, component, component == 0 ? by : 0.0, component == 1 ? by : 0.0);
  const WholeRun run = record.run(deck);
  const double force = run.reaction(node)[component];
  record.near(Where::plane_strain, what, force, exact, 1e-9);
  for (std::size_t g = 0; g < groups; ++g)
    record.near(Where::plane_strain, "largest moment, " + what,
                std::max(LargestMoment(run.stress[g]).within, kMp), kMp, 1e-11);
  return force;
}

// Frames that collapse by hinges of plasticity where forces act: two elements a member.
void plastic_frames(Record& record) {
  const double L = 4.0;
  for (const int code : {kBeam2, kBeam3}) {
    const std::string name = code == kBeam2 ? ", beam2" : ", beam3";
    BeamRow cantilever(1, code, 2, {0.0, 0.0}, {0.8 * L, 0.6 * L}, kSectionPlastic, yielding());
    cantilever.clamp(1);
    collapse_force(record, cantilever.deck, cantilever.last(), 1, 3.0, "cantilever, force at its tip" + name,
                   kMp / (0.8 * L));
    BeamRow propped(1, code, 2, {0.0, 0.0}, {L, 0.0}, kSectionPlastic, yielding());
    propped.clamp(1);
    propped.deck.fix(propped.last(), 0, 1);
    collapse_force(record, propped.deck, propped.node(1), 1, -1.0,
                   "propped cantilever, force in the middle" + name, -6.0 * kMp / L);
    for (const double N : {-0.8, -0.5, 0.5, 0.8}) {
      BeamRow row(1, code, 2, {0.0, 0.0}, {L, 0.0}, kSectionPlastic, yielding(kStrong));
      row.clamp(1);
      row.deck.stage().load(row.last(), N * kStrong, 0.0);
      StageCards& stage = row.deck.stage(12);
      stage.fix(row.last(), 0, 1, 0.0, 1.0);
      const WholeRun run = record.run(row.deck);
      record.near(Where::plane_strain, fmt::format("moment of a cantilever under N = {} N_p{}", N, name),
                  run.reaction(row.last()).y() * L, (1.0 - N * N) * kMp, 1e-9);
    }
  }
  // Columns 3 high, a beam of 4, feet clamped: sway, then with a load of 15 in the middle of the beam.
  for (const double load : {0.0, 15.0}) {
    BeamRow row(1, kBeam2, 6, {0.0, 0.0}, {1.0, 0.0}, kSectionPlastic, yielding());
    row.deck.nodes.clear();
    const Vector2 at[] = {{0.0, 0.0}, {0.0, 1.5}, {0.0, 3.0}, {2.0, 3.0}, {4.0, 3.0}, {4.0, 1.5}, {4.0, 0.0}};
    for (int i = 0; i < 7; ++i) row.deck.node(i + 1, at[i].x(), at[i].y());
    row.clamp(1);
    row.clamp(7);
    row.deck.stage().load(4, 0.0, -load);
    collapse_force(record, row.deck, 3, 0, 1.0,
                   load == 0.0 ? "portal that sways" : "portal that sways, loaded beam",
                   load == 0.0 ? 4.0 * kMp / 3.0 : (6.0 * kMp - 2.0 * load) / 3.0);
  }
}

// An even load moves the hinge within a member to 0.586 of its length from the clamp: q = 11.657 M_p/L^2.  A triangle of
// water, largest at the clamp, makes q L^2/6 there, also where elements take an uneven part of it.
void plastic_loads(Record& record) {
  const double L = 4.0;
  BeamRow propped(1, kBeam2, 8, {0.0, 0.0}, {L, 0.0}, kSectionPlastic, yielding());
  propped.clamp(1);
  propped.deck.fix(propped.last(), 0, 1);
  StageCards& stage = propped.deck.stage(16);
  const double q = 12.0 * kMp / (L * L);
  for (int e = 0; e < 8; ++e) stage.pressure(e + 1, 1, -q, -q);
  const WholeRun run = record.try_run(propped.deck);
  record.near(Where::plane_strain, "propped cantilever under an even load, q L^2/M_p, 8 elements",
              printed_bracket(run).from * 12.0, 6.0 + 4.0 * std::sqrt(2.0), 1e-2);
  const LargestMoment largest(run.stress[0]);
  record.near(Where::plane_strain, "largest moment at ends and middles", largest.at_points, kMp, 1e-9);
  record.near(Where::plane_strain, "largest moment within elements", largest.within, kMp, 1e-2);
  for (const int n : {1, 2}) {
    BeamRow row(1, kBeam2, n, {0.0, 0.0}, {L, 0.0}, kSectionPlastic, yielding());
    row.clamp(1);
    StageCards& loads = row.deck.stage(8);
    const double all = 1.25 * 6.0 * kMp / (L * L);
    for (int e = 0; e < n; ++e) loads.pressure(e + 1, 1, all * (n - e) / n, all * (n - e - 1) / n);
    const WholeRun fails = record.try_run(row.deck);
    record.near(Where::plane_strain,
                fmt::format("cantilever under a triangle of load, share of q L^2/6, {} element(s)", n),
                printed_bracket(fails).from * 1.25, 1.0, 2e-3);
    record.near(Where::plane_strain, "moment at its clamp", std::abs(fails.stress[0](kMoment, 0)), kMp, 2e-3);
  }
}

}  // namespace

Section structure_cases() {
  const std::string by_hand = "Timoshenko 1921", order = "order of convergence";
  return {"Beams and shells",
          {{"structures.cantilever", "cantilever of plates and of strips, one element as eight", by_hand,
            Grade::exact, "rounding times the condition number", cantilever},
           {"structures.slender", "cantilever of L/h = 1e4: no locking", by_hand, Grade::exact,
            "rounding times the condition number, 1e10", slender},
           {"structures.plastic_frames", "collapse of cantilevers and a portal; axial force and moment",
            "theorems of plastic collapse; |M|/M_p + (N/N_p)^2 = 1", Grade::exact,
            "exact: yield at the elements' ends, where moments are", plastic_frames},
           {"structures.plastic_loads", "collapse under loads along the elements",
            "theorems of plastic collapse: q = (6 + 4 sqrt 2) M_p/L^2", Grade::exact,
            "the hinge within a member stands at the nearest end or middle of an element", plastic_loads},
           {"structures.propped_wall", "wall under a triangle of pressure, propped, its prop rigid or a spring",
            "force method", Grade::exact, "exact at nodes: rounding", propped},
           {"structures.hetenyi", "beam with free ends on springs (interface elements)", "Hetenyi 1946",
            Grade::exact, order, hetenyi},
           {"structures.hetenyi_long", "infinite and semi-infinite beam on springs, with and without shear",
            "Hetenyi 1946; roots of the differential equation", Grade::exact, order, hetenyi_long},
           {"structures.composite", "two beams one on the other that slip along an elastic joint",
            "Newmark 1951", Grade::exact, order, composite},
           {"structures.ring", "ring in infinite ground, bonded and slipping, overpressure and excavation",
            "Michell's solution, modes 0 and 2 (Burns and Richard 1964; Einstein and Schwartz 1979)",
            Grade::exact, order, ring},
           {"structures.plates", "circular plates under pressure, from the axis on, with shear",
            "Timoshenko and Woinowsky-Krieger 1959", Grade::exact, order, plates},
           {"structures.tank", "wall of a cylindrical tank, base clamped, top free",
            "Timoshenko and Woinowsky-Krieger 1959, in 30 digits; with shear the differential equation",
            Grade::exact, order, tank},
           {"structures.edge_loads", "cylinder under a force or a moment around its edge",
            "Timoshenko and Woinowsky-Krieger 1959; with shear the differential equation", Grade::exact, order,
            edge_loads},
           {"structures.sphere", "sphere under pressure inside", "membrane theory", Grade::exact, order,
            spherical_shell},
           {"structures.sphere_edge", "sphere clamped at its equator, with an opening: bending at its edges",
            "equations of the shell by Chebyshev collocation, against Geckeler 1926", Grade::computed, order,
            sphere_edge}}};
}

}  // namespace sage::verify
