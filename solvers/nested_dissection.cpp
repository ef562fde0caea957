#include "solvers/nested_dissection.hpp"

#include <algorithm>
#include <future>
#include <limits>
#include <span>
#include <system_error>
#include <utility>

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Groups of a piece by their distance from where a search began.
struct Levels {
  std::vector<int> start{0};
  std::vector<int> room;  // the groups, and behind them what is not in use
  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> all() const { return {room.data(), at(start.back())}; }
  std::span<const int> of(int level) const {
    return all().subspan(at(start[at(level)]), at(start[at(level) + 1] - start[at(level)]));
  }
};

// The level that separates best: few groups for the product of the two sides.  Lopsided cuts, below a fifth,
// serve only where there is no other.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int level = -1;
};

Cut best_cut(const Levels& levels) {
  Cut best;
  const double all = static_cast<double>(levels.all().size());
  for (int level = 1; level + 1 < levels.count(); ++level) {
    const double size = static_cast<double>(levels.of(level).size());
    const double before = levels.start[at(level)], behind = all - before - size;
    const double lopsided = std::min(before, behind) < 0.2 * all ? 1e3 : 1.0;
    const double cost = lopsided * size * all * all / (before * behind);
    if (cost < best.cost) best = {cost, level};
  }
  return best;
}

// Every group bears a mark: kOutside, or a number that rises from search to search.  What is left of the graph
// around a piece is outside, because a separator has been taken out between a piece and any other.
class Dissection {
 public:
  // mark: of every group, 0 at first.  Several may share them that work on parts which a separator divides.
  Dissection(const EquationGraph& graph, int leaf_equations, std::size_t worth_a_thread, std::span<int> mark,
             int stamp = 0)
      : graph_(graph),
        leaf_equations_(leaf_equations),
        worth_a_thread_(worth_a_thread),
        mark_(mark),
        stamp_(stamp) {}

  SeparatorTree run(int border, int threads) {
    const int inner = static_cast<int>(graph_.group_of.size()) - border;
    std::vector<int> all, last;
    all.reserve(at(graph_.members.count()));
    for (int g = 0; g < graph_.members.count(); ++g) {
      const bool stays = graph_.members.of(g).front() >= inner;
      if (stays) mark_[at(g)] = kOutside;
      (stays ? last : all).push_back(g);
    }
    tree_.groups.item.reserve(mark_.size());
    make_room(all.size());
    const std::vector<int> tops = dissect(all, {}, threads);
    if (!last.empty()) add_node(last, tops);
    return std::move(tree_);
  }

 private:
  static constexpr int kOutside = std::numeric_limits<int>::max();

  void make_room(std::size_t groups) {
    levels_.room.resize(groups);
    others_.room.resize(groups);
  }

  // Divides groups that nothing but what is outside separates from others into connected pieces and each of them
  // further.  Returns the tree nodes that have no parent yet.  `near` are groups that touch the separator above.
  std::vector<int> dissect(std::span<const int> groups, std::span<const int> near, int threads) {
    std::vector<int> tops, roots;
    const int before = stamp_;
    for (const int seed : groups) {
      if (mark_[at(seed)] > before) continue;  // already in another piece
      search({&seed, 1}, levels_);
      roots.clear();
      for (const int g : near)
        if (mark_[at(g)] == stamp_) roots.push_back(g);
      tops.push_back(divide(roots, threads));
    }
    return tops;
  }

