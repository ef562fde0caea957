// Solids that cover the same ground.
//
// How often a mesh of counter-clockwise elements covers a place is the winding number of its bare edges (those
// that no neighbour has the other way round): where two elements overlap, one that overlaps another has a bare
// edge.  So only elements with bare edges are held against those around them, and a sound mesh has few.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "sage/builder/builder.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/coarse_shape.hpp"

namespace sage::builder {

namespace {

// Solids may reach into each other by so much of the thinner one's width.  Chords of a circle that two meshes
// divide differently do: the arc over a chord of 22.5 degrees is 4.9 % of it high, and sides with and without
// mid-side nodes differ by that.  Rounded coordinates differ by less, and slips by more.
constexpr double kReach = 0.06;

constexpr std::size_t kMostFound = 1000;  // pairs: then the search ends
constexpr std::size_t kShown = 3;
constexpr std::int64_t kManyCells = 64;  // under one element: it is held apart
constexpr double kElementsPerCell = 2.0;

struct Solid {
  int group = 0, element = 0;
  bool bare = false;
  bool operator==(const Solid& other) const { return group == other.group && element == other.element; }
  bool operator<(const Solid& other) const {
    return std::tie(group, element) < std::tie(other.group, other.element);
  }
};

struct Box {
  Vector2 low, high;
  bool meets(const Box& other) const {
    return low.x() < other.high.x() && other.low.x() < high.x() && low.y() < other.high.y() &&
           other.low.y() < high.y();
  }
};

// Groups that are active in one stage.  Those of which one goes before the other comes may lie on each other.
class StagesTogether {
 public:
  explicit StagesTogether(const Model& model) : model_(&model), active_(model.groups.size()) {
    Activity activity(model);
    for (const Stage& stage : model.stages) {
      activity.enter(stage);
      for (std::size_t g = 0; g < active_.size(); ++g) active_[g].push_back(activity.group[g]);
    }
  }
  bool together(int first, int second) const {
    const auto g = static_cast<std::size_t>(first), h = static_cast<std::size_t>(second);
    if (model_->groups[g].overlay != model_->groups[h].overlay) return false;
    for (std::size_t s = 0; s < active_[g].size(); ++s)
      if (active_[g][s] && active_[h][s]) return true;
    return false;
  }

 private:
  const Model* model_;
  std::vector<std::vector<char>> active_;  // by group, then by stage
};

// ---- Edges

// Edges of the mesh of which a solid lies on one hand only, and those that two have on the same hand.
class EdgeSearch {
 public:
  EdgeSearch(Builder& b, const StagesTogether& stages_together) : b_(b), stages_(stages_together) {
    for (int node = 0; node < b.model.mesh.nodes(); ++node) {
      const std::span<const SolidEdge> edges = b.solid_edges().at(node);
      for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].other == edges[begin].other) ++end;
        take(edges.subspan(begin, end - begin));
      }
    }
  }

  std::vector<SolidEdge> bare;
  int on_one_hand = 0;
  std::optional<std::pair<SolidEdge, SolidEdge>>
      first;  // the first that the deck's order has, its elder before it

 private:
  bool overlay(const SolidEdge& edge) const { return b_.model.groups[edge.group].overlay; }

  // All edges between two corners.
  void take(std::span<const SolidEdge> edges) {
    const bool neighbours = edges.size() == 2 && edges[0].reversed != edges[1].reversed;
    if (neighbours && (edges[0].group == edges[1].group || overlay(edges[0]) == overlay(edges[1]))) return;
    std::array<int, 2> surplus{};  // of plain groups, of those that lie on others
    for (const SolidEdge& edge : edges) surplus[overlay(edge) ? 1 : 0] += edge.reversed ? -1 : 1;
    for (const SolidEdge& edge : edges)
      if (surplus[overlay(edge) ? 1 : 0] != 0) bare.push_back(edge);
    for (std::size_t i = 1; i < edges.size(); ++i) compare(edges, i);
  }

  void compare(std::span<const SolidEdge> edges, std::size_t i) {
    const auto order = [](const SolidEdge& edge) { return std::tuple(edge.group, edge.element, edge.local); };
    const SolidEdge& edge = edges[i];
    const SolidEdge& owner =
        *std::ranges::find_if(edges, [&](const SolidEdge& other) { return other.reversed == edge.reversed; });
    if (&owner == &edge || !stages_.together(edge.group, owner.group)) return;
    ++on_one_hand;
    if (first && order(first->second) < order(edge)) return;
    first = {owner, edge};
  }

  Builder& b_;
  const StagesTogether& stages_;
};

