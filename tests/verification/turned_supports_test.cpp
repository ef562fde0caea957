// Supports along turned lines: models that are turned as a whole, closed forms with symmetry along a turned line, what
// becomes of the supports on finer meshes and in files, and input that is rejected.  Ties of nodes.  docs/manual/supports.md
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "sage/builder/model_input.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/dof_map.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/model_file/model_file.hpp"
#include "tests/studies/workbench.hpp"

namespace sage {
namespace {

using namespace scenes;

constexpr double kModulus = 1000.0, kPoisson = 0.3;

const Workbench& turned_bench() {
  static const Workbench bench = app::make_workbench();
  return bench;
}

WholeRun complete(const ModelInput& input, const BuildOptions& options = {}, const RunSettings& settings = {}) {
  WholeRun done = turned_bench().run(build_model(input, turned_bench().catalogue(), options), settings);
  EXPECT_TRUE(done.completed()) << done.failure;
  EXPECT_LT(done.out_of_balance, 1e-7);
  return done;
}

// Elements of eight nodes between grid lines of a unit square, which `place` maps.
struct Patch {
  int columns = 2, rows = 2;

  int node(int i, int j) const {  // on half lines; 0 where both are odd
    if (i % 2 == 1 && j % 2 == 1) return 0;
    const int full = 2 * columns + 1, half = columns + 1;
    return (j / 2) * (full + half) + (j % 2 == 0 ? i : full + i / 2) + 1;
  }
  std::vector<int> row(int j) const {
    std::vector<int> list;
    for (int i = 0; i <= 2 * columns; ++i)
      if (node(i, j) > 0) list.push_back(node(i, j));
    return list;
  }
  std::vector<int> column(int i) const {
    std::vector<int> list;
    for (int j = 0; j <= 2 * rows; ++j)
      if (node(i, j) > 0) list.push_back(node(i, j));
    return list;
  }
  std::vector<int> elements_of_row(int row) const {
    std::vector<int> list;
    for (int i = 1; i <= columns; ++i) list.push_back(row * columns + i);
    return list;
  }
  std::vector<int> elements_of_column(int column) const {
    std::vector<int> list;
    for (int j = 0; j < rows; ++j) list.push_back(j * columns + column + 1);
    return list;
  }
  ModelInput input(const std::function<Vector2(double, double)>& place, Geometry geometry) const {
    ModelInput input{.title = "patch", .geometry = geometry};
    for (int j = 0; j <= 2 * rows; ++j)
      for (int i = 0; i <= 2 * columns; ++i)
        if (node(i, j) > 0) input.nodes.push_back(place(0.5 * i / columns, 0.5 * j / rows));
    GroupInput group{.element = "quad8", .material = 1, .elements = {}};
    for (int j = 0; j < 2 * rows; j += 2)
      for (int i = 0; i < 2 * columns; i += 2)
        group.elements.push_back({node(i, j), node(i + 2, j), node(i + 2, j + 2), node(i, j + 2),
                                  node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2), node(i, j + 1)});
    input.groups = {group};
    input.materials = {{"linear_elastic", {{"youngs_modulus", kModulus}, {"poissons_ratio", kPoisson}}}};
    return input;
  }
};

SupportInput held_along(std::vector<int> nodes, double angle, double value = 0.0) {
  return {.nodes = std::move(nodes), .x = FixityCode::fixed, .x_value = value, .angle = angle};
}
SupportInput held_across(std::vector<int> nodes, double angle, double value = 0.0) {
  return {.nodes = std::move(nodes), .y = FixityCode::fixed, .y_value = value, .angle = angle};
}

Vector2 turn(const Vector2& v, double degrees) {
  const double a = degrees * kRadiansPerDegree;
  return {std::cos(a) * v.x() - std::sin(a) * v.y(), std::sin(a) * v.x() + std::cos(a) * v.y()};
}

// A distorted patch of a yielding material under weight, a pressure, a force, and then a base that is partly let go and a
// side that is pushed in; all of it turned.
WholeRun turned_patch(double angle, bool yields, const RunSettings& settings = {}) {
  const Patch patch{3, 2};
  const auto place = [&](double x, double y) {
    return turn({3.0 * x + 0.2 * std::sin(3.0 * x * y), 2.0 * y + 0.15 * std::sin(4.0 * x)}, angle);
  };
  ModelInput input = patch.input(place, Geometry::plane_strain);
  if (yields)
    input.materials = {{"mohr_coulomb",
                        {{"youngs_modulus", kModulus},
                         {"poissons_ratio", kPoisson},
                         {"cohesion", 3.0},
                         {"friction_angle", 20.0}}}};
  input.materials[0].unit_weight = 1.0;
  input.supports = {held_across(patch.row(0), angle), held_along(patch.column(0), angle)};
  StageInput first{.increments = 2, .tolerance = 1e-12}, second = first;
  const Vector2 gravity = turn({0.3, -1.0}, angle), force = turn({0.4, -0.3}, angle);
  first.gravity = gravity;
  first.loads = {{.nodes = {patch.node(6, 4)}, .x = force.x(), .y = force.y()}};
  first.pressures = {{.elements = patch.elements_of_row(1), .edge = 3, .normal1 = 4.0, .normal2 = 4.0}};
  second.supports = {
      held_along(patch.column(6), angle, -0.01),
      {.nodes = {patch.node(6, 0), patch.node(5, 0)}, .y = FixityCode::released, .angle = angle}};
  input.stages = {first, second};
  return complete(input, {}, settings);
}

void expect_turned(const WholeRun& turned, const WholeRun& plain, double angle, double close) {
  for (std::size_t i = 0; i < plain.increments.size(); ++i) {
    const Snapshot &a = turned.increments[i], &b = plain.increments[i];
    const double u = b.u.lpNorm<Eigen::Infinity>(), f = b.internal.lpNorm<Eigen::Infinity>();
    for (int node = 0; node < plain.model->mesh.nodes(); ++node) {
      const int dof = DofMap::displacement(node);
      EXPECT_LT((Vector2(a.u.segment<2>(dof)) - turn(b.u.segment<2>(dof), angle)).norm(), close * u) << node;
      const Vector2 here = a.internal.segment<2>(dof) - a.external.segment<2>(dof);
      const Vector2 there = b.internal.segment<2>(dof) - b.external.segment<2>(dof);
      EXPECT_LT((here - turn(there, angle)).norm(), close * f) << node;
    }
  }
}

// 90 and 180 degrees are supports along x and y, 120 degrees those along a line at 30 degrees with the axes exchanged.
// Tolerance: rounding of K (condition 1e3); of the yielding body Newton's last correction, too.
TEST(TurnedSupports, AModelThatIsTurnedGivesTurnedAnswers) {
  const WholeRun plain = turned_patch(0.0, false);
  for (const double angle : {30.0, 120.0, 90.0, 180.0, -45.0, 200.0, 290.5}) {
    SCOPED_TRACE(angle);
    expect_turned(turned_patch(angle, false), plain, angle, 1e-11);
  }
  const WholeRun yielding = turned_patch(0.0, true);
  EXPECT_GT(yielding.last().points[static_cast<std::size_t>(PointStatus::yielded)], 0);
  expect_turned(turned_patch(30.0, true), yielding, 30.0, 1e-10);
}

// Every method of iteration and every skip finds the same state.
TEST(TurnedSupports, SkipsChangeNothing) {
  const WholeRun all = turned_patch(30.0, true);
  RunSettings settings = turned_bench().settings();
  for (const SkipName& skip : kSkipNames) settings.skips.*skip.flag = false;
  expect_turned(turned_patch(30.0, true, settings), all, 0.0, 1e-9);
}

// A block of height h and length l on a smooth plane at b degrees, stopped at its lower side.  nu = 0: two columns in one,
// with stresses g cos(b) (h - n) across the plane and g sin(b) (l - s) along it.  Quadratic displacements are exact.
TEST(TurnedSupports, ABlockOnAnInclinedPlaneIsTwoColumns) {
  const double h = 2.0, l = 3.0, g = 20.0, b = 25.0;
  const double across = g * std::cos(b * kRadiansPerDegree), along = g * std::sin(b * kRadiansPerDegree);
  const Patch patch{2, 2};
  ModelInput input = patch.input(
      [&](double x, double y) {
        return turn({l * x, h * y}, b);
      },
      Geometry::plane_strain);
  input.materials[0].parameters = {{"youngs_modulus", kModulus}, {"poissons_ratio", 0.0}};
  input.materials[0].unit_weight = g;
  input.supports = {held_across(patch.row(0), b), held_across(patch.column(0), b + 90.0)};
  input.stages = {{.gravity = {0.0, -1.0}}};
  const WholeRun run = complete(input);
  const double scale = across * h * h / kModulus;
  for (std::size_t i = 0; i < input.nodes.size(); ++i) {
    const Vector2 at = turn(input.nodes[i], -b), u = turn(run.u(static_cast<int>(i) + 1), -b);
    EXPECT_NEAR(u.x(), -along * (l * at.x() - 0.5 * at.x() * at.x()) / kModulus, 1e-13 * scale);
    EXPECT_NEAR(u.y(), -across * (h * at.y() - 0.5 * at.y() * at.y()) / kModulus, 1e-13 * scale);
  }
  Vector2 base = Vector2::Zero(), stop = Vector2::Zero();
  for (const int n : patch.row(0)) base += run.reaction(n);
  for (const int n : patch.column(0)) stop += run.reaction(n);
  stop -= run.reaction(patch.node(0, 0));  // the corner belongs to both
  base -= run.reaction(patch.node(0, 0));
  const Vector2 whole = base + stop + run.reaction(patch.node(0, 0));
  EXPECT_NEAR(whole.x(), 0.0, 1e-11);
  EXPECT_NEAR(whole.y(), g * h * l, 1e-11);
  EXPECT_NEAR(base.normalized().dot(turn({1.0, 0.0}, b)), 0.0, 1e-12);  // smooth
  EXPECT_NEAR(stop.normalized().dot(turn({0.0, 1.0}, b)), 0.0, 1e-12);
}

// Radial displacement of Lame's cylinder (plane strain) and sphere, a < r < b, under internal pressure p.
double lame(Geometry geometry, double r, double a, double b, double p) {
  const double e = kModulus, v = kPoisson;
  if (geometry == Geometry::plane_strain)
    return (1.0 + v) * p * a * a / (e * (b * b - a * a)) * ((1.0 - 2.0 * v) * r + b * b / r);
  return p * a * a * a / (e * (b * b * b - a * a * a)) *
         ((1.0 - 2.0 * v) * r + (1.0 + v) * b * b * b / (2.0 * r * r));
}

// A wedge of the cylinder, or of the sphere below a cone, from the x axis to `angle`; its sides are held across.
ModelInput wedge(Geometry geometry, int n, double angle) {
  const Patch patch{2 * n, n};
  ModelInput input = patch.input([&](double x, double y) { return turn({1.0 + x, 0.0}, angle * y); }, geometry);
  input.supports = {held_across(patch.row(0), 0.0), held_across(patch.row(2 * n), angle)};
  StageInput stage;
  stage.pressures = {{.elements = patch.elements_of_column(0), .edge = 4, .normal1 = 10.0, .normal2 = 10.0}};
  input.stages = {stage};
  return input;
}

double wedge_error(const WholeRun& run, Geometry geometry, double angle) {
  double error = 0.0, size = 0.0;
  for (int node = 0; node < run.model->mesh.nodes(); ++node) {
    const Vector2 x = run.model->mesh.x.col(node), u = run.last().u.segment<2>(DofMap::displacement(node));
    const Vector2 exact = lame(geometry, x.norm(), 1.0, 2.0, 10.0) * x.normalized();
    error += (u - exact).squaredNorm();
    size += exact.squaredNorm();
    if (std::abs(std::atan2(x.y(), x.x()) / kRadiansPerDegree - angle) < 1e-9) {
      EXPECT_NEAR(turn(u, -angle).y(), 0.0, 1e-16) << node;  // one product of the direction
    }
  }
  return std::sqrt(error / size);
}

// Order 3 of quadratic elements; 0.3 for coarse meshes.
TEST(TurnedSupports, WedgesOfACylinderAndASphereConvergeToLame) {
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
    const double angle = 30.0;
    const double coarse = wedge_error(complete(wedge(geometry, 2, angle)), geometry, angle);
    const double fine = wedge_error(complete(wedge(geometry, 4, angle)), geometry, angle);
    EXPECT_GT(std::log2(coarse / fine), 2.7);
    EXPECT_LT(fine, 1e-4);
  }
}

