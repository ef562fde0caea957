// Every table of shape functions: partition of unity, one at its own node, derivatives, edges.
#include "elements/shapes.hpp"

#include <gtest/gtest.h>

#include "elements/lobatto.hpp"

namespace sage {
namespace {

const std::vector<ParentPoint> kSamples{{0.21, 0.34}, {0.6, 0.15}, {0.05, 0.9}, {0.333, 0.333}};

template <class Shape>
class Shapes : public testing::Test {};
using AllShapes =
    testing::Types<Quad4, Quad8, Quad9, LobattoQuad<4>, LobattoQuad<6>, LobattoQuad<8>, Tri3, Tri6, Tri15>;
TYPED_TEST_SUITE(Shapes, AllShapes);

TYPED_TEST(Shapes, OneAtItsOwnNodeAndZeroAtTheOthers) {
  for (std::size_t j = 0; j < TypeParam::nodes; ++j) {
    const auto N = TypeParam::N(TypeParam::node_at[j]);
    for (int i = 0; i < TypeParam::nodes; ++i) EXPECT_NEAR(N(i), i == static_cast<int>(j) ? 1.0 : 0.0, 1e-14);
  }
}

TYPED_TEST(Shapes, PartitionOfUnity) {
  for (const ParentPoint& q : kSamples) {
    EXPECT_NEAR(TypeParam::N(q).sum(), 1.0, 1e-14);
    EXPECT_LT(TypeParam::dN(q).colwise().sum().norm(), 1e-13);
  }
}

// Central differences with h = 1e-5: truncation h^2 N'''/6 < 1e-8 for quartics, 5e-8 for
// degree 8, rounding 1e-11.
TYPED_TEST(Shapes, DerivativesMatchDifferences) {
  const double h = 1e-5;
  for (const ParentPoint& q : kSamples)
    for (std::size_t d = 0; d < 2; ++d) {
      ParentPoint plus = q, minus = q;
      plus[d] += h;
      minus[d] -= h;
      const auto difference = ((TypeParam::N(plus) - TypeParam::N(minus)) / (2.0 * h)).eval();
      EXPECT_LT((TypeParam::dN(q).col(static_cast<int>(d)) - difference).norm(),
                TypeParam::degree > 6 ? 1e-7 : 2e-8);
    }
}

// Along an edge only its own nodes count, with the functions of the line: neighbours fit whatever their shape.
TYPED_TEST(Shapes, EdgesAreLines) {
  using Line = typename TypeParam::Edge;
  ASSERT_EQ(TypeParam::edges().size(), static_cast<std::size_t>(TypeParam::corners));
  for (std::size_t e = 0; e < TypeParam::edges().size(); ++e) {
    const std::vector<int>& edge = TypeParam::edges()[e];
    ASSERT_EQ(edge.size(), static_cast<std::size_t>(Line::nodes));
    EXPECT_EQ(edge[1], TypeParam::edges()[(e + 1) % TypeParam::corners][0]) << "edges follow one another";
    const ParentPoint a = TypeParam::node_at[edge[0]];
    const ParentPoint b = TypeParam::node_at[edge[1]];
    for (const double xi : {-0.7, 0.1, 0.45}) {
      const double s = 0.5 * (1.0 + xi);
      auto N = TypeParam::N({a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])});
      const auto line = Line::N(xi);
      for (int i = 0; i < Line::nodes; ++i) N(edge[i]) -= line(i);
      EXPECT_LT(N.norm(), 1e-14);
    }
  }
}

template <class Line>
class Lines : public testing::Test {};
using AllLines = testing::Types<Line2, Line3, Line5, LobattoLine<4>, LobattoLine<6>, LobattoLine<8>>;
TYPED_TEST_SUITE(Lines, AllLines);

TYPED_TEST(Lines, NodesSumAndDerivatives) {
  for (std::size_t j = 0; j < TypeParam::nodes; ++j)
    EXPECT_NEAR(TypeParam::N(TypeParam::node_xi[j])(static_cast<int>(j)), 1.0, 1e-14);
  const double h = 1e-5;
  for (const double xi : {-0.8, 0.15, 0.6}) {
    EXPECT_NEAR(TypeParam::N(xi).sum(), 1.0, 1e-14);
    const auto difference = ((TypeParam::N(xi + h) - TypeParam::N(xi - h)) / (2.0 * h)).eval();
    EXPECT_LT((TypeParam::dN(xi) - difference).norm(), 2e-8);
  }
}

}  // namespace
}  // namespace sage
