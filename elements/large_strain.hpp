// A solid under large strain: the shape, rule and assumed strain of a Solid, with strains and equilibrium in the place
// that the element has moved to.  docs/theory/large_strain.md
#pragma once

#include <algorithm>
#include <cassert>
#include <string>

#include "elements/follower_load.hpp"
#include "elements/log_strain.hpp"
#include "elements/solid.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/four_at_a_time.hpp"

namespace sage {

// What the elements remember at each point: the deformation gradient less the unit, since the group was activated.
inline constexpr std::array<Quantity, 5> kLargeStrainHistory{{{"displacement_gradient_xx"},
                                                              {"displacement_gradient_xy"},
                                                              {"displacement_gradient_yx"},
                                                              {"displacement_gradient_yy"},
                                                              {"displacement_gradient_zz"}}};

// What a law answers to a step of large strain, at one point or at four side by side.
template <class Real>
struct LogPoints {
  Tensor<Real> tau0, tau;         // Kirchhoff stress, committed and tried
  Tensor<Real> trial, deps;       // elastic trial strain, without a factor at the shear; increment for the law
  std::array<Tensor<Real>, 4> D;  // D[i][j] = d(tau_i)/d(trial strain_j)
};

// Stiffness by displacement gradients [xx yy zz xy yx], of stress components in the same order.
enum GradientComponent : std::size_t { kXx, kYy, kZz, kXy, kYx };
template <class Real>
using GradientStiffness = std::array<std::array<Real, 5>, 5>;

// Sets trial and deps.  tau0 has an elastic strain without change of volume: that part is the same in the trial strain,
// whatever it is.  step: gradient of the displacements since the committed state, by the places of that state.  False where
// it turns a point inside out.
template <class Real>
bool find_trial_strain(const Real& G, const PlaneGradient<Real>& step, LogPoints<Real>& point) {
  const Tensor<Real>& tau = point.tau0;
  const Real mean = (tau[0] + tau[1] + tau[2]) / 3.0, by_G = 0.5 / G;
  const Tensor<Real> elastic{(tau[0] - mean) * by_G, (tau[1] - mean) * by_G, (tau[2] - mean) * by_G,
                             tau[3] * by_G};
  if (!half_log(pushed_forward(stretch_of(elastic), step), point.trial)) return false;
  for (std::size_t i = 0; i < 4; ++i) point.deps[i] = point.trial[i] - elastic[i];
  point.deps[3] *= 2.0;
  return true;
}

// In the moved place: D d(trial strain)/d(gradient).
template <class Real>
GradientStiffness<Real> log_stiffness(const LogPoints<Real>& point) {
  const LogRate<Real> rate(point.trial);
  const Real across = 0.5 * rate.curve * rate.turn[0], along = 0.25 * rate.curve * rate.turn[3];
  GradientStiffness<Real> C;
  for (std::size_t i = 0; i < 4; ++i) {
    const Tensor<Real>& D = point.D[i];
    const Real turned = D[0] * rate.turn[0] + D[1] * rate.turn[1] + D[3] * rate.turn[3];
    C[i] = {D[0] + across * turned, D[1] - across * turned, D[2], D[3] + (along - 0.5) * turned,
            D[3] + (along + 0.5) * turned};
  }
  C[kYx] = C[kXy];
  return C;
}

// Adds the part from the turn of the gradients of shape functions under a constant stress: -tau l^T.
template <class Real>
void add_initial_stress_stiffness(const Tensor<Real>& tau, GradientStiffness<Real>& C) {
  C[kXx][kXx] -= tau[0], C[kXx][kXy] -= tau[3];
  C[kXy][kYx] -= tau[0], C[kXy][kYy] -= tau[3];
  C[kYx][kXx] -= tau[3], C[kYx][kXy] -= tau[1];
  C[kYy][kYx] -= tau[3], C[kYy][kYy] -= tau[1];
  C[kZz][kZz] -= tau[2];
}

// Points are computed in blocks, one in each place of Real; the last places of the last block repeat the last point.
template <class Shape, class Kinematics, class Rule, AssumedStrain strain,
          class Real = std::conditional_t<(Rule::points < 3), double, Four>>
class LargeStrain final : public Element {
  static_assert(strain != AssumedStrain::enhanced);
  static constexpr int kNodes = Shape::nodes, kDofs = 2 * kNodes;
  static constexpr std::size_t kPoints = Rule::points, kOwn = kLargeStrainHistory.size();
  static constexpr std::size_t kTogether = kPlaces<Real>, kBlocks = (kPoints + kTogether - 1) / kTogether;
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
    for (std::size_t b = 0; b < kBlocks; ++b)
      for (std::size_t l = 0; l < kTogether; ++l) {
        const RulePoint& at = Rule::table[point(b, l)];
        blocks_[b].take(ShapeAt<Shape>({at.xi, at.eta}, at.w), l);
      }
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
    const std::size_t of_law = law.traits().history.size(), stride = of_law + kOwn;
    // A loop for each part of a point's work: the processor then works at several points at once.
    std::array<Moved, kBlocks> moved;
    std::array<LogPoints<Real>, kBlocks> points;
    Dilatation whole;
    const Motion motion(in);
    for (std::size_t b = 0; b < kBlocks; ++b)
      if (!move(motion, b, gradient_from(in.h0 + of_law, stride, b), moved[b])) return Outcome::cut_step;
    if constexpr (kMean) {
      whole.sum(moved);
      for (Moved& m : moved) whole.take_mean(m);
    }
    for (std::size_t b = 0; b < kBlocks; ++b) {
      store_gradient(moved[b].total, stride, b, out.h1 + of_law);
      if (!find_strains(law, in, b, stride, moved[b], points[b], out)) return Outcome::cut_step;
    }
    for (std::size_t b = 0; b < kBlocks; ++b) {
      if (find_stresses(law, in, b, stride, points[b], out) != Outcome::ok) return Outcome::cut_step;
      Tensor<Real> sigma = points[b].tau;
      for (Real& component : sigma) component /= 1.0 + moved[b].change;
      scatter(sigma, b, out.sigma1);
    }
    Forces f;
    for (std::size_t b = 0; b < kBlocks; ++b) add_forces(b, moved[b], whole, points[b].tau, f);
    write(f, out);
    if (out.K != nullptr) {
      Stiffness K;
      for (std::size_t b = 0; b < kBlocks; ++b) add_stiffness(b, moved[b], whole, points[b], K);
      if constexpr (kMean) add_volume_curvature(moved, whole, K);
      write(K, out.K);
    }
    if (!in.edges.empty()) follow_edges(in, out);
    return Outcome::ok;
  }