// Made nodes of a side that is held across are held across, so that a refined model is one of that mesh.
TEST(TurnedSupports, NodesOfAFinerMeshInheritThem) {
  const double angle = 30.0;
  const WholeRun coarse = complete(wedge(Geometry::plane_strain, 2, angle));
  BuildOptions finer;
  finer.refine = 1;
  const WholeRun fine = complete(wedge(Geometry::plane_strain, 2, angle), finer);
  EXPECT_GT(fine.model->mesh.nodes(), 3 * coarse.model->mesh.nodes());
  const double before = wedge_error(coarse, Geometry::plane_strain, angle);
  EXPECT_LT(wedge_error(fine, Geometry::plane_strain, angle), 0.5 * before);  // places of nodes stay on chords
  EXPECT_EQ(fine.model->turned_fixities.size(), 17u);
}

// A linear body whose load is controlled by the displacement of a node that slides: the share of the load is known.
TEST(TurnedSupports, AControlledLoadMovesANodeThatSlides) {
  ModelInput input = wedge(Geometry::plane_strain, 2, 30.0);
  const WholeRun whole = complete(input);
  const int node = Patch{4, 2}.row(4).front();
  const double u = whole.u(node).x();
  input.stages[0].load_control = std::to_string(node) + " x " + std::to_string(0.01);
  const WholeRun part = complete(input);
  EXPECT_NEAR(part.u(node).x(), 0.01, 1e-14);
  const Eigen::VectorXd expected = 0.01 / u * whole.last().u;
  EXPECT_LT((part.last().u - expected).norm(), 1e-10 * expected.norm());
}

