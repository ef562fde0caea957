// Where the elastic solution of a mesh is not smooth: from its boundary, the angle inside and what holds both sides; and
// where materials meet otherwise than along a smooth line.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "sage/mesh/corner_exponent.hpp"
#include "sage/mesh/subdivide.hpp"
#include "sage/model/arc_sides.hpp"
#include "sage/model/locking.hpp"

namespace sage::mesh {

namespace {

struct BoundaryEdge {
  int a = 0, z = 0;  // counter-clockwise: the body is to the left
  int group = 0, element = 0, edge = 0;
  int middle = -1;  // where a card gives it
};

double degrees(double radians) {
  return radians / kRadiansPerDegree;
}

// Boundary edges by their ends, angles of the body at each node.  An edge is held where one list of fixities
// holds both of its ends, and the middle node that a card gives: the ends of a long edge may belong to two
// other sides.
struct Outline {
  explicit Outline(const Mesh& mesh) : arcs(mesh) {}

  ArcSides arcs;
  std::vector<BoundaryEdge> edges;
  std::map<int, std::map<int, double>> sectors;  // degrees that each kind of material has at a node
  std::map<int, int> borders;                    // sides of elements at a node between two kinds of material
  std::map<int, std::vector<std::size_t>> leaving, arriving;
  std::map<int, double> angle;            // degrees
  std::set<EdgeKey> joined;               // an interface lies on them
  std::vector<std::array<bool, 2>> held;  // by edge and direction

  void apply(const std::vector<Fixity>& fixities) {
    std::map<int, std::array<FixityCode, 2>> codes;
    for (const Fixity& f : fixities)
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] != FixityCode::unchanged) codes[f.node][c] = f.code[c];
    held.resize(edges.size(), {false, false});
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const BoundaryEdge& edge = edges[i];
      for (std::size_t c = 0; c < 2; ++c) {
        const auto code = [&](int node) {
          const auto it = codes.find(node);
          return it == codes.end() ? FixityCode::unchanged : it->second[c];
        };
        const auto all = [&](FixityCode wanted) {
          return code(edge.a) == wanted && code(edge.z) == wanted &&
                 (edge.middle < 0 || code(edge.middle) == wanted);
        };
        const auto any = [&](FixityCode wanted) {
          return code(edge.a) == wanted || code(edge.z) == wanted ||
                 (edge.middle >= 0 && code(edge.middle) == wanted);
        };
        if (all(FixityCode::fixed)) held[i][c] = true;
        if (any(FixityCode::released)) held[i][c] = false;
      }
    }
  }
};

// The first group whose law is the same: the same code and parameters.
std::vector<int> kinds_of_material(const Model& model) {
  std::vector<int> kinds;
  for (const Group& group : model.groups) {
    const auto same = [&](const Group& other) {
      const Material &a = model.material_of(group), &b = model.material_of(other);
      return a.code == b.code && a.parameters == b.parameters;
    };
    kinds.push_back(
        static_cast<int>(std::find_if(model.groups.begin(), model.groups.end(), same) - model.groups.begin()));
  }
  return kinds;
}

// From an end of a side into it: along its circle, or the parabola where a card gives its middle.
Vector2 direction(const Mesh& mesh, const ArcSides& arcs, const std::array<int, 2>& ends, int middle,
                  std::size_t end) {
  const Vector2 here = mesh.x.col(ends[end]), there = mesh.x.col(ends[1 - end]);
  constexpr double kNothing = 1e-6;  // of a middle at the quarter point
  const Vector2 chord = there - here;
  if (const auto centre = arcs.centre(ends[0], ends[1])) {
    const Vector2 radius = here - *centre, around(-radius.y(), radius.x());
    return around.dot(chord) > 0.0 ? around : Vector2(-around);
  }
  if (middle < 0) return chord;
  const Vector2 tangent = 4.0 * mesh.x.col(middle) - 3.0 * here - there;
  return tangent.norm() > kNothing * chord.norm() ? tangent : chord;
}

