// Plasticity around cylinders and spheres: triaxial specimen, thick cylinder with its plastic front, cavities
// in an infinite medium.  Pressures compression positive.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

int radial_dof(const WholeRun& run, int number) {
  return DofMap::displacement(run.index(number));
}

const char* law_name(int code) {
  return code == 4 ? "Mohr-Coulomb" : "Drucker-Prager";
}

// E, nu, c, phi, no volume change.  Drucker-Prager: which cone.
std::vector<double> strength(int code, double E, double nu, double c, double phi, double cone = 1.0) {
  std::vector<double> p{E, nu, c, phi, 0.0};
  if (code == 3) p.insert(p.end(), {cone, 1.0});
  return p;
}

// sigma3 = 50, sin phi = 3/5, c = 0: q_f = 150 from 5 % on, then no volume change.
void specimen(Record& record) {
  const double nu = 0.3, phi = std::asin(0.6) / kRadiansPerDegree;
  for (int code : {3, 4})
    for (Cell cell : {Cell::quad4, Cell::quad8, Cell::tri6}) {
      const bool triangle = cell == Cell::tri6;
      const char* cell_name = cell == Cell::quad4 ? "quad4 b-bar" : triangle ? "tri6" : "quad8";
      Block block;
      block.cell = cell;
      block.columns = block.rows = 2;
      block.place = rectangle(0.0, 1.0, 0.0, 2.0);
      DeckWriter deck(2);
      block.write_nodes(deck);
      deck.material(1, code, strength(code, 3000.0, nu, 0.0, phi));
      deck.group(1, static_cast<int>(cell), 0, 1);
      block.write_elements(deck, 1);
      for (int n : block.bottom()) deck.fix(n, 0, 1);
      for (int n : block.left()) deck.fix(n, 1, 0);
      deck.initial(1, 0, 50.0, 50.0, 50.0, 0.0);
      for (double strain : {0.04, 0.06}) {
        StageCards& stage = deck.stage(2);
        for (int n : block.top()) stage.fix(n, 0, 1, 0.0, -2.0 * strain);
        if (deck.stages.size() == 1)
          for (int j = 0; j < 2; ++j)
            stage.pressure(block.element(1, j) + (triangle ? 1 : 0), triangle ? 3 : 2, 50.0, 50.0);
      }
      const WholeRun run = record.run(deck);
      const std::string name = fmt::format("{}, {}", law_name(code), cell_name);
      const auto deviator = [&](const Snapshot& s) { return -run.reaction(s, block.top(), 1) / kPi - 50.0; };
      record.near(Where::axisymmetric, name + ": deviator at 4 %", deviator(run.increments[1]), 120.0, 1e-7);
      record.near(Where::axisymmetric, name + ": deviator at 10 %", deviator(run.last()), 150.0, 1e-7);
      record.near(Where::axisymmetric, name + ": u_r at 10 %", run.u(block.node(block.across() - 1, 0)).x(),
                  nu * 0.05 + 0.5 * 0.05, 1e-6);
    }
}

// Ring a = 1, b = 2 with u_z = 0, pushed from inside: a strip in axisymmetry or a sector in plane strain.
struct PushedRing {
  bool sector = false;
  int code = 4;
  Cell cell = Cell::quad8;
  int formulation = 1;
  static constexpr double k = 1.0, G = 100.0, nu = 0.4999;
  Block block;