TEST(TurnedSupports, DecksAndModelFilesKeepThem) {
  const ModelInput input = [] {
    ModelInput one = wedge(Geometry::plane_strain, 2, 120.0);
    one.stages.push_back({.supports = {held_along({1, 2}, 12.5, 0.001),
                                       {.nodes = {5}, .x = FixityCode::released, .angle = 12.5}}});
    for (Vector2& x : one.nodes) x = (1e12 * x).array().round().matrix() / 1e12;  // digits of a card
    return one;
  }();
  const Model model = build_model(input, turned_bench().catalogue());
  Diagnostics notes;
  const Catalogue& all = turned_bench().catalogue();
  const std::string deck = sage1_text(model, notes);
  for (const Diagnostic& note : notes.list()) ADD_FAILURE() << to_string(note);
  const Model again = build_model(read_deck_text(deck, "written", load_layout("sage1_wide")), all);
  EXPECT_EQ(fingerprint(again), fingerprint(model));
  ModelInput other = input;
  other.supports[1].angle = 121.0;
  EXPECT_NE(fingerprint(build_model(other, all)), fingerprint(model));
}

std::string refusal(const ModelInput& input, const BuildOptions& options = {}) {
  try {
    build_model(input, turned_bench().catalogue(), options);
  } catch (const InputError& e) {
    std::string all;
    for (const Diagnostic& d : e.diagnostics().list())
      if (d.severity == Severity::error) all += to_string(d) + "\n";
    return all;
  }
  return "taken";
}

