#include "solvers/front_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "solvers/profile_numbering.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int whole_tiles(int n) {
  return (n + kTile - 1) / kTile;
}

// Within each front: what is inside its subtree has been eliminated by then, as delay_pressures() wants it.
void put_pressures_last(const EquationGraph& graph, const SeparatorTree& tree, std::vector<int>& order) {
  auto begin = order.begin();
  for (int f = 0; f < tree.groups.count(); ++f) {
    auto end = begin;
    for (const int group : tree.groups.of(f))
      end += static_cast<std::ptrdiff_t>(graph.members.of(group).size());
    std::stable_partition(begin, end, [&](int equation) { return graph.pressure[at(equation)] == 0; });
    begin = end;
  }
}

void number_equations(const EquationGraph& graph, const SeparatorTree& tree, FrontTree& fronts) {
  fronts.order = expand(graph, tree.groups.item);
  if (!graph.pressure.empty()) put_pressures_last(graph, tree, fronts.order);
  fronts.position.resize(fronts.order.size());
  for (std::size_t p = 0; p < fronts.order.size(); ++p)
    fronts.position[at(fronts.order[p])] = static_cast<int>(p);
}

void list_children(const std::vector<int>& parent, IndexLists& children) {
  children.start.assign(parent.size() + 1, 0);
  for (const int p : parent)
    if (p >= 0) ++children.start[at(p) + 1];
  for (std::size_t f = 1; f < children.start.size(); ++f) children.start[f] += children.start[f - 1];
  children.item.resize(at(children.start.back()));
  std::vector<int> end(children.start.begin(), children.start.end() - 1);
  for (std::size_t f = 0; f < parent.size(); ++f)
    if (parent[f] >= 0) children.item[at(end[at(parent[f])]++)] = static_cast<int>(f);
}

// Border of a front: what its pivots and its children's borders touch beyond its own pivots.  Groups are listed
// by their rank in the elimination.
IndexLists border_groups(const EquationGraph& graph, const SeparatorTree& tree, const IndexLists& children,
                         std::span<const int> rank) {
  IndexLists borders;
  std::vector<int> seen(rank.size(), -1);
  for (int f = 0; f < tree.groups.count(); ++f) {
    const int last = tree.groups.start[at(f) + 1] - 1;
    const auto begin = static_cast<std::ptrdiff_t>(borders.item.size());
    const auto take = [&](int r) {
      if (r <= last || seen[at(r)] == f) return;
      seen[at(r)] = f;
      borders.item.push_back(r);
    };
    for (const int group : tree.groups.of(f))
      for (const int other : graph.neighbours.of(group)) take(rank[at(other)]);
    for (const int child : children.of(f))
      for (int k = borders.start[at(child)]; k < borders.start[at(child) + 1]; ++k) take(borders.item[at(k)]);
    std::sort(borders.item.begin() + begin, borders.item.end());
    borders.start.push_back(static_cast<int>(borders.item.size()));
  }
  return borders;
}

void lay_out_fronts(const EquationGraph& graph, const SeparatorTree& tree, bool symmetric, int width,
                    FrontTree& fronts) {
  std::vector<int> rank(at(graph.members.count()));
  for (std::size_t r = 0; r < rank.size(); ++r) rank[at(tree.groups.item[r])] = static_cast<int>(r);
  const IndexLists borders = border_groups(graph, tree, fronts.children, rank);
  std::size_t border = 0;  // equations of all borders
  for (const int r : borders.item) border += graph.members.of(tree.groups.item[at(r)]).size();
  fronts.border.reserve(border);
  fronts.fronts.reserve(at(tree.groups.count()));
  int first = 0;
  for (int f = 0; f < tree.groups.count(); ++f) {
    Front front;
    front.parent = tree.parent[at(f)];
    front.first = first;
    for (const int group : tree.groups.of(f)) front.pivots += static_cast<int>(graph.members.of(group).size());
    first += front.pivots;
    front.border_begin = static_cast<int>(fronts.border.size());
    for (const int r : borders.of(f))
      for (const int equation : graph.members.of(tree.groups.item[at(r)]))
        fronts.border.push_back(fronts.position[at(equation)]);
    if (!graph.pressure.empty()) std::sort(fronts.border.begin() + front.border_begin, fronts.border.end());
    front.border = static_cast<int>(fronts.border.size()) - front.border_begin;
    front.pivot_tiles = whole_tiles(front.pivots);
    front.border_tiles = whole_tiles(front.border);
    front.symmetric = symmetric;
    front.width = width;
    if (2 * front.arm_terms() > std::numeric_limits<int>::max())
      throw std::length_error("a front of the matrix has more than 2^31 terms");
    fronts.factor_terms += (symmetric ? 1 : 2) * front.arm_terms();
    fronts.fronts.push_back(front);
  }
}

