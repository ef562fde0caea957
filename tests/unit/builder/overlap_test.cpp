// Solids that cover the same ground without a common edge: refused, and what only touches is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sage/app/commands.hpp"
#include "sage/messages/error.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// A deck of loose pieces; every node is held, so that nothing else is wrong with them.
struct Pieces {
  DeckWriter deck{1};
  int nodes = 0, elements = 0;
  double turn = 0.0;  // of the whole picture

  Pieces() {
    deck.material(1, 1, {2e4, 0.3});
    deck.group(1, 1, 0, 1);
    deck.group(2, 1, 0, 1);
    deck.group(3, 2, 0, 1);
    deck.stage().load(1, 1.0, 0.0);
  }
  int node(double x, double y) {
    deck.node(++nodes, x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn));
    deck.fix(nodes, 1, 1);
    return nodes;
  }
  int element(int group, const std::vector<int>& list) {
    deck.element(++elements, group, list);
    return elements;
  }
  // [x0, x1] x [y0, y1] with nodes of its own.
  int rectangle(double x0, double x1, double y0, double y1, int group = 1) {
    return element(group, {node(x0, y0), node(x1, y0), node(x1, y1), node(x0, y1)});
  }
  // columns x rows of squares of this size, their lower left corner at (x, y).
  void mesh(int columns, int rows, double x, double y, double size) {
    Block block;
    block.columns = columns;
    block.rows = rows;
    block.first_node = nodes + 1;
    block.first_element = elements + 1;
    block.place = scenes::rectangle(x, x + columns * size, y, y + rows * size);
    block.write_nodes(deck);
    block.write_elements(deck, 1);
    for (int n = 1; n <= block.across() * block.up(); ++n) deck.fix(nodes + n, 1, 1);
    nodes += block.across() * block.up();
    elements += columns * rows;
  }
  // A ring's piece from the angle a to b, in degrees, with mid-side nodes on the arcs or without.
  int arch(double inner, double outer, double a, double b, bool curved) {
    const auto at = [&](double r, double angle) {
      const double radians = angle * std::acos(-1.0) / 180.0;
      return node(r * std::cos(radians), r * std::sin(radians));
    };
    std::vector<int> list{at(inner, a), at(outer, a), at(outer, b), at(inner, b)};
    if (curved)
      for (const int mid : {at(0.5 * (inner + outer), a), at(outer, 0.5 * (a + b)),
                            at(0.5 * (inner + outer), b), at(inner, 0.5 * (a + b))})
        list.push_back(mid);
    return element(curved ? 3 : 1, list);
  }
};

// The first error; empty where the deck becomes a model.
std::string refusal(const Pieces& pieces) {
  try {
    app::make_workbench().build(pieces.deck.text());
  } catch (const InputError& error) {
    for (const Diagnostic& one : error.diagnostics().list())
      if (one.severity == Severity::error) return one.message;
    return "no error";
  }
  return {};
}

void expect_overlap(const Pieces& pieces, const std::string& first, const std::string& second) {
  const std::string message = refusal(pieces);
  EXPECT_NE(message.find("elements " + first + " (card of line "), std::string::npos) << message;
  EXPECT_NE(message.find(") and " + second + " (card of line "), std::string::npos) << message;
  EXPECT_NE(message.find(") overlap: both cover the same ground"), std::string::npos) << message;
}

// By half its width, along an edge of the other; a tenth of it is still a slip.
TEST(Overlap, AnElementShiftedUponItsNeighbour) {
  for (const double shift : {0.5, 0.1, 0.9})
    for (const double turn : {0.0, 0.7}) {
      Pieces pieces;
      pieces.turn = turn;
      pieces.rectangle(0.0, 1.0, 0.0, 1.0);
      pieces.rectangle(1.0 - shift, 2.0 - shift, 0.0, 1.0);
      expect_overlap(pieces, "1", "2");
    }
}

TEST(Overlap, InsideALargeOneOrInAMesh) {
  Pieces inside;
  inside.rectangle(0.0, 10.0, 0.0, 10.0);
  inside.rectangle(4.0, 4.1, 7.0, 7.1);
  expect_overlap(inside, "1", "2");

  Pieces in_a_mesh;  // no edge of the mesh near it is bare
  in_a_mesh.mesh(20, 20, 0.0, 0.0, 1.0);
  in_a_mesh.rectangle(10.2, 10.8, 7.2, 7.8);
  expect_overlap(in_a_mesh, "151", "401");  // row 8 from below, column 11

  Pieces mesh_in_one;  // the large one's edges lie over elements without a bare edge
  mesh_in_one.mesh(20, 20, 0.0, 0.0, 1.0);
  mesh_in_one.rectangle(7.0, 9.0, 7.0, 9.0);
  expect_overlap(mesh_in_one, "148", "401");
}

// No corner of one lies in the other.
TEST(Overlap, TwoThatCross) {
  for (const double at : {0.0, -3.0, 4.5}) {
    Pieces pieces;
    pieces.rectangle(-10.0, 10.0, -0.2, 0.2);
    pieces.rectangle(at - 0.2, at + 0.2, -5.0, 15.0);
    expect_overlap(pieces, "1", "2");
  }
}