// ---- Two solids

// The line around a solid, drawn together towards the middle of its parent shape: that stays within the solid
// where a thin one is curved.
class Outline {
 public:
  Outline(const Model& model, const Solid& solid) {
    const Group& group = model.groups[solid.group];
    const int* nodes = group.nodes_of(solid.element);
    const std::vector<std::vector<int>>& edges = group.element->edges();
    shape_.corners = static_cast<int>(edges.size());
    double longest = 0.0, twice_area = 0.0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const auto place = [&](std::size_t i) -> Vector2 { return model.mesh.x.col(nodes[edges[k][i]]); };
      longest = std::max(longest, (place(1) - place(0)).norm());
      shape_.corner[k] = place(0);
      if (const std::size_t between = edges[k].size() - 2; between > 0)
        shape_.middle[k] = place(2 + between / 2);
      if (shape_.middle[k])
        height_ = std::max(height_, (*shape_.middle[k] - 0.5 * (place(0) + place(1))).norm());
    }
    for (int k = 0; k < shape_.corners; ++k)
      for (std::size_t c = 0; c < 2; ++c)
        centre_[c] += parent_corners(shape_.corners)[static_cast<std::size_t>(k)][c] / shape_.corners;
    middle_ = shape_.at(centre_);
    trace(1.0, height_ > 0.0 ? 2 : 1);
    for (std::size_t i = 0; i < points_.size(); ++i)
      twice_area += cross(points_[i] - middle_, next(i) - middle_);
    width_ = 0.5 * twice_area / longest;
  }

  // Every side comes in by kReach of its distance from the middle; that of a solid wider than the other by less.
  // Chords of curved sides are short enough that their own height is a small part of that.
  void draw_in(double other_width) {
    constexpr double kFewest = 4.0, kMost = 64.0;
    const double thinner = std::min(width_, other_width),
                 chords = std::sqrt(8.0 * height_ / (kReach * thinner));
    trace(1.0 - kReach * thinner / width_,
          height_ > 0.0 ? static_cast<int>(std::clamp(chords, kFewest, kMost)) : 1);
  }

  double width() const { return width_; }  // area over the longest side

  bool overlaps(const Outline& other) const {
    const Vector2 between = other.middle_ - middle_;
    if (is_apart(other, between) || sides_part(other) || other.sides_part(*this)) return false;
    return crosses(other) || holds_any(other) || other.holds_any(*this);
  }

 private:
  static double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }
  const Vector2& next(std::size_t i) const { return points_[i + 1 < points_.size() ? i + 1 : 0]; }

  // Through the sides of the parent shape, `scale` times as large about its centre; curved ones in chords.
  void trace(double scale, int chords) {
    const auto n = static_cast<std::size_t>(shape_.corners);
    const std::array<Place, 4>& parent = parent_corners(shape_.corners);
    points_.clear();
    for (std::size_t k = 0; k < n; ++k)
      for (int i = 0; i < chords; ++i) {
        Place at{};
        for (std::size_t c = 0; c < 2; ++c) {
          const double on_side = parent[k][c] + (parent[(k + 1) % n][c] - parent[k][c]) * i / chords;
          at[c] = centre_[c] + scale * (on_side - centre_[c]);
        }
        points_.push_back(shape_.at(at));
      }
  }

  // All points of the other lie farther along the axis than all of these.
  bool is_apart(const Outline& other, const Vector2& axis) const {
    double most = -std::numeric_limits<double>::infinity(), least = -most;
    for (const Vector2& point : points_) most = std::max(most, axis.dot(point));
    for (const Vector2& point : other.points_) least = std::min(least, axis.dot(point));
    return most < least;  // of an axis without length none do
  }

  bool sides_part(const Outline& other) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector2 side = next(i) - points_[i];
      if (is_apart(other, Vector2(side.y(), -side.x()))) return true;
    }
    return false;
  }

  bool crosses(const Outline& other) const {
    for (std::size_t i = 0; i < points_.size(); ++i)
      for (std::size_t k = 0; k < other.points_.size(); ++k) {
        const Vector2 &a = points_[i], &b = next(i), &c = other.points_[k], &d = other.next(k);
        if (cross(b - a, c - a) * cross(b - a, d - a) < 0.0 && cross(d - c, a - c) * cross(d - c, b - c) < 0.0)
          return true;
      }
    return false;
  }

  // Of places within the other: sides that lie on each other cross nowhere.
  bool holds_any(const Outline& other) const {
    constexpr double kWithin = 0.9;
    if (holds(other.middle_)) return true;
    for (int k = 0; k < other.shape_.corners; ++k) {
      const Place& corner = parent_corners(other.shape_.corners)[static_cast<std::size_t>(k)];
      Place at{};
      for (std::size_t c = 0; c < 2; ++c) at[c] = other.centre_[c] + kWithin * (corner[c] - other.centre_[c]);
      if (holds(other.shape_.at(at))) return true;
    }
    return false;
  }

  // By the sides that a ray to the right meets.
  bool holds(const Vector2& place) const {
    bool inside = false;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector2 &a = points_[i], &b = next(i);
      if ((a.y() > place.y()) == (b.y() > place.y())) continue;
      if (place.x() < a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
  }

  CoarseShape shape_;
  Place centre_{};  // of the parent shape
  std::vector<Vector2> points_;
  Vector2 middle_;                     // a place within
  double width_ = 0.0, height_ = 0.0;  // height: of the most curved side's middle over its chord
};

