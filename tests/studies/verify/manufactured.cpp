// Manufactured solutions: a smooth field is chosen, the body force that keeps it in equilibrium follows from
// its derivatives, the boundary is held at it, and the errors must fall at the theory's rate.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"
#include "tests/studies/verify/jet.hpp"

namespace sage::verify {

namespace {

constexpr double kE = 1.0, kNu = 0.3;
const double kG = kE / (2 * (1 + kNu)), kLambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu));

struct Field {
  Jet u, v;
};

Field plane_field(const Vector2& p) {
  const Jet x = Jet::first(p.x()), y = Jet::second(p.y());
  return {0.1 * (sin(kPi * x) * cos(kPi * y)), 0.1 * (x * x * y - cos(kPi * x) * sin(kPi * y))};
}

Field ring_field(const Vector2& p) {
  const Jet r = Jet::first(p.x()), z = Jet::second(p.y());
  return {0.1 * (r * cos(kPi * z) - r * r * r * cos(kPi * z)), 0.1 * ((r * r + z * z) * sin(z))};
}

struct Problem {
  int geometry;
  double x0;  // the unit square starts there
  Field field(const Vector2& p) const { return geometry == 1 ? plane_field(p) : ring_field(p); }

  VectorField displacement() const {
    return [*this](const Vector2& p) -> Vector2 {
      const Field f = field(p);
      return {f.u.v, f.v.v};
    };
  }
  TensorField stress() const {
    return [*this](const Vector2& p) -> Vector4 {
      const Field f = field(p);
      const double hoop = geometry == 1 ? 0.0 : f.u.v / p.x(), volume = f.u.x + f.v.y + hoop;
      return {kLambda * volume + 2 * kG * f.u.x, kLambda * volume + 2 * kG * f.v.y,
              kLambda * volume + 2 * kG * hoop, kG * (f.u.y + f.v.x)};
    };
  }
  // b = -div sigma.
  VectorField body_force() const {
    return [*this](const Vector2& p) -> Vector2 {
      const Field f = field(p);
      const double r = p.x();
      double volume_x = f.u.xx + f.v.xy, volume_y = f.u.xy + f.v.yy;  // derivatives of the volumetric strain
      if (geometry == 2) {
        volume_x += f.u.x / r - f.u.v / (r * r);
        volume_y += f.u.y / r;
      }
      double bx = kLambda * volume_x + 2 * kG * f.u.xx + kG * (f.u.yy + f.v.xy);
      double by = kLambda * volume_y + 2 * kG * f.v.yy + kG * (f.u.xy + f.v.xx);
      if (geometry == 2) {
        bx += 2 * kG * (f.u.x - f.u.v / r) / r;
        by += kG * (f.u.y + f.v.x) / r;
      }
      return {-bx, -by};
    };
  }
};

enum class Mesh { squares, parallelograms, trapezoids };

struct MeshKind {
  const char* name;
  Cell cell;
  int formulation, coarsest;
  Mesh mesh;
  double order, stress_order;
};

// Trapezoids: rows of nodes shifted up and down by a quarter of a cell, the same pattern on every level, so
// that cells never come near parallelograms.
std::function<Vector2(double, double)> placed(const MeshKind& kind, double x0, int n) {
  const bool trapezoids = kind.mesh == Mesh::trapezoids;
  return [=](double s, double t) -> Vector2 {
    if (!trapezoids) return {x0 + s, t};
    const auto shift = [&](double column) {  // of inner rows at corner columns
      return (std::lround(column) % 2 == 0 ? 0.25 : -0.25) / n;
    };
    const double column = s * n, row = t * n, left = std::floor(column + 1e-9), part = column - left;
    const auto at_row = [&](double j) {
      const bool moves = j > 0.5 && j < n - 0.5 && std::lround(j) % 2 == 1;
      return j / n + (moves ? (1 - part) * shift(left) + part * shift(left + 1) : 0.0);
    };
    const double below = std::floor(row + 1e-9), up = row - below;
    return {x0 + s, up < 1e-9 ? at_row(below) : (1 - up) * at_row(below) + up * at_row(below + 1)};
  };
}