Outline outline_of(const Model& model) {
  Outline outline(model.mesh);
  const std::vector<int> kinds = kinds_of_material(model);
  std::map<EdgeKey, int> uses, kind_on;
  std::vector<BoundaryEdge> all;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.interface() && !counts_for_outline(group)) continue;
    const auto& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e) {
      const int* n = group.nodes_of(e);
      if (group.interface()) {
        for (const auto& edge : edges) outline.joined.insert(edge_key(n[edge[0]], n[edge[1]]));
        continue;
      }
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto middle_node = [&](const std::vector<int>& edge) {
          return middle_of(edge) < 0 ? -1 : n[middle_of(edge)];
        };
        const auto& edge_before = edges[(i + edges.size() - 1) % edges.size()];
        const int a = n[edges[i][0]], z = n[edges[i][1]], before = n[edge_before[0]],
                  middle = middle_node(edges[i]);
        ++uses[edge_key(a, z)];
        all.push_back({a, z, static_cast<int>(g), e, static_cast<int>(i), middle});
        if (const auto [it, is_first] = kind_on.try_emplace(edge_key(a, z), kinds[g]);
            !is_first && it->second != kinds[g]) {
          ++outline.borders[a];
          ++outline.borders[z];
        }
        const Vector2 out = direction(model.mesh, outline.arcs, {a, z}, middle, 0),
                      in = direction(model.mesh, outline.arcs, {before, a}, middle_node(edge_before), 1);
        double angle = degrees(std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in)));
        if (angle < -90.0) angle += 360.0;  // two sides that go straight on
        outline.angle[a] += angle;
        outline.sectors[a][kinds[g]] += angle;
      }
    }
  }
  for (const BoundaryEdge& edge : all) {
    if (uses[edge_key(edge.a, edge.z)] != 1) continue;
    outline.leaving[edge.a].push_back(outline.edges.size());
    outline.arriving[edge.z].push_back(outline.edges.size());
    outline.edges.push_back(edge);
  }
  return outline;
}

Side kind_of(const Model& model, const Outline& outline, std::size_t edge) {
  const BoundaryEdge& e = outline.edges[edge];
  if (outline.joined.count(edge_key(e.a, e.z))) return Side::held;
  const Vector2 along = model.mesh.x.col(e.z) - model.mesh.x.col(e.a);
  const double length = along.norm();
  const bool on_axis = model.geometry == Geometry::axisymmetric &&
                       std::abs(model.mesh.x(0, e.a)) < 1e-9 * length &&
                       std::abs(model.mesh.x(0, e.z)) < 1e-9 * length;
  const bool x = outline.held[edge][0] || on_axis, y = outline.held[edge][1];
  if (!x && !y) return Side::free;
  if (x && y) return Side::held;
  const bool level = std::abs(along.y()) < 1e-6 * length, upright = std::abs(along.x()) < 1e-6 * length;
  if (!level && !upright) return Side::held;
  return x == upright ? Side::across : Side::along;
}

constexpr double kSlack = 2.0;  // degrees, for meshers

bool is_mirror(Side side) {
  return side == Side::across || side == Side::along;
}

// Slopes of the stress have no bound.
bool is_singular(Side a, Side b, double angle, double nu) {
  const double right_angles = 90.0 * std::round(angle / 90.0);
  if (std::abs(angle - right_angles) < kSlack) angle = right_angles;
  return corner_exponent(a, b, angle * kRadiansPerDegree, nu) < kSmoothExponent;
}

// Near 1/2 where water keeps the volume.
double poissons_ratio_at(const Model& model, const BoundaryEdge& edge) {
  constexpr double kUndrained = 0.499;
  const Group& group = model.groups[edge.group];
  return group.excess >= 0 ? kUndrained : std::min(poissons_ratio(model.material_of(group)), kUndrained);
}

void find_by_supports(const Model& model, const Outline& outline, std::set<int>& found) {
  for (const auto& [node, leaving] : outline.leaving) {
    const auto& arriving = outline.arriving.at(node);
    if (leaving.size() != 1) {
      found.insert(node);  // two parts touch in a point
      continue;
    }
    const Side in = kind_of(model, outline, arriving.front()), out = kind_of(model, outline, leaving.front());
    const double angle = outline.angle.at(node);
    if (in == out && std::abs(angle - 180.0) < kSlack) continue;  // nearly all nodes
    if (is_singular(in, out, angle, poissons_ratio_at(model, outline.edges[leaving.front()])))
      found.insert(node);
  }
}

// A line between two materials is smooth where it goes straight on, also by way of its mirror image.
bool goes_on(const Model& model, const Outline& outline, int node) {
  const auto all = [&](double angle) {
    const auto& sectors = outline.sectors.at(node);
    return std::all_of(sectors.begin(), sectors.end(),
                       [&](const auto& sector) { return std::abs(sector.second - angle) < kSlack; });
  };
  const int borders = outline.borders.at(node);
  const auto leaving = outline.leaving.find(node);
  if (leaving == outline.leaving.end()) return borders == 2 && all(180.0);
  if (borders != 1 || leaving->second.size() != 1 || !all(90.0)) return false;
  const Side in = kind_of(model, outline, outline.arriving.at(node).front());
  return is_mirror(in) && in == kind_of(model, outline, leaving->second.front());
}

