#include "elements/contact.hpp"

#include <algorithm>
#include <variant>

#include "elements/extrapolation.hpp"
#include "elements/shape_check.hpp"
#include "sage/math/quadrature.hpp"
#include "sage/messages/error.hpp"

namespace sage {

namespace {

// Of the size of the element: an edge in the mesh may lie that far beyond the line.
constexpr double kBeyond = 1e-6;

}  // namespace

// A point of the edge and the line, displaced by u.  What changes is computed of displacements, so that small ones keep their
// digits beside a penalty.
template <class Line, class Kinematics>
struct Contact<Line, Kinematics>::Place {
  Vector<kEdge> N, dN;
  Vector2 t, n, ds;
  double length = 0.0, slid = 0.0, gap = 0.0,
         share = 0.0;  // slid: along the line since the mesh; share: of its length
  double J = 0.0, r = 0.0, weight = 0.0;

  Place(const Coordinates& mesh, const Coordinates& u, const LinePoint& at)
      : N(Line::N(at.xi)), dN(Line::dN(at.xi)) {
    const Vector2 line0 = mesh.col(kEdge + 1) - mesh.col(kEdge), w = u.col(kEdge + 1) - u.col(kEdge);
    const double length0 = line0.norm();
    length = (line0 + w).norm();
    const Vector2 t0 = line0 / length0, n0 = left_of(t0);
    const Vector2 turn = (w - t0 * ((2.0 * line0 + w).dot(w) / (length + length0))) / length;
    t = t0 + turn;
    n = left_of(t);
    const Vector2 d0 = mesh.template leftCols<kEdge>().lazyProduct(N) - mesh.col(kEdge);
    const Vector2 moved = u.template leftCols<kEdge>().lazyProduct(N) - u.col(kEdge), d = d0 + moved;
    slid = t0.dot(moved) + turn.dot(d);
    gap = n0.dot(d0) + (n0.dot(moved) + left_of(turn).dot(d));
    share = (t0.dot(d0) + slid) / length;
    ds = (mesh + u).template leftCols<kEdge>().lazyProduct(dN);
    J = ds.norm();
    r = mesh.col(kEdge).x() + u.col(kEdge).x() + d.x();
    weight = at.w * J * Kinematics::measure(r);
  }
  static Vector2 left_of(const Vector2& direction) { return {-direction.y(), direction.x()}; }
  bool touches() const { return gap <= 0.0 && share >= 0.0 && share <= 1.0; }

  // Derivatives by the displacements, of a direction d: d . (point - start of the line), and d . (end - start).
  Dofs of_point(const Vector2& d) const {
    Dofs row = Dofs::Zero();
    for (int i = 0; i < kEdge; ++i) row.template segment<2>(2 * i) = N(i) * d;
    row.template segment<2>(2 * kEdge) = -d;
    return row;
  }
  static Dofs of_line(const Vector2& d) {
    Dofs row = Dofs::Zero();
    row.template segment<2>(2 * kEdge) = -d;
    row.template segment<2>(2 * kEdge + 2) = d;
    return row;
  }
  Dofs of_along() const { return of_point(t) + gap / length * of_line(n); }
  Dofs of_gap() const { return of_point(n) - share * of_line(n); }
  Dofs of_weight(double w) const {
    Dofs row = Dofs::Zero();
    const double around = Kinematics::measure(r);
    const double growth = Kinematics::geometry == Geometry::axisymmetric ? 2.0 * kPi : 0.0;
    for (int i = 0; i < kEdge; ++i) {
      row.template segment<2>(2 * i) = w * around * dN(i) / J * ds;
      row(2 * i) += w * J * growth * N(i);
    }
    return row;
  }
  // Second derivatives of along and gap, times shear and normal.
  Matrix<kDofs> curvature(double shear, double normal) const {
    const Dofs across = of_line(n), stretch = of_line(t), off = of_point(n),
               slide = of_point(t) - share * stretch;
    const double tilt = gap / length;
    const Matrix<kDofs> of_gap =
        across * slide.transpose() + slide * across.transpose() + tilt * across * across.transpose();
    const Matrix<kDofs> of_along = across * off.transpose() + off * across.transpose() -
                                   share * across * across.transpose() -
                                   tilt * (stretch * across.transpose() + across * stretch.transpose());
    return (shear * of_along - normal * of_gap) / length;
  }
};

template <class Line, class Kinematics>
struct Contact<Line, Kinematics>::Sums {
  Dofs f = Dofs::Zero();
  Matrix<kDofs> K = Matrix<kDofs>::Zero();
};

template <class Line, class Kinematics>
Contact<Line, Kinematics>::Contact(std::string_view name)
    : traits_{.name = name,
              .geometry = Kinematics::geometry,
              .nodes = kNodes,
              .dofs = kDofs,
              .points = kPoints,
              .degree = kEdge - 1,
              .law_size = 2,
              .symmetric = false,
              .linear = false,
              .sees_unknowns = true,
              .sees_coordinates = true} {
  std::vector<ParentPoint> points, nodes;
  for (const LinePoint& at : GaussLine<kPoints>::table) points.push_back({at.xi, 0.0});
  for (const double xi : Line::node_xi) nodes.push_back({xi, 0.0});
  to_nodes_ = extrapolation_matrix(points, nodes, kEdge == 2 ? Basis::line_linear : Basis::line_quadratic);
  to_nodes_.insert(to_nodes_.end(), 2 * kPoints, 1.0 / kPoints);
}

template <class Line, class Kinematics>
void Contact<Line, Kinematics>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  if (!x.allFinite()) throw ElementShapeError("contact: a coordinate is not a number");
  const double size = extent(x.leftCols(kEdge));
  if (Kinematics::geometry == Geometry::axisymmetric) check_radii(x);
  if (!(size > 0.0) || !((x.col(kEdge + 1) - x.col(kEdge)).norm() > 1e-12 * size))
    throw ElementShapeError("contact: the edge or the line has no length");
  double* block = out.data();
  for (const LinePoint& at : GaussLine<kPoints>::table) {
    const Place place(Coordinates(x), Coordinates::Zero(), at);
    if (!(place.J > 0.0)) throw ElementShapeError("contact: the middle node folds the edge");
    if (place.gap < -kBeyond * size && place.share >= 0.0 && place.share <= 1.0)
      throw ElementShapeError(
          "contact: the edge lies beyond the line, by " + std::to_string(-place.gap) +
          "; the body must be to the left of the way from the line's first node to its second: "
          "exchange the two");
    *block = place.weight;
    Eigen::Map<Eigen::Matrix<double, kDofs, 2>> Bt(block + 1);
    Bt.col(0) = place.of_along();
    Bt.col(1) = place.of_gap();
    block += 1 + 2 * kDofs;
  }
}

