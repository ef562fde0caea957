#include "sage/model/model.hpp"

#include <algorithm>
#include <limits>

namespace sage {

LawRef Material::law_ref() const {
  if (const auto* solid = std::get_if<std::unique_ptr<SolidLaw>>(&law)) return solid->get();
  return std::get<std::unique_ptr<InterfaceLaw>>(law).get();
}

double report_area(const Model& model, const Report& report) {
  if (report.area > 0.0) return report.area;
  if (report.nodes.empty()) return std::numeric_limits<double>::quiet_NaN();
  double low = model.mesh.x(0, report.nodes.front()), high = low;
  for (int node : report.nodes) {
    low = std::min(low, model.mesh.x(0, node));
    high = std::max(high, model.mesh.x(0, node));
  }
  return model.geometry == Geometry::axisymmetric ? kPi * high * high : high - low;
}

void element_coordinates(const Mesh& mesh, const Group& group, int element, Eigen::Matrix2Xd& x) {
  const auto n = static_cast<Eigen::Index>(group.node_count());
  if (x.cols() != n) x.resize(2, n);
  const int* nodes = group.nodes_of(element);
  for (Eigen::Index i = 0; i < n; ++i) x.col(i) = mesh.x.col(nodes[i]);
}

}  // namespace sage
