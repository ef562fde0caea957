#include "sage/draw/contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sage/draw/plot.hpp"
#include "sage/draw/svg.hpp"

namespace sage {

bool one_value(double low, double high) {
  return !(high - low > 1e-5 * std::max(std::abs(low), std::abs(high)));
}

std::vector<double> band_limits(double low, double high, int bands) {
  if (one_value(low, high)) return {low, high};
  std::vector<double> limits = round_ticks(low, high, bands);
  if (limits.size() < 2) return {low, high};
  const double step = limits[1] - limits[0], slack = 1e-6 * step;
  if (limits.front() > low + slack) limits.insert(limits.begin(), limits.front() - step);
  if (limits.back() < high - slack) limits.push_back(limits.back() + step);
  return limits;
}

std::vector<Corner> above(const std::vector<Corner>& polygon, double limit) {
  std::vector<Corner> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.value >= limit) result.push_back(a);
    if ((a.value >= limit) != (b.value >= limit)) {
      const double t = (limit - a.value) / (b.value - a.value);
      result.push_back({a.at + t * (b.at - a.at), limit});
    }
  }
  return result;
}

namespace {

void append_place(std::string& path, char pen, const Vector2& at) {
  path += pen;
  svg::number(path, at.x());
  path += ' ';
  svg::number(path, at.y());
}

// at(i): the place of the i-th corner.
template <class At>
void append_closed(std::string& path, std::size_t corners, const At& at) {
  if (corners < 3) return;
  for (std::size_t i = 0; i < corners; ++i) append_place(path, i == 0 ? 'M' : 'L', at(i));
  path += 'Z';
}

}  // namespace

void append_path(std::string& path, const std::vector<Corner>& polygon) {
  append_closed(path, polygon.size(), [&](std::size_t i) -> const Vector2& { return polygon[i].at; });
}

std::vector<Corner> polygon_of(const Patch& patch, const std::vector<int>& indices) {
  std::vector<Corner> polygon;
  for (int i : indices) polygon.push_back(patch.places[static_cast<std::size_t>(i)]);
  return polygon;
}

namespace {

// As append_path(path, polygon_of(patch, indices)), without the polygon.
void append_places(std::string& path, const Patch& patch, const std::vector<int>& indices) {
  append_closed(path, indices.size(), [&](std::size_t i) -> const Vector2& {
    return patch.places[static_cast<std::size_t>(indices[i])].at;
  });
}

// The part of a cell where value >= limit: whole where it can be, else triangle by triangle.
void append_above(std::string& path, const Patch& patch, const GridCell& cell, double limit) {
  if (cell.centre < 0) return append_path(path, above(polygon_of(patch, cell.corners), limit));
  const auto is_above = [&](int i) { return patch.places[static_cast<std::size_t>(i)].value >= limit; };
  const auto count = std::ranges::count_if(cell.corners, is_above) + (is_above(cell.centre) ? 1 : 0);
  if (count == 0) return;
  if (count == static_cast<std::ptrdiff_t>(cell.corners.size()) + 1)
    return append_places(path, patch, cell.corners);
  const std::vector<Corner> polygon = polygon_of(patch, cell.corners);
  const Corner& centre = patch.places[static_cast<std::size_t>(cell.centre)];
  for (std::size_t i = 0; i < polygon.size(); ++i)
    append_path(path, above({polygon[i], polygon[(i + 1) % polygon.size()], centre}, limit));
}

}  // namespace

namespace {

// Where a triangle has the value: from edge to edge, nothing where it touches a corner alone.
void append_crossing(std::string& path, const std::array<const Corner*, 3>& triangle, double limit) {
  char pen = 'M';
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = *triangle[i], &b = *triangle[(i + 1) % 3];
    if ((a.value >= limit) == (b.value >= limit)) continue;
    const Vector2 at = a.at + (limit - a.value) / (b.value - a.value) * (b.at - a.at);
    append_place(path, pen, at);
    pen = 'L';
  }
}

void append_crossings(std::string& path, const Patch& patch, const GridCell& cell, double limit) {
  const auto corner = [&](std::size_t i) {
    return &patch.places[static_cast<std::size_t>(cell.corners[i % cell.corners.size()])];
  };
  if (cell.centre < 0) return append_crossing(path, {corner(0), corner(1), corner(2)}, limit);
  const Corner* const centre = &patch.places[static_cast<std::size_t>(cell.centre)];
  for (std::size_t i = 0; i < cell.corners.size(); ++i)
    append_crossing(path, {corner(i), corner(i + 1), centre}, limit);
}

}  // namespace

std::vector<std::string> line_paths(const std::vector<Patch>& patches, const std::vector<double>& limits) {
  std::vector<std::string> paths(limits.size());
  for (const Patch& patch : patches) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    bool known = true;
    for (const Corner& c : patch.places) {
      known = known && !std::isnan(c.value);
      low = std::min(low, c.value);
      high = std::max(high, c.value);
    }
    if (!known) continue;
    for (std::size_t k = 0; k < limits.size(); ++k)
      if (low < limits[k] && limits[k] <= high)
        for (const GridCell& cell : patch.grid->cells) append_crossings(paths[k], patch, cell, limits[k]);
  }
  return paths;
}

std::vector<std::string> band_paths(const std::vector<Patch>& patches, const std::vector<double>& limits) {
  std::vector<std::string> paths(std::max<std::size_t>(limits.size(), 2) - 1);
  for (const Patch& patch : patches) {
    if (patch.places.empty()) continue;
    const auto [low, high] =
        std::minmax_element(patch.places.begin(), patch.places.end(),
                            [](const Corner& a, const Corner& b) { return a.value < b.value; });
    std::size_t first = 0;  // the band of the lowest value: the whole element
    while (first + 1 < paths.size() && low->value >= limits[first + 1]) ++first;
    append_places(paths[first], patch, patch.grid->outline);
    for (std::size_t band = first + 1; band < paths.size() && high->value > limits[band]; ++band)
      for (const GridCell& cell : patch.grid->cells) append_above(paths[band], patch, cell, limits[band]);
  }
  return paths;
}

}  // namespace sage
