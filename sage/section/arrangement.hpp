// The section cut where its lines and outlines meet: pieces that share no more than their ends, and the faces
// between them.  Not part of the public interface.
#pragma once

#include <vector>

#include "sage/section/curve.hpp"
#include "sage/section/section_mesh.hpp"

namespace sage::section {

struct Piece {
  int first = -1, last = -1;  // vertices
  Curve curve;                // from first to last
  double size = 0.0;          // smallest wish of the lines on it; 0 = none
};

// A piece passed in one of its directions.
struct Way {
  int piece = -1;
  bool back = false;
};

// A closed way around a face, the face to its left.
using Cycle = std::vector<Way>;

struct Face {
  int area = -1;  // -1: none
  Cycle outer;    // dangling pieces are passed twice, once in each direction
  std::vector<Cycle> inner;
  std::vector<int> vertices;  // points of the user inside the face
};

struct Arrangement {
  double tolerance = 0.0;
  std::vector<Vector2> vertices;
  std::vector<int> vertex_of_point;  // by point of the section
  std::vector<char> isolated;        // by vertex: a point on no piece that is to be a node
  std::vector<Piece> pieces;
  std::vector<std::vector<Way>> lines;  // by line of the section
  struct Loop {
    int area = -1;
    bool hole = false;
    int index = 0;  // of the hole
    std::vector<Way> ways;
  };
  std::vector<Loop> loops;
  std::vector<Face> faces;               // those in areas and those between
  std::vector<std::array<int, 2>> side;  // by piece: the face to its left and to its right, -1 outside of all

  int first_of(Way way) const {
    const Piece& piece = pieces[way.piece];
    return way.back ? piece.last : piece.first;
  }
  int last_of(Way way) const {
    const Piece& piece = pieces[way.piece];
    return way.back ? piece.first : piece.last;
  }
  int face_left_of(Way way) const { return side[way.piece][way.back ? 1 : 0]; }
  int area_left_of(Way way) const {
    const int face = face_left_of(way);
    return face < 0 ? -1 : faces[face].area;
  }
};

// Curves of a line in their order; empty where its data are incomplete.
std::vector<Curve> curves_of(const Section& section, const SectionLine& line);

using Faults = std::vector<SectionFault>;

// What can be seen without geometry: indices, numbers of points, sizes.
void check_data(const Section& section, Faults& faults);

// Needs complete data.  `cuts` are further straight curves, of no line.  Adds faults of outlines, areas and lines.
Arrangement arrange(const Section& section, const std::vector<Curve>& cuts, Faults& faults);

// Fills faces and side from pieces and loops.
void find_faces(const Section& section, Arrangement& arrangement, Faults& faults);

// "line wall"; "line 3" (counted from 1) where it has no name.
std::string name_of(const Section& section, SectionItem item, int index);
std::string text_of(const Vector2& x);  // "(1.5, 2)"

}  // namespace sage::section
