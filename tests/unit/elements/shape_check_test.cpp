// Each bad shape gets the error that helps to mend it.
#include "elements/shape_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "sage/messages/error.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

constexpr auto kPlane = Geometry::plane_strain;
constexpr auto kRing = Geometry::axisymmetric;

// What geometry() says about these coordinates (rows x and y), "" if it accepts them.
std::string complaint(int code, Geometry geometry, const Eigen::Matrix2Xd& x, int formulation = 0) {
  const ElementEntry& entry = *element_catalogue().elements.find(code);
  const auto element = entry.make(geometry, formulation);
  std::vector<double> block(static_cast<std::size_t>(element->traits().geometry_size()));
  try {
    element->geometry(x, block);
  } catch (const ElementShapeError& e) {
    EXPECT_TRUE(entry.interface() || geometry == kRing || element->shape_quality(x) <= kSmallestQuality);
    return e.what();
  }
  return "";
}

Eigen::Matrix2Xd quad(std::initializer_list<double> xy) {
  return Eigen::Map<const Eigen::Matrix2Xd>(xy.begin(), 2, static_cast<Eigen::Index>(xy.size() / 2));
}

TEST(SolidShape, Clockwise) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 0, 1, 1, 1, 1, 0})),
            "clockwise: node order 4 3 2 1 would be right");
  EXPECT_EQ(complaint(3, kPlane, quad({0, 0, 0, 1, 1, 0})), "clockwise: node order 3 2 1 would be right");
}

// The order that the message gives must itself be accepted.
TEST(SolidShape, TheOrderSuggestedForClockwiseNodesIsRight) {
  for (const int code : {1, 2, 3, 4, 5, 6}) {
    SCOPED_TRACE(code);
    const ElementEntry& entry = *element_catalogue().elements.find(code);
    Eigen::Matrix2Xd x = sample_shape(entry);
    x.row(0) = (3.0 - x.row(0).array()).matrix().eval();  // mirror
    const std::string text = complaint(code, kPlane, x);
    ASSERT_EQ(text.find("clockwise: node order "), 0u) << text;
    std::istringstream order(text.substr(22));
    Eigen::Matrix2Xd y = x;
    int node = 0, i = 0;
    while (order >> node) y.col(i++) = x.col(node - 1);
    EXPECT_EQ(complaint(code, kPlane, y), "");
  }
}

TEST(SolidShape, CrossedNodes) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, 0, 0, 1, 1, 1})).find("crossed (bow-tie) nodes"), 0u);
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, 1, 1, 0, 0, 1})).find("crossed (bow-tie) nodes"), 0u);
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, 0, .2, 1, 1, .9})).find("crossed (bow-tie) nodes"), 0u);
}

TEST(SolidShape, ZeroArea) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, 1, 3, 3, 2, 2})), "zero area: all corners lie on one line");
  EXPECT_EQ(complaint(3, kPlane, quad({0, 0, 1, 1, 3, 3})), "zero area: all corners lie on one line");
  EXPECT_EQ(complaint(3, kRing, quad({0, 0, 0, 2, 0, 1})), "zero area: all corners lie on one line");
}

TEST(SolidShape, ReentrantCorner) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 2, 0, .4, .4, 0, 2})).find("re-entrant corner at local node 3"),
            0u);
  // 183 degrees at node 2: detJ is positive at all four Gauss points, so only the corner shows it.
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, .53, 2, 1, 0, 2})).find("re-entrant corner at local node 2"),
            0u);
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, .47, 2, 1, 0, 2})), "");
}

TEST(SolidShape, CoincidentNodes) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, 0, 0, 1, 0, 1})),
            "local nodes 3 and 4 are at the same place; a triangle needs the three-node element");
  EXPECT_EQ(complaint(3, kPlane, quad({0, 0, 1, 0, 1, 0})), "local nodes 2 and 3 are at the same place");
}

TEST(SolidShape, NotANumber) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1, NAN, 1, 1, 0, 1})),
            "a coordinate of local node 2 is not a number");
}

