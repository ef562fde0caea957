// Elements of high degree from cards with four or eight nodes, uniform refinement and grading: places of new
// nodes, conformity, and what goes along.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "sage/app/commands.hpp"
#include "sage/app/input.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/studies/scenes/lame.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

Model build(const std::string& text, const BuildOptions& options = {}) {
  static const Catalogue catalogue = app::full_catalogue();
  return build_model(read_deck_text(text, "test.dat", load_layout("sage1")), catalogue, options);
}

BuildOptions with(int element, int refine = 0, std::vector<Grading> gradings = {}) {
  BuildOptions options;
  options.element = element;
  options.refine = refine;
  options.gradings = std::move(gradings);
  return options;
}

// A distorted 2 x 2 block on [0, 2] x [0, 1] with the lower side held in y and the left in x, a pressure that
// falls from 3 to 1 along the top.
DeckWriter block_deck(Cell cell = Cell::quad4, int geometry = 1) {
  Block block;
  block.cell = cell;
  block.columns = block.rows = 2;
  block.place = [](double s, double t) {
    return Vector2(2.0 * s + 0.6 * s * (1 - s) * t * (1 - t), t + 0.8 * s * (1 - s) * t * (1 - t));
  };
  DeckWriter deck(geometry);
  block.write_nodes(deck);
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, static_cast<int>(cell), 0, 1);
  block.write_elements(deck, 1);
  for (int node : block.bottom()) deck.fix(node, 0, 1);
  for (int node : block.left()) deck.fix(node, 1, 0);
  const int top = cell == Cell::tri3 || cell == Cell::tri6 ? 1 : 3;
  const int half = cell == Cell::tri3 || cell == Cell::tri6 ? 1 : 0;
  StageCards& stage = deck.stage();
  stage.pressure(block.element(0, 1) + half, top, 2.0, 3.0);
  stage.pressure(block.element(1, 1) + half, top, 1.0, 2.0);
  return deck;
}

// Each edge of a solid is shared by two, or all of its nodes are on the outline of the rectangle.
void expect_conforming(const Model& model, double width, double height) {
  std::map<std::set<int>, int> uses;
  for (const Group& group : model.groups)
    for (int e = 0; group.solid() && e < group.elements(); ++e)
      for (const auto& edge : group.element->edges()) {
        std::set<int> nodes;
        for (int local : edge) nodes.insert(group.nodes_of(e)[local]);
        ++uses[nodes];
      }
  int outside = 0;
  for (const auto& [nodes, count] : uses) {
    ASSERT_LE(count, 2);
    if (count == 2) continue;
    ++outside;
    bool left = true, right = true, bottom = true, top = true;
    for (int node : nodes) {
      const Vector2 x = model.mesh.x.col(node);
      left = left && std::abs(x.x()) < 1e-12;
      right = right && std::abs(x.x() - width) < 1e-12;
      bottom = bottom && std::abs(x.y()) < 1e-12;
      top = top && std::abs(x.y() - height) < 1e-12;
    }
    EXPECT_TRUE(left || right || bottom || top) << "an edge inside has an element on one side only";
  }
  EXPECT_GT(outside, 4);
}

double area(const Model& model) {
  double sum = 0.0;
  Eigen::Matrix2Xd x;
  std::vector<double> geometry;
  for (const Group& group : model.groups) {
    const ElementTraits& t = group.element->traits();
    geometry.resize(t.geometry_size());
    for (int e = 0; group.solid() && e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      group.element->geometry(x, geometry);
      for (int p = 0; p < t.points; ++p) sum += geometry[p * (1 + 4 * t.dofs)];
    }
  }
  return sum;
}

// Force of all pressures, from the loads at the end of a run.
Vector2 total_load(const WholeRun& run) {
  Vector2 sum = Vector2::Zero();
  for (int i = 0; i < run.model->mesh.nodes(); ++i) sum += run.last().external.segment<2>(2 * i);
  return sum;
}

