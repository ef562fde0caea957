// Isoparametric solid: shape x kinematics x rule (x where its strain comes from).  All it does is to make w and B, and
// the modes of an enhanced strain; point_kernel.hpp or enhanced.hpp does the rest.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <vector>

#include "elements/edge_load.hpp"
#include "elements/enhanced.hpp"
#include "elements/extrapolation.hpp"
#include "elements/kinematics.hpp"
#include "elements/point_kernel.hpp"
#include "elements/shape_check.hpp"
#include "elements/shapes.hpp"

namespace sage {

// Strain of the points: of the displacements there as it is, with its volumetric part replaced by the element's mean
// (B-bar), or with modes of the element's own added (enhanced.hpp).
enum class AssumedStrain { none, mean_dilatation, enhanced };

// N and dN/d(xi, eta) at one place of the parent shape.
template <class Shape>
struct ShapeAt {
  Vector<Shape::nodes> N;
  Eigen::Matrix<double, Shape::nodes, 2> dN;
  double w = 0.0;  // weight of the rule

  ShapeAt() = default;
  explicit ShapeAt(const ParentPoint& q, double weight = 0.0) : N(Shape::N(q)), dN(Shape::dN(q)), w(weight) {}
};

inline double determinant(const Matrix2& J) {
  return J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
}

template <class Shape, class Kinematics, class Rule, AssumedStrain strain>
using SolidKernel =
    std::conditional_t<strain == AssumedStrain::enhanced,
                       EnhancedElement<2 * Shape::nodes, Rule::points, EnhancedModes<Kinematics>::kCount>,
                       PointElement<4, 2 * Shape::nodes, Rule::points, strain == AssumedStrain::none>>;

template <class Shape, class Kinematics, class Rule, AssumedStrain strain = AssumedStrain::none>
class Solid final : public SolidKernel<Shape, Kinematics, Rule, strain> {
  using Kernel = SolidKernel<Shape, Kinematics, Rule, strain>;
  static constexpr int kDofs = 2 * Shape::nodes;
  static constexpr int kStride = kPointStride<4, kDofs>;
  using Coordinates = Eigen::Matrix<double, 2, Shape::nodes>;

 public:
  Solid(std::string_view name, bool reduced, bool locks, bool loses_order)
      : Kernel(ElementTraits{.name = name,
                             .geometry = Kinematics::geometry,
                             .nodes = Shape::nodes,
                             .dofs = kDofs,
                             .points = Rule::points,
                             .degree = Shape::degree,
                             .law_size = 4,
                             .reduced = reduced,
                             .locks = locks,
                             .loses_order = loses_order}) {
    std::vector<ParentPoint> at;
    for (std::size_t p = 0; p < Rule::points; ++p) {
      const RulePoint& q = Rule::table[p];
      points_[p] = ShapeAt<Shape>({q.xi, q.eta}, q.w);
      at.push_back({q.xi, q.eta});
    }
    for (std::size_t c = 0; c < Shape::corners; ++c) corners_[c] = ShapeAt<Shape>(Shape::node_at[c]);
    to_nodes_ =
        extrapolation_matrix(at, Shape::node_at, Rule::points == 1 ? Basis::constant : Shape::stress_basis);
    if constexpr (Shape::corners == 4 && Rule::points > Shape::degree * Shape::degree) {
      std::vector<ParentPoint> samples;
      samples.reserve(GaussSquare<Shape::degree>::table.size());
      for (const RulePoint& q : GaussSquare<Shape::degree>::table) samples.push_back({q.xi, q.eta});
      to_samples_ = extrapolation_matrix(at, samples, Basis::tensor);
    }
  }

  void geometry(const NodeCoordinates& nodes, std::span<double> geometry) const override {
    assert(nodes.cols() == Shape::nodes && static_cast<int>(geometry.size()) == this->traits().geometry_size());
    const Coordinates x = nodes;
    check(x);
    std::array<Gradients, Rule::points> at_points;
    for (std::size_t p = 0; p < Rule::points; ++p) at_points[p] = gradients(x, points_[p]);
    NodePairs b_new;
    if constexpr (strain == AssumedStrain::mean_dilatation) b_new = mean_volumetric_part(at_points);
    double* block = geometry.data();
    for (const Gradients& g : at_points) {
      *block = g.w;
      if constexpr (strain == AssumedStrain::mean_dilatation)
        write_operator(g, (b_new - g.volumetric_part()) / 3.0, block + 1);
      else
        write_operator(g, NodePairs::Zero(), block + 1);
      block += kStride;
    }
    if constexpr (strain == AssumedStrain::enhanced) write_modes(x, block);
  }

  Vector2 position(const NodeCoordinates& x, int point) const override { return x * points_[point].N; }

  // f_i += integral N_i b dV
  void body_load(const NodeCoordinates& nodes, const Vector2& b, std::span<double> f) const override {
    const Coordinates x = nodes;
    Eigen::Map<Eigen::Matrix<double, 2, Shape::nodes>> forces(f.data());
    for (const RulePoint& q : Shape::LoadRule::table) {
      const ShapeAt<Shape> at({q.xi, q.eta});
      const Matrix2 J = x.lazyProduct(at.dN);
      const double w = q.w * determinant(J) * Kinematics::measure(x.row(0).dot(at.N));
      forces += w * b * at.N.transpose();
    }
  }

