// Structures beside joints, held by them alone, free to turn about a node, and released ends that meet.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "sage/builder/builder.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/joined.hpp"
#include "sage/model/spread_loads.hpp"

namespace sage::builder {

namespace {

// In any direction.
bool has_support(const Activity& activity, int node) {
  return activity.has_reaction(DofMap::displacement(node, 0)) ||
         activity.has_reaction(DofMap::displacement(node, 1));
}

std::string node_number(const Model& model, int node) {
  return std::to_string(model.mesh.number[node]);
}

std::string element_number(const Group& group, int element) {
  return std::to_string(group.element_numbers[element]);
}

int line_of(const Group& group, int element) {
  return group.element_lines[element];
}

// Groups that are there in one and the same stage.
class Lives {
 public:
  explicit Lives(const Model& model)
      : from_(model.groups.size(), 0), to_(model.groups.size(), static_cast<int>(model.stages.size())) {
    for (std::size_t s = 0; s < model.stages.size(); ++s) {
      for (const int g : model.stages[s].births) from_[g] = static_cast<int>(s);
      for (const int g : model.stages[s].deaths) to_[g] = static_cast<int>(s);
    }
  }
  bool meet(std::size_t a, std::size_t b) const {
    return std::max(from_[a], from_[b]) < std::min(to_[a], to_[b]);
  }

 private:
  std::vector<int> from_, to_;
};

using Segment = std::pair<int, int>;  // the smaller node first

Segment segment(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// Of all structures with two ends: from end to end, and over the node in the middle.
std::map<Segment, std::string> segments_of_structures(const Model& model) {
  std::map<Segment, std::string> segments;
  for (const Group& group : model.groups) {
    if (!group.structure() || group.entry->corners != 2) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* n = group.nodes_of(e);
      const std::string number = element_number(group, e);
      segments.try_emplace(segment(n[0], n[1]), number);
      if (group.node_count() == 3) {
        segments.try_emplace(segment(n[0], n[2]), number);
        segments.try_emplace(segment(n[2], n[1]), number);
      }
    }
  }
  return segments;
}

// A joint on one face of a structure.
struct Face {
  std::size_t group = 0;
  int element = 0;
  bool left = false;   // of the way from the segment's smaller node
  bool known = false;  // a solid at its other side tells which side is which
};

bool solid_at(Builder& b, int a, int c) {
  const auto [first, last] = segment(a, c);
  return std::ranges::any_of(b.solid_edges().at(first),
                             [last = last](const SolidEdge& e) { return e.other == last; });
}

// By segment.  Nodes 1 and 2 belong to what lies to the right of them, 3 and 4 to what lies to the left.
std::map<Segment, std::vector<Face>> faces_of(Builder& b, const std::map<Segment, std::string>& structures) {
  std::map<Segment, std::vector<Face>> faces;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (!group.interface()) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* n = group.nodes_of(e);
      const Segment bottom = segment(n[0], n[1]), top = segment(n[3], n[2]);
      if (structures.contains(bottom)) faces[bottom].push_back({g, e, n[0] < n[1], solid_at(b, n[3], n[2])});
      if (structures.contains(top)) faces[top].push_back({g, e, n[3] > n[2], solid_at(b, n[0], n[1])});
    }
  }
  return faces;
}

// A structure has two faces: two joints at once on one of them means that one lies the wrong way round.
void check_faces(Builder& b) {
  const std::map<Segment, std::string> structures = segments_of_structures(b.model);
  if (structures.empty()) return;
  const Lives lives(b.model);
  std::set<std::pair<std::size_t, std::size_t>> reported;  // pairs of groups
  for (const auto& [ends, faces] : faces_of(b, structures))
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (std::size_t j = i + 1; j < faces.size(); ++j) {
        if (faces[i].left != faces[j].left || !lives.meet(faces[i].group, faces[j].group)) continue;
        if (!reported.insert(std::minmax(faces[i].group, faces[j].group)).second) continue;
        const bool first_wrong = faces[j].known && !faces[i].known;
        const Face &wrong = first_wrong ? faces[i] : faces[j], &other = first_wrong ? faces[j] : faces[i];
        const Group &group = b.model.groups[wrong.group], &beside = b.model.groups[other.group];
        b.error(
            "S327", b.at_line(line_of(group, wrong.element)),
            "element " + element_number(group, wrong.element) + " (" + group.element_name +
                ") lies on the same side of the structure between nodes " + node_number(b.model, ends.first) +
                " and " + node_number(b.model, ends.second) + " (element " + structures.at(ends) +
                ") as element " + element_number(beside, other.element) + " (" + beside.element_name +
                "): the sides of " + (other.known ? "the first" : "one of them") +
                " are swapped; nodes 1 and 2 must be those of the body on the right of the line from node 1 "
                "to node 2, nodes 3 and 4 those of the body on the left");
      }
}