TEST(SolidShape, MidSideNodeTooNearACorner) {
  Eigen::Matrix2Xd x = straight_element(*element_catalogue().elements.find(2), quad({0, 0, 1, 0, 1, 1, 0, 1}));
  x(0, 4) = 0.3;
  EXPECT_EQ(complaint(2, kPlane, x), "");
  x(0, 4) = 0.2;  // beyond the quarter point detJ is negative at node 1
  EXPECT_EQ(complaint(2, kPlane, x).find("mid-side nodes fold the element"), 0u);
}

TEST(SolidShape, NegativeRadius) {
  const Eigen::Matrix2Xd x = quad({-.1, 0, 1, 0, 1, 1, 0, 1});
  EXPECT_EQ(complaint(1, kRing, x).find("node on negative radius: local node 1 has r = -0.1"), 0u);
  EXPECT_EQ(complaint(1, kPlane, x), "");
  EXPECT_EQ(complaint(1, kRing, quad({-1e-15, 0, 1, 0, 1, 1, 0, 1})), "") << "rounding of a mesher";
}

TEST(SolidShape, SlenderIsNotWrong) {
  EXPECT_EQ(complaint(1, kPlane, quad({0, 0, 1e6, 0, 1e6, 1, 0, 1})), "");
  EXPECT_EQ(complaint(3, kPlane, quad({0, 0, 1e6, 0, 1e6, 1})), "");
}

TEST(InterfaceShape, PairThatDoesNotMatch) {
  EXPECT_EQ(complaint(11, kPlane, quad({0, 0, 1, 0, 1, .01, 0, 0})),
            "interface: the nodes of pair (2, 3) are 0.010000 apart; they must be at the same place");
  EXPECT_EQ(complaint(12, kPlane, quad({0, 0, 1, 0, 1, 0, 0, 0, .5, 0, .5, .1})),
            "interface: the nodes of pair (5, 6) are 0.100000 apart; they must be at the same place");
  EXPECT_EQ(complaint(11, kPlane, quad({0, 0, 1, 0, 1, 5e-7, 0, 0})), "") << "within 1e-6 of the length";
  EXPECT_NE(complaint(11, kPlane, quad({0, 0, 1, 0, 1, 1.5e-6, 0, 0})), "") << "not within 1e-6";
}

TEST(InterfaceShape, WrongPairingIsNamed) {
  EXPECT_EQ(
      complaint(11, kPlane, quad({0, 0, 1, 0, 0, 0, 1, 0})),
      "interface: pairs (1, 3) and (2, 4) are together instead of (1, 4) and (2, 3): the second side must run "
      "back; node order 1 2 4 3 would be right");
  EXPECT_EQ(
      complaint(11, kRing, quad({0, 0, 0, 0, 1, 0, 1, 0})),
      "interface: pairs (1, 2) and (3, 4) are together instead of (1, 4) and (2, 3): node order 2 3 4 1 would "
      "be right");
}

TEST(InterfaceShape, NoLengthOrNoArea) {
  EXPECT_EQ(complaint(11, kPlane, quad({1, 1, 1, 1, 1, 1, 1, 1})),
            "interface: zero length, local nodes 1 and 2 are at the same place");
  EXPECT_EQ(complaint(11, kRing, quad({0, 0, 0, 1, 0, 1, 0, 0})),
            "interface: it lies on the axis r = 0 and has no area");
  EXPECT_EQ(complaint(11, kRing, quad({-1, 0, 1, 0, 1, 0, -1, 0})).find("node on negative radius"), 0u);
  EXPECT_EQ(
      complaint(12, kPlane, quad({0, 0, 1, 0, 1, 0, 0, 0, .1, 0, .1, 0})).find("interface: the mid-side pair"),
      0u);
}

TEST(InterfaceShape, NewtonCotesAtTheAxisIsACaution) {
  const Eigen::Matrix2Xd x = quad({1, 0, 0, 0, 0, 0, 1, 0});  // the second pair is on the axis
  for (const int formulation : {1, 2, 3}) {
    const auto element = element_catalogue().elements.find(11)->make(kRing, formulation);
    EXPECT_EQ(element->caution(x).find("Newton-Cotes gives no area to the pair (2, 3) at r = 0") == 0,
              formulation == 3);
  }
}

}  // namespace
}  // namespace sage::test
