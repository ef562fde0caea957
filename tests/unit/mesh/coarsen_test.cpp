// The coarsest mesh that means the same: refined again it is the deck's mesh, with everything that hangs on it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "sage/app/commands.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

Model build(const std::string& text, const BuildOptions& options = {}) {
  static const Catalogue catalogue = app::full_catalogue();
  return build_model(read_deck_text(text, "test.dat", load_layout("sage1")), catalogue, options);
}

BuildOptions coarse(int refine = 0) {
  BuildOptions options;
  options.coarsen = true;
  options.refine = refine;
  return options;
}

int elements(const Model& model) {
  int count = 0;
  for (const Group& group : model.groups) count += group.elements();
  return count;
}

using Point = std::pair<long, long>;  // in millionths

Point at(const Model& model, int node) {
  return {std::lround(1e6 * model.mesh.x(0, node)), std::lround(1e6 * model.mesh.x(1, node))};
}

// What a list of fixities holds, by place.
std::map<Point, std::array<double, 4>> held(const Model& model, const std::vector<Fixity>& fixities) {
  std::map<Point, std::array<double, 4>> all;
  for (const Fixity& f : fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] != FixityCode::unchanged) {
        auto& entry = all[at(model, f.node)];
        entry[c] = static_cast<double>(f.code[c]);
        entry[2 + c] = std::round(1e9 * f.value[c]);
      }
  return all;
}

// Pressures and shears by the places of the ends of their edges, in the order of the element.
std::map<std::pair<Point, Point>, std::array<long, 4>> loads(const Model& model, const Stage& stage) {
  std::map<std::pair<Point, Point>, std::array<long, 4>> all;
  for (const EdgeLoad& p : stage.pressures) {
    const Group& group = model.groups[p.group];
    const auto& edge = group.element->edges()[p.edge];
    const int* nodes = group.nodes_of(p.element);
    auto& entry = all[{at(model, nodes[edge[0]]), at(model, nodes[edge[1]])}];
    for (int i = 0; i < 2; ++i) {
      entry[i] += std::lround(1e6 * p.normal[i]);
      entry[2 + i] += std::lround(1e6 * p.shear[i]);
    }
  }
  return all;
}

// Corners of all elements with their group's number.
std::multiset<std::pair<int, std::set<Point>>> cells(const Model& model) {
  std::multiset<std::pair<int, std::set<Point>>> all;
  for (const Group& group : model.groups)
    for (int e = 0; e < group.elements(); ++e) {
      std::set<Point> corners;
      for (int k = 0; k < 4; ++k) corners.insert(at(model, group.nodes_of(e)[k]));
      all.insert({group.number, corners});
    }
  return all;
}

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(cells(a), cells(b));
  EXPECT_EQ(held(a, a.fixities), held(b, b.fixities));
  ASSERT_EQ(a.stages.size(), b.stages.size());
  for (std::size_t s = 0; s < a.stages.size(); ++s) {
    EXPECT_EQ(held(a, a.stages[s].fixities), held(b, b.stages[s].fixities)) << "stage " << s + 1;
    EXPECT_EQ(loads(a, a.stages[s]), loads(b, b.stages[s])) << "stage " << s + 1;
    ASSERT_EQ(a.stages[s].loads.size(), b.stages[s].loads.size());
    for (std::size_t i = 0; i < a.stages[s].loads.size(); ++i)
      EXPECT_EQ(at(a, a.stages[s].loads[i].node), at(b, b.stages[s].loads[i].node));
  }
  ASSERT_EQ(a.reports.size(), b.reports.size());
  for (std::size_t r = 0; r < a.reports.size(); ++r) {
    std::set<Point> of_a, of_b;
    for (int node : a.reports[r].nodes) of_a.insert(at(a, node));
    for (int node : b.reports[r].nodes) of_b.insert(at(b, node));
    EXPECT_EQ(of_a, of_b) << "report " << r + 1;
  }
}

constexpr int kCells = 8;

