// Mid-side nodes that the deck's own cards give keep what the deck says of them, in every solid of the
// catalogue that has any, whatever is refined, graded or replaced by elements of high degree; nodes that are
// made beside them follow.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "sage/app/commands.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

constexpr double kE = 1000.0, kNu = 0.2;  // nu/(1 - nu) = 1/4: displacements that ten columns hold

const Catalogue& full_catalogue() {
  static const Catalogue catalogue = app::full_catalogue();
  return catalogue;
}

struct Solid {
  int code = 0, formulation = 0;
  const ElementEntry* entry = nullptr;
  std::string name;
};

std::vector<Solid> solids_with_mid_side_nodes() {
  std::vector<Solid> solids;
  for (const auto& [code, entry] : full_catalogue().elements.entries())
    if (entry.solid() && !entry.only_corners() && entry.unknowns.empty())
      for (const Formulation& f : entry.formulations)
        solids.push_back({code, f.code, &entry, entry.name + " " + f.name});
  return solids;
}

// A quadrilateral of corners and the middle nodes of its sides.
bool gives_sides(const ElementEntry& entry) {
  return entry.square() && entry.nodes == 2 * entry.corners;
}

// Ways to rerun the deck; 8-node squares become elements of high degree too.
std::vector<BuildOptions> reruns(const Solid& solid) {
  const std::vector<Grading> towards_corner{{1, 2, 0.3}};
  std::vector<BuildOptions> all;
  const auto add = [&](int element, int refine, const std::vector<Grading>& gradings) {
    BuildOptions& options = all.emplace_back();
    options.element = element;
    options.refine = refine;
    options.gradings = gradings;
  };
  add(0, 0, {});
  add(0, 1, {});
  add(0, 2, {});
  add(0, 0, towards_corner);
  add(0, 1, towards_corner);
  if (!gives_sides(*solid.entry)) return all;
  for (const auto& [code, entry] : full_catalogue().elements.entries()) {
    if (!entry.square() || !entry.makes_nodes()) continue;
    add(code, 0, {});
    add(code, 1, {});
    add(code, 0, towards_corner);
  }
  return all;
}

std::string words(const Solid& solid, const BuildOptions& options) {
  return solid.name + ", element " + std::to_string(options.element) + ", refine " +
         std::to_string(options.refine) + ", " + std::to_string(options.gradings.size()) + " gradings";
}

// The square (0, 2) x (0, 2) in 2 x 2 cells, whose cards give corners and mid-side nodes; others are made.
// Nodes lie on a lattice of half a cell, numbered row by row from 1.
class Square {
 public:
  explicit Square(const Solid& solid) {
    deck.material(1, 1, {kE, kNu});
    deck.group(1, solid.code, solid.formulation, 1);
    const bool triangles = solid.entry->triangle();
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i)
        if (triangles || i % 2 == 0 || j % 2 == 0) deck.node(number(i, j), 0.5 * i, 0.5 * j);
    for (int j = 0; j < 4; j += 2)
      for (int i = 0; i < 4; i += 2) {
        if (triangles) {
          cell({{i, j}, {i + 2, j}, {i, j + 2}});
          cell({{i + 2, j + 2}, {i, j + 2}, {i + 2, j}});
        } else {
          cell({{i, j}, {i + 2, j}, {i + 2, j + 2}, {i, j + 2}});
        }
      }
  }

  static int number(int i, int j) { return 1 + 5 * j + i; }
  static bool outside(int i, int j) { return i == 0 || i == 4 || j == 0 || j == 4; }

  DeckWriter deck{1};

 private:
  void cell(const std::vector<std::array<int, 2>>& at) {
    const std::size_t corners = at.size();
    std::vector<int> nodes(2 * corners, 0);
    for (std::size_t k = 0; k < corners; ++k) {
      const auto& a = at[k];
      const auto& z = at[(k + 1) % corners];
      nodes[k] = number(a[0], a[1]);
      nodes[corners + k] = number((a[0] + z[0]) / 2, (a[1] + z[1]) / 2);
    }
    deck.element(++elements_, 1, nodes);
  }

  int elements_ = 0;
};

