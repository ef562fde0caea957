// What a field looks like: elements as polygons with values, cut into bands of one colour.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sage/core/types.hpp"

namespace sage {

struct Corner {
  Vector2 at;
  double value = 0.0;
};

// A triangle, or a quadrilateral about its centre; indices of places.
struct GridCell {
  std::vector<int> corners;
  int centre = -1;  // -1: a triangle
};

// How a patch is cut, the same for many patches.
struct CellGrid {
  std::vector<int> outline;  // places around the patch
  std::vector<GridCell> cells;
};

// An element on the paper: values vary linearly within each triangle of its grid.
struct Patch {
  const CellGrid* grid = nullptr;
  std::vector<Corner> places;
  // Of one that is hardly larger than a point of the screen: the nodes at its places, all of which are its outline.
  // What such neighbours have in one colour is drawn as one.
  std::array<int, 4> nodes{-1, -1, -1, -1};
  bool tiny() const { return nodes[0] >= 0; }
};

// Whether values from `low` to `high` are one to the eye: what differs is rounding, or what an iteration left.
bool one_value(double low, double high);

// Round limits of the bands: the first at or below `low`, the last at or above `high`; at least two.
std::vector<double> band_limits(double low, double high, int bands);

// The places of a patch that `indices` name.
std::vector<Corner> polygon_of(const Patch& patch, const std::vector<int>& indices);

// The part of a polygon where value >= limit; values vary linearly along its edges.
std::vector<Corner> above(const std::vector<Corner>& polygon, double limit);

// SVG path data of every band, to be painted in this order: each band covers what is above its lower limit, and
// the next is painted over it, so that no gaps can show.
std::vector<std::string> band_paths(const std::vector<Patch>& patches, const std::vector<double>& limits);

// SVG path data of the lines where the values are a limit, for each limit.
std::vector<std::string> line_paths(const std::vector<Patch>& patches, const std::vector<double>& limits);

void append_path(std::string& path, const std::vector<Corner>& polygon);

}  // namespace sage