// 8 x 8 elements on [0, 4] x [0, 4], two layers of soil, rollers at both sides, a fixed base, a pressure and a
// shear that fall off linearly on the left half of the top; the forces of the base are reported.
struct Scene {
  Block block{kCells, kCells, Cell::quad4, 1, 1, rectangle(0.0, 4.0, 0.0, 4.0)};
  DeckWriter deck{1};
  explicit Scene(Cell cell = Cell::quad4) {
    block.cell = cell;
    block.write_nodes(deck);
    deck.material(1, 1, {1000.0, 0.3});
    deck.material(2, 1, {3000.0, 0.2});
    deck.group(1, static_cast<int>(cell), 0, 1);
    deck.group(2, static_cast<int>(cell), 0, 2);
    DeckWriter both(1);
    block.write_elements(both, 1);
    for (std::size_t e = 0; e < both.elements.size(); ++e) {
      std::string card = both.elements[e];
      if (e >= both.elements.size() / 2) card[9] = '2';  // columns 6 to 10 hold the group
      deck.elements.push_back(card);
    }
    for (int node : block.bottom()) deck.fix(node, 1, 1);
    for (int node : block.left()) deck.fix(node, 1, 0);
    for (int node : block.right()) deck.fix(node, 1, 0);
    deck.stage();
    for (int i = 0; i < kCells / 2; ++i)
      deck.stages[0].pressure(block.element(i, kCells - 1), 3, 10.0 - i - 1, 10.0 - i, 4.0 - i - 1, 4.0 - i);
    report(block.bottom());
  }
  void report(const std::vector<int>& row) {
    const int step = row.size() > 1 ? row[1] - row[0] : 1;
    char card[80];
    std::snprintf(card, sizeof card, "    2    0%5d%5d%5d    1", row.front(), row.back(), step);
    deck.reports.emplace_back(card);
  }
};

TEST(Coarsen, RefinedAgainItIsTheDecksMesh) {
  const Scene scene;
  const Model deck = build(scene.deck.text()), least = build(scene.deck.text(), coarse());
  EXPECT_EQ(elements(least), 4) << "two layers, loaded and free half";
  EXPECT_EQ(least.mesh.nodes(), 9) << "no node is left without an element";
  EXPECT_EQ(least.mesh.deck_nodes, 9);
  expect_same(build(scene.deck.text(), coarse(2)), deck);
}

TEST(Coarsen, EightNodeElementsLoseTheirMiddlesAndGetThemBack) {
  const Scene scene(Cell::quad8);
  EXPECT_EQ(elements(build(scene.deck.text(), coarse())), 4);
  expect_same(build(scene.deck.text(), coarse(2)), build(scene.deck.text()));
}

// Things that hang on nodes keep the lines through them.
TEST(Coarsen, WhatHangsOnNodesStays) {
  const auto expect = [](const Scene& scene, int count, const char* what) {
    const Model deck = build(scene.deck.text()), least = build(scene.deck.text(), coarse());
    EXPECT_EQ(elements(least), count) << what;
    // Whatever is left out comes back in the right place: as many nodes of the deck as ever have what they had.
    const auto of = [](const Model& m) { return held(m, m.fixities); };
    for (const auto& [place, what_is_held] : of(least)) EXPECT_EQ(of(deck).at(place), what_is_held) << what;
    for (std::size_t r = 0; r < deck.reports.size(); ++r)
      EXPECT_GE(least.reports[r].nodes.size(), std::min<std::size_t>(2, deck.reports[r].nodes.size())) << what;
  };
  {
    Scene s;
    s.deck.stages[0].load(s.block.node(2, 6), 0.0, -1.0);
    expect(s, 9, "a load inside: the lines x = 1 and y = 3");
  }
  {
    Scene s;
    s.report({s.block.node(6, 8)});
    expect(s, 6, "a reported node of the surface: the line x = 3");
  }
  {
    Scene s;
    s.report(s.block.top());
    expect(s, 16, "the mean displacement of nine nodes is no other number than theirs");
  }
  {
    Scene s;
    s.deck.fixities.clear();
    for (int i = 0; i <= 2; ++i) s.deck.fix(s.block.node(i, 0), 1, 1);
    for (int node : s.block.left()) s.deck.fix(node, 1, 0);
    s.deck.reports.clear();
    s.report({s.block.node(0, 8)});
    expect(s, 6, "supports end at x = 1");
  }
  {
    Scene s;
    s.deck.stages[0].pressures.pop_back();  // loaded from 0 to 1.5
    expect(s, 4, "the load ends at another node");
  }
  {
    Scene s;
    s.deck.stages[0].pressure(s.block.element(1, kCells - 1), 3, 1.0, 1.0);
    expect(s, 8, "a strip of more load from x = .5 to 1");
  }
}

