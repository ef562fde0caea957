// Node cards (with line generation) and fill cards (blocks between four corner nodes).
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "sage/builder/builder.hpp"
#include "sage/math/rounding.hpp"

namespace sage::builder {

namespace {

constexpr int kMaxNodes = 20'000'000;

using PlacedNodes = ByNumber<Vector2>;

// Fractions 0 .. 1 of `intervals` intervals whose last is `ratio` times the first (0 = equal).
std::vector<double> graded_fractions(int intervals, double ratio) {
  std::vector<double> at(static_cast<std::size_t>(intervals) + 1, 0.0);
  const double q = ratio > 0.0 && intervals > 1 ? std::pow(ratio, 1.0 / (intervals - 1)) : 1.0;
  double length = 1.0, sum = 0.0;
  for (int i = 1; i <= intervals; ++i, length *= q) at[i] = sum += length;
  for (double& a : at) a /= sum;
  at.back() = 1.0;
  return at;
}

struct NodeCard {
  int number = 0;
  bool polar = false;
  Vector2 given = Vector2::Zero();  // as written: x, y or radius, degrees
};

Vector2 cartesian(const NodeCard& card) {
  if (!card.polar) return card.given;
  const double angle = card.given.y() * kRadiansPerDegree;
  // Quarter turns are exact, so that symmetry lines are straight.
  const double quarter = card.given.y() / 90.0;
  if (quarter == std::floor(quarter)) {
    const int turn = (static_cast<int>(std::fmod(quarter, 4.0)) + 4) % 4;
    const double c[4] = {1, 0, -1, 0}, s[4] = {0, 1, 0, -1};
    return card.given.x() * Vector2(c[turn], s[turn]);
  }
  return card.given.x() * Vector2(std::cos(angle), std::sin(angle));
}

// False after an error.
bool place(Builder& b, PlacedNodes& nodes, const CardView& card, int number, const Vector2& x) {
  if (number < 1) {
    b.error("S206", card.where("number"), "node number " + std::to_string(number) + " must be 1 or more");
    return false;
  }
  if (nodes.try_emplace(number, x).second) return true;
  b.error("S205", card.where("number"), "node " + std::to_string(number) + " is defined twice");
  return false;
}

// A generated place on an axis is a difference of numbers of the size `reach`: what is rounding of those is zero.
Vector2 on_axes(const Vector2& place, double reach) {
  constexpr double kRounding = rounding::kFewProducts;
  return (place.array().abs() <= kRounding * reach).select(0.0, place);
}

void fill_line(Builder& b, PlacedNodes& nodes, const CardView& card, const NodeCard& from, const NodeCard& to,
               int step, double ratio) {
  const std::int64_t span = std::int64_t{to.number} - from.number;
  if (span <= 0 || span % step != 0) {
    b.error("S218", card.where("step"),
            "the step " + std::to_string(step) + " does not lead from node " + std::to_string(from.number) +
                " to node " + std::to_string(to.number));
    return;
  }
  if (from.polar != to.polar) {
    b.error("S218", card.where("system"), "both ends of a generated line must use the same coordinate system");
    return;
  }
  if (span / step > kMaxNodes) {
    b.error("S218", card.where("step"),
            "the line would have more than " + std::to_string(kMaxNodes) + " nodes");
    return;
  }
  const int intervals = static_cast<int>(span / step);
  const std::vector<double> at = graded_fractions(intervals, ratio);
  const double reach = std::max(cartesian(from).cwiseAbs().maxCoeff(), cartesian(to).cwiseAbs().maxCoeff());
  for (int i = 1; i < intervals; ++i) {
    NodeCard between = from;
    between.given += at[i] * (to.given - from.given);
    const Vector2 at_node = on_axes(cartesian(between), reach);
    if (!place(b, nodes, card, from.number + i * step, at_node)) return;  // one message a card
  }
}

void read_node_cards(Builder& b, PlacedNodes& nodes) {
  NodeCard previous;
  FieldName number("number"), coordinate_system("system"), x("x"), y("y"), spacing("ratio"),
      number_step("step");
  for (const CardView& card : b.deck.all("node")) {
    const int system = card.integer(coordinate_system);
    NodeCard now{card.integer(number), system == 1, {card.real(x), card.real(y)}};
    if (system != 0 && system != 1)
      b.error("S210", card.where("system"),
              "coordinate system " + std::to_string(system) + " is unknown; 0 cartesian, 1 polar");
    if (!b.usable(card, "x", now.given.x()) || !b.usable(card, "y", now.given.y())) now.given.setZero();
    const double ratio = card.real(spacing);
    if (b.usable(card, "ratio", ratio) && ratio < 0.0)
      b.error("S207", card.where("ratio"), "the spacing ratio must not be negative");
    const int step = card.integer(number_step);
    if (step < 0) b.error("S207", card.where("step"), "the step must not be negative");
    if (step > 0 && previous.number == 0)
      b.error("S218", card.where("step"), "the first node card cannot generate: there is no node before it");
    else if (step > 0)
      fill_line(b, nodes, card, previous, now, step, ratio);
    place(b, nodes, card, now.number, cartesian(now));
    previous = now;
  }
}

// The nodes of one side of a block: those defined so far if all are, otherwise a straight graded line.
std::vector<Vector2> side_points(const PlacedNodes& nodes, int first, int step, int intervals, double ratio) {
  std::vector<Vector2> points;
  for (int i = 0; i <= intervals; ++i) {
    const Vector2* point = nodes.find(first + i * step);
    if (point == nullptr) break;
    points.push_back(*point);
  }
  if (static_cast<int>(points.size()) == intervals + 1) return points;
  const Vector2 &a = *nodes.find(first), c = *nodes.find(first + intervals * step);
  const std::vector<double> at = graded_fractions(intervals, ratio);
  points.clear();
  for (double t : at) points.push_back(a + t * (c - a));
  return points;
}

void fill_block(Builder& b, PlacedNodes& nodes, const CardView& card, int errors_before) {
  const int first = card.integer("first"), columns = card.integer("columns"), rows = card.integer("rows");
  const int column_step = card.integer("column_step", 1), row_step = card.integer("row_step");
  const std::pair<const char*, int> counts[] = {
      {"columns", columns}, {"rows", rows}, {"column_step", column_step}, {"row_step", row_step}};
  for (const auto& [field, count] : counts)
    if (count < 1)
      return b.error("S218", card.where(field),
                     "the " + card.label(field) + " must be 1 or more, not " + std::to_string(count));
  if (static_cast<std::int64_t>(columns) * rows > kMaxNodes) {
    b.error("S218", card.where("columns"),
            "the block would have more than " + std::to_string(kMaxNodes) + " nodes");
    return;
  }
  // i columns and j rows further is the same number where i * column_step = j * row_step.
  const int common = std::gcd(column_step, row_step);
  if (row_step / common <= columns && column_step / common <= rows) {
    b.error("S218", card.where("row_step"),
            "the block would number two of its nodes alike: the step from row to row, " +
                std::to_string(row_step) + ", does not clear " + std::to_string(columns) +
                " columns in steps of " + std::to_string(column_step));
    return;
  }
  const std::int64_t across = std::int64_t{columns} * column_step, up = std::int64_t{rows} * row_step;
  for (const std::int64_t corner : {std::int64_t{first}, first + across, first + across + up, first + up}) {
    if (corner <= kLargestNumber && nodes.contains(static_cast<int>(corner))) continue;
    if (b.problems.errors() == errors_before)  // else the card that should define it is what is wrong
      b.error("S218", card.where("first"),
              "corner node " + std::to_string(corner) + " of the block is not defined before it");
    return;
  }
  const int corners[4] = {first, static_cast<int>(first + across), static_cast<int>(first + across + up),
                          static_cast<int>(first + up)};
  const double cr = card.real("column_ratio"), rr = card.real("row_ratio");
  if (!b.usable(card, "column_ratio", cr) || !b.usable(card, "row_ratio", rr)) return;
  if (cr < 0.0 || rr < 0.0) {
    b.error("S207", card.where(cr < 0.0 ? "column_ratio" : "row_ratio"),
            "a spacing ratio must not be negative");
    return;
  }
  for (const char* field : {"column_ratio", "row_ratio"})
    if (const double ratio = card.real(field); ratio != 0.0 && !(ratio > 1e-3 && ratio < 1e3))
      b.warning("S220", card.where(field), "the " + card.label(field) + " is extreme");
  const auto bottom = side_points(nodes, first, column_step, columns, cr);
  const auto top = side_points(nodes, corners[3], column_step, columns, cr);
  const auto left = side_points(nodes, first, row_step, rows, rr);
  const auto right = side_points(nodes, corners[1], row_step, rows, rr);
  double reach = 0.0;
  for (const int corner : corners) reach = std::max(reach, nodes.find(corner)->cwiseAbs().maxCoeff());
  const auto s_at = graded_fractions(columns, cr), t_at = graded_fractions(rows, rr);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const auto iu = static_cast<std::size_t>(i), ju = static_cast<std::size_t>(j);
      const double s = s_at[iu], t = t_at[ju];
      // Coons patch: exact on all four sides.
      const Vector2 x = (1 - t) * bottom[iu] + t * top[iu] + (1 - s) * left[ju] + s * right[ju] -
                        ((1 - s) * (1 - t) * bottom.front() + s * (1 - t) * bottom.back() + s * t * top.back() +
                         (1 - s) * t * top.front());
      nodes.try_emplace(first + i * column_step + j * row_step, on_axes(x, reach));  // nodes of cards stay
    }
  }
}

