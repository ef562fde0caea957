// Interfaces in whole models: shear column, sliding block, block on a slope, pull-out; and the hyperbolic law
// on one point.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/core/point_driver.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

// Block H = 2 in pure shear (u_y = 0 everywhere) on an interface: delta = tau (H/G + 1/k_s); beyond
// c + sigma_n tan phi it slides as a rigid body; on the way back only the elastic part returns.
void shear_column(Record& record) {
  const double H = 2.0, E = 1000.0, nu = 0.25, G = E / (2 * (1 + nu)), ks = 500.0, c = 3.0, sigma_n = 20.0;
  const double strength = c + sigma_n * std::tan(30.0 * kDegree), flexibility = H / G + 1.0 / ks;
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
  const char* names[] = {"elastic", "sliding", "on the way back"};
  for (double move : moves) {
    StageCards& stage = deck.stage(2);
    for (int n : block.top()) stage.fix(n, 1, 0, move);
  }
  const WholeRun run = record.run(deck);
  for (std::size_t s = 0; s < 3; ++s)
    record.near(Where::plane_strain, fmt::format("shear stress, {}", names[s]),
                run.reaction(run.increments[2 * s + 1], block.top(), 0), stress[s], 1e-8);
  // The foot has moved by what slid and by the interface's elastic part.
  record.near(Where::plane_strain, "what stays: displacement of the foot", run.u(block.node(1, 0)).x(),
              moves[0] + moves[1] - yield + stress[2] / ks, 1e-8);
}

// The twin: a ring c = 1, b = 2 of height H that moves up along its outer face (u_r = 0 everywhere) on a rigid
// core: delta = P (ln(b/c)/G + 1/(k_s c))/(2 pi H), and P = 2 pi c H (c + sigma_n tan phi) once it slides.
void shear_ring(Record& record) {
  const double H = 0.5, E = 1000.0, nu = 0.25, G = E / (2 * (1 + nu)), ks = 500.0, c = 3.0, sigma_n = 20.0;
  const double flexibility = (std::log(2.0) / G + 1.0 / ks) / (2 * kPi * H);
  const double strength = 2 * kPi * H * (c + sigma_n * std::tan(30.0 * kDegree));
  Block block;
  block.cell = Cell::quad8;
  block.columns = 8;
  block.place = rectangle(1.0, 2.0, 0.0, H);
  DeckWriter deck(2);
  deck.water_unit_weight = 1.0;
  block.write_nodes(deck);
  const std::vector<int> core = copy_row(deck, block, block.left(), 101);
  deck.material(1, 1, {E, nu});
  deck.material(2, 22, coulomb(c, 30.0, ks, 1e6));
  deck.group(1, 2, 1, 1);
  deck.group(2, 12, 0, 2);
  block.write_elements(deck, 1);
  join(deck, 101, 2, block.left(), core, 2);
  for (int j = 0; j < block.up(); ++j)
    for (int i = 0; i < block.across(); ++i)
      if (block.exists(i, j)) deck.fix(block.node(i, j), 1, 0);
  for (int n : core) deck.fix(n, 1, 1);
  deck.initial(2, 0, 0.0, sigma_n);
  const double moves[] = {0.05, 0.06, -0.04};
  for (double move : moves) {
    StageCards& stage = deck.stage(2);
    for (int n : block.right()) stage.fix(n, 0, 1, 0.0, move);
  }
  const WholeRun run = record.run(deck);
  const double force[] = {moves[0] / flexibility, strength, strength + moves[2] / flexibility};
  const char* names[] = {"elastic", "sliding", "on the way back"};
  for (std::size_t s = 0; s < 3; ++s)
    record.near(Where::axisymmetric, fmt::format("force, {}", names[s]),
                run.reaction(run.increments[2 * s + 1], block.right(), 1), force[s], s == 1 ? 1e-8 : 1e-4);
}

// Pushed at the foot of its left side: P = W tan phi once all of it slides.
void sliding_block(Record& record) {
  BlockOnPlane model(coulomb(0.0, 25.0, 1e5, 1e6));
  model.deck.stage(2).gravity_y = -1.0;
  model.deck.stage(10).fix(model.block.node(0, 0), 1, 0, 0.05);
  const WholeRun run = record.run(model.deck);
  const double P = BlockOnPlane::weight * std::tan(25.0 * kDegree);
  const std::vector<int> foot{model.block.node(0, 0)};
  record.near(Where::plane_strain, "push once all of it slides", run.reaction(run.last(), foot, 0), P, 1e-8);
  record.near(Where::plane_strain, "a plateau: push one increment earlier",
              run.reaction(run.increments[10], foot, 0), P, 1e-8);
}

