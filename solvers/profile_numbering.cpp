#include "solvers/profile_numbering.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>
#include <utility>

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int degree(const EquationGraph& graph, int group) {
  return static_cast<int>(graph.neighbours.of(group).size());
}

// Two ends of a pseudo-diameter of the part that holds `seed`, and the levels from the first.
struct Ends {
  int first = 0, last = 0;
  IndexLists levels;
};

int least_degree(const EquationGraph& graph, std::span<const int> groups) {
  return *std::ranges::min_element(groups, {}, [&](int g) { return std::pair{degree(graph, g), g}; });
}

Ends pseudo_diameter(const EquationGraph& graph, int seed, std::vector<int>& distance) {
  Ends ends;
  ends.first = seed;
  for (int previous_depth = 0;;) {
    const std::array<int, 1> root{ends.first};
    ends.levels = levels_from(graph, root, distance);
    const int depth = ends.levels.count();
    ends.last = least_degree(graph, ends.levels.of(depth - 1));
    for (const int g : ends.levels.item) distance[at(g)] = -1;
    if (depth <= previous_depth) return ends;
    previous_depth = depth;
    std::swap(ends.first, ends.last);
  }
}

void cuthill_mckee_part(const EquationGraph& graph, int root, std::vector<char>& done,
                        std::vector<int>& order) {
  std::size_t head = order.size();
  order.push_back(root);
  done[at(root)] = 1;
  while (head < order.size()) {
    const auto tail = static_cast<std::ptrdiff_t>(order.size());
    for (const int other : graph.neighbours.of(order[head])) {
      if (done[at(other)]) continue;
      done[at(other)] = 1;
      order.push_back(other);
    }
    std::sort(order.begin() + tail, order.end(), [&](int a, int b) {
      return std::pair{degree(graph, a), a} < std::pair{degree(graph, b), b};
    });
    ++head;
  }
}

// One connected part by Sloan's algorithm; distance holds the distance from the last end.
class SloanPart {
 public:
  SloanPart(const EquationGraph& graph, std::vector<int>& order) : graph_(graph), order_(order) {
    const auto groups = at(graph.members.count());
    status_.assign(groups, inactive);
    priority_.assign(groups, 0);
  }

  void number(int start, std::span<const int> part, const std::vector<int>& distance) {
    for (const int g : part) priority_[at(g)] = 1 * distance[at(g)] - 2 * (degree(graph_, g) + 1);
    activate(start);
    while (!queue_.empty()) {
      const auto [priority, minus_group] = queue_.top();
      queue_.pop();
      const int group = -minus_group;
      if (status_[at(group)] == numbered || priority != priority_[at(group)]) continue;
      if (status_[at(group)] == preactive)
        for (const int other : graph_.neighbours.of(group)) raise(other);
      order_.push_back(group);
      status_[at(group)] = numbered;
      for (const int other : graph_.neighbours.of(group))
        if (status_[at(other)] == preactive) {
          raise(other);
          status_[at(other)] = active;
          for (const int further : graph_.neighbours.of(other))
            if (status_[at(further)] != numbered) raise(further);
        }
    }
  }

 private:
  enum Status : char { inactive, preactive, active, numbered };

  void activate(int group) {
    status_[at(group)] = preactive;
    queue_.emplace(priority_[at(group)], -group);
  }
  // One more neighbour is in the front: numbering this group costs less.
  void raise(int group) {
    if (status_[at(group)] == numbered) return;
    priority_[at(group)] += 2;
    if (status_[at(group)] == inactive) status_[at(group)] = preactive;
    queue_.emplace(priority_[at(group)], -group);  // the entry with the old priority is skipped later
  }

  const EquationGraph& graph_;
  std::vector<int>& order_;
  std::vector<Status> status_;
  std::vector<int> priority_;
  std::priority_queue<std::pair<int, int>> queue_;
};

// Lowest position in the elimination that a column reaches, for every position.
std::vector<int> column_tops(const EquationGraph& graph, std::span<const int> order) {
  std::vector<int> first_position(order.size());
  int position = 0;
  for (const int group : order) {
    first_position[at(group)] = position;
    position += static_cast<int>(graph.members.of(group).size());
  }
  std::vector<int> tops;
  tops.reserve(at(position));
  for (const int group : order) {
    int top = first_position[at(group)];
    for (const int other : graph.neighbours.of(group)) top = std::min(top, first_position[at(other)]);
    tops.insert(tops.end(), graph.members.of(group).size(), top);
  }
  return tops;
}

}  // namespace

IndexLists levels_from(const EquationGraph& graph, std::span<const int> roots, std::vector<int>& distance) {
  IndexLists levels;
  for (const int root : roots) {
    distance[at(root)] = 0;
    levels.item.push_back(root);
  }
  std::size_t head = 0;
  for (int level = 1; head < levels.item.size(); ++level) {
    const std::size_t end = levels.item.size();
    levels.start.push_back(static_cast<int>(end));
    for (; head < end; ++head)
      for (const int other : graph.neighbours.of(levels.item[head])) {
        if (distance[at(other)] >= 0) continue;
        distance[at(other)] = level;
        levels.item.push_back(other);
      }
  }
  return levels;
}

std::vector<int> reverse_cuthill_mckee(const EquationGraph& graph) {
  const int groups = graph.members.count();
  std::vector<int> order, distance(at(groups), -1);
  std::vector<char> done(at(groups), 0);
  order.reserve(at(groups));
  for (int seed = 0; seed < groups; ++seed) {
    if (done[at(seed)]) continue;
    const auto begin = static_cast<std::ptrdiff_t>(order.size());
    cuthill_mckee_part(graph, pseudo_diameter(graph, seed, distance).first, done, order);
    std::reverse(order.begin() + begin, order.end());
  }
  return order;
}

std::vector<int> sloan(const EquationGraph& graph) {
  const int groups = graph.members.count();
  std::vector<int> order, distance(at(groups), -1), from_end(at(groups), -1);
  order.reserve(at(groups));
  SloanPart part(graph, order);
  for (int seed = 0; seed < groups; ++seed) {
    if (from_end[at(seed)] >= 0) continue;
    const Ends ends = pseudo_diameter(graph, seed, distance);
    const std::array<int, 1> root{ends.last};
    levels_from(graph, root, from_end);
    part.number(ends.first, ends.levels.item, from_end);
  }
  return order;
}

double profile_cost(const EquationGraph& graph, std::span<const int> order) {
  double cost = 0.0;
  const std::vector<int> tops = column_tops(graph, order);
  for (std::size_t i = 0; i < tops.size(); ++i) {
    const double height = static_cast<double>(i) - tops[i] + 1.0;
    cost += height * height;
  }
  return cost;
}

double profile_terms(const EquationGraph& graph, std::span<const int> order) {
  double terms = 0.0;
  const std::vector<int> tops = column_tops(graph, order);
  for (std::size_t i = 0; i < tops.size(); ++i) terms += 2.0 * (static_cast<double>(i) - tops[i]) + 1.0;
  return terms;
}

std::vector<int> best_profile_numbering(const EquationGraph& graph) {
  std::vector<int> best(at(graph.members.count()));
  std::iota(best.begin(), best.end(), 0);
  double least = profile_cost(graph, best);
  for (auto&& candidate : {reverse_cuthill_mckee(graph), sloan(graph)}) {
    const double cost = profile_cost(graph, candidate);
    if (cost >= least) continue;
    least = cost;
    best = candidate;
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

}  // namespace sage
