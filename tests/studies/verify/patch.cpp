// Patch tests P1 to P3 in whole models, P6 on single elements: every solid element of the catalogue.
#include <cmath>

#include "sage/math/dense.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

constexpr double kYoung = 1e6;

// Corner nodes and counter-clockwise quadrilaterals, from deck number 1.
struct Corners {
  std::vector<Vector2> x;
  std::vector<std::array<int, 4>> quads;
};

Corners macneal_harder() {
  Corners c;
  c.x = {{0, 0}, {.24, 0}, {.24, .12}, {0, .12}, {.04, .02}, {.18, .03}, {.16, .08}, {.08, .08}};
  c.quads = {{5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {1, 5, 8, 4}};
  return c;
}

// Elements with their corners only: the program makes the other nodes.
Model patch_model(const Record& record, const Corners& corners, int geometry, int element, int formulation,
                  double nu) {
  DeckWriter deck(geometry);
  for (std::size_t i = 0; i < corners.x.size(); ++i)
    deck.node(static_cast<int>(i) + 1, corners.x[i].x(), corners.x[i].y());
  deck.material(1, 1, {kYoung, nu});
  deck.group(1, element, formulation, 1);
  int number = 1;
  for (const auto& q : corners.quads) {
    if (record.bench().catalogue().elements.find(element)->square()) {
      deck.element(number++, 1, {q[0], q[1], q[2], q[3]});
    } else {
      deck.element(number++, 1, {q[0], q[1], q[2]});
      deck.element(number++, 1, {q[0], q[2], q[3]});
    }
  }
  deck.fix(1, 1, 1);
  deck.fix(2, 0, 1);
  deck.stage();
  return record.bench().build(deck.text());
}

// Boundary nodes are held at u; nodes on the axis of a ring, except its ends, slide along it.
void hold_boundary(Model& model, const VectorField& u) {
  const double bottom = model.mesh.x.row(1).minCoeff(), top = model.mesh.x.row(1).maxCoeff();
  const std::vector<char> boundary = boundary_nodes(model);
  for (int i = 0; i < model.mesh.nodes(); ++i) {
    if (!boundary[i]) continue;
    const Vector2 x = model.mesh.x.col(i);
    const bool slides =
        model.geometry == Geometry::axisymmetric && x.x() == 0.0 && x.y() > bottom && x.y() < top;
    hold(model, i, true, !slides, u(x));
  }
}

// The larger of the errors of displacement (over the largest one) and of stress (over its norm).
double patch_error(const Record& record, Model model, const VectorField& u, const Vector4& strain) {
  hold_boundary(model, u);
  const Vector4 sigma = stress_of(model.materials[0], strain);
  const WholeRun run = record.run(std::move(model));
  const Eigen::Matrix2Xd& x = run.model->mesh.x;
  double error = 0.0, size = 0.0;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    error = std::max(error,
                     (run.last().u.segment<2>(DofMap::displacement(static_cast<int>(i))) - u(x.col(i))).norm());
    size = std::max(size, u(x.col(i)).norm());
  }
  return std::max(error / size, largest_stress_error(run, 0, [&](const Vector2&) { return sigma; }));
}

struct Solid {
  int element, formulation;
  std::string name;
};

std::vector<Solid> solids(const Record& record) {
  std::vector<Solid> list;
  for (const auto& [code, entry] : record.bench().catalogue().elements.entries())
    if (entry.solid() && entry.unknowns.empty())
      for (const Formulation& f : entry.formulations) list.push_back({code, f.code, entry.name + " " + f.name});
  return list;
}

// P1: u = 1e-3 (x + y/2), v = 1e-3 (y + x/2).
void p1(Record& record, double nu, double gate) {
  const VectorField u = [](const Vector2& x) -> Vector2 {
    return {1e-3 * (x.x() + 0.5 * x.y()), 1e-3 * (x.y() + 0.5 * x.x())};
  };
  for (const Solid& s : solids(record))
    record.small(Where::plane_strain, s.name,
                 patch_error(record, patch_model(record, macneal_harder(), 1, s.element, s.formulation, nu), u,
                             {1e-3, 1e-3, 0.0, 1e-3}),
                 gate);
}

// P2: u_r = A r, u_z = B z + C.
void p2(Record& record, double nu, double gate) {
  const double A = 1e-3, B = -2.5e-3, C = 4e-4;
  const VectorField u = [=](const Vector2& x) -> Vector2 { return {A * x.x(), B * x.y() + C}; };
  for (const Solid& s : solids(record))
    record.small(Where::axisymmetric, s.name,
                 patch_error(record, patch_model(record, macneal_harder(), 2, s.element, s.formulation, nu), u,
                             {A, B, A, 0.0}),
                 gate);
}

