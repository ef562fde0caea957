#include "elements/beam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "elements/edge_load.hpp"
#include "elements/extrapolation.hpp"

namespace sage {

namespace {

enum Strain { kAxial, kHoop, kShear, kBending, kHoopBending };
constexpr int kStrains = 5;
constexpr int kJoined = 6, kPoints = 3;  // of the beam with two nodes: dofs without a slip
using Operator2 = OperatorT<kStrains, kJoined>;
using Strains = Vector<kStrains>;

// Ends and middle with Simpson's weights: exact for the square of a linear curvature.
constexpr std::array<LinePoint, kPoints> kEndsAndMiddle{
    {{-1.0, 1.0 / 3.0}, {0.0, 4.0 / 3.0}, {1.0, 1.0 / 3.0}}};

// Rotation and deflection of the beam with two nodes at xi, from (w1, w2, theta1, theta2, gamma):
// theta = N . theta_i + a (1 - xi^2) with gamma the same everywhere asks for a = 3/2 ((w2 - w1)/L - mean theta -
// gamma), and w' = theta + gamma.
struct Linked {
  Vector<5> theta, slope, w;  // slope: of theta along the line

  Linked(double xi, double L) {
    const Vector<5> a = Vector<5>(-1.5 / L, 1.5 / L, -0.75, -0.75, -1.5);
    const double bubble = 1.0 - xi * xi;
    theta = Vector<5>(0.0, 0.0, 0.5 * (1.0 - xi), 0.5 * (1.0 + xi), 0.0) + bubble * a;
    slope = Vector<5>(0.0, 0.0, -1.0 / L, 1.0 / L, 0.0) - 4.0 * xi / L * a;
    // Integrals from the first end of N1, N2, 1 - xi^2 and 1.
    const double whole = xi + 1.0, square = 0.25 * (xi * xi - 1.0), cubic = xi - xi * xi * xi / 3.0 + 2.0 / 3.0;
    w = Vector<5>(1.0, 0.0, 0.0, 0.0, 0.0) +
        0.5 * L * (Vector<5>(0.0, 0.0, 0.5 * whole - square, 0.5 * whole + square, whole) + cubic * a);
  }
};

// Rows of the dofs of both nodes from what a local quantity has of (w1, w2, theta1, theta2), and of the
// displacements along the line (s1, s2).
void set_column(const LineFrame& frame, const Vector2& along, const Vector<5>& across, int strain,
                Operator2& Bt, Strains& G) {
  for (int i = 0; i < 2; ++i) {
    Bt.block<2, 1>(2 * i, strain) = along(i) * frame.t + across(i) * frame.n;
    Bt(4 + i, strain) = across(2 + i);
  }
  G(strain) = across(4);
}

// Along which the first end may part from its node.
Vector2 slip_direction(Release released, const LineFrame& at_end) {
  return released == Release::shear ? at_end.n : at_end.t;
}

// What the slip adds to a list of loads of dofs: the end goes where node and slip take it.
template <Release released>
void add_slip(const LineFrame& at_end, std::span<double> f) {
  if constexpr (released != Release::none) {
    const Vector2 along = slip_direction(released, at_end);
    f.back() = along.x() * f[0] + along.y() * f[1];
  }
}

// B^T of a point, behind that of the other dofs the row of the slip.
template <Release released, int Dofs>
void put_operator(const LineFrame& at_end, const OperatorT<kStrains, Dofs - slip_dofs(released)>& Bt,
                  double* to) {
  Eigen::Map<OperatorT<kStrains, Dofs>> all(to);
  all.template topRows<Dofs - slip_dofs(released)>() = Bt;
  if constexpr (released != Release::none) {
    const Vector2 along = slip_direction(released, at_end);
    all.row(Dofs - 1) = along.x() * Bt.row(0) + along.y() * Bt.row(1);
  }
}

// On the axis nothing is left of an end that slips.
template <class Kinematics, Release released>
void check_release(const NodeCoordinates& x) {
  if constexpr (released != Release::none && Kinematics::geometry == Geometry::axisymmetric)
    if (x(0, 0) <= kRadiusTolerance * extent(x))
      throw ElementShapeError(
          "beam: an end that is released along the line or across it can't lie on the axis");
}

// Strains at a point: B^T for the dofs and G for gamma.
template <class Kinematics>
void strains_at(const LineFrame& frame, double L, double xi, double r, Operator2& Bt, Strains& G) {
  const Linked linked(xi, L);
  const Vector2 N = Line2::N(xi), stretch(-1.0 / L, 1.0 / L);
  const Vector<5> none = Vector<5>::Zero(), gamma = Vector<5>::Unit(4);
  set_column(frame, stretch, none, kAxial, Bt, G);
  set_column(frame, Vector2::Zero(), gamma, kShear, Bt, G);
  set_column(frame, Vector2::Zero(), linked.slope, kBending, Bt, G);
  if constexpr (Kinematics::geometry == Geometry::plane_strain) {
    set_column(frame, Vector2::Zero(), none, kHoop, Bt, G);
    set_column(frame, Vector2::Zero(), none, kHoopBending, Bt, G);
  } else if (r > kRadiusTolerance * L) {
    set_column(frame, frame.t.x() / r * N, frame.n.x() / r * linked.w, kHoop, Bt, G);
    set_column(frame, Vector2::Zero(), frame.t.x() / r * linked.theta, kHoopBending, Bt, G);
  } else {
    // On the axis u_r = 0 and theta = 0: the limits of u_r / r and theta t_r / r are their slopes.
    set_column(frame, stretch, frame.n.x() / frame.t.x() * (linked.theta + gamma), kHoop, Bt, G);
    set_column(frame, Vector2::Zero(), linked.slope, kHoopBending, Bt, G);
  }
}

// What geometry() of the beam with two nodes writes behind its points.
constexpr int kModes = 4;  // gamma, stretch of the first and the second end, both ends' turn
using Modes = Eigen::Matrix<double, kStrains, kModes>;
struct Own {
  const double* from;
  static constexpr int kSize = kPoints * kStrains * kModes + 4;
  // Strains of unit modes at a point; the first column is G.
  Eigen::Map<const Modes> modes(std::size_t p) const {
    return Eigen::Map<const Modes>(from + p * kStrains * kModes);
  }
  Vector2 t() const { return Vector2::Map(from + kPoints * kStrains * kModes); }
  double measure(std::size_t end) const {
    return from[kPoints * kStrains * kModes + 2 + static_cast<int>(end)];
  }
};

// The points of one element, as evaluate() sees them.
template <int Dofs>
struct Points {
  Own own;
  std::array<double, kPoints> w{};
  std::array<OperatorT<kStrains, Dofs>, kPoints> Bt;
  std::array<Strains, kPoints> G, deps, sigma;
  std::array<Matrix<kStrains>, kPoints> D;