// ---- All of them

class OverlapSearch {
 public:
  OverlapSearch(const Model& model, const StagesTogether& stages_together, const std::vector<SolidEdge>& bare)
      : model_(model), stages_(stages_together), bare_(model.groups.size()) {
    std::size_t solids = 0;
    for (const Group& group : model.groups) solids += group.solid() ? group.element_numbers.size() : 0;
    for (const SolidEdge& edge : bare) {
      std::vector<char>& of_group = bare_[edge.group];
      of_group.resize(model.groups[edge.group].element_numbers.size(), 0);
      of_group[edge.element] = 1;
    }
    lay_grid(solids);
  }

  std::vector<std::pair<Solid, Solid>> find() {
    mark();
    collect();
    for (std::size_t begin = 0, end = 0; begin < entries_.size() && !full(); begin = end) {
      while (end < entries_.size() && entries_[end].cell == entries_[begin].cell) ++end;
      compare_all(std::span(entries_).subspan(begin, end - begin));
    }
    for (const Entry& one : large_)
      if (!full()) compare_with_cells(one);
    compare_all(large_);
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }

  bool full() const { return found_.size() >= kMostFound; }

 private:
  struct Entry {
    std::int64_t cell = -1;  // -1: of a solid that is over many
    Solid solid;
    Box box;
  };
  struct Cells {
    std::int64_t left, right, bottom, top;
    std::int64_t count() const { return (right - left + 1) * (top - bottom + 1); }
  };

  void lay_grid(std::size_t solids) {
    const auto& x = model_.mesh.x;
    low_ = x.rowwise().minCoeff();
    const Vector2 size = x.rowwise().maxCoeff() - low_;
    const double cells = static_cast<double>(solids) / kElementsPerCell + 1.0;
    const double step = std::max(std::sqrt(size.x() * size.y() / cells), size.maxCoeff() / cells);
    for (Eigen::Index c = 0; c < 2; ++c) count_[c] = std::max<std::int64_t>(1, std::llround(size[c] / step));
    for (Eigen::Index c = 0; c < 2; ++c)
      scale_[c] = size[c] > 0.0 ? static_cast<double>(count_[c]) / size[c] : 0.0;
    marked_.assign(count_[0] * count_[1], 0);
  }

  std::int64_t place(double at, Eigen::Index c) const {
    return std::min(static_cast<std::int64_t>((at - low_[c]) * scale_[c]), count_[c] - 1);
  }
  Cells cells_of(const Box& box) const {
    return {place(box.low.x(), 0), place(box.high.x(), 0), place(box.low.y(), 1), place(box.high.y(), 1)};
  }

  // act(cell) for all of them.
  template <class Act>
  void for_cells(const Cells& cells, const Act& act) const {
    for (std::int64_t j = cells.bottom; j <= cells.top; ++j)
      for (std::int64_t i = cells.left; i <= cells.right; ++i) act(j * count_[0] + i);
  }

