// Patch tests P4 and P5 of interfaces.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

constexpr int kNewtonCotes = 3;

struct Joint {
  int element, formulation;
  std::string name;
};

std::vector<Joint> joints(const Record& record) {
  std::vector<Joint> list;
  for (const auto& [code, entry] : record.bench().catalogue().elements.entries())
    if (entry.interface() && entry.square() && !entry.has_pores())
      for (const Formulation& f : entry.formulations) list.push_back({code, f.code, entry.name + " " + f.name});
  return list;
}

// Blocks (x0, x0 + 3) x (-1, 0) and (x0, x0 + 3) x (0, 1) with an elastic interface between them, under a
// uniform stress `local` = [ss nn tt sn]; the whole is turned by `degrees`.  The bottom is held at its exact
// displacements, the rest is loaded by tractions.  Returns the largest error of stress in the solids and of
// traction in the interface, relative.
double sandwich_error(const Record& record, const Joint& joint, int geometry, double degrees, const Vector2& k,
                      const Vector4& local, double x0) {
  const double E = 1000.0, nu = 0.3;
  const bool ring = geometry == 2, quadratic = joint.element == 12;
  Block lower, upper;
  lower.cell = upper.cell = quadratic ? Cell::quad8 : Cell::quad4;
  lower.columns = upper.columns = 3;
  lower.place = rectangle(x0, x0 + 3.0, -1.0, 0.0);
  upper.place = rectangle(x0, x0 + 3.0, 0.0, 1.0);
  upper.first_node = upper.first_element = 101;
  DeckWriter deck(geometry);
  lower.write_nodes(deck);
  upper.write_nodes(deck);
  deck.material(1, 1, {E, nu});
  deck.material(2, 21, {k.x(), k.y(), 1.0});
  deck.group(1, static_cast<int>(lower.cell), 2, 1);
  deck.group(2, joint.element, joint.formulation, 2);
  lower.write_elements(deck, 1);
  upper.write_elements(deck, 1);
  join(deck, 201, 2, lower.top(), upper.bottom(), lower.order());
  for (int n : lower.bottom()) deck.fix(n, 1, 1);
  for (const Block* block : {&lower, &upper})
    if (ring && x0 == 0.0)
      for (int n : block->left()) deck.fix(n, 1, 0);
  StageCards& stage = deck.stage();
  for (int i = 0; i < 3; ++i)
    stage.pressure(upper.element(i, 0), 3, -local[1], -local[1], -local[3], -local[3]);
  for (const Block* block : {&lower, &upper}) {
    stage.pressure(block->element(2, 0), 2, -local[0], -local[0], local[3], local[3]);
    if (!ring || x0 > 0.0) stage.pressure(block->element(0, 0), 4, -local[0], -local[0], local[3], local[3]);
  }
  Model model = record.bench().build(deck.text());
  const Eigen::Matrix2Xd flat = model.mesh.x;
  const Matrix2 R = Eigen::Rotation2Dd(degrees * kRadiansPerDegree).toRotationMatrix();
  model.mesh.x = R * flat;
  const double along =
      ring ? (local[0] - nu * (local[1] + local[2])) / E : (1 + nu) / E * ((1 - nu) * local[0] - nu * local[1]);
  for (int i = 0; i < model.mesh.nodes(); ++i)
    if (flat(1, i) == -1.0) hold(model, i, true, true, R * Vector2(along * flat(0, i), 0.0));
  const WholeRun run = record.run(std::move(model));

  const Matrix2 turned = R * (Matrix2() << local[0], local[3], local[3], local[1]).finished() * R.transpose();
  const Vector4 sigma(turned(0, 0), turned(1, 1), ring ? local[2] : nu * (local[0] + local[1]), turned(0, 1));
  const Vector2 traction(local[3], local[1]);
  const double solid = largest_stress_error(run, 0, [&](const Vector2&) { return sigma; });
  const double joint_error = (run.stress[1].colwise() - traction).colwise().norm().maxCoeff() / traction.norm();
  return std::max(solid, joint_error);
}