  explicit Points(const double* geometry) : own{geometry + kPoints * kPointStride<kStrains, Dofs>} {
    for (std::size_t p = 0; p < kPoints; ++p) {
      const double* block = geometry + p * kPointStride<kStrains, Dofs>;
      w[p] = *block;
      Bt[p] = OperatorT<kStrains, Dofs>::Map(block + 1);
      G[p] = own.modes(p).col(0);
    }
  }
};

// Asks the law at all points.  inner(p): strain increments there beside those of the dofs.
template <int Dofs, class Inner>
Outcome update_points(const Law<kStrains>& law, const ElementIn& in, const Inner& inner, Points<Dofs>& points,
                      ElementOut& out) {
  const std::size_t history = law.traits().history.size();
  const auto du = Vector<Dofs>::Map(in.du);
  PointIn<kStrains> point;
  for (std::size_t p = 0; p < kPoints; ++p) {
    PointOut<kStrains> result;
    point.sigma0 = Strains::Map(in.sigma0 + p * kStrains);
    point.eps0 = Strains::Map(in.eps0 + p * kStrains);
    point.deps = points.Bt[p].transpose() * du + inner(p);
    point.h0 = {in.h0 + p * history, history};
    result.h1 = {out.h1 + p * history, history};
    point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
    if (law.update(point, result) != Outcome::ok) return Outcome::cut_step;
    points.deps[p] = point.deps;
    points.sigma[p] = result.sigma;
    points.D[p] = result.D;
    Strains::Map(out.sigma1 + p * kStrains) = result.sigma;
    Strains::Map(out.eps1 + p * kStrains) = point.eps0 + point.deps;
    out.status[p] = result.status;
  }
  return Outcome::ok;
}

// What gamma does work on: its balance, the balance's slope and the size of its terms.
struct ShearBalance {
  double sum = 0.0, slope = 0.0, size = 0.0;

