// Which body owns which side of an interface: found from the solids, because the pairs' coordinates coincide.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run_text.hpp"
#include "tests/support/text.hpp"

namespace sage {
namespace {

using scenes::DeckWriter;

enum class Bodies { both, bottom, top, none };

struct Joint {
  bool quadratic = false;
  double angle = 0.0;  // degrees, of the line 1 -> 2
  double bend = 0.0;   // sagitta of the joint
  Bodies bodies = Bodies::both;
  std::vector<int> order;  // nodes of the joint
  bool placed_late = false, top_removed = false;
};

// Bottom body: nodes 1-8, top body: nodes 11-18, both quad8 numbering; 3 4 (7) and 11 12 (15) lie at the joint.
std::vector<int> right_order(bool quadratic) {
  return quadratic ? std::vector<int>{4, 3, 12, 11, 7, 15} : std::vector<int>{4, 3, 12, 11};
}

std::vector<int> swapped(const std::vector<int>& n) {
  return n.size() == 6 ? std::vector<int>{n[3], n[2], n[1], n[0], n[5], n[4]}
                       : std::vector<int>{n[3], n[2], n[1], n[0]};
}

std::string text(const Joint& joint) {
  DeckWriter deck(1);
  const double a = joint.angle * kRadiansPerDegree;
  const auto node = [&](int number, double x, double y) {
    deck.node(number, 5.0 + x * std::cos(a) - y * std::sin(a), 5.0 + x * std::sin(a) + y * std::cos(a));
  };
  const double corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const double middle[4][2] = {{.5, 0}, {1, .5}, {.5, 1}, {0, .5}};
  for (const int body : {0, 10}) {
    for (int i = 0; i < 4; ++i) node(body + 1 + i, corner[i][0], corner[i][1] + body / 10);
    const double up[4] = {body == 10 ? joint.bend : 0.0, 0.0, body == 0 ? joint.bend : 0.0, 0.0};
    if (joint.quadratic)
      for (int i = 0; i < 4; ++i) node(body + 5 + i, middle[i][0], middle[i][1] + body / 10 + up[i]);
  }
  deck.material(1, 1, {1e4, 0.3});
  deck.material(2, 21, {1e4, 1e6, 1.0});
  deck.group(1, joint.quadratic ? 2 : 1, 0, 1);
  deck.group(2, joint.quadratic ? 12 : 11, 0, 2);
  deck.group(3, joint.quadratic ? 2 : 1, 0, 1);
  const auto body = [&](int first) {
    std::vector<int> nodes;
    for (int i = 1; i <= (joint.quadratic ? 8 : 4); ++i) nodes.push_back(first + i);
    return nodes;
  };
  if (joint.bodies == Bodies::both || joint.bodies == Bodies::bottom) deck.element(1, 1, body(0));
  deck.element(2, 2, joint.order);
  if (joint.bodies == Bodies::both || joint.bodies == Bodies::top) deck.element(3, 3, body(10));
  for (int number = 1; number <= 18; ++number)
    if (number % 10 >= 1 && number % 10 <= (joint.quadratic ? 8 : 4)) deck.fix(number, 1, 1);
  deck.stage();
  if (joint.placed_late) deck.stage().births = {2, 3};
  if (joint.top_removed) deck.stage().deaths = {3};
  return deck.text();
}

struct Answer {
  std::string error, notes;
};

Answer answer(const Joint& joint) {
  Answer answer;
  try {
    const scenes::WholeRun run = test::run_text(text(joint));
    for (const Diagnostic& d : run.model->diagnostics.list()) answer.notes += d.message + "\n";
  } catch (const InputError& error) {
    answer.error = to_string(error.diagnostics().list().front());
    EXPECT_EQ(error.diagnostics().errors(), 1) << error.what();
  }
  return answer;
}

TEST(InterfaceSides, AreCheckedAtEveryAngleWithOneBodyOrTwo) {
  for (const bool quadratic : {false, true})
    for (const double angle : {0.0, 30.0, 90.0, 135.0, 180.0, 250.0})
      for (const double bend : {0.0, 0.15}) {
        if (bend != 0.0 && !quadratic) continue;
        for (const Bodies bodies : {Bodies::both, Bodies::bottom, Bodies::top}) {
          SCOPED_TRACE("angle " + std::to_string(angle) + (quadratic ? " quadratic" : " linear"));
          Joint joint{quadratic, angle, bend, bodies, right_order(quadratic)};
          const Answer right = answer(joint);
          EXPECT_EQ(right.error, "");
          EXPECT_FALSE(test::has(right.notes, "which side is which")) << right.notes;
          joint.order = swapped(joint.order);
          const std::string wrong = answer(joint).error;
          EXPECT_TRUE(test::has(wrong, "element 2 (interface")) << wrong;
          EXPECT_TRUE(test::has(wrong, "sides are swapped")) << wrong;
          EXPECT_TRUE(test::has(wrong, quadratic ? "4 3 2 1 6 5" : "node order 4 3 2 1 would")) << wrong;
          EXPECT_EQ(test::has(wrong, "element 3, which owns its nodes 1 and 2, lies to the left"),
                    bodies != Bodies::bottom)
              << wrong;
          EXPECT_EQ(test::has(wrong, "element 1, which owns its nodes 3 and 4, lies to the right"),
                    bodies != Bodies::top)
              << wrong;
        }
      }
}

// The proposed order is one that is accepted.
TEST(InterfaceSides, TheOrderThatTheMessageNamesIsRight) {
  for (const bool quadratic : {false, true})
    EXPECT_EQ(answer({quadratic, 40.0, 0.0, Bodies::both, swapped(swapped(right_order(quadratic)))}).error, "");
  // Walked the other way round, with each body still on its own side of the walk.
  EXPECT_EQ(answer({false, 40.0, 0.0, Bodies::both, {12, 11, 4, 3}}).error, "")
      << "nodes 3 4 1 2 is the same element";
}

TEST(InterfaceSides, BodiesOfOtherStagesCountToo) {
  Joint joint{false, 20.0, 0.0, Bodies::both, right_order(false), true, true};
  EXPECT_EQ(answer(joint).error, "");
  joint.order = swapped(joint.order);
  EXPECT_TRUE(test::has(answer(joint).error, "sides are swapped"));
  joint.bodies = Bodies::top;
  EXPECT_TRUE(test::has(answer(joint).error, "sides are swapped"));
}

TEST(InterfaceSides, LinearJointsAlongAQuadraticEdge) {
  // Two interfaces of two nodes a side, corner to middle and middle to corner of one 8-node element.
  const auto with = [](const std::vector<int>& order) {
    Joint joint{true, 0.0, 0.0, Bodies::bottom, right_order(true)};
    std::string deck = text(joint);
    const auto row = [](const std::vector<int>& n) {
      std::string card;
      for (const int i : n) card += std::string(5 - std::to_string(i).size(), ' ') + std::to_string(i);
      return card;
    };
    const auto replace = [&](const std::string& from, const std::string& to) {
      const std::size_t at = deck.find(from);
      EXPECT_NE(at, std::string::npos) << from;
      deck.replace(at, from.size(), to);
    };
    replace(row({2, 2, 4, 3, 12, 11, 7, 15}), row({2, 2}) + row(order));
    replace(row({2, 12, 0, 2}), row({2, 11, 0, 2}));
    return deck;
  };
  EXPECT_NO_THROW(test::run_text(with({4, 7, 15, 11})));
  EXPECT_THROW(test::run_text(with({11, 15, 7, 4})), InputError);
}

TEST(InterfaceSides, WithoutSolidsThereIsANote) {
  const Answer free = answer({false, 0.0, 0.0, Bodies::none, right_order(false)});
  EXPECT_EQ(free.error, "");
  EXPECT_TRUE(
      test::has(free.notes, "1 interface element(s) touch no solid on either side, the first is element 2"))
      << free.notes;
}

}  // namespace
}  // namespace sage