// What a law answers without stress to a strain (of a joint: a displacement of its upper side); nothing where it gives no
// answer.
template <int N>
struct Answer {
  Vector<N> sigma;
  Matrix<N> D;
  PointStatus status;
};

template <int N>
std::optional<Answer<N>> answer(const Law<N>& law, const Vector<N>& strain) {
  std::vector<double> before = initial_values(law.traits().history), after = before;
  PointIn<N> in;
  PointOut<N> out;
  PointContext context;
  in.sigma0.setZero();
  in.eps0.setZero();
  if (!law.initialise(in.sigma0, before))
    return Answer<N>{Vector<N>::Zero(), Matrix<N>::Zero(), PointStatus::open};
  in.deps = strain;
  in.h0 = before;
  out.h1 = after;
  in.context = &context;
  if (law.update(in, out) != Outcome::ok) return {};
  return Answer<N>{out.sigma, out.D, out.status};
}

const Law<2>* joint_law(const Model& model, const Group& group) {
  const LawRef ref = model.material_of(group).law_ref();
  const auto* law = std::get_if<const Law<2>*>(&ref);
  return law == nullptr ? nullptr : *law;
}

// A joint that opens carries nothing: asked with an opening too small to break anything.
bool carries_tension(const Model& model, const Group& group) {
  const Law<2>* law = joint_law(model, group);
  if (law == nullptr) return true;
  const auto opened = answer<2>(*law, {0.0, 1e-12});
  return !opened || opened->sigma[1] > 0.0;
}

// Whether a joint slips, or yields to shear, long before it gives way across: pressed together by a tenth of its slip.
bool may_slip(const Model& model, const Group& group) {
  constexpr double kSoft = 0.01, kWay = 1e-6;
  const Law<2>* law = joint_law(model, group);
  if (law == nullptr) return false;
  const auto moved = answer<2>(*law, {kWay, -0.1 * kWay});
  return moved && (moved->status == PointStatus::slipping ||
                   std::abs(moved->sigma[0]) < kSoft * 10.0 * std::abs(moved->sigma[1]));
}

// Interfaces of two pairs along a curve: each follows a chord, and at a node that two chords share slip along the one opens
// or closes the other, so that a smooth pipe is held as if it were bonded.
void check_curved_joints(Builder& b) {
  constexpr double kAlong = 0.5, kCorner = 60.0;  // degrees from one to the next
  constexpr int kCurve = 3;                       // turns that make one
  const Model& model = b.model;
  for (const Group& group : model.groups) {
    if (!group.interface() || !group.entry->square() || group.node_count() != 4 || !may_slip(model, group))
      continue;
    std::map<int, int> from;  // elements by their first node
    for (int e = 0; e < group.elements(); ++e) from.emplace(group.nodes_of(e)[0], e);
    const auto way = [&](int e) -> Vector2 {
      const int* n = group.nodes_of(e);
      return model.mesh.x.col(n[1]) - model.mesh.x.col(n[0]);
    };
    int turns = 0, first = -1;
    double sharpest = 0.0;
    for (int e = 0; e < group.elements(); ++e) {
      const auto next = from.find(group.nodes_of(e)[1]);
      if (next == from.end()) continue;
      const Vector2 a = way(e), c = way(next->second);
      const double turn = std::abs(std::atan2(a.x() * c.y() - a.y() * c.x(), a.dot(c))) / kRadiansPerDegree;
      if (turn < kAlong || turn > kCorner) continue;
      if (++turns == 1) first = e;
      sharpest = std::max(sharpest, turn);
    }
    if (turns < kCurve) continue;
    b.warning(
        "S348", b.at_line(line_of(group, first)),
        "interface set " + std::to_string(group.number) + " follows a curve from element " +
            element_number(group, first) + " on, by " + rounded_text(sharpest, 3) + " degrees from one " +
            group.element_name +
            " to the next, and its law lets the bodies slip: along a polygon they can't, since a node that "
            "slides along one side opens or closes the next; take interface6 with quad8 and beam3, their "
            "nodes on the curve");
  }
}

