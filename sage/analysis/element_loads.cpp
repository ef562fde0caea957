#include "sage/analysis/element_loads.hpp"

#include <algorithm>
#include <utility>

#include "sage/model/activity.hpp"
#include "sage/model/spread_loads.hpp"

namespace sage {

namespace {

// Of a group whose loads on edges follow its motion (ElementTraits::large_strain): the sums of these loads, by element.
std::vector<FollowedEdge> followed_edges(const Model& model, int stage, int group) {
  std::vector<FollowedEdge> edges;
  Activity activity(model);
  for (int s = 0; s <= stage; ++s) {
    const Stage& now = model.stages[s];
    activity.enter(now);
    if (!activity.group[group]) continue;
    for (const EdgeLoad& load : now.pressures) {
      if (load.group != group) continue;
      auto at = std::ranges::find_if(edges, [&](const FollowedEdge& edge) {
        return edge.element == load.element && edge.end.edge == load.edge;
      });
      if (at == edges.end()) {
        const EdgeTraction none{.edge = load.edge};
        at = edges.insert(edges.end(), FollowedEdge{load.element, none, none});
      }
      for (EdgeTraction* sum : {s < stage ? &at->start : nullptr, &at->end}) {
        if (sum == nullptr) continue;
        sum->normal += load.normal;
        sum->shear += load.shear;
      }
    }
  }
  std::ranges::stable_sort(edges, {}, &FollowedEdge::element);
  return edges;
}

// What was at this load factor stays.
void take_followed_edges(GroupData& data, std::vector<FollowedEdge> edges, double t) {
  const std::vector<FollowedEdge> last = std::exchange(data.followed, std::move(edges));
  for (FollowedEdge& edge : data.followed) {
    const auto old = std::ranges::find_if(last, [&](const FollowedEdge& other) {
      return other.element == edge.element && other.end.edge == edge.end.edge;
    });
    const EdgeTraction none, &start = old == last.end() ? none : old->start,
                             &end = old == last.end() ? none : old->end;
    const auto start_of = [t](const Vector2& from, const Vector2& to, const Vector2& now_to) -> Vector2 {
      return ((1.0 - t) * from + t * to - t * now_to) / (1.0 - t);
    };
    edge.start.normal = start_of(start.normal, end.normal, edge.end.normal);
    edge.start.shear = start_of(start.shear, end.shear, edge.end.shear);
  }
}

}  // namespace

void begin_element_loads(const Model& model, int stage, std::vector<GroupData>& groups) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].group->element->traits().large_strain)
      groups[g].followed = followed_edges(model, stage, static_cast<int>(g));
    if (!groups[g].sees_spread) continue;
    groups[g].spread_start = spread_loads(model, stage - 1, g);
    groups[g].spread_end = spread_loads(model, stage, g);
  }
}

void change_element_loads(const Model& model, int stage, double load_factor, std::vector<GroupData>& groups) {
  const double t = load_factor;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (groups[g].group->element->traits().large_strain)
      take_followed_edges(groups[g], followed_edges(model, stage, static_cast<int>(g)), t);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].sees_spread) continue;
    std::vector<double>&start = groups[g].spread_start, &end = groups[g].spread_end;
    const std::vector<double> last = std::exchange(end, spread_loads(model, stage, g));
    const std::size_t size = std::max({start.size(), last.size(), end.size()});
    for (std::vector<double>* list : {&start, &end}) list->resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      const double now = (1.0 - t) * start[i] + (i < last.size() ? t * last[i] : 0.0);
      start[i] = (now - t * end[i]) / (1.0 - t);
    }
  }
}

}  // namespace sage