// The condition of an element matrix grows with the square of its degree: beyond degree 4 the gate does too.
double rounding_gate(const Model& model) {
  return 1e-12 * std::max(1.0, std::pow(model.groups[0].element->traits().degree / 4.0, 2));
}

// P3: u_z = C r needs the body force b_z = -G C / r.
void p3(Record& record) {
  const double C = 2e-3, G = kYoung / 2.5;
  for (const Solid& s : solids(record)) {
    Model model = patch_model(record, macneal_harder(), 2, s.element, s.formulation, 0.25);
    add_body_force(model, [=](const Vector2& x) -> Vector2 { return {0.0, -G * C / x.x()}; });
    const double gate = rounding_gate(model);
    record.small(Where::axisymmetric, s.name,
                 patch_error(record, std::move(model),
                             [=](const Vector2& x) -> Vector2 {
                               return {0.0, C * x.x()};
                             },
                             {0.0, 0.0, 0.0, C}),
                 gate);
  }
}

// P6: eigenvalues of one element that are zero.
void p6(Record& record) {
  for (int geometry : {1, 2})
    for (const Solid& s : solids(record)) {
      Corners one;
      one.x = {{1.0, 0.1}, {2.4, 0.3}, {2.0, 1.6}, {1.2, 1.2}};
      const Model mesh = [&] {
        Corners c = one;
        c.quads = {{1, 2, 3, 4}};
        return patch_model(record, c, geometry, s.element, s.formulation, 0.25);
      }();
      const Group& group = mesh.groups[0];
      const ElementTraits& t = group.element->traits();
      std::vector<double> g(static_cast<std::size_t>(t.geometry_size()));
      Eigen::Matrix2Xd x;
      element_coordinates(mesh.mesh, group, 0, x);
      group.element->geometry(x, g);
      Matrix4 D;
      for (int i = 0; i < 4; ++i) D.col(i) = stress_of(mesh.materials[0], Vector4::Unit(i));
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(t.dofs, t.dofs);
      for (int p = 0; p < t.points; ++p) {
        const double* block = g.data() + p * (1 + 4 * t.dofs);
        const Eigen::Map<const Eigen::MatrixXd> Bt(block + 1, t.dofs, 4);
        K += block[0] * Bt * D * Bt.transpose();
      }
      const Eigen::VectorXd eigen = dense_matrix::symmetric_eigensystem(K).values;
      const auto zero = (eigen.array().abs() < 1e-9 * eigen.maxCoeff()).count();
      record.within(where_of(geometry),
                    s.name + (t.reduced ? ": zero-energy modes, one of them hourglass" : ": zero-energy modes"),
                    static_cast<double>(zero), (geometry == 1 ? 3 : 1) + (t.reduced ? 1 : 0), 0.5);
    }
}

}  // namespace

Section patch_cases() {
  const std::string macneal = "closed form; patch of MacNeal & Harder 1985";
  const std::string rounding = "rounding: 1e-12 of the largest displacement and of the stress";
  const std::string stiff = "rounding times the condition number, K/G = 5e6: 2e-16 x 5e8";
  return {"Patch tests of solid elements",
          {
              {"patch.p1", "uniform strain on a distorted patch", macneal, Grade::exact, rounding,
               [](Record& r) { p1(r, 0.25, 1e-12); }},
              {"patch.p1_incompressible", "the same at nu = .4999999", macneal, Grade::exact, stiff,
               [](Record& r) { p1(r, 0.4999999, 1e-7); }},
              {"patch.p2", "u_r = A r, u_z = B z + C on a patch that touches the axis", "closed form",
               Grade::exact, rounding, [](Record& r) { p2(r, 0.25, 1e-12); }},
              {"patch.p2_incompressible", "the same at nu = .4999999", "closed form", Grade::exact, stiff,
               [](Record& r) { p2(r, 0.4999999, 1e-7); }},
              {"patch.p3", "u_z = C r with the body force -G C/r", "closed form", Grade::exact,
               rounding + "; beyond degree 4 times the square of degree/4", p3},
              {"patch.p6", "zero-energy modes of single elements", "rigid motions: 3 in the plane, 1 in a ring",
               Grade::exact, "whole numbers", p6},
          }};
}

}  // namespace sage::verify