void converge(Record& record, const Problem& problem, const std::vector<MeshKind>& kinds) {
  for (const MeshKind& kind : kinds) {
    std::vector<double> size, u, s;
    for (int level = 0; level < 3; ++level) {
      const int n = kind.coarsest << level;
      Block block;
      block.cell = kind.cell;
      block.columns = block.rows = n;
      block.place = placed(kind, problem.x0, n);
      DeckWriter deck(problem.geometry);
      block.write_nodes(deck);
      deck.material(1, 1, {kE, kNu});
      deck.group(1, static_cast<int>(kind.cell), kind.formulation, 1);
      block.write_elements(deck, 1);
      for (int node : block.bottom()) deck.fix(node, 1, 1);
      deck.stage();
      Model model = record.bench().build(deck.text());
      hold(model, boundary_nodes(model), problem.displacement());
      add_body_force(model, problem.body_force());
      const WholeRun run = record.run(std::move(model));
      const FieldErrors e = field_errors(run, problem.displacement(), problem.stress());
      size.push_back(1.0 / n);
      u.push_back(e.displacement);
      s.push_back(e.stress);
    }
    record.order(where_of(problem.geometry), fmt::format("u, {}", kind.name), size, u, kind.order);
    record.order(where_of(problem.geometry), fmt::format("stress, {}", kind.name), size, s, kind.stress_order);
  }
}

const std::vector<MeshKind> kMeshKinds = {
    {"quad4 full", Cell::quad4, 1, 8, Mesh::squares, 2, 1},
    {"quad4 b-bar", Cell::quad4, 2, 8, Mesh::squares, 2, 1},
    {"quad8 reduced", Cell::quad8, 1, 4, Mesh::squares, 3, 2},
    {"quad8 full", Cell::quad8, 2, 4, Mesh::squares, 3, 2},
    {"quad9", Cell::quad9, 1, 4, Mesh::squares, 3, 2},
    {"tri3", Cell::tri3, 1, 8, Mesh::squares, 2, 1},
    {"tri6 three points", Cell::tri6, 1, 4, Mesh::squares, 3, 2},
    {"quad4 full, trapezoids", Cell::quad4, 1, 8, Mesh::trapezoids, 2, 1},
    {"quad8 full, trapezoids", Cell::quad8, 2, 4, Mesh::trapezoids, 2, 1},
    {"quad9, trapezoids", Cell::quad9, 1, 4, Mesh::trapezoids, 3, 2},
};

}  // namespace

Section manufactured_cases() {
  const std::string gate =
      "theory, L2 with r in the measure: u 2 and stress 1 for linear, 3 and 2 for quadratic elements; quad8 on "
      "trapezoids 2 and 1 (Arnold, Boffi & Falk 2002)";
  return {
      "Manufactured solutions",
      {
          {"mms.plane", "u = sin(pi x) cos(pi y)/10, v = (x^2 y - cos(pi x) sin(pi y))/10 on the unit square",
           "the field itself, its body force by second derivatives", Grade::exact, gate,
           [](Record& r) {
             converge(r, {1, 0.0}, kMeshKinds);
           }},
          {"mms.axis", "u_r = r (1 - r^2) cos(pi z)/10, u_z = (r^2 + z^2) sin(z)/10 from the axis to r = 1",
           "the field itself", Grade::exact, gate,
           [](Record& r) {
             converge(r, {2, 0.0}, kMeshKinds);
           }},
          {"mms.ring", "the same between r = 1 and 2", "the field itself", Grade::exact, gate,
           [](Record& r) {
             converge(r, {2, 1.0}, kMeshKinds);
           }},
      }};
}

}  // namespace sage::verify
