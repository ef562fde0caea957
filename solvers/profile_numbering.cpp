#include "solvers/profile_numbering.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

class CuthillMckee {
 public:
  explicit CuthillMckee(const EquationGraph& graph) : graph_(graph) {
    distance_.assign(at(graph.members.count()), -1);
    done_.assign(at(graph.members.count()), 0);
    order_.reserve(at(graph.members.count()));
  }

  std::vector<int> run(Beginning beginning) {
    for (int seed = 0; seed < graph_.members.count(); ++seed) {
      if (done_[at(seed)]) continue;
      const auto begin = static_cast<std::ptrdiff_t>(order_.size());
      number_part(beginning == Beginning::end ? std::vector<int>{far_ends(seed).first} : side(seed));
      std::reverse(order_.begin() + begin, order_.end());
    }
    return std::move(order_);
  }

 private:
  std::pair<std::size_t, int> rank(int group) const { return {graph_.neighbours.of(group).size(), group}; }

  void number_part(std::span<const int> roots) {
    std::size_t head = order_.size();
    for (const int root : roots) take(root);
    for (; head < order_.size(); ++head) {
      const auto tail = static_cast<std::ptrdiff_t>(order_.size());
      for (const int other : graph_.neighbours.of(order_[head]))
        if (!done_[at(other)]) take(other);
      std::sort(order_.begin() + tail, order_.end(), [&](int a, int b) { return rank(a) < rank(b); });
    }
  }

  void take(int group) {
    done_[at(group)] = 1;
    order_.push_back(group);
  }

  // Levels of a breadth-first search; distance_ is left clean.
  IndexLists search(std::span<const int> roots) {
    IndexLists levels;
    levels.item.assign(roots.begin(), roots.end());
    for (const int root : roots) distance_[at(root)] = 0;
    std::size_t head = 0;
    while (head < levels.item.size()) {
      const std::size_t end = levels.item.size();
      levels.start.push_back(static_cast<int>(end));
      for (; head < end; ++head)
        for (const int other : graph_.neighbours.of(levels.item[head])) {
          if (distance_[at(other)] >= 0) continue;
          distance_[at(other)] = levels.count();
          levels.item.push_back(other);
        }
    }
    for (const int group : levels.item) distance_[at(group)] = -1;
    return levels;
  }

  // The deeper end of a pseudo-diameter first.
  std::pair<int, int> far_ends(int seed) {
    std::pair<int, int> ends{seed, seed};
    for (int depth = 0;;) {
      const IndexLists levels = search({&ends.first, 1});
      const auto last = levels.of(levels.count() - 1);
      ends.second = *std::ranges::min_element(last, {}, [&](int g) { return rank(g); });
      if (levels.count() <= depth) return ends;
      depth = levels.count();
      std::swap(ends.first, ends.second);
    }
  }

  // All that is farthest from an end, in the order of the distance from one of its corners.
  std::vector<int> side(int seed) {
    const int end = far_ends(seed).first;
    const IndexLists levels = search({&end, 1});
    const auto last = levels.of(levels.count() - 1);
    std::vector<int> groups(last.begin(), last.end());
    const IndexLists across = search({&groups.front(), 1});
    std::vector<char> is_wanted(done_.size(), 0);
    for (const int group : groups) is_wanted[at(group)] = 1;
    // The corner is the wanted group that is farthest from the first; from there outwards.
    const auto corner =
        std::find_if(across.item.rbegin(), across.item.rend(), [&](int g) { return is_wanted[at(g)]; });
    const IndexLists outwards = search({&*corner, 1});
    groups.clear();
    std::ranges::copy_if(outwards.item, std::back_inserter(groups),
                         [&](int g) { return is_wanted[at(g)] != 0; });
    return groups;
  }

  const EquationGraph& graph_;
  std::vector<int> order_, distance_;
  std::vector<char> done_;
};

// Lowest position in the elimination that the column of every group reaches.
std::vector<int> first_positions(const EquationGraph& graph, std::span<const int> order) {
  std::vector<int> first(order.size());
  int position = 0;
  for (const int group : order) {
    first[at(group)] = position;
    position += static_cast<int>(graph.members.of(group).size());
  }
  return first;
}

}  // namespace

std::vector<int> reverse_cuthill_mckee(const EquationGraph& graph, Beginning beginning) {
  return CuthillMckee(graph).run(beginning);
}

double profile_cost(const EquationGraph& graph, std::span<const int> order) {
  const std::vector<int> first = first_positions(graph, order);
  double cost = 0.0;
  for (const int group : order) {
    int top = first[at(group)];
    for (const int other : graph.neighbours.of(group)) top = std::min(top, first[at(other)]);
    const int size = static_cast<int>(graph.members.of(group).size());
    for (int k = 1; k <= size; ++k) {
      const double height = first[at(group)] + k - top;
      cost += height * height;
    }
  }
  return cost;
}

std::vector<int> best_profile_numbering(const EquationGraph& graph) {
  std::vector<int> best(at(graph.members.count()));
  std::iota(best.begin(), best.end(), 0);
  double least = profile_cost(graph, best);
  for (const Beginning beginning : {Beginning::end, Beginning::side}) {
    std::vector<int> candidate = reverse_cuthill_mckee(graph, beginning);
    const double cost = profile_cost(graph, candidate);
    if (cost >= least) continue;
    least = cost;
    best = std::move(candidate);
  }
  return best;
}

std::vector<int> expand(const EquationGraph& graph, std::span<const int> order) {
  std::vector<int> equations;
  equations.reserve(graph.group_of.size());
  for (const int group : order) {
    const auto members = graph.members.of(group);
    equations.insert(equations.end(), members.begin(), members.end());
  }
  return equations;
}

void delay_pressures(const EquationGraph& graph, std::vector<int>& equations) {
  if (graph.pressure.empty()) return;
  const auto is_pressure = [&](int equation) { return graph.pressure[at(equation)] != 0; };
  std::vector<int> last(at(graph.members.count()), -1);  // place of each group's last other equation
  for (std::size_t p = 0; p < equations.size(); ++p)
    if (!is_pressure(equations[p])) last[at(graph.group_of[at(equations[p])])] = static_cast<int>(p);
  const auto place = [&](int equation, int own) {
    if (!is_pressure(equation)) return own;
    const int group = graph.group_of[at(equation)];
    int behind = last[at(group)];
    for (const int other : graph.neighbours.of(group)) behind = std::max(behind, last[at(other)]);
    return std::max(behind, own);
  };
  std::vector<std::pair<int, int>> ranked;
  for (std::size_t p = 0; p < equations.size(); ++p)
    ranked.emplace_back(place(equations[p], static_cast<int>(p)), equations[p]);
  std::ranges::stable_sort(ranked, [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : is_pressure(a.second) < is_pressure(b.second);
  });
  for (std::size_t p = 0; p < equations.size(); ++p) equations[p] = ranked[p].second;
}

}  // namespace sage