void p4_plane(Record& record) {
  for (const Joint& joint : joints(record))
    for (double degrees : {0.0, 30.0, 90.0})
      record.small(Where::plane_strain, joint.name + fmt::format(", turned by {:g} deg", degrees),
                   sandwich_error(record, joint, 1, degrees, {4e4, 1e5}, {-1.0, -3.0, 0.0, 0.8}, 0.0), 1e-11);
}

void p4_stiffness(Record& record) {
  for (double ratio : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    const Vector2 k = Vector2(0.4, 1.0) * ratio * 1000.0;
    for (const Joint& joint : joints(record)) {
      if (joint.formulation == kNewtonCotes) continue;
      const double gate = 1e-11 + 1e-15 * ratio;
      record.small(Where::plane_strain, joint.name + fmt::format(", kn h/E = {:.0e}", ratio),
                   sandwich_error(record, joint, 1, 30.0, k, {-1.0, -3.0, 0.0, 0.8}, 0.0), gate);
      record.small(Where::axisymmetric, joint.name + fmt::format(", kn h/E = {:.0e}", ratio),
                   sandwich_error(record, joint, 2, 0.0, k, {-1.0, -3.0, -1.0, 0.0}, 0.0), gate);
    }
  }
}

// P5: forces sum w B^T t of a uniform traction on a straight element from r1 to r2 of length L.
void p5(Record& record) {
  const double L = 1.5, t = 1.0;
  for (const Joint& joint : joints(record)) {
    const ElementEntry& entry = *record.bench().catalogue().elements.find(joint.element);
    const auto element = entry.make(Geometry::axisymmetric, joint.formulation);
    const ElementTraits& traits = element->traits();
    for (double r1 : {0.0, 2.0}) {
      const double r2 = r1 + 0.8 * L, dz = 0.6 * L;
      Eigen::Matrix2Xd x(2, entry.nodes);
      x.leftCols(4) << r1, r2, r2, r1, 0.0, dz, dz, 0.0;
      if (!entry.only_corners()) x.rightCols(2) << 0.5 * (r1 + r2), 0.5 * (r1 + r2), 0.5 * dz, 0.5 * dz;
      std::vector<double> g(static_cast<std::size_t>(traits.geometry_size()));
      element->geometry(x, g);
      Eigen::VectorXd f = Eigen::VectorXd::Zero(traits.dofs);
      for (int p = 0; p < traits.points; ++p) {
        const double* block = g.data() + p * (1 + 2 * traits.dofs);
        f += block[0] * Eigen::Map<const Eigen::MatrixXd>(block + 1, traits.dofs, 2) * Vector2(0.0, t);
      }
      // Per 2 pi L t.  Newton-Cotes gives the linear element what the source chapter objects to.
      std::vector<double> share{(2 * r1 + r2) / 6, (r1 + 2 * r2) / 6};
      if (joint.element == 11 && joint.formulation == kNewtonCotes) share = {r1 / 2, r2 / 2};
      if (joint.element == 12) share = {r1 / 6, r2 / 6, (r1 + r2) / 3};
      const int top[] = {3, 2, 5};
      double error = 0.0;
      for (std::size_t i = 0; i < share.size(); ++i)
        error = std::max(error,
                         (f.segment<2>(2 * top[i]) - 2 * kPi * L * t * share[i] * Vector2(-0.6, 0.8)).norm());
      record.small(Where::axisymmetric, joint.name + fmt::format(", r1 = {:g}", r1),
                   error / (2 * kPi * L * t * r2), 1e-13);
    }
  }
}

}  // namespace

Section interface_patch_cases() {
  return {
      "Patch tests of interfaces",
      {
          {"interface.p4", "uniform traction through an interface in any direction", "closed form",
           Grade::exact, "rounding", p4_plane},
          {"interface.p4_stiffness", "the same with stiffness up to 1e12 E/h, and a cylinder from the axis on",
           "closed form", Grade::exact,
           "w = t/k is a difference of displacements known to rounding: 1e-15 k h/E", p4_stiffness},
          {"interface.p5", "nodal forces of a uniform traction in a ring",
           "consistent forces; for Newton-Cotes on the linear element its own wrong ones, 2 pi L {r1, r2}/2 "
           "times the "
           "traction",
           Grade::exact, "rounding", p5},
      }};
}

}  // namespace sage::verify