TEST(TurnedSupports, WhatCannotBeIsRejected) {
  const ModelInput good = wedge(Geometry::plane_strain, 2, 30.0);
  const auto with = [&](const std::function<void(ModelInput&)>& change) {
    ModelInput input = good;
    change(input);
    return refusal(input);
  };
  EXPECT_NE(with([](ModelInput& m) { m.supports[1].angle = 400.0; }).find("S367"), std::string::npos);
  EXPECT_NE(with([](ModelInput& m) {
              m.stages[0].supports = {held_across({3}, 10.0, 0.1)};
              m.stages[0].supports[0].history = {{1.0, 1.0}};
            }).find("S367"),
            std::string::npos);
  // Node 1 is held across the x axis, along a line at 20 and along one at 50 degrees: no displacement has 0, 0.1 and 0.1.
  EXPECT_NE(with([](ModelInput& m) {
              m.stages[0].supports = {held_along({1}, 20.0, 0.1), held_along({1}, 50.0, 0.1)};
            }).find("S368"),
            std::string::npos);
  EXPECT_EQ(with([](ModelInput& m) { m.stages[0].supports = {held_along({1}, 20.0, 0.1)}; }), "taken");
  EXPECT_NE(with([](ModelInput& m) { m.supports.erase(m.supports.begin()); }).find("S323"), std::string::npos);
  BuildOptions coarser;
  coarser.coarsen = true;
  EXPECT_NE(refusal(good, coarser).find("S369"), std::string::npos);
}

