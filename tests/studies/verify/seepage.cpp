// Water: barriers in a layer, wells, spheres, stretched soil, a dam with a free surface.
#include "tests/studies/scenes/seepage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/studies/verify/cases.hpp"

namespace sage::verify {

namespace {

double discharge(const Record& record, const Barrier& barrier) {
  return -inflow_of(record.run(barrier.deck()), barrier.exit());
}

struct Known {
  double b, s, q;
};

void barriers(Record& record) {
  const Known cases[] = {{0.0, 0.1, 1.0298065910}, {0.0, 0.25, .7346090158}, {0.0, 0.5, 0.5},
                         {0.0, 0.75, .3403170865}, {0.0, 0.9, .2427640318},  {0.5, 0.0, .5331795566},
                         {1.0, 0.0, .3469517731},  {0.5, 0.5, .4063602699},  {1.0, 0.5, .2983698755}};
  for (const Known& c : cases)
    record.near(Where::plane_strain,
                fmt::format("q/(k h), floor b/T = {:g}, depth s/T = {:g}, quad8", c.b, c.s),
                discharge(record, {c.b, c.s}), c.q, 1e-3);
}

// The tip takes the order: with lattice lines at the cubes of their numbers what it costs falls with the size of the
// cells beside it, 1/n^3; a floor has corners of the same kind.
void barrier_orders(Record& record) {
  for (const Known& c : {Known{0.0, 0.5, 0.5}, {0.5, 0.0, .5331795566}}) {
    std::vector<double> size, error;
    for (const int n : {3, 6, 12}) {
      size.push_back(1.0 / n);
      error.push_back(std::abs(discharge(record, {c.b, c.s, Cell::quad8, n}) / c.q - 1.0));
    }
    record.order(Where::plane_strain,
                 c.s > 0.0 ? "discharge below a pile, quad8" : "discharge below a floor, quad8", size, error,
                 3.0, 0.3);
  }
}

void pile_face(Record& record) {
  const Barrier pile{0.0, 0.5, Cell::quad8, 10, {0.4, 0.25, 0.1}};
  const WholeRun run = record.run(pile.deck());
  const Block ground = pile.block();
  for (const auto& [depth, head] : {std::pair{0.1, .060408441}, {0.25, .158443550}, {0.4, .285883831}})
    for (int j = 0; j < ground.up(); ++j)
      if (std::abs(ground.at(0, j).y() + depth) < 1e-9)
        record.within(Where::plane_strain, fmt::format("head at depth {:g} T beside the pile", depth),
                      head_of(run, ground.node(0, j)), head, 1e-3);
  for (const auto& [s, gradient] : {std::pair{0.25, .314085686}, {0.5, .299535059}, {0.75, .265648559}}) {
    const Barrier one{0.0, s, Cell::quad8, 12, {0.25 * s}};
    const WholeRun result = record.run(one.deck());
    const Block block = one.block();
    // From the heads of the uppermost cell: quadratic, its slope at the surface.
    const int up = block.up() - 1;
    const double size = block.at(0, up).y() - block.at(0, up - 2).y();
    const double slope =
        (3.0 * head_of(result, block.node(0, up)) - 4.0 * head_of(result, block.node(0, up - 1)) +
         head_of(result, block.node(0, up - 2))) /
        size;
    record.near(Where::plane_strain, fmt::format("exit gradient s/h at the pile, s/T = {:g}", s), -slope * s,
                gradient, 1e-3);
  }
}

struct Shape {
  const char* name;
  Cell cell;
  int n;
  double order;
};
constexpr Shape kShapes[] = {{"quad4", Cell::quad4, 12, 2.0},
                             {"tri3", Cell::tri3, 12, 2.0},
                             {"quad8", Cell::quad8, 6, 4.0},
                             {"quad9", Cell::quad9, 6, 4.0},
                             {"tri6", Cell::tri6, 6, 4.0}};

// Radii in geometric series.
double radial(const Record& record, const Shape& shape, int n, double q) {
  Block block;
  block.columns = n;
  block.cell = shape.cell;
  block.place = [](double s, double t) { return Vector2(0.1 * std::pow(100.0, s), 2.0 * t); };
  block.straight = true;
  DeckWriter deck = flow_deck(block, 2, kDarcyLaw, {1.0});
  hold_heads(deck.stages.back(), block.left(), 0.0);
  hold_heads(deck.stages.back(), block.right(), 1.0);
  return std::abs(inflow_of(record.run(deck), block.right()) / q - 1.0);
}

double sphere(const Record& record, const Shape& shape, int n, double q) {
  Block block;
  block.columns = block.rows = n;
  block.cell = shape.cell;
  block.place = [](double s, double t) {
    const double R = std::pow(5.0, s), a = 0.5 * kPi * t;
    return Vector2(R * std::cos(a), R * std::sin(a));
  };
  DeckWriter deck = flow_deck(block, 2, kDarcyLaw, {1.0});
  hold_heads(deck.stages.back(), block.left(), 0.0);
  hold_heads(deck.stages.back(), block.right(), 1.0);
  return std::abs(inflow_of(record.run(deck), block.right()) / q - 1.0);
}

void wells(Record& record) {
  const auto each = [&](const char* what, const auto& error_of, double q) {
    for (const Shape& shape : kShapes) {
      std::vector<double> size, error;
      for (int level = 0; level < 3; ++level) {
        const int n = shape.n << level;
        size.push_back(1.0 / n);
        error.push_back(error_of(record, shape, n, q));
      }
      record.order(Where::axisymmetric, fmt::format("{}, {}", what, shape.name), size, error, shape.order, 0.3);
      record.small(Where::axisymmetric, fmt::format("{}, {}, finest", what, shape.name), error.back(), 1e-3);
    }
  };
  each("discharge of a well", radial, 2.7287527077);
  each("flow between spheres", sphere, 0.5 * 15.7079632679);
}

// x' = x sqrt(k2/k1) makes soil of k1 along x and k2 along y isotropic.
void anisotropy(Record& record) {
  for (const Shape& shape : kShapes) {
    const auto run = [&](double stretch, const std::vector<double>& k, std::vector<int>& nodes) {
      Block block;
      block.columns = 8;
      block.rows = 4;
      block.cell = shape.cell;
      block.straight = true;
      block.place = [=](double s, double t) {
        return Vector2(stretch * (4.0 * s + 0.25 * t), 3.0 * t + 0.5 * s * t);
      };
      DeckWriter deck = flow_deck(block, 1, kDarcyLaw, k);
      std::vector<int> inflow = block.top();
      inflow.resize(block.order() * 2 + 1);
      hold_heads(deck.stages.back(), inflow, 4.0);
      hold_heads(deck.stages.back(), block.right(), 1.0);
      nodes = block.right();
      return record.run(deck);
    };
    std::vector<int> nodes;
    const WholeRun stretched = run(4.0, {16.0, 1.0}, nodes), plain = run(1.0, {4.0}, nodes);
    const Eigen::Index heads = plain.last().u.size() - 2 * plain.model->mesh.nodes();
    record.small(Where::plane_strain, fmt::format("heads of stretched soil, {}", shape.name),
                 (stretched.last().u.tail(heads) - plain.last().u.tail(heads)).cwiseAbs().maxCoeff() / 4.0,
                 1e-12);
    record.near(Where::plane_strain, fmt::format("discharge of stretched soil, {}", shape.name),
                inflow_of(stretched, nodes), inflow_of(plain, nodes), 1e-12);
  }
}

// Heads a x + b y are those of any permeability.  What flows in at the outline, weighted with x and with y, is then the
// area times the two components of R diag(k1, k2) R^T (a, b), by the divergence theorem.
void rotated(Record& record) {
  const double k1 = 4.0, k2 = 0.25, angle = 30.0 * kRadiansPerDegree;
  const Vector2 slope(0.5, -0.25);
  const double c = std::cos(angle), s = std::sin(angle);
  Matrix2 k;
  k << k1 * c * c + k2 * s * s, (k1 - k2) * c * s, (k1 - k2) * c * s, k1 * s * s + k2 * c * c;
  const Vector2 expected = 6.0 * k * slope;
  for (const Shape& shape : kShapes) {
    Block block;
    block.columns = 6;
    block.rows = 4;
    block.cell = shape.cell;
    block.place = rectangle(0.0, 3.0, 0.0, 2.0);
    DeckWriter deck = flow_deck(block, 1, kDarcyLaw, {k1, k2, 30.0});
    std::vector<std::pair<int, Vector2>> outline;
    for (int j = 0; j < block.up(); ++j)
      for (int i = 0; i < block.across(); ++i) {
        const bool inside = i > 0 && j > 0 && i + 1 < block.across() && j + 1 < block.up();
        if (inside || !block.exists(i, j)) continue;
        outline.emplace_back(block.node(i, j), block.at(i, j));
        hold_heads(deck.stages.back(), {block.node(i, j)}, slope.dot(block.at(i, j)));
      }
    const WholeRun run = record.run(deck);
    Vector2 moment = Vector2::Zero();
    for (const auto& [node, place] : outline) moment += inflow_of(run, {node}) * place;
    for (const int axis : {0, 1})
      record.near(Where::plane_strain,
                  fmt::format("flow along {}, k1 turned by 30 degrees, {}", axis == 0 ? "x" : "y", shape.name),
                  moment[axis], expected[axis], 1e-12);
  }
}

// A layer 4 m long under a head of 5 m, with a drain at its other end 3 m above the datum: k (5 - 3) / 4 for each metre of
// height while the head is above the drain, and nothing while it is below.
void drains(Record& record) {
  for (const double head : {5.0, 2.0}) {
    Block block;
    block.columns = 8;
    block.rows = 2;
    block.cell = Cell::quad8;
    block.place = rectangle(0.0, 4.0, 0.0, 1.0);
    DeckWriter deck = flow_deck(block, 1, kDarcyLaw, {2.0});
    hold_heads(deck.stages.back(), block.left(), head);
    for (std::size_t j = 0; j < block.right().size(); ++j)
      deck.stages.back().fixities.push_back(
          head_card(block.right()[j], 3.0 - block.at(0, static_cast<int>(j)).y(), 2));
    const WholeRun run = record.run(deck);
    const double out = -inflow_of(run, block.right());
    record.within(Where::plane_strain, fmt::format("what a drain at 3 m takes under a head of {:g} m", head),
                  out, head > 3.0 ? 2.0 * (head - 3.0) / 4.0 : 0.0, 1e-10);
    record.within(Where::plane_strain, fmt::format("head at the drain, {:g} m given", head),
                  head_of(run, block.right().front()), std::min(head, 3.0), 1e-10);
  }
}

// Between two circles that have no common middle heads are linear in the bipolar coordinate xi, and both circles are
// lines of it: q = 2 pi k dh / (xi of the drain - xi of the outer circle).  Half of it, for the line through both
// middles lets nothing through.  k2 across the direction `angle`: the same in axes in which that soil is isotropic,
// with k = sqrt(k1 k2).
struct RoundDrain {
  Cell cell = Cell::quad4;
  int n = 12;
  double k1 = 1.0, k2 = 1.0, angle = 0.0;            // degrees
  static constexpr double inner = 2.0, outer = 0.5;  // xi

