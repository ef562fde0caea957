// Triangles, their edges, and longest-edge bisection.
#include "sage/bounds/domain.hpp"

#include <gtest/gtest.h>

#include "sage/bounds/programs.hpp"
#include "tests/unit/bounds/meshes.hpp"

namespace sage::bounds {
namespace {

double area_of(const Domain& d) {
  double sum = 0.0;
  for (const Triangle& t : d.triangles) {
    EXPECT_GT(d.area(t), 0.0);
    sum += d.area(t);
  }
  return sum;
}

// Every edge has two triangles, or lies on the rim of the square.
void expect_no_hanging_node(const Domain& d, double side) {
  double rim = 0.0;
  for (const Edge& edge : edges_of(d).all)
    if (edge.triangle[1] < 0) rim += (d.x[edge.a] - d.x[edge.b]).norm();
  EXPECT_NEAR(rim, 4.0 * side, 1e-12);
}

TEST(Domain, RefinesWithoutHangingNodes) {
  Domain d = block({0.0, 1.0, 2.0}, {0.0, 1.0, 2.0});
  along_level(d, 2.0, 0.0, 2.0, [](Boundary& b) {
    b.live = {Vector2(0.0, -2.0 * 0.0 - 1.0), Vector2(0.0, -3.0)};
  });
  const std::size_t before = d.boundary.size();
  for (int turn = 0; turn < 6; ++turn) {
    std::vector<char> marked(d.triangles.size(), 0);
    for (std::size_t t = 0; t < marked.size(); ++t)
      for (const int n : d.triangles[t].node) marked[t] |= d.x[n].norm() < 1e-12;
    refine(d, marked);
  }
  EXPECT_NEAR(area_of(d), 4.0, 1e-12);
  expect_no_hanging_node(d, 2.0);
  EXPECT_GE(d.triangles.size(), 24u);
  EXPECT_GT(d.boundary.size(), before);
  // Near the corner the triangles are smaller by 2^6 in area at least.
  double least = 1.0;
  for (const Triangle& t : d.triangles) least = std::min(least, d.area(t));
  EXPECT_LT(least, 0.25 / 60.0);
}

// A traction that is linear along a side stays what it is.
TEST(Domain, DividesTheTractionsOfASide) {
  Domain d = block({0.0, 1.0}, {0.0, 1.0});
  along_level(d, 1.0, 0.0, 1.0, [&](Boundary& b) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double x = d.x[i == 0 ? b.a : b.b].x();
      b.live[i] = Vector2(1.0 + x, 0.0);
    }
  });
  for (int turn = 0; turn < 4; ++turn) refine(d, std::vector<char>(d.triangles.size(), 1));
  int found = 0;
  for (const Boundary& b : d.boundary)
    for (std::size_t i = 0; i < 2; ++i) {
      if (b.live[i].isZero(0.0)) continue;
      EXPECT_NEAR(b.live[i].x(), 1.0 + d.x[i == 0 ? b.a : b.b].x(), 1e-14);
      ++found;
    }
  EXPECT_EQ(found, 8);
}

// Both sides of a joint are divided at the same places.
TEST(Domain, DividesBothSidesOfAJoint) {
  Domain d = block({0.0, 1.0}, {0.0, 1.0});
  const Domain upper = block({0.0, 1.0}, {1.0, 2.0});
  const int shift = static_cast<int>(d.x.size());
  d.x.insert(d.x.end(), upper.x.begin(), upper.x.end());
  for (Triangle t : upper.triangles) {
    for (int& n : t.node) n += shift;
    d.triangles.push_back(t);
  }
  d.joints.push_back({.first = {3, 2}, .second = {shift, shift + 1}, .strength = {}, .lower_cohesion = 0.0});
  ASSERT_EQ(d.x[3], d.x[shift]);
  for (int turn = 0; turn < 3; ++turn) refine(d, std::vector<char>(d.triangles.size(), 1));
  double length = 0.0;
  for (const Joint& joint : d.joints) {
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(d.x[joint.first[i]], d.x[joint.second[i]]);
    length += (d.x[joint.first[0]] - d.x[joint.first[1]]).norm();
  }
  EXPECT_NEAR(length, 1.0, 1e-14);
  EXPECT_GT(d.joints.size(), 1u);
}

// The line between the nodes opposite to an edge meets it in the new node.
TEST(Domain, DividesEdgesWhereDiagonalsCross) {
  Domain d;
  d.x = {{0.0, 0.0}, {2.0, 0.0}, {2.1, 1.2}, {0.0, 1.0}};
  d.triangles = {{{0, 1, 2}, 0, 0}, {{0, 2, 3}, 0, 0}};
  refine(d, {1, 0});
  ASSERT_EQ(d.x.size(), 5u);
  const Vector2 a = d.x[4] - d.x[1], b = d.x[3] - d.x[1], c = d.x[4] - d.x[0], e = d.x[2] - d.x[0];
  EXPECT_NEAR(a.x() * b.y() - a.y() * b.x(), 0.0, 1e-14);
  EXPECT_NEAR(c.x() * e.y() - c.y() * e.x(), 0.0, 1e-14);
}

// One of the equations of a node whose edges lie on two lines, and none of a node whose edges do not.
TEST(Domain, FindsEquationsThatDependOnOthers) {
  const auto dependent = [](double kink) {
    Domain d = block({0.0, 1.0, 2.0}, {0.0, 1.0});
    d.soils = {{}};
    d.x.back().x() += kink;  // the middle of the last cell
    return lower_program(d, edges_of(d), Quantity::load).program.dependent.size();
  };
  EXPECT_EQ(dependent(0.0), 2u);
  EXPECT_EQ(dependent(1e-3), 1u);
}

}  // namespace
}  // namespace sage::bounds