// What a connected part of structures has to hold it.
struct Hold {
  std::size_t group = 0;  // of its first element
  int element = 0;
  bool otherwise = false, joints = false, tension = false;
  std::vector<Vector2> away = {};  // unit vectors along which joints open
};

// Along a direction all joints open, or none closes: unit vector; zero where there is none.
Vector2 free_direction(const std::vector<Vector2>& away, Geometry geometry) {
  constexpr double kNothing = 1e-6;
  const auto opens = [&](const Vector2& d) {
    double most = 0.0;
    for (const Vector2& n : away) {
      if (d.dot(n) < -kNothing) return false;
      most = std::max(most, d.dot(n));
    }
    return most > kNothing;
  };
  if (geometry == Geometry::axisymmetric) {
    for (const Vector2& d : {Vector2(0.0, 1.0), Vector2(0.0, -1.0)})
      if (opens(d)) return d;
    return Vector2::Zero();
  }
  constexpr int kDirections = 72;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * static_cast<double>(EIGEN_PI) * i / kDirections;
    if (const Vector2 d(std::cos(angle), std::sin(angle)); opens(d)) return d;
  }
  return Vector2::Zero();
}

// Connected parts of active structures, by number.
std::map<int, Hold> holds_of(const Model& model, const Activity& activity) {
  const auto active = [&](std::size_t g) { return activity.group[g] != 0; };
  const std::vector<int> parts =
      connected_parts(model, [&](std::size_t g, int) { return active(g) && model.groups[g].structure(); });
  const auto part_of = [&](int node) { return parts[node]; };
  std::map<int, Hold> holds;
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (const Group& group = model.groups[g]; active(g) && group.structure())
      for (int e = 0; e < group.elements(); ++e) holds.try_emplace(part_of(group.nodes_of(e)[0]), Hold{g, e});
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (const Group& group = model.groups[g]; active(g) && group.solid())
      for (const int node : group.nodes)
        if (part_of(node) >= 0) holds.at(part_of(node)).otherwise = true;
  for (int node = 0; node < model.mesh.nodes(); ++node)
    if (part_of(node) >= 0 && has_support(activity, node)) holds.at(part_of(node)).otherwise = true;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!active(g) || !group.interface()) continue;
    const bool tension = carries_tension(model, group);
    for (int e = 0; e < group.elements(); ++e) {
      const int* n = group.nodes_of(e);
      const Vector2 t = (model.mesh.x.col(n[1]) - model.mesh.x.col(n[0])).normalized();
      for (const auto& [node, away] :
           {std::pair(n[0], Vector2(t.y(), -t.x())), {n[3], Vector2(-t.y(), t.x())}}) {
        if (part_of(node) < 0) continue;
        Hold& hold = holds.at(part_of(node));
        hold.joints = true;
        hold.tension = hold.tension || tension;
        hold.away.push_back(away);
      }
    }
  }
  return holds;
}

void check_holds(Builder& b, const Stage& stage, const Activity& activity, std::set<std::size_t>& reported) {
  for (const auto& [node, hold] : holds_of(b.model, activity)) {
    if (hold.otherwise || !hold.joints || hold.tension || !reported.insert(hold.group).second) continue;
    const Group& group = b.model.groups[hold.group];
    const Vector2 free = free_direction(hold.away, b.model.geometry);
    const std::string words = "stage " + std::to_string(stage.number) + ": the structure with element " +
                              element_number(group, hold.element) + " (group " + std::to_string(group.number) +
                              ") is held by joints alone, which open without tension: ";
    if (free.isZero(0.0))
      b.note("S345", stage.where,
             words + "pressed on from both sides it stays, along the joints by their shear");
    else
      b.warning("S345", stage.where,
                words + "nothing but weight and pressure keeps it from moving off along (" +
                    rounded_text(std::round(1000.0 * free.x()) / 1000.0 + 0.0, 3) + ", " +
                    rounded_text(std::round(1000.0 * free.y()) / 1000.0 + 0.0, 3) +
                    "); hold a node, give the joint tension, or press it on before");
  }
}

