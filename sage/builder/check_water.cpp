// What only decks with flow of water can have wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/flow_line.hpp"
#include "sage/model/water.hpp"
#include "sage/model/weight_above.hpp"

namespace sage::builder {

namespace {

// In the stage that the report starts with: later ones may take the flow away.
void check_discharges(Builder& b) {
  const Model& model = b.model;
  Activity activity(model);
  for (const Stage& stage : model.stages) {
    activity.enter(stage);
    for (const Report& report : model.reports) {
      if (report.kind != ReportKind::discharge || report.stage + 1 != stage.number) continue;
      const FlowLine line = flow_line(model, activity.group, report.nodes);
      if (!line.fault.empty())
        b.error("S242", report.where, "there is no discharge through this line: " + line.fault);
    }
  }
}

// Nothing but the deck's own weight can hold an element that has no stiffness; a card that gives one is lost.
void note_weights(Builder& b) {
  const bool gravity =
      std::ranges::any_of(b.model.stages, [](const Stage& stage) { return !stage.gravity.isZero(0.0); });
  if (!gravity) return;
  for (const Group& group : b.model.groups)
    if (group.flow() && b.model.material_of(group).unit_weight != 0.0)
      b.warning("S332", group.where,
                "group " + std::to_string(group.number) + " (" + group.element_name +
                    "): the unit weight of its material does nothing: what water flows through has its weight "
                    "from the solids there");
}

// A flag a node: something there moves.
std::vector<bool> moving_nodes(const Model& model) {
  std::vector<bool> moves(static_cast<std::size_t>(model.mesh.nodes()), false);
  for (const Group& group : model.groups)
    if (!group.flow())
      for (const int node : group.nodes) moves[node] = true;
  return moves;
}

// A support card whose name of the unknown is blank holds displacements, which water does not have.
void warn_of_displacements(Builder& b, const DofMap& map, const std::vector<bool>& moves,
                           const std::vector<Fixity>& fixities) {
  const int head = find_unknown(b.model.unknowns, "head");
  for (const Fixity& fixity : fixities)
    if (map.of(fixity.node, head) >= 0 && !moves[fixity.node])
      b.warning("S332", {b.model.file, fixity.line, 0, 0},
                "node " + std::to_string(b.model.mesh.number[fixity.node]) +
                    " has a head and no displacement that the card could hold; a card for heads names them "
                    "(head)");
}

// Pressures at nodes belong to the nodes of the deck and those between them.
bool follows_mesh(Builder& b) {
  if (b.model.mesh.given_nodes() == b.water_nodes) return true;
  const auto follows = [&](std::size_t card) {
    return std::ranges::any_of(b.stored_heads, [&](const StoredHeads& heads) { return heads.card == card; });
  };
  for (std::size_t i = 0; i < b.model.water.size(); ++i)
    if (const WaterCard& card = b.model.water[i]; card.kind == WaterKind::nodes && !follows(i)) {
      b.error("S248", card.where, "pressures at nodes can't be carried over to another mesh than the deck's");
      return false;
    }
  return true;
}

// Edges with water behind them that the card says not to stand outside.
void warn_of_open_edges(Builder& b, const Activity& activity, const std::vector<FreeEdge>& all,
                        const PorePressure& water, const Stage& stage) {
  int edges = 0;
  const FreeEdge* first = nullptr;
  const WaterCard* card = nullptr;
  for (const FreeEdge& edge : all) {
    const WaterCard* const own = water.card(static_cast<std::size_t>(edge.group));
    if (own == nullptr || own->kind != WaterKind::line || own->action != WaterAction::none || edge.on_structure)
      continue;
    const Group& group = b.model.groups[edge.group];
    const std::vector<int>& local = group.element->edges()[edge.edge];
    bool below = true, held = true;
    for (const int i : {local[0], local[1]}) {
      const int node = group.nodes_of(edge.element)[i];
      const Vector2 x = b.model.mesh.x.col(node);
      below = below && water_level(*own, x.x()) > x.y() + b.model.mesh.reach;
      held = held && (activity.has_reaction(DofMap::displacement(node, 0)) ||
                      activity.has_reaction(DofMap::displacement(node, 1)));
    }
    if (!below || held) continue;
    if (edges++ == 0) {
      first = &edge;
      card = own;
    }
  }
  if (edges == 0) return;
  const Group& group = b.model.groups[first->group];
  b.warning("S339", card->where,
            "stage " + std::to_string(stage.number) + ": the phreatic line lies above " +
                std::to_string(edges) + " free edge(s), first of element " +
                std::to_string(group.element_numbers[first->element]) +
                ", and by action 1 no water stands there: nothing balances the pressure");
}

// Where the pressure is more than all that lies above, water and structures on the ground included.
void warn_of_uplift(Builder& b, const Activity& activity, const PorePressure& water, const Stage& stage,
                    double gravity) {
  if (!(gravity > 0.0)) return;
  const Model& model = b.model;
  const WeightAbove above(model, activity.group, water.stage());
  int places = 0, worst_element = 0;
  double worst = 0.0;
  const WaterCard* card = nullptr;
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const WaterCard* const own = water.card(g);
    if (own == nullptr) continue;
    const Group& group = model.groups[g];
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      const double u = water.at_point(g, e, 0);
      if (!(u > 0.0)) continue;
      const Vector2 place = group.element->position(x, 0);
      const double total = above.at(place, free_level(*own, place.x())).stress;
      if (!(u - total > 1e-6 * u)) continue;
      ++places;
      if (u - total <= worst) continue;
      worst = u - total;
      worst_element = group.element_numbers[e];
      card = own;
    }
  }
  if (places == 0) return;
  b.warning("S340", card->where,
            "stage " + std::to_string(stage.number) + ": uplift: in " + std::to_string(places) +
                " element(s) the pore pressure is more than all that lies above; most in element " +
                std::to_string(worst_element) + ", by " + rounded_text(worst, 4) + " " + model.units.stress);
}

