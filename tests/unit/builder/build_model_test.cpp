// What deck cards become: generation, mid-side nodes, inherited fixities, checks before anything is solved.
#include "sage/builder/build_model.hpp"

#include <gtest/gtest.h>

#include "sage/app/commands.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/run_text.hpp"

namespace sage {
namespace {

Model build(const std::string& text, const BuildOptions& options = {}) {
  static const Catalogue catalogue = app::full_catalogue();
  return build_model(read_deck_text(text, "test.dat", load_layout("sage1")), catalogue, options);
}

// A deck by hand: one square or block with the given node, fill and element cards.
std::string deck(const std::vector<std::string>& nodes, const std::vector<std::string>& fills,
                 const std::vector<std::string>& elements, int geometry = 1) {
  const auto count = [](std::size_t n) {
    std::string text = std::to_string(n);
    return std::string(5 - text.size(), ' ') + text;
  };
  std::string text = "test\nm       kN      kPa\n";
  text += count(static_cast<std::size_t>(geometry)) + "    0" + count(nodes.size()) + count(fills.size()) +
          "    1    1" + count(elements.size()) + "    1    0    1    0    0    0\n";
  for (const auto& card : nodes) text += card + "\n";
  for (const auto& card : fills) text += card + "\n";
  text += "    1    1    2\n     1000.       0.3\n    1    1    2    1\n";
  for (const auto& card : elements) text += card + "\n";
  text += "    1    2    1    1    1\nstage\n    1\nEND\n";
  return text;
}

const std::vector<std::string> kSquare{
    "    1    0    0        0.        0.", "    2    0    0        1.        0.",
    "    3    0    0        1.        1.", "    4    0    0        0.        1."};

Vector2 at(const Model& model, int number) {
  for (int i = 0; i < model.mesh.nodes(); ++i)
    if (model.mesh.number[i] == number) return model.mesh.x.col(i);
  return {std::nan(""), std::nan("")};
}

TEST(NodeCards, FillALineInProportion) {
  // Five nodes, last interval twice the first: intervals 1, 2^(1/3), 2^(2/3), 2 over their sum.
  std::string text =
      deck({"    1    0    0        0.        0.", "    5    1    0        1.        0.        2.",
            "   10    0    0        1.        1.", "   11    0    0        0.        1."},
           {}, {"    1    1    1    5   10   11"});
  const std::string held = "    1    2    1    1    1\n";
  const Model model = build(text.replace(text.find(held), held.size(), "    1    5    4    1    1\n"));
  const double q = std::cbrt(2.0), sum = 1.0 + q + q * q + 2.0;
  EXPECT_NEAR(at(model, 2).x(), 1.0 / sum, 1e-15);
  EXPECT_NEAR(at(model, 3).x(), (1.0 + q) / sum, 1e-15);
  EXPECT_NEAR(at(model, 4).x(), (1.0 + q + q * q) / sum, 1e-15);
}

TEST(NodeCards, PolarNodesLieOnTheArc) {
  const Model model = build(deck({"    1    0    1        1.        0.", "    3    1    1        1.       90.",
                                  "    4    0    1        2.        0.", "    6    1    1        2.       90."},
                                 {}, {"    1    1    1    4    5    2", "    2    1    2    5    6    3"}));
  EXPECT_NEAR(at(model, 2).x(), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(at(model, 2).y(), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(at(model, 3).x(), 0.0) << "a quarter turn is exact, so that symmetry lines are straight";
}

TEST(FillCards, KeepCurvedSides) {
  // A block whose lower side is bent down by 0.2 in the middle: half of that in the middle of the block.
  const Model model = build(deck({"    1    0    0        0.        0.", "    2    0    0        .5       -.2",
                                  "    3    0    0        1.        0.", "    7    0    0        0.        1.",
                                  "    9    0    0        1.        1."},
                                 {"    1    2    1    2    3"},
                                 {"    1    1    1    2    5    4                        2    2    1    3"}));
  EXPECT_EQ(model.mesh.nodes(), 9);
  EXPECT_NEAR(at(model, 5).y(), 0.5 - 0.1, 1e-15);
  EXPECT_NEAR(at(model, 8).y(), 1.0, 1e-15);
  EXPECT_EQ(model.groups[0].elements(), 4);
  EXPECT_EQ(model.groups[0].element_numbers.back(), 4);
}

TEST(MidNodes, AreSharedAndInheritFixities) {
  // Two squares side by side, made of eight-node elements by option: one common mid-side node.
  const std::string text = deck({"    1    0    0        0.        0.", "    3    1    0        2.        0.",
                                 "    4    0    0        0.        1.", "    6    1    0        2.        1."},
                                {}, {"    1    1    1    2    5    4                        2"});
  BuildOptions options;
  options.element = 2;
  const Model model = build(text, options);
  EXPECT_EQ(model.mesh.nodes(), 6 + 7);
  EXPECT_EQ(model.mesh.deck_nodes, 6);
  // Nodes 1 and 2 are held in x and y; the node between them on the boundary is too, those above are not.
  int held = 0;
  for (const Fixity& f : model.fixities) {
    if (f.node < model.mesh.deck_nodes) continue;
    ++held;
    EXPECT_NEAR(model.mesh.x(0, f.node), 0.5, 1e-15);
    EXPECT_EQ(model.mesh.x(1, f.node), 0.0);
  }
  EXPECT_EQ(held, 1);
}

TEST(Triangles, AFoldedQuadrilateralBecomesOne) {
  const Model model =
      build(deck(kSquare, {}, {"    1    1    1    2    3    3", "    2    1    1    3    4    4"}));
  int triangles = 0;
  for (const Group& group : model.groups)
    if (group.element->traits().nodes == 3) triangles += group.elements();
  EXPECT_EQ(triangles, 2);
}

// Edges count as the card lists the nodes, wherever the repeated corner stands: the
// loaded side is 3-1, 1-2 or 2-3.
TEST(Triangles, EdgesKeepTheNumbersOfTheCard) {
  const auto loaded = [](const std::string& element, int edge) {
    std::string text = deck(kSquare, {}, {element, "    2    1    1    3    4    4"});
    const std::string stage = "stage\n    1\n";
    text.replace(text.find(stage), stage.size(),
                 "stage\n    1    0    0    0    0    0    1\n    1    " + std::to_string(edge) +
                     "                 10.       10.\n");
    const Model model = build(text);
    const EdgeLoad& load = model.stages.at(0).pressures.at(0);
    const Group& group = model.groups[load.group];
    std::string nodes;
    for (int i : group.element->edges()[load.edge])
      nodes += std::to_string(model.mesh.number[group.nodes_of(load.element)[i]]);
    return nodes;
  };
  EXPECT_EQ(loaded("    1    1    1    2    3    3", 1), "12");
  EXPECT_EQ(loaded("    1    1    1    2    3    3", 4), "31");
  EXPECT_EQ(loaded("    1    1    1    1    2    3", 2), "12");
  EXPECT_EQ(loaded("    1    1    1    1    2    3", 4), "31");
  EXPECT_EQ(loaded("    1    1    1    2    2    3", 3), "23");
  EXPECT_EQ(loaded("    1    1    1    2    3    1", 3), "31");
  try {
    loaded("    1    1    1    2    3    3", 3);
    FAIL() << "the edge between the same nodes";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("both of its nodes are the same"), std::string::npos)
        << error.what();
  }
}

TEST(Axis, NodesOnItAreHeldRadially) {
  const Model model = build(deck(kSquare, {}, {"    1    1    1    2    3    4"}, 2));
  int held = 0;
  for (const Fixity& f : model.fixities) held += f.node == 3 && f.code[0] == FixityCode::fixed && f.line == 0;
  EXPECT_EQ(held, 1) << "node 4 at r = 0, not held by the deck";
}

std::string refusal(const std::string& text) {
  try {
    build(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Checks, NameTheMotionThatNothingHolds) {
  std::string loose = deck(kSquare, {}, {"    1    1    1    2    3    4"});
  const std::string held = "    1    2    1    1    1\n";
  const auto with = [&](const std::string& card) {
    std::string text = loose;
    return text.replace(text.find(held), held.size(), card);
  };
  EXPECT_EQ(refusal(loose), "accepted");
  EXPECT_NE(refusal(with("    1    2    1    0    1\n")).find("translation in x"), std::string::npos);
  EXPECT_NE(refusal(with("    1    4    3    1    0\n")).find("translation in y"), std::string::npos);
  EXPECT_NE(refusal(with("    1    1    1    1    1\n")).find("rotation"), std::string::npos);
}

}  // namespace
}  // namespace sage