// Where two turned directions are held, the node has the one displacement with both values.
TEST(TurnedSupports, TwoDirectionsPlaceANode) {
  ModelInput input = wedge(Geometry::plane_strain, 2, 30.0);
  const int node = Patch{4, 2}.node(8, 2);
  input.stages[0].supports = {held_along({node}, 20.0, 0.01), held_along({node}, 50.0, 0.005)};
  const WholeRun run = complete(input);
  EXPECT_NEAR(turn(run.u(node), -20.0).x(), 0.01, 1e-15);
  EXPECT_NEAR(turn(run.u(node), -50.0).x(), 0.005, 1e-15);
}

// ---- Ties

SupportInput held(std::vector<int> nodes, bool x, bool y) {
  const auto code = [](bool is_held) { return is_held ? FixityCode::fixed : FixityCode::unchanged; };
  return {.nodes = std::move(nodes), .x = code(x), .y = code(y)};
}

BuildOptions refined(int times) {
  BuildOptions options;
  options.refine = times;
  return options;
}

// A layer of height h between sides that are tied to each other goes on for ever: under a pressure p and a shear stress t
// on its surface u_x = t y / G and u_y = -p y / M, with the constrained modulus M.
TEST(Ties, SidesOfAPeriodicLayerMoveAlike) {
  const double h = 2.0, p = 10.0, t = 4.0, shear = kModulus / (2.0 * (1.0 + kPoisson));
  const double constrained = kModulus * (1.0 - kPoisson) / ((1.0 + kPoisson) * (1.0 - 2.0 * kPoisson));
  const Patch patch{2, 3};
  ModelInput input = patch.input(
      [&](double x, double y) { return Vector2(x + 0.1 * std::sin(7.0 * x) * std::sin(3.14 * x) * y, h * y); },
      Geometry::plane_strain);
  for (int j = 0; j <= 2 * patch.rows; ++j) input.nodes[patch.node(4, j) - 1].x() = 1.0;
  input.supports = {held(patch.row(0), true, true)};
  for (int j = 0; j <= 2 * patch.rows; ++j) input.ties.push_back({{patch.node(4, j)}, patch.node(0, j)});
  StageInput stage;
  stage.pressures = {
      {.elements = patch.elements_of_row(2), .edge = 3, .normal1 = p, .normal2 = p, .shear1 = t, .shear2 = t}};
  input.stages = {stage};
  for (const int times : {0, 1}) {
    const WholeRun run = complete(input, refined(times));
    double sign = 0.0;  // of shear, which is along the edge
    for (int node = 0; node < run.model->mesh.nodes(); ++node) {
      const double y = run.model->mesh.x(1, node);
      const Vector2 u = run.last().u.segment<2>(DofMap::displacement(node));
      if (sign == 0.0 && y > 0.0) sign = u.x() > 0.0 ? 1.0 : -1.0;
      EXPECT_NEAR(u.x(), sign * t * y / shear, 1e-13);
      EXPECT_NEAR(u.y(), -p * y / constrained, 1e-13);
    }
  }
}