// Nodes of a card's middle fields: the i-th middle node is that of the side between corners i and i + 1.
void place_middle_nodes(const CardView& card, int corners, PlacedNodes& nodes) {
  for (int i = 0; i < corners; ++i) {
    const int middle = card.integer("n" + std::to_string(corners + i + 1));
    if (middle < 1 || nodes.contains(middle)) continue;
    const Vector2* from = nodes.find(card.integer("n" + std::to_string(i + 1)));
    const Vector2* to = nodes.find(card.integer("n" + std::to_string((i + 1) % corners + 1)));
    if (from == nullptr || to == nullptr) continue;
    const Vector2 between = 0.5 * (*from + *to);
    nodes.try_emplace(middle, between);
  }
}

// Where the control card asks for it, mid-side nodes that no node card gives stand in the middle of straight
// sides.
void add_middle_nodes(Builder& b, PlacedNodes& nodes) {
  if (b.deck.one("control").integer("middle_nodes") == 0) return;
  std::map<int, int> corners;  // of the groups' elements
  for (const CardView& group : b.deck.all("group")) {
    const ElementEntry* entry = b.catalogue.elements.find(group.integer("element"));
    if (entry != nullptr && entry->fills_area()) corners[group.integer("number")] = entry->corners;
  }
  for (const CardView& card : b.deck.all("element"))
    if (const auto found = corners.find(card.integer("group", 1)); found != corners.end())
      place_middle_nodes(card, found->second, nodes);
}

