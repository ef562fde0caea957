#include "solvers/nested_dissection.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// The level that separates best: few groups for the product of the two sides.  Lopsided cuts, below a fifth,
// serve only where there is no other.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int level = -1;
};

Cut best_cut(const IndexLists& levels) {
  Cut best;
  const double all = static_cast<double>(levels.item.size());
  for (int level = 1; level + 1 < levels.count(); ++level) {
    const double size = static_cast<double>(levels.of(level).size());
    const double before = levels.start[at(level)], behind = all - before - size;
    const double lopsided = std::min(before, behind) < 0.2 * all ? 1e3 : 1.0;
    const double cost = lopsided * size * all * all / (before * behind);
    if (cost < best.cost) best = {cost, level};
  }
  return best;
}

class Dissection {
 public:
  Dissection(const EquationGraph& graph, int leaf_equations) : graph_(graph), leaf_equations_(leaf_equations) {
    part_of_.assign(at(graph.members.count()), 0);
    mark_.assign(at(graph.members.count()), 0);
  }

  SeparatorTree run(int border) {
    const int inner = static_cast<int>(graph_.group_of.size()) - border;
    std::vector<int> all, last;
    all.reserve(at(graph_.members.count()));
    for (int g = 0; g < graph_.members.count(); ++g) {
      const bool stays = graph_.members.of(g).front() >= inner;
      if (stays) part_of_[at(g)] = -1;
      (stays ? last : all).push_back(g);
    }
    const std::vector<int> tops = dissect(all, 0, {});
    if (!last.empty()) add_node(last, tops);
    return std::move(tree_);
  }

 private:
  // Divides the groups with part_of_ == part into connected pieces and each of them further.  Returns the tree
  // nodes that have no parent yet.  `near` are groups that touch the separator above.
  std::vector<int> dissect(std::span<const int> groups, int part, std::span<const int> near) {
    std::vector<int> tops;
    for (const int seed : groups) {
      if (part_of_[at(seed)] != part) continue;  // already in another piece
      IndexLists piece = search({&seed, 1}, part);
      const int own = ++parts_;
      for (const int g : piece.item) part_of_[at(g)] = own;
      std::vector<int> roots;
      for (const int g : near)
        if (part_of_[at(g)] == own) roots.push_back(g);
      tops.push_back(divide(std::move(piece), own, roots));
    }
    return tops;
  }

  int divide(IndexLists levels, int part, std::span<const int> near) {
    int equations = 0;
    for (const int g : levels.item) equations += static_cast<int>(graph_.members.of(g).size());
    if (equations <= leaf_equations_) return add_node(levels.item, {});
    levels = best_levels(std::move(levels), part, near);
    const Cut cut = best_cut(levels);
    if (cut.level < 0) return add_node(levels.item, {});  // everything touches everything

    const int before = ++parts_, behind = ++parts_;
    std::vector<int> first, second, separator;
    for (int level = 0; level < levels.count(); ++level)
      for (const int g : levels.of(level)) {
        if (level == cut.level) continue;
        part_of_[at(g)] = level < cut.level ? before : behind;
        (level < cut.level ? first : second).push_back(g);
      }
    trim(levels.of(cut.level), before, behind, first, second, separator);
    std::vector<int> children = dissect(first, before, touching(separator, before));
    const std::vector<int> others = dissect(second, behind, touching(separator, behind));
    children.insert(children.end(), others.begin(), others.end());
    return add_node(separator, children);
  }

  // What touches one side only is no part of the separator.
  void trim(std::span<const int> level, int before, int behind, std::vector<int>& first,
            std::vector<int>& second, std::vector<int>& separator) {
    for (const int g : level) {
      bool touches_first = false, touches_second = false;
      for (const int other : graph_.neighbours.of(g)) {
        touches_first |= part_of_[at(other)] == before;
        touches_second |= part_of_[at(other)] == behind;
      }
      if (touches_first && touches_second) {
        separator.push_back(g);
        part_of_[at(g)] = -1;
      } else {
        part_of_[at(g)] = touches_second ? behind : before;
        (touches_second ? second : first).push_back(g);
      }
    }
  }

  std::vector<int> touching(std::span<const int> separator, int part) {
    std::vector<int> list;
    ++stamp_;
    for (const int s : separator)
      for (const int g : graph_.neighbours.of(s)) {
        if (part_of_[at(g)] != part || mark_[at(g)] == stamp_) continue;
        mark_[at(g)] = stamp_;
        list.push_back(g);
      }
    return list;
  }

  IndexLists best_levels(IndexLists levels, int part, std::span<const int> near) {
    // From an end of the pseudo-diameter to its other end, and back from all that is farthest.
    const int end = far_end(levels);
    levels = search({&end, 1}, part);
    const auto last = levels.of(levels.count() - 1);
    IndexLists best = search(std::vector<int>(last.begin(), last.end()), part);
    if (best_cut(levels).cost < best_cut(best).cost) best = std::move(levels);
    if (!near.empty()) {
      IndexLists other = search(near, part);
      if (best_cut(other).cost < best_cut(best).cost) best = std::move(other);
    }
    return best;
  }

  int far_end(const IndexLists& levels) const {
    return *std::ranges::min_element(levels.of(levels.count() - 1), {},
                                     [&](int g) { return graph_.neighbours.of(g).size(); });
  }

  // Levels of the breadth-first search within one part.
  IndexLists search(std::span<const int> roots, int part) {
    IndexLists levels;
    ++stamp_;
    for (const int root : roots) {
      mark_[at(root)] = stamp_;
      levels.item.push_back(root);
    }
    std::size_t head = 0;
    while (head < levels.item.size()) {
      const std::size_t end = levels.item.size();
      levels.start.push_back(static_cast<int>(end));
      for (; head < end; ++head)
        for (const int other : graph_.neighbours.of(levels.item[head])) {
          if (part_of_[at(other)] != part || mark_[at(other)] == stamp_) continue;
          mark_[at(other)] = stamp_;
          levels.item.push_back(other);
        }
    }
    return levels;
  }

  int add_node(std::span<const int> groups, std::span<const int> children) {
    const int node = static_cast<int>(tree_.parent.size());
    tree_.parent.push_back(-1);
    for (const int child : children) tree_.parent[at(child)] = node;
    auto& list = tree_.groups;
    list.item.insert(list.item.end(), groups.begin(), groups.end());
    std::sort(list.item.end() - static_cast<std::ptrdiff_t>(groups.size()), list.item.end());
    list.start.push_back(static_cast<int>(list.item.size()));
    return node;
  }

  const EquationGraph& graph_;
  int leaf_equations_;
  SeparatorTree tree_;
  std::vector<int> part_of_, mark_;
  int parts_ = 0, stamp_ = 0;
};

}  // namespace

SeparatorTree nested_dissection(const EquationGraph& graph, int leaf_equations, int border) {
  return Dissection(graph, leaf_equations).run(border);
}

}  // namespace sage
