#include <algorithm>
#include <map>

#include "sage/model/water_parts.hpp"

namespace sage {

using namespace water;

namespace {

// Groups of active solids by the sides of elements of structures that they lie on, with or without a joint between.
class SolidsBeside {
 public:
  SolidsBeside(const Model& model, const std::vector<char>& groups) : solids_(edges_of_active(model, groups)) {
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      if (!groups[g] || !group.interface()) continue;
      for (int e = 0; e < group.elements(); ++e) {
        // Its sides go from 1 to 2 and from 3 to 4; what lies behind one has it the other way round.
        const int* const n = group.nodes_of(e);
        if (const int behind = touching(n[3], n[2]); behind >= 0) joints_[{n[0], n[1]}] = behind;
        if (const int behind = touching(n[1], n[0]); behind >= 0) joints_[{n[2], n[3]}] = behind;
      }
    }
  }

  // The group on the left of the way from node to node; -1 = there is none.
  int on(int from, int to) const {
    if (const int group = touching(from, to); group >= 0) return group;
    const auto joint = joints_.find({from, to});
    return joint == joints_.end() ? -1 : joint->second;
  }

 private:
  int touching(int from, int to) const {
    for (const SolidEdge& edge : solids_.at(std::min(from, to)))
      if (edge.other == std::max(from, to) && edge.reversed == (from > to)) return edge.group;
    return -1;
  }

  SolidEdges solids_;
  std::map<std::pair<int, int>, int> joints_;  // solids behind joints
};

// Pore pressure stands, or may stand, in solids of the group on the line between two nodes.
bool is_wet(const Model& model, int stage, int group, int from, int to) {
  const WaterCard* const card = group < 0 ? nullptr : water_card(model, stage, group);
  if (card == nullptr || card->kind != WaterKind::line) return card != nullptr;
  const auto covered = [&](int node) {
    return water_level(*card, model.mesh.x(0, node)) > model.mesh.x(1, node);
  };
  return covered(from) || covered(to);
}

}  // namespace

std::vector<BesideStructure> structures_beside_water(const Model& model, int stage,
                                                     const std::vector<char>& groups) {
  std::vector<BesideStructure> list;
  bool any = false;
  for (std::size_t g = 0; g < model.groups.size(); ++g) any = any || (groups[g] && model.groups[g].structure());
  if (!any) return list;
  const SolidsBeside solids(model, groups);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!groups[g] || !group.structure() || group.element->edges().empty()) continue;
    const std::vector<int>& edge = group.element->edges().front();
    for (int e = 0; e < group.elements(); ++e) {
      const int a = group.nodes_of(e)[edge[0]], b = group.nodes_of(e)[edge[1]];
      const int left = solids.on(a, b), right = solids.on(b, a);
      list.push_back({static_cast<int>(g), e, left < 0, right < 0,
                      is_wet(model, stage, left, a, b) || is_wet(model, stage, right, a, b)});
    }
  }
  return list;
}

namespace {

// The line of a structure's element through its two or three nodes, by xi from -1 to 1.
struct StructureLine {
  Eigen::Matrix<double, 2, 3> x = Eigen::Matrix<double, 2, 3>::Zero();
  bool curved = false;