// Elements that share rotations, and the nodes where something else holds them.
struct Turning {
  std::size_t group = 0;
  int element = 0;
  bool held = false;  // a rotation
  std::set<int> nodes = {};
};

// Parts of beams that turn together, in plane strain: one that hangs on a single node turns about it.
void check_turning(Builder& b, const Stage& stage, const Activity& activity, std::set<std::size_t>& reported) {
  const Model& model = b.model;
  const DofMap& map = activity.dof_map;
  Joined parts(static_cast<std::size_t>(map.dofs()));
  std::vector<int> dofs;
  const auto rotations = [&](const Group& group, int e) {
    map.list(group, e, dofs);
    std::erase_if(dofs, [&](int dof) { return !model.unknowns[map.at(dof).field].turns; });
  };
  const auto each = [&](const auto& act) {
    for (std::size_t g = 0; g < model.groups.size(); ++g)
      if (activity.group[g] != 0)
        for (int e = 0; e < model.groups[g].elements(); ++e) act(g, e);
  };
  each([&](std::size_t g, int e) {
    if (!model.groups[g].structure()) return;
    rotations(model.groups[g], e);
    for (const int dof : dofs) parts.join(dof, dofs.front());
  });
  std::vector<char> structure(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    if (group.structure())
      for (const int node : group.nodes) structure[node] = 1;
  std::map<int, Turning> found;
  std::map<int, std::set<int>> parts_at;  // of each node; -1: of what has no rotation
  each([&](std::size_t g, int e) {
    const Group& group = model.groups[g];
    if (!group.entry->moves()) return;
    dofs.clear();
    if (group.structure()) rotations(group, e);
    const int part = dofs.empty() ? -1 : parts.set_of(dofs.front());
    if (part >= 0) {
      Turning& turning = found.try_emplace(part, Turning{g, e}).first->second;
      for (const int dof : dofs) turning.held = turning.held || activity.held[dof] != 0;
      turning.nodes.insert(group.nodes_of(e), group.nodes_of(e) + group.node_count());
    }
    for (std::size_t i = 0; i < group.node_count(); ++i)
      if (const int node = group.nodes_of(e)[i]; structure[node]) parts_at[node].insert(part);
  });
  for (const auto& [part, turning] : found) {
    std::vector<int> hangs;
    bool shared = false;
    for (const int node : turning.nodes) {
      const bool more = parts_at[node].size() > 1;
      shared = shared || more;
      if (more || has_support(activity, node)) hangs.push_back(node);
    }
    if (turning.held || !shared || hangs.size() != 1 || !reported.insert(turning.group).second) continue;
    const Group& group = model.groups[turning.group];
    b.error(
        "S346", stage.where,
        "stage " + std::to_string(stage.number) + ": the beam with element " +
            element_number(group, turning.element) + " (group " + std::to_string(group.number) +
            ") hangs on node " + node_number(model, hangs.front()) +
            " alone and has no rotation support: it turns freely about it; hold its rotation there, or join "
            "it to a second node");
  }
}

// A straight side of the ground, x or y = const, at the edge of the mesh, all of whose nodes are held across it.
struct HeldSide {
  int normal = 0;  // 0: x = const
  double at = 0.0;
};

std::vector<HeldSide> held_sides(const Model& model, const Activity& activity, double tolerance) {
  std::vector<char> ground(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (activity.group[g] != 0 && model.groups[g].solid())
      for (const int node : model.groups[g].nodes) ground[node] = 1;
  std::vector<HeldSide> sides;
  for (int normal = 0; normal < 2; ++normal)
    for (const double sign : {-1.0, 1.0}) {
      const auto place = [&](int node) { return sign * model.mesh.x(normal, node); };
      double edge = -std::numeric_limits<double>::infinity();
      for (int node = 0; node < model.mesh.nodes(); ++node)
        if (ground[node] != 0) edge = std::max(edge, place(node));
      bool held = std::isfinite(edge);
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (int node = 0; held && node < model.mesh.nodes(); ++node) {
        if (ground[node] == 0 || place(node) < edge - tolerance) continue;
        held = activity.holds(node, normal);
        least = std::min(least, model.mesh.x(1 - normal, node));
        most = std::max(most, model.mesh.x(1 - normal, node));
      }
      if (held && most > least + tolerance) sides.push_back({normal, sign * edge});
    }
  return sides;
}

// Ends of beams that no other element of a beam shares, each with its element: node, group, element.
struct FreeEnd {
  std::size_t group = 0;
  int element = 0, corner = 0, count = 0;
};

std::map<int, FreeEnd> free_ends(const Model& model, const Activity& activity) {
  std::map<int, FreeEnd> ends;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    const bool beam =
        group.structure() && group.entry->corners == 2 &&
        std::ranges::any_of(group.entry->unknowns, [](const ElementUnknown& one) { return one.field.turns; });
    for (int e = 0; beam && activity.group[g] != 0 && e < group.elements(); ++e)
      for (int corner = 0; corner < 2; ++corner) {
        FreeEnd& end = ends.try_emplace(group.nodes_of(e)[corner], FreeEnd{g, e, corner, 0}).first->second;
        ++end.count;
      }
  }
  std::erase_if(ends, [](const auto& one) { return one.second.count > 1; });
  return ends;
}

// Whether the rotation of an end is the one that beams share, and free.  A hinge has a rotation of its own.
bool turns_freely(const Model& model, const Activity& activity, int node, const FreeEnd& end) {
  for (const ElementUnknown& unknown : model.groups[end.group].entry->unknowns) {
    if (!unknown.field.turns || unknown.field.name != "rotation") continue;
    if (!unknown.nodes.empty() && std::ranges::find(unknown.nodes, end.corner) == unknown.nodes.end()) continue;
    for (std::size_t field = 1; field < model.unknowns.size(); ++field)
      if (model.unknowns[field].name == unknown.field.name) {
        const int dof = activity.dof_map.of(node, static_cast<int>(field));
        return dof >= 0 && activity.held[dof] == 0;
      }
  }
  return false;
}

// On a line of symmetry the mirror image of a beam that crosses it keeps its end from turning.  Weight along the normal of
// a side shows that it is none.
void check_symmetric_ends(Builder& b, const Stage& stage, const Activity& activity, std::set<int>& reported) {
  const Model& model = b.model;
  const double size = (model.mesh.x.rowwise().maxCoeff() - model.mesh.x.rowwise().minCoeff()).maxCoeff();
  const double tolerance = 1e-9 * size;
  const std::map<int, FreeEnd> ends = free_ends(model, activity);
  if (ends.empty()) return;
  for (const HeldSide& side : held_sides(model, activity, tolerance)) {
    const auto along = static_cast<Eigen::Index>(side.normal);
    const bool weight =
        std::ranges::any_of(model.stages, [&](const Stage& one) { return one.gravity[along] != 0.0; });
    const bool axis = model.geometry == Geometry::axisymmetric && side.normal == 0;
    if (weight || axis) continue;
    std::string nodes;
    int count = 0;
    const FreeEnd* first = nullptr;
    for (const auto& [node, end] : ends) {
      const int other = model.groups[end.group].nodes_of(end.element)[1 - end.corner];
      const Vector2 axis_of_beam = model.mesh.x.col(other) - model.mesh.x.col(node);
      const bool crosses = std::abs(axis_of_beam[along]) > std::abs(axis_of_beam[1 - along]);
      const bool slides = activity.holds(node, side.normal) && !activity.holds(node, 1 - side.normal);
      if (std::abs(model.mesh.x(along, node) - side.at) > tolerance || !crosses || !slides ||
          !turns_freely(model, activity, node, end) || !reported.insert(node).second)
        continue;
      nodes += (count++ == 0 ? "" : ", ") + node_number(model, node);
      if (first == nullptr) first = &end;
    }
    if (first == nullptr) continue;
    const std::string name = side.normal == 0 ? "x" : "y";
    b.warning(
        "S372", stage.where,
        "stage " + std::to_string(stage.number) + ": group " +
            std::to_string(model.groups[first->group].number) + " has a beam that ends at node" +
            (count > 1 ? "s " : " ") + nodes + " of the side " + name + " = " + rounded_text(side.at) +
            ", where displacements along " + name +
            " are held but the rotation is free: on a line of symmetry the mirror image of the beam "
            "prevents the rotation; fix the unknown rotation there, or end the beam with a hinged element "
            "if a hinge is meant");
  }
}

// Unknowns with which an end parts from its node: a node has one of each, along the line of one element.
void check_releases(Builder& b) {
  const Model& model = b.model;
  const Lives lives(model);
  std::map<std::pair<int, std::string>, std::vector<std::pair<std::size_t, int>>> ends;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.structure()) continue;
    for (const ElementUnknown& unknown : group.entry->unknowns) {
      if (unknown.field.displacement() || unknown.field.turns || unknown.nodes.empty()) continue;
      for (int e = 0; e < group.elements(); ++e)
        for (const int i : unknown.nodes) ends[{group.nodes_of(e)[i], unknown.field.name}].emplace_back(g, e);
    }
  }
  for (const auto& [place, elements] : ends)
    for (std::size_t i = 1; i < elements.size(); ++i) {
      const auto& [g, e] = elements[i];
      const auto& [other_g, other_e] = elements[i - 1];
      if (!lives.meet(g, other_g)) continue;
      b.error("S347", b.at_line(line_of(model.groups[g], e)),
              "elements " + element_number(model.groups[other_g], other_e) + " and " +
                  element_number(model.groups[g], e) + " (" + model.groups[g].element_name +
                  ") have their released ends at one node, " + node_number(model, place.first) +
                  ", which has one " + place.second + " alone; start one of them at its other end");
      return;
    }
}