// A mesh one element wide with rollers at both sides would hold its free top as well: two stay.
TEST(Coarsen, AFreeTopBetweenTwoHeldSidesStaysFree) {
  Scene scene;
  scene.deck.stages[0].pressures.clear();
  scene.deck.stages[0].gravity_y = -1.0;
  const Model least = build(scene.deck.text(), coarse());
  EXPECT_EQ(elements(least), 4);
  expect_same(build(scene.deck.text(), coarse(2)), build(scene.deck.text()));
}

// A tilted quadrilateral is one element, a bent outline keeps its corner, a curve all of its nodes.
TEST(Coarsen, TheOutlineStays) {
  const auto count = [](std::function<Vector2(double, double)> place) {
    const Block block{4, 4, Cell::quad4, 1, 1, std::move(place)};
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 1, {1000.0, 0.3});
    deck.group(1, 1, 0, 1);
    block.write_elements(deck, 1);
    for (int node : block.bottom()) deck.fix(node, 1, 1);
    deck.stage().gravity_y = -1.0;
    return elements(build(deck.text(), coarse()));
  };
  EXPECT_EQ(count([](double s, double t) { return Vector2(s + 0.5 * t, t - 0.25 * s * t); }), 1);
  EXPECT_EQ(count([](double s, double t) { return Vector2(s, t * (1.0 + 0.5 * std::max(0.0, s - 0.5))); }), 2);
  EXPECT_EQ(count([](double s, double t) { return Vector2(2 * s, t * (1.0 + 0.5 * s * s)); }), 4);
  EXPECT_EQ(count([](double s, double t) { return Vector2(s, 20.0 * t); }), 4)
      << "not longer than four times its width";
}

TEST(Coarsen, OtherMeshesStayAsTheyAre) {
  DeckWriter triangles(1);
  const Block block{4, 4, Cell::tri3, 1, 1, rectangle(0.0, 1.0, 0.0, 1.0)};
  block.write_nodes(triangles);
  triangles.material(1, 1, {1000.0, 0.3});
  triangles.group(1, 3, 0, 1);
  block.write_elements(triangles, 1);
  for (int node : block.bottom()) triangles.fix(node, 1, 1);
  triangles.stage().gravity_y = -1.0;
  const Model same = build(triangles.text(), coarse());
  EXPECT_EQ(elements(same), 32);
  EXPECT_EQ(same.mesh.nodes(), 25);
}

// One element of 1 x 3 with rough ends, whose corner above is singular: the part there is cut to 1 x 1, and layers are as
// long as wide.  From any number of rows the mesh is the same.
TEST(Coarsen, ElementsAtGradedCornersAreAsLongAsWide) {
  for (const int rows : {1, 3, 7}) {
    scenes::DeckWriter deck(1);
    const scenes::Block block{2, rows, scenes::Cell::quad4, 1, 1, scenes::rectangle(0.0, 1.0, 0.0, 3.0)};
    block.write_nodes(deck);
    deck.material(1, 1, {1000.0, 0.3});
    deck.group(1, 1, 2, 1);
    block.write_elements(deck, 1);
    for (int node : block.bottom()) deck.fix(node, 0, 1);
    for (int node : block.left()) deck.fix(node, 1, 0);
    scenes::StageCards& stage = deck.stage();
    for (int node : block.top()) stage.fix(node, 1, 1, 0.0, -0.01);
    BuildOptions options = coarse();
    EXPECT_EQ(elements(build(deck.text(), options)), 1) << "without layers nothing is cut";
    options.gradings = {{0, 1, 0.15}};
    const Model graded = build(deck.text(), options);
    EXPECT_EQ(elements(graded), 2 + 2) << rows << " rows";
    double smallest = 3.0;
    for (int node = 0; node < graded.mesh.nodes(); ++node)
      if (graded.mesh.x(0, node) == 1.0 && graded.mesh.x(1, node) < 3.0)
        smallest = std::min(smallest, 3.0 - graded.mesh.x(1, node));
    EXPECT_NEAR(smallest, 0.15, 0.01) << "the layer is 0.15 times 1, not 3";
    options.refine_graded = 1;
    EXPECT_EQ(elements(build(deck.text(), options)), 16) << "layers too";
  }
}

}  // namespace
}  // namespace sage::test