// The ends of a side have the same distance from the centre but for what drawings allow (sage/section/check.cpp).  Where
// nodes were moved since, the sides between them stay as the nodes have them.
void add_arc(Builder& b, const DeckArc& drawn) {
  constexpr double kOnCircle = 2e-4;  // of the radius
  Arc arc{{drawn.x, drawn.y}, {}};
  for (const auto& [from, to] : drawn.ends) {
    const int *const a = b.node_index.find(from), *const z = b.node_index.find(to);
    if (a == nullptr || z == nullptr) continue;
    const double radius_a = (b.model.mesh.x.col(*a) - arc.centre).norm(),
                 radius_z = (b.model.mesh.x.col(*z) - arc.centre).norm();
    if (std::abs(radius_a - radius_z) <= kOnCircle * radius_a) arc.ends.emplace_back(*a, *z);
  }
  if (!arc.ends.empty()) b.model.mesh.arcs.push_back(std::move(arc));
}

}  // namespace

void build_nodes(Builder& b) {
  PlacedNodes nodes;
  const int before = b.problems.errors();
  read_node_cards(b, nodes);
  for (const CardView& card : b.deck.all("fill")) fill_block(b, nodes, card, before);
  add_middle_nodes(b, nodes);
  b.nodes_known = b.problems.errors() == before;
  if (nodes.empty() && b.problems.errors() == 0)
    b.error("S214", b.deck.one("control").where(), "the deck defines no nodes");

  Mesh& mesh = b.model.mesh;
  mesh.x.resize(2, static_cast<Eigen::Index>(nodes.size()));
  mesh.number.reserve(nodes.size());
  nodes.for_each([&](int number, const Vector2& node) {  // ordered by number, as listings are
    const int index = mesh.nodes();
    mesh.x.col(index) = node;
    mesh.number.push_back(number);
    b.node_index.try_emplace(number, index);
  });
  mesh.deck_nodes = mesh.nodes();
  for (const DeckArc& arc : b.deck.arcs) add_arc(b, arc);
}

}  // namespace sage::builder
