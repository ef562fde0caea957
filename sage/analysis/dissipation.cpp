#include "sage/analysis/dissipation.hpp"

#include <algorithm>

#include "sage/messages/error.hpp"

namespace sage {

namespace {

double dissipation_of(const Mesh& mesh, const GroupData& data) {
  const Group& group = *data.group;
  const ElementTraits& traits = group.element->traits();
  const auto points = static_cast<std::size_t>(traits.points), size = static_cast<std::size_t>(traits.law_size);
  const std::size_t stride = 1 + size * static_cast<std::size_t>(traits.dofs);
  const PointStates &from = data.state.committed, &to = data.state.trial;
  std::vector<double> geometry(static_cast<std::size_t>(traits.geometry_size()));
  Eigen::Matrix2Xd x;
  double sum = 0.0;
  for (int e = 0; e < group.elements(); ++e) {
    const std::size_t first = static_cast<std::size_t>(e) * points;
    const auto some = to.status.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::none_of(some, some + static_cast<std::ptrdiff_t>(points), is_plastic)) continue;
    element_coordinates(mesh, group, e, x);
    group.element->geometry(x, geometry);
    for (std::size_t p = 0; p < points; ++p) {
      if (!is_plastic(to.status[first + p])) continue;
      for (std::size_t i = (first + p) * size; i < (first + p + 1) * size; ++i)
        sum += geometry[p * stride] * to.sigma[i] * (to.eps[i] - from.eps[i]);
    }
  }
  return sum;
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
