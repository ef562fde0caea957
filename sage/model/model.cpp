#include "sage/model/model.hpp"

namespace sage {

LawRef Material::law_ref() const {
  if (const auto* solid = std::get_if<std::unique_ptr<SolidLaw>>(&law)) return solid->get();
  return std::get<std::unique_ptr<InterfaceLaw>>(law).get();
}

void element_coordinates(const Mesh& mesh, const Group& group, int element, Eigen::Matrix2Xd& x) {
  const auto n = static_cast<Eigen::Index>(group.node_count());
  if (x.cols() != n) x.resize(2, n);
  const int* nodes = group.nodes_of(element);
  for (Eigen::Index i = 0; i < n; ++i) x.col(i) = mesh.x.col(nodes[i]);
}

}  // namespace sage