TEST(HighDegree, NodesOfOneSquareAreTheGaussLobattoGrid) {
  const Model model = build(block_deck().text(), with(7));
  EXPECT_EQ(model.mesh.nodes(), 81) << "a 9 x 9 lattice";
  EXPECT_EQ(model.groups[0].element_name, "quad25 full");
  const Group& group = model.groups[0];
  const Vector2 a = model.mesh.x.col(group.nodes_of(0)[0]), b = model.mesh.x.col(group.nodes_of(0)[1]);
  const Vector2 first = model.mesh.x.col(group.nodes_of(0)[4]);
  EXPECT_NEAR((first - a).norm() / (b - a).norm(), 0.5 * (1.0 - std::sqrt(3.0 / 7.0)), 1e-14);
  expect_conforming(model, 2.0, 1.0);
  EXPECT_NEAR(area(model), 2.0, 1e-13);
}

// Fixities reach every node of the sides that were held, and no other.
TEST(HighDegree, SidesInheritTheirFixities) {
  for (const BuildOptions& options : {with(7), with(8, 1), with(9, 0, {{1, 2, 0.2}})}) {
    const Model model = build(block_deck().text(), options);
    std::set<int> held_x, held_y;
    for (const Fixity& f : model.fixities) {
      if (f.code[0] == FixityCode::fixed) held_x.insert(f.node);
      if (f.code[1] == FixityCode::fixed) held_y.insert(f.node);
    }
    for (int i = 0; i < model.mesh.nodes(); ++i) {
      EXPECT_EQ(held_x.count(i), std::abs(model.mesh.x(0, i)) < 1e-12 ? 1u : 0u)
          << model.mesh.x.col(i).transpose();
      EXPECT_EQ(held_y.count(i), std::abs(model.mesh.x(1, i)) < 1e-12 ? 1u : 0u)
          << model.mesh.x.col(i).transpose();
    }
  }
}

// Eight nodes on the card: the sides are parabolas through them, in meshes of every fineness.
TEST(HighDegree, SidesFollowTheParabolaOfTheCard) {
  DeckWriter deck(1);
  const Vector2 x[] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}, {1, -.2}, {2.1, .5}, {1, 1.3}, {0, .5}};
  for (int i = 0; i < 8; ++i) deck.node(i + 1, x[i].x(), x[i].y());
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, 7, 0, 1);
  deck.element(1, 1, {1, 2, 3, 4, 5, 6, 7, 8});
  deck.fix(1, 1, 1);
  deck.fix(2, 1, 1);
  deck.stage();
  for (const BuildOptions& options :
       {BuildOptions{}, with(0, 1), with(0, 0, {{3, 2, 0.15}}), with(0, 2, {{1, 1, 0.3}})}) {
    const Model model = build(deck.text(), options);
    int below = 0;
    for (int i = 0; i < model.mesh.nodes(); ++i) {
      if (model.mesh.x(1, i) > -1e-9) continue;  // below the chord from (0, 0) to (2, 0)
      const double s = model.mesh.x(0, i) - 1.0, parabola = -0.2 * (1.0 - s * s);
      EXPECT_GE(model.mesh.x(1, i), parabola - 1e-13);
      if (std::abs(model.mesh.x(1, i) - parabola) < 1e-13) ++below;
    }
    EXPECT_GE(below, 3);
    // Two thirds of the sagitta times the chord: exact for the parabola.
    EXPECT_NEAR(area(model), 2.0 + 2.0 / 3.0 * (2.0 * 0.2 + 2.0 * 0.3 + 1.0 * 0.1), 1e-12);
  }
}

TEST(HighDegree, NeighboursOfOtherDegreeAreRefused) {
  DeckWriter deck(1);
  for (int i = 0; i < 6; ++i) deck.node(i + 1, i % 3, i / 3);
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, 7, 0, 1);
  deck.group(2, 1, 0, 1);
  deck.element(1, 1, {1, 2, 5, 4});
  deck.element(2, 2, {2, 3, 6, 5});
  deck.fix(1, 1, 1);
  deck.fix(4, 1, 1);
  deck.stage();
  try {
    build(deck.text());
    FAIL() << "no exception";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("elements of different degree don't fit together"),
              std::string::npos)
        << error.what();
  }
}

TEST(Refine, KeepsAreaConformityAndLoads) {
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri3, Cell::tri6}) {
    const std::string text = block_deck(cell).text();
    const WholeRun coarse = run_text(text);
    for (int times = 1; times <= 2; ++times) {
      const WholeRun fine = run_text(text, with(0, times));
      ASSERT_TRUE(fine.completed());
      EXPECT_EQ(fine.model->groups[0].elements(), coarse.model->groups[0].elements() << (2 * times));
      expect_conforming(*fine.model, 2.0, 1.0);
      EXPECT_NEAR(area(*fine.model), 2.0, 1e-12);
      EXPECT_LT((total_load(fine) - total_load(coarse)).norm(), 1e-12 * total_load(coarse).norm());
      EXPECT_NEAR(total_load(fine).y(), -4.0, 1e-12) << "pressure 3 to 1 over a length of 2";
    }
  }
}