// Multiplications and additions of a front's elimination, about.
double work_of(const Front& front) {
  const double p = front.pivots, b = front.border;
  return p * (p * p / 3.0 + p * b + b * b);
}

double work_of(const FrontTree& tree, std::size_t f) {
  return static_cast<int>(f) == tree.kept ? 0.0 : work_of(tree.fronts[f]);
}

// Cuts the tree below fronts of much work: small subtrees are balanced by taking them one after the other.
void divide_work(FrontTree& tree) {
  constexpr double kParts = 8.0, kLeastWork = 2e7;
  const std::size_t count = tree.fronts.size();
  std::vector<double> below(count, 0.0);  // work of the whole subtree
  std::vector<int> begin(count);          // its first front
  double all = 0.0;
  for (std::size_t f = 0; f < count; ++f) begin[f] = static_cast<int>(f);
  for (std::size_t f = 0; f < count; ++f) {
    below[f] += work_of(tree, f);
    all += work_of(tree, f);
    const int parent = tree.fronts[f].parent;
    if (parent < 0) continue;
    below[at(parent)] += below[f];
    begin[at(parent)] = std::min(begin[at(parent)], begin[f]);
  }
  const double largest = std::max(all / kParts, kLeastWork);
  std::vector<char> is_top(count, 0);
  for (std::size_t f = count; f-- > 0;) {
    const int parent = tree.fronts[f].parent;
    if (parent >= 0 && !is_top[at(parent)]) continue;  // within a subtree
    is_top[f] = below[f] > largest;
    if (is_top[f])
      tree.top.push_back(static_cast<int>(f));
    else
      tree.subtrees.push_back({begin[f], static_cast<int>(f) + 1});
  }
  std::ranges::reverse(tree.top);
  std::ranges::reverse(tree.subtrees);
}

// Border matrices live from their front to its parent, first in, last out.  Two stacks, for fronts at even and
// odd depth, let a front build its own while those of its children are still there.  The root of a subtree
// leaves its border where the fronts above find it.
void place_borders(const Subtree& subtree, FrontTree& tree) {
  const auto begin = at(subtree.begin), root = at(subtree.end - 1);
  std::vector<int> depth(root + 1 - begin, 0);
  for (std::size_t f = root; f-- > begin;) depth[f - begin] = depth[at(tree.fronts[f].parent) - begin] + 1;
  std::array<std::int64_t, 2> top{}, highest{};
  for (std::size_t f = begin; f < root; ++f) {
    const auto own = at(depth[f - begin] % 2), below = 1 - own;
    tree.fronts[f].border_at = top[own];
    top[own] += tree.fronts[f].border_terms();
    highest[own] = std::max(highest[own], top[own]);
    for (const int child : tree.children.of(static_cast<int>(f)))
      top[below] -= tree.fronts[at(child)].border_terms();
  }
  for (std::size_t f = begin; f < root; ++f)
    if (depth[f - begin] % 2 == 1) tree.fronts[f].border_at += highest[0];
  tree.subtree_terms = std::max(tree.subtree_terms, highest[0] + highest[1]);
}

// Places of the borders that outlive their subtree: the first gap that is large enough.
class SharedPlaces {
 public:
  std::int64_t take(std::int64_t terms) {
    std::int64_t place = 0;
    auto next = used_.begin();
    for (; next != used_.end() && next->begin < place + terms; ++next) place = next->end;
    used_.insert(next, {place, place + terms});
    highest_ = std::max(highest_, place + terms);
    return place;
  }
  void release(std::int64_t place) { used_.erase(std::ranges::find(used_, place, &Used::begin)); }
  std::int64_t highest() const { return highest_; }

 private:
  struct Used {
    std::int64_t begin, end;
  };
  std::vector<Used> used_;  // ascending
  std::int64_t highest_ = 0;
};

void place_borders(FrontTree& tree) {
  SharedPlaces places;
  const auto share = [&](int f) {
    Front& front = tree.fronts[at(f)];
    front.shared = true;
    if (front.border_terms() > 0) front.border_at = places.take(front.border_terms());
  };
  for (const Subtree& subtree : tree.subtrees) {
    place_borders(subtree, tree);
    share(subtree.end - 1);
  }
  for (const int f : tree.top) {
    share(f);
    for (const int child : tree.children.of(f))
      if (tree.fronts[at(child)].border_terms() > 0) places.release(tree.fronts[at(child)].border_at);
  }
  tree.shared_terms = places.highest();
}

// local[position] for all equations of a front.
void set_local(const FrontTree& tree, const Front& front, std::vector<int>& local) {
  for (int k = 0; k < front.pivots; ++k) local[at(front.first + k)] = k;
  for (int k = 0; k < front.border; ++k)
    local[at(tree.border[at(front.border_begin + k)])] = front.pivot_tiles * kTile + k;
}

