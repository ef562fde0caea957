// What can be known to be wrong before anything is solved.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/core/contact.hpp"
#include "sage/core/law_remark.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/arc_sides.hpp"
#include "sage/model/locking.hpp"

namespace sage::builder {

namespace {

// Between the straight sides at the corners of a solid, in degrees.
double largest_angle(const Eigen::Matrix2Xd& x, const Element& element) {
  const auto& edges = element.edges();
  double largest = 0.0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& before = edges[(i + edges.size() - 1) % edges.size()];
    const Vector2 in = x.col(edges[i][0]) - x.col(before[0]), out = x.col(edges[i][1]) - x.col(edges[i][0]);
    const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    largest = std::max(largest, 180.0 - turn / kRadiansPerDegree);
  }
  return largest;
}

// Nodes that a finer mesh puts on a circle can fold an element that one more layer of elements would save.
std::string cure_on_arcs(const ArcSides& arcs, const Group& group, int e) {
  const auto& edges = group.element->edges();
  const int* const nodes = group.nodes_of(e);
  const bool on_arc = std::ranges::any_of(edges, [&](const std::vector<int>& edge) {
    return arcs.centre(nodes[edge[0]], nodes[edge[1]]).has_value();
  });
  return on_arc ? "; it lies along an arc, whose nodes a finer mesh puts on the circle: give the line of the "
                  "arc a "
                  "smaller size"
                : "";
}

void check_shapes(Builder& b) {
  constexpr std::size_t kShown = 20;
  constexpr double kPoorShape = 0.1;
  // A card may make a block of elements that all have one flaw: the first of them is named.
  struct Refused {
    int line = 0;
    std::string message;
    int more = 0;
  };
  std::vector<Refused> refused;
  const ArcSides arcs(b.model.mesh);
  int poor = 0;
  double worst = 1.0, worst_angle = 0.0;
  std::string worst_name;
  SourcePosition worst_where;
  Eigen::Matrix2Xd x;
  std::vector<double> geometry;
  for (const Group& group : b.model.groups) {
    geometry.resize(group.element->traits().geometry_size());
    std::string caution;
    int cautioned = 0;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(b.model.mesh, group, e, x);
      const auto eu = static_cast<std::size_t>(e);
      const auto name = [&] { return "element " + std::to_string(group.element_numbers[eu]); };
      try {
        group.element->geometry(x, geometry);
        const double quality = group.element->shape_quality(x);
        if (const std::string words = group.element->caution(x); !words.empty() && ++cautioned == 1)
          caution = name() + " (" + group.element_name + "): " + words;
        if (quality < kPoorShape) ++poor;
        if (quality < worst) {
          worst = quality;
          worst_angle = largest_angle(x, *group.element);
          worst_name = name();
          worst_where = b.at_line(group.element_lines[eu]);
        }
      } catch (const ElementShapeError& error) {
        const int line = group.element_lines[eu];
        if (!refused.empty() && refused.back().line == line)
          ++refused.back().more;
        else
          refused.push_back(
              {line, name() + " (" + group.element_name + "): " + error.what() + cure_on_arcs(arcs, group, e),
               0});
      }
    }
    if (cautioned > 1) caution += " (and " + std::to_string(cautioned - 1) + " more)";
    if (cautioned > 0) b.warning("S227", group.where, caution);
  }
  for (std::size_t i = 0; i < std::min(kShown, refused.size()); ++i) {
    const Refused& card = refused[i];
    b.error("S226", b.at_line(card.line),
            card.message + (card.more > 0 ? " (and " + std::to_string(card.more) + " more of this card)" : ""));
  }
  if (refused.size() > kShown)
    b.error("S226", b.deck.one("control").where(),
            "and " + std::to_string(refused.size() - kShown) + " more cards of elements with unusable shapes");
  if (poor > 0)
    b.warning("S227", worst_where,
              std::to_string(poor) + " element(s) badly distorted; worst " + worst_name +
                  ", smallest over mean Jacobian " + rounded_text(worst, 3) + ", largest inner angle " +
                  rounded_text(worst_angle, 3) + " degrees");
}