bool stays(const Record& record, double slope, double c, double phi) {
  BlockOnPlane model(coulomb(c, phi, 1e5, 1e6));
  StageCards& stage = model.deck.stage(4);
  stage.gravity_x = std::sin(slope * kDegree);
  stage.gravity_y = -std::cos(slope * kDegree);
  return record.try_run(model.deck).completed();
}

// Sliding of a layer on a slope: sin(slope) = c/(gamma H) + cos(slope) tan phi, which is the infinite slope's
// F = c/(gamma z sin cos) + tan phi/tan = 1 with z = H/cos.
void block_on_slope(Record& record) {
  record.within(Where::plane_strain, "steepest slope without cohesion, degrees",
                bisect(20.0, 30.0, 0.005, [&](double slope) { return stays(record, slope, 0.0, 25.0); }), 25.0,
                0.01);
  const double slope = 30.0, c = 4.0, phi = 25.0;
  const double F = c / (20.0 * std::sin(slope * kDegree)) + std::tan(phi * kDegree) / std::tan(slope * kDegree);
  const double found = bisect(1.0, 1.5, 2e-4, [&](double f) {
    return stays(record, slope, c / f, std::atan(std::tan(phi * kDegree) / f) / kDegree);
  });
  record.near(Where::plane_strain, "factor of safety at 30 degrees with cohesion, strength reduction", found, F,
              4e-4);
}

// A bar with nu = 0 whose side is held to a rigid wall by shear springs k_s (perimeter s, section A, length L):
// u = F cosh(mu x)/(E A mu sinh(mu L)) from its free end, mu^2 = k_s s/(E A).  With strength tau_m a zone of
// length d slips at the loaded end: F = s tau_m d + E A mu (tau_m/k_s) tanh(mu (L - d)).
struct PullOut {
  int geometry;
  int cells;
  double c = 1e6;
  int rule = 0;
  static constexpr double E = 1000.0, L = 1.0, a = 0.001, ks = 4.0;  // mu L = 2 (plane), 2.83 (round)
  Block block;
  DeckWriter deck;
  std::vector<int> wall;

  PullOut(int g, int n, double strength = 1e6) : geometry(g), cells(n), c(strength), deck(g) {
    block.cell = Cell::quad8;
    block.columns = 1;
    block.rows = cells;
    block.place = rectangle(0.0, a, 0.0, L);
    deck.water_unit_weight = 1.0;
    block.write_nodes(deck);
    wall = copy_row(deck, block, block.right(), 5001);
    deck.material(1, 1, {E, 0.0});
    deck.material(2, 22, coulomb(c, 0.0, ks, 1e6));
    deck.group(1, 2, 1, 1);
    deck.group(2, 12, rule, 2);
    block.write_elements(deck, 1);
    join(deck, 5001, 2, wall, block.right(), 2);
    for (int j = 0; j < block.up(); ++j)
      for (int i = 0; i < block.across(); ++i)
        if (block.exists(i, j)) deck.fix(block.node(i, j), 1, 0);
    for (int n2 : wall) deck.fix(n2, 1, 1);
  }
  double perimeter() const { return geometry == 1 ? 1.0 : 2 * kPi * a; }
  double area() const { return geometry == 1 ? a : kPi * a * a; }
  double mu() const { return std::sqrt(ks * perimeter() / (E * area())); }
  void pull(double u, int increments) {
    StageCards& stage = deck.stage(increments);
    for (int n : block.top()) stage.fix(n, 0, 1, 0.0, u);
  }
  double force(const WholeRun& run, const Snapshot& at) const { return run.reaction(at, block.top(), 1); }
};

void pull_out(Record& record) {
  for (int geometry : {1, 2}) {
    PullOut bar(geometry, 16);
    bar.pull(0.01, 1);
    const WholeRun run = record.run(bar.deck);
    const double mu_L = bar.mu() * PullOut::L;
    record.near(where_of(geometry), "stiffness F/u of the loaded end", bar.force(run, run.last()) / 0.01,
                PullOut::E * bar.area() * bar.mu() * std::tanh(mu_L), 1e-4);
    double worst = 0.0;
    for (int node : bar.block.left()) {
      const double exact = std::cosh(bar.mu() * run.position(node).y()) / std::cosh(mu_L);
      worst = std::max(worst, std::abs(run.u(node).y() / 0.01 - exact));
    }
    record.small(where_of(geometry), "u along the bar over that of the loaded end, largest error", worst, 1e-4);
  }
}

