#include "sage/model/solid_edges.hpp"

#include <algorithm>

namespace sage {

namespace {

using Wanted = std::function<bool(std::size_t group)>;

// act(group, element, local, from, to) for every edge of every solid.
template <class Act>
void for_edges(const Model& model, const Wanted& wanted, const Act& act) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!wanted(g)) continue;
    const auto& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      for (std::size_t i = 0; i < edges.size(); ++i)
        act(static_cast<int>(g), e, static_cast<std::int16_t>(i), nodes[edges[i][0]], nodes[edges[i][1]]);
    }
  }
}

}  // namespace

SolidEdges::SolidEdges(const Model& model)
    : SolidEdges(model, [&](std::size_t g) { return model.groups[g].solid(); }) {}

SolidEdges::SolidEdges(const Model& model, const Wanted& wanted)
    : first_(static_cast<std::size_t>(model.mesh.nodes()) + 1, 0) {
  for_edges(model, wanted, [&](int, int, std::int16_t, int from, int to) {
    ++first_[static_cast<std::size_t>(std::min(from, to)) + 1];
  });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  edges_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_edges(model, wanted, [&](int group, int element, std::int16_t local, int from, int to) {
    edges_[next[std::min(from, to)]++] = {std::max(from, to), group, element, local, from > to};
  });
  for (std::size_t node = 0; node + 1 < first_.size(); ++node) {
    const auto begin = edges_.begin() + static_cast<std::ptrdiff_t>(first_[node]);
    const auto end = edges_.begin() + static_cast<std::ptrdiff_t>(first_[node + 1]);
    const auto before = [](const SolidEdge& a, const SolidEdge& b) { return a.other < b.other; };
    if (end - begin > 32) {
      std::stable_sort(begin, end, before);
      continue;
    }
    for (auto i = begin; i != end; ++i)  // most nodes have few: each edge goes before those with larger nodes
      for (auto k = i; k != begin && before(*k, *(k - 1)); --k) std::iter_swap(k, k - 1);
  }
}

bool SolidEdges::has(int from, int to) const {
  return std::ranges::any_of(at(std::min(from, to)), [&](const SolidEdge& edge) {
    return edge.other == std::max(from, to) && edge.reversed == (from > to);
  });
}

}  // namespace sage