  DeckWriter start() {
    block.cell = cell;
    block.columns = 10;
    block.rows = sector ? 6 : 1;
    block.polar = sector;
    block.place = sector ? rectangle(1.0, 2.0, 0.0, 90.0) : rectangle(1.0, 2.0, 0.0, 0.1);
    DeckWriter deck(sector ? 1 : 2);
    block.write_nodes(deck);
    deck.material(1, code, strength(code, 2 * G * (1 + nu), nu, k, 0.0, 4.0));
    deck.group(1, static_cast<int>(cell), formulation, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.top()) deck.fix(n, sector ? 1 : 0, sector ? 0 : 1);
    return deck;
  }
  // The inner face moves out by `u` in all.
  void push(DeckWriter& deck, double u, int increments) const {
    StageCards& stage = deck.stage(increments);
    for (int n : block.left()) {
      const Vector2 x = block.at(0, (n - 1) / block.across());
      const double angle = sector ? x.y() * kRadiansPerDegree : 0.0;
      stage.fix(n, 1, sector ? 1 : 0, u * std::cos(angle), sector ? u * std::sin(angle) : 0.0);
    }
  }
  // Mean pressure on the inner face: work of the reactions through a unit radial displacement, over the area.
  double pressure(const WholeRun& run, const Snapshot& at) const {
    double sum = 0.0;
    for (int n : block.left()) {
      const Vector2 x = run.position(n);
      sum += run.reaction(at, n).dot(sector ? Vector2(x.normalized()) : Vector2(1.0, 0.0));
    }
    return sum / (sector ? kPi / 2 : 2 * kPi * 0.1);
  }
};

// Difference of hoop and radial stress, and the radius, of a point.
double stress_difference(const WholeRun& run, bool sector, Eigen::Index point, double& r) {
  const Vector4 s = run.stress[0].col(point);
  const Vector2 x = point_position(*run.model, 0, point);
  if (!sector) {
    r = x.x();
    return s[2] - s[0];
  }
  r = x.norm();
  const Vector2 n = x / r;
  const double radial = s[0] * n.x() * n.x() + s[1] * n.y() * n.y() + 2 * s[3] * n.x() * n.y();
  return s[0] + s[1] - 2 * radial;
}

// Tresca, nu = 1/2: plastic to radius c at p = k (2 ln(c/a) + 1 - c^2/b^2), u_a = k c^2/(2 G a); collapse at 2
// k ln(b/a). Outside the front the stress difference is 2 k c^2/r^2, which measures c.
void thick_cylinder(Record& record) {
  for (bool sector : {true, false})
    for (int code : {4, 3}) {
      const Where where = sector ? Where::plane_strain : Where::axisymmetric;
      PushedRing ring;
      ring.sector = sector;
      ring.code = code;
      for (double c : {1.2, 1.5, 1.8}) {
        DeckWriter deck = ring.start();
        ring.push(deck, c * c / (2 * PushedRing::G), 10);
        const WholeRun run = record.run(deck);
        record.near(where, fmt::format("{}: p/k with the front at {:g} a", law_name(code), c),
                    ring.pressure(run, run.last()), 2 * std::log(c) + 1 - c * c / 4, 5e-3);
        double front = 0.0, outermost = 0.0;
        for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p) {
          double r = 0.0;
          const double difference = stress_difference(run, sector, p, r);
          if (r > outermost) {
            outermost = r;
            front = r * std::sqrt(difference / (2 * PushedRing::k));
          }
        }
        record.near(where, fmt::format("{}: front, from the stress at the rim, {:g} a", law_name(code), c),
                    front, c, 5e-3);
      }
      DeckWriter deck = ring.start();
      ring.push(deck, 0.2, 20);
      const WholeRun run = record.run(deck);
      record.near(where, fmt::format("{}: p/k at collapse", law_name(code)), ring.pressure(run, run.last()),
                  2 * std::log(2.0), 5e-3);
    }
}

// The source chapter's element has no collapse load: it locks against plastic flow without volume change.
void full_quad4(Record& record) {
  const double exact = 2 * std::log(2.0);
  double pressure[2], growth[2];
  for (int formulation : {1, 2}) {
    PushedRing ring;
    ring.cell = Cell::quad4;
    ring.formulation = formulation;
    DeckWriter deck = ring.start();
    ring.push(deck, 0.2, 20);
    ring.push(deck, 0.2, 20);
    const WholeRun run = record.run(deck);
    pressure[formulation - 1] = ring.pressure(run, run.increments[19]);
    growth[formulation - 1] = ring.pressure(run, run.last()) / pressure[formulation - 1] - 1.0;
  }
  record.near(Where::axisymmetric, "b-bar: p/k at collapse", pressure[1], exact, 0.01);
  // How much too much the full element carries depends on nu; that it is too much and grows does not.
  record.within(Where::axisymmetric, "full: exceeds collapse by 5 % or more",
                pressure[0] > 1.05 * exact ? 1.0 : 0.0, 1.0, 0.5);
  record.small(Where::axisymmetric, "growth from u = .2 to .4, b-bar over full", growth[1] / growth[0], 0.1);
}