 private:
  // The point of a place in a block.
  static constexpr std::size_t point(std::size_t b, std::size_t l) {
    return std::min(b * kTogether + l, kPoints - 1);
  }
  // Points of a block, without those that stand there again.
  static constexpr std::size_t used(std::size_t b) { return std::min(kTogether, kPoints - b * kTogether); }

  // Shape functions at the points of a block.
  struct Block {
    std::array<Real, kNodes> N, dN_xi, dN_eta;
    Real w;
    std::array<ShapeAt<Shape>, kTogether> at;
    void take(const ShapeAt<Shape>& shape, std::size_t l) {
      for (std::size_t i = 0; i < kNodes; ++i) {
        place(N[i], l) = shape.N[i];
        place(dN_xi[i], l) = shape.dN(i, 0);
        place(dN_eta[i], l) = shape.dN(i, 1);
      }
      place(w, l) = shape.w;
      at[l] = shape;
    }
  };
  // Places of the nodes in the committed state, and how they move from there.
  struct Motion {
    Coordinates before, du;
    explicit Motion(const ElementIn& in)
        : before(Coordinates::Map(in.x) + Coordinates::Map(in.u0)), du(Coordinates::Map(in.du)) {}
  };
  // Gradients of the shape functions where the element is.
  struct Gradients {
    Nodes x, y, hoop;
  };
  struct Moved {
    Real volume;                                // now
    Real reference;                             // of what is free of stress
    Real change0, change;                       // volume over that less 1, of the strain that the law sees
    PlaneGradient<Real> step, total, strained;  // strained: as the law sees it
    std::array<Gradients, kTogether> at;
  };
  // Of the element, for strains with its mean change of volume.
  struct Dilatation {
    double volume = 0.0, reference = 0.0;
    double growth0 = 0.0, growth = 0.0;            // sums of reference times change0 and change
    Nodes bx = Nodes::Zero(), by = Nodes::Zero();  // sum of volume times (N,x + N/r), N,y
    double pressure = 0.0;                         // sum of reference times tr(tau)/3