// A rigid smooth cap on two columns of moduli E and 3 E, nu = 0: they share the force as springs do.  In axisymmetry a rigid
// disc on one.  All nodes of the cap are tied to the first.
TEST(Ties, ARigidCapSettlesEvenly) {
  const double h = 2.0, force = -12.0;
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
    const bool plane = geometry == Geometry::plane_strain;
    const Patch patch{2, 2};
    ModelInput input = patch.input([&](double x, double y) { return Vector2(x, h * y); }, geometry);
    input.materials[0].parameters = {{"youngs_modulus", kModulus}, {"poissons_ratio", 0.0}};
    if (plane) {
      input.materials.push_back(input.materials[0]);
      input.materials[1].parameters = {{"youngs_modulus", 3.0 * kModulus}, {"poissons_ratio", 0.0}};
      input.groups.push_back(input.groups[0]);
      input.groups[1].material = 2;
      input.groups[0].elements = {input.groups[0].elements[0], input.groups[0].elements[2]};
      input.groups[1].elements = {input.groups[1].elements[1], input.groups[1].elements[3]};
    }
    input.supports = {held(patch.row(0), true, true)};
    input.supports.push_back(held(patch.column(0), true, false));
    const std::vector<int> top = patch.row(4);
    input.ties = {{.nodes = top, .to = top[1], .x = false}};
    input.stages = {
        {.loads = {{.nodes = {top[0]}, .y = 0.25 * force}, {.nodes = {top[2]}, .y = 0.75 * force}}}};
    const double stiffness = plane ? (0.5 * kModulus + 1.5 * kModulus) / h : kPi * kModulus / h;
    for (const int times : {0, 1}) {
      const WholeRun run = complete(input, refined(times));
      for (int node = 0; node < run.model->mesh.nodes(); ++node) {
        const double y = run.model->mesh.x(1, node);
        const Vector2 u = run.last().u.segment<2>(DofMap::displacement(node));
        EXPECT_NEAR(u.y(), force / stiffness * y / h, 1e-13);
        EXPECT_NEAR(u.x(), 0.0, 1e-14);
      }
    }
    // Moved at one node, the cap takes the others along, and the sum of reactions is the same force.
    input.stages[0].loads.clear();
    input.stages[0].supports = {held({top[3]}, false, true)};
    input.stages[0].supports[0].y_value = force / stiffness;
    const WholeRun moved = complete(input);
    EXPECT_NEAR(moved.reaction(moved.last(), top, 1), force, 1e-10);
    for (const int node : top) EXPECT_NEAR(moved.u(node).y(), force / stiffness, 1e-15);
  }
}

