#include "sage/model/coarse_shape.hpp"

#include <cmath>

namespace sage {

namespace {

Vector2 along_arc(const Vector2& a, const Vector2& z, const Vector2& centre, double t) {
  const Vector2 from = a - centre, to = z - centre;
  const double sweep = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  const double start = from.norm(), radius = (1.0 - t) * start + t * to.norm();
  const double c = std::cos(t * sweep), s = std::sin(t * sweep);
  return centre + radius / start * Vector2(c * from.x() - s * from.y(), s * from.x() + c * from.y());
}

}  // namespace

Vector2 along_side(const Vector2& a, const Vector2& z, const std::optional<Vector2>& middle,
                   const std::optional<Vector2>& centre, double t) {
  if (centre) return along_arc(a, z, *centre, t);
  if (middle) return (1 - t) * (1 - 2 * t) * a + t * (2 * t - 1) * z + 4 * t * (1 - t) * *middle;
  return (1 - t) * a + t * z;
}

bool CoarseShape::curved() const {
  constexpr double kStraight = 1e-12;  // of the side: rounding
  for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k) {
    if (!middle[k]) continue;
    const Vector2 &a = corner[k], &z = corner[(k + 1) % static_cast<std::size_t>(corners)];
    if ((*middle[k] - 0.5 * (a + z)).norm() > kStraight * (z - a).norm()) return true;
  }
  return false;
}

namespace {

// Of side k, that place q is beside: where along the side, and the part that q has of the side's distance from its chord.
// A triangle's part is that of the six-node triangle, where the side is a parabola.
std::pair<double, double> share_of_side(int corners, std::size_t k, const Place& q) {
  const auto [x, y] = q;
  if (corners == 4) {
    const std::array<double, 4> along{(1 + x) / 2, (1 + y) / 2, (1 - x) / 2, (1 - y) / 2};
    return {along[k], along[(k + 3) % 4]};
  }
  const std::array<double, 4> share = corner_shares(3, q);
  const double beside = share[k] + share[(k + 1) % 3];
  return {beside > 0.0 ? share[(k + 1) % 3] / beside : 0.0, beside * beside};
}

}  // namespace

// Corner part plus the distance of each side from its chord: transfinite interpolation (Gordon and Hall 1973).
Vector2 CoarseShape::at(const Place& q) const {
  const std::array<double, 4> linear = corner_shares(corners, q);
  Vector2 point = Vector2::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k) {
    point += linear[k] * corner[k];
    if (!middle[k] && !centre[k]) continue;
    const Vector2 &a = corner[k], &z = corner[(k + 1) % static_cast<std::size_t>(corners)];
    const auto [t, part] = share_of_side(corners, k, q);
    point += part * (along_side(a, z, middle[k], centre[k], t) - ((1 - t) * a + t * z));
  }
  return point;
}

std::array<double, 4> corner_shares(int corners, const Place& q) {
  const auto [x, y] = q;
  if (corners == 3) return {1 - x - y, x, y, 0.0};
  return {(1 - x) * (1 - y) / 4, (1 + x) * (1 - y) / 4, (1 + x) * (1 + y) / 4, (1 - x) * (1 + y) / 4};
}

const std::array<Place, 4>& parent_corners(int corners) {
  static const std::array<Place, 4> square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  static const std::array<Place, 4> triangle{{{0, 0}, {1, 0}, {0, 1}, {0, 0}}};
  return corners == 4 ? square : triangle;
}

}  // namespace sage
