#include "sage/analysis/congruent.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_map>

namespace sage {

namespace {

// Coordinates relative to the first node, in units of 1e-12 of the element's size; the radius too, in a ring.
void make_key(const Eigen::Matrix2Xd& x, bool ring, std::vector<std::int64_t>& key) {
  const Eigen::Index nodes = x.cols();
  const double size = (x.colwise() - x.col(0)).cwiseAbs().maxCoeff();
  const int exponent = std::ilogb(size);
  const double unit = std::ldexp(1e-12, exponent);
  key.clear();
  key.push_back(exponent);
  if (ring) key.push_back(std::llround(x(0, 0) / unit));
  for (Eigen::Index i = 1; i < nodes; ++i)
    for (Eigen::Index c = 0; c < 2; ++c) key.push_back(std::llround((x(c, i) - x(c, 0)) / unit));
}

}  // namespace

std::vector<int> shapes_of(const Mesh& mesh, const Group& group, Geometry geometry) {
  std::vector<int> shapes(static_cast<std::size_t>(group.elements()));
  std::unordered_map<std::string, int> known;
  std::vector<std::int64_t> key;
  Eigen::Matrix2Xd x;
  std::string bytes;
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(mesh, group, e, x);
    make_key(x, geometry == Geometry::axisymmetric, key);
    bytes.assign(reinterpret_cast<const char*>(key.data()), key.size() * sizeof key[0]);
    shapes[static_cast<std::size_t>(e)] =
        known.try_emplace(bytes, static_cast<int>(known.size())).first->second;
  }
  return shapes;
}

}  // namespace sage
