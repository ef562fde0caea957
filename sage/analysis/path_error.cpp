#include "sage/analysis/path_error.hpp"

#include <cmath>

namespace sage {

namespace {

struct WeightedMean {
  double sum = 0.0, weight = 0.0;
};

template <int N>
void add_path_error(const GroupData& data, const Law<N>& law, WeightedMean& mean) {
  const StateStore& state = data.state;
  const ElementTraits& traits = data.group->element->traits();
  const auto stride = static_cast<std::size_t>(traits.geometry_size() / traits.points);
  const auto history = static_cast<std::size_t>(state.history_size());
  const std::size_t points = state.committed.status.size();
  for (std::size_t p = 0; p < points; ++p) {
    const auto at = [&](const std::vector<double>& v) { return Eigen::Map<const Vector<N>>(v.data() + p * N); };
    const auto h = [&](const PointStates& s) {
      return std::span<const double>(s.h.data() + p * history, history);
    };
    const Vector<N> sigma0 = at(state.committed.sigma), sigma1 = at(state.trial.sigma);
    const Vector<N> eps0 = at(state.committed.eps), deps = at(state.trial.eps) - eps0;
    const double work = data.geometry[p * stride] * std::abs((sigma1 - sigma0).dot(deps));
    mean.weight += work;
    mean.sum += work * law.path_error({sigma0, eps0, deps, h(state.committed)}, sigma1, h(state.trial));
  }
}

}  // namespace

double mean_path_error(const std::vector<GroupData>& groups, const std::vector<char>& group_linear) {
  WeightedMean mean;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (groups[g].active && !group_linear[g])
      std::visit([&](const auto* law) { add_path_error(groups[g], *law, mean); }, groups[g].law);
  return mean.weight > 0.0 ? mean.sum / mean.weight : 0.0;
}

}  // namespace sage