  template <int Dofs>
  explicit ShearBalance(const Points<Dofs>& points) {
    for (std::size_t p = 0; p < kPoints; ++p) {
      sum += points.w[p] * points.G[p].dot(points.sigma[p]);
      slope += points.w[p] * points.G[p].dot(points.D[p] * points.G[p]);
      size += points.w[p] * points.G[p].cwiseProduct(points.sigma[p]).cwiseAbs().sum();
    }
  }
};

// Newton for the increment of gamma, within the bracket that the signs seen so far leave: the balance grows with
// gamma wherever the law's tangent is positive.
class ShearSearch {
 public:
  // False: gamma stands.
  bool next(const ShearBalance& balance, double& gamma) {
    constexpr double kSmall = 1e-14;
    if (std::abs(balance.sum) <= kSmall * balance.size || !(balance.slope > 0.0)) return false;
    (balance.sum > 0.0 ? high_ : low_) = gamma;
    double to = gamma - balance.sum / balance.slope;
    if (std::isfinite(low_) && std::isfinite(high_) && !(to > low_ && to < high_)) to = 0.5 * (low_ + high_);
    if (std::abs(to - gamma) <= 1e-15 * std::max(std::abs(to), std::abs(gamma))) return false;
    gamma = to;
    return true;
  }

 private:
  double low_ = -std::numeric_limits<double>::infinity(), high_ = std::numeric_limits<double>::infinity();
};

// f and K of the dofs, gamma eliminated.
template <int Dofs>
void condense(const Points<Dofs>& points, double slope, ElementOut& out) {
  Vector<Dofs> f = Vector<Dofs>::Zero(), right = f, left = f;
  Matrix<Dofs> K = Matrix<Dofs>::Zero();
  for (std::size_t p = 0; p < kPoints; ++p) {
    f += points.Bt[p] * (points.w[p] * points.sigma[p]);
    if (out.K == nullptr) continue;
    const Matrix<kStrains> wD = points.w[p] * points.D[p];
    K += points.Bt[p] * wD * points.Bt[p].transpose();
    right += points.Bt[p] * (wD * points.G[p]);
    left += points.Bt[p] * (wD.transpose() * points.G[p]);
  }
  Vector<Dofs>::Map(out.f) = f;
  if (out.K == nullptr) return;
  if (slope > 0.0) K -= right * left.transpose() / slope;
  Matrix<Dofs>::Map(out.K) = K;
}

// Sections that may yield.  Axial force and moment of the points at the ends are then those that the ends put on their
// nodes, loads along the element included: the strains of the points get modes of their own (an end's stretch and turn,
// undone by the element between), whose work is that condition.  docs/theory/structures.md, docs/decisions/0042

// What the loads along an element are to those conditions.
template <int Dofs>
struct Along {
  Vector<kModes> work = Vector<kModes>::Zero();
  double odd = 0.0, odd_strain = 0.0;  // moment of the first end, and minus that of the second, of uneven loads

  Along(const Points<Dofs>& points, const ElementIn& in, double EI) {
    if (in.spread == nullptr) return;
    const auto load = Vector<Dofs>::Map(in.spread), before = Vector<Dofs>::Map(in.spread0);
    const Vector2 t = points.own.t();
    work << 0.0, -load.template head<2>().dot(t), load.template segment<2>(2).dot(t), load(5) - load(4);
    const double first = points.own.measure(0), second = points.own.measure(1);
    if (!(first > 0.0 && second > 0.0)) return;
    const auto moment = [&](const auto& f) { return 0.5 * (f(4) / first + f(5) / second); };
    odd = moment(load);
    odd_strain = EI > 0.0 ? (odd - moment(before)) / EI : 0.0;
  }
  // Its sign at a point.
  static double side(std::size_t p) { return 1.0 - static_cast<double>(p); }
};

// The law's stiffness where nothing has happened.  The history at the points' ends is room for it.
Outcome first_stiffness(const Law<kStrains>& law, const ElementIn& in, ElementOut& out, Matrix<kStrains>& D) {
  const std::span<const Quantity> history = law.traits().history;
  for (std::size_t i = 0; i < history.size(); ++i) out.h1[i] = history[i].initial;
  PointIn<kStrains> point;
  PointOut<kStrains> result;
  point.sigma0 = point.eps0 = point.deps = Strains::Zero();
  point.h0 = {out.h1, history.size()};
  result.h1 = {out.h1 + history.size(), history.size()};
  point.context = in.contexts;
  const Outcome outcome = law.update(point, result);
  D = result.D;
  return outcome;
}

// Points whose law is asked; the others answer by the first stiffness, until it turns out that their law does not.  One
// after the other is added, where the law differs most: what an element yields by is then found beside elastic points,
// and not from a state in which all of them are at their strength.
template <int Dofs>
class Asked {
 public:
  Asked(const ElementIn& in, const Matrix<kStrains>& D) : in_(&in), D_(&D) {}

