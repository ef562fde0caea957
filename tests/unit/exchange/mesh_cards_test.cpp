// Meshes listed by order and slopes numbered by rule.  Expected values: the same body as a rectangle numbered by
// rule, and closed forms for numbers of nodes and areas.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "sage/app/commands.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::app {
namespace {

Model model_of(const std::string& text, const std::string& layout) {
  return build_model(read_deck_text(text, "deck.dat", load_layout(layout)), full_catalogue());
}

std::string complaint(const std::string& text, const std::string& layout) {
  try {
    model_of(text, layout);
  } catch (const InputError& error) {
    return error.diagnostics().list().front().message;
  }
  return "";
}

// Corners and mid-side nodes round the element: another corner first, in either sense; inner nodes backwards.
std::vector<int> round_the_element(const Group& group, int element, bool clockwise) {
  const int* nodes = group.nodes_of(element);
  std::vector<int> ring, inner(nodes, nodes + group.node_count());
  for (const std::vector<int>& edge : group.element->edges()) {
    ring.push_back(nodes[edge[0]]);
    for (std::size_t i = 2; i < edge.size(); ++i) ring.push_back(nodes[edge[i]]);
  }
  const std::size_t side = ring.size() / group.element->edges().size();
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(side), ring.end());
  if (clockwise) std::reverse(ring.begin() + 1, ring.end());
  std::erase_if(inner, [&](int n) { return std::find(ring.begin(), ring.end(), n) != ring.end(); });
  ring.insert(ring.end(), inner.rbegin(), inner.rend());
  return ring;
}

// The body of a program 5.1 deck as one of program 5.4.
std::string listed(const Model& model, const std::string& shape, int points, bool clockwise) {
  const Group& first = model.groups.front();
  int elements = 0;
  for (const Group& group : model.groups) elements += group.elements();
  std::string text = fmt::format("'{}' {} {} {} {} 2 3 2 {}\n", shape, first.node_count(), elements,
                                 model.mesh.nodes(), points, model.groups.size());
  for (const Group& group : model.groups) {
    const std::vector<double>& p = model.material_of(group).parameters;
    text += fmt::format("{} {} 0.\n", p[0], p[1]);
  }
  std::map<int, std::pair<int, std::vector<int>>> by_number;
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    for (int e = 0; e < model.groups[g].elements(); ++e)
      by_number[model.groups[g].element_numbers[e]] = {static_cast<int>(g) + 1,
                                                       round_the_element(model.groups[g], e, clockwise)};
  if (model.groups.size() > 1) {
    for (const auto& [number, element] : by_number) text += fmt::format("{} ", element.first);
    text += "\n";
  }
  for (int n = 0; n < model.mesh.nodes(); ++n)
    text += fmt::format("{:.17g} {:.17g}\n", model.mesh.x(0, n), model.mesh.x(1, n));
  for (const auto& [number, element] : by_number) {
    for (const int n : element.second) text += fmt::format("{} ", n + 1);
    text += "\n";
  }
  text += fmt::format("{}\n", model.fixities.size());
  for (const Fixity& f : model.fixities)
    text += fmt::format("{} {} {}\n", f.node + 1, f.code[0] == FixityCode::fixed ? 0 : 1,
                        f.code[1] == FixityCode::fixed ? 0 : 1);
  const Stage& stage = model.stages.front();
  text += fmt::format("{}\n", stage.loads.size());
  for (const NodalLoad& load : stage.loads)
    text += fmt::format("{} {:.17g} {:.17g}\n", load.node + 1, load.force.x(), load.force.y());
  text += fmt::format("{}\n", stage.fixities.size());
  for (const Fixity& f : stage.fixities)
    text += fmt::format("{} {} {:.17g}\n", f.node + 1, f.code[0] == FixityCode::fixed ? 1 : 2,
                        f.code[0] == FixityCode::fixed ? f.value[0] : f.value[1]);
  return text;
}

