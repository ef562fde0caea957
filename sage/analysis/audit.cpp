#include "sage/analysis/audit.hpp"

#include <algorithm>
#include <cmath>

#include "sage/math/rounding.hpp"

namespace sage {

namespace {

// What the rounding of its unknowns makes of the sums of a further field: water at rest flows by that much.  Known
// of elements whose matrices are kept; of others 0.
double rounding_of(const Assembly& assembly, int field, const Eigen::VectorXd& u) {
  constexpr double kRounding = rounding::kSumAtNode;
  double stiffest = 0.0, largest = 0.0, count = 0.0;
  for (const GroupData& data : assembly.groups()) {
    if (!data.active || !data.constant || data.field_of_dof.empty() || data.field_of_dof[0] != field) continue;
    for (const double k : data.K) stiffest = std::max(stiffest, std::abs(k));
  }
  const DofMap& map = assembly.dof_map();
  for (int dof = map.displacements(); dof < map.dofs(); ++dof) {
    if (map.at(dof).field != field) continue;
    largest = std::max(largest, std::abs(u[dof]));
    ++count;
  }
  return kRounding * stiffest * largest * std::sqrt(count);
}

}  // namespace

EquilibriumAudit audit_equilibrium(const Model& model, const Assembly& assembly, const Solution& now,
                                   const Eigen::VectorXd& force_start) {
  EquilibriumAudit audit;
  const Eigen::VectorXd &f = *now.internal, &external = *now.external, &u = *now.u;
  double moment_scale = 0.0, extent = 0.0, scale[2] = {0, 0};
  const DofMap& map = assembly.dof_map();
  const Eigen::VectorXd unbalanced = f - external;
  audit.fields.resize(static_cast<std::size_t>(map.fields()) - 1);
  for (int dof = 0; dof < map.dofs(); ++dof) {
    if (!assembly.in_use(dof)) continue;
    const auto [node, field, c] = map.at(dof);
    const double reaction = assembly.numbering().constraint_force(unbalanced, dof);
    const double size = std::max(std::abs(external[dof]) + std::abs(reaction), std::abs(force_start[dof]));
    if (field > 0) {
      FieldAudit& sums = audit.fields[static_cast<std::size_t>(field) - 1];
      sums.applied += external[dof];
      sums.reactions += reaction;
      sums.scale += size;
      if (model.unknowns[field].turns) {  // couples have the same moment everywhere
        audit.moment += external[dof] + reaction;
        moment_scale += size;
      }
      continue;
    }
    const double force = external[dof] + reaction;
    audit.applied[c] += external[dof];
    audit.reactions[c] += reaction;
    // Large strain is in balance in the place that it has moved to.
    const double moved = model.large_strain ? u[DofMap::displacement(node, 1 - c)] : 0.0;
    const double place = model.mesh.x(1 - c, node) + moved, arm = c == 0 ? -place : place;
    audit.moment += force * arm;
    scale[c] += size;
    moment_scale += size * std::abs(arm);
    extent = std::max(extent, std::abs(arm));
  }
  audit.scale = std::max(scale[0], scale[1]);
  // Forces whose lines pass through the origin have no moment, but the rounding of the others has.
  moment_scale = std::max(moment_scale, 1e-3 * audit.scale * extent);
  const bool plane = model.geometry == Geometry::plane_strain;
  if (audit.scale > 0.0) {
    audit.out_of_balance = std::abs(audit.applied[1] + audit.reactions[1]) / audit.scale;
    if (plane)  // radial forces of a ring need no sum of zero
      audit.out_of_balance =
          std::max(audit.out_of_balance, std::abs(audit.applied[0] + audit.reactions[0]) / audit.scale);
  }
  if (plane && moment_scale > 0.0)
    audit.out_of_balance = std::max(audit.out_of_balance, std::abs(audit.moment) / moment_scale);
  for (std::size_t i = 0; i < audit.fields.size(); ++i) {
    const FieldAudit& sums = audit.fields[i];
    const double left = std::abs(sums.applied + sums.reactions);
    if (model.unknowns[i + 1].balanced && left > rounding_of(assembly, static_cast<int>(i) + 1, u))
      audit.out_of_balance = std::max(audit.out_of_balance, left / sums.scale);
  }
  return audit;
}

}  // namespace sage
