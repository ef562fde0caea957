// What an interface tells besides its stiffness: sides, shape, extrapolation to nodes.
#include <gtest/gtest.h>

#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

// The two sides, corners first, each in the element's direction of turning.
TEST(InterfaceElement, EdgesAreItsTwoSides) {
  for (const ElementCase& c : interface_cases()) {
    SCOPED_TRACE(c.name);
    const std::vector<std::vector<int>> two{{0, 1}, {2, 3}}, three{{0, 1, 4}, {2, 3, 5}};
    EXPECT_EQ(c.make()->edges(), c.entry->corners == 4 && c.make()->traits().nodes == 4 ? two : three);
  }
}

// |dx/dxi| is the same everywhere on a straight element with its middle pair in the middle.
TEST(InterfaceElement, ShapeQualityOfAnEvenElementIsOne) {
  Eigen::Matrix2Xd ends(2, 2);
  ends << 1.0, 3.5, 2.0, 4.0;
  for (const ElementCase& c : interface_cases())
    EXPECT_NEAR(c.make()->shape_quality(straight_element(*c.entry, ends)), 1.0, 1e-14) << c.name;
}

// Length 2 along x, the middle pair moved by s: J = 1 - 2 s xi.  Smallest at the end nearer to it, 1 - 2 s; the
// mean over the points of both rules, which lie evenly about the middle, is 1.
TEST(InterfaceElement, ShapeQualityFallsAsTheMiddlePairMoves) {
  for (const ElementCase& c : interface_cases()) {
    if (c.make()->traits().nodes != 6) continue;
    SCOPED_TRACE(c.name);
    Eigen::Matrix2Xd ends(2, 2);
    ends << 1.0, 3.0, 0.0, 0.0;
    Eigen::Matrix2Xd x = straight_element(*c.entry, ends);
    for (const double s : {0.1, 0.3, 0.6}) {
      Eigen::Matrix2Xd moved = x;
      moved(0, 4) += s;
      moved(0, 5) += s;
      EXPECT_NEAR(c.make()->shape_quality(moved), 1.0 - 2.0 * s, 1e-13) << s;
    }
  }
}

// Moved off the line instead, square to the chord: J along the chord is the same everywhere, however the
// element lies, and however short it is.
TEST(InterfaceElement, ShapeQualityIsMeasuredAlongTheChord) {
  for (const ElementCase& c : interface_cases())
    for (const double length : {1e-3, 2.0}) {
      SCOPED_TRACE(c.name);
      Eigen::Matrix2Xd ends(2, 2);
      ends << 1.0, 1.0 + 0.6 * length, 2.0, 2.0 + 0.8 * length;
      Eigen::Matrix2Xd x = straight_element(*c.entry, ends);
      for (int n = 4; n < x.cols(); ++n) x.col(n) += 0.1 * length * Vector2(-0.8, 0.6);
      EXPECT_NEAR(c.make()->shape_quality(x), 1.0, 1e-12);
    }
}

TEST(InterfaceElement, ShapeQualityOfZeroLengthIsZero) {
  for (const ElementCase& c : interface_cases())
    EXPECT_EQ(c.make()->shape_quality(straight_element(*c.entry, Eigen::Matrix2Xd::Ones(2, 2))), 0.0) << c.name;
}

// Values that vary along the element as its pairs can follow (linearly, or quadratically) are met at every
// node, from either rule's points.
TEST(InterfaceElement, ExtrapolationFollowsTheElementsOwnVariation) {
  Eigen::Matrix2Xd ends(2, 2);
  ends << 1.0, 3.0, 0.5, 0.5;
  for (const ElementCase& c : interface_cases()) {
    SCOPED_TRACE(c.name);
    const std::unique_ptr<Element> element = c.make();
    const ElementTraits& t = element->traits();
    const Eigen::Matrix2Xd x = straight_element(*c.entry, ends);
    const auto value = [&](double at) { return 3.0 - 2.0 * at + (t.nodes == 6 ? 0.7 * at * at : 0.0); };
    const std::span<const double> to_nodes = element->point_to_node(x);
    for (int n = 0; n < t.nodes; ++n) {
      double sum = 0.0;
      for (int p = 0; p < t.points; ++p) sum += to_nodes[n * t.points + p] * value(element->position(x, p).x());
      EXPECT_NEAR(sum, value(x(0, n)), 1e-12) << "node " << n;
    }
  }
}

}  // namespace
}  // namespace sage::test