// A flag a node: only elements without displacements, which water flows through, have it otherwise.
std::vector<char> moved_nodes(const Model& model) {
  std::vector<char> moved(static_cast<std::size_t>(model.mesh.nodes()), 1);
  for (const Group& group : model.groups)
    if (!group.entry->moves())
      for (const int node : group.nodes) moved[node] = 0;
  for (const Group& group : model.groups)
    if (group.entry->moves())
      for (const int node : group.nodes) moved[node] = 1;
  return moved;
}

// ... nor can it turn.
void fix_turning_on_axis(Builder& b, double reach) {
  Model& model = b.model;
  const DofMap map(model);
  int added = 0;
  for (std::size_t field = 1; field < model.unknowns.size(); ++field) {
    if (!model.unknowns[field].turns) continue;
    for (int node = 0; node < model.mesh.nodes(); ++node) {
      const int f = static_cast<int>(field);
      if (std::abs(model.mesh.x(0, node)) > 1e-12 * reach || map.of(node, f) < 0) continue;
      const bool held = std::ranges::any_of(model.field_fixities, [&](const FieldFixity& other) {
        return other.field == f && other.node == node && other.code == FixityCode::fixed;
      });
      if (held) continue;
      FieldFixity fixity;
      fixity.field = f;
      fixity.node = node;
      fixity.code = FixityCode::fixed;
      model.field_fixities.push_back(fixity);
      ++added;
    }
  }
  if (added > 0)
    b.note("S328", b.at_line(0),
           std::to_string(added) + " node(s) of beams on the axis r = 0 held against turning, by symmetry");
}

// In axisymmetry a point on the axis can't move radially.
void fix_axis(Builder& b) {
  Model& model = b.model;
  if (model.geometry != Geometry::axisymmetric) return;
  const double reach = model.mesh.x.row(0).cwiseAbs().maxCoeff();
  std::vector<char> held(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Fixity& f : model.fixities)
    if (f.code[0] == FixityCode::fixed) held[f.node] = 1;
  const std::vector<char> moved = moved_nodes(model);
  int added = 0;
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const double r = model.mesh.x(0, node);
    if (r < -1e-12 * reach) continue;  // its elements are refused
    if (std::abs(r) > 1e-12 * reach || held[node]) continue;
    if (!moved[node]) continue;
    Fixity fixity;
    fixity.node = node;
    fixity.code[0] = FixityCode::fixed;
    model.fixities.push_back(fixity);
    ++added;
  }
  if (added > 0)
    b.note("S328", b.at_line(0),
           std::to_string(added) + " node(s) on the axis r = 0 held radially (u_r = 0 by symmetry)");
  fix_turning_on_axis(b, reach);
}

