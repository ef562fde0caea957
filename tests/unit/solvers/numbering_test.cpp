// Groups, numberings and separators of small meshes whose best answers are known by counting.
#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "sage/conformance/solver_systems.hpp"
#include "solvers/nested_dissection.hpp"
#include "solvers/profile_numbering.hpp"

namespace sage::test {

using namespace conformance;

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

EquationGraph graph_of(const System& system) {
  return make_equation_graph(system.equations, system.elements);
}

// The same mesh with its equations in random order, pairs of a node apart too.
System shuffled(const System& system) {
  std::vector<int> to(at(system.equations));
  std::iota(to.begin(), to.end(), 0);
  std::shuffle(to.begin(), to.end(), std::mt19937(5));
  System other = system;
  for (int& equation : other.elements.equations)
    if (equation >= 0) equation = to[at(equation)];
  return other;
}

bool is_permutation_of_groups(const EquationGraph& graph, std::vector<int> order) {
  std::vector<int> all(at(graph.members.count()));
  std::iota(all.begin(), all.end(), 0);
  std::ranges::sort(order);
  return order == all;
}

// A chain of n bars: equation i meets i - 1 and i + 1.
System chain(int n) {
  System system;
  system.equations = n;
  for (int i = 0; i + 1 < n; ++i) add_spring(system, i, i + 1, 1.0);
  return system;
}

TEST(EquationGraph, TakesTheTwoEquationsOfANodeTogether) {
  const EquationGraph graph = graph_of(q4_mesh({.columns = 3, .rows = 2, .supports = Supports::none}));
  ASSERT_EQ(graph.members.count(), 12);
  for (int g = 0; g < 12; ++g) EXPECT_EQ(graph.members.of(g).size(), 2u);
  // Node 0 is a corner with 3 neighbours, node 5 lies inside with 8.
  EXPECT_EQ(std::vector(graph.neighbours.of(0).begin(), graph.neighbours.of(0).end()), (std::vector{1, 4, 5}));
  EXPECT_EQ(graph.neighbours.of(5).size(), 8u);
}

TEST(EquationGraph, FindsGroupsWhateverTheNumbering) {
  const EquationGraph graph =
      graph_of(shuffled(q4_mesh({.columns = 6, .rows = 4, .supports = Supports::none})));
  EXPECT_EQ(graph.members.count(), 35);
}

TEST(EquationGraph, LeavesOutPrescribedAndKeepsLonelyEquations) {
  System system;
  system.equations = 3;
  add_spring(system, 0, -1, 1.0);
  add_spring(system, 0, 2, 1.0);
  const EquationGraph graph = graph_of(system);
  ASSERT_EQ(graph.members.count(), 3);
  EXPECT_TRUE(graph.neighbours.of(graph.group_of[1]).empty());
  EXPECT_EQ(graph.neighbours.of(graph.group_of[0]).size(), 1u);
}

TEST(ProfileNumbering, NumbersAShuffledChainFromEndToEnd) {
  const EquationGraph graph = graph_of(shuffled(chain(50)));
  for (const Beginning beginning : {Beginning::end, Beginning::side}) {
    const std::vector<int> order = reverse_cuthill_mckee(graph, beginning);
    EXPECT_TRUE(is_permutation_of_groups(graph, order));
    // Columns of height 1, 2, 2, ...: 1 + 49 * 4.
    EXPECT_EQ(profile_cost(graph, order), 197.0);
  }
}

TEST(ProfileNumbering, NumbersAShuffledRectangleLineByLine) {
  const System mesh = q4_mesh({.columns = 14, .rows = 28, .supports = Supports::none});
  const EquationGraph natural = graph_of(mesh), random = graph_of(shuffled(mesh));
  std::vector<int> line_by_line(at(natural.members.count()));
  std::iota(line_by_line.begin(), line_by_line.end(), 0);
  const double best = profile_cost(natural, line_by_line);
  EXPECT_LE(profile_cost(random, best_profile_numbering(random)), 1.001 * best);
  // From a corner the levels are bent: clearly more.
  EXPECT_GT(profile_cost(random, reverse_cuthill_mckee(random, Beginning::end)), 1.2 * best);
}

TEST(ProfileNumbering, KeepsANumberingThatIsBest) {
  const EquationGraph graph = graph_of(q4_mesh({.columns = 6, .rows = 20, .supports = Supports::none}));
  std::vector<int> identity(at(graph.members.count()));
  std::iota(identity.begin(), identity.end(), 0);
  EXPECT_EQ(best_profile_numbering(graph), identity);
}

TEST(ProfileNumbering, NumbersPartsOneByOne) {
  System system = join(chain(10), q4_mesh({.columns = 2, .rows = 2}));
  system.equations += 2;  // two of no element
  const EquationGraph graph = graph_of(system);
  for (const Beginning beginning : {Beginning::end, Beginning::side}) {
    const std::vector<int> order = reverse_cuthill_mckee(graph, beginning);
    EXPECT_TRUE(is_permutation_of_groups(graph, order));
    // The chain fills ten places in a row.
    const auto in_chain = [&](int g) { return graph.members.of(g).front() < 10; };
    const auto first = std::ranges::find_if(order, in_chain);
    EXPECT_TRUE(std::all_of(first, first + 10, in_chain));
  }
  const std::vector<int> equations = expand(graph, best_profile_numbering(graph));
  EXPECT_EQ(std::set(equations.begin(), equations.end()).size(), at(system.equations));
}

class Dissected : public testing::TestWithParam<int> {};

TEST_P(Dissected, PartsTouchOnlyAncestorsAndDescendants) {
  const System mesh = q4_mesh({.columns = 17, .rows = 23, .supports = Supports::none});
  const EquationGraph graph = graph_of(GetParam() == 0 ? mesh : shuffled(mesh));
  const SeparatorTree tree = nested_dissection(graph, 16);
  EXPECT_TRUE(is_permutation_of_groups(graph, tree.groups.item));
  std::vector<int> part(at(graph.members.count()));
  for (int p = 0; p < tree.groups.count(); ++p)
    for (const int g : tree.groups.of(p)) part[at(g)] = p;
  const auto is_ancestor = [&](int high, int low) {
    while (low >= 0 && low < high) low = tree.parent[at(low)];
    return low == high;
  };
  for (int g = 0; g < graph.members.count(); ++g)
    for (const int other : graph.neighbours.of(g))
      EXPECT_TRUE(is_ancestor(std::max(part[at(g)], part[at(other)]), std::min(part[at(g)], part[at(other)])));
  for (int p = 0; p < tree.groups.count(); ++p) EXPECT_TRUE(tree.parent[at(p)] == -1 || tree.parent[at(p)] > p);
}
INSTANTIATE_TEST_SUITE_P(Orders, Dissected, testing::Values(0, 1));

// 21 x 41 nodes: the straight cut across has 21 nodes, and each side about half of the rest.
TEST(NestedDissection, CutsARectangleAcross) {
  const System mesh = shuffled(q4_mesh({.columns = 20, .rows = 40, .supports = Supports::none}));
  const EquationGraph graph = graph_of(mesh);
  const SeparatorTree tree = nested_dissection(graph, 16);
  EXPECT_LE(tree.groups.of(tree.groups.count() - 1).size(), 22u);
}

// Large enough that every side of the first two separators is work for a thread; also where two meshes have
// nothing in common and where the last equations stay.
TEST(NestedDissection, IsTheSameForAnyNumberOfThreads) {
  System system = shuffled(q4_mesh({.columns = 150, .rows = 160, .supports = Supports::none}));
  const int first = system.equations;
  const System other = q4_mesh({.columns = 90, .rows = 100, .supports = Supports::none});
  for (int e = 0; e < other.elements.count(); ++e) {
    for (const int equation : other.elements.of(e)) system.elements.equations.push_back(first + equation);
    system.elements.offset.push_back(static_cast<std::int64_t>(system.elements.equations.size()));
  }
  system.equations += other.equations;
  for (const int border : {0, 40}) {
    const EquationGraph graph = make_equation_graph(system.equations, system.elements, border);
    const SeparatorTree one = nested_dissection(graph, 16, border);
    for (const int threads : {2, 3, 7}) {
      const SeparatorTree several = nested_dissection(graph, 16, border, threads);
      EXPECT_EQ(several.parent, one.parent);
      EXPECT_EQ(several.groups.start, one.groups.start);
      EXPECT_EQ(several.groups.item, one.groups.item);
    }
  }
}

// Nodes of a comb: a back of `height` rows of cells, and teeth of random width and length that stand on it.
System comb(std::mt19937& random) {
  const auto some = [&](unsigned from, unsigned to) { return static_cast<int>(from + random() % (to - from)); };
  constexpr int kRows = 90;
  const int height = some(4, 25), teeth = some(6, 60);
  std::vector<int> columns;  // rows of cells of each
  for (int t = 0; t < teeth; ++t) {
    const bool wide = random() % 12 == 0;
    columns.insert(columns.end(), static_cast<std::size_t>(wide ? some(20, 50) : some(2, 8)),
                   height + some(3, kRows - 30));
    columns.push_back(height);
  }
  System system;
  std::vector<int> number((columns.size() + 1) * (kRows + 1), -1);
  const auto equation = [&](std::size_t column, int row) {
    int& n = number[column * (kRows + 1) + at(row)];
    if (n < 0) n = system.equations++;
    return n;
  };
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (int r = 0; r < columns[c]; ++r) {
      for (const int n : {equation(c, r), equation(c + 1, r), equation(c + 1, r + 1), equation(c, r + 1)})
        system.elements.equations.push_back(n);
      system.elements.offset.push_back(static_cast<std::int64_t>(system.elements.equations.size()));
    }
  return system;
}

// A side that a separator leaves in several pieces, of which one went to another thread before the next was searched.
TEST(NestedDissection, PiecesOfASideShareNoMarks) {
  std::mt19937 random(3);
  for (int c = 0; c < 40; ++c) {
    const EquationGraph graph = graph_of(comb(random));
    const SeparatorTree one = nested_dissection(graph, 16);
    for (const int threads : {4, 8, 16}) {
      const SeparatorTree several = nested_dissection(graph, 16, 0, threads, 40);
      ASSERT_EQ(several.groups.item, one.groups.item) << "comb " << c << ", " << threads << " threads";
      ASSERT_EQ(several.groups.start, one.groups.start);
      ASSERT_EQ(several.parent, one.parent);
    }
  }
}

TEST(NestedDissection, TakesWhatAllTouchEachOtherAsOnePart) {
  System system;
  system.equations = 60;
  std::vector<int> all(60);
  std::iota(all.begin(), all.end(), 0);
  system.add_element(all, Eigen::MatrixXd::Identity(60, 60));
  EXPECT_EQ(nested_dissection(graph_of(system), 16).groups.count(), 1);
}

}  // namespace
}  // namespace sage::test