  double exact() const { return kPi * std::sqrt(k1 * k2) / (inner - outer); }
  double discharge(const Record& record) const {
    Block block;
    block.columns = block.rows = n;
    block.cell = cell;
    const double c = std::cos(angle * kRadiansPerDegree), s = std::sin(angle * kRadiansPerDegree);
    block.place = [=, this](double across, double around) {
      const double xi = outer + (inner - outer) * across, eta = kPi * (1.0 - around);
      const double size = std::cosh(xi) - std::cos(eta);
      const Vector2 p(std::sqrt(k1) * std::sinh(xi) / size, std::sqrt(k2) * std::sin(eta) / size);
      return Vector2(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    };
    DeckWriter deck = flow_deck(block, 1, kDarcyLaw, {k1, k2, angle});
    hold_heads(deck.stages.back(), block.left(), 9.0);
    // At the drain the head is 8: a pressure head of 8 - y.
    const std::vector<int> drain = block.right();
    for (std::size_t j = 0; j < drain.size(); ++j)
      deck.stages.back().fixities.push_back(
          head_card(drain[j], 8.0 - block.at(block.across() - 1, static_cast<int>(j)).y(), 2));
    return -inflow_of(record.run(deck), drain);
  }
};

void round_drain(Record& record, const char* what, double k1, double k2, double angle) {
  for (const Shape& shape : kShapes) {
    std::vector<double> size, error;
    for (int level = 0; level < 3; ++level) {
      const int n = shape.n << level;
      const RoundDrain drain{shape.cell, n, k1, k2, angle};
      size.push_back(1.0 / n);
      error.push_back(std::abs(drain.discharge(record) / drain.exact() - 1.0));
    }
    record.order(Where::plane_strain, fmt::format("{}, {}", what, shape.name), size, error, shape.order, 0.4);
    record.small(Where::plane_strain, fmt::format("{}, {}, finest", what, shape.name), error.back(), 1e-3);
  }
}

void round_drains(Record& record) {
  round_drain(record, "discharge of a round drain", 1.0, 1.0, 0.0);
}

void rotated_drains(Record& record) {
  round_drain(record, "discharge of a drain, k1 turned by 30 degrees", 4.0, 0.25, 30.0);
}

void dam(Record& record) {
  std::vector<double> size, error;
  double finest = 0.0, balance = 0.0;
  for (const int n : {14, 28, 56}) {
    Dam dam;
    dam.columns = dam.rows = n;
    const WholeRun run = record.run(dam.deck());
    const Block body = dam.block();
    size.push_back(dam.H / n);
    finest = -inflow_of(run, body.right());
    balance = std::abs(inflow_of(run, body.left()) - finest) / finest;
    error.push_back(std::abs(finest / dam.charny() - 1.0));
  }
  record.near(Where::plane_strain, "discharge of the dam H = 7, h = 2, L = 7", finest, 3.2142857142857143e-3,
              1e-3);
  record.order(Where::plane_strain, "discharge of the dam", size, error, 1.0, 0.3);
  record.small(Where::plane_strain, "inflow less outflow, of the water moved", balance, 1e-10);
}

}  // namespace

Section seepage_cases() {
  const char* harr = "Harr (1962), Polubarinova-Kochina (1962): elliptic integrals";
  return {"Seepage",
          {{"seepage.barriers", "Piles, floors and cut-offs in a layer", harr, Grade::exact,
            "1e-3 on lattices that get finer towards the tip", barriers},
           {"seepage.barrier_orders", "The same on finer lattices", harr, Grade::exact, "the tip's own order",
            barrier_orders},
           {"seepage.pile_face", "Heads and exit gradient beside a pile", harr, Grade::exact,
            "1e-3 of the head lost", pile_face},
           {"seepage.wells", "A well in a confined layer, and flow between spheres",
            "Q = 2 pi k D dh/ln(r2/r1); Q = 4 pi k dh/(1/r1 - 1/r2)", Grade::exact,
            "1e-3; twice the degree of the element", wells},
           {"seepage.anisotropy", "Soil with two permeabilities on a stretched mesh", "x' = x sqrt(k2/k1)",
            Grade::twofold, "rounding", anisotropy},
           {"seepage.rotated", "Soil with turned permeabilities in a uniform slope of the head",
            "R diag(k1, k2) R^T (a, b)", Grade::exact, "rounding", rotated},
           {"seepage.rotated_drain", "A round drain in soil with turned permeabilities",
            "bipolar coordinates; x' = x sqrt(k2/k1) along k1", Grade::exact,
            "1e-3; twice the degree of the element", rotated_drains},
           {"seepage.drains", "A layer with a drain at its end", "k (h - 3)/4 above the drain, 0 below",
            Grade::exact, "1e-10", drains},
           {"seepage.round_drain", "A round drain off the middle of a round body",
            "q = 2 pi k dh/(xi1 - xi2), bipolar coordinates", Grade::exact,
            "1e-3; twice the degree of the element", round_drains},
           {"seepage.dam", "Free surface in a dam with vertical faces", "Dupuit; Charny (1951): exact",
            Grade::exact, "1e-3; first order, as the height over which the soil falls dry", dam}}};
}

}  // namespace sage::verify