TEST(Grade, KeepsAreaConformityAndLoads) {
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri3, Cell::tri6})
    for (const int node : {1, cell == Cell::quad8 || cell == Cell::tri6 ? 13 : 5}) {  // a corner, the middle
      const WholeRun graded = run_text(block_deck(cell).text(), with(0, 0, {{node, 3, 0.2}}));
      ASSERT_TRUE(graded.completed());
      expect_conforming(*graded.model, 2.0, 1.0);
      EXPECT_NEAR(area(*graded.model), 2.0, 1e-12);
      EXPECT_NEAR(total_load(graded).y(), -4.0, 1e-12);
    }
}

// The element at the corner is ratio^layers as long as the one that was there.
TEST(Grade, LayersShrinkByTheRatio) {
  const Model model = build(block_deck().text(), with(0, 0, {{1, 4, 0.15}}));
  double least = 10.0;
  const Group& group = model.groups[0];
  EXPECT_EQ(group.elements(), 4 + 2 * 4);
  for (int e = 0; e < group.elements(); ++e)
    least = std::min(least,
                     (model.mesh.x.col(group.nodes_of(e)[1]) - model.mesh.x.col(group.nodes_of(e)[0])).norm());
  EXPECT_NEAR(least, 1.0 * std::pow(0.15, 4), 1e-15);
}

// A uniform strain prescribed on the outline is reproduced inside, whatever was refined: made boundary nodes
// take what is linear between their ends.
TEST(Refine, PatchTest) {
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri3, Cell::tri6})
    for (const BuildOptions& options : {with(0, 1), with(0, 0, {{1, 3, 0.15}}), with(0, 1, {{3, 2, 0.3}})}) {
      DeckWriter deck = block_deck(cell);
      deck.fixities.clear();
      Block block;
      block.cell = cell;
      block.columns = block.rows = 2;
      deck.stages.front().pressures.clear();
      std::set<int> outline;
      for (const auto& side : {block.left(), block.right(), block.bottom(), block.top()})
        outline.insert(side.begin(), side.end());
      const Model places = build(block_deck(cell).text());
      for (int i = 0; i < places.mesh.deck_nodes; ++i) {
        const int number = places.mesh.number[i];
        const Vector2 x = places.mesh.x.col(i);
        if (outline.count(number))
          deck.stages.front().fix(number, 1, 1, 1e-3 * (x.x() + 0.5 * x.y()), 1e-3 * (x.y() + 0.5 * x.x()));
      }
      const WholeRun run = run_text(deck.text(), options);
      ASSERT_TRUE(run.completed()) << run.failure;
      std::set<int> used;  // grading leaves mid-side nodes of the card behind
      for (const Group& group : run.model->groups) used.insert(group.nodes.begin(), group.nodes.end());
      for (int i : used) {
        const Vector2 x = run.model->mesh.x.col(i);
        const Vector2 exact = 1e-3 * Vector2(x.x() + 0.5 * x.y(), x.y() + 0.5 * x.x());
        EXPECT_LT((run.last().u.segment<2>(2 * i) - exact).norm(), 1e-14) << "node at " << x.transpose();
      }
    }
}

// A column of two blocks on an interface: both sides of it are cut at the same places, and the answer, a
// uniform compression in series with the interface, stays exact.
std::string column_deck() {
  DeckWriter deck(1);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 3; ++i) deck.node(3 * j + i + 1, 0.5 * i, j < 2 ? j : j - 1);
  deck.material(1, 1, {1000.0, 0.0});
  deck.material(2, 21, {500.0, 2000.0});
  deck.group(1, 1, 0, 1);
  deck.group(2, 11, 0, 2);
  for (int i = 0; i < 2; ++i) {
    deck.element(1 + i, 1, {1 + i, 2 + i, 5 + i, 4 + i});
    deck.element(3 + i, 1, {7 + i, 8 + i, 11 + i, 10 + i});
    deck.element(5 + i, 2, {4 + i, 5 + i, 8 + i, 7 + i});
  }
  for (int i = 1; i <= 3; ++i) deck.fix(i, 1, 1);
  StageCards& stage = deck.stage();
  stage.pressure(3, 3, 10.0, 10.0);
  stage.pressure(4, 3, 10.0, 10.0);
  return deck.text();
}