// Bending without traction on top and bottom: u = k x y, v = -k (x^2 + nu/(1 - nu) y^2)/2.  Closed form.
Vector2 bending(const Vector2& x) {
  constexpr double k = 0.01;
  return {k * x.x() * x.y(), -0.5 * k * (x.x() * x.x() + kNu / (1.0 - kNu) * x.y() * x.y())};
}

std::set<int> used_nodes(const Model& model) {
  std::set<int> used;
  for (const Group& group : model.groups) used.insert(group.nodes.begin(), group.nodes.end());
  return used;
}

// Elements of degree two and more hold it: what the outline's nodes are moved by gives it everywhere if the
// made nodes of the outline lie on the parabolas through their ends and middles.
TEST(MidSideNodes, OutlineMovedByAQuadraticField) {
  for (const Solid& solid : solids_with_mid_side_nodes())
    for (const BuildOptions& options : reruns(solid)) {
      SCOPED_TRACE(words(solid, options));
      // Grading makes trapezoids, on which eight nodes hold less than all quadratics
      // (Arnold, Boffi & Falk 2002).
      const bool eight = gives_sides(*solid.entry) && options.element == 0;
      if (eight && !options.gradings.empty()) continue;
      Square square(solid);
      StageCards& stage = square.deck.stage();
      for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i)
          if (Square::outside(i, j)) {
            const Vector2 u = bending(0.5 * Vector2(i, j));
            stage.fix(Square::number(i, j), 1, 1, u.x(), u.y());
          }
      const WholeRun run = run_text(square.deck.text(), options);
      ASSERT_TRUE(run.completed()) << run.failure;
      for (const int i : used_nodes(*run.model)) {
        const Vector2 x = run.model->mesh.x.col(i);
        EXPECT_LT((run.last().u.segment<2>(2 * i) - bending(x)).norm(), 1e-13) << "node at " << x.transpose();
      }
    }
}

// Both ends and the middle of a side are held before the stages; a stage moves the middle alone, the next lets
// it go.  Everything on the side goes with it.
TEST(MidSideNodes, MadeNodesGoWithTheMiddle) {
  for (const Solid& solid : solids_with_mid_side_nodes())
    for (const BuildOptions& options : reruns(solid)) {
      SCOPED_TRACE(words(solid, options));
      Square square(solid);
      for (int i = 0; i < 5; ++i) {
        square.deck.fix(Square::number(i, 0), 1, 1);
        square.deck.fix(Square::number(i, 4), 1, 1);
      }
      square.deck.stage().fix(Square::number(3, 4), 0, 1, 0.0, -0.01);
      square.deck.stage().fix(Square::number(3, 4), 0, -1);
      const WholeRun run = run_text(square.deck.text(), options);
      ASSERT_TRUE(run.completed()) << run.failure;
      int moved = 0;
      for (const int i : used_nodes(*run.model)) {
        const Vector2 x = run.model->mesh.x.col(i);
        if (x.y() < 2.0 - 1e-12) continue;
        const double s = x.x() - 1.5;  // -1/2 ... 1/2 along the side that was pushed
        const double v = s > -0.5 ? -0.01 * (1.0 - 4.0 * s * s) : 0.0;
        EXPECT_NEAR(run.increments[0].u[2 * i + 1], v, 1e-15) << "x = " << x.x();
        if (v == 0.0) continue;
        ++moved;
        const double force = run.last().internal[2 * i + 1] - run.last().external[2 * i + 1];
        EXPECT_NEAR(force, 0.0, 1e-9) << "x = " << x.x() << " was let go";
      }
      EXPECT_GT(moved, 0);
    }
}

