#include "sage/analysis/dissipation.hpp"

#include <algorithm>

#include "sage/messages/error.hpp"

namespace sage {

namespace {

struct Work {
  double committed = 0.0, tried = 0.0;  // of the stresses before the step and at its end
};

Work work_of(const Mesh& mesh, const GroupData& data) {
  const Group& group = *data.group;
  const ElementTraits& traits = group.element->traits();
  const auto points = static_cast<std::size_t>(traits.points), size = static_cast<std::size_t>(traits.law_size);
  const std::size_t stride = 1 + size * static_cast<std::size_t>(traits.dofs);
  const PointStates &from = data.state.committed, &to = data.state.trial;
  std::vector<double> geometry(static_cast<std::size_t>(traits.geometry_size()));
  Eigen::Matrix2Xd x;
  Work work;
  for (int e = 0; e < group.elements(); ++e) {
    const std::size_t first = static_cast<std::size_t>(e) * points;
    const auto some = to.status.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::none_of(some, some + static_cast<std::ptrdiff_t>(points), is_plastic)) continue;
    element_coordinates(mesh, group, e, x);
    group.element->geometry(x, geometry);
    for (std::size_t p = 0; p < points; ++p) {
      if (!is_plastic(to.status[first + p])) continue;
      for (std::size_t i = (first + p) * size; i < (first + p + 1) * size; ++i) {
        const double deps = geometry[p * stride] * (to.eps[i] - from.eps[i]);
        work.committed += from.sigma[i] * deps;
        work.tried += to.sigma[i] * deps;
      }
    }
  }
  return work;
}

double dissipation_of(const Mesh& mesh, const GroupData& data) {
  const Work work = work_of(mesh, data);
  return data.group->structure() || !(work.committed > 0.0) ? work.tried : work.committed;
}

}  // namespace

std::vector<double> dissipation(const RunParts& run, const Eigen::VectorXd& du) {
  Assembly& assembly = run.assembly();
  if (!assembly.eliminated().dofs().empty() || !du.allFinite()) return {};
  try {
    if (assembly.evaluate(du, nullptr) == Outcome::cut_step) return {};
  } catch (const AnalysisError&) {
    return {};
  }
  std::vector<double> all;
  for (const GroupData& data : assembly.groups())
    all.push_back(data.active && !data.constant && !data.group->flow() ? dissipation_of(run.model.mesh, data)
                                                                       : 0.0);
  return all;
}

}  // namespace sage