TEST(Refine, InterfacesAreCutOnBothSides) {
  for (const BuildOptions& options :
       {with(0, 1), with(0, 0, {{4, 2, 0.2}}), with(0, 0, {{8, 2, 0.2}}), with(2, 1)}) {
    const WholeRun coarse = run_text(column_deck());
    const WholeRun fine = run_text(column_deck(), options);
    ASSERT_TRUE(fine.completed()) << fine.failure;
    const Group& interface = fine.model->groups[1];
    std::set<std::pair<int, int>> edges;
    for (int e = 0; e < fine.model->groups[0].elements(); ++e)
      for (const auto& edge : fine.model->groups[0].element->edges())
        edges.insert(std::minmax(fine.model->groups[0].nodes_of(e)[edge[0]],
                                 fine.model->groups[0].nodes_of(e)[edge[1]]));
    EXPECT_GT(interface.elements(), 2);
    for (int e = 0; e < interface.elements(); ++e) {
      const int* n = interface.nodes_of(e);
      EXPECT_EQ(edges.count(std::minmax(n[0], n[1])), 1u);
      EXPECT_EQ(edges.count(std::minmax(n[2], n[3])), 1u);
      EXPECT_LT((fine.model->mesh.x.col(n[0]) - fine.model->mesh.x.col(n[3])).norm(), 1e-14);
    }
    // Ends: E / h in series with k_n; nu = 0.
    const double expected = -10.0 * (1.0 / 1000.0 + 1.0 / 2000.0 + 1.0 / 1000.0);
    EXPECT_NEAR(fine.u(10).y(), expected, 1e-12);
    EXPECT_NEAR(coarse.u(10).y(), expected, 1e-12);
  }
}

std::string graded_nodes(const Model& model) {
  std::string text;
  for (const Diagnostic& d : model.diagnostics.list())
    if (const auto at = d.message.find("graded towards node "); at != std::string::npos)
      text += d.message.substr(at + 20, d.message.find(':') - at - 20) + " ";
  return text;
}

// Two materials on the upper and lower half (or left and right) of a 2 x 2 block between rollers and a free
// right side.
TEST(Grade, CornersWhereMaterialsMeet) {
  const std::vector<Grading> automatic{{0, 1, 0.15}};
  const auto nodes = [&](std::array<int, 4> material, double bend, double second, bool right_roller) {
    const Block block{
        2, 2, Cell::quad4,
        1, 1, [=](double s, double t) {
                        return Vector2(2.0 * s, 2.0 * t + bend * s * (1 - s) * t * (1 - t)); }};
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 1, {1000.0, 0.3});
    deck.material(2, 1, {second, 0.3});
    deck.group(1, 1, 2, 1);
    deck.group(2, 1, 2, 2);
    DeckWriter plain(1);
    block.write_elements(plain, 1);
    for (std::size_t e = 0; e < 4; ++e) {
      std::string card = plain.elements[e];
      card[9] = static_cast<char>('0' + material[e]);
      deck.elements.push_back(card);
    }
    for (int node : block.bottom()) deck.fix(node, 0, 1);
    for (int node : block.left()) deck.fix(node, 1, 0);
    if (right_roller)
      for (int node : block.right()) deck.fix(node, 1, 0);
    deck.stage().gravity_y = 0.0;
    deck.stages[0].pressure(3, 3, 1.0, 1.0);
    deck.stages[0].pressure(4, 3, 1.0, 1.0);
    return graded_nodes(build(deck.text(), with(0, 0, automatic)));
  };
  EXPECT_EQ(nodes({1, 1, 2, 2}, 0.0, 9000.0, true), "") << "a layer between lines of symmetry goes on";
  EXPECT_EQ(nodes({1, 1, 2, 2}, 0.0, 9000.0, false), "6 ") << "its end at a free side";
  EXPECT_EQ(nodes({1, 1, 2, 2}, 0.0, 1000.0, false), "") << "two groups of one law are one material";
  EXPECT_EQ(nodes({1, 1, 1, 2}, 0.0, 9000.0, true), "5 8 ") << "the corner of an inclusion and its end above";
  EXPECT_EQ(nodes({1, 2, 2, 1}, 0.0, 9000.0, true), "5 8 ") << "a chequer board";
  EXPECT_EQ(nodes({1, 1, 2, 2}, 0.8, 9000.0, true), "4 5 6 ") << "a bent border meets the sides at an angle";
}