    void sum(const std::array<Moved, kBlocks>& moved) {
      for (std::size_t p = 0; p < kPoints; ++p) {
        const Moved& m = moved[p / kTogether];
        const std::size_t l = p % kTogether;
        const double of_point = place(m.volume, l), of_reference = place(m.reference, l);
        volume += of_point;
        reference += of_reference;
        growth0 += of_reference * place(m.change0, l);
        growth += of_reference * place(m.change, l);
        bx += of_point * (m.at[l].x + m.at[l].hoop);
        by += of_point * m.at[l].y;
      }
    }
    // Scales the step and the whole deformation to the mean change of volume.  Small changes keep their digits.
    void take_mean(Moved& m) const {
      const double mean0 = growth0 / reference, mean = growth / reference;
      const Real log0 = log_1_plus(mean0) - log_1_plus(m.change0),
                 log = log_1_plus(mean) - log_1_plus(m.change);
      m.strained = scaled(m.total, exp_less_1(log / 3.0));
      m.step = scaled(m.step, exp_less_1((log - log0) / 3.0));
      m.change0 = everywhere<Real>(mean0);
      m.change = everywhere<Real>(mean);
    }
    // What the mean adds to a third of a point's own dilatation, by displacements along x and y.
    Nodes third_x(const Gradients& g) const { return bx / (3.0 * volume) - (g.x + g.hoop) / 3.0; }
    Nodes third_y(const Gradients& g) const { return by / (3.0 * volume) - g.y / 3.0; }

    static PlaneGradient<Real> scaled(const PlaneGradient<Real>& g, const Real& more) {
      const Real by = 1.0 + more;
      return {more + by * g.xx, by * g.xy, by * g.yx, more + by * g.yy, more + by * g.zz};
    }
  };
  struct Forces {
    Nodes x = Nodes::Zero(), y = Nodes::Zero();
  };
  // A row of an operator: the component of the gradient that a displacement of the nodes changes by so much.
  struct Row {
    GradientComponent component;
    Nodes by;
  };
  // Stiffness as a sum of products of a force pattern and what a displacement of the nodes along x and y makes of it.
  template <std::size_t kMost>
  struct Products {
    std::size_t count = 0;
    std::array<Nodes, kMost> force, by_x, by_y;
  };
  static constexpr std::size_t kRowsX = kRing ? 3 : 2, kRowsY = 2;  // of a point's own operator
  struct Stiffness {
    Products<kPoints*(kMean ? 4 + 2 * kRowsX : kRowsX) + (kMean ? 1 : 0)> x;  // forces along x
    Products<kPoints*(kMean ? 4 + 2 * kRowsY : kRowsY) + (kMean ? 1 : 0)> y;
  };

  // Tensors of a block's points, from and to those of all points in turn.
  static Tensor<Real> gather(const double* from, std::size_t b) {
    Tensor<Real> t;
    if constexpr (kTogether == 1)
      std::copy_n(from + 4 * b, 4, t.begin());
    else
      t = gather_four(
          {from + 4 * point(b, 0), from + 4 * point(b, 1), from + 4 * point(b, 2), from + 4 * point(b, 3)}, 0);
    return t;
  }
  static void scatter(const Tensor<Real>& t, std::size_t b, double* to) {
    if constexpr (kTogether == 1)
      std::ranges::copy(t, to + 4 * b);
    else
      scatter_four(t, {to + 4 * point(b, 0), to + 4 * point(b, 1), to + 4 * point(b, 2), to + 4 * point(b, 3)},
                   0);
  }

  // History of the element at a block's points: `at` of the first point, and from one to the next.
  static PlaneGradient<Real> gradient_from(const double* at, std::size_t stride, std::size_t b) {
    PlaneGradient<Real> g;
    for (std::size_t l = 0; l < kTogether; ++l) {
      const double* const h = at + point(b, l) * stride;
      place(g.xx, l) = h[0], place(g.xy, l) = h[1], place(g.yx, l) = h[2], place(g.yy, l) = h[3];
      place(g.zz, l) = h[4];
    }
    return g;
  }
  static void store_gradient(const PlaneGradient<Real>& g, std::size_t stride, std::size_t b, double* at) {
    for (std::size_t l = 0; l < kTogether; ++l) {
      double* const h = at + point(b, l) * stride;
      h[0] = place(g.xx, l), h[1] = place(g.xy, l), h[2] = place(g.yx, l), h[3] = place(g.yy, l);
      h[4] = place(g.zz, l);
    }
  }