  const std::vector<std::vector<int>>& edges() const override { return Shape::edges(); }

  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override {
    using Edge = typename Shape::Edge;
    const std::vector<int>& nodes = edges().at(edge);
    Eigen::Matrix<double, 2, Edge::nodes> ends;
    for (int i = 0; i < Edge::nodes; ++i) ends.col(i) = x.col(nodes[i]);
    add_edge_load<Edge, Kinematics>(ends, normal, shear, nodes, f);
  }

  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override { return to_nodes_; }

  std::span<const double> point_to_sample() const override { return to_samples_; }

  bool shape_functions(const Vector2& parent, std::span<double> N, std::span<double> dN) const override {
    const ShapeAt<Shape> at({parent.x(), parent.y()});
    Eigen::Map<Vector<Shape::nodes>>(N.data()) = at.N;
    Eigen::Map<Eigen::Matrix<double, Shape::nodes, 2>>(dN.data()) = at.dN;
    return true;
  }

  double shape_quality(const NodeCoordinates& x) const override { return quality(x); }

 private:
  // A value for each dof: one row a node, columns u and v.
  using NodePairs = Eigen::Matrix<double, Shape::nodes, 2>;

  // What B and w are made of at one place.
  struct Gradients {
    NodePairs dNdx;
    Vector<Shape::nodes> hoop;  // N / r
    double w = 0.0;

    // Volumetric strain per dof, b = [1 1 1 0] B.
    NodePairs volumetric_part() const {
      NodePairs b = dNdx;
      b.col(0) += hoop;
      return b;
    }
  };

  static Gradients gradients(const Coordinates& x, const ShapeAt<Shape>& at) {
    const Matrix2 J = x.lazyProduct(at.dN);
    const double detJ = determinant(J), r = x.row(0).dot(at.N);
    const Matrix2 inverse = (Matrix2() << J(1, 1), -J(0, 1), -J(1, 0), J(0, 0)).finished() / detJ;
    Gradients g;
    g.dNdx = at.dN.lazyProduct(inverse);
    for (int i = 0; i < Shape::nodes; ++i) g.hoop(i) = Kinematics::hoop(at.N(i), r);
    g.w = at.w * detJ * Kinematics::measure(r);
    return g;
  }

  // b_mean = sum w b / sum w; w contains r, so the mean is over the volume of the ring.
  static NodePairs mean_volumetric_part(const std::array<Gradients, Rule::points>& at_points) {
    NodePairs sum = NodePairs::Zero();
    double volume = 0.0;
    for (const Gradients& g : at_points) {
      sum += g.w * g.volumetric_part();
      volume += g.w;
    }
    return sum / volume;
  }

  // B = [N,x 0; 0 N,y; N/r 0; N,y N,x] for each node, plus c in its first three rows:
  // B-bar = B + [1 1 1 0]^T c, c = (b_new - b) / 3                  [Hughes 1980; Simo, Taylor & Pister 1985]
  static void write_operator(const Gradients& g, const NodePairs& c, double* block) {
    Eigen::Map<OperatorT<4, kDofs>> Bt(block);
    for (int i = 0; i < Shape::nodes; ++i) {
      const double Nx = g.dNdx(i, 0), Ny = g.dNdx(i, 1), u = c(i, 0), v = c(i, 1);
      Bt.row(2 * i) << Nx + u, u, g.hoop(i) + u, Ny;
      Bt.row(2 * i + 1) << v, Ny + v, v, Nx;
    }
  }

  void write_modes(const Coordinates& x, double* to) const {
    std::array<double, Rule::points> det, measure;
    for (std::size_t p = 0; p < Rule::points; ++p) {
      det[p] = determinant(x.lazyProduct(points_[p].dN));
      measure[p] = Kinematics::measure(x.row(0).dot(points_[p].N));
    }
    EnhancedModes<Kinematics>::write(Rule::table, det, measure, x.lazyProduct(Shape::dN({0.0, 0.0})), to);
  }

  // Smallest detJ over mean detJ at points and corners; 0 or -1 where there is no area or a negative one.
  double quality(const Coordinates& x) const {
    double least = std::numeric_limits<double>::infinity(), sum = 0.0;
    const auto visit = [&](const ShapeAt<Shape>& at) {
      const double detJ = determinant(x.lazyProduct(at.dN));
      least = std::min(least, detJ);
      sum += detJ;
    };
    for (const auto& at : points_) visit(at);
    for (const auto& at : corners_) visit(at);
    const double mean = sum / (Rule::points + Shape::corners);
    const double size = extent(x);
    if (!(mean > 1e-12 * size * size)) return mean < 0.0 ? -1.0 : 0.0;
    return least / mean;
  }

  void check(const Coordinates& x) const {
    if constexpr (Kinematics::geometry == Geometry::axisymmetric) check_radii(x);
    if (!(quality(x) > kSmallestQuality)) reject_shape(x, Shape::corners, Shape::edges());
  }

  std::array<ShapeAt<Shape>, Rule::points> points_;
  std::array<ShapeAt<Shape>, Shape::corners> corners_;
  std::vector<double> to_nodes_, to_samples_;
};

}  // namespace sage