// A cavity a = 1 in a medium to r = b with stress p0 there: cylinder as a strip (u_z = 0) or a sector, sphere
// as a quadrant of (r, z).
struct Cavity {
  enum class Body { sector, strip, sphere } body = Body::strip;
  double b = 1000.0;
  int columns = 60;
  Block block;

  bool strip() const { return body == Body::strip; }
  Where where() const { return body == Body::sector ? Where::plane_strain : Where::axisymmetric; }
  int factor() const { return body == Body::sphere ? 2 : 1; }  // the kk of the formulas

  DeckWriter start(int code, const std::vector<double>& parameters, double p0) {
    block.cell = Cell::quad8;
    block.columns = columns;
    block.rows = strip() ? 1 : 6;
    block.polar = !strip();
    block.straight = strip();
    block.place = [far = b, flat = strip()](double s, double t) -> Vector2 {
      return {std::pow(far, s), flat ? 0.1 * t : 90.0 * t};
    };
    DeckWriter deck(body == Body::sector ? 1 : 2);
    block.write_nodes(deck);
    deck.material(1, code, parameters);
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.top()) deck.fix(n, strip() ? 0 : 1, strip() ? 1 : 0);
    deck.initial(1, 0, p0, p0, p0, 0.0);
    StageCards& rest = deck.stage();
    for (int j = 0; j < block.rows; ++j) {
      rest.pressure(block.element(0, j), 4, p0, p0);
      rest.pressure(block.element(columns - 1, j), 2, p0, p0);
    }
    return deck;
  }
  void add_pressure(DeckWriter& deck, double p, int increments) const {
    StageCards& stage = deck.stage(increments);
    for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(0, j), 4, p, p);
  }
};

// Points of a cylinder whose axial stress is not between the two others, by more than rounding.
int axial_not_middle(const WholeRun& run, bool strip) {
  int count = 0;
  for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p) {
    const Vector4 s = run.stress[0].col(p);
    const double axial = strip ? s[1] : s[2], a = s[0], b = strip ? s[2] : s[1];
    const double middle = 0.5 * (a + b), reach = std::hypot(0.5 * (a - b), s[3]);
    if (std::abs(axial - middle) > reach + 1e-6 * std::abs(middle)) ++count;
  }
  return count;
}

// c = 0, sin phi = 3/5, p0 = 50: with A = (1 + sin phi)/(1 - sin phi) = 4 and kk = 1 (cylinder) or 2 (sphere),
// first yield at p0 + delta, delta = kk (A - 1) p0/(kk + A); the plastic zone reaches c where (c/a)^(kk
// (A-1)/A) = p/(p0 + delta).  Outside u = delta c/(2 kk G) (c/r)^kk, which gives c from a displacement.  Around
// a sphere all is triaxial compression, so Drucker-Prager with that cone must agree; around a cylinder sigma_z
// must stay the middle stress.
void frictional_cavity(Record& record, Cavity::Body body, const std::vector<int>& laws) {
  const double p0 = 50.0, E = 3000.0, nu = 0.3, G = E / (2 * (1 + nu)), A = 4.0;
  const double phi = std::asin(0.6) / kRadiansPerDegree;
  for (int code : laws) {
    Cavity cavity;
    cavity.body = body;
    if (body == Cavity::Body::sphere) cavity.b = 200.0;
    const double kk = cavity.factor(), delta = kk * (A - 1) * p0 / (kk + A);
    DeckWriter deck = cavity.start(code, strength(code, E, nu, 0.0, phi), p0);
    double before = p0;
    for (double c : {1.5, 2.0}) {
      const double p = (p0 + delta) * std::pow(c, kk * (A - 1) / A);
      cavity.add_pressure(deck, p - before, 12);
      before = p;
    }
    const WholeRun run = record.run(deck);
    if (body != Cavity::Body::sphere)
      record.within(cavity.where(), "points whose axial stress is not the middle one: condition of the formula",
                    axial_not_middle(run, cavity.strip()), 0.0, 0.5);
    std::size_t stage = 0;
    for (double c : {1.5, 2.0}) {
      const Snapshot& at = run.increments[12 * ++stage];
      const int node = cavity.block.node(cavity.columns / 2, 0);  // outside the plastic zone
      const double r = run.position(node).x();
      const double u = at.u[radial_dof(run, node)] - run.increments[0].u[radial_dof(run, node)];
      record.near(cavity.where(),
                  fmt::format("{}: plastic radius at p = {:.3f}", law_name(code),
                              (p0 + delta) * std::pow(c, kk * (A - 1) / A)),
                  std::pow(u * std::pow(r, kk) * 2 * kk * G / delta, 1.0 / (kk + 1)), c, 5e-3);
    }
  }
}