// Free water that a rapid drawdown would raise.
void refuse_rising_water(Builder& b, const std::vector<FreeEdge>& free, const PorePressure& water) {
  for (const FreeEdge& edge : free) {
    const WaterCard* const own = water.card(static_cast<std::size_t>(edge.group));
    if (own == nullptr || own->kind != WaterKind::drawdown || own->stage != water.stage()) continue;
    const WaterCard* const before = line_before(b.model, *own, edge.group);
    const Group& group = b.model.groups[edge.group];
    for (const int i : group.element->edges()[edge.edge]) {
      const Vector2 x = b.model.mesh.x.col(group.nodes_of(edge.element)[i]);
      const double level = water_level(*own, x.x());
      if (level <= std::max(x.y(), water_level(*before, x.x())) + b.model.mesh.reach) continue;
      b.error("S248", own->where,
              "at x = " + rounded_text(x.x()) + " the level " + rounded_text(level) +
                  " after the drawdown lies above the one before, " +
                  rounded_text(water_level(*before, x.x())));
      return;
    }
  }
}

// Ends of free edges that water stands at, by their places: walls in joints have nodes of their own there.
struct WetEnd {
  Vector2 other = Vector2::Zero();  // the edge's other end
  double level = 0.0;
};
using WetEnds = std::map<std::pair<double, double>, std::vector<WetEnd>>;

WetEnds wet_ends(const Model& model, const std::vector<FreeEdge>& edges, const PorePressure& water) {
  WetEnds ends;
  for (const FreeEdge& edge : edges) {
    const WaterCard* const own = water.card(static_cast<std::size_t>(edge.group));
    if (own == nullptr || own->kind != WaterKind::line || own->action == WaterAction::none || edge.on_structure)
      continue;
    const Group& group = model.groups[edge.group];
    const std::vector<int>& local = group.element->edges()[edge.edge];
    const int* const nodes = group.nodes_of(edge.element);
    const Vector2 a = model.mesh.x.col(nodes[local[0]]), c = model.mesh.x.col(nodes[local[1]]);
    const auto add = [&](const Vector2& end, const Vector2& other) {
      const double level = water_level(*own, end.x());
      if (level > end.y() + model.mesh.reach) ends[{end.x(), end.y()}].push_back({other, level});
    };
    add(a, c);
    add(c, a);
  }
  return ends;
}

