// Bounds against closed forms: both must hold the exact value between them, and be as close as asked for.
#include "sage/bounds/bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sage/bounds/check.hpp"
#include "tests/unit/bounds/meshes.hpp"

namespace sage::bounds {
namespace {

constexpr double kPi = std::numbers::pi;

// Half of a strip footing of half width 1 that moves down, the axis at x = 0.
Domain strip(double width, double depth, int steps, const Soil& soil, bool rough) {
  Domain d = block(both_ways(graded(1.0, 0.0, steps / 2, 1.3), graded(1.0, width, steps, 1.3)), [&] {
    auto y = graded(0.0, -depth, steps, 1.3);
    return std::vector<double>(y.rbegin(), y.rend());
  }());
  d.soils = {soil};
  along_level(d, 0.0, 0.0, 1.0, [&](Boundary& b) {
    b.held = {rough, true};
    b.motion = {Vector2(0.0, -1.0), Vector2(0.0, -1.0)};
  });
  return d;
}

void expect_bracket(const Bounds& found, double exact, double gap) {
  ASSERT_TRUE(found.lower.value) << found.lower.reason;
  ASSERT_TRUE(found.upper.value) << found.upper.reason;
  EXPECT_LE(*found.lower.value, exact);
  EXPECT_GE(*found.upper.value, exact);
  EXPECT_LE(*found.relative_gap(), gap);
  EXPECT_LE(found.lower.residual, 1e-11);
  EXPECT_LE(found.upper.residual, 1e-11);
  EXPECT_LE(std::max(found.lower.margin, found.upper.margin), 2e-4);
}

Options up_to(int elements, Quantity quantity = Quantity::load) {
  Options options;
  options.quantity = quantity;
  options.elements = elements;
  options.gap = 1e-3;
  return options;
}

// 2 + pi (Prandtl); the half footing has width 1.
TEST(Bounds, StripOnClay) {
  const Bounds found = find_bounds(strip(4.0, 2.0, 4, {{1.0, 0.0}}, true), up_to(4300));
  expect_bracket(found, 2.0 + kPi, 0.008);
  const auto coarse = std::find_if(found.rounds.begin(), found.rounds.end(),
                                   [](const Round& round) { return round.triangles >= 1000; });
  ASSERT_TRUE(coarse->lower && coarse->upper);
  EXPECT_LE(*coarse->upper - *coarse->lower, 0.02 * (2.0 + kPi));
  // Meshes that grow by 1.4 have 3.5 times the triangles of the last.
  int triangles = 0;
  for (const Round& round : found.rounds) triangles += round.triangles;
  EXPECT_LE(triangles, 4 * found.rounds.back().triangles);
}

// (N_q - 1) cot(phi) = 30.1396 for phi = 30 without weight.
TEST(Bounds, StripOnWeightlessSand) {
  const Bounds found = find_bounds(strip(8.0, 6.0, 8, {{1.0, kPi / 6.0}}, true), up_to(1500));
  expect_bracket(found, 30.1396, 0.05);
  EXPECT_NEAR(0.5 * (*found.lower.value + *found.upper.value), 30.1396, 0.015 * 30.1396);
}

// N_q = 18.4011 for phi = 30. The surcharge acts on the footing too, whose force is that of the ground.
TEST(Bounds, SurchargeBesideAndOnAStrip) {
  Domain d = strip(8.0, 6.0, 8, {{0.0, kPi / 6.0}}, true);
  along_level(d, 0.0, 1.0, 8.0, [](Boundary& b) { b.fixed = {Vector2(0.0, -1.0), Vector2(0.0, -1.0)}; });
  for (Boundary& b : d.boundary)
    if (b.motion[0].y() != 0.0) b.fixed = {Vector2(0.0, -1.0), Vector2(0.0, -1.0)};
  expect_bracket(find_bounds(d, up_to(800)), 18.4011, 0.1);
}

// N_gamma of a smooth strip, 7.6530 (similarity solution); without cohesion the surface has no stress.
TEST(Bounds, WeightOfSandBelowASmoothStrip) {
  expect_bracket(find_bounds(strip(4.0, 2.0, 6, {{0.0, kPi / 6.0}, Vector2(0.0, -1.0)}, false), up_to(3000)),
                 7.6530, 0.05);
}

Domain vertical_cut(int cells, const Soil& soil) {
  std::vector<double> X, Y;
  for (int i = 0; i <= 3 * cells; ++i) X.push_back(-1.0 + static_cast<double>(i) / cells);
  for (int i = 0; i <= 2 * cells; ++i) Y.push_back(-1.0 + static_cast<double>(i) / cells);
  Domain d = block(X, Y, [](double x, double y) { return x > 0.0 || y < 0.0; });
  d.soils = {soil};
  return d;
}

// gamma H / c between 3.775 and 3.778 (Pastor, Thai & Francescato 2000).
TEST(Bounds, VerticalCut) {
  Soil soil{{1.0, 0.0}};
  soil.weight_live = Vector2(0.0, -1.0);
  expect_bracket(find_bounds(vertical_cut(3, soil), up_to(1000)), 3.7765, 0.02);
}

// The factor of safety of the same cut: strength and weight change places.
TEST(Bounds, FactorOfSafetyOfAVerticalCut) {
  Soil soil{{1.0, 0.0}};
  soil.weight_fixed = Vector2(0.0, -2.0);
  expect_bracket(find_bounds(vertical_cut(3, soil), up_to(400, Quantity::strength)), 3.7765 / 2.0, 0.04);
}

// Lengths and stresses in other units, by 2^20 each.
TEST(Bounds, DoNotDependOnUnits) {
  Soil soil{{1.0, 0.3}};
  soil.weight_live = Vector2(0.0, -1.0);
  const Domain d = vertical_cut(2, soil);
  Domain other = d;
  for (Vector2& x : other.x) x *= 0x1p-20;
  other.soils[0].strength.cohesion = 0x1p20;
  other.soils[0].weight_live *= 0x1p40;
  const Bounds a = find_bounds(d, up_to(0)), b = find_bounds(other, up_to(0));
  ASSERT_TRUE(a.lower.value && a.upper.value) << a.lower.reason << a.upper.reason;
  ASSERT_TRUE(b.lower.value && b.upper.value) << b.lower.reason << b.upper.reason;
  EXPECT_NEAR(*a.lower.value, *b.lower.value, 1e-4 * *a.lower.value);
  EXPECT_NEAR(*a.upper.value, *b.upper.value, 1e-4 * *a.upper.value);
}

// A block on an inclined joint slides at F = (c L + W cos(b) tan(phi)) / (W sin(b)), which the upper field finds.
TEST(Bounds, BlockOnAJoint) {
  Domain d = block({0.0, 1.0}, {0.0, 1.0});
  const Domain above = block({0.0, 1.0}, {1.0, 1.5});
  const int shift = static_cast<int>(d.x.size());
  d.x.insert(d.x.end(), above.x.begin(), above.x.end());
  for (Triangle t : above.triangles) {
    for (int& n : t.node) n += shift;
    d.triangles.push_back(t);
  }
  const double slope = 0.3, phi = 0.4, weight = 10.0, W = 0.5 * weight;
  d.joints.push_back(
      {.first = {3, 2}, .second = {shift, shift + 1}, .strength = {0.2, phi}, .lower_cohesion = 0.2});
  d.soils = {{{20.0, 0.5}, weight * Vector2(-std::sin(slope), -std::cos(slope))}};
  for (Boundary& b : d.boundary) b.held = {true, true};
  const double exact = (0.2 + W * std::cos(slope) * std::tan(phi)) / (W * std::sin(slope));
  const Bounds found = find_bounds(d, up_to(0, Quantity::strength));
  ASSERT_TRUE(found.upper.value) << found.upper.reason;
  EXPECT_NEAR(*found.upper.value, exact, 5e-4 * exact);
  ASSERT_TRUE(found.lower.value) << found.lower.reason;
  EXPECT_LE(*found.lower.value, exact * (1.0 + 1e-9));
  EXPECT_GE(*found.lower.value, 0.9 * exact);
}

// A layer on a slope without cohesion: infinite slope, tan(phi) / tan(b), here with F below 1.
TEST(Bounds, SlopeOfSandThatFails) {
  Domain d = block({0.0, 1.0, 2.0, 3.0}, {0.0, 0.25, 0.5});
  const double slope = 0.7, phi = 0.6;
  d.soils = {{{0.0, phi}, 10.0 * Vector2(-std::sin(slope), -std::cos(slope))}};
  for (Boundary& b : d.boundary) b.held = {b.held[1], b.held[1]};
  const Bounds found = find_bounds(d, up_to(0, Quantity::strength));
  if (found.upper.value) {
    EXPECT_LE(*found.upper.value, 1.001 * std::tan(phi) / std::tan(slope));
  } else {
    EXPECT_FALSE(found.upper.reason.empty());
  }
  if (!found.lower.value) {
    EXPECT_FALSE(found.lower.reason.empty());
  }
}

// Fixed loads that fail alone leave no lower bound on what may be added, and a reason.
TEST(Bounds, SayWhyThereIsNone) {
  Soil soil{{1.0, 0.0}, Vector2(0.0, -10.0), Vector2(0.0, -1.0)};
  const Bounds found = find_bounds(vertical_cut(2, soil), up_to(0));
  if (found.lower.value) {
    EXPECT_LT(*found.lower.value, 0.0);
  } else {
    EXPECT_FALSE(found.lower.reason.empty());
  }
}

// A field that lacks 1e-8 of equilibrium, of the flow rule or of the strength does not pass.
TEST(Check, RejectsFieldsThatAreNearlyStrict) {
  const Domain d = vertical_cut(2, {{1.0, 0.0}, Vector2::Zero(), Vector2(0.0, -1.0)});
  const ConeProgram lower = lower_program(d, edges_of(d), Quantity::load).program;
  ConeOptions options;
  ConeSolution found = solve(lower, options);
  ASSERT_TRUE(check_stress(lower, found.sigma, found.tau).passed());
  EXPECT_FALSE(check_stress(lower, found.sigma, found.tau * (1.0 + 1e-8)).passed());
  // Equilibrium holds, with a load beyond what the ground carries: two fields of the same loads, apart by 1e3.
  EXPECT_FALSE(check_stress(lower, 1e3 * found.sigma, 1e3 * found.tau).passed());
  found.sigma(2, 0) += 1e-8 * found.sigma.cwiseAbs().maxCoeff();
  EXPECT_FALSE(check_stress(lower, found.sigma, found.tau).passed());

  const ConeProgram upper = upper_program(d, edges_of(d), Quantity::load).program;
  options.side = Side::dual;
  const ConeSolution moving = solve(upper, options);
  ASSERT_TRUE(check_velocity(upper, moving.u).passed());
  for (const Eigen::Index one : {Eigen::Index{0}, moving.u.size() / 2}) {
    Eigen::VectorXd u = moving.u;
    u[one] += 1e-8 * u.cwiseAbs().maxCoeff();
    EXPECT_FALSE(check_velocity(upper, u).passed());
  }
  EXPECT_FALSE(check_velocity(upper, -moving.u).passed());  // against the load
}

// Where the last mesh lacks a bound, those of the best mesh before are the answer, with all rounds.
TEST(Bounds, KeepWhatACoarserMeshProved) {
  Bounds best, last;
  best.lower.value = 1.0;
  best.upper.value = 1.2;
  best.rounds = {{10, 1.0, 1.2}};
  last.lower.value = 1.1;
  last.rounds = {{10, 1.0, 1.2}, {20, 1.1, {}}};
  const Bounds kept = proved(best, last);
  EXPECT_EQ(kept.lower.value, 1.0);
  EXPECT_EQ(kept.upper.value, 1.2);
  EXPECT_EQ(kept.rounds.size(), 2u);
  last.upper.value = 1.15;
  EXPECT_EQ(proved(best, last).upper.value, 1.15);
  last.upper.value.reset();
  EXPECT_EQ(proved({}, last).lower.value, 1.1);  // no mesh gave both: what the last one gave
}

// Drucker-Prager cones have the limit of Mohr-Coulomb in the plane: cone 3 for the same c and phi.
TEST(Strength, OfConesInThePlane) {
  const Strength same = Strength{2.0, 0.5, Yield::cone_plane_strain}.in_plane();
  EXPECT_NEAR(same.cohesion, 2.0, 1e-12);
  EXPECT_NEAR(same.friction, 0.5, 1e-12);
  const Strength tresca = Strength{2.0, 0.0, Yield::cone_compression}.in_plane();
  EXPECT_NEAR(tresca.cohesion, 4.0 / std::numbers::sqrt3, 1e-12);
  EXPECT_EQ(tresca.friction, 0.0);
  EXPECT_NEAR(Strength{}.in_plane().friction, 0.0, 0.0);
  EXPECT_GE((Strength{1.0, std::asin(0.6) + 1e-6, Yield::cone_compression}.in_plane().friction),
            0.5 * kPi - 1e-3);
}

}  // namespace
}  // namespace sage::bounds
