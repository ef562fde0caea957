// Diagrams of the forces and moments along structures, over a picture of the mesh.
#pragma once

#include "sage/draw/scenery.hpp"

namespace sage {

// Behind the name of a force: the least and the largest of all stages.
inline constexpr std::string_view kEnvelopePicture = "_envelope";

// What a picture of this name shows along structures, a place in kEndQuantities; -1 = it shows no diagram.
int diagram_of(std::string_view picture);
bool is_envelope(std::string_view picture);

// An element with what it has at both ends.
struct DiagramElement {
  Vector2 at[2], side[2];  // on the paper; side: to the left of the way from node 1 to node 2
  double low[2] = {}, high[2] = {};
};

struct Diagram {
  int quantity = -1;
  bool envelope = false;  // of stages; else low and high are the same
  std::vector<DiagramElement> elements;
  double least = 0.0, largest = 0.0;
  double most =
      0.0;  // the size that kDiagramShare of the frame stands for: of the largest in it, or in several
};

// ends: of an envelope, by group and element.
Diagram make_diagram(const Scenery& scenery, std::string_view picture, const std::vector<EnvelopeEnd>* ends);

// Appends the diagram, and gives the line that explains it.
std::string draw_diagram(std::string& out, const Scenery& scenery, const Diagram& diagram);

}  // namespace sage