void find_by_materials(const Model& model, const Outline& outline, std::set<int>& found) {
  for (const auto& [node, count] : outline.borders)
    if (!goes_on(model, outline, node)) found.insert(node);
}

// Loads on edges that make the stress jump from direction to direction at a point: it is
// bounded, its slope is not.
class EdgeLoads {
 public:
  EdgeLoads(const Model& model, const ArcSides& arcs, const Stage& stage) : model_(&model), arcs_(&arcs) {
    for (const EdgeLoad& p : stage.pressures) {
      auto [it, is_new] = load_.try_emplace({p.group, p.element, p.edge},
                                            std::array<Vector2, 2>{Vector2::Zero(), Vector2::Zero()});
      it->second[0] += Vector2(p.normal.x(), p.shear.x());
      it->second[1] += Vector2(p.normal.y(), p.shear.y());
      largest_ = std::max({largest_, p.normal.cwiseAbs().maxCoeff(), p.shear.cwiseAbs().maxCoeff()});
    }
  }
  // Pressure and shear that end or jump on a straight side.
  bool jump(const BoundaryEdge& in, const BoundaryEdge& out) const {
    return (value(out, 0) - value(in, 1)).norm() > 1e-6 * largest_;
  }
  // Tractions on the sides of a corner that no one stress has: it is symmetric, n_in . t_out = n_out . t_in.
  bool clash(const BoundaryEdge& in, const BoundaryEdge& out) const {
    const Vector2 t_in = traction(in, 1), t_out = traction(out, 0);
    const double difference = std::abs(normal(in, 1).dot(t_out) - normal(out, 0).dot(t_in));
    return difference > std::sin(kSlack * kRadiansPerDegree) * (t_in.norm() + t_out.norm()) + 1e-6 * largest_;
  }

 private:
  Vector2 value(const BoundaryEdge& e, std::size_t end) const {
    const auto it = load_.find({e.group, e.element, e.edge});
    return it == load_.end() ? Vector2::Zero() : it->second[end];
  }
  Vector2 normal(const BoundaryEdge& e, std::size_t end) const {  // outward
    const Vector2 along =
        (end == 0 ? 1.0 : -1.0) * direction(model_->mesh, *arcs_, {e.a, e.z}, e.middle, end).normalized();
    return {along.y(), -along.x()};
  }
  Vector2 traction(const BoundaryEdge& e, std::size_t end) const {
    const Vector2 n = normal(e, end), load = value(e, end);
    return -load.x() * n + load.y() * Vector2(-n.y(), n.x());
  }

  const Model* model_;
  const ArcSides* arcs_;
  std::map<std::tuple<int, int, int>, std::array<Vector2, 2>> load_;  // pressure, shear at both ends of an edge
  double largest_ = 0.0;
};

void find_by_loads(const Model& model, const Outline& outline, const Stage& stage, std::set<int>& found) {
  const EdgeLoads loads(model, outline.arcs, stage);
  for (const auto& [node, leaving] : outline.leaving) {
    if (leaving.size() != 1) continue;
    const std::size_t edge_in = outline.arriving.at(node).front(), edge_out = leaving.front();
    const BoundaryEdge &in = outline.edges[edge_in], &out = outline.edges[edge_out];
    const double angle = outline.angle.at(node);
    if (std::abs(angle - 180.0) <= 10.0) {
      if (loads.jump(in, out)) found.insert(node);
      continue;
    }
    const Side a = kind_of(model, outline, edge_in), b = kind_of(model, outline, edge_out);
    // Beside a line of symmetry the pressure adjusts itself, so that only shear can clash, at a right angle.
    const bool both_free = a == Side::free && b == Side::free;
    const bool beside_mirror =
        is_mirror(a) != is_mirror(b) && a != Side::held && b != Side::held && std::abs(angle - 90.0) < kSlack;
    if ((both_free || beside_mirror) && loads.clash(in, out)) found.insert(node);
  }
}

}  // namespace

std::vector<int> singular_corners(const Model& model) {
  Outline outline = outline_of(model);
  outline.apply(model.fixities);
  std::set<int> found;
  for (const Stage& stage : model.stages) {
    outline.apply(stage.fixities);
    find_by_supports(model, outline, found);
    find_by_loads(model, outline, stage, found);
    find_by_materials(model, outline, found);
  }
  return {found.begin(), found.end()};
}

}  // namespace sage::mesh