  StructureLine(const Mesh& mesh, const int* nodes, const std::vector<int>& edge) : curved(edge.size() > 2) {
    for (std::size_t i = 0; i < std::min<std::size_t>(edge.size(), 3); ++i)
      x.col(static_cast<Eigen::Index>(i)) = mesh.x.col(nodes[edge[i]]);
  }
  Eigen::Vector3d N(double xi) const {
    if (curved) return {0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi};
    return {0.5 * (1.0 - xi), 0.5 * (1.0 + xi), 0.0};
  }
  Vector2 along(double xi) const {
    return x * (curved ? Eigen::Vector3d(xi - 0.5, xi + 0.5, -2.0 * xi) : Eigen::Vector3d(-0.5, 0.5, 0.0));
  }
  Vector2 at(double xi) const { return x * N(xi); }
};

// Between a and b, where f has other signs.
template <class F>
double zero_between(const F& f, double a, double b) {
  const bool below = f(a) < 0.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (a + b);
    ((f(middle) < 0.0) == below ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

// xi where the depth below the water begins or bends: pieces between them have a smooth pressure.
std::vector<double> pieces(const StructureLine& line, const WaterCard& card) {
  constexpr int kLooks = 8;
  std::vector<double> at{-1.0, 1.0};
  const auto add_zeros = [&](const auto& f) {
    for (int i = 0; i < kLooks; ++i) {
      const double a = -1.0 + 2.0 * i / kLooks, b = -1.0 + 2.0 * (i + 1) / kLooks;
      if ((f(a) < 0.0) != (f(b) < 0.0)) at.push_back(zero_between(f, a, b));
    }
  };
  add_zeros([&](double xi) { return water_level(card, line.at(xi).x()) - line.at(xi).y(); });
  for (const Vector2& point : card.line) add_zeros([&](double xi) { return line.at(xi).x() - point.x(); });
  std::ranges::sort(at);
  return at;
}

// f += free water of a card on an element.  sense: 1 pushes to the left of the way from node 1 to node 2.  at_nodes: by
// the shape functions of the edges of solids beside it.
void add_free_water(const Model& model, const Group& group, int element, const WaterCard& card, double sense,
                    bool at_nodes, std::span<double> f) {
  const GaussRule rule(4);
  const std::vector<int>& edge = group.element->edges().front();
  const StructureLine line(model.mesh, group.nodes_of(element), edge);
  const std::vector<double> ends = pieces(line, card);
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, group, element, x);
  const auto force_at = at_nodes ? nullptr : group.formulation_entry().force_at;
  for (std::size_t piece = 1; piece < ends.size(); ++piece) {
    const double half = 0.5 * (ends[piece] - ends[piece - 1]);
    for (std::size_t q = 0; q < rule.x.size(); ++q) {
      const double xi = ends[piece - 1] + half * (1.0 + rule.x[q]);
      const Vector2 place = line.at(xi), along = line.along(xi);
      const double u = model.units.water_unit_weight * (water_level(card, place.x()) - place.y());
      if (!(u > 0.0)) continue;
      const Vector2 force =
          sense * half * rule.w[q] * measure(model, place) * u * Vector2(-along.y(), along.x());
      if (force_at != nullptr) {
        force_at(x, xi, force, f);
        continue;
      }
      const Eigen::Vector3d N = line.N(xi);
      for (std::size_t i = 0; i < std::min<std::size_t>(edge.size(), 3); ++i)
        Vector2::Map(f.data() + 2 * edge[i]) += N[i] * force;
    }
  }
}

}  // namespace

void water_on_structures(const Model& model, int stage, const std::vector<char>& groups, int only,
                         const AddWater& add) {
  const auto card = [&](int group, WaterSide side) { return water_card(model, stage, group, side); };
  const auto any = [&](int group) {
    return (only < 0 || group == only) && groups[group] && model.groups[group].structure() &&
           (card(group, WaterSide::left) != nullptr || card(group, WaterSide::right) != nullptr);
  };
  bool wanted = false;
  for (std::size_t g = 0; g < model.groups.size(); ++g) wanted = wanted || any(static_cast<int>(g));
  if (!wanted) return;
  std::vector<double> f;
  for (const BesideStructure& one : structures_beside_water(model, stage, groups)) {
    if (!any(one.group)) continue;
    const WaterCard* const left = one.left ? card(one.group, WaterSide::left) : nullptr;
    const WaterCard* const right = one.right ? card(one.group, WaterSide::right) : nullptr;
    if (left == nullptr && right == nullptr) continue;
    const Group& group = model.groups[one.group];
    f.assign(group.element->traits().dofs, 0.0);
    if (left != nullptr) add_free_water(model, group, one.element, *left, -1.0, one.wet, f);
    if (right != nullptr) add_free_water(model, group, one.element, *right, 1.0, one.wet, f);
    add(one.group, one.element, f);
  }
}

}  // namespace sage