  // Puts the first stiffness in the place of the answers of the others.
  void take(Points<Dofs>& points) {
    for (std::size_t p = 0; p < kPoints; ++p) {
      if (asked_[p]) continue;
      const Strains elastic = Strains::Map(in_->sigma0 + p * kStrains) + *D_ * points.deps[p];
      differs_[p] = energy(points.sigma[p] - elastic);
      if (!(differs_[p] > kSame * energy(elastic))) differs_[p] = 0.0;
      points.sigma[p] = elastic;
      points.D[p] = *D_;
    }
  }
  // Asks one more; false: all of the others answer so.
  bool add() {
    std::size_t most = 0;
    for (std::size_t p = 1; p < kPoints; ++p)
      if (differs_[p] > differs_[most]) most = p;
    if (!(differs_[most] > 0.0)) return false;
    asked_[most] = true;
    differs_[most] = 0.0;
    return true;
  }

 private:
  static constexpr double kSame = 1e-22;
  double energy(const Strains& sigma) const {
    double sum = 0.0;
    for (int i = 0; i < kStrains; ++i)
      if ((*D_)(i, i) > 0.0) sum += sigma(i) * sigma(i) / (*D_)(i, i);
    return sum;
  }

  const ElementIn* in_;
  const Matrix<kStrains>* D_;
  std::array<bool, kPoints> asked_{};
  std::array<double, kPoints> differs_{};
};

// What the modes do work on: the balance, its slope, the size of its terms.
struct ModeBalance {
  Vector<kModes> sum, size;
  Matrix<kModes> slope = Matrix<kModes>::Zero();

  template <int Dofs>
  ModeBalance(const Points<Dofs>& points, const Along<Dofs>& along) : sum(along.work), size(sum.cwiseAbs()) {
    for (std::size_t p = 0; p < kPoints; ++p) {
      const Eigen::Map<const Modes> modes = points.own.modes(p);
      Strains sigma = points.sigma[p];
      sigma[kBending] -= along.odd * Along<Dofs>::side(p);
      sum += points.w[p] * (modes.transpose() * sigma);
      size += points.w[p] * (modes.cwiseAbs().transpose() * sigma.cwiseAbs());
      slope += points.w[p] * (modes.transpose() * (points.D[p] * modes));
    }
  }
  bool within(double share) const { return (sum.cwiseAbs().array() <= share * size.array()).all(); }
};

// Newton for the modes.  The balance is the slope of a function that bends upwards wherever the law's tangent is not
// negative.  Where points are at the tip of their strength it bends in no direction that they share; a correction that
// runs past its lowest point is shortened, and made again with a part of the first stiffness added where that does not
// help (Levenberg and Marquardt).
class ModeSearch {
 public:
  // scale: the balance's slope of the first stiffness.
  explicit ModeSearch(const Vector<kModes>& scale) {
    for (int k = 0; k < kModes; ++k) unit_(k) = scale(k) > 0.0 ? 1.0 / std::sqrt(scale(k)) : 0.0;
  }
  // What the modes do when the balance is to change by `by`.
  template <class Columns>
  Columns solve(const Matrix<kModes>& slope, const Columns& by, double ridge = kRidge) const {
    Matrix<kModes> A = unit_.asDiagonal() * slope * unit_.asDiagonal();
    A.diagonal().array() += ridge;
    const Columns right = unit_.asDiagonal() * by;
    const Columns scaled = Eigen::PartialPivLU<Matrix<kModes>>(A).solve(right);
    return unit_.asDiagonal() * scaled;
  }
  // The balance is another function now.
  void restart() { first_ = 0.0; }
  void next(const ModeBalance& balance, Vector<kModes>& modes) {
    constexpr double kPast = 0.5, kMore = 1e3, kFirstMore = 1e-6, kMost = 10.0;
    constexpr int kShorter = 3;
    const double slope = step_.dot(balance.sum);
    if (first_ < 0.0 && slope > -kPast * first_ && ridge_ < kMost) {
      if (++past_ % (kShorter + 1) != 0) {
        share_ *= std::clamp(first_ / (first_ - slope), 0.1, 0.5);
        modes = base_ + share_ * step_;
        return;
      }
      ridge_ = std::clamp(kMore * ridge_, kFirstMore, kMost);
    } else {
      base_ = modes;
      sum_ = balance.sum;
      slope_ = balance.slope;
      ridge_ = std::max(kRidge, ridge_ / kMore);
      past_ = 0;
    }
    share_ = 1.0;
    step_ = solve(slope_, Vector<kModes>(-sum_), ridge_);
    first_ = step_.dot(sum_);
    modes = base_ + step_;
  }