// Ground under open water beside a beam whose side there has none: the wall would bear the water behind it alone.
bool warn_of_dry_walls(Builder& b, const std::vector<FreeEdge>& free, const PorePressure& water,
                       const std::vector<BesideStructure>& walls, const Stage& stage) {
  const Model& model = b.model;
  const WetEnds ends = wet_ends(model, free, water);
  if (ends.empty()) return false;
  for (const BesideStructure& one : walls) {
    const auto g = static_cast<std::size_t>(one.group);
    const Group& group = model.groups[g];
    const std::vector<int>& edge = group.element->edges().front();
    const int* const nodes = group.nodes_of(one.element);
    const Vector2 a = model.mesh.x.col(nodes[edge[0]]), c = model.mesh.x.col(nodes[edge[1]]);
    for (const Vector2& end : {a, c}) {
      const auto found = ends.find({end.x(), end.y()});
      if (found == ends.end()) continue;
      for (const WetEnd& wet : found->second) {
        const Vector2 along = c - a, to = wet.other - end;
        const double across = along.x() * to.y() - along.y() * to.x();
        if (std::abs(across) <= 1e-6 * along.norm() * to.norm()) continue;
        const WaterSide side = across > 0.0 ? WaterSide::left : WaterSide::right;
        const bool open = side == WaterSide::left ? one.left : one.right;
        if (!open || water_card(model, water.stage(), one.group, side) != nullptr ||
            !(0.5 * (a.y() + c.y()) < wet.level))
          continue;
        b.warning("S341", group.where,
                  "stage " + std::to_string(stage.number) + ": water stands on the ground beside element " +
                      std::to_string(group.element_numbers[one.element]) + " of group " +
                      std::to_string(group.number) + ", up to " + rounded_text(wet.level, 6) +
                      ", and none on its " + (side == WaterSide::left ? "left" : "right") +
                      " side: a water card of kind 1 that names the group puts it there");
        return true;
      }
    }
  }
  return false;
}

// Cards about sides of structures that are free in this stage.
void mark_used_sides(const Builder& b, const PorePressure& water, const std::vector<BesideStructure>& walls,
                     std::vector<char>& used) {
  for (std::size_t i = 0; i < b.model.water.size(); ++i) {
    const WaterCard& card = b.model.water[i];
    if (card.group < 0 || !b.model.groups[card.group].structure()) continue;
    for (const BesideStructure& one : walls)
      for (const auto& [side, open] : {std::pair{WaterSide::left, one.left}, {WaterSide::right, one.right}})
        if (open && one.group == card.group && water_card(b.model, water.stage(), one.group, side) == &card)
          used[i] = 1;
  }
}

struct LevelJump {
  int edges = 0;
  double largest = 0.0, sideways = 0.0;  // stress; force
  int first = 0, second = 0;             // groups
  int element = 0;                       // of the first, where the jump is largest
  Vector2 place = Vector2::Zero();
};

// Ends of structures' edges, by node, as pairs of smaller and larger.
std::set<std::pair<int, int>> structure_edges(const Model& model, const Activity& activity) {
  std::set<std::pair<int, int>> edges;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!activity.group[g] || !group.structure() || group.entry->corners < 2) continue;
    for (int e = 0; e < group.elements(); ++e)
      edges.insert(std::minmax(group.nodes_of(e)[0], group.nodes_of(e)[1]));
  }
  return edges;
}

// Pore pressure that the cards of an edge's own group give at its ends.
std::array<double, 2> pressures_of(const Model& model, const PorePressure& water, const SolidEdge& edge,
                                   int node) {
  std::array<double, 2> pressures{};
  const Group& group = model.groups[edge.group];
  const int* const nodes = group.nodes_of(edge.element);
  const std::array<int, 2> ends{node, edge.other};
  for (std::size_t end = 0; end < 2; ++end) {
    std::vector<double> N(static_cast<std::size_t>(group.node_count()), 0.0);
    for (std::size_t i = 0; i < N.size(); ++i)
      if (nodes[i] == ends[end]) N[i] = 1.0;
    if (water.card(static_cast<std::size_t>(edge.group)) != nullptr)
      pressures[end] = water.at(edge.group, edge.element, model.mesh.x.col(ends[end]), N);
  }
  return pressures;
}

