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
  for (int i : indices) polygon.push_back(patch.places[i]);
  return polygon;
}

namespace {

// As append_path(path, polygon_of(patch, indices)), without the polygon.
void append_places(std::string& path, const Patch& patch, const std::vector<int>& indices) {
  append_closed(path, indices.size(),
                [&](std::size_t i) -> const Vector2& { return patch.places[indices[i]].at; });
}

// The part of a cell where value >= limit: whole where it can be, else triangle by triangle.
void append_above(std::string& path, const Patch& patch, const GridCell& cell, double limit) {
  if (cell.centre < 0) return append_path(path, above(polygon_of(patch, cell.corners), limit));
  const auto is_above = [&](int i) { return patch.places[i].value >= limit; };
  const auto count = std::ranges::count_if(cell.corners, is_above) + (is_above(cell.centre) ? 1 : 0);
  if (count == 0) return;
  if (count == static_cast<std::ptrdiff_t>(cell.corners.size()) + 1)
    return append_places(path, patch, cell.corners);
  const std::vector<Corner> polygon = polygon_of(patch, cell.corners);
  const Corner& centre = patch.places[cell.centre];
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
  const auto corner = [&](std::size_t i) { return &patch.places[cell.corners[i % cell.corners.size()]]; };
  if (cell.centre < 0) return append_crossing(path, {corner(0), corner(1), corner(2)}, limit);
  const Corner* const centre = &patch.places[cell.centre];
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

namespace {

// A side of a tiny patch, in the sense of its outline.
struct Side {
  int from = 0, to = 0, band = 0;
  Vector2 at = Vector2::Zero();  // of `from`
  int low() const { return std::min(from, to); }
};

// By their lower nodes, so that the two of one place stand near one another.
std::vector<Side> by_low(const std::vector<Side>& sides, std::vector<std::size_t>& first) {
  int most = -1;
  for (const Side& side : sides) most = std::max(most, side.low());
  first.assign(static_cast<std::size_t>(most) + 2, 0);
  for (const Side& side : sides) ++first[static_cast<std::size_t>(side.low()) + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<std::size_t> next(first);
  std::vector<Side> sorted(sides.size());
  for (const Side& side : sides) sorted[next[side.low()]++] = side;
  return sorted;
}

// Those where the region of a band's patches ends, for each band: where the patch beyond has another or there is none.
std::vector<std::vector<Side>> region_sides(const std::vector<Side>& sides, std::size_t bands) {
  std::vector<std::vector<Side>> ends(bands);
  std::vector<std::size_t> first;
  std::vector<Side> all = by_low(sides, first);
  for (std::size_t node = 0; node + 1 < first.size(); ++node)
    for (std::size_t i = first[node]; i < first[node + 1]; ++i) {
      int beyond = -1;
      for (std::size_t j = first[node]; j < first[node + 1]; ++j)
        if (all[j].from == all[i].to && all[j].to == all[i].from) beyond = all[j].band;
      if (beyond != all[i].band) ends[all[i].band].push_back(all[i]);
    }
  return ends;
}

// A closed line without the places that lie on the way between their neighbours.
void append_loop(std::string& path, const std::vector<Vector2>& loop) {
  constexpr double kNear = 0.01;  // px
  constexpr std::size_t kMostPassed = 16;
  std::vector<Vector2> kept;
  std::size_t passed = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2& next = loop[(i + 1) % loop.size()];
    if (!kept.empty() && passed < kMostPassed) {
      const Vector2 way = next - kept.back(), to = loop[i] - kept.back();
      const double across = std::abs(way.x() * to.y() - way.y() * to.x()), along = way.dot(to);
      ++passed;
      if (across <= kNear * way.norm() && along >= 0.0 && along <= way.squaredNorm()) continue;
    }
    kept.push_back(loop[i]);
    passed = 0;
  }
  append_closed(path, kept.size(), [&](std::size_t i) -> const Vector2& { return kept[i]; });
}

// Sides one behind the other, as closed lines.
void append_loops(std::string& path, std::vector<Side> sides) {
  std::ranges::stable_sort(sides, {}, &Side::from);
  std::vector<char> used(sides.size(), 0);
  const auto next_of = [&](int node) {
    auto at = static_cast<std::size_t>(std::ranges::lower_bound(sides, node, {}, &Side::from) - sides.begin());
    while (at < sides.size() && sides[at].from == node && used[at] != 0) ++at;
    return at < sides.size() && sides[at].from == node ? at : sides.size();
  };
  for (std::size_t begin = 0; begin < sides.size(); ++begin) {
    if (used[begin] != 0) continue;
    std::vector<Vector2> loop;
    for (std::size_t at = begin; at < sides.size(); at = next_of(sides[at].to)) {
      used[at] = 1;
      loop.push_back(sides[at].at);
    }
    append_loop(path, loop);
  }
}

void add_sides(std::vector<Side>& sides, const Patch& patch, std::size_t band) {
  const std::size_t n = patch.places.size();
  for (std::size_t i = 0; i < n; ++i)
    sides.push_back({patch.nodes[i], patch.nodes[(i + 1) % n], static_cast<int>(band), patch.places[i].at});
}

}  // namespace

std::vector<std::string> band_paths(const std::vector<Patch>& patches, const std::vector<double>& limits) {
  std::vector<std::string> paths(std::max<std::size_t>(limits.size(), 2) - 1);
  std::vector<Side> sides;  // of tiny patches
  for (const Patch& patch : patches) {
    if (patch.places.empty()) continue;
    const auto [low, high] =
        std::minmax_element(patch.places.begin(), patch.places.end(),
                            [](const Corner& a, const Corner& b) { return a.value < b.value; });
    std::size_t first = 0;  // the band of the lowest value: the whole element
    while (first + 1 < paths.size() && low->value >= limits[first + 1]) ++first;
    if (patch.tiny())
      add_sides(sides, patch, first);
    else
      append_places(paths[first], patch, patch.grid->outline);
    for (std::size_t band = first + 1; band < paths.size() && high->value > limits[band]; ++band)
      for (const GridCell& cell : patch.grid->cells) append_above(paths[band], patch, cell, limits[band]);
  }
  if (sides.empty()) return paths;
  std::vector<std::vector<Side>> ends = region_sides(sides, paths.size());
  for (std::size_t band = 0; band < paths.size(); ++band) append_loops(paths[band], std::move(ends[band]));
  return paths;
}

}  // namespace sage