// Tresca, nu = 1/2, small strain: cylinder p - p0 = c_u (1 + ln(2 G u_a/(c_u a))), sphere 4/3 c_u (1 + ln(3 G
// u_a/(c_u a))); no plateau.
void tresca_cavity(Record& record, Cavity::Body body) {
  const double G = 100.0, nu = 0.4999, p0 = 2.0, cu = 1.0;
  Cavity cavity;
  cavity.body = body;
  if (body == Cavity::Body::sphere) cavity.b = 200.0;
  const bool sphere = body == Cavity::Body::sphere;
  DeckWriter deck = cavity.start(4, strength(4, 2 * G * (1 + nu), nu, cu, 0.0), p0);
  double before = p0;
  const double moves[] = {0.02, 0.1, 0.5};
  for (double u : moves) {
    const double p = p0 + (sphere ? 4.0 / 3 * (1 + std::log(3 * G * u)) : 1 + std::log(2 * G * u));
    cavity.add_pressure(deck, p - before, 10);
    before = p;
  }
  const WholeRun run = record.run(deck);
  std::size_t stage = 0;
  for (double u : moves) {
    const Snapshot& at = run.increments[10 * ++stage];
    const double p = p0 + (sphere ? 4.0 / 3 * (1 + std::log(3 * G * u)) : 1 + std::log(2 * G * u));
    // The displacement at that pressure; as pressure: an error of u by 1 % is one of p by .01 (or .0133) c_u.
    const int inner = cavity.block.node(0, 0);
    const double found = at.u[radial_dof(run, inner)] - run.increments[0].u[radial_dof(run, inner)];
    record.near(cavity.where(), fmt::format("u_a at p - p0 = {:.4f} c_u", p - p0), found, u, 0.02);
  }
}

// Ring 1 to b = 4 under p0 all round, then more from inside; c = 10, phi = 30.  Compression +,
// N = (1 + sin phi)/(1 - sin phi), h = c cot phi.  Plastic to C, sigma_r + h = N (sigma_t + h) there, so
// (sigma_r + h) r^((N-1)/N) is constant; outside sigma_r = p0 + A (1/r^2 - 1/b^2), whose hoop stress yields
// at C.  u_b = (1 - nu) A/(G b), whatever the dilation.  Collapse at C = b.
void cohesive_ring(Record& record, Cavity::Body body) {
  const double E = 20000.0, nu = 0.3, G = E / (2 * (1 + nu)), c = 10.0, phi = 30.0, p0 = 30.0, b = 4.0;
  const double s = std::sin(phi * kRadiansPerDegree), N = (1 + s) / (1 - s);
  const double h = c / std::tan(phi * kRadiansPerDegree), power = (N - 1) / N;
  const auto amount = [&](double C) {  // A
    return (N - 1) * (p0 + h) / (1 / (C * C) - 1 / (b * b) + N * (1 / (C * C) + 1 / (b * b)));
  };
  const auto pressure = [&](double C) {
    return (p0 + amount(C) * (1 / (C * C) - 1 / (b * b)) + h) * std::pow(C, power) - h;
  };
  for (double psi : {0.0, 30.0}) {
    std::vector<double> parameters = strength(4, E, nu, c, phi);
    parameters[4] = psi;
    Cavity ring;
    ring.body = body;
    ring.b = b;
    ring.columns = 40;
    DeckWriter deck = ring.start(4, parameters, p0);
    double before = p0;
    const double fronts[] = {1.5, 2.5};
    for (double C : fronts) {
      ring.add_pressure(deck, pressure(C) - before, 6);
      before = pressure(C);
    }
    const WholeRun run = record.run(deck);
    const int rim = radial_dof(run, ring.block.node(ring.block.across() - 1, 0));
    std::size_t stage = 0;
    for (double C : fronts) {
      const Snapshot& at = run.increments[6 * ++stage];
      record.near(ring.where(), fmt::format("psi = {:g}: u_b with the front at {:g} a", psi, C),
                  at.u[rim] - run.increments[0].u[rim], (1 - nu) * amount(C) / (G * b), 5e-4);
    }
    DeckWriter over = ring.start(4, parameters, p0);
    const double collapse = (p0 + h) * std::pow(b, power) - h, beyond = 120.0;
    ring.add_pressure(over, beyond - p0, 10);
    const double from = printed_bracket(record.try_run(over)).from;
    record.near(ring.where(),
                fmt::format("psi = {:g}: lower end of the printed bracket of the collapse pressure", psi),
                p0 + from * (beyond - p0), collapse, 1e-3);
  }
}

}  // namespace