 private:
  // Where all has yielded the slope is zero in some direction, and so is the balance.
  static constexpr double kRidge = 1e-12;
  Vector<kModes> unit_, base_ = Vector<kModes>::Zero(), sum_ = base_, step_ = base_;
  Matrix<kModes> slope_ = Matrix<kModes>::Zero();
  double first_ = 0.0, share_ = 1.0, ridge_ = kRidge;
  int past_ = 0;
};

// f and K of the dofs, the modes eliminated.
template <int Dofs>
void condense(const Points<Dofs>& points, const Along<Dofs>& along, const ModeSearch& search,
              const ModeBalance& balance, ElementOut& out) {
  using Columns = Eigen::Matrix<double, Dofs, kModes>;
  Vector<Dofs> f = Vector<Dofs>::Zero();
  Columns right = Columns::Zero(), left = right;
  Matrix<Dofs> K = Matrix<Dofs>::Zero();
  for (std::size_t p = 0; p < kPoints; ++p) {
    Strains sigma = points.sigma[p];
    sigma[kBending] -= along.odd * Along<Dofs>::side(p);
    f += points.Bt[p] * (points.w[p] * sigma);
    if (out.K == nullptr) continue;
    const Matrix<kStrains> wD = points.w[p] * points.D[p];
    const Eigen::Map<const Modes> modes = points.own.modes(p);
    K += points.Bt[p] * wD * points.Bt[p].transpose();
    right += points.Bt[p] * (wD * modes);
    left += points.Bt[p] * (wD.transpose() * modes);
  }
  Vector<Dofs>::Map(out.f) = f;
  if (out.K == nullptr) return;
  const Eigen::Matrix<double, kModes, Dofs> back = left.transpose();
  K -= right * search.solve(balance.slope, back);
  Matrix<Dofs>::Map(out.K) = K;
}

template <int Dofs>
Outcome evaluate_yielding(const Law<kStrains>& law, const ElementIn& in, ElementOut& out) {
  constexpr int kMostSteps = 100, kManySteps = 8;
  constexpr double kSmall = 1e-13,
                   kEnough = 1e-10;  // of the terms; kEnough where rounding may keep it from less
  Points<Dofs> points(in.geometry);
  Matrix<kStrains> D;
  if (first_stiffness(law, in, out, D) != Outcome::ok) return Outcome::cut_step;
  const Along<Dofs> along(points, in, D(kBending, kBending));
  Vector<kModes> modes = Vector<kModes>::Zero(), scale = modes;
  for (std::size_t p = 0; p < kPoints; ++p)
    scale += points.w[p] * (points.own.modes(p).transpose() * D * points.own.modes(p)).diagonal();
  const auto inner = [&](std::size_t p) -> Strains {
    Strains strain = points.own.modes(p) * modes;
    strain[kBending] += along.odd_strain * Along<Dofs>::side(p);
    return strain;
  };
  ModeSearch search(scale);
  Asked<Dofs> asked(in, D);
  for (int all = 0, step = 0; all < kMostSteps; ++all, ++step) {
    if (update_points(law, in, inner, points, out) != Outcome::ok) return Outcome::cut_step;
    asked.take(points);
    const ModeBalance balance(points, along);
    if (!balance.within(step < kManySteps ? kSmall : kEnough)) {
      search.next(balance, modes);
    } else if (asked.add()) {
      search.restart();
      step = -1;
    } else {
      condense(points, along, search, balance, out);
      return Outcome::ok;
    }
  }
  return Outcome::cut_step;
}

// Strains of the modes at a point.  A stretch of an end by a unit is a strain of its point, as wide as its weight, and
// moves the element beside it back; so does a turn.
template <int Dofs>
Modes modes_at(const std::array<OperatorT<kStrains, Dofs>, kPoints>& Bt, const std::array<double, kPoints>& w,
               const Vector2& measure, const Vector2& t, const Strains& G, std::size_t p) {
  Modes modes = Modes::Zero();
  modes.col(0) = G;
  const auto own = [&](int end) { return p == static_cast<std::size_t>(2 * end) ? measure(end) / w[p] : 0.0; };
  const bool both = measure.minCoeff() > 0.0;
  for (const int end : {0, 1}) {
    if (!(measure(end) > 0.0)) continue;  // on the axis, where no circle stretches
    const double sense = end == 0 ? 1.0 : -1.0;
    modes.col(1 + end) = sense * (Bt[p].template middleRows<2>(2 * end).transpose() * t);
    modes(kAxial, 1 + end) += own(end);
    if (!both) continue;
    modes.col(3) += sense * Bt[p].row(4 + end).transpose();
    modes(kBending, 3) += own(end);
  }
  return modes;
}

// f += what a force at xi does to the dofs of both nodes.  With Hermite's cubics, those of a slender beam: the forces of
// an even load are exact for every beam.
void add_force(const LineFrame& frame, double xi, const Vector2& force, std::span<double> f) {
  const Vector2 N = Line2::N(xi);
  const Vector<5> w = Linked(xi, 2.0 * frame.J).w;
  for (int i = 0; i < 2; ++i) {
    const Vector2 at = N(i) * force.dot(frame.t) * frame.t + w(i) * force.dot(frame.n) * frame.n;
    const auto first = static_cast<std::size_t>(2 * i);
    f[first] += at.x();
    f[first + 1] += at.y();
    f[4 + i] += w(2 + i) * force.dot(frame.n);
  }
}

// f += integral of the deflection's shape times a load, force per length at xi.
template <class Kinematics, class Load>
void add_load(const NodeCoordinates& x, const Load& load, std::span<double> f) {
  const LineFrame frame(0.5 * (x.col(1) - x.col(0)));
  for (const LinePoint& q : GaussLine<5>::table) {
    const double r = x.row(0).head<2>().dot(Line2::N(q.xi));
    add_force(frame, q.xi, q.w * frame.J * Kinematics::measure(r) * load(q.xi, frame), f);
  }
}

}  // namespace

template <class Kinematics, Release released>
Beam2<Kinematics, released>::Beam2(std::string_view name) {
  traits_.name = name;
  traits_.geometry = Kinematics::geometry;
  traits_.nodes = 2;
  traits_.dofs = kDofs;
  traits_.points = kPoints;
  traits_.law_size = kStrains;
  traits_.own_doubles = Own::kSize;
}

template <class Kinematics, Release released>
void Beam2<Kinematics, released>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  check_line<Line2, Kinematics>(x, "beam");
  check_release<Kinematics, released>(x);
  const LineFrame frame(0.5 * (x.col(1) - x.col(0)));
  std::array<OperatorT<kStrains, kDofs>, kPoints> all;
  std::array<Strains, kPoints> G;
  std::array<double, kPoints> w{};
  double* block = out.data();
  for (std::size_t p = 0; p < kPoints; ++p, block += kPointStride<kStrains, kDofs>) {
    const LinePoint& q = kEndsAndMiddle[p];
    const double r = x.row(0).head<2>().dot(Line2::N(q.xi));
    Operator2 Bt;
    strains_at<Kinematics>(frame, 2.0 * frame.J, q.xi, r, Bt, G[p]);
    *block = w[p] = q.w * frame.J * Kinematics::measure(r);
    put_operator<released, kDofs>(frame, Bt, block + 1);
    all[p] = OperatorT<kStrains, kDofs>::Map(block + 1);
  }
  Vector2 measure;
  for (int end = 0; end < 2; ++end)
    measure(end) = x(0, end) > kRadiusTolerance * extent(x) || Kinematics::geometry == Geometry::plane_strain
                       ? Kinematics::measure(x(0, end))
                       : 0.0;
  for (std::size_t p = 0; p < kPoints; ++p)
    Modes::Map(block + p * kStrains * kModes) = modes_at(all, w, measure, frame.t, G[p], p);
  Eigen::Vector4d::Map(block + kPoints * kStrains * kModes) << frame.t, measure;
}

