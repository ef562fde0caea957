// A truss of two bars, for elements of one's own.
#pragma once

#include "tests/studies/scenes/deck_writer.hpp"

namespace sage::test {

// Two bars of length 5 from supports at (-3, 4) and (3, 4) to node 3 at (0, 0), in the group 1; EA = 200.  Codes: of the
// element, and of tests/install/consumer/bar.hpp's law.
inline scenes::DeckWriter two_bars(int element, int law) {
  scenes::DeckWriter deck(1);
  deck.node(1, -3.0, 4.0);
  deck.node(2, 3.0, 4.0);
  deck.node(3, 0.0, 0.0);
  deck.material(1, law, {1000.0, 0.2});
  deck.group(1, element, 0, 1);
  deck.element(1, 1, {1, 3});
  deck.element(2, 1, {3, 2});
  for (const int node : {1, 2}) deck.fix(node, 1, 1);
  return deck;
}

}  // namespace sage::test
