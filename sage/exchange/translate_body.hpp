// What decks of the families with a mesh of one kind of element share: rows of material values, lists of the
// elements' materials, nodal loads, and the cards that the model builder makes stages of.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/exchange/translate.hpp"

namespace sage::translate {

struct BodyNode {
  int number = 0;
  Vector2 x = Vector2::Zero();
  SourcePosition where;
};

struct BodyElement {
  std::vector<int> nodes;  // numbers: corners counter-clockwise, mid-side nodes edge by edge, inner nodes
  SourcePosition where;
};

struct Body {
  const Deck& deck;
  const Catalogue& catalogue;
  CardView card;  // that of the mesh
  bool axisymmetric = false, triangles = false;
  int nodes_per_element = 8;
  std::vector<BodyNode> nodes = {};
  std::vector<BodyElement> elements = {};  // number 1, 2, ...

  bool flows() const;         // water flows through it: heads are held, not displacements
  bool consolidates() const;  // and displaces it
};

[[noreturn]] void refuse(const Body& body, const CardView& card, std::string_view field,
                         const std::string& message);

// Of the card element_materials, one an element; 1 without that card.
std::vector<int> element_materials(const Body& body);

// Title, control, nodes, materials, groups (one a material) and elements.
void add_body(const Body& body, const std::vector<int>& material, const std::string& what, CardWriter& out);

// Loads, displacements and the cards that say how they come.  Forces of axisymmetric decks are for one radian.
void add_loading(const Body& body, CardWriter& out);

}  // namespace sage::translate