template <class Kinematics, Release released>
Outcome Beam2<Kinematics, released>::evaluate(const ElementIn& in, ElementOut& out) const {
  constexpr int kMostSteps = 60;
  const Law<kStrains>& law = *std::get<const Law<kStrains>*>(in.law);
  if (!law.traits().linear) return evaluate_yielding<kDofs>(law, in, out);
  Points<kDofs> points(in.geometry);
  double gamma = 0.0;
  const auto inner = [&](std::size_t p) -> Strains { return gamma * points.G[p]; };
  ShearSearch search;
  for (int step = 0; step < kMostSteps; ++step) {
    if (update_points(law, in, inner, points, out) != Outcome::ok) return Outcome::cut_step;
    const ShearBalance balance(points);
    if (search.next(balance, gamma)) continue;
    if (!(balance.slope > 0.0) && std::abs(balance.sum) > 1e-9 * balance.size) return Outcome::cut_step;
    condense(points, balance.slope, out);
    return Outcome::ok;
  }
  return Outcome::cut_step;
}

template <class Kinematics, Release released>
Vector2 Beam2<Kinematics, released>::position(const NodeCoordinates& x, int point) const {
  return x.leftCols<2>() * Line2::N(kEndsAndMiddle[point].xi);
}

template <class Kinematics, Release released>
void Beam2<Kinematics, released>::body_load(const NodeCoordinates& x, const Vector2& b,
                                            std::span<double> f) const {
  add_load<Kinematics>(
      x, [&](double, const LineFrame&) -> Vector2 { return b; }, f);
  add_slip<released>(LineFrame(x.col(1) - x.col(0)), f);
}

