// Numbering by rule.  Expected numbers: the textbook's decks and figures (p51_1, p51_2, p61), counted by hand.
#include "sage/exchange/rectangle.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

double area(const Rectangle& mesh, int element) {
  std::vector<Vector2> at(static_cast<std::size_t>(mesh.nodes_per_element * mesh.elements() * 2 + 400));
  const int k = mesh.intervals();
  for (int j = 0; j <= k * mesh.rows(); ++j)
    for (int i = 0; i <= k * mesh.columns(); ++i)
      if (mesh.exists(i, j)) at[mesh.number(i, j)] = mesh.position(i, j);
  const std::vector<int> nodes = mesh.nodes(element);
  const std::size_t corners = mesh.triangles ? 3 : 4;
  double twice = 0.0;
  for (std::size_t c = 0; c < corners; ++c) {
    const Vector2 a = at[nodes[c]], b = at[nodes[(c + 1) % corners]];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2.0;
}

TEST(Rectangle, TrianglesCountedAlongX) {
  const Rectangle mesh{true, 3, true, {0, .5, 1}, {0, -.5, -1}};
  EXPECT_EQ(mesh.elements(), 8);
  EXPECT_EQ(mesh.nodes(0), (std::vector<int>{1, 4, 2}));
  EXPECT_EQ(mesh.nodes(1), (std::vector<int>{5, 2, 4}));
  EXPECT_EQ(mesh.nodes(2), (std::vector<int>{2, 5, 3}));
}

TEST(Rectangle, FifteenNodeTrianglesCountedAlongY) {
  const Rectangle mesh{true, 15, false, {0, 1, 6}, {0, -2}};
  EXPECT_EQ(mesh.number(8, 4), 45);
  EXPECT_EQ(mesh.number(1, 0), 6);
  EXPECT_EQ(mesh.nodes(0), (std::vector<int>{1, 5, 21, 2, 3, 4, 9, 13, 17, 16, 11, 6, 7, 8, 12}));
}

TEST(Rectangle, EightNodeQuadrilateralsSkipTheCentres) {
  const Rectangle mesh{false, 8, false, {0, 1, 2, 3}, {0, -1.25, -2.5, -3.75, -5}};
  // Program 6.1: 9 nodes down the first line, 5 on the next, loads at the top nodes 1 10 15 24 29.
  EXPECT_EQ(mesh.number(1, 0), 10);
  EXPECT_EQ(mesh.number(2, 0), 15);
  EXPECT_EQ(mesh.number(3, 0), 24);
  EXPECT_EQ(mesh.number(4, 0), 29);
  EXPECT_EQ(mesh.number(1, 8), 14);
  EXPECT_FALSE(mesh.exists(1, 1));
  EXPECT_EQ(mesh.nodes(0), (std::vector<int>{3, 17, 15, 1, 11, 16, 10, 2}));
}

TEST(Rectangle, ElementsAreCounterClockwiseWhicheverWayTheListsRun) {
  for (const bool triangles : {false, true})
    for (const std::vector<double>& x : {std::vector<double>{0, 1, 3}, std::vector<double>{3, 1, 0}})
      for (const std::vector<double>& y : {std::vector<double>{0, -2}, std::vector<double>{-2, 0}}) {
        const Rectangle mesh{triangles, triangles ? 6 : 8, true, x, y};
        double sum = 0.0;
        for (int e = 0; e < mesh.elements(); ++e) {
          EXPECT_GT(area(mesh, e), 0.0);
          sum += area(mesh, e);
        }
        EXPECT_NEAR(sum, 6.0, 1e-12);
      }
}

}  // namespace
}  // namespace sage
