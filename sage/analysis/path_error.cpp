#include "sage/analysis/path_error.hpp"

#include <cmath>

#include "sage/analysis/element_work.hpp"

namespace sage {

namespace {

struct WeightedMean {
  double sum = 0.0, weight = 0.0;
};

// w of a point of the group: the first of its doubles in the kept geometry, whose points stand before what the element
// has of its own.
double weight_of(const GroupData& data, const ElementTraits& traits, std::size_t point) {
  const auto points = static_cast<std::size_t>(traits.points);
  if (!data.four_abreast())
    return data.geometry[point / points * static_cast<std::size_t>(traits.geometry_size()) +
                         point % points * static_cast<std::size_t>(1 + traits.law_size * traits.dofs)];
  const auto size = static_cast<std::size_t>(data.four_elements->four_geometry_size());
  const std::size_t element = point / points, place = element % kAbreast;
  return data
      .geometry_four_abreast[(element - place) * size + point % points * (size / points) * kAbreast + place];
}

template <int N>
void add_path_error(const Mesh& mesh, const GroupData& data, const Law<N>& law, const StepTime& step_time,
                    WeightedMean& mean) {
  const StateStore& state = data.state;
  const ElementTraits& traits = data.group->element->traits();
  const auto history = static_cast<std::size_t>(state.history_size());
  const std::size_t points = state.committed.status.size();
  Eigen::Matrix2Xd x;
  PointContext context;
  const auto* const estimate = dynamic_cast<const PathError<N>*>(&law);
  for (std::size_t p = 0; p < points; ++p) {
    const auto at = [&](const std::vector<double>& v) { return Eigen::Map<const Vector<N>>(v.data() + p * N); };
    const auto h = [&](const PointStates& s) {
      return std::span<const double>(s.h.data() + p * history, history);
    };
    const Vector<N> sigma0 = at(state.committed.sigma), sigma1 = at(state.trial.sigma);
    const Vector<N> eps0 = at(state.committed.eps), deps = at(state.trial.eps) - eps0;
    const double work = weight_of(data, traits, p) * std::abs((sigma1 - sigma0).dot(deps));
    mean.weight += work;
    if (estimate == nullptr) continue;
    PointIn<N> in{sigma0, eps0, deps, h(state.committed)};
    if (data.wants_context) {
      const int element = static_cast<int>(p) / traits.points, point = static_cast<int>(p) % traits.points;
      element_coordinates(mesh, *data.group, element, x);
      context = context_of(data, element, x, point, step_time);
      in.context = &context;
    }
    mean.sum += work * estimate->path_error(in, sigma1, h(state.trial));
  }
}

}  // namespace

double mean_path_error(const Mesh& mesh, const std::vector<GroupData>& groups,
                       const std::vector<char>& group_linear, const StepTime& step_time) {
  WeightedMean mean;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (groups[g].active && !group_linear[g] && !has_matrix_of_step(groups[g]))
      std::visit([&](const auto* law) { add_path_error(mesh, groups[g], *law, step_time, mean); },
                 groups[g].law);
  return mean.weight > 0.0 ? mean.sum / mean.weight : 0.0;
}

}  // namespace sage