template <class Kinematics, Release released>
const std::vector<std::vector<int>>& Beam2<Kinematics, released>::edges() const {
  static const EdgeNodes edges{{0, 1}};
  return edges;
}

template <class Kinematics, Release released>
void Beam2<Kinematics, released>::edge_load(const NodeCoordinates& x, int /*edge*/, const Vector2& normal,
                                            const Vector2& shear, std::span<double> f) const {
  add_load<Kinematics>(
      x,
      [&](double xi, const LineFrame& frame) -> Vector2 {
        return between_ends(normal, xi) * frame.n + between_ends(shear, xi) * frame.t;
      },
      f);
  add_slip<released>(LineFrame(x.col(1) - x.col(0)), f);
}

template <class Kinematics, Release released>
void Beam2<Kinematics, released>::force_at(const NodeCoordinates& x, double xi, const Vector2& force,
                                           std::span<double> f) {
  std::array<double, kDofs> one{};
  add_force(LineFrame(0.5 * (x.col(1) - x.col(0))), xi, force, one);
  add_slip<released>(LineFrame(x.col(1) - x.col(0)), one);
  for (std::size_t i = 0; i < one.size(); ++i) f[i] += one[i];
}

template class Beam2<PlaneStrain>;
template class Beam2<Axisymmetric>;
template class Beam2<PlaneStrain, Release::axial>;
template class Beam2<Axisymmetric, Release::axial>;
template class Beam2<PlaneStrain, Release::shear>;
template class Beam2<Axisymmetric, Release::shear>;

template <class Kinematics, Release released>
Beam3<Kinematics, released>::Beam3(std::string_view name)
    : PointElement<kStrains, kDofs, 2>({.name = name,
                                        .geometry = Kinematics::geometry,
                                        .nodes = 3,
                                        .dofs = kDofs,
                                        .points = 2,
                                        .degree = 2,
                                        .law_size = kStrains}) {
  std::vector<ParentPoint> points, nodes;
  for (const LinePoint& q : GaussLine<2>::table) points.push_back({q.xi, 0.0});
  for (const double xi : Line3::node_xi) nodes.push_back({xi, 0.0});
  to_nodes_ = extrapolation_matrix(points, nodes, Basis::line_linear);
}

