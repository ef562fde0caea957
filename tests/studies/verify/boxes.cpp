// Elastic boxes under flexible and rigid loads, and Cook's membrane: converged references
// without truncation error.
#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

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

// Force P = 1 down on a half-space; tension +, z = -y is the depth.  In axisymmetry a point force on the axis
// (Boussinesq), in plane strain a line of force (Flamant).
struct HalfSpace {
  bool ring = false;
  double E = 1000.0, nu = 0.3;

  Vector4 stress(const Vector2& at) const {
    const double x = at.x(), z = -at.y(), R = at.norm(), R5 = std::pow(R, 5);
    if (!ring) {
      const double f = 2 / kPi / std::pow(R, 4), sx = -f * x * x * z, sy = -f * z * z * z;
      return {sx, sy, nu * (sx + sy), f * x * z * z};
    }
    const double side = (1 - 2 * nu) / (R * (R + z)), f = 1 / (2 * kPi);
    return {f * (side - 3 * x * x * z / R5), -3 * f * z * z * z / R5,
            f * ((1 - 2 * nu) * z / (R * R * R) - side), 3 * f * x * z * z / R5};
  }
  Vector2 displacement(const Vector2& at) const {
    const double x = at.x(), z = -at.y(), R = at.norm();
    if (ring) {
      const double f = (1 + nu) / (2 * kPi * E);
      return {f * (x * z / (R * R * R) - (1 - 2 * nu) * x / (R * (R + z))),
              -f * (z * z / (R * R * R) + 2 * (1 - nu) / R)};
    }
    const double plane = E / (1 - nu * nu), ratio = nu / (1 - nu), f = 1 / (kPi * plane),
                 angle = std::atan2(x, z);
    const double s = std::sin(angle), c = std::cos(angle);
    const double along = f * (-2 * c * std::log(R) - (1 - ratio) * angle * s);
    const double across = f * (2 * ratio * s + 2 * std::log(R) * s + (1 - ratio) * (s - angle * c));
    return {along * s + across * c, -along * c + across * s};
  }
};

// The force of a node, the far sides moved as the half-space moves.  A force is that of the full circle.
void point_force(Record& record) {
  for (int geometry : {1, 2}) {
    HalfSpace exact;
    exact.ring = geometry == 2;
    std::vector<double> size, error;
    for (int n : {16, 32}) {
      Block block;
      block.cell = Cell::quad8;
      block.columns = block.rows = n;
      block.straight = true;
      block.place = [](double s, double t) -> Vector2 { return {4 * s * s, -4 * (1 - t) * (1 - t)}; };
      DeckWriter deck(geometry);
      block.write_nodes(deck);
      deck.material(1, 1, {exact.E, exact.nu});
      deck.group(1, 2, 2, 1);  // full: a single force sets off the hourglass of the reduced one
      block.write_elements(deck, 1);
      for (int node : block.left()) deck.fix(node, 1, 0);
      for (int node : block.bottom()) deck.fix(node, 1, 1);
      for (int node : block.right()) deck.fix(node, 1, 1);
      deck.stage().load(block.left().back(), 0.0, exact.ring ? -1.0 : -0.5);  // half of the line's force
      Model model = record.bench().build(deck.text());
      std::vector<char> far(static_cast<std::size_t>(model.mesh.nodes()), 0);
      for (int node = 0; node < model.mesh.nodes(); ++node)
        far[node] = model.mesh.x(0, node) == 4.0 || model.mesh.x(1, node) == -4.0;
      hold(model, far, [&](const Vector2& x) { return exact.displacement(x); });
      const WholeRun run = record.run(std::move(model));
      double wrong = 0.0, all = 0.0;
      for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p) {
        const Vector2 at = point_position(*run.model, 0, p);
        if (at.norm() < 1.5 || at.norm() > 3.0) continue;
        const Vector4 right = exact.stress(at);
        wrong += (run.stress[0].col(p) - right).squaredNorm();
        all += right.squaredNorm();
      }
      const double mean = std::sqrt(wrong / all);
      record.small(where_of(geometry), fmt::format("mean error of the stress, 1.5 < R < 3, {0} x {0} quad8", n),
                   mean, n == 16 ? 0.015 : 0.003);
      size.push_back(1.0 / n);
      error.push_back(mean);
    }
    record.order(where_of(geometry), "mean error of the stress, 1.5 < R < 3", size, error, 2.0);
  }
}

}  // namespace

Section box_cases() {
  const std::string hp = "independent hp finite-element computation, 6 to 8 digits";
  return {
      "Elastic boxes and Cook's membrane",
      {
          {"box.flexible", "uniform load on a box: settlements, work and stress", hp, Grade::computed,
           "graded mesh of 36 x 28 quad8; stress at a node is extrapolated: 2e-3 q", flexible},
          {"box.rigid", "rigid smooth and rough plates on a box", hp, Grade::computed,
           "the contact pressure is singular at the plate's edge: 0.2 % with a graded mesh", rigid},
          {"box.point_force", "force of one node: stress in the half-space", "Boussinesq 1885; Flamant 1892",
           Grade::exact, "32 x 32 quad8 finer towards the force: 0.3 % of the stress, at order 2", point_force},
          {"cook.converged", "Cook's membrane in plane strain, nu = 1/3 and .4999", hp, Grade::computed,
           "singular corner: 0.1 % on a graded mesh of 32 x 32 quad8; b-bar within 3 % at n = 16", cook},
          {"cook.locking", "what fully integrated elements give for nu = .4999",
           "the same meshes in an independent program", Grade::computed, "five digits are printed",
           cook_locking},
      }};
}

}  // namespace sage::verify
