// Structures beside joints, held by them alone, free to turn about a node, and released ends that meet.
#include <algorithm>
#include <cmath>
#include <cstdint>
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
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    const bool changed = !stage.births.empty() || !stage.deaths.empty() || !stage.fixities.empty() ||
                         !stage.turned_fixities.empty() || !stage.field_fixities.empty();
    if (!changed && &stage != &b.model.stages.front()) continue;
    check_holds(b, stage, activity, held);
    if (b.model.geometry == Geometry::plane_strain) check_turning(b, stage, activity, turning);
  }
}

}  // namespace sage::builder