void note_unused_nodes(Builder& b) {
  const Model& model = b.model;
  std::vector<char> used(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    for (int node : group.nodes) used[node] = 1;
  const auto unused = std::count(used.begin(), used.end(), 0);
  if (unused == 0) return;
  const auto first = std::find(used.begin(), used.end(), 0) - used.begin();
  b.note("S329", b.at_line(0),
         std::to_string(unused) + " node(s) belong to no element and are ignored, the first is node " +
             std::to_string(model.mesh.number[first]));
  const auto refuse = [&](const Fixity& f) {
    const bool moved = f.value[0] != 0.0 || f.value[1] != 0.0;
    if (moved && !used[f.node])
      b.error("S330", b.at_line(f.line),
              "node " + std::to_string(model.mesh.number[f.node]) + " is displaced but belongs to no element");
  };
  for (const Stage& stage : model.stages) {
    for (const Fixity& f : stage.fixities) refuse(f);
    for (const TurnedFixity& f : stage.turned_fixities) refuse(f);
    for (const NodalLoad& load : stage.loads)
      if (!used[load.node])
        b.error(
            "S330", b.at_line(load.line),
            "node " + std::to_string(model.mesh.number[load.node]) + " is loaded but belongs to no element");
  }
}

// Materials that no group refers to are read and then ignored.
void note_unused_materials(Builder& b) {
  // By numbers: undrained groups have a twin of their material, which bears its number.
  std::set<int> used;
  for (const Group& group : b.model.groups) {
    used.insert(b.model.material_of(group).number);
    if (group.second_material >= 0) used.insert(b.model.materials[group.second_material].number);
  }
  for (const Stage& stage : b.model.stages)
    for (const InitialStress& initial : stage.initials)
      if (initial.kind == InitialKind::material) used.insert(static_cast<int>(initial.value[0]));
  for (const Material& material : b.model.materials)
    if (!used.contains(material.number))
      b.note("S329", material.where,
             "material " + std::to_string(material.number) + " is used by no group and is ignored");
}

// What the laws themselves find worth a warning, once a group.
void warn_materials(Builder& b) {
  for (const Group& group : b.model.groups) {
    const Material& material = b.model.material_of(group);
    const std::string words = std::visit([](const auto* law) { return law->caution(); }, material.law_ref());
    if (words.empty() || is_contact(*group.entry)) continue;  // contact without friction is often wanted
    const bool interface = group.interface();
    b.warning("S331", group.where,
              (interface ? "interface set " : "group ") + std::to_string(group.number) + ", material " +
                  std::to_string(material.number) + " (" + material.law_name + "): " + words);
  }
}

// What they say of themselves, once a material.
void note_remarks(Builder& b) {
  std::set<int> noted;
  for (const Group& group : b.model.groups) {
    const Material& material = b.model.material_of(group);
    const std::string words = std::visit([](const auto* law) { return remark_of(*law); }, material.law_ref());
    if (!words.empty() && noted.insert(material.number).second)
      b.note("S587", material.where,
             "material " + std::to_string(material.number) + " (" + material.law_name + "): " + words);
  }
}

bool has_initial_stress(const Model& model, int group) {
  const auto states = [&](const std::vector<InitialStress>& initials) {
    return std::ranges::any_of(initials, [&](const InitialStress& initial) {
      return initial.group == group && states_stress(initial.kind);
    });
  };
  return states(model.initials) ||
         std::ranges::any_of(model.stages, [&](const Stage& stage) { return states(stage.initials); });
}

// Laws whose strength and stiffness come from the stress of the ground.
void check_start_without_stress(Builder& b) {
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    const Material& material = b.model.material_of(group);
    const LawRef law = material.law_ref();
    const auto* const solid = std::get_if<const SolidLaw*>(&law);
    if (solid == nullptr || *solid == nullptr || has_initial_stress(b.model, static_cast<int>(g))) continue;
    std::vector<double> h = initial_values((*solid)->traits().history);
    if ((*solid)->initialise(Vector4::Zero(), h)) continue;
    b.error("S586", group.where,
            "group " + std::to_string(group.number) + ", material " + std::to_string(material.number) + " (" +
                material.law_name + "): the law can't start without stress; give the group an initial stress");
  }
}

// Whether beams of a part could hold it by their rotation.
bool turns(const Model& model, const std::vector<int>& part, int p) {
  const DofMap map(model);
  for (std::size_t field = 1; field < model.unknowns.size(); ++field)
    for (int node = 0; model.unknowns[field].turns && node < model.mesh.nodes(); ++node)
      if (part[node] == p && map.of(node, static_cast<int>(field)) >= 0) return true;
  return false;
}

std::string turning_words() {
  return " (the beams there have no rotation support: a fixity of the unknown rotation clamps a node)";
}

