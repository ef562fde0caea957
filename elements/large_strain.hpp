// A solid under large strain: the shape, rule and assumed strain of a Solid, with strains and equilibrium in the place
// that the element has moved to.  docs/theory/large_strain.md
#pragma once

#include <cassert>
#include <cmath>
#include <string>

#include "elements/follower_load.hpp"
#include "elements/log_strain.hpp"
#include "elements/solid.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/math/exp_and_log.hpp"

namespace sage {

// What the elements remember at each point: the deformation gradient less the unit, since the group was activated.
inline constexpr std::array<Quantity, 5> kLargeStrainHistory{{{"displacement_gradient_xx"},
                                                              {"displacement_gradient_xy"},
                                                              {"displacement_gradient_yx"},
                                                              {"displacement_gradient_yy"},
                                                              {"displacement_gradient_zz"}}};

inline PlaneGradient gradient_from(const double* h) {
  return {h[0], h[1], h[2], h[3], h[4]};
}
inline void store_gradient(const PlaneGradient& g, double* h) {
  h[0] = g.xx, h[1] = g.xy, h[2] = g.yx, h[3] = g.yy, h[4] = g.zz;
}

// The answer of a law to a step of large strain.
struct LogPoint {
  Vector4 tau;                      // Kirchhoff stress
  Matrix4 D;                        // d(tau)/d(elastic trial strain)
  Vector4 trial = Vector4::Zero();  // elastic trial strain, without a factor at the shear
  PointStatus status = PointStatus::elastic;
};

// point: committed Kirchhoff stress, strain, history and context; its deps is overwritten.  step: gradient of the
// displacements since the committed state, by the places of that state.  False where the step turns the point inside out.
bool find_trial_strain(const ElasticShear& law, const PlaneGradient& step, PointIn<4>& point, Vector4& trial);
// h1: the law's trial history.
Outcome update_stress(const ElasticShear& law, const PointIn<4>& point, std::span<double> h1, LogPoint& answer);

// Stiffness by displacement gradients [xx yy zz xy yx], of stress components in the same order, in the moved place:
// D d(trial strain)/d(gradient).
Eigen::Matrix<double, 5, 5> log_stiffness(const LogPoint& point);
// The same from the turn of the gradients of shape functions under a constant stress: -tau l^T.
void add_initial_stress_stiffness(const Vector4& tau, Eigen::Matrix<double, 5, 5>& C);

template <class Shape, class Kinematics, class Rule, AssumedStrain strain>
class LargeStrain final : public Element {
  static_assert(strain != AssumedStrain::enhanced);
  static constexpr int kNodes = Shape::nodes, kDofs = 2 * kNodes;
  static constexpr std::size_t kPoints = Rule::points, kOwn = kLargeStrainHistory.size();
  static constexpr bool kRing = Kinematics::geometry == Geometry::axisymmetric;
  static constexpr bool kMean = strain == AssumedStrain::mean_dilatation;
  using Small = Solid<Shape, Kinematics, Rule, strain>;
  using Coordinates = Eigen::Matrix<double, 2, kNodes>;
  using Nodes = Vector<kNodes>;

 public:
  LargeStrain(std::string_view name, bool reduced, bool locks, bool loses_order)
      : name_(std::string(name) + ", large strain"),
        small_(name_, reduced, locks, loses_order),
        traits_(small_.traits()) {
    traits_.linear = false;
    traits_.large_strain = true;
    traits_.sees_unknowns = true;
    traits_.sees_coordinates = true;
    traits_.history = kLargeStrainHistory;
    for (std::size_t p = 0; p < kPoints; ++p)
      points_[p] = ShapeAt<Shape>({Rule::table[p].xi, Rule::table[p].eta}, Rule::table[p].w);
  }

  const ElementTraits& traits() const override { return traits_; }
  // Of the mesh, for outputs.
  void geometry(const NodeCoordinates& x, std::span<double> to) const override { small_.geometry(x, to); }
  Vector2 position(const NodeCoordinates& x, int point) const override { return small_.position(x, point); }
  // The weight of what is in the mesh: it stays as the volume changes.
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override {
    small_.body_load(x, b, f);
  }
  const std::vector<std::vector<int>>& edges() const override { return small_.edges(); }
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override {
    small_.edge_load(x, edge, normal, shear, f);
  }
  std::span<const double> point_to_node(const NodeCoordinates& x) const override {
    return small_.point_to_node(x);
  }
  std::span<const double> point_to_sample() const override { return small_.point_to_sample(); }
  bool shape_functions(const Vector2& parent, std::span<double> N, std::span<double> dN) const override {
    return small_.shape_functions(parent, N, dN);
  }
  double shape_quality(const NodeCoordinates& x) const override { return small_.shape_quality(x); }

