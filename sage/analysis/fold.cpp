#include "sage/analysis/fold.hpp"

#include <algorithm>
#include <limits>

#include "sage/analysis/explain.hpp"
#include "sage/core/contact.hpp"

namespace sage {

namespace {

// The corner with the smallest share of its area in the mesh.
struct Corner {
  const Group* group = nullptr;
  int element = 0, node = 0;
  double share = std::numeric_limits<double>::infinity();
};

double area_at(const Element& element, const Eigen::Matrix2Xd& x, const std::array<double, 2>& parent) {
  const auto nodes = static_cast<std::size_t>(x.cols());
  std::vector<double> N(nodes), dN(2 * nodes);
  element.shape_functions(Vector2(parent[0], parent[1]), N, dN);
  return Matrix2(x * Eigen::Map<const Eigen::MatrixXd>(dN.data(), x.cols(), 2)).determinant();
}

void look_at(const Model& model, const Group& group, int element, const Eigen::VectorXd& u, Corner& worst) {
  Eigen::Matrix2Xd mesh;
  element_coordinates(model.mesh, group, element, mesh);
  Eigen::Matrix2Xd moved = mesh;
  const int* const nodes = group.nodes_of(element);
  for (Eigen::Index i = 0; i < moved.cols(); ++i) moved.col(i) += u.segment<2>(DofMap::displacement(nodes[i]));
  for (int corner = 0; corner < group.entry->corners; ++corner) {
    const std::array<double, 2>& parent = group.entry->parent_nodes[corner];
    const double share = area_at(*group.element, moved, parent) / area_at(*group.element, mesh, parent);
    if (share < worst.share) worst = {&group, element, nodes[corner], share};
  }
}

Corner worst_corner(const Model& model, const Assembly& assembly, const Eigen::VectorXd& u) {
  Corner worst;
  for (const GroupData& data : assembly.groups()) {
    if (!data.active || !data.group->element->traits().large_strain) continue;
    for (int e = 0; e < data.group->elements(); ++e) look_at(model, *data.group, e, u, worst);
  }
  return worst;
}

bool has_contact(const Model& model) {
  return std::ranges::any_of(model.groups, [](const Group& group) { return is_contact(*group.entry); });
}

}  // namespace

std::string fold_lines(const Model& model, const Assembly& assembly, const Eigen::VectorXd& u,
                       const Eigen::VectorXd& du) {
  constexpr double kNear = 0.2;
  const Corner now = worst_corner(model, assembly, u), tried = worst_corner(model, assembly, u + du);
  const Corner& found = now.share < kNear ? now : tried;
  if (found.group == nullptr || (now.share >= kNear && !(tried.share <= 0.0))) return {};
  const Vector2 place = model.mesh.x.col(found.node) + u.segment<2>(DofMap::displacement(found.node));
  return "  element " + std::to_string(found.group->element_numbers[found.element]) + " (group " +
         std::to_string(found.group->number) + ", " + found.group->element_name +
         ") turns inside out: its corner at node " + std::to_string(model.mesh.number[found.node]) +
         ", now at (" + short_number(place.x()) + "; " + short_number(place.y()) + "), has " +
         short_number(100.0 * now.share) + " % of its area in the mesh at the last equilibrium" +
         (tried.share <= 0.0 ? " and is beyond zero at the last attempt" : "") + "\n  what helps: " +
         (has_contact(model) ? "" : "a free side that rolls onto a rough platen needs elements of contact; ") +
         "a larger element at that corner goes further, and smaller increments do where the steps were large\n";
}

}  // namespace sage
