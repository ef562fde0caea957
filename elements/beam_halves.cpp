#include "elements/beam_halves.hpp"

#include <Eigen/LU>
#include <array>

namespace sage {

namespace {

constexpr int kSectionStrains = 5, kHalfPoints = 3, kBothPoints = 2 * kHalfPoints;

// Places of a half's dofs among those of the whole.
template <int Dofs>
using Places = std::array<std::size_t, Dofs>;
constexpr Places<7> kFirst{0, 1, 4, 5, 6, 8, 9};  // the slip last, where there is one
constexpr Places<6> kSecond{4, 5, 2, 3, 8, 7};

Eigen::Matrix2d half_of(const NodeCoordinates& x, int half) {
  Eigen::Matrix2d nodes;
  nodes << x.col(half == 0 ? 0 : 2), x.col(half == 0 ? 2 : 1);
  return nodes;
}

template <std::size_t Count>
void add_to(const std::array<std::size_t, Count>& places, std::span<const double> f, std::span<double> to) {
  for (std::size_t i = 0; i < f.size(); ++i) to[places[i]] += f[i];
}

// The loads along both halves, by the forces that they make at the nodes, as loads that vary linearly along each.
class HalfLoads {
 public:
  HalfLoads(const double* spread, const Vector2& first, const Vector2& second) {
    const Eigen::Matrix<double, 2, 3> all = Eigen::Matrix<double, 2, 3>::Map(spread);
    Eigen::Matrix<double, 2, 3> forces;
    forces << all.col(0), all.col(2), all.col(1);
    half_[0] = {first.norm(), first.normalized()};
    half_[1] = {second.norm(), second.normalized()};
    along_ = loads(forces, 2.0 / 6.0, 1.0 / 6.0);
    across_ = loads(forces, 7.0 / 20.0, 3.0 / 20.0);
  }

  // The nodal forces and moments of one half; a force that slips has them at its end.
  void of(int half, std::span<double> f) const {
    const auto [L, t] = half_[half];
    const Vector2 n(-t.y(), t.x());
    const Vector2 p0 = along_.col(half), p1 = along_.col(half + 1), q0 = across_.col(half),
                  q1 = across_.col(half + 1);
    const Vector2 a = L / 6.0 * t * t.dot(2.0 * p0 + p1) + L / 20.0 * n * n.dot(7.0 * q0 + 3.0 * q1);
    const Vector2 b = L / 6.0 * t * t.dot(p0 + 2.0 * p1) + L / 20.0 * n * n.dot(3.0 * q0 + 7.0 * q1);
    const std::array<double, 6> all{a.x(),
                                    a.y(),
                                    b.x(),
                                    b.y(),
                                    L * L / 60.0 * n.dot(3.0 * q0 + 2.0 * q1),
                                    -L * L / 60.0 * n.dot(2.0 * q0 + 3.0 * q1)};
    std::copy(all.begin(), all.end(), f.begin());
  }

 private:
  // Loads at the three nodes in a row; own and other: the parts of L that a load at an end gives to both ends.
  Eigen::Matrix<double, 2, 3> loads(const Eigen::Matrix<double, 2, 3>& forces, double own, double other) const {
    const double a = half_[0].L, b = half_[1].L;
    Eigen::Matrix3d M;
    M << own * a, other * a, 0.0, other * a, own * (a + b), other * b, 0.0, other * b, own * b;
    return M.inverse().eval().operator*(forces.transpose()).transpose();
  }