  // Stress arrives and leaves as Cauchy stress, strain as logarithmic strain of the left stretch.
  Outcome evaluate(const ElementIn& in, ElementOut& out) const override {
    const SolidLaw* const of_group = std::get<const SolidLaw*>(in.law);
    assert(dynamic_cast<const ElasticShear*>(of_group) && "the model builder rejects other laws");
    const auto& law = static_cast<const ElasticShear&>(*of_group);
    const std::size_t of_law = law.traits().history.size();
    const std::size_t stride = of_law + kOwn;
    // A loop for each part of a point's work: the processor then works at several points at once.
    std::array<Moved, kPoints> moved;
    Dilatation whole;
    const Motion motion(in);
    for (std::size_t p = 0; p < kPoints; ++p)
      if (!move(motion, p, in.h0 + p * stride + of_law, moved[p], whole)) return Outcome::cut_step;
    std::array<PointIn<4>, kPoints> points;
    std::array<LogPoint, kPoints> answers;
    for (std::size_t p = 0; p < kPoints; ++p) {
      Moved& m = moved[p];
      if constexpr (kMean) whole.take_mean(m);
      store_gradient(m.total, out.h1 + p * stride + of_law);
      points[p].sigma0 = (1.0 + m.change0) * Vector4::Map(in.sigma0 + 4 * p);
      points[p].eps0 = Vector4::Map(in.eps0 + 4 * p);
      points[p].h0 = {in.h0 + p * stride, of_law};
      points[p].context = in.contexts != nullptr ? in.contexts + p : nullptr;
      if (!find_trial_strain(law, m.step, points[p], answers[p].trial) ||
          !total_strain(m.strained, out.eps1 + 4 * p))
        return Outcome::cut_step;
    }
    for (std::size_t p = 0; p < kPoints; ++p)
      if (update_stress(law, points[p], {out.h1 + p * stride, of_law}, answers[p]) != Outcome::ok)
        return Outcome::cut_step;
    Sums sums;
    if (out.K != nullptr) sums.clear();
    for (std::size_t p = 0; p < kPoints; ++p) {
      Vector4::Map(out.sigma1 + 4 * p) = answers[p].tau / (1.0 + moved[p].change);
      out.status[p] = answers[p].status;
      add_point(moved[p], whole, answers[p], out.K != nullptr, sums);
    }
    if (kMean && out.K != nullptr) add_volume_curvature(moved, whole, sums);
    write(sums, out);
    if (!in.edges.empty()) follow_edges(in, out);
    return Outcome::ok;
  }

 private:
  // Places of the nodes in the committed state, and how they move from there.
  struct Motion {
    Coordinates before, du;
    explicit Motion(const ElementIn& in)
        : before(Coordinates::Map(in.x) + Coordinates::Map(in.u0)), du(Coordinates::Map(in.du)) {}
  };
  // Gradients of the shape functions where the element is.
  struct Moved {
    Nodes gx, gy, hoop;
    double volume = 0.0;                  // now
    double reference = 0.0;               // of what is free of stress
    double change0 = 0.0, change = 0.0;   // volume over that less 1, of the strain that the law sees
    PlaneGradient step, total, strained;  // strained: as the law sees it
  };
  // Of the element, for strains with its mean change of volume.
  struct Dilatation {
    double volume = 0.0, reference = 0.0;
    double growth0 = 0.0, growth = 0.0;            // sums of reference times change0 and change
    Nodes bx = Nodes::Zero(), by = Nodes::Zero();  // sum of volume times (N,x + N/r), N,y
    double pressure = 0.0;                         // sum of reference times tr(tau)/3

    // Scales the step and the whole deformation to the mean change of volume.  Small changes keep their digits.
    void take_mean(Moved& m) const {
      const double mean0 = growth0 / reference, mean = growth / reference;
      const double log0 = log_1_plus(mean0) - log_1_plus(m.change0),
                   log = log_1_plus(mean) - log_1_plus(m.change);
      m.strained = scaled(m.total, exp_less_1(log / 3.0));
      m.step = scaled(m.step, exp_less_1((log - log0) / 3.0));
      m.change0 = mean0;
      m.change = mean;
    }
    static PlaneGradient scaled(const PlaneGradient& g, double more) {
      const double by = 1.0 + more;
      return {more + by * g.xx, by * g.xy, by * g.yx, more + by * g.yy, more + by * g.zz};
    }
  };
  struct Sums {
    Nodes fx = Nodes::Zero(), fy = Nodes::Zero();
    Matrix<kNodes> xx, xy, yx, yy;
    void clear() { xx.setZero(), xy.setZero(), yx.setZero(), yy.setZero(); }
  };