template <class Line, class Kinematics>
Vector2 Contact<Line, Kinematics>::position(const NodeCoordinates& x, int point) const {
  return x.leftCols(kEdge) * Line::N(GaussLine<kPoints>::table[point].xi);
}

template <class Line, class Kinematics>
Outcome Contact<Line, Kinematics>::evaluate(const ElementIn& in, ElementOut& out) const {
  const Coordinates mesh = Coordinates::Map(in.x), before = Coordinates::Map(in.u0);
  const Coordinates now = before + Coordinates::Map(in.du);
  Sums sums;
  Outcome outcome = Outcome::ok;
  for (std::size_t p = 0; p < kPoints; ++p) {
    const LinePoint& at = GaussLine<kPoints>::table[p];
    add_point(p, in, out, Place(mesh, before, at), Place(mesh, now, at), sums, outcome);
    if (outcome != Outcome::ok) return outcome;
  }
  Dofs::Map(out.f) = sums.f;
  if (out.K != nullptr) Matrix<kDofs>::Map(out.K) = sums.K;
  return Outcome::ok;
}

template <class Line, class Kinematics>
void Contact<Line, Kinematics>::add_point(std::size_t p, const ElementIn& in, ElementOut& out,
                                          const Place& before, const Place& now, Sums& sums,
                                          Outcome& outcome) const {
  const InterfaceLaw& law = *std::get<const InterfaceLaw*>(in.law);
  const std::span<const Quantity> history = law.traits().history;
  const std::span<double> h1{out.h1 + p * history.size(), history.size()};
  Eigen::Map<Vector2> sigma1(out.sigma1 + 2 * p), eps1(out.eps1 + 2 * p);
  if (!now.touches()) {
    sigma1.setZero();
    eps1 << 0.0, now.gap;
    for (std::size_t i = 0; i < h1.size(); ++i) h1[i] = history[i].initial;
    out.status[p] = PointStatus::open;
    return;
  }
  const bool held = before.touches();
  PointIn<2> point;
  point.sigma0 = held ? Vector2(Vector2::Map(in.sigma0 + 2 * p)) : Vector2(Vector2::Zero());
  point.eps0 = held ? Vector2(in.eps0[2 * p], before.gap) : Vector2(Vector2::Zero());
  point.deps = held ? Vector2(now.slid - before.slid, now.gap - before.gap) : Vector2(0.0, now.gap);
  point.h0 = {in.h0 + p * history.size(), history.size()};
  point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
  PointOut<2> answer;
  answer.h1 = h1;
  outcome = law.update(point, answer);
  if (outcome != Outcome::ok) return;
  sigma1 = answer.sigma;
  eps1 = point.eps0 + point.deps;
  out.status[p] = answer.status;
  const Dofs slip = now.of_along(), gap = now.of_gap();
  const Dofs force = answer.sigma[0] * slip + answer.sigma[1] * gap;
  sums.f += now.weight * force;
  if (out.K == nullptr) return;
  const Dofs of_shear = (held ? answer.D(0, 0) : 0.0) * slip + answer.D(0, 1) * gap;
  const Dofs of_normal = (held ? answer.D(1, 0) : 0.0) * slip + answer.D(1, 1) * gap;
  sums.K += now.weight * (slip * of_shear.transpose() + gap * of_normal.transpose() +
                          now.curvature(answer.sigma[0], answer.sigma[1]));
  sums.K += force * now.of_weight(GaussLine<kPoints>::table[p].w).transpose();
}

template class Contact<Line2, PlaneStrain>;
template class Contact<Line2, Axisymmetric>;
template class Contact<Line3, PlaneStrain>;
template class Contact<Line3, Axisymmetric>;

}  // namespace sage
