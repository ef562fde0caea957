// The mesh of a section: nodes split along lines with interfaces, and what lies along each line.  Indices of nodes,
// elements and edges count from 0; areas, lines and points are in the order of the Section.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sage/messages/error.hpp"
#include "sage/section/section.hpp"

namespace sage {

// Nodes of all elements one after the other: corners counter-clockwise, then the middle nodes of sides 1-2, 2-3, ...
struct AreaMesh {
  std::vector<int> nodes;  // SectionMesh::nodes_per_element() for each element
};

// An edge of an element of an area.  Edge k goes from corner k to corner k + 1 (the card's edge k + 1).
struct AreaEdge {
  int area = -1;  // -1: no body there
  int element = -1;
  int edge = -1;
  bool there() const { return area >= 0; }
};

// A piece of a line as long as an element's edge.
struct LineSegment {
  AreaEdge left, right;  // of the bodies on both sides of the line's direction
};

// On a segment of a line.  Nodes as a card has them: 1 2 along the line on the body to its right, 3 4 back on the body
// to its left, then the middle pair (right, left).  One of the bodies may be the line's beam.
struct InterfaceElement {
  int segment = 0;
  std::array<int, 6> nodes{-1, -1, -1, -1, -1, -1};  // the last two only with nodes on the middle of edges
};

// All lists of nodes have segments * (nodes_per_edge - 1) + 1 entries in the order along the line, middle nodes
// between their ends; of a closed line the last is the first again.
struct LineMesh {
  std::vector<LineSegment> segments;
  std::vector<int> left,
      right;               // nodes of the bodies; -1 where there is none.  The same where they are not split;
                           // where another line ends at this one, those of the segment that follows
  std::vector<int> beam;   // empty without a beam
  std::vector<int> nodes;  // all nodes on the line, of bodies and beams, each once: for supports
  std::vector<InterfaceElement> left_interfaces;   // between the body on the left and the beam, or joints
  std::vector<InterfaceElement> right_interfaces;  // between the beam and the body on the right
};

struct PointMesh {
  // At its place, that of beams first, then those of bodies.  Empty for a point on no area and no beam (a centre).
  std::vector<int> nodes;
  int beam = -1;  // the one that beams have there
};

// Two nodes at one place that should move as one but must be two, since the pairs of an interface are two nodes.
struct NodePair {
  enum class Kind {
    toe,   // the end of a beam inside the ground, asked for by LineEnd::tied
    end,   // the joined end of a line with interfaces but no beam: `second` belongs to nothing else
    bond,  // a beam on the side that has no interfaces, where another line with interfaces meets it
  };
  int first = -1, second = -1;
  int line = -1;
  Kind kind = Kind::toe;
};

struct SectionMesh {
  std::vector<Vector2> x;  // by node
  std::vector<AreaMesh> areas;
  std::vector<LineMesh> lines;
  std::vector<PointMesh> points;
  std::vector<NodePair> ties;
  ElementShape shape = ElementShape::triangle;
  int nodes_per_edge = 3;
  bool by_gmsh = false;

  int corners() const { return shape == ElementShape::triangle ? 3 : 4; }
  int nodes_per_element() const { return corners() * (nodes_per_edge - 1); }
};

enum class SectionItem { section, point, line, area };

// Something that can't be meshed.  Messages name the item; a reader adds the place in the file.
struct SectionFault {
  Code code;
  SectionItem item = SectionItem::section;
  int index = 0;
  std::string message;
};

class SectionError : public CodedError {
 public:
  explicit SectionError(std::vector<SectionFault> faults);
  const std::vector<SectionFault>& faults() const { return faults_; }  // at least one; what() is the first

 private:
  std::vector<SectionFault> faults_;
};

// All that is wrong with the drawing, as far as it can be known without a mesh.
std::vector<SectionFault> check_section(const Section& section);

// Throws SectionError for what check_section finds, for areas that need Gmsh where it is missing, and where Gmsh fails.  The
// same input gives the same mesh.  One thread at a time: Gmsh has global state.
SectionMesh mesh_section(const Section& section, const MeshSettings& settings = {});

// Whether Gmsh can be loaded; `reason` gets why not.
bool gmsh_available(std::string* reason = nullptr);

}  // namespace sage