void pull_out_slip(Record& record) {
  const double tau_m = 0.02;
  for (int geometry : {1, 2}) {
    PullOut bar(geometry, 40, tau_m);
    const double EA = PullOut::E * bar.area(), s = bar.perimeter(), mu = bar.mu(), first = tau_m / PullOut::ks;
    const auto F = [&](double d) { return s * tau_m * d + EA * mu * first * std::tanh(mu * (PullOut::L - d)); };
    const auto u = [&](double d) {
      const double at_front = EA * mu * first * std::tanh(mu * (PullOut::L - d));
      return first + at_front / EA * d + s * tau_m * d * d / (2 * EA);
    };
    double before = 0.0;
    for (double d : {0.2, 0.5, 0.8}) {
      bar.pull(u(d) - before, 4);
      before = u(d);
    }
    bar.pull(0.1, 4);
    const WholeRun run = record.run(bar.deck);
    std::size_t stage = 0;
    for (double d : {0.2, 0.5, 0.8})
      record.near(where_of(geometry), fmt::format("force with slip over {:g} of the length", d),
                  bar.force(run, run.increments[4 * stage++ + 3]), F(d), 1e-3);
    record.near(where_of(geometry), "force at the end: s tau L", bar.force(run, run.last()),
                s * tau_m * PullOut::L, 1e-8);
  }
}

// tau = w / (1/k_s + w R_f/tau_f) at constant sigma_n, with k_s = k_j gamma_w (sigma_n/p_a)^n.
void hyperbola(Record& record) {
  const UnitSystem units{"in", "lbf", "psi", 14.696, 0.036111};
  const double kj = 5000, n = 0.9, Rf = 0.8, phi = 28.5, sigma_n = 50.0, w = 0.05;
  const double ks = kj * units.water_unit_weight * std::pow(sigma_n / units.atmospheric_pressure, n);
  const double strength = sigma_n * std::tan(phi * kDegree), exact = w / (1 / ks + w * Rf / strength);
  const char* names[] = {"tangent", "midpoint", "exact hyperbola"};
  for (int rule = 0; rule < 3; ++rule) {
    const std::vector<double> parameters{0.0, phi, 0.0, Rf, kj, n, 1e6, 1e6, 0.0, static_cast<double>(rule)};
    const LawPtr law = record.bench().catalogue().materials.find(22)->make(parameters, units);
    std::vector<double> size, error;
    for (int steps : {25, 50, 100}) {
      PointDriver<2> driver(*std::get<std::unique_ptr<InterfaceLaw>>(law), {0.0, -sigma_n});
      for (int i = 0; i < steps; ++i) driver.advance({Control::strain, Control::stress}, {w / steps, -sigma_n});
      size.push_back(1.0 / steps);
      error.push_back(std::abs(driver.sigma()[0] / exact - 1.0));
    }
    if (rule == 2)
      record.small(Where::point, "shear stress, exact rule, any step",
                   *std::max_element(error.begin(), error.end()), 1e-10);
    else
      record.order(Where::point, fmt::format("shear stress, {} rule", names[rule]), size, error, rule + 1.0);
  }
}

}  // namespace

Section interface_cases() {
  return {
      "Interfaces",
      {
          {"interface.shear_column", "block or ring on an interface: elastic, sliding, back",
           "tau = delta/(H/G + 1/k_s), c + sigma_n tan phi; ring: ln(b/c)/G + 1/(k_s c)", Grade::exact,
           "Newton's tolerance, 1e-8; the ring's elastic part: 8 quad8, 1e-4",
           [](Record& r) {
             shear_column(r);
             shear_ring(r);
           }},
          {"interface.sliding_block", "heavy block pushed over a rough plane", "P = W tan phi", Grade::exact,
           "Newton's tolerance, 1e-8", sliding_block},
          {"interface.slope", "block on a slope: steepest angle, factor of safety of the infinite slope",
           "F = c/(gamma z sin cos) + tan phi/tan(slope)", Grade::exact, "twice the width of the bisection",
           block_on_slope},
          {"interface.pull_out", "bar held by elastic shear springs", "u = F cosh(mu x)/(E A mu sinh(mu L))",
           Grade::exact, "the bar's own shear, k_s a/G = 8e-6, and 16 quad8: 1e-4", pull_out},
          {"interface.pull_out_slip", "the same with a shear strength: slip from the loaded end on",
           "F = s tau d + E A mu (tau/k_s) tanh(mu (L - d))", Grade::exact,
           "front of slip within a cell of 1/40: 1e-3; at the end 1e-8", pull_out_slip},
          {"interface.hyperbola", "hyperbolic interface at constant normal stress",
           "tau = w/(1/k_s + w R_f/tau_f)", Grade::exact,
           "order 1 for the tangent, 2 for the midpoint, exact for the hyperbola", hyperbola},
      }};
}

}  // namespace sage::verify