// How much of a pressure two cards may differ by.  Those of layers with their own r_u differ by nature, excess pressures
// are no level, heads of flow elements are not known yet, and pressures given at nodes carry the error of a mesh.
std::optional<double> allowed_jump(const WaterCard* one, const WaterCard* two) {
  constexpr double kRounding = 1e-6, kMesh = 0.02;
  const auto kind = [](const WaterCard* card) { return card == nullptr ? WaterKind::dry : card->kind; };
  bool exact = true;
  int ratios = 0;
  for (const WaterKind k : {kind(one), kind(two)}) {
    if (k == WaterKind::undrained || k == WaterKind::drained || k == WaterKind::heads ||
        k == WaterKind::drawdown)
      return {};
    exact = exact && (k == WaterKind::line || k == WaterKind::dry);
    ratios += k == WaterKind::ratio ? 1 : 0;
  }
  if (ratios == 2) return {};
  return exact ? kRounding : kMesh;
}

// Solids of two groups with a common edge, where their levels give different pressures.
std::map<std::pair<int, int>, LevelJump> level_jumps(Builder& b, const Activity& activity,
                                                     const PorePressure& water) {
  constexpr double kSame = 1e-6;  // rounding
  const Model& model = b.model;
  std::map<std::pair<int, int>, LevelJump> jumps;
  const std::set<std::pair<int, int>> walls = structure_edges(model, activity);
  const SolidEdges& solids = b.solid_edges();
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const auto edges = solids.at(node);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const SolidEdge &one = edges[i], &two = edges[i + 1];
      if (one.other != two.other || one.group == two.group || walls.contains({node, one.other})) continue;
      const auto g1 = static_cast<std::size_t>(one.group), g2 = static_cast<std::size_t>(two.group);
      if (!activity.group[g1] || !activity.group[g2]) continue;
      const WaterCard *const c1 = water.card(g1), *const c2 = water.card(g2);
      const std::optional<double> allowed = allowed_jump(c1, c2);
      if (c1 == c2 || !allowed) continue;
      const std::array<double, 2> u1 = pressures_of(model, water, one, node),
                                  u2 = pressures_of(model, water, two, node);
      const double start = std::abs(u1[0] - u2[0]), end = std::abs(u1[1] - u2[1]), most = std::max(start, end);
      if (most <= *allowed * std::max({u1[0], u1[1], u2[0], u2[1]})) continue;
      LevelJump& jump = jumps[std::minmax(one.group, two.group)];
      const Vector2 x = model.mesh.x.col(node), y = model.mesh.x.col(one.other);
      const double width =
          model.geometry == Geometry::axisymmetric ? 3.14159265358979323846 * (x.x() + y.x()) : 1.0;
      jump.sideways += 0.5 * (start + end) * std::abs(x.y() - y.y()) * width;
      ++jump.edges;
      if (most <= jump.largest * (1.0 + kSame)) continue;
      jump.largest = most;
      jump.first = one.group;
      jump.second = two.group;
      jump.element = model.groups[g1].element_numbers[one.element];
      jump.place = end > start * (1.0 + kSame) ? y : x;
    }
  }
  return jumps;
}

// Once for every pair of groups: the stage in which it begins.
void warn_of_level_jumps(Builder& b, const Activity& activity, const PorePressure& water, const Stage& stage,
                         std::set<std::pair<int, int>>& reported) {
  const Model& model = b.model;
  for (const auto& [pair, jump] : level_jumps(b, activity, water)) {
    if (!reported.insert(pair).second) continue;
    const Group &one = model.groups[jump.first], &two = model.groups[jump.second];
    const WaterCard* const card = water.card(static_cast<std::size_t>(jump.first)) != nullptr
                                      ? water.card(static_cast<std::size_t>(jump.first))
                                      : water.card(static_cast<std::size_t>(jump.second));
    b.warning("S360", card->where,
              "stage " + std::to_string(stage.number) + ": the pore pressures of groups " +
                  std::to_string(one.number) + " and " + std::to_string(two.number) + " jump by up to " +
                  rounded_text(jump.largest) + " " + model.units.stress + " at " + std::to_string(jump.edges) +
                  (jump.edges == 1 ? " common edge" : " common edges") + " without a wall, most at element " +
                  std::to_string(jump.element) + ", (" + rounded_text(jump.place.x()) + ", " +
                  rounded_text(jump.place.y()) + ")" +
                  (jump.sideways > 0.0
                       ? ": this pushes " + rounded_text(jump.sideways) + " " + model.units.force + " sideways"
                       : std::string()));
  }
}