// Of many the first few are named, the others counted.
TEST(Overlap, ManyAreOneMessage) {
  Pieces pieces;
  for (int i = 0; i < 12; ++i) {
    pieces.rectangle(3.0 * i, 3.0 * i + 1.0, 0.0, 1.0);
    pieces.rectangle(3.0 * i + 0.5, 3.0 * i + 1.5, 0.0, 1.0);
  }
  expect_overlap(pieces, "1", "2");
  const std::string message = refusal(pieces);
  EXPECT_NE(message.find("; so do 3 and 4, 5 and 6, and 9 more pairs"), std::string::npos) << message;
}

// Edges that coincide without common nodes, corners on edges, edges of different length.
TEST(Overlap, WhatTouchesDoesNot) {
  for (const double turn : {0.0, 0.7}) {
    Pieces pieces;
    pieces.turn = turn;
    pieces.rectangle(0.0, 1.0, 0.0, 1.0);
    pieces.rectangle(1.0, 2.0, 0.0, 1.0);
    pieces.rectangle(0.5, 1.7, 1.0, 2.0);
    pieces.rectangle(2.0, 2.5, 0.3, 0.6);
    pieces.rectangle(-40.0, 0.0, -20.0, 20.0);
    EXPECT_EQ(refusal(pieces), "");
  }
}

TEST(Overlap, InterfacesLieOnEdges) {
  Pieces pieces;
  pieces.deck.material(2, 22, {5.0, 20.0, 0.0, 0.8, 12000.0, 0.0, 1e6, 1e6, 10.0, 2.0});
  pieces.deck.group(4, 11, 2, 2);
  pieces.rectangle(0.0, 1.0, 0.0, 1.0);
  pieces.rectangle(0.0, 1.0, 1.0, 2.0);
  pieces.element(4, {4, 3, 6, 5});
  EXPECT_EQ(refusal(pieces), "");
}

// Rings of arcs with mid-side nodes and of their chords: 4.9 % of the chord at 22.5 degrees, within what is
// allowed of a width like it; at 60 degrees the arc is 13 % high, and the ring is not thicker than the chord.
TEST(Overlap, ArcsAndChordsOfOneCircle) {
  const auto rings = [](double step, double thickness) {
    Pieces pieces;
    for (double a = 0.0; a < 89.0; a += step) {
      pieces.arch(1.0 - thickness, 1.0, a, a + step, true);
      pieces.arch(1.0, 1.0 + thickness, a, a + step, false);
    }
    return refusal(pieces);
  };
  EXPECT_EQ(rings(22.5, 0.4), "");
  EXPECT_EQ(rings(15.0, 0.3), "");
  EXPECT_EQ(rings(7.5, 0.1), "");
  EXPECT_NE(rings(45.0, 0.2).find("overlap"), std::string::npos);
}

// Thin arcs, one around the other, each a hundredth of the radius thick and bent to the edge of what an element can be:
// the middle of their corners lies outside them.
TEST(Overlap, ThinArcsLieOnEachOther) {
  for (const double step : {11.25, 22.5, 45.0})
    for (const double inner : {0.5, 0.99})
      for (const bool shared : {false, true}) {
        Pieces pieces;
        for (double a = 0.0; a < 89.0; a += step) {
          const int first = pieces.nodes;
          pieces.arch(inner, 1.0, a, a + step, true);
          if (!shared) {
            pieces.arch(1.0, 1.01, a, a + step, true);
            continue;
          }
          // The outer side of the arch below is corners 2 and 3 and middle 6.
          const auto at = [&](double r, double angle) {
            const double radians = angle * std::acos(-1.0) / 180.0;
            return pieces.node(r * std::cos(radians), r * std::sin(radians));
          };
          const int low = at(1.01, a), high = at(1.01, a + step), middle = at(1.01, a + 0.5 * step);
          pieces.element(
              3, {first + 2, low, high, first + 3, at(1.005, a), middle, at(1.005, a + step), first + 6});
        }
        EXPECT_EQ(refusal(pieces), "")
            << step << " degrees, from " << inner << (shared ? ", common nodes" : "");
      }
  Pieces thinnest;
  thinnest.arch(0.99, 1.0, 0.0, 22.5, true);
  thinnest.arch(1.0, 1.002, 0.0, 22.5, true);
  EXPECT_EQ(refusal(thinnest), "");
  Pieces over;  // by half of the thin one's thickness
  over.arch(0.5, 1.005, 0.0, 22.5, true);
  over.arch(1.0, 1.01, 0.0, 22.5, true);
  expect_overlap(over, "1", "2");
}