template <class Kinematics, Release released>
void Beam3<Kinematics, released>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  check_line<Line3, Kinematics>(x, "beam");
  check_release<Kinematics, released>(x);
  const Eigen::Matrix<double, 2, 3> nodes = x;
  const LineFrame first(nodes * Line3::dN(-1.0));
  double* block = out.data();
  for (const LinePoint& q : GaussLine<2>::table) {
    const Vector<3> N = Line3::N(q.xi);
    const LineFrame frame(nodes * Line3::dN(q.xi));
    const Vector<3> dN = Line3::dN(q.xi) / frame.J;
    const double r = nodes.row(0).dot(N);
    *block = q.w * frame.J * Kinematics::measure(r);
    OperatorT<kStrains, 9> Bt;
    for (int i = 0; i < 3; ++i) {
      Bt.row(2 * i) << dN(i) * frame.t.x(), Kinematics::hoop(N(i), r), dN(i) * frame.n.x(), 0.0, 0.0;
      Bt.row(2 * i + 1) << dN(i) * frame.t.y(), 0.0, dN(i) * frame.n.y(), 0.0, 0.0;
      Bt.row(6 + i) << 0.0, 0.0, -N(i), dN(i), frame.t.x() * Kinematics::hoop(N(i), r);
    }
    put_operator<released, kDofs>(first, Bt, block + 1);
    block += kPointStride<kStrains, kDofs>;
  }
}

template <class Kinematics, Release released>
void Beam3<Kinematics, released>::body_load(const NodeCoordinates& x, const Vector2& b,
                                            std::span<double> f) const {
  const Eigen::Matrix<double, 2, 3> nodes = x;
  for (const LinePoint& q : GaussLine<5>::table) {
    const Vector<3> N = Line3::N(q.xi);
    const double w = q.w * (nodes * Line3::dN(q.xi)).norm() * Kinematics::measure(nodes.row(0).dot(N));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 2; ++c)
        f[2 * i + c] += w * N(static_cast<Eigen::Index>(i)) * b(static_cast<Eigen::Index>(c));
  }
  add_slip<released>(LineFrame(nodes * Line3::dN(-1.0)), f);
}

template <class Kinematics, Release released>
const std::vector<std::vector<int>>& Beam3<Kinematics, released>::edges() const {
  static const EdgeNodes edges{{0, 1, 2}};
  return edges;
}

template <class Kinematics, Release released>
void Beam3<Kinematics, released>::edge_load(const NodeCoordinates& x, int edge, const Vector2& normal,
                                            const Vector2& shear, std::span<double> f) const {
  add_edge_load<Line3, Kinematics>(Eigen::Matrix<double, 2, 3>(x), normal, shear, edges().at(edge), f);
  add_slip<released>(LineFrame(x.leftCols<3>() * Line3::dN(-1.0)), f);
}

template <class Kinematics, Release released>
void Beam3<Kinematics, released>::force_at(const NodeCoordinates& x, double xi, const Vector2& force,
                                           std::span<double> f) {
  std::array<double, kDofs> one{};
  for (std::size_t i = 0; i < 3; ++i)
    Vector2::Map(one.data() + 2 * i) = Line3::N(xi)(static_cast<Eigen::Index>(i)) * force;
  add_slip<released>(LineFrame(x.leftCols<3>() * Line3::dN(-1.0)), one);
  for (std::size_t i = 0; i < one.size(); ++i) f[i] += one[i];
}

template class Beam3<PlaneStrain>;
template class Beam3<Axisymmetric>;
template class Beam3<PlaneStrain, Release::axial>;
template class Beam3<Axisymmetric, Release::axial>;
template class Beam3<PlaneStrain, Release::shear>;
template class Beam3<Axisymmetric, Release::shear>;

template <class Kinematics>
void RotationalSpring<Kinematics>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  if (!x.allFinite()) throw ElementShapeError("rotational spring: a coordinate is not a number");
  const double width = Kinematics::measure(x(0, 0));
  if (!(width > 0.0))
    throw ElementShapeError("rotational spring: its node has the radius " + std::to_string(x(0, 0)) +
                            "; a circle of springs needs one above 0");
  std::ranges::fill(out, 0.0);
  out.front() = width;
  Eigen::Map<OperatorT<kStrains, 4>> Bt(out.data() + 1);
  Bt.col(kBending) << 0.0, 0.0, -1.0, 1.0;
}

template class RotationalSpring<PlaneStrain>;
template class RotationalSpring<Axisymmetric>;

}  // namespace sage