// A free middle between two held corners carries its load by its own stiffness.  Finer spaces hold the coarse
// one, so that under the same force the node goes down by no less (principle of minimum energy).
TEST(MidSideNodes, FreeMiddleBetweenHeldCornersStaysFree) {
  for (const Solid& solid : solids_with_mid_side_nodes()) {
    if (solid.formulation != solid.entry->formulations.front().code) continue;
    double coarse = 0.0;
    for (const BuildOptions& options : reruns(solid)) {
      if (!options.gradings.empty()) continue;  // cuts the loaded node off, which is refused
      SCOPED_TRACE(words(solid, options));
      Square square(solid);
      for (int i = 0; i < 5; ++i) square.deck.fix(Square::number(i, 0), 1, 1);
      for (const int i : {0, 1, 2, 4}) square.deck.fix(Square::number(i, 4), 1, 1);
      square.deck.stage().load(Square::number(3, 4), 0.0, -10.0);
      const WholeRun run = run_text(square.deck.text(), options);
      ASSERT_TRUE(run.completed()) << run.failure;
      EXPECT_NEAR(run.reaction(Square::number(3, 4)).y(), 0.0, 1e-9) << "a free node";
      const double v = run.u(Square::number(3, 4)).y();
      EXPECT_LT(v, -1e-3);
      if (coarse == 0.0) coarse = v;
      if (solid.entry->formulations.front().name == "full") {
        EXPECT_LE(v, coarse + 1e-12);
      }
    }
  }
}

// The cards of nodes that are the deck's stay as they are, in every list, and so do the reports.
TEST(MidSideNodes, CardsOfTheDecksNodesStay) {
  const auto of_deck = [](const Model& model, const std::vector<Fixity>& list) {
    std::map<int, std::array<double, 4>> cards;
    for (const Fixity& f : list)
      if (f.node < model.mesh.deck_nodes)
        cards[f.node] = {static_cast<double>(f.code[0]), static_cast<double>(f.code[1]), f.value[0],
                         f.value[1]};
    return cards;
  };
  for (const Solid& solid : solids_with_mid_side_nodes()) {
    Square square(solid);
    for (const int i : {0, 2, 4}) square.deck.fix(Square::number(i, 0), 1, 1);  // two free middles
    square.deck.fix(Square::number(3, 4), 0, 1);
    StageCards& stage = square.deck.stage();
    stage.fix(Square::number(2, 4), 1, 1, 0.0, -0.5);
    stage.fix(Square::number(4, 4), 1, 1, 0.0, -0.5);
    stage.fix(Square::number(3, 4), 0, 1, 0.0, -0.25);
    square.deck.reports.push_back("    2    0   21   25    2");  // three corners of the top
    const Workbench workbench = app::make_workbench();
    const Model plain = workbench.build(square.deck.text());
    for (const BuildOptions& options : reruns(solid)) {
      SCOPED_TRACE(words(solid, options));
      if (!options.gradings.empty()) continue;  // may cut the middles off: see below
      const Model model = workbench.build(square.deck.text(), options);
      EXPECT_EQ(of_deck(model, model.fixities), of_deck(plain, plain.fixities));
      EXPECT_EQ(of_deck(model, model.stages[0].fixities), of_deck(plain, plain.stages[0].fixities));
      EXPECT_EQ(model.reports[0].nodes, plain.reports[0].nodes) << "the middle between them is not listed";
    }
  }
}

// A middle that is held alone can't be kept where grading cuts its edge elsewhere.
TEST(MidSideNodes, SupportThatGradingWouldLoseIsRefused) {
  for (const Solid& solid : solids_with_mid_side_nodes()) {
    SCOPED_TRACE(solid.name);
    Square square(solid);
    for (int i = 0; i < 5; ++i) square.deck.fix(Square::number(i, 4), 1, 1);
    square.deck.fix(Square::number(1, 0), 0, 1);  // its ends are free
    square.deck.stage();
    BuildOptions options;
    options.gradings = {{1, 2, 0.3}};
    try {
      app::make_workbench().build(square.deck.text(), options);
      ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("node 2 is held along y but is no node of the graded mesh"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace sage::test