TEST(MeshCards, EveryElementInEitherSense) {
  struct Case {
    const char* shape;
    int nodes, points;
    const char* direction;
  };
  for (const Case& c : {Case{"triangle", 3, 1, "x"}, Case{"triangle", 6, 3, "y"}, Case{"triangle", 15, 12, "x"},
                        Case{"quadrilateral", 4, 4, "y"}, Case{"quadrilateral", 8, 4, "x"},
                        Case{"quadrilateral", 8, 9, "y"}, Case{"quadrilateral", 9, 9, "x"}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", c.shape, c.nodes, c.direction));
    const int elements = c.shape[0] == 't' ? 8 : 4;
    std::string types;
    for (int e = 0; e < elements; ++e) types += e % 2 == 0 ? "1 " : "2 ";
    const int side = c.nodes == 3 || c.nodes == 4 ? 1 : c.nodes == 15 ? 4 : 2;
    // Both ends of the first line of nodes are held, and enough of a third node; one node is loaded, one is moved.
    const int line = 2 * side + 1;
    const std::string deck = fmt::format(
        "'plane' '{}' {} '{}' 2 2 {} 2\n1000. .3\n500. .2\n{}\n0. 1. 2.5\n0. -1. -1.5\n2\n1 0 0 {} 0 0\n1\n2 "
        "1. -2.\n1\n{} 1 .01\n",
        c.shape, c.nodes, c.direction, c.points, types, line, line + 1);
    Model rectangle = model_of(deck, "sg_p51");
    for (const bool clockwise : {true, false}) {
      Model general = model_of(listed(rectangle, c.shape, c.points, clockwise), "sg_p54");
      const scenes::WholeRun a = make_workbench().run(model_of(deck, "sg_p51"));
      const scenes::WholeRun b = make_workbench().run(std::move(general));
      ASSERT_TRUE(a.completed() && b.completed());
      EXPECT_GE(a.largest_u(), 0.01);
      EXPECT_LT((a.last().u - b.last().u).cwiseAbs().maxCoeff(), 1e-12)
          << (clockwise ? "clockwise" : "counter-clockwise");
    }
  }
}

TEST(MeshCards, WhatIsWrongIsNamedAtItsPlace) {
  const std::string begin = "'quadrilateral' 4 1 4 4 2 3 2 1\n1000. .3 0.\n0. 0. 1. 0. 1. 1. 0. 1.\n";
  const std::string end = "\n2\n1 0 0 2 0 0\n1\n3 0. -1.\n0\n";
  EXPECT_EQ(complaint(begin + "1 4 3 2" + end, "sg_p54"), "");
  EXPECT_NE(complaint(begin + "1 3 4 2" + end, "sg_p54").find("element 1: its corners"), std::string::npos);
  EXPECT_NE(complaint(begin + "1 4 3 5" + end, "sg_p54").find("node 5 is none of the 4 nodes"),
            std::string::npos);
  const std::string brick =
      "'hexahedron' 8 1 8 8 3 6 3 1\n1000. .3 0.\n0. 0. 0. 1. 0. 0. 1. 1. 0. 0. 1. 0. 0. 0. 1. 1. 0. 1. 1. 1. "
      "1. 0. 1. 1.\n"
      "1 2 3 4 5 6 7 8\n2\n1 0 0 0 2 0 0 0\n1\n8 0. 0. -1.\n0\n";
  EXPECT_NE(complaint(brick, "sg_p54").find("three dimensions"), std::string::npos)
      << complaint(brick, "sg_p54");
}

std::string slope(int nx1, int nx2, int ny1, int ny2) {
  return fmt::format("12. 8. 10. 6. {}\n{} {} {} {} 1\n20. 15. 0. 20. 1.e5 .3\n.0001 500 1\n1.\n",
                     ny2 > 0 ? 4.0 : 0.0, nx1, nx2, ny1, ny2);
}

// Nodes (3 nye + 2) nx1 + 2 nye + 1 + (3 ny2 + 2) nx2, as that program counts them; the area of the trapezium and
// of what is below.
TEST(MeshCards, SlopesOfAllKinds) {
  struct Case {
    int nx1, nx2, ny1, ny2;
  };
  for (const Case& c : {Case{4, 2, 3, 2}, Case{4, 0, 3, 2}, Case{5, 0, 2, 0}, Case{1, 1, 1, 1}}) {
    SCOPED_TRACE(fmt::format("{} {} {} {}", c.nx1, c.nx2, c.ny1, c.ny2));
    const Model model = model_of(slope(c.nx1, c.nx2, c.ny1, c.ny2), "sg_p64");
    const int nye = c.ny1 + c.ny2;
    EXPECT_EQ(model.mesh.nodes(), (3 * nye + 2) * c.nx1 + 2 * nye + 1 + (3 * c.ny2 + 2) * c.nx2);
    double area = 0.0;
    for (int e = 0; e < model.groups[0].elements(); ++e)
      for (std::size_t i = 0; i < 4; ++i) {
        const Vector2 a = model.mesh.x.col(model.groups[0].nodes_of(e)[i]);
        const Vector2 b = model.mesh.x.col(model.groups[0].nodes_of(e)[(i + 1) % 4]);
        area += 0.5 * (a.x() * b.y() - b.x() * a.y());
      }
    const double below = c.ny2 > 0 ? 4.0 * (20.0 + (c.nx2 > 0 ? 10.0 : 0.0)) : 0.0;
    EXPECT_NEAR(area, 6.0 * (12.0 + 20.0) / 2.0 + below, 1e-10);
  }
}

}  // namespace
}  // namespace sage::app