// Interfaces that would connect a part, but are not active: those that have a node of it, and those on the far side of an
// inactive structure between them.
std::vector<const Group*> inactive_joints(const Model& model, const Activity& activity,
                                          const std::vector<int>& part, int p) {
  std::vector<char> reached(part.size(), 0);
  for (std::size_t node = 0; node < part.size(); ++node) reached[node] = part[node] == p ? 1 : 0;
  std::set<std::size_t> found;
  for (int round = 0; round < 2; ++round) {
    const std::vector<char> before = reached;
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      const auto at = [&](int node) { return before[node] != 0; };
      if (activity.group[g] != 0 || !group.interface() || std::ranges::none_of(group.nodes, at)) continue;
      found.insert(g);
      for (const int node : group.nodes)
        if (part[node] < 0) reached[node] = 1;
    }
  }
  std::vector<const Group*> joints;
  for (const std::size_t g : found) joints.push_back(&model.groups[g]);
  return joints;
}

std::string joint_words(const std::vector<const Group*>& joints) {
  if (joints.empty()) return "; add fixities";
  constexpr std::size_t kShown = 6;
  std::string list;
  for (std::size_t i = 0; i < std::min(kShown, joints.size()); ++i)
    list += (i == 0 ? " " : ", ") + std::to_string(joints[i]->number) +
            (joints[i]->name.empty() ? "" : " (" + joints[i]->name + ")");
  if (joints.size() > kShown) list += ", ...";
  return joints.size() == 1 ? "; the interface group" + list +
                                  " beside it is not active in this stage: activate it with what it connects, "
                                  "or add fixities"
                            : "; the interface groups" + list +
                                  " beside it are not active in this stage: activate them with what they "
                                  "connect, or add fixities";
}

// Rigid motions left free, by connected part.
void check_supports_of(Builder& b, const Stage& stage, const Activity& activity) {
  constexpr std::size_t kShown = 5;
  const std::vector<int> part = connected_parts(b.model, activity);
  const bool several = !part.empty() && *std::max_element(part.begin(), part.end()) > 0;
  const std::vector<LoosePart> loose = loose_parts(b.model, activity, part);
  for (std::size_t i = 0; i < std::min(kShown, loose.size()); ++i)
    b.error("S323", stage.where,
            "stage " + std::to_string(stage.number) + ": nothing holds the " +
                (several ? part_name(b.model, part, loose[i].part) : "mesh") + " against " + loose[i].motion +
                joint_words(inactive_joints(b.model, activity, part, loose[i].part)) +
                (turns(b.model, part, loose[i].part) ? turning_words() : std::string()));
}

void check_supports(Builder& b) {
  Activity activity(b.model);
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    const bool changed = !stage.births.empty() || !stage.deaths.empty() || !stage.fixities.empty() ||
                         !stage.turned_fixities.empty();
    if (!changed && &stage != &b.model.stages.front()) continue;
    const int before = b.problems.errors();
    check_supports_of(b, stage, activity);
    if (b.problems.errors() > before) return;
  }
}

// A solver that would use one half of the matrix for both.
void check_solver(Builder& b) {
  const SolverEntry* solver = b.catalogue.solvers.find(b.model.solver);
  if (solver == nullptr || !solver->symmetric) return;
  for (const Group& group : b.model.groups) {
    const Material& material = b.model.material_of(group);
    if (std::visit([](const auto* law) { return law->traits().symmetric; }, material.law_ref())) continue;
    const bool from_deck = b.options.solver < 0;
    b.error("S324", from_deck ? b.deck.one("control").where("solver") : b.at_line(0),
            std::string(from_deck ? "solver " + std::to_string(b.model.solver) : "the option --solver") + ": " +
                solver->name + " is for symmetric matrices only, but material " +
                std::to_string(material.number) + " (" + material.law_name + ") of group " +
                std::to_string(group.number) +
                " has an unsymmetric tangent; 0 chooses a solver that fits, `sagefe list solvers` shows them");
    return;
  }
}

