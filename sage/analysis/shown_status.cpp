#include "sage/analysis/shown_status.hpp"

#include "sage/core/contact.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

PointStatus shown_opening(const Mesh& mesh, const GroupData& data, std::size_t point) {
  if (is_contact(*data.group->entry)) return PointStatus::open;  // its law hasn't seen the gap
  constexpr double kRounding = rounding::kResult;
  const PointStates& state = data.state.committed;
  const auto history = history_of(data.law);
  const auto stride = static_cast<std::size_t>(data.state.history_size());
  const int element = static_cast<int>(point) / data.group->element->traits().points;
  const int* nodes = data.group->nodes_of(element);
  const double length = (mesh.x.col(nodes[1]) - mesh.x.col(nodes[0])).norm();
  for (std::size_t i = 0; i < history.size(); ++i)
    if (history[i].name == "gap" && state.h[point * stride + i] < kRounding * length)
      return PointStatus::elastic;
  return PointStatus::open;
}

}  // namespace sage
