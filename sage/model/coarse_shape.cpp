#include "sage/model/coarse_shape.hpp"

#include <cmath>

namespace sage {

Vector2 along_edge(const Vector2& a, const Vector2& z, const std::optional<Vector2>& middle, double t) {
  if (!middle) return (1 - t) * a + t * z;
  return (1 - t) * (1 - 2 * t) * a + t * (2 * t - 1) * z + 4 * t * (1 - t) * *middle;
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

// Corner part plus, for each curved side, its middle node's distance from the chord times
// the middle node's function.
Vector2 CoarseShape::at(const Place& q) const {
  const auto [x, y] = q;
  std::array<double, 4> bubble{};
  const std::array<double, 4> linear = corner_shares(corners, q);
  if (corners == 4) {
    bubble = {(1 - x * x) * (1 - y) / 2, (1 + x) * (1 - y * y) / 2, (1 - x * x) * (1 + y) / 2,
              (1 - x) * (1 - y * y) / 2};
  } else {
    bubble = {4 * (1 - x - y) * x, 4 * x * y, 4 * y * (1 - x - y), 0.0};
  }
  Vector2 point = Vector2::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k) {
    point += linear[k] * corner[k];
    const std::size_t next = (k + 1) % static_cast<std::size_t>(corners);
    if (middle[k]) point += bubble[k] * (*middle[k] - 0.5 * (corner[k] + corner[next]));
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