// Whether a section bends along the line alone, with nothing around the axis.
bool is_strip(const LawRef& ref) {
  constexpr int kBending = 3, kHoopBending = 4;  // docs/theory/structures.md
  const auto* const law = std::get_if<const Law<5>*>(&ref);
  if (law == nullptr) return false;
  const auto here = answer<5>(**law, Vector<5>::Zero());
  return here && here->D(kBending, kBending) > 0.0 && here->D(kHoopBending, kHoopBending) == 0.0;
}

// Strips that meet on the axis have no width there: their moment grows as 1/r towards it.
void check_strips(Builder& b) {
  const Model& model = b.model;
  if (model.geometry != Geometry::axisymmetric) return;
  const double on_axis = 1e-9 * model.mesh.x.row(0).cwiseAbs().maxCoeff();
  for (const Group& group : model.groups) {
    if (!group.structure() || group.entry->corners < 2 || !is_strip(model.material_of(group).law_ref()))
      continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* const nodes = group.nodes_of(e);
      if (model.mesh.x(0, nodes[0]) > on_axis && model.mesh.x(0, nodes[1]) > on_axis) continue;
      b.warning(
          "S352", b.at_line(line_of(group, e)),
          "group " + std::to_string(group.number) + ": element " + element_number(group, e) +
              " ends on the axis and bends along the radius alone, without hoop_bending_stiffness: strips "
              "that meet there have no width, and their moment grows as 1/r towards the axis, without "
              "bound as elements get smaller");
      break;
    }
  }
}