  Box box_of(const int* nodes, std::size_t count) const {
    Vector2 low = model_.mesh.x.col(nodes[0]), high = low;
    for (std::size_t i = 1; i < count; ++i) {
      const double x = model_.mesh.x(0, nodes[i]), y = model_.mesh.x(1, nodes[i]);
      low = {std::min(low.x(), x), std::min(low.y(), y)};
      high = {std::max(high.x(), x), std::max(high.y(), y)};
    }
    return {low, high};
  }

  bool is_bare(std::size_t group, int element) const {
    return !bare_[group].empty() && bare_[group][element] != 0;
  }

  // The cells in which there is something to compare; all, where that would be most of them.
  void mark() {
    std::size_t written = 0;
    const std::size_t most = 8 * marked_.size();
    for (std::size_t g = 0; g < bare_.size() && written <= most; ++g)
      for (int e = 0; e < static_cast<int>(bare_[g].size()) && written <= most; ++e) {
        if (!is_bare(g, e)) continue;
        const Cells cells = cells_of(box_of(model_.groups[g].nodes_of(e), model_.groups[g].node_count()));
        written += static_cast<std::size_t>(cells.count());
        for_cells(cells, [&](std::int64_t cell) { marked_[cell] = 1; });
      }
    if (written > most) marked_.assign(marked_.size(), 1);
  }

  void collect() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      const Group& group = model_.groups[g];
      if (!group.solid()) continue;
      const std::size_t nodes = group.node_count();
      for (int e = 0; e < group.elements(); ++e) {
        const Box box = box_of(group.nodes.data() + static_cast<std::size_t>(e) * nodes, nodes);
        const Cells cells = cells_of(box);
        const Solid solid{static_cast<int>(g), e, is_bare(g, e)};
        if (cells.count() > kManyCells)
          large_.push_back({-1, solid, box});
        else
          for_cells(cells, [&](std::int64_t cell) {
            if (marked_[cell]) entries_.push_back({cell, solid, box});
          });
      }
    }
    const auto order = [](const Entry& a, const Entry& b) {
      return std::pair(a.cell, a.box.low.x()) < std::pair(b.cell, b.box.low.x());
    };
    std::sort(entries_.begin(), entries_.end(), order);
    std::sort(large_.begin(), large_.end(), order);
  }

  // From the left to the right, each with those that begin before it ends.
  void compare_all(std::span<const Entry> list) {
    for (std::size_t i = 0; i < list.size() && !full(); ++i)
      for (std::size_t k = i + 1; k < list.size() && list[k].box.low.x() < list[i].box.high.x(); ++k)
        if (list[i].cell < 0 || is_first_cell(list[i], list[k])) compare(list[i], list[k]);
  }

  // Two that meet in several cells are compared in one.
  bool is_first_cell(const Entry& a, const Entry& b) const {
    if (!(a.solid.bare || b.solid.bare) || !a.box.meets(b.box)) return false;
    const Vector2 corner = a.box.low.cwiseMax(b.box.low);
    const std::int64_t cell = place(corner.y(), 1) * count_[0] + place(corner.x(), 0);
    return cell == a.cell;
  }

  void compare_with_cells(const Entry& one) {
    const Cells cells = cells_of(one.box);
    const auto before = [](const Entry& entry, std::int64_t cell) { return entry.cell < cell; };
    for (std::int64_t j = cells.bottom; j <= cells.top && !full(); ++j) {
      const std::int64_t row = j * count_[0];
      auto at = std::lower_bound(entries_.begin(), entries_.end(), row + cells.left, before);
      for (; at != entries_.end() && at->cell <= row + cells.right && !full(); ++at) compare(one, *at);
    }
  }

  void compare(const Entry& a, const Entry& b) {
    if (!(a.solid.bare || b.solid.bare) || !a.box.meets(b.box)) return;
    if (!stages_.together(a.solid.group, b.solid.group) || share_an_edge(a.solid, b.solid)) return;
    Outline one(model_, a.solid), two(model_, b.solid);
    const double first = one.width(), second = two.width();
    one.draw_in(second);
    two.draw_in(first);
    if (one.overlaps(two)) found_.emplace_back(std::min(a.solid, b.solid), std::max(a.solid, b.solid));
  }

  // Both lie on the same hand of a common edge, of which there is a message, or on either hand, as neighbours do.
  bool share_an_edge(const Solid& a, const Solid& b) const {
    const Group &g = model_.groups[a.group], &h = model_.groups[b.group];
    const int *n = g.nodes_of(a.element), *m = h.nodes_of(b.element);
    for (const std::vector<int>& edge : g.element->edges())
      for (const std::vector<int>& other : h.element->edges())
        if (std::minmax({n[edge[0]], n[edge[1]]}) == std::minmax({m[other[0]], m[other[1]]})) return true;
    return false;
  }

  const Model& model_;
  const StagesTogether& stages_;
  std::vector<std::vector<char>> bare_;  // by group, then by element; empty where none is
  Vector2 low_ = Vector2::Zero(), scale_ = Vector2::Zero();
  std::array<std::int64_t, 2> count_{1, 1};  // cells along x and y
  std::vector<char> marked_;
  std::vector<Entry> entries_, large_;
  std::vector<std::pair<Solid, Solid>> found_;
};