Section cavity_cases() {
  using Body = Cavity::Body;
  const std::string houlsby = "small-strain form of Yu & Houlsby 1991; Carter, Booker & Yeung 1986";
  return {
      "Plastic cylinders and cavities",
      {
          {"plastic.specimen", "triaxial specimen, drained compression to 10 %",
           "q_f = sigma3 (K_p - 1), u_r without plastic volume change", Grade::exact,
           "exact with any step: Newton's tolerance", specimen},
          {"plastic.thick_cylinder", "Tresca ring b/a = 2: pressure, front and collapse",
           "p = k (2 ln c/a + 1 - c^2/b^2), u_a = k c^2/(2 G a), 2 k ln b/a", Grade::exact,
           "ten quad8 across, the front within a cell: 0.5 %", thick_cylinder},
          {"plastic.cohesive_ring", "Mohr-Coulomb ring b/a = 4, c = 10, phi = 30: displacement and collapse",
           "Yu & Houlsby 1991, small strain, finite ring", Grade::exact,
           "40 quad8 across, the front within a cell: 0.05 % of u_b; the bracket's width: 0.1 %",
           [](Record& r) {
             cohesive_ring(r, Body::sector);
             cohesive_ring(r, Body::strip);
           }},
          {"plastic.locking", "the same with full and b-bar quad4: the full one has no collapse load",
           "Nagtegaal, Parks & Rice 1974; 2 k ln b/a", Grade::exact,
           "1 % for ten b-bar; a flag for the full element, and a tenth of its growth", full_quad4},
          {"cavity.cylinder", "cylindrical cavity, c = 0, sin phi = 3/5", houlsby, Grade::exact,
           "mesh of 60 rings to 1000 a: 0.5 % of the plastic radius",
           [](Record& r) {
             frictional_cavity(r, Body::sector, {4});
             frictional_cavity(r, Body::strip, {4});
           }},
          {"cavity.sphere", "spherical cavity, c = 0, sin phi = 3/5, both laws", houlsby, Grade::exact,
           "mesh of 60 x 6 to 200 a: 0.5 % of the plastic radius",
           [](Record& r) {
             frictional_cavity(r, Body::sphere, {4, 3});
           }},
          {"cavity.tresca_cylinder", "cylindrical cavity, Tresca, nu = .4999",
           "p - p0 = c_u (1 + ln 2 G u_a/(c_u a))", Grade::exact, "an error of 2 % in u is 0.02 c_u in p",
           [](Record& r) {
             tresca_cavity(r, Body::sector);
             tresca_cavity(r, Body::strip);
           }},
          {"cavity.tresca_sphere", "spherical cavity, Tresca, nu = .4999",
           "p - p0 = 4/3 c_u (1 + ln 3 G u_a/(c_u a))", Grade::exact, "an error of 2 % in u is 0.027 c_u in p",
           [](Record& r) { tresca_cavity(r, Body::sphere); }},
      }};
}

}  // namespace sage::verify
