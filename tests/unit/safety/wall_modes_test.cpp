// Smooth walls in ground, of which soil and structure are divided together, against hand calculations with Rankine's
// pressures: a wall that turns near its toe, one with a plastic hinge, and one whose anchor yields.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/safety/safety.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/soil_structure.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/support/sanitized.hpp"

namespace sage::safety {
namespace {

// Depths z from the top of the wall.  Forces for each unit of width, positive towards the excavation.
struct HandWall {
  double weight = 18.0, c = 2.0, phi = 30.0;  // of the ground, at F = 1
  double dug = 4.0, length = 10.0;            // depth of the cut, of the toe
  double moment = 0.0;                        // M_p at F = 1
  double anchor = 0.0, anchor_depth = 0.0;    // force that it carries at F = 1

  // Rankine: sigma_a = K_a gamma z - 2 c sqrt(K_a), not below zero, and sigma_p = gamma z/K_a + 2 c/sqrt(K_a), with c/F and
  // tan(phi)/F.
  double active(double z, double F) const {
    const double K = coefficient(F);
    return z > 0.0 ? std::max(0.0, K * weight * z - 2.0 * c / F * std::sqrt(K)) : 0.0;
  }
  double passive(double z, double F) const {
    const double K = coefficient(F);
    return z > 0.0 ? weight * z / K + 2.0 * c / F / std::sqrt(K) : 0.0;
  }
  double coefficient(double F) const {
    const double s = std::sin(std::atan(std::tan(phi * kRadiansPerDegree) / F));
    return (1.0 - s) / (1.0 + s);
  }
  // What both sides put on the wall where it moves towards the excavation, and where it moves into the ground.
  double forward(double z, double F) const { return active(z, F) - passive(z - dug, F); }
  double backward(double z, double F) const { return passive(z, F) - active(z - dug, F); }
};

double integral(const std::function<double(double)>& f, double from, double to) {
  constexpr int kParts = 2000;
  const double h = (to - from) / kParts;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) sum += f(from + (i + 0.5) * h) * h;
  return sum;
}

// Where f falls through zero.
double falls_through_zero(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
double rises_through_zero(const std::function<double(double)>& f, double low, double high) {
  return falls_through_zero([&](double x) { return -f(x); }, low, high);
}

// The rigid wall turns about a depth near its toe, above which it moves forward.  That depth is where the forces balance,
//   integral of forward from 0 to it + integral of backward from it to the toe - T/F = 0,
// and F is the factor at which the moments about the top balance with it.  Without an anchor (T = 0) this is the
// cantilever of every textbook; with one it is the wall whose anchor yields.
double depth_of_turning(const HandWall& w, double F) {
  return falls_through_zero(
      [&](double depth) {
        return integral([&](double z) { return w.forward(z, F); }, 0.0, depth) +
               integral([&](double z) { return w.backward(z, F); }, depth, w.length) - w.anchor / F;
      },
      w.dug, w.length);
}
// About the top, towards the ground positive.
double moment_of_turning(const HandWall& w, double F) {
  const double depth = depth_of_turning(w, F);
  return w.anchor_depth * w.anchor / F - integral([&](double z) { return z * w.forward(z, F); }, 0.0, depth) -
         integral([&](double z) { return z * w.backward(z, F); }, depth, w.length);
}
double factor_of_turning(const HandWall& w, double low, double high) {
  return rises_through_zero([&](double F) { return moment_of_turning(w, F); }, low, high);
}

// The hinge forms where the shear force vanishes, at h: integral of forward from 0 to h = 0.  There the moment of the
// pressures above is M_p/F: integral of (h - z) forward = M_p/F.
double factor_of_hinge(const HandWall& w, double low, double high) {
  return rises_through_zero(
      [&](double F) {
        const auto forward = [&](double z) { return w.forward(z, F); };
        const double h =
            falls_through_zero([&](double z) { return integral(forward, 0.0, z); }, w.dug, w.length);
        return integral([&](double z) { return (h - z) * forward(z); }, 0.0, h) - w.moment / F;
      },
      low, high);
}

scenes::WallInGround scene_of(const HandWall& w) {
  scenes::WallInGround s;
  s.half_width = 10.0;
  s.inside = 10;
  s.outside = 10;
  s.far = 24.0;
  s.cohesion = w.c;
  s.friction = w.phi;
  s.adhesion = s.wall_friction = 0.0;
  s.goes_around = false;
  s.weight = w.weight;
  s.toe = static_cast<int>(w.length);
  s.depth = s.toe + 6;
  s.levels = {static_cast<int>(w.dug) / 2, static_cast<int>(w.dug)};
  s.tip_spring = 100.0;
  s.moment_strength = w.moment;
  if (w.anchor > 0.0) {
    s.spacing = 2.5;
    s.strut_stiffness = 1e5;
    s.anchor_strength = w.anchor * s.spacing;
    s.struts = {{static_cast<int>(w.anchor_depth), 3, 0, 0.0, true}};
  }
  return s;
}

// What is needed of a search once its model is gone.
struct Answer {
  Safety found;
  ModelPart fails = ModelPart::soil;  // first part that is named
  double share = 0.0;
};

Answer find_factor(const scenes::DeckWriter& deck, std::vector<ModelPart> reduce, double start, int refine) {
  Catalogue catalogue;
  register_elements(catalogue);
  register_materials(catalogue);
  register_solvers(catalogue);
  const scenes::Workbench bench(std::move(catalogue), choose_solver);
  BuildOptions build;
  build.refine = test::kSanitized ? 0 : refine;
  Model model = bench.build(deck.text(), build);
  Options options;
  options.reduce = std::move(reduce);
  options.limits.start = start;
  options.limits.tolerance = test::kSanitized ? 0.05 : 0.01;
  Answer answer{find_safety(model, bench.catalogue(), bench.settings(), options)};
  answer.found.mechanism.reset();  // it refers to the model
  if (answer.found.failing.empty()) return answer;
  const Failing& first = answer.found.failing.front();
  answer.fails = part_of(model.groups[first.group]).value();
  answer.share = first.share;
  return answer;
}

// The middle of the bracket lies within this part of the hand calculation.
void expect_factor(const Safety& found, double factor, double tolerance) {
  ASSERT_TRUE(found.complete()) << found.incomplete;
  if (test::kSanitized) return;  // coarse mesh, wide bracket
  EXPECT_NEAR(0.5 * (*found.lower + *found.upper), factor, tolerance * factor);
}

// Finite elements lie above Rankine's pressures, a statically admissible field: behind the toe the ground carries more.
TEST(WallModes, ToeOfACantilever) {
  HandWall wall;
  wall.c = 5.0;
  wall.length = 8.0;
  scenes::WallInGround scene = scene_of(wall);
  scene.dilation = wall.phi;
  const Answer answer = find_factor(scene.deck(), {ModelPart::soil}, 1.2, 1);
  expect_factor(answer.found, factor_of_turning(wall, 1.0, 1.6), 0.05);
  EXPECT_EQ(answer.fails, ModelPart::soil);
  EXPECT_GT(answer.share, 0.999);
}

TEST(WallModes, HingeOfACantilever) {
  HandWall wall;
  wall.moment = 150.0;
  const Answer answer = find_factor(scene_of(wall).deck(), {ModelPart::soil, ModelPart::walls}, 1.0, 1);
  expect_factor(answer.found, factor_of_hinge(wall, 0.9, 1.6), 0.03);
  EXPECT_EQ(answer.fails, ModelPart::walls);
  EXPECT_GT(answer.share, 0.1);
}

// Of associated flow the shares are known too.  The wall moves by (t - z) omega above the depth t about which it turns, so
// that the anchor dissipates T/F (t - z_a) omega, and the ground what c does in Rankine's pressures: 2 c/F sqrt(K_a) behind
// the wall below the depth to which it stands by itself, 2 c/F/sqrt(K_a) in front of it.
TEST(WallModes, AnchorThatYields) {
  HandWall wall;
  wall.dug = 6.0;
  wall.anchor = 70.0;
  wall.anchor_depth = 1.0;
  scenes::WallInGround scene = scene_of(wall);
  scene.dilation = wall.phi;
  const Answer answer = find_factor(scene.deck(), {ModelPart::soil, ModelPart::anchors}, 1.0, 0);
  const double F = factor_of_turning(wall, 0.9, 1.35);
  expect_factor(answer.found, F, 0.03);
  EXPECT_EQ(answer.fails, ModelPart::anchors);
  const double t = depth_of_turning(wall, F), root = std::sqrt(wall.coefficient(F)), c = wall.c / F;
  const auto square = [](double x) { return x * x; };
  const double anchor = wall.anchor / F * (t - wall.anchor_depth);
  const double ground = c * (root * square(t - 2.0 * c / root / wall.weight) + square(t - wall.dug) / root);
  EXPECT_NEAR(answer.share, anchor / (anchor + ground), test::kSanitized ? 0.1 : 0.03);
}

// Without ground a frame's own motion is the collapse: a cantilever with a force P at its end has F = M_p/(P L).
TEST(WallModes, CantileverWithoutGround) {
  scenes::DeckWriter deck(1);
  deck.node(1, 0.0, 0.0);
  deck.node_row(5, 1, 4.0, 0.0);
  deck.material(1, 37, {1e6, 1e4, 0.0, 90.0});
  deck.group(1, 35, 1, 1, "beam");
  deck.elements_block(1, 1, {1, 2}, 4, 1, 1, 1);
  deck.fix(1, 1, 1);
  deck.fixities.push_back("    1    0    0    1    0" + std::string(20, ' ') + "rotation");
  deck.stage(2).load(5, 0.0, -15.0);
  const Answer answer = find_factor(deck, {ModelPart::walls}, 1.0, 0);
  ASSERT_TRUE(answer.found.complete()) << answer.found.incomplete;
  EXPECT_LE(*answer.found.lower, 1.5);
  EXPECT_GE(*answer.found.upper, 1.5);
  EXPECT_EQ(answer.fails, ModelPart::walls);
  EXPECT_NEAR(answer.share, 1.0, 1e-12);
}

// A bar of strength T every s metres under a force P for each unit of width: F = T/(s P).  The beam beside it, which could
// not carry more than 1.2 P, is not divided.
TEST(WallModes, OnlyWhatIsNamedIsDivided) {
  scenes::DeckWriter deck(1);
  deck.node(1, 0.0, 0.0);
  deck.node(2, 1.0, 0.0);
  deck.node(3, 2.0, 0.0);
  deck.material(1, 33, {1e5, 80.0, 0.0, 2.0}, 0.0, "tie");
  deck.material(2, 37, {1e6, 1e4, 30.0, 90.0}, 0.0, "beam");
  deck.group(1, 31, 0, 1, "tie");
  deck.group(2, 35, 1, 2, "beam");
  deck.element(1, 1, {1, 2});
  deck.element(2, 2, {2, 3});
  deck.fix(1, 1, 1);
  deck.fix(2, 0, 1);
  deck.fix(3, 0, 1);
  deck.stage(2).load(3, 25.0, 0.0);
  const Answer answer = find_factor(deck, {ModelPart::anchors}, 1.0, 0);
  ASSERT_TRUE(answer.found.complete()) << answer.found.incomplete;
  EXPECT_LE(*answer.found.lower, 1.6);
  EXPECT_GE(*answer.found.upper, 1.6);
  EXPECT_EQ(answer.fails, ModelPart::anchors);
  EXPECT_NEAR(answer.share, 1.0, 1e-12);
  EXPECT_EQ(answer.found.reduced, std::vector<std::string>{"1 tie (axial_plastic)"});
  EXPECT_EQ(answer.found.untouched, std::vector<std::string>{"2 beam (section_plastic): not asked for"});
}

}  // namespace
}  // namespace sage::safety