void warn_locking(Builder& b) {
  constexpr int kShown = 5;
  int found = 0;
  for (const Group& group : b.model.groups) {
    const ElementTraits& traits = group.element->traits();
    if (!group.solid() || !(traits.locks || traits.loses_order)) continue;
    const double nu = poissons_ratio(b.model.material_of(group));
    const bool undrained = group.excess >= 0;
    if (!nearly_incompressible(b.model, group) || ++found > kShown) continue;
    const std::string& remedy = group.entry->against_locking;
    const std::string what =
        traits.locks
            ? ": full integration locks near nu = 1/2 and reports too much stiffness; " +
                  (remedy.empty() ? "quad4 enhanced or 8-node quadrilaterals (reduced) do not" : remedy)
            : ": near nu = 1/2 its error is several times that at nu = 0.3 and falls more slowly with the "
              "mesh; quad4 enhanced or 8-node quadrilaterals (reduced) keep theirs";
    b.warning("S325", group.where,
              "group " + std::to_string(group.number) + " (" + group.element_name +
                  (undrained ? std::string(") is undrained") : ") has nu = " + rounded_text(nu, 7)) + what);
  }
  if (found > kShown)
    b.warning("S325", b.at_line(0),
              "and " + std::to_string(found - kShown) +
                  " more groups whose elements lock or lose accuracy near nu = 1/2");
}

// What makes the ground of a material grow while it flows, as words; empty = nothing.
std::string dilation_words(const Material& material) {
  const Dilation dilation = dilation_of(material);
  if (dilation.none()) return {};
  return dilation.angle > 0.0
             ? "a dilation angle of " + rounded_text(dilation.angle) + " degrees"
             : "a flow that dilates, " + rounded_text(dilation.share) + " of the associated one";
}

// Elements that resist a flow that dilates err on the unsafe side.  Numbers: docs/theory/accuracy.md.
void warn_dilation(Builder& b) {
  constexpr int kShown = 6;
  const Group* first = nullptr;
  std::string numbers, words;
  int found = 0;
  bool locks = false;
  for (const Group& group : b.model.groups) {
    if (!resists_dilation(*group.entry, group.element->traits()) || group.elements() == 0) continue;
    const std::string dilation = dilation_words(b.model.material_of(group));
    if (dilation.empty()) continue;
    if (first == nullptr) first = &group, words = dilation;
    locks = locks || group.element->traits().locks;
    if (++found <= kShown) numbers += (numbers.empty() ? "" : ", ") + std::to_string(group.number);
  }
  if (first == nullptr) return;
  const bool several = found > 1;
  if (found > kShown) numbers += " and " + std::to_string(found - kShown) + " more";
  b.warning("S355", first->where,
            (several ? "groups " : "group ") + numbers + " of 4-node elements (" + first->element_name + ") " +
                (several ? "have a flow that dilates, the first " : "has ") + words +
                ": they collapse too late, a slope with psi = 20 degrees at F = " +
                (locks ? "1.58 for 1.38 (14" : "1.52 for 1.38 (10") +
                " % too high); quad4 enhanced (--formulation 5) and 8-node elements (--element quad8) are "
                "within 2 %");
}

}  // namespace

void check_model(Builder& b) {
  check_shapes(b);
  if (b.problems.errors() == 0) check_interfaces(b);
  if (b.problems.errors() == 0) check_contact(b);
  if (b.problems.errors() == 0) check_structures(b);
  fix_axis(b);
  check_inactive(b);
  note_unused_nodes(b);
  note_unused_materials(b);
  check_water(b);
  check_joints(b);
  check_sides(b);
  warn_materials(b);
  note_remarks(b);
  check_start_without_stress(b);
  if (b.problems.errors() == 0) check_supports(b);
  if (b.problems.errors() == 0) check_held_structures(b);
  check_solver(b);
  warn_locking(b);
  if (b.options.dilates) warn_dilation(b);
}

}  // namespace sage::builder