void check_pressures(Builder& b) {
  if (b.model.water.empty() || !follows_mesh(b)) return;
  Activity activity(b.model);
  double gravity = 0.0;
  bool warned = false;
  std::vector<char> used(b.model.water.size(), 0);
  std::set<std::pair<int, int>> jumps;
  for (std::size_t s = 0; s < b.model.stages.size(); ++s) {
    const Stage& stage = b.model.stages[s];
    activity.enter(stage);
    gravity -= stage.gravity.y();
    const bool changes =
        s == 0 || !stage.births.empty() || !stage.deaths.empty() ||
        std::ranges::any_of(b.model.water, [&](const WaterCard& c) { return c.stage == static_cast<int>(s); });
    if (!changes) continue;
    const PorePressure water(b.model, static_cast<int>(s), activity.group, activity.dof_map, nullptr);
    if (!water.any()) continue;
    const std::vector<FreeEdge> free = free_edges(b.model, activity.group);
    refuse_rising_water(b, free, water);
    warn_of_open_edges(b, activity, free, water, stage);
    warn_of_uplift(b, activity, water, stage, gravity);
    warn_of_level_jumps(b, activity, water, stage, jumps);
    const std::vector<BesideStructure> walls = structures_beside_water(b.model, water.stage(), activity.group);
    mark_used_sides(b, water, walls, used);
    if (!warned) warned = warn_of_dry_walls(b, free, water, walls, stage);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    const WaterCard& card = b.model.water[i];
    if (used[i] != 0 || card.group < 0 || card.kind != WaterKind::line) continue;
    const Group& group = b.model.groups[card.group];
    if (group.structure())
      b.warning(
          "S332", card.where,
          "group " + std::to_string(group.number) +
              ": no side of it is free for this water in any stage; soil and joints bring theirs themselves");
  }
}

// Joints take pressures that are given, not those that follow from a change of volume: their traction beside soil that
// is shut in is the total one.
void warn_of_joints_beside_undrained(Builder& b) {
  const Model& model = b.model;
  for (const WaterCard& card : model.water) {
    if (card.kind != WaterKind::undrained) continue;
    const Group& soil = model.groups[card.group];
    const std::set<int> shut(soil.nodes.begin(), soil.nodes.end());
    const auto joint = std::ranges::find_if(model.groups, [&](const Group& group) {
      return group.interface() &&
             std::ranges::any_of(group.nodes, [&](int node) { return shut.contains(node); });
    });
    if (joint == model.groups.end()) continue;
    b.warning(
        "S349", card.where,
        "joints of group " + std::to_string(joint->number) + " touch group " + std::to_string(soil.number) +
            ", which is undrained from stage " + std::to_string(card.stage + 1) +
            " on: its excess pressure is in their traction, and counts for friction, until it is drained");
    return;
  }
}

}  // namespace

void check_water(Builder& b) {
  check_pressures(b);
  warn_of_joints_beside_undrained(b);
  if (find_unknown(b.model.unknowns, "head") >= 0) {
    const DofMap map(b.model);  // with the nodes in the middle of sides, which the deck's own map lacks
    const std::vector<bool> moves = moving_nodes(b.model);
    warn_of_displacements(b, map, moves, b.model.fixities);
    for (const Stage& stage : b.model.stages) warn_of_displacements(b, map, moves, stage.fixities);
  }
  check_discharges(b);
  note_weights(b);
}

}  // namespace sage::builder