void place_borders_in_parents(FrontTree& tree) {
  tree.in_parent.resize(tree.border.size());
  std::vector<int> local(tree.order.size());
  for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
    set_local(tree, tree.fronts[f], local);
    for (const int child : tree.children.of(static_cast<int>(f))) {
      const Front& c = tree.fronts[at(child)];
      for (int k = c.border_begin; k < c.border_begin + c.border; ++k)
        tree.in_parent[at(k)] = local[at(tree.border[at(k)])];
    }
  }
}

// Room for all entries.  Ranges are empty still.
void make_lists(const std::vector<int>& entries, FrontTree& tree) {
  tree.entries.assign(tree.subtrees.size() + 1, {});
  tree.entries_of.assign(entries.size(), {static_cast<int>(tree.subtrees.size()), 0, 0});
  for (std::size_t s = 0; s < tree.subtrees.size(); ++s)
    for (int f = tree.subtrees[s].begin; f < tree.subtrees[s].end; ++f)
      tree.entries_of[at(f)].list = static_cast<int>(s);
  std::vector<int> size(tree.entries.size(), 0);
  for (std::size_t f = 0; f < entries.size(); ++f) {
    EntryRange& range = tree.entries_of[f];
    range.begin = range.end = size[at(range.list)];
    size[at(range.list)] += entries[f];
  }
  for (std::size_t list = 0; list < size.size(); ++list) {
    tree.entries[list].source.resize(at(size[list]));
    tree.entries[list].target.resize(at(size[list]));
  }
}

// Lists the matrix's entries by the fronts that take them.  In the place of an entry's target stands its column.
void sort_entries(const AssembledMatrix& matrix, FrontTree& tree) {
  std::vector<int> front_of(tree.order.size());  // of each equation
  for (std::size_t f = 0; f < tree.fronts.size(); ++f)
    for (int k = 0; k < tree.fronts[f].pivots; ++k)
      front_of[at(tree.order[at(tree.fronts[f].first + k)])] = static_cast<int>(f);
  const auto visit = [&](auto&& use) {
    for (int column = 0; column < matrix.equations(); ++column) {
      const int own = front_of[at(column)];  // fronts stand in the order of elimination
      for (int k = matrix.column_start()[at(column)]; k < matrix.column_start()[at(column) + 1]; ++k)
        use(std::min(own, front_of[at(matrix.row()[at(k)])]), k, column);
    }
  };
  std::vector<int> entries(tree.fronts.size(), 0);
  visit([&](int f, int, int) { ++entries[at(f)]; });
  make_lists(entries, tree);
  visit([&](int f, int k, int column) {
    EntryRange& range = tree.entries_of[at(f)];
    Entries& list = tree.entries[at(range.list)];
    const auto slot = at(range.end++);
    list.source[slot] = k;
    list.target[slot] = column;
  });
}

}  // namespace

void list_entries(const AssembledMatrix& matrix, FrontTree& tree) {
  sort_entries(matrix, tree);
  std::vector<int> local(tree.order.size());
  for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
    const Front& front = tree.fronts[f];
    set_local(tree, front, local);
    const EntryRange& range = tree.entries_of[f];
    Entries& list = tree.entries[at(range.list)];
    for (auto s = at(range.begin); s < at(range.end); ++s) {
      const int row = matrix.row()[at(list.source[s])], column = list.target[s];
      int i = local[at(tree.position[at(row)])], j = local[at(tree.position[at(column)])];
      if (matrix.symmetric() && i > j) std::swap(i, j);
      list.target[s] = static_cast<int>(arm_target(front, i, j));
    }
  }
}

double elimination_operations(const Front& front, bool symmetric_matrix) {
  double count = 0.0;
  for (int left = front.border + front.pivots - 1; left >= front.border; --left)
    count += symmetric_matrix ? left * (left + 3.0) : left * (2.0 * left + 1.0);
  return count;
}

std::int64_t arm_target(const Front& front, int i, int j) {
  const int I = i / kTile, J = j / kTile;
  const bool upper = I <= J;
  const int column = upper ? J : I, k = upper ? i : j, v = (upper ? j : i) % kTile;
  return (upper ? 0 : front.arm_terms()) + front.panel(column) + k * kTile + v;
}

FrontTree make_front_tree(const EquationGraph& graph, const AssembledMatrix& matrix, int leaf_equations,
                          int width, int border, int threads) {
  FrontTree fronts;
  const SeparatorTree tree = nested_dissection(graph, leaf_equations, border, threads);
  if (border > 0) fronts.kept = tree.groups.count() - 1;
  number_equations(graph, tree, fronts);
  list_children(tree.parent, fronts.children);
  lay_out_fronts(graph, tree, matrix.symmetric(), width, fronts);
  divide_work(fronts);
  place_borders(fronts);
  place_borders_in_parents(fronts);
  return fronts;
}

}  // namespace sage