  // False where the element is turned inside out.
  bool move(const Motion& to, std::size_t p, const double* history, Moved& m, Dilatation& whole) const {
    const ShapeAt<Shape>& at = points_[p];
    const auto dN_xi = at.dN.col(0), dN_eta = at.dN.col(1);
    const Matrix2 J0 = to.before.lazyProduct(at.dN), dJ = to.du.lazyProduct(at.dN);
    const double x_xi = J0(0, 0), x_eta = J0(0, 1), y_xi = J0(1, 0), y_eta = J0(1, 1);
    const double dx_xi = dJ(0, 0), dx_eta = dJ(0, 1), dy_xi = dJ(1, 0), dy_eta = dJ(1, 1);
    const double J_xx = x_xi + dx_xi, J_xy = x_eta + dx_eta, J_yx = y_xi + dy_xi, J_yy = y_eta + dy_eta;
    const double det0 = x_xi * y_eta - x_eta * y_xi, det = J_xx * J_yy - J_xy * J_yx;
    const double r0 = kRing ? to.before.row(0).dot(at.N) : 1.0, dr = kRing ? to.du.row(0).dot(at.N) : 0.0;
    const double r = r0 + dr;
    if (!(det0 > 0.0) || !(det > 0.0) || (kRing && (!(r0 > 0.0) || !(r > 0.0)))) return false;
    m.gx = (J_yy / det) * dN_xi - (J_yx / det) * dN_eta;
    m.gy = (J_xx / det) * dN_eta - (J_xy / det) * dN_xi;
    if constexpr (kRing)
      m.hoop = at.N / r;
    else
      m.hoop.setZero();
    // d(du)/dx by the committed places
    m.step = {(dx_xi * y_eta - dx_eta * y_xi) / det0, (dx_eta * x_xi - dx_xi * x_eta) / det0,
              (dy_xi * y_eta - dy_eta * y_xi) / det0, (dy_eta * x_xi - dy_xi * x_eta) / det0, dr / r0};
    const PlaneGradient last = gradient_from(history);
    m.total = m.strained = followed_by(last, m.step);
    m.change0 = last.volume_change();
    m.change = m.total.volume_change();
    m.volume = at.w * det * Kinematics::measure(r);
    m.reference = at.w * det0 * Kinematics::measure(r0) / (1.0 + m.change0);
    if constexpr (kMean) {
      whole.volume += m.volume;
      whole.reference += m.reference;
      whole.growth0 += m.reference * m.change0;
      whole.growth += m.reference * m.change;
      whole.bx += m.volume * (m.gx + m.hoop);
      whole.by += m.volume * m.gy;
    }
    return m.change > -1.0;
  }

  static bool total_strain(const PlaneGradient& total, double* eps) {
    Vector4 e;
    if (!half_log(pushed_forward(Vector4::Zero(), total), e)) return false;
    e[3] *= 2.0;
    Vector4::Map(eps) = e;
    return true;
  }

  // Into the columns of a node's displacements: `to` += w (rows of the operator) (C g).
  static void add_plain(const Moved& m, double w, const Eigen::Matrix<double, 5, 5>& C, Sums& sums) {
    const Eigen::Matrix<double, 5, 5> wC = w * C;
    for (int j = 0; j < kNodes; ++j) {
      const Vector<5> u = wC.col(0) * m.gx[j] + wC.col(3) * m.gy[j] + wC.col(2) * m.hoop[j];
      const Vector<5> v = wC.col(4) * m.gx[j] + wC.col(1) * m.gy[j];
      sums.xx.col(j) += m.gx * u[0] + m.gy * u[3];
      sums.yx.col(j) += m.gx * u[4] + m.gy * u[1];
      sums.xy.col(j) += m.gx * v[0] + m.gy * v[3];
      sums.yy.col(j) += m.gx * v[4] + m.gy * v[1];
      if constexpr (!kRing) continue;
      sums.xx.col(j) += m.hoop * u[2];
      sums.xy.col(j) += m.hoop * v[2];
    }
  }

  // The same with the mean dilatation in place of the point's own, in the first three rows of both operators.
  static void add_mean(const Moved& m, double w, const Nodes& cx, const Nodes& cy,
                       const Eigen::Matrix<double, 5, 5>& C, Sums& sums) {
    using Operator = Eigen::Matrix<double, kNodes, 5>;
    Operator u, v;
    u << m.gx + cx, cx, m.hoop + cx, m.gy, Nodes::Zero();
    v << cy, m.gy + cy, cy, Nodes::Zero(), m.gx;
    const Eigen::Matrix<double, 5, 5> wCt = w * C.transpose();
    const Operator Cu = u.lazyProduct(wCt), Cv = v.lazyProduct(wCt);
    sums.xx += u.lazyProduct(Cu.transpose());
    sums.yx += v.lazyProduct(Cu.transpose());
    sums.xy += u.lazyProduct(Cv.transpose());
    sums.yy += v.lazyProduct(Cv.transpose());
  }