// ---- Messages

int line_of(const Model& model, int group, int element) {
  return model.groups[group].element_lines[element];
}

std::string number_of(const Model& model, int group, int element) {
  const Group& of = model.groups[group];
  return std::to_string(of.element_numbers[element]);
}

std::string with_line(const Model& model, const Solid& solid) {
  const int line = line_of(model, solid.group, solid.element);
  return number_of(model, solid.group, solid.element) +
         (line > 0 ? " (card of line " + std::to_string(line) + ")" : "");
}

void refuse_overlaps(Builder& b, const std::vector<std::pair<Solid, Solid>>& found) {
  const Model& model = b.model;
  const auto& [first, second] = found.front();
  std::string text = "elements " + with_line(model, first) + " and " + with_line(model, second) +
                     " overlap: both cover the same ground";
  for (std::size_t i = 1; i < std::min(kShown, found.size()); ++i)
    text += (i == 1 ? "; so do " : ", ") + number_of(model, found[i].first.group, found[i].first.element) +
            " and " + number_of(model, found[i].second.group, found[i].second.element);
  if (found.size() > kShown)
    text += ", and " + std::string(found.size() >= kMostFound ? "at least " : "") +
            std::to_string(found.size() - kShown) + " more pairs";
  b.error("S326", b.at_line(line_of(model, second.group, second.element)),
          text + " (a group that lies on others on purpose says so: overlay 1)");
}

// Elements of water on those of soil, of a group that does not say so: its edges would count as the neighbours of the
// soil's, none of them be a free one, and nodes made on them not be held.  Where they have an edge in common with the
// soil on the same hand, they cover it, whatever shapes both have.
void refuse_water_in_soil(Builder& b) {
  const std::vector<Group>& groups = b.model.groups;
  const auto unnamed = [](const Group& group) { return group.flow() && !group.overlay; };
  if (std::ranges::none_of(groups, unnamed)) return;
  const SolidEdges& solids = b.solid_edges();
  const auto on_solid = [&](const Group& group, const int* nodes) {
    return std::ranges::any_of(group.element->edges(), [&](const std::vector<int>& edge) {
      return solids.has(nodes[edge[0]], nodes[edge[1]]);
    });
  };
  for (const Group& group : groups)
    for (int e = 0; unnamed(group) && e < group.elements(); ++e)
      if (on_solid(group, group.nodes_of(e))) {
        b.error("S326", group.where,
                "group " + std::to_string(group.number) + ": water flows through element " +
                    std::to_string(group.element_numbers[e]) +
                    " on the nodes of a solid (a group that lies on others on purpose says so: overlay 1)");
        break;
      }
}

}  // namespace

void check_overlap(Builder& b) {
  refuse_water_in_soil(b);
  const StagesTogether stages_together(b.model);
  const EdgeSearch edges(b, stages_together);
  if (edges.first) {
    const auto& [owner, edge] = *edges.first;
    b.warning(
        "S326", b.at_line(line_of(b.model, edge.group, edge.element)),
        "elements " + number_of(b.model, owner.group, owner.element) + " and " +
            number_of(b.model, edge.group, edge.element) +
            " lie on the same side of a common edge: they overlap" +
            (edges.on_one_hand > 1 ? " (and " + std::to_string(edges.on_one_hand - 1) + " more such edges)"
                                   : ""));
  }
  if (edges.bare.empty()) return;
  const auto found = OverlapSearch(b.model, stages_together, edges.bare).find();
  if (!found.empty()) refuse_overlaps(b, found);
}

}  // namespace sage::builder
