// Meshes: distortion to collapse, aspect, wrong orders, radii, nodes that are twice, unused or hanging.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/studies/scenes/lame.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

constexpr double kE = 1e6, kNu = 0.25;

// u = 1e-3 (x + y/2), v = 1e-3 (y + x/2) in plane strain: sigma_x = sigma_y = 1600, sigma_z = 800, tau = 400
// (MacNeal & Harder 1985).
double patch_error(const Ran& ran) {
  if (!ran.completed()) return kUnknown;
  const Vector4 exact(1600.0, 1600.0, 800.0, 400.0);
  return (ran.run->stress[0].colwise() - Eigen::VectorXd(exact)).cwiseAbs().maxCoeff() / 1600.0;
}

void move_as_patch(StageCards& stage, int node, double x, double y) {
  stage.fix(node, 1, 1, 1e-3 * (x + 0.5 * y), 1e-3 * (y + 0.5 * x));
}

// 2 x 2 elements over (-1/4, 3/4)^2.  At the origin the inner node would make the lower left one a triangle: it
// stands at (delta, delta)/4.
std::string distorted_patch(int element, int formulation, double delta) {
  DeckWriter deck(1);
  const double at[] = {-0.25, 0.25, 0.75};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const bool inner = i == 1 && j == 1;
      deck.node(3 * j + i + 1, inner ? 0.25 * delta : at[i], inner ? 0.25 * delta : at[j]);
    }
  deck.material(1, 1, {kE, kNu});
  deck.group(1, element, formulation, 1);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int n = 3 * j + i + 1;
      deck.element(2 * j + i + 1, 1, {n, n + 1, n + 4, n + 3});
    }
  StageCards& stage = deck.stage();
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      if (i != 1 || j != 1) move_as_patch(stage, 3 * j + i + 1, at[i], at[j]);
  return deck.text();
}