  // Divides the piece that levels_ holds.
  int divide(std::span<const int> near, int threads) {
    int equations = 0;
    for (const int g : levels_.all()) equations += static_cast<int>(graph_.members.of(g).size());
    if (equations <= leaf_equations_) return add_node(levels_.all(), {});
    const Cut cut = find_best_levels(near);
    if (cut.level < 0) return add_node(levels_.all(), {});  // everything touches everything

    std::vector<int> first, second, separator;
    const int before = ++stamp_, behind = ++stamp_;
    const std::span<const int> level = levels_.of(cut.level), all = levels_.all();
    const std::size_t from = at(levels_.start[at(cut.level)]), to = from + level.size();
    first.reserve(to);
    second.reserve(all.size() - from);
    first.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(from));
    second.assign(all.begin() + static_cast<std::ptrdiff_t>(to), all.end());
    for (const int g : first) mark_[at(g)] = before;
    for (const int g : second) mark_[at(g)] = behind;
    trim(level, before, behind, first, second, separator);
    const Side one{first, touching(separator, before)}, two{second, touching(separator, behind)};
    return add_node(separator, dissect_both(one, two, threads));
  }

  struct Side {
    std::span<const int> groups;
    std::vector<int> near;
  };

  // The sides of a separator know nothing of each other: with two threads another one works on the second.  The
  // tree is the same.
  std::vector<int> dissect_both(const Side& first, const Side& second, int threads) {
    std::future<Dissection> other;
    const int with_other = threads / 2;
    if (threads > 1 && second.groups.size() >= worth_a_thread_) {
      try {
        other = std::async(std::launch::async, [this, &second, with_other, stamp = stamp_] {
          Dissection part(graph_, leaf_equations_, worth_a_thread_, mark_, stamp);
          part.make_room(second.groups.size());
          part.tops_ = part.dissect(second.groups, second.near, with_other);
          return part;
        });
      } catch (const std::system_error&) {
        // The system gives no more threads.
      }
    }
    const bool shared = other.valid();
    std::vector<int> tops = dissect(first.groups, first.near, shared ? threads - with_other : threads);
    const std::vector<int> others = shared ? append(other.get()) : dissect(second.groups, second.near, threads);
    tops.insert(tops.end(), others.begin(), others.end());
    return tops;
  }

  // Puts the tree of a part behind what there is; the part's nodes without a parent.
  std::vector<int> append(Dissection part) {
    const int nodes = static_cast<int>(tree_.parent.size());
    const int groups = static_cast<int>(tree_.groups.item.size());
    for (const int parent : part.tree_.parent) tree_.parent.push_back(parent < 0 ? -1 : nodes + parent);
    const IndexLists& list = part.tree_.groups;
    tree_.groups.item.insert(tree_.groups.item.end(), list.item.begin(), list.item.end());
    for (std::size_t i = 1; i < list.start.size(); ++i) tree_.groups.start.push_back(groups + list.start[i]);
    for (int& top : part.tops_) top += nodes;
    // The next search must not find the part's marks under its own number.
    stamp_ = std::max(stamp_, part.stamp_);
    return std::move(part.tops_);
  }

  // What touches one side only is no part of the separator.
  void trim(std::span<const int> level, int before, int behind, std::vector<int>& first,
            std::vector<int>& second, std::vector<int>& separator) {
    for (const int g : level) {
      bool touches_first = false, touches_second = false;
      for (const int other : graph_.neighbours.of(g)) {
        touches_first |= mark_[at(other)] == before;
        touches_second |= mark_[at(other)] == behind;
      }
      if (touches_first && touches_second) {
        separator.push_back(g);
        mark_[at(g)] = kOutside;
      } else {
        mark_[at(g)] = touches_second ? behind : before;
        (touches_second ? second : first).push_back(g);
      }
    }
  }

  // Groups with that mark that touch the separator; they lose it.
  std::vector<int> touching(std::span<const int> separator, int mark) {
    std::vector<int> list;
    for (const int s : separator)
      for (const int g : graph_.neighbours.of(s)) {
        if (mark_[at(g)] != mark) continue;
        mark_[at(g)] = 0;
        list.push_back(g);
      }
    return list;
  }

  // Searches the piece in levels_ from all sides; the levels that hold the best cut stay there.
  Cut find_best_levels(std::span<const int> near) {
    // From an end of the pseudo-diameter to its other end, and back from all that is farthest.
    const int end = far_end(levels_);
    search({&end, 1}, levels_);
    search(levels_.of(levels_.count() - 1), others_);
    Cut best = best_cut(others_);
    if (const Cut cut = best_cut(levels_); cut.cost < best.cost)
      best = cut;
    else
      std::swap(levels_, others_);
    if (near.empty()) return best;
    search(near, others_);
    if (const Cut cut = best_cut(others_); cut.cost < best.cost) {
      best = cut;
      std::swap(levels_, others_);
    }
    return best;
  }

  int far_end(const Levels& levels) const {
    return *std::ranges::min_element(levels.of(levels.count() - 1), {},
                                     [&](int g) { return graph_.neighbours.of(g).size(); });
  }

  // Levels of the breadth-first search from some groups of a piece; its groups are marked by stamp_.
  void search(std::span<const int> roots, Levels& levels) {
    const int stamp = ++stamp_;
    levels.start.assign(1, 0);
    int* const found = levels.room.data();
    std::size_t count = 0;
    for (const int root : roots) {
      found[count++] = root;
      mark_[at(root)] = stamp;
    }
    std::size_t head = 0;
    while (head < count) {
      const std::size_t end = count;
      levels.start.push_back(static_cast<int>(end));
      for (; head < end; ++head)
        for (const int other : graph_.neighbours.of(found[head])) {
          if (mark_[at(other)] >= stamp) continue;
          mark_[at(other)] = stamp;
          found[count++] = other;
        }
    }
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
  std::size_t worth_a_thread_;
  SeparatorTree tree_;
  std::vector<int> tops_;  // nodes of a part that have no parent
  std::span<int> mark_;
  Levels levels_, others_;  // of the piece in hand
  int stamp_;
};

}  // namespace

SeparatorTree nested_dissection(const EquationGraph& graph, int leaf_equations, int border, int threads,
                                std::size_t worth_a_thread) {
  std::vector<int> mark(at(graph.members.count()), 0);
  return Dissection(graph, leaf_equations, worth_a_thread, mark).run(border, threads);
}

}  // namespace sage