  static void add_point(const Moved& m, Dilatation& whole, const LogPoint& answer, bool stiffness, Sums& sums) {
    const double w = m.reference;
    const Vector4& tau = answer.tau;
    sums.fx += w * (tau[0] * m.gx + tau[3] * m.gy + tau[2] * m.hoop);
    sums.fy += w * (tau[3] * m.gx + tau[1] * m.gy);
    Eigen::Matrix<double, 5, 5> C;
    if (stiffness) C = log_stiffness(answer);
    if constexpr (kMean) {
      const double pressure = (tau[0] + tau[1] + tau[2]) / 3.0;
      const Nodes cx = whole.bx / (3.0 * whole.volume) - (m.gx + m.hoop) / 3.0;
      const Nodes cy = whole.by / (3.0 * whole.volume) - m.gy / 3.0;
      sums.fx += 3.0 * w * pressure * cx;
      sums.fy += 3.0 * w * pressure * cy;
      whole.pressure += w * pressure;
      if (!stiffness) return;
      add_mean(m, w, cx, cy, C, sums);
      C.setZero();
      add_initial_stress_stiffness(tau - pressure * Vector4(1.0, 1.0, 1.0, 0.0), C);
      add_plain(m, w, C, sums);
    } else if (stiffness) {
      add_initial_stress_stiffness(tau, C);
      add_plain(m, w, C, sums);
    }
  }

  // The mean pressure times the second derivative of the logarithm of the element's volume.
  static void add_volume_curvature(const std::array<Moved, kPoints>& moved, const Dilatation& whole,
                                   Sums& sums) {
    Eigen::Matrix<double, 5, 5> C = Eigen::Matrix<double, 5, 5>::Zero();
    C.template topLeftCorner<3, 3>().setOnes();
    add_initial_stress_stiffness(Vector4(1.0, 1.0, 1.0, 0.0), C);
    for (const Moved& m : moved) add_plain(m, whole.pressure * m.volume / whole.volume, C, sums);
    const Nodes bx = whole.bx / whole.volume, by = whole.by / whole.volume;
    sums.xx -= whole.pressure * bx * bx.transpose();
    sums.xy -= whole.pressure * bx * by.transpose();
    sums.yx -= whole.pressure * by * bx.transpose();
    sums.yy -= whole.pressure * by * by.transpose();
  }

  void follow_edges(const ElementIn& in, ElementOut& out) const {
    std::array<double, kDofs> change{};
    for (const EdgeTraction& load : in.edges) add_edge(in, load, change, out.K);
    for (std::size_t i = 0; i < change.size(); ++i) out.f[i] -= change[i];
    if (out.load != nullptr) std::ranges::copy(change, out.load);
  }

  void add_edge(const ElementIn& in, const EdgeTraction& load, std::span<double> change, double* K) const {
    using Edge = typename Shape::Edge;
    const std::vector<int>& nodes = edges()[load.edge];
    const Coordinates mesh = Coordinates::Map(in.x);
    const Coordinates moved = mesh + Coordinates::Map(in.u0) + Coordinates::Map(in.du);
    Eigen::Matrix<double, 2, Edge::nodes> of_mesh, of_moved;
    for (int i = 0; i < Edge::nodes; ++i) {
      of_mesh.col(i) = mesh.col(nodes[i]);
      of_moved.col(i) = moved.col(nodes[i]);
    }
    add_follower<Edge, Kinematics>(of_mesh, of_moved, load, nodes, change, K);
  }

  static void write(const Sums& sums, ElementOut& out) {
    Eigen::Map<Coordinates> f(out.f);
    f.row(0) = sums.fx;
    f.row(1) = sums.fy;
    if (out.K == nullptr) return;
    Eigen::Map<Matrix<kDofs>> K(out.K);
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) {
        K(2 * i, 2 * j) = sums.xx(i, j);
        K(2 * i + 1, 2 * j) = sums.yx(i, j);
        K(2 * i, 2 * j + 1) = sums.xy(i, j);
        K(2 * i + 1, 2 * j + 1) = sums.yy(i, j);
      }
  }

  std::string name_;
  Small small_;
  ElementTraits traits_;
  std::array<ShapeAt<Shape>, kPoints> points_;
};

}  // namespace sage