  struct Half {
    double L;
    Vector2 t;
  };
  std::array<Half, 2> half_;
  Eigen::Matrix<double, 2, 3> along_, across_;
};

// One half: its part of the unknowns in, its forces and matrix added.
template <int Dofs, int All, std::size_t Count>
Outcome evaluate_half(const Element& element, const std::array<std::size_t, Count>& places,
                      std::size_t first_point, const ElementIn& in, const double* geometry,
                      const std::array<const double*, 2>& spread, ElementOut& out) {
  const std::size_t history = std::get<const Law<kSectionStrains>*>(in.law)->traits().history.size();
  std::array<double, Dofs> du{}, f{};
  std::array<double, Dofs * Dofs> K{};
  for (std::size_t i = 0; i < Dofs; ++i) du[i] = in.du[places[i]];
  ElementIn half = in;
  half.geometry = geometry;
  half.du = du.data();
  half.sigma0 += first_point * kSectionStrains;
  half.eps0 += first_point * kSectionStrains;
  half.h0 += first_point * history;
  if (half.contexts != nullptr) half.contexts += first_point;
  half.spread = spread[0];
  half.spread0 = spread[1];
  ElementOut one = out;
  one.K = out.K != nullptr ? K.data() : nullptr;
  one.f = f.data();
  one.sigma1 += first_point * kSectionStrains;
  one.eps1 += first_point * kSectionStrains;
  one.h1 += first_point * history;
  one.status += first_point;
  if (element.evaluate(half, one) != Outcome::ok) return Outcome::cut_step;
  add_to(places, f, {out.f, All});
  if (out.K == nullptr) return Outcome::ok;
  for (std::size_t j = 0; j < Dofs; ++j)
    for (std::size_t i = 0; i < Dofs; ++i) out.K[places[i] + All * places[j]] += K[i + Dofs * j];
  return Outcome::ok;
}

}  // namespace

template <class Kinematics, Release released>
BeamHalves<Kinematics, released>::BeamHalves(std::string_view name) : first_(name), second_(name) {
  traits_ = first_.traits();
  traits_.nodes = 3;
  traits_.dofs = kDofs;
  traits_.points = kBothPoints;
  traits_.degree = 2;
  // The ends' places besides: loads along the element are divided by them.
  traits_.own_doubles = first_.traits().geometry_size() + second_.traits().geometry_size() + 4;
}

template <class Kinematics, Release released>
void BeamHalves<Kinematics, released>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  constexpr int kHalfDofs = 6 + slip_dofs(released);
  check_line<Line3, Kinematics>(x, "beam");
  constexpr std::size_t kStride = kPointStride<kSectionStrains, kDofs>;
  const std::span<double> own = out.subspan(kBothPoints * kStride);
  const auto size = static_cast<std::size_t>(first_.traits().geometry_size());
  first_.geometry(half_of(x, 0), own.first(size));
  second_.geometry(half_of(x, 1),
                   own.subspan(size, static_cast<std::size_t>(second_.traits().geometry_size())));
  Eigen::Vector4d::Map(own.data() + own.size() - 4) << x.col(2) - x.col(0), x.col(1) - x.col(2);
  const auto place = [&](std::size_t p, const double* from, const auto& places, int dofs) {
    double* const to = out.data() + p * kStride;
    std::fill(to, to + kStride, 0.0);
    *to = *from;
    for (int c = 0; c < kSectionStrains; ++c)
      for (int i = 0; i < dofs; ++i)
        to[1 + static_cast<std::size_t>(c * kDofs) + places[i]] = from[1 + c * dofs + i];
  };
  for (std::size_t p = 0; p < kHalfPoints; ++p) {
    place(p, own.data() + p * kPointStride<kSectionStrains, kHalfDofs>, kFirst, kHalfDofs);
    place(kHalfPoints + p, own.data() + size + p * kPointStride<kSectionStrains, 6>, kSecond, 6);
  }
}