// A spring between two rotations of one node.
bool joins_rotations(const Group& group) {
  return group.structure() && group.node_count() == 1 &&
         std::ranges::count_if(group.entry->unknowns,
                               [](const ElementUnknown& unknown) { return unknown.field.turns; }) == 2;
}

// Rotations that anything but rotational springs acts on: elements, and supports of any stage.
std::set<std::pair<int, std::string>> rotations_in_use(const Model& model) {
  std::set<std::pair<int, std::string>> used;
  for (const Group& group : model.groups) {
    if (joins_rotations(group)) continue;
    for (const ElementUnknown& unknown : group.entry->unknowns) {
      if (!unknown.field.turns) continue;
      for (int e = 0; e < group.elements(); ++e)
        for (std::size_t i = 0; i < group.node_count(); ++i)
          if (unknown.nodes.empty() || std::ranges::count(unknown.nodes, static_cast<int>(i)) > 0)
            used.emplace(group.nodes_of(e)[i], unknown.field.name);
    }
  }
  const auto held = [&](const std::vector<FieldFixity>& cards) {
    for (const FieldFixity& card : cards)
      if (card.code == FixityCode::fixed) used.emplace(card.node, model.unknowns[card.field].name);
  };
  held(model.field_fixities);
  for (const Stage& stage : model.stages) held(stage.field_fixities);
  return used;
}