  // False where the element is turned inside out.
  bool move(const Motion& to, std::size_t b, const PlaneGradient<Real>& last, Moved& m) const {
    const Block& block = blocks_[b];
    Real x_xi{}, x_eta{}, y_xi{}, y_eta{}, dx_xi{}, dx_eta{}, dy_xi{}, dy_eta{}, r0{}, dr{};
#pragma GCC unroll 15
    for (int i = 0; i < kNodes; ++i) {
      const Real &xi = block.dN_xi[i], &eta = block.dN_eta[i];
      x_xi += to.before(0, i) * xi, x_eta += to.before(0, i) * eta;
      y_xi += to.before(1, i) * xi, y_eta += to.before(1, i) * eta;
      dx_xi += to.du(0, i) * xi, dx_eta += to.du(0, i) * eta;
      dy_xi += to.du(1, i) * xi, dy_eta += to.du(1, i) * eta;
      if constexpr (kRing) r0 += to.before(0, i) * block.N[i], dr += to.du(0, i) * block.N[i];
    }
    if constexpr (!kRing) r0 = everywhere<Real>(1.0);
    const Real r = r0 + dr;
    const Real J_xx = x_xi + dx_xi, J_xy = x_eta + dx_eta, J_yx = y_xi + dy_xi, J_yy = y_eta + dy_eta;
    const Real det0 = x_xi * y_eta - x_eta * y_xi, det = J_xx * J_yy - J_xy * J_yx;
    if (!holds_everywhere(det0 > 0.0) || !holds_everywhere(det > 0.0)) return false;
    if (kRing && (!holds_everywhere(r0 > 0.0) || !holds_everywhere(r > 0.0))) return false;
    const Real by_det = 1.0 / det, by_r = 1.0 / r, by_det0 = 1.0 / det0;
    const Real xi_x = J_yy * by_det, eta_x = -J_yx * by_det, xi_y = -J_xy * by_det, eta_y = J_xx * by_det;
    for (std::size_t l = 0; l < used(b); ++l) {
      const ShapeAt<Shape>& at = block.at[l];
      const auto dN_xi = at.dN.col(0), dN_eta = at.dN.col(1);
      m.at[l].x = place(xi_x, l) * dN_xi + place(eta_x, l) * dN_eta;
      m.at[l].y = place(xi_y, l) * dN_xi + place(eta_y, l) * dN_eta;
      if constexpr (kRing)
        m.at[l].hoop = place(by_r, l) * at.N;
      else
        m.at[l].hoop.setZero();
    }
    // d(du)/dx by the committed places
    m.step = {(dx_xi * y_eta - dx_eta * y_xi) * by_det0, (dx_eta * x_xi - dx_xi * x_eta) * by_det0,
              (dy_xi * y_eta - dy_eta * y_xi) * by_det0, (dy_eta * x_xi - dy_xi * x_eta) * by_det0, dr / r0};
    m.total = m.strained = followed_by(last, m.step);
    m.change0 = last.volume_change();
    m.change = m.total.volume_change();
    m.volume = block.w * det * Kinematics::measure(r);
    m.reference = block.w * det0 * Kinematics::measure(r0) / (1.0 + m.change0);
    return holds_everywhere(m.change > -1.0);
  }

  // Strains of the law and of the whole deformation.  False where a point is turned inside out.
  static bool find_strains(const ElasticShear& law, const ElementIn& in, std::size_t b, std::size_t stride,
                           const Moved& m, LogPoints<Real>& points, ElementOut& out) {
    points.tau0 = gather(in.sigma0, b);
    for (Real& component : points.tau0) component *= 1.0 + m.change0;
    Real G;
    for (std::size_t l = 0; l < kTogether; ++l)
      place(G, l) = law.shear_modulus(place(points.tau0, l), {in.h0 + point(b, l) * stride, stride - kOwn});
    Tensor<Real> total;
    if (!find_trial_strain(G, m.step, points) || !half_log(pushed_forward({}, m.strained), total)) return false;
    total[3] *= 2.0;
    scatter(total, b, out.eps1);
    return true;
  }

