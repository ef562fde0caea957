#include "sage/analysis/congruent.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>

namespace sage {

namespace {

// Coordinates relative to the first node in whole units; the radius too, in a ring.
void make_key(const Eigen::Matrix2Xd& x, bool ring, double unit, std::vector<std::int64_t>& key) {
  const Eigen::Index nodes = x.cols();
  key.clear();
  if (ring) key.push_back(std::llround(x(0, 0) / unit));
  for (Eigen::Index i = 1; i < nodes; ++i)
    for (Eigen::Index c = 0; c < 2; ++c) key.push_back(std::llround((x(c, i) - x(c, 0)) / unit));
}

}  // namespace

std::vector<int> shapes_of(const Mesh& mesh, const Group& group, Geometry geometry) {
  // What the rounding of coordinates leaves of equal distances.
  const double unit = 32.0 * std::numeric_limits<double>::epsilon() * mesh.x.cwiseAbs().maxCoeff();
  std::vector<int> shapes(static_cast<std::size_t>(group.elements()));
  std::unordered_map<std::string, int> known;
  std::vector<std::int64_t> key;
  Eigen::Matrix2Xd x;
  std::string bytes;
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(mesh, group, e, x);
    make_key(x, geometry == Geometry::axisymmetric, unit, key);
    bytes.assign(reinterpret_cast<const char*>(key.data()), key.size() * sizeof key[0]);
    shapes[e] = known.try_emplace(bytes, static_cast<int>(known.size())).first->second;
  }
  return shapes;
}

}  // namespace sage