// With nodes of their own, whatever their shape.
TEST(Overlap, TheSamePlaceTwice) {
  for (const double turn : {0.0, 0.7}) {
    Pieces skewed;
    skewed.turn = turn;
    for (int i = 0; i < 2; ++i)
      skewed.element(
          1, {skewed.node(0.0, 0.0), skewed.node(2.0, 0.3), skewed.node(2.4, 1.1), skewed.node(0.2, 0.9)});
    expect_overlap(skewed, "1", "2");
  }
  Pieces arches;
  arches.arch(0.99, 1.0, 0.0, 45.0, true);
  arches.arch(0.99, 1.0, 0.0, 45.0, true);
  expect_overlap(arches, "1", "2");
}

// A curved element that bulges into a straight one's place, by its mid-side node alone.
TEST(Overlap, AMidSideNodeThatReachesIntoANeighbour) {
  const auto bulge = [](double height) {
    Pieces pieces;
    pieces.rectangle(0.0, 1.0, 0.0, 1.0);
    const std::vector<int> list{pieces.node(1.0, 0.0), pieces.node(2.0, 0.0),         pieces.node(2.0, 1.0),
                                pieces.node(1.0, 1.0), pieces.node(1.5, 0.0),         pieces.node(2.0, 0.5),
                                pieces.node(1.5, 1.0), pieces.node(1.0 - height, 0.5)};
    pieces.element(3, list);
    return refusal(pieces);
  };
  EXPECT_EQ(bulge(0.0), "");
  EXPECT_EQ(bulge(0.04), "");
  EXPECT_NE(bulge(0.2).find("overlap"), std::string::npos);
}

// On purpose: pore water in soil, and a body that comes when another has gone.
TEST(Overlap, OverlaysAndTwinsMay) {
  Pieces water;
  water.rectangle(0.0, 1.0, 0.0, 1.0);
  water.rectangle(0.5, 1.5, 0.0, 1.0, 2);
  EXPECT_NE(refusal(water).find("overlay 1"), std::string::npos);
  std::string& card = water.deck.groups[1];
  card.resize(60, ' ');
  card += "    1";
  EXPECT_EQ(refusal(water), "");
  // Another mark than 0 and 1 is none.
  card.replace(card.size() - 5, 5, "    2");
  EXPECT_NE(refusal(water).find("can't be 2"), std::string::npos);

  Pieces twins;
  twins.deck.group(4, 1, 0, 1);
  twins.rectangle(0.0, 1.0, 0.0, 1.0, 4);
  twins.rectangle(0.5, 1.5, 0.0, 1.0, 2);
  twins.rectangle(5.0, 6.0, 0.0, 1.0);
  StageCards& stage = twins.deck.stage();
  stage.deaths = {4};
  stage.births = {2};
  EXPECT_EQ(refusal(twins), "");
}

// Water in soil counts as the soil's neighbour where its group does not say that it lies there: boundaries would be none.
TEST(Overlap, WaterInSoilSaysSo) {
  Pieces pieces;
  pieces.deck.material(2, 41, {1e-6});
  pieces.deck.group(4, 41, 0, 2);
  const std::vector<int> corners{pieces.node(0, 0), pieces.node(1, 0), pieces.node(1, 1), pieces.node(0, 1)};
  pieces.element(1, corners);
  pieces.element(4, {corners[2], corners[3], corners[0], corners[1]});
  EXPECT_NE(refusal(pieces).find("water flows through element 2 on the nodes of a solid"), std::string::npos);
  std::string& card = pieces.deck.groups[3];
  card.resize(60, ' ');
  card += "    1";
  EXPECT_EQ(refusal(pieces), "");
}

// Rectangles with whole coordinates up to 12 units long overlap by a twelfth of their width or not at all: compared
// with their intervals.  Small and large ones, so that some lie over many cells of the search and some beside.
TEST(Overlap, AgreesWithIntervals) {
  std::mt19937 random(15);
  int with = 0, without = 0;
  for (int trial = 0; trial < 150; ++trial) {
    struct Sides {
      int x0, x1, y0, y1;
    };
    std::vector<Sides> all;
    Pieces pieces;
    pieces.turn = trial % 3 == 0 ? 0.0 : 0.3 * trial;
    const auto lot = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (int i = 0, count = 2 + lot(30); i < count; ++i) {
      const int x = lot(150), y = lot(150), most = lot(8) == 0 ? 12 : 4;
      all.push_back({x, x + 1 + lot(most), y, y + 1 + lot(most)});
      pieces.rectangle(x, all.back().x1, y, all.back().y1);
    }
    int pairs = 0;
    std::pair<std::size_t, std::size_t> first;
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        const Sides &a = all[i], &b = all[k];
        if (std::max(a.x0, b.x0) >= std::min(a.x1, b.x1) || std::max(a.y0, b.y0) >= std::min(a.y1, b.y1))
          continue;
        if (++pairs == 1) first = {i + 1, k + 1};
      }
    ++(pairs > 0 ? with : without);
    if (pairs == 0)
      EXPECT_EQ(refusal(pieces), "") << "trial " << trial;
    else
      expect_overlap(pieces, std::to_string(first.first), std::to_string(first.second));
  }
  EXPECT_GT(with, 20);
  EXPECT_GT(without, 20);
}

}  // namespace
}  // namespace sage::test