  static PointIn<4> input_of(const ElementIn& in, std::size_t p, std::size_t stride,
                             const LogPoints<Real>& points, std::size_t l) {
    PointIn<4> to;
    to.sigma0 = place(points.tau0, l);
    to.eps0 = Vector4::Map(in.eps0 + 4 * p);
    to.deps = place(points.deps, l);
    to.h0 = {in.h0 + p * stride, stride - kOwn};
    to.context = in.contexts != nullptr ? in.contexts + p : nullptr;
    return to;
  }
  static Outcome find_stresses(const SolidLaw& law, const ElementIn& in, std::size_t b, std::size_t stride,
                               LogPoints<Real>& points, ElementOut& out) {
    if constexpr (kTogether == kAbreast)
      if (in.four_law != nullptr) return find_four_stresses(*in.four_law, in, b, stride, points, out);
    PointOut<4> answer;  // places of the last point that stand there again get its answer
    for (std::size_t l = 0; l < kTogether; ++l) {
      if (l < used(b)) {
        const std::size_t p = point(b, l);
        answer = {};
        answer.h1 = {out.h1 + p * stride, stride - kOwn};
        if (law.update(input_of(in, p, stride, points, l), answer) != Outcome::ok) return Outcome::cut_step;
        out.status[p] = answer.status;
      }
      for (std::size_t i = 0; i < 4; ++i) {
        place(points.tau[i], l) = answer.sigma[i];
        for (std::size_t j = 0; j < 4; ++j) place(points.D[i][j], l) = answer.D(i, j);
      }
    }
    return Outcome::ok;
  }

  static Outcome find_four_stresses(const FourPointLaw<4>& law, const ElementIn& in, std::size_t b,
                                    std::size_t stride, LogPoints<Real>& points, ElementOut& out) {
    FourPointsIn<4> to{points.tau0, gather(in.eps0, b), points.deps, {}};
    FourPointsOut<4> answer;
    for (std::size_t l = 0; l < kTogether; ++l) {
      to.h0[l] = in.h0 + point(b, l) * stride;
      answer.h1[l] = out.h1 + point(b, l) * stride;
    }
    if (law.update_four({&to, 1}, {&answer, 1}) != Outcome::ok) return Outcome::cut_step;
    points.tau = answer.sigma;
    points.D = answer.D;
    for (std::size_t l = 0; l < kTogether; ++l) out.status[point(b, l)] = answer.status[l];
    return Outcome::ok;
  }

  // Adds operator^T C operator, of the rows u by displacements along x and v along y.  C: of one point, a component every
  // kTogether doubles.
  template <std::size_t U, std::size_t V>
  static void add_product(const std::array<Row, U>& u, const std::array<Row, V>& v, const double* C,
                          Stiffness& K) {
    const auto component_by = [&](std::size_t k, const auto& rows) -> Nodes {
      Nodes sum = C[(5 * k + rows[0].component) * kTogether] * rows[0].by;
      for (std::size_t m = 1; m < rows.size(); ++m)
        sum += C[(5 * k + rows[m].component) * kTogether] * rows[m].by;
      return sum;
    };
    const auto add = [&](const auto& rows, auto& to) {
      for (const Row& row : rows) {
        to.force[to.count] = row.by;
        to.by_x[to.count] = component_by(row.component, u);
        to.by_y[to.count] = component_by(row.component, v);
        ++to.count;
      }
    };
    add(u, K.x);
    add(v, K.y);
  }
  static void add_plain(const Gradients& g, const double* C, Stiffness& K) {
    const std::array<Row, 2> v{{{kYy, g.y}, {kYx, g.x}}};
    if constexpr (kRing)
      add_product(std::array<Row, 3>{{{kXx, g.x}, {kXy, g.y}, {kZz, g.hoop}}}, v, C, K);
    else
      add_product(std::array<Row, 2>{{{kXx, g.x}, {kXy, g.y}}}, v, C, K);
  }
  // The same with the mean dilatation in place of the point's own.
  static void add_mean(const Gradients& g, const Nodes& cx, const Nodes& cy, const double* C, Stiffness& K) {
    add_product(std::array<Row, 4>{{{kXx, g.x + cx}, {kYy, cx}, {kZz, g.hoop + cx}, {kXy, g.y}}},
                std::array<Row, 4>{{{kXx, cy}, {kYy, g.y + cy}, {kZz, cy}, {kYx, g.x}}}, C, K);
  }

  static void multiply_by(const Real& w, GradientStiffness<Real>& C) {
    for (auto& row : C)
      for (Real& c : row) c *= w;
  }
  static const double* of_place(const GradientStiffness<Real>& C, std::size_t l) {
    return reinterpret_cast<const double*>(&C) + l;
  }