TEST(GradeAuto, FindsWhereSupportsAndLoadsMakeTheSolutionSingular) {
  const std::vector<Grading> automatic{{0, 1, 0.15}};
  // Rollers on two sides at right angles, loads to the corners: nothing singular.
  EXPECT_EQ(graded_nodes(build(block_deck().text(), with(0, 0, automatic))), "");

  // The top held as well: at its free end (9), not where it meets the roller (7).
  DeckWriter rough = block_deck();
  rough.stages.front().pressures.clear();
  for (const int node : {7, 8, 9}) rough.stages.front().fix(node, 1, 1, 0.0, -0.01);
  EXPECT_EQ(graded_nodes(build(rough.text(), with(0, 0, automatic))), "9 ");
  // Bars along it are no sides of the soil.
  rough.material(2, 31, {1e5, 1.0});
  rough.group(2, 31, 0, 2);
  rough.element(20, 2, {7, 8});
  rough.element(21, 2, {8, 9});
  EXPECT_EQ(graded_nodes(build(rough.text(), with(0, 0, automatic))), "9 ");

  // A smooth punch on half the top: where it ends.
  DeckWriter punch = block_deck();
  punch.stages.front().pressures.clear();
  for (const int node : {7, 8}) punch.stages.front().fix(node, 0, 1, 0.0, -0.01);
  EXPECT_EQ(graded_nodes(build(punch.text(), with(0, 0, automatic))), "8 ");

  // A pressure on half the top.
  DeckWriter strip = block_deck();
  strip.stages.front().pressures.pop_back();
  EXPECT_EQ(graded_nodes(build(strip.text(), with(0, 0, automatic))), "8 ");
}

// Cook's panel: below the clamped side's lower end the angle is 47 degrees, stresses are bounded and go as rho^.13.  On a
// slope of 1:2 the crest (153 degrees between free sides) has rho^.5, the toe no bound.
TEST(GradeAuto, FindsCornersWhoseStressIsBoundedButNotSmooth) {
  const std::vector<Grading> automatic{{0, 1, 0.15}};
  CookDeck cook;
  cook.n = 1;
  EXPECT_EQ(graded_nodes(build(cook.deck().text(), with(0, 0, automatic))), "1 2 3 4 ");
  DeckWriter slope(1);
  const double x[] = {0, 10, 14, 0, 10, 14, 0, 6}, y[] = {0, 0, 0, 4, 4, 4, 6, 6};
  for (int i = 0; i < 8; ++i) slope.node(i + 1, x[i], y[i]);
  slope.material(1, 1, {1000.0, 0.3});
  slope.group(1, 1, 0, 1);
  slope.element(1, 1, {1, 2, 5, 4});
  slope.element(2, 1, {2, 3, 6, 5});
  slope.element(3, 1, {4, 5, 8, 7});
  for (const int node : {1, 2, 3}) slope.fix(node, node == 2 ? 0 : 1, 1);
  for (const int node : {4, 6, 7}) slope.fix(node, 1, 0);
  slope.stage().gravity_y = -1.0;
  EXPECT_EQ(graded_nodes(build(slope.text(), with(0, 0, automatic))), "5 8 ");
}

// Sides of 8-node elements are parabolas: where their tangents go on, there is no corner, however the chords meet.
TEST(GradeAuto, SeesNoCornersAlongCurvedSides) {
  const std::vector<Grading> automatic{{0, 1, 0.15}};
  LameDeck ring{LameBody::sector, Cell::quad8, 1, 4};
  EXPECT_EQ(graded_nodes(build(ring.text(), with(0, 0, automatic))), "");
  ring.cell = Cell::quad4;  // the polygon has them
  EXPECT_NE(graded_nodes(build(ring.text(), with(0, 0, automatic))), "");
}