template <class Kinematics, Release released>
Outcome BeamHalves<Kinematics, released>::evaluate(const ElementIn& in, ElementOut& out) const {
  constexpr int kHalfDofs = 6 + slip_dofs(released);
  std::fill(out.f, out.f + kDofs, 0.0);
  if (out.K != nullptr) std::fill(out.K, out.K + kDofs * kDofs, 0.0);
  const double* const own = in.geometry + kBothPoints * kPointStride<kSectionStrains, kDofs>;
  const auto size = static_cast<std::size_t>(first_.traits().geometry_size());
  const double* const chords = in.geometry + traits_.geometry_size() - 4;
  std::array<std::array<double, 7>, 4> spread{};  // of both halves, now and before
  if (in.spread != nullptr)
    for (std::size_t i = 0; i < 2; ++i) {
      const HalfLoads loads(i == 0 ? in.spread : in.spread0, Vector2::Map(chords), Vector2::Map(chords + 2));
      for (int half = 0; half < 2; ++half) loads.of(half, spread[static_cast<std::size_t>(2 * half) + i]);
    }
  const auto of = [&](std::size_t half) {
    return in.spread == nullptr
               ? std::array<const double*, 2>{}
               : std::array<const double*, 2>{spread[2 * half].data(), spread[2 * half + 1].data()};
  };
  const Outcome first = evaluate_half<kHalfDofs, kDofs>(first_, kFirst, 0, in, own, of(0), out);
  if (first != Outcome::ok) return first;
  return evaluate_half<6, kDofs>(second_, kSecond, kHalfPoints, in, own + size, of(1), out);
}

template <class Kinematics, Release released>
Vector2 BeamHalves<Kinematics, released>::position(const NodeCoordinates& x, int point) const {
  return second_.position(half_of(x, point / kHalfPoints), point % kHalfPoints);
}

template <class Kinematics, Release released>
void BeamHalves<Kinematics, released>::body_load(const NodeCoordinates& x, const Vector2& b,
                                                 std::span<double> f) const {
  std::array<double, 6 + slip_dofs(released)> first{};
  std::array<double, 6> second{};
  first_.body_load(half_of(x, 0), b, first);
  second_.body_load(half_of(x, 1), b, second);
  add_to(kFirst, first, f);
  add_to(kSecond, second, f);
}

template <class Kinematics, Release released>
const std::vector<std::vector<int>>& BeamHalves<Kinematics, released>::edges() const {
  static const EdgeNodes edges{{0, 1, 2}};
  return edges;
}

template <class Kinematics, Release released>
void BeamHalves<Kinematics, released>::edge_load(const NodeCoordinates& x, int /*edge*/, const Vector2& normal,
                                                 const Vector2& shear, std::span<double> f) const {
  std::array<double, 6 + slip_dofs(released)> first{};
  std::array<double, 6> second{};
  const auto half = [](const Vector2& ends, int which) -> Vector2 {
    return {which == 0 ? ends[0] : ends.mean(), which == 0 ? ends.mean() : ends[1]};
  };
  first_.edge_load(half_of(x, 0), 0, half(normal, 0), half(shear, 0), first);
  second_.edge_load(half_of(x, 1), 0, half(normal, 1), half(shear, 1), second);
  add_to(kFirst, first, f);
  add_to(kSecond, second, f);
}

template <class Kinematics, Release released>
void BeamHalves<Kinematics, released>::force_at(const NodeCoordinates& x, double xi, const Vector2& force,
                                                std::span<double> f) {
  if (xi < 0.0) {
    std::array<double, 6 + slip_dofs(released)> first{};
    Beam2<Kinematics, released>::force_at(half_of(x, 0), 2.0 * xi + 1.0, force, first);
    add_to(kFirst, first, f);
  } else {
    std::array<double, 6> second{};
    Beam2<Kinematics>::force_at(half_of(x, 1), 2.0 * xi - 1.0, force, second);
    add_to(kSecond, second, f);
  }
}

template <class Kinematics, Release released>
std::span<const double> BeamHalves<Kinematics, released>::point_to_node(const NodeCoordinates& /*x*/) const {
  static constexpr std::array<double, 18> ends{1.0, 0.0, 0.0, 0.0, 0.0, 0.0,   // node 1
                                               0.0, 0.0, 0.0, 0.0, 0.0, 1.0,   // node 2
                                               0.0, 0.0, 0.5, 0.5, 0.0, 0.0};  // node 3
  return ends;
}

template class BeamHalves<PlaneStrain>;
template class BeamHalves<Axisymmetric>;
template class BeamHalves<PlaneStrain, Release::axial>;
template class BeamHalves<Axisymmetric, Release::axial>;
template class BeamHalves<PlaneStrain, Release::shear>;
template class BeamHalves<Axisymmetric, Release::shear>;

}  // namespace sage