  static void add_forces(std::size_t b, const Moved& m, Dilatation& whole, const Tensor<Real>& tau, Forces& f) {
    for (std::size_t l = 0; l < used(b); ++l) {
      const Gradients& g = m.at[l];
      const Vector4 w_tau = place(m.reference, l) * place(tau, l);
      f.x += w_tau[0] * g.x + w_tau[3] * g.y + w_tau[2] * g.hoop;
      f.y += w_tau[3] * g.x + w_tau[1] * g.y;
      if constexpr (kMean) {
        const double trace = w_tau[0] + w_tau[1] + w_tau[2];
        f.x += trace * whole.third_x(g);
        f.y += trace * whole.third_y(g);
        whole.pressure += trace / 3.0;
      }
    }
  }

  static void add_stiffness(std::size_t b, const Moved& m, const Dilatation& whole,
                            const LogPoints<Real>& points, Stiffness& K) {
    const Tensor<Real>& tau = points.tau;
    GradientStiffness<Real> C = log_stiffness(points);
    if constexpr (!kMean) {
      add_initial_stress_stiffness(tau, C);
      multiply_by(m.reference, C);
      for (std::size_t l = 0; l < used(b); ++l) add_plain(m.at[l], of_place(C, l), K);
    } else {
      const Real pressure = (tau[0] + tau[1] + tau[2]) / 3.0;
      GradientStiffness<Real> C_turn{};
      add_initial_stress_stiffness({tau[0] - pressure, tau[1] - pressure, tau[2] - pressure, tau[3]}, C_turn);
      multiply_by(m.reference, C);
      multiply_by(m.reference, C_turn);
      for (std::size_t l = 0; l < used(b); ++l) {
        const Gradients& g = m.at[l];
        add_mean(g, whole.third_x(g), whole.third_y(g), of_place(C, l), K);
        add_plain(g, of_place(C_turn, l), K);
      }
    }
  }

  // The mean pressure times the second derivative of the logarithm of the element's volume.
  static void add_volume_curvature(const std::array<Moved, kBlocks>& moved, const Dilatation& whole,
                                   Stiffness& K) {
    GradientStiffness<Real> unit{};
    for (const std::size_t i : {kXx, kYy, kZz})
      for (const std::size_t j : {kXx, kYy, kZz}) unit[i][j] = everywhere<Real>(1.0);
    const Real one = everywhere<Real>(1.0);
    add_initial_stress_stiffness({one, one, one, Real{}}, unit);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      GradientStiffness<Real> C = unit;
      multiply_by(whole.pressure / whole.volume * moved[b].volume, C);
      for (std::size_t l = 0; l < used(b); ++l) add_plain(moved[b].at[l], of_place(C, l), K);
    }
    const double less = -whole.pressure / (whole.volume * whole.volume);
    add_product(std::array<Row, 1>{{{kXx, whole.bx}}}, std::array<Row, 1>{{{kXx, whole.by}}}, &less, K);
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

  static void write(const Forces& f, ElementOut& out) {
    Eigen::Map<Coordinates> to(out.f);
    to.row(0) = f.x;
    to.row(1) = f.y;
  }
  // The columns of one node at a time: their sums stay in registers.
  static void write(const Stiffness& K, double* to) {
    const auto sum = [](const auto& products, int j, Nodes& by_x, Nodes& by_y) {
      by_x = products.force[0] * products.by_x[0][j];
      by_y = products.force[0] * products.by_y[0][j];
      for (std::size_t k = 1; k < products.count; ++k) {
        by_x += products.force[k] * products.by_x[k][j];
        by_y += products.force[k] * products.by_y[k][j];
      }
    };
    Nodes xx, xy, yx, yy;
    for (int j = 0; j < kNodes; ++j, to += 2 * kDofs) {
      sum(K.x, j, xx, xy);
      sum(K.y, j, yx, yy);
      interleave(xx, yx, to);
      interleave(xy, yy, to + kDofs);
    }
  }
  // x1 y1 x2 y2 ...
  static void interleave(const Nodes& x, const Nodes& y, double* to) {
    constexpr int kFours = kNodes / kAbreast * kAbreast;
    for (int i = 0; i < kFours; i += kAbreast) {
      const Four a = load_four(x.data() + i), b = load_four(y.data() + i);
      store_four(to + 2 * i, __builtin_shufflevector(a, b, 0, 4, 1, 5));
      store_four(to + 2 * i + kAbreast, __builtin_shufflevector(a, b, 2, 6, 3, 7));
    }
    for (int i = kFours; i < kNodes; ++i) to[2 * i] = x[i], to[2 * i + 1] = y[i];
  }

  std::string name_;
  Small small_;
  ElementTraits traits_;
  std::array<Block, kBlocks> blocks_;
};

}  // namespace sage
