// A section through ground and structures as the user draws it: points, lines and areas.  mesh_section() turns it into
// a SectionMesh (section_mesh.hpp).  No unit and no file format is known here.  Indices count from 0.
#pragma once

#include <string>
#include <vector>

#include "sage/core/types.hpp"

namespace sage {

struct SectionPoint {
  std::string name;  // for messages
  Vector2 x = Vector2::Zero();
  double size = 0.0;  // length of element edges there; 0 = no wish
};

enum class LineShape {
  polyline,  // straight from point to point, two points at least; the first again at the end closes it
  arc,       // points = {start, end} around `centre`, counter-clockwise unless `clockwise`
  circle,    // around `centre` with `radius`, from `start_angle` once around
};

// Which sides of a line get interface elements, left and right as seen along the line.  A beam without interfaces
// shares the nodes of the ground.  Without a beam one row of interface elements is a joint between the two bodies, whichever
// side is named.
enum class InterfaceSide { none, left, right, both };

// What becomes of a line with interfaces at an end inside the ground.  Ends on an outline, or on another line with
// interfaces, need no choice.
enum class LineEnd {
  automatic,  // joined for a beam with interfaces on both sides, else open
  joined,  // the ground is one node at the end, the beam there has a node of its own (the wall's toe may slip)
  tied,    // as joined; the beam's node and the ground's are listed in SectionMesh::ties
  open,    // the ground has two nodes at the end; they close at the next node of the mesh straight ahead
};

struct SectionLine {
  std::string name;
  LineShape shape = LineShape::polyline;
  std::vector<int> points;
  int centre = -1;           // a point, of arcs and circles
  double radius = 0.0;       // of circles
  double start_angle = 0.0;  // of circles, radians, counter-clockwise from the x axis
  bool clockwise = false;    // of arcs and circles
  double size = 0.0;         // length of element edges along it; 0 = no wish
  bool beam = false;  // a wall, slab, raft, lining or geogrid: the line has nodes in an order for beams or bars
  InterfaceSide interface = InterfaceSide::none;
  LineEnd first_end = LineEnd::automatic, last_end = LineEnd::automatic;
};

// A part of an outline: a corner, or a whole line in either direction.
struct OutlinePart {
  int point = -1;
  int line = -1;
};

// Parts in their order around, either way.  A straight edge joins each part to the next, and the last to the first,
// where their ends are apart.
using Outline = std::vector<OutlinePart>;

struct SectionArea {
  std::string name;
  Outline outline;
  std::vector<Outline> holes =
      {};             // may touch the outline or lie on it in part (a tunnel on the axis of symmetry)
  double size = 0.0;  // longest element edge in it; 0 = no wish
};

enum class ElementShape { triangle, quadrilateral };

// Points, lines and areas may meet and cross anywhere: lines cross areas, corners of one area lie on an edge of the
// next.  Areas must not overlap.  Lines lie inside areas or on their outlines; those with a beam may stick out.
struct Section {
  std::vector<SectionPoint> points;
  std::vector<SectionLine> lines;
  std::vector<SectionArea> areas;
  double size = 0.0;  // where nothing else is wished; 0 = a twentieth of the section's diagonal
  ElementShape shape = ElementShape::triangle;
  int nodes_per_edge = 3;  // 2: tri3, quad4; 3: tri6, quad8
};

enum class Mesher {
  automatic,  // blocks for quadrilaterals where every area is made of blocks as it stands; else Gmsh; without it blocks
  gmsh,
  blocks,  // areas of four sides with opposite sides alike; sections of horizontal and vertical lines are cut into such
};

struct MeshSettings {
  double size_factor = 1.0;  // of all sizes: .5 halves the elements' edges
  double growth = 0.35;      // by which sizes grow with the distance from where a small one is wished
  Mesher mesher = Mesher::automatic;
};

}  // namespace sage