// A rotational spring whose stiffness comes from a thickness, or that nothing turns at one of its ends.
void check_rotational_springs(Builder& b) {
  const Model& model = b.model;
  if (std::ranges::none_of(model.groups, joins_rotations)) return;
  const auto used = rotations_in_use(model);
  for (const Group& group : model.groups) {
    if (!joins_rotations(group)) continue;
    const Material& material = model.material_of(group);
    if (std::ranges::any_of(material.entry->parameters,
                            [](const Parameter& p) { return p.role == ParameterRole::thickness; }))
      b.error("S625", group.where,
              "group " + std::to_string(group.number) + ": " + material.law_name + " is no law for a " +
                  group.element_name +
                  ", whose bending_stiffness is a moment per radian; use section_elastic "
                  "or section_plastic");
    for (int e = 0; e < group.elements(); ++e) {
      const int node = group.nodes_of(e)[0];
      for (const ElementUnknown& unknown : group.entry->unknowns) {
        if (!unknown.field.turns || used.contains({node, unknown.field.name})) continue;
        b.error("S626", b.at_line(line_of(group, e)),
                "element " + element_number(group, e) + " (" + group.element_name + "): node " +
                    node_number(model, node) + " has no beam with " + unknown.field.name +
                    " and no support of it, so that the spring has no effect; let one of the beams there start "
                    "with a hinge and another end without, or hold the rotation");
      }
    }
  }
}

// Prestress that the law can't carry: a tension-only anchor that is pushed, a force beyond the strength.
void check_prestress(Builder& b, const InitialStress& initial) {
  const Group& group = b.model.groups[initial.group];
  const bool lock_off = initial.kind == InitialKind::lock_off;
  if (!group.structure() || (initial.kind != InitialKind::uniform && !lock_off)) return;
  const double share = lock_off ? 1.0 / spacing_of(b.model.material_of(group).law_ref()) : 1.0;
  const Material& material = b.model.material_of(group);
  const bool carried = std::visit(
      [&]<int N>(const Law<N>* law) {
        Vector<N> sigma = Vector<N>::Zero();
        for (int i = 0; i < N; ++i) sigma[i] = 0.0 - share * initial.value[i];
        std::vector<double> history = initial_values(law->traits().history);
        return law->initialise(sigma, history);
      },
      material.law_ref());
  if (carried) return;
  const double force = initial.value[0];
  b.error("S351", initial.where,
          "group " + std::to_string(group.number) + ": " + material.law_name +
              " can't carry this prestress, an axial " + (force < 0.0 ? "tension of " : "compression of ") +
              rounded_text(std::abs(force)) + " " + b.model.units.force +
              (lock_off ? "; values are compression positive, of one bar"
                        : "; values are compression positive, for each unit of width"));
}

}  // namespace

void check_structures(Builder& b) {
  if (std::ranges::none_of(b.model.groups, [](const Group& group) { return group.structure(); })) return;
  check_faces(b);
  check_releases(b);
  check_strips(b);
  check_rotational_springs(b);
  check_curved_joints(b);
  for (const InitialStress& initial : b.model.initials) check_prestress(b, initial);
  for (const Stage& stage : b.model.stages)
    for (const InitialStress& initial : stage.initials) check_prestress(b, initial);
}

void check_held_structures(Builder& b) {
  if (std::ranges::none_of(b.model.groups, [](const Group& group) { return group.structure(); })) return;
  Activity activity(b.model);
  std::set<std::size_t> held, turning;
  std::set<int> ends;
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    const bool changed = !stage.births.empty() || !stage.deaths.empty() || !stage.fixities.empty() ||
                         !stage.turned_fixities.empty() || !stage.field_fixities.empty();
    if (!changed && &stage != &b.model.stages.front()) continue;
    check_holds(b, stage, activity, held);
    if (b.model.geometry == Geometry::plane_strain) check_turning(b, stage, activity, turning);
    check_symmetric_ends(b, stage, activity, ends);
  }
}

}  // namespace sage::builder
