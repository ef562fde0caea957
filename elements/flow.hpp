// Steady flow of water on the shape of a solid: the unknown is the head h of each node, and the strain operator
// gives [h,x h,y h] at a point.  Weights, places, edges and shape checks are those of the solid.
#pragma once

#include <array>

#include "elements/solid.hpp"

namespace sage {

template <class Shape, class Kinematics, class Rule>
class Flow final : public PointElement<3, Shape::nodes, Rule::points> {
  static constexpr int kNodes = Shape::nodes;
  static constexpr std::size_t kStride = kPointStride<3, kNodes>;
  static constexpr std::size_t kSolidStride = kPointStride<4, 2 * kNodes>;

 public:
  explicit Flow(std::string_view name)
      : Flow::PointElement({.name = name,
                            .geometry = Kinematics::geometry,
                            .nodes = kNodes,
                            .dofs = kNodes,
                            .points = Rule::points,
                            .degree = Shape::degree,
                            .law_size = 3}),
        solid_(name, false, false, false) {}

  // A solid's B has N,x and N,y in its first two rows, at the columns of u and of v.
  void geometry(const NodeCoordinates& x, std::span<double> geometry) const override {
    std::array<double, Rule::points * kSolidStride> own;
    solid_.geometry(x, own);
    for (std::size_t p = 0; p < Rule::points; ++p) {
      const RulePoint& q = Rule::table[p];
      const double* const from = own.data() + p * kSolidStride;
      double* const to = geometry.data() + p * kStride;
      to[0] = from[0];
      const Eigen::Map<const OperatorT<4, 2 * kNodes>> solid_Bt(from + 1);
      Eigen::Map<OperatorT<3, kNodes>> Bt(to + 1);
      const Vector<kNodes> N = Shape::N({q.xi, q.eta});
      for (int i = 0; i < kNodes; ++i) Bt.row(i) << solid_Bt(2 * i, 0), solid_Bt(2 * i + 1, 1), N(i);
    }
  }

  Vector2 position(const NodeCoordinates& x, int point) const override { return solid_.position(x, point); }
  const std::vector<std::vector<int>>& edges() const override { return solid_.edges(); }
  // `normal` is what flows in through the edge, volume per area and time; `shear` has no meaning here.
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& /*shear*/,
                 std::span<double> f) const override {
    using Edge = typename Shape::Edge;
    const std::vector<int>& nodes = edges().at(edge);
    Eigen::Matrix<double, 2, Edge::nodes> ends;
    for (int i = 0; i < Edge::nodes; ++i) ends.col(i) = x.col(nodes[i]);
    add_edge_inflow<Edge, Kinematics>(ends, normal, nodes, f);
  }
  std::span<const double> point_to_node(const NodeCoordinates& x) const override {
    return solid_.point_to_node(x);
  }
  std::span<const double> point_to_sample() const override { return solid_.point_to_sample(); }
  bool shape_functions(const Vector2& parent, std::span<double> N, std::span<double> dN) const override {
    return solid_.shape_functions(parent, N, dN);
  }
  double shape_quality(const NodeCoordinates& x) const override { return solid_.shape_quality(x); }

 private:
  Solid<Shape, Kinematics, Rule> solid_;
};

}  // namespace sage