TEST(GradeAuto, FindsReentrantCorners) {
  DeckWriter deck(1);
  for (int i = 0; i < 9; ++i) deck.node(i + 1, i % 3, i / 3);
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, 1, 0, 1);
  deck.element(1, 1, {1, 2, 5, 4});
  deck.element(2, 1, {2, 3, 6, 5});
  deck.element(3, 1, {4, 5, 8, 7});
  for (const int node : {1, 2, 3}) deck.fix(node, 0, 1);
  for (const int node : {1, 4, 7}) deck.fix(node, 1, 0);
  StageCards& stage = deck.stage();
  stage.pressure(3, 3, 1.0, 1.0);
  EXPECT_EQ(graded_nodes(build(deck.text(), with(0, 0, {{0, 1, 0.15}}))), "5 ");
}

// One element, 1 2 3 4 counter-clockwise from (0, 0).
DeckWriter one_cell(double top_right = 1.0) {
  DeckWriter deck(1);
  deck.node(1, 0.0, 0.0);
  deck.node(2, 1.0, 0.0);
  deck.node(3, top_right, 1.0);
  deck.node(4, 0.0, 1.0);
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, 1, 0, 1);
  deck.element(1, 1, {1, 2, 3, 4});
  deck.stage();
  return deck;
}

// n_a . t_b = n_b . t_a of the normals and tractions of two sides, for stress is symmetric.
TEST(GradeAuto, FindsCornersWhoseTractionsNoStressHas) {
  const std::vector<Grading> automatic{{0, 1, 0.15}};
  struct Case {
    const char* what;
    int edge;  // 2 right, 3 top
    double pressure, shear;
    const char* nodes;
  };
  const Case cases[] = {{"a pressure at right angles to a free side", 3, 1.0, 0.0, ""},
                        {"shear beside a free side and a line of symmetry", 2, 0.0, 1.0, "2 3 "},
                        {"the same on top", 3, 0.0, 1.0, "3 4 "}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    DeckWriter deck = one_cell();
    for (const int node : {1, 2}) deck.fix(node, 0, 1);  // base and left side on rollers
    for (const int node : {1, 4}) deck.fix(node, 1, 0);
    deck.stages[0].pressure(1, c.edge, c.pressure, c.pressure, c.shear, c.shear);
    EXPECT_EQ(graded_nodes(build(deck.text(), with(0, 0, automatic))), c.nodes);
  }
  // Shear that is the same on both sides of the free corner is one stress; a pressure
  // on a slanting side is none.
  for (const bool slanting : {false, true}) {
    DeckWriter deck = one_cell(slanting ? 1.4 : 1.0);
    for (const int node : {1, 2}) deck.fix(node, 1, 1);
    StageCards& stage = deck.stages[0];
    if (slanting) {
      stage.pressure(1, 3, 1.0, 1.0);
    } else {
      stage.pressure(1, 2, 0.0, 0.0, 1.0, 1.0);    // up
      stage.pressure(1, 3, 0.0, 0.0, -1.0, -1.0);  // to the right
      stage.pressure(1, 4, 0.0, 0.0, 1.0, 1.0);    // down
    }
    const std::string nodes = graded_nodes(build(deck.text(), with(0, 0, automatic)));
    EXPECT_EQ(nodes.find("3") != std::string::npos, slanting) << nodes;
  }
}

// The clamped corner and both ends of the sheared side: against an independent converged solution.
TEST(GradeAuto, CooksMembraneIsAsGoodAsGradedByHand) {
  CookDeck cook;
  cook.n = 2;
  const Block block = cook.block();
  const int clamped_low = block.left().front(), clamped = block.left().back(), low = block.right().front(),
            high = block.right().back();
  const double reference = 22.61049;
  const auto error = [&](std::vector<Grading> gradings) {
    BuildOptions options;
    options.element = 8;  // degree 6
    options.gradings = std::move(gradings);
    return std::abs(run_text(cook.deck().text(), options).u(high).y() / reference - 1.0);
  };
  constexpr double kRatio = 0.15;
  const int layers = 6;
  const double by_hand = error({{clamped_low, layers, kRatio},
                                {clamped, layers, kRatio},
                                {low, layers, kRatio},
                                {high, layers, kRatio}});
  const double clamped_only = error({{clamped, layers, kRatio}});
  const double automatic = error({{0, layers, kRatio}});
  std::printf("    error of the top corner: by hand %.2e, clamped corner only %.2e, automatic %.2e\n", by_hand,
              clamped_only, automatic);
  EXPECT_NEAR(automatic, by_hand, 1e-9);  // the same mesh, perhaps in another order
  EXPECT_LT(automatic, 1e-4);             // 2 x 2 elements; measured 3.6e-5
  EXPECT_GT(clamped_only, 10.0 * automatic);
}