// A table of time moves the tied nodes as it moves both of them without a tie, and a support of a node that is in no active
// element holds none.
TEST(Ties, FollowTablesOfTimeAndActiveGroups) {
  const Patch patch{2, 2};
  ModelInput input = patch.input([](double x, double y) { return Vector2(x, y); }, Geometry::plane_strain);
  const std::vector<int> top = patch.row(4);
  input.supports = {held(patch.row(0), true, true)};
  StageInput stage{.increments = 4};
  stage.duration = 2.0;
  stage.supports = {held({top[1]}, false, true)};
  stage.supports[0].y_value = -0.01;
  stage.supports[0].history = {{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.25}};
  input.stages = {stage};
  input.ties = {{.nodes = top, .to = top[0], .x = false}};
  const WholeRun tied = complete(input);
  input.ties.clear();
  input.stages[0].supports[0].nodes = top;
  const WholeRun all = complete(input);
  ASSERT_EQ(tied.increments.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT((tied.increments[k].u - all.increments[k].u).lpNorm<Eigen::Infinity>(), 1e-14);

  ModelInput born = patch.input([](double x, double y) { return Vector2(x, y); }, Geometry::plane_strain);
  born.groups.push_back(born.groups[0]);
  born.groups[0].elements = {born.groups[0].elements[0], born.groups[0].elements[1]};
  born.groups[1].elements = {born.groups[1].elements[2], born.groups[1].elements[3]};
  born.supports = {held(patch.row(0), true, true)};
  born.ties = {{.nodes = patch.row(2), .to = top[0], .x = false}};
  StageInput load, later;
  load.loads = {{.nodes = {patch.node(2, 2)}, .y = -1.0}};
  later.births = {2};
  born.stages = {load, later};
  const WholeRun without = complete(born);
  born.supports.push_back(held({top[0]}, false, true));
  const WholeRun with = complete(born);
  const int node = DofMap::displacement(without.index(patch.node(2, 2)));
  EXPECT_LT(without.increments[0].u[node + 1], -1e-5);
  EXPECT_NEAR(with.increments[0].u[node + 1], without.increments[0].u[node + 1], 1e-15);
}

// Sides of one element each, tied in mixed directions, and all corners of a cell tied to one: the new nodes of opposite sides
// move alike.  Two tied nodes alone are not a cap.
TEST(Ties, NewNodesOfOppositeSidesAreTied) {
  const Patch patch{1, 2};
  ModelInput input = patch.input([](double x, double y) { return Vector2(x, y); }, Geometry::plane_strain);
  input.supports = {held(patch.row(0), true, true)};
  for (int j = 0; j <= 4; ++j) {
    const int left = patch.node(0, j), right = patch.node(2, j);
    input.ties.push_back(j % 2 == 0 ? TieInput{{left}, right} : TieInput{{right}, left});
  }
  input.stages = {{.loads = {{.nodes = {patch.node(1, 4)}, .y = -1.0}}}};
  const WholeRun run = complete(input, refined(1));
  const auto u_at = [&](const Vector2& place) {
    for (int node = 0; node < run.model->mesh.nodes(); ++node)
      if ((Vector2(run.model->mesh.x.col(node)) - place).norm() < 1e-9)
        return Vector2(run.last().u.segment<2>(DofMap::displacement(node)));
    ADD_FAILURE() << "no node there";
    return Vector2(0.0, 0.0);
  };
  for (const double y : {0.125, 0.375, 0.5, 0.625, 0.875, 1.0})
    EXPECT_LT((u_at({0.0, y}) - u_at({1.0, y})).norm(), 1e-15) << y;
  EXPECT_GT(std::abs(u_at({0.5, 1.0}).y() - u_at({0.0, 1.0}).y()), 1e-5) << "the top is not rigid";
}

TEST(Ties, AreKeptInDecksAndRejectedByName) {
  const Patch patch{2, 2};
  ModelInput good = patch.input([](double x, double y) { return Vector2(x, y); }, Geometry::plane_strain);
  good.supports = {held(patch.row(0), true, true)};
  good.ties = {{.nodes = patch.row(4), .to = patch.node(0, 4), .x = false}};
  good.stages = {{.loads = {{.nodes = {patch.node(0, 4)}, .y = -1.0}}}};
  const Catalogue& all = turned_bench().catalogue();
  const Model model = build_model(good, all);
  EXPECT_EQ(model.ties.size(), 4u);
  Diagnostics notes;
  const Model again =
      build_model(read_deck_text(sage1_text(model, notes), "written", load_layout("sage1_wide")), all);
  for (const Diagnostic& note : notes.list()) ADD_FAILURE() << to_string(note);
  EXPECT_EQ(fingerprint(again), fingerprint(model));
  const auto with = [&](const std::function<void(ModelInput&)>& change) {
    ModelInput input = good;
    change(input);
    return refusal(input);
  };
  EXPECT_NE(with([](ModelInput& m) { m.ties[0].y = false; }).find("S370"), std::string::npos);
  EXPECT_NE(
      with([&](ModelInput& m) { m.supports.push_back(held_across({patch.node(2, 4)}, 30.0)); }).find("S370"),
      std::string::npos);
  EXPECT_NE(with([&](ModelInput& m) {
              m.stages[0].supports = {held_across({patch.node(1, 4)}, 0.0, 0.1),
                                      held_across({patch.node(3, 4)}, 0.0, 0.2)};
            }).find("S370"),
            std::string::npos);
  EXPECT_NE(with([](ModelInput& m) { m.ties[0].to = 999; }), "taken");
}

}  // namespace
}  // namespace sage