void distortion(Sweep& s) {
  struct Kind {
    const char* name;
    int element, formulation;
  };
  for (const Kind& kind : {Kind{"quad4 full", 1, 1}, Kind{"quad4 b-bar", 1, 2}, Kind{"quad8 reduced", 2, 1}}) {
    for (double delta : {1.0, 0.5, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
      const Ran ran = s.run(distorted_patch(kind.element, kind.formulation, delta));
      const std::string label = fmt::format("{}, {:g} from collapse", kind.name, delta);
      s.right(label, delta, ran, patch_error(ran), 1e-12).series = kind.name;
      if (delta < 0.05) s.says(label, kUnknown, ran, "badly distorted; worst element 1");
    }
    for (double delta : {0.0, -1e-8, -0.5}) {
      const std::string label = fmt::format("{}, {:g} beyond collapse", kind.name, -delta);
      const Ran ran = s.run(distorted_patch(kind.element, kind.formulation, delta));
      s.says(label, kUnknown, ran, "element 1");
      s.holds(label, kUnknown, !ran.run, "refused", ran.run ? "it ran" : "refused");
    }
  }
}

// A mesh of 3 x 3 cells with corners out of line, squeezed to 1/aspect in y; every coordinate has few digits,
// so that cards hold it exactly.
Block thin_block(Cell cell, double ratio) {
  Block block;
  block.cell = cell;
  block.columns = block.rows = 3;
  const int order = block.order();
  block.place = [ratio, order](double a, double b) {
    const int n = 3 * order;
    const int i = static_cast<int>(std::lround(a * n)), j = static_cast<int>(std::lround(b * n));
    const auto corner = [&](int k, int l) {
      const double at[] = {0.0, 0.3, 0.7, 1.0};
      const bool inner = k % 3 != 0 && l % 3 != 0;
      return Vector2(at[k] + (inner ? 0.1 * (k - l) : 0.0), (at[l] + (inner && k == l ? 0.06 : 0.0)) / ratio);
    };
    if (order == 1) return corner(i, j);
    const auto mean = [&](int k, int l, int p, int q) { return Vector2(0.5 * (corner(k, l) + corner(p, q))); };
    if (i % 2 == 0) return mean(i / 2, j / 2, i / 2, (j + 1) / 2);
    if (j % 2 == 0) return mean(i / 2, j / 2, (i + 1) / 2, j / 2);
    return mean((i + 1) / 2, j / 2, i / 2, (j + 1) / 2);  // on a triangle's diagonal
  };
  return block;
}

// u = x/1000, v = y/2000 on meshes ever thinner: exact.  A thin element has stiffness ratios of aspect^2, and
// so many digits may go.
void aspect(Sweep& s) {
  struct Kind {
    const char* name;
    Cell cell;
    int formulation;
  };
  const double strain_x = 1e-3, strain_y = 5e-4, factor = kE / ((1 + kNu) * (1 - 2 * kNu));
  const Vector4 exact(factor * ((1 - kNu) * strain_x + kNu * strain_y),
                      factor * ((1 - kNu) * strain_y + kNu * strain_x), factor * kNu * (strain_x + strain_y),
                      0.0);
  for (const Kind& kind : {Kind{"quad4 b-bar", Cell::quad4, 2}, Kind{"quad8 reduced", Cell::quad8, 1},
                           Kind{"tri6", Cell::tri6, 1}})
    for (double ratio : {1.0, 10.0, 100.0, 1e3, 1e4}) {
      const Block block = thin_block(kind.cell, ratio);
      DeckWriter deck(1);
      block.write_nodes(deck);
      deck.material(1, 1, {kE, kNu});
      deck.group(1, static_cast<int>(kind.cell), kind.formulation, 1);
      block.write_elements(deck, 1);
      StageCards& stage = deck.stage();
      for (int j = 0; j < block.up(); ++j)
        for (int i = 0; i < block.across(); ++i) {
          const bool outline = i == 0 || j == 0 || i + 1 == block.across() || j + 1 == block.up();
          if (outline && block.exists(i, j))
            stage.fix(block.node(i, j), 1, 1, strain_x * block.at(i, j).x(), strain_y * block.at(i, j).y());
        }
      const Ran ran = s.run(deck.text());
      const double error =
          ran.completed()
              ? (ran.run->stress[0].colwise() - Eigen::VectorXd(exact)).cwiseAbs().maxCoeff() / exact.maxCoeff()
              : kUnknown;
      s.right(fmt::format("{}, aspect {:g}", kind.name, ratio), ratio, ran, error,
              100.0 * kUnit * ratio * ratio)
          .series = kind.name;
    }
}

// One element over the unit square, its nodes in the order given and one of them elsewhere.
std::string one_element(int element, const std::vector<int>& order, int moved = 0, double x = 0.0,
                        double y = 0.0, int geometry = 1, double shift = 0.0) {
  const double at[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {.5, 0}, {1, .5}, {.5, 1}, {0, .5}};
  DeckWriter deck(geometry);
  for (int n = 1; n <= static_cast<int>(order.size()); ++n)
    deck.node(n, (n == moved ? x : at[n - 1][0]) + shift, n == moved ? y : at[n - 1][1]);
  deck.material(1, 1, {kE, kNu});
  deck.group(1, element, 0, 1);
  deck.element(7, 1, order);
  for (int n : {1, 2}) deck.fix(n, 1, 1);
  deck.stage().load(3, 1.0, 1.0);
  return deck.text();
}

void bad_shapes(Sweep& s) {
  const std::vector<int> q4{1, 2, 3, 4}, q8{1, 2, 3, 4, 5, 6, 7, 8};
  std::vector<int> order = q4;
  do {  // all 24 orders: 4 are right, 4 clockwise, 16 crossed
    const std::string label = fmt::format("order {} {} {} {}", order[0], order[1], order[2], order[3]);
    const Ran ran = s.run(one_element(1, order));
    const int turn = (order[1] - order[0] + 4) % 4;
    const bool cyclic =
        (order[2] - order[1] + 4) % 4 == turn && (order[3] - order[2] + 4) % 4 == turn && turn != 2;
    if (cyclic && turn == 1)
      s.silent(label, kUnknown, ran, "clockwise");
    else
      s.says(label, kUnknown, ran,
             cyclic ? "element 7 (quad4 b-bar): clockwise" : "element 7 (quad4 b-bar): crossed");
  } while (std::next_permutation(order.begin(), order.end()));
  s.says("re-entrant corner", kUnknown, s.run(one_element(1, q4, 3, 0.4, 0.4)), "re-entrant corner");
  s.says("collapsed to a triangle", kUnknown, s.run(one_element(1, q4, 3, 0.5, 0.5)), "element 7");
  s.says("two corners at one place", kUnknown, s.run(one_element(1, q4, 3, 1.0, 0.0)), "at the same place");
  s.says("all on one line", kUnknown, s.run(one_element(1, {1, 2, 5, 6}, 0)), "is not defined by any node");
  s.says("mid-side node at the quarter point", kUnknown, s.run(one_element(2, q8, 5, 0.25, 0.0)), "element 7");
  s.says("mid-side node beyond it", kUnknown, s.run(one_element(2, q8, 5, 0.2, 0.0)), "mid-side nodes fold");
  s.says("mid-side node far outside", kUnknown, s.run(one_element(2, q8, 5, 0.5, 3.0)), "element 7");
  s.silent("mid-side node a little off", kUnknown, s.run(one_element(2, q8, 5, 0.45, 0.0)), "fold");
}

void radius(Sweep& s) {
  const std::vector<int> q4{1, 2, 3, 4};
  for (double shift : {-2.0, -0.5, -1e-3, -1e-6})
    s.says(fmt::format("smallest r = {:g}", shift), kUnknown, s.run(one_element(1, q4, 0, 0.0, 0.0, 2, shift)),
           "negative radius");
  // r = 0: held, and right.  A free cylinder under p from the side: u_r = -(1-nu) p r/E.
  for (double inner : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
    Block block;
    block.columns = 4;
    block.rows = 2;
    block.place = rectangle(inner, 1.0, 0.0, 1.0);
    DeckWriter deck(2);
    block.write_nodes(deck);
    deck.material(1, 1, {kE, kNu});
    deck.group(1, 1, 2, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    StageCards& stage = deck.stage();
    for (int j = 0; j < block.rows; ++j) {
      stage.pressure(block.element(3, j), 2, 100.0, 100.0);
      if (inner > 0.0) stage.pressure(block.element(0, j), 4, 100.0, 100.0);
    }
    const Ran ran = s.run(deck.text());
    const double exact = -(1.0 - kNu) * 100.0 / kE;
    const std::string label = fmt::format("mesh from r = {:g}", inner);
    s.right(label, kUnknown, ran,
            ran.completed() ? ran.run->u(block.right().front()).x() / exact - 1.0 : kUnknown, 1e-10);
    if (inner == 0.0) s.says(label, kUnknown, ran, "on the axis r = 0 held radially");
  }
}

// Two unit cells side by side with nodes of their own, `gap` apart.
std::string two_cells(double gap) {
  DeckWriter deck(1);
  const double x[] = {0.0, 1.0, 1.0 + gap, 2.0 + gap};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) deck.node(10 * (i + 1) + j, x[i] - 1.0, j);
  deck.material(1, 1, {kE, kNu});
  deck.group(1, 1, 1, 1);
  deck.element(1, 1, {10, 20, 21, 11});
  deck.element(2, 1, {30, 40, 41, 31});
  for (int n : {10, 20, 30, 40}) deck.fix(n, 1, 1);
  deck.stage().load(11, 1.0, 0.0);
  return deck.text();
}

void duplicates(Sweep& s) {
  for (double gap : {0.0, 1e-12, 1e-10, 1e-8, 9e-7})
    s.says(fmt::format("nodes {:g} of an edge apart", gap), kUnknown, s.run(two_cells(gap)),
           "2 pair(s) of nodes at one place are joined by no interface: 20 and 30, 21 and 31");
  for (double gap : {1e-5, 1e-3, 0.1})
    s.silent(fmt::format("nodes {:g} of an edge apart", gap), kUnknown, s.run(two_cells(gap)), "at one place");
  TwoRingDeck joined;
  s.silent("pairs of an interface", kUnknown, s.run(joined.text()), "at one place");
  // Many parts of a mesh are small beside others: the measure is the edge, not the mesh.
  TriaxialDeck fine;
  fine.parameters = {kE, kNu};
  fine.columns = 40;
  s.silent("a fine mesh", kUnknown, s.run(fine.text()), "at one place");
}

void orphans(Sweep& s) {
  TriaxialDeck column;
  column.parameters = {kE, kNu};
  const auto with = [&](const std::function<void(DeckWriter&)>& change) {
    DeckWriter deck = column.deck();
    change(deck);
    return s.run(deck.text());
  };
  const Ran unused = with([](DeckWriter& deck) { deck.node(99, 5.0, 5.0); });
  s.says("a node of no element", kUnknown, unused,
         "belong to no element and are ignored, the first is node 99");
  s.right("the answer without it", kUnknown, unused,
          unused.completed()
              ? unused.run->reaction(unused.run->last(), column.block().top(), 1) / (-0.01 * kE * kPi) - 1.0
              : kUnknown,
          1e-10);
  s.says("it is loaded", kUnknown, with([](DeckWriter& deck) {
           deck.node(99, 5.0, 5.0);
           deck.stages.front().load(99, 1.0, 0.0);
         }),
         "node 99 is loaded but belongs to no element");
  s.says("it is displaced", kUnknown, with([](DeckWriter& deck) {
           deck.node(99, 5.0, 5.0);
           deck.stages.front().fix(99, 1, 1, 1.0, 0.0);
         }),
         "node 99 is displaced but belongs to no element");
  s.says("a material of no group", kUnknown, with([](DeckWriter& deck) {
           deck.material(2, 1, {1.0, 0.0});
         }),
         "material 2 is used by no group");
}

// A coarse element below two fine ones, or beside a quadratic one.
void hanging(Sweep& s) {
  for (bool quadratic : {false, true}) {
    DeckWriter deck(1);
    deck.node(1, 0.0, 0.0);
    deck.node(2, 2.0, 0.0);
    deck.node(3, 2.0, 1.0);
    deck.node(4, 0.0, 1.0);
    deck.node(5, 1.0, 1.0);
    deck.node(6, 0.0, 2.0);
    deck.node(7, 1.0, 2.0);
    deck.node(8, 2.0, 2.0);
    deck.node(9, 2.0, 1.5);
    deck.node(10, 0.0, 1.5);
    deck.material(1, 1, {kE, kNu});
    deck.group(1, 1, 1, 1);
    if (quadratic) deck.group(2, 2, 1, 1);
    deck.element(1, 1, {1, 2, 3, 4});
    if (quadratic) {
      deck.element(2, 2, {4, 3, 8, 6, 5, 9, 7, 10});
    } else {
      deck.element(2, 1, {4, 5, 7, 6});
      deck.element(3, 1, {5, 3, 8, 7});
    }
    for (int n : {1, 2}) deck.fix(n, 1, 1);
    deck.stage().load(8, 1.0, 0.0);
    s.says(quadratic ? "quad8 above a quad4" : "two quad4 above one", kUnknown, s.run(deck.text()),
           quadratic ? "1 hanging node(s): node 5 of element 2 on an edge of element 1 (nodes 3 and 4)"
                     : "1 hanging node(s): node 5 on an edge of element 1 (nodes 3 and 4)");
  }
  for (Cell cell : {Cell::quad4, Cell::quad8, Cell::quad9}) {
    LameDeck whole;
    whole.cell = cell;
    s.silent(fmt::format("a mesh that joins, cell {}", static_cast<int>(cell)), kUnknown, s.run(whole.text()),
             "hanging");
  }
}

}  // namespace

std::vector<Row> shape_rows() {
  const std::string family = "Meshes";
  return {
      {"distortion", family, "an element to collapse and beyond",
       "patch test of MacNeal & Harder: exact as long as the Jacobian is positive. Allowed: 1e-12",
       "distance to collapse (1 = square)", true, distortion},
      {"aspect", family, "aspect ratio to 1e4",
       "patch test. Allowed: 100 u aspect^2 (condition of a thin element), u = 1.1e-16", "aspect ratio", true,
       aspect},
      {"bad-shapes", family, "all orders of four nodes, re-entrant corners, mid-side nodes",
       "the element is named", "", false, bad_shapes},
      {"radius", family, "negative radii, and meshes that touch the axis", "u_r = -(1 - nu) p r/E", "", false,
       radius},
      {"duplicate-nodes", family, "nodes at one place without an interface", "announced below 1e-6 of an edge",
       "", false, duplicates},
      {"orphans", family, "nodes of no element, materials of no group", "a note; E eps for the rest", "", false,
       orphans},
      {"hanging-nodes", family, "meshes that do not join", "node and edge are named", "", false, hanging},
  };
}

}  // namespace sage::stress