TEST(GradeOption, SaysWhatItWants) {
  EXPECT_EQ(app::grading_from("auto").node, 0);
  EXPECT_EQ(app::grading_from("435:7").layers, 7);
  EXPECT_EQ(app::grading_from("435:7:0.2").ratio, 0.2);
  for (const char* bad : {"", "x", "0", "-3", "4:0", "4:99", "4:5:0", "4:5:1", "4:5:.2:1", "4:5x", "4:5:nan"})
    EXPECT_THROW(app::grading_from(bad), std::invalid_argument) << bad;
  EXPECT_THROW(build(block_deck().text(), with(0, 0, {{77, 2, 0.2}})), InputError);
}

// Before anything is made: 4 elements 12 times are 67 million, 10 times 4 million.
TEST(RefineOption, LargeMeshesAreAnnouncedOrRefused) {
  struct Stop {};
  const DeckWriter deck = block_deck();
  BuildOptions options = with(0, 12);
  std::string printed;
  options.say = [&](const std::string& text, Code) {
    printed = text;
    throw Stop();
  };
  try {
    build(deck.text(), options);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("--refine 12 would make 67108864 elements"), std::string::npos) << words;
    EXPECT_NE(words.find("--refine 10 makes 4194304"), std::string::npos) << words;
  }
  EXPECT_EQ(printed, "");
  options.refine = 10;
  EXPECT_THROW(build(deck.text(), options), Stop);
  EXPECT_NE(printed.find("4194304 elements with about 4194304 nodes: expect 17 GB"), std::string::npos)
      << printed;
  printed.clear();
  options.refine = 3;
  EXPECT_EQ(build(deck.text(), options).mesh.nodes(), 17 * 17);
  EXPECT_EQ(printed, "");
}

// What is announced against what is made.
TEST(RefineOption, AnnouncedNodesAreThoseThatAreMade) {
  struct Stop {};
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri3, Cell::tri6}) {
    SCOPED_TRACE(static_cast<int>(cell));
    BuildOptions options = with(0, 9);
    double announced = 0.0;
    options.say = [&](const std::string& text, Code) {
      announced = std::stod(text.substr(text.find("about ") + 6));
      throw Stop();
    };
    EXPECT_THROW(build(block_deck(cell).text(), options), Stop);
    options.refine = 4;
    const double made = build(block_deck(cell).text(), options).mesh.nodes() * 1024.0;  // 4^(9-4)
    EXPECT_NEAR(announced, made, 0.07 * made);  // 32 x 32 cells have 33 x 33 nodes
  }
}

TEST(GradeOption, NodeThatIsNoCornerIsRefused) {
  EXPECT_THROW(build(block_deck(Cell::quad8).text(), with(0, 0, {{2, 2, 0.2}})), InputError)
      << "a mid-side node";
}

// A deck whose elements run clockwise is refused for its own four elements, not for their parts.
TEST(Refine, ElementsOfUnusableShapeAreNotCut) {
  Block block;
  block.columns = block.rows = 2;
  block.place = [](double s, double t) { return Vector2(-s, t); };
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, static_cast<int>(Cell::quad4), 0, 1);
  block.write_elements(deck, 1);
  for (int node : block.bottom()) deck.fix(node, 1, 1);
  deck.stage();
  for (const BuildOptions& options : {with(0, 2), with(0, 0, {Grading{0, 3}})}) {
    try {
      build(deck.text(), options);
      FAIL() << "clockwise elements are refused";
    } catch (const InputError& error) {
      int refused = 0;
      for (const Diagnostic& d : error.diagnostics().list()) {
        EXPECT_NE(d.code, Code("S406")) << d.message;  // graded towards a node
        if (d.code != Code("S226")) continue;
        EXPECT_EQ(d.message.find("more of this card"), std::string::npos) << d.message;
        ++refused;
      }
      EXPECT_EQ(refused, 4) << error.what();
    }
  }
}

}  // namespace
}  // namespace sage::test
