// The model: what the deck means.  Plain data with internal signs (tension +) and 0-based indices.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/messages/error.hpp"

namespace sage {

// Sides of elements, one after the other, that follow a circle.
struct Arc {
  Vector2 centre = Vector2::Zero();
  std::vector<std::pair<int, int>> ends;  // nodes (indices) at the ends of each side
};

struct Mesh {
  Eigen::Matrix2Xd x;       // one column a node
  std::vector<int> number;  // the deck's node numbers; mid-side nodes made here get numbers above the deck's
  int deck_nodes = 0;       // nodes from here on were made by the program
  int made_between = 0;     // how many of the last were made between those that the elements' cards give
  // Length: a place so close outside a solid counts as on its edge, however small the
  // elements there are (Locator).
  double reach = 0.0;
  std::vector<Arc> arcs;  // of a drawing; cards know none (sage/model/arc_sides.hpp)

  int nodes() const { return static_cast<int>(number.size()); }
  int given_nodes() const { return nodes() - made_between; }  // of cards, or made by refining
};

// A law and its parameters, one of several that the points of a group may have in force (law_table.hpp).
struct LawVariant {
  std::shared_ptr<const MaterialEntry> entry;
  std::vector<double> parameters;  // as the deck writes them
  std::string material;            // name of the material
  bool held = false;               // the stress stays whatever the strain does
};

struct Material {
  int number = 0;
  std::string name;
  int code = 0;  // catalogue code of the law
  std::string law_name;
  std::shared_ptr<const MaterialEntry> entry;
  std::vector<double> parameters;      // as the deck writes them
  double unit_weight = 0.0;            // force / length^3
  double saturated_unit_weight = 0.0;  // of solids below a phreatic line; 0: the same
  LawPtr law;
  SourcePosition where;
  bool undrained = false;            // the law stands within one of sage/model/undrained.hpp
  bool twin = false;                 // made for some of the groups of another material, with its number
  std::vector<LawVariant> variants;  // that points may have in force; empty = the law of `parameters` alone

  LawRef law_ref() const;
  // The first parameter of a role as the deck writes it; nothing where the law has none.
  std::optional<double> parameter(ParameterRole role) const;
};

// From a stage on, which variant of its material each point of a group has in force.
struct LawChoice {
  int stage = 0;              // 0-based
  bool anew = false;          // the history of that law begins with the stress of then
  std::vector<int> of_point;  // element after element; a single one = of all points
  SourcePosition where;
};

// Elements of one formulation and one material; connectivity in one flat array.
struct Group {
  int number = 0;
  std::string name;
  int element_code = 0, formulation = 0;
  std::string element_name;  // "quad4 b-bar"
  std::shared_ptr<const ElementEntry> entry;
  std::shared_ptr<const Element> element;
  int material = 0;          // index into Model::materials
  int second_material = -1;  // of the second law, of elements that have two (ElementTraits::second_law_size)
  std::vector<int> element_numbers;
  std::vector<int> element_lines;  // deck line of each element
  std::vector<int> nodes;          // element->traits().nodes each
  // Lies on the elements of other groups on purpose, as pore water does in soil.
  bool overlay = false;
  SourcePosition where;
  int excess = -1;  // place of the excess pore pressure in the law's history; -1 = never undrained
  std::vector<LawChoice> choices;  // by stage; empty = the material has one law

  int elements() const { return static_cast<int>(element_numbers.size()); }
  const int* nodes_of(int e) const { return nodes.data() + static_cast<std::size_t>(e) * node_count(); }
  std::size_t node_count() const { return static_cast<std::size_t>(element->traits().nodes); }
  const Formulation& formulation_entry() const;
  bool solid() const { return entry->solid(); }
  bool interface() const { return entry->interface(); }
  bool structure() const { return entry->structure(); }
  bool flow() const { return entry->flow(); }
};

// Makes a group one of these elements.  formulation: 0 = the first.  Throws ParameterError for one that the
// element lacks, std::logic_error for a code that the catalogue lacks.
void set_element(Group& group, const Catalogue& catalogue, int code, int formulation, Geometry geometry);

enum class FixityCode { unchanged, fixed, released };

// Shares of a value by the time since the start of a stage, ascending: linear between, from 0 at the start where that is left
// out, the last share behind the last time.  Empty: in proportion to the load factor.
using TimeTable = std::vector<std::pair<double, double>>;
double share_at(const TimeTable& table, double time);
std::string history_text(const TimeTable& table);  // "0 0 2 1", as on cards

// Share of a card's value that is added at a load factor of its stage, which lasts that long.
template <class Card>
double share_of(const Card& card, double load_factor, double duration) {
  return card.history.empty() ? load_factor : share_at(card.history, load_factor * duration);
}

// From its stage on.  `value` is the displacement added over the stage.
struct Fixity {
  int node = 0;
  std::array<FixityCode, 2> code{};
  std::array<double, 2> value{};
  int line = 0;
  TimeTable history = {};
};

// A support with axes of its own, as others are in x and y: component 0 along a line, component 1 normal to it.
struct TurnedFixity : Fixity {
  double angle = 0.0;  // of the line: degrees, anticlockwise from x, above 0 and below 90
};
// Unit vector of a component of such a support.
Vector2 turned_axis(double angle, std::size_t component);

// In every stage the node moves as another one does, in x, y or both.
struct Tie {
  int node = 0, to = 0;
  std::array<char, 2> component{};  // flags
  int line = 0;
};

struct NodalLoad {
  int node = 0;
  Vector2 force = Vector2::Zero();  // added over the stage
  int line = 0;
  TimeTable history = {};
};

struct EdgeLoad {
  int group = 0, element = 0;  // element: index within the group
  int edge = 0;                // 0-based local edge
  Vector2 normal =
      Vector2::Zero();  // pressure > 0 pushes into the element, at the edge's first and second corner
  Vector2 shear = Vector2::Zero();
  int line = 0;
  TimeTable history = {};
};

// A support or a load in a field of one number a node (Model::unknowns); as Fixity and NodalLoad are.
struct FieldFixity {
  int field = 1, node = 0;
  FixityCode code = FixityCode::unchanged;
  double value = 0.0;
  int line = 0;
  TimeTable history = {};  // of excess pressures
};

struct FieldLoad {
  int field = 1, node = 0;
  double value = 0.0;  // added over the stage
  int line = 0;
  TimeTable history = {};  // of excess pressures
};

// What a support or a load of a field has added at a load factor of its stage, which lasts that long.
template <class Card>
double added_at(const Card& card, double load_factor, double duration) {
  return card.value * share_of(card, load_factor, duration);
}

// From its stage on, until a card holds or releases the head of the node: water may leave there, and does as soon
// as it stands at this pressure head above the node; none comes in but what loads bring.  Of excess pressures: as soon as
// they reach this pressure.
struct Exit {
  int node = 0;
  double pressure_head = 0.0;
  int line = 0;
  int field = -1;  // of Model::unknowns; -1 = the head
};

enum class InitialKind {
  uniform,    // given stress (solids: xx yy zz xy; interfaces: shear, normal; structures: the law's components)
  geostatic,  // vertical stress from a surface level and unit weight, horizontal by K0
  zero,       // explicitly none
  traction,   // interfaces: the traction that the neighbouring group's initial stress puts on the interface
  history,    // history of the law: number of the first quantity (from 1), then values; NaN = left as it is
  lock_off,  // bars, in a stage: the force of one bar that stands at its end; from the next stage on the bar is elastic
  material,  // in a stage: number of the material that the group goes on with; its stress stays
  parameter,  // number of a parameter (from 1), level, growth per depth below it, growth per effective vertical stress
  at_rest,  // weight of the solids above, horizontal by K0: that of normally consolidated soil, OCR, POP, stress at the surface
};
// Of the others the stress stays as it is.
inline bool states_stress(InitialKind kind) {
  return kind == InitialKind::uniform || kind == InitialKind::geostatic || kind == InitialKind::traction ||
         kind == InitialKind::lock_off || kind == InitialKind::at_rest;
}
// Cards of the law of a group, not of its stress.
inline bool is_about_law(InitialKind kind) {
  return kind == InitialKind::material || kind == InitialKind::parameter;
}

struct InitialStress {
  int group = 0;  // index into Model::groups
  InitialKind kind = InitialKind::uniform;
  std::array<double, 6> value{};  // as the deck writes them; see docs/manual
  SourcePosition where;
};

enum class WaterKind {
  dry,        // no pore pressure
  line,       // hydrostatic below a phreatic line
  ratio,      // r_u times the weight above
  nodes,      // given at nodes
  heads,      // from the heads of flow elements at the start of the stage
  undrained,  // water can't leave: its bulk over the porosity adds to that of the grains
  drained,    // what was undrained lets its excess go over the stage
  // 7 on cards: heads of an earlier run, which become pressures at nodes
  drawdown =
      8,  // rapid: free water falls to a line, and the pressure in the ground by a share of what that takes away
};
enum class WaterAction {
  edges,  // water stands at free edges where there is pressure behind them, and in joints
  none,   // pressure in the solids alone
  force,  // seepage force and buoyancy in place of pressures; all free edges are balanced by water
};

// From its stage on, until a later card of the same group: pore pressure, or (undrained, drained) how it moves.
struct WaterCard {
  int stage = 0;   // 0-based
  int group = -1;  // index; -1 = all solids.  Of structures: the free water on their sides
  WaterKind kind = WaterKind::dry;
  WaterAction action = WaterAction::edges;
  // ratio: r_u.  undrained: bulk of the water over the porosity.  drawdown: that share, B-bar.  structures: > 0 left side,
  // < 0 right, 0 both
  double value = 0.0;
  std::vector<Vector2> line;                  // by rising x
  std::vector<std::pair<int, double>> nodes;  // node index and pressure
  SourcePosition where;

  bool pressure() const { return kind != WaterKind::undrained && kind != WaterKind::drained; }
  // Places have a pressure without regard to nodes.
  bool by_place() const {
    return kind == WaterKind::line || kind == WaterKind::ratio || kind == WaterKind::drawdown;
  }
};

enum class Method { newton, modified_newton, initial_stiffness, dogleg };

// What the water in the pores of coupled elements does in a stage.
enum class PoreWater {
  kept,     // its pressures stay as they are, and as much as that needs comes or goes
  shut_in,  // none moves: undrained
  flows,    // consolidation
};

// Indirect displacement control: over its stage the displacement of a node, or what it exceeds that of another one by, grows
// in proportion to the increments.  The share of the stage's loads that this needs is unknown, and may fall.
struct LoadControl {
  int node = -1;   // index; -1 = the loads grow by themselves
  int other = -1;  // index of the node whose displacement is subtracted; -1 = none
  int component = 0;
  double growth = 0.0;
};

struct Stage {
  int number = 0;
  std::string title;
  int increments = 1;
  double duration = 1.0;  // for laws that depend on time; the load factor grows in proportion to time
  PoreWater pores = PoreWater::kept;
  double theta = 1.0;    // of the theta method of flowing pore water, 0.5 .. 1
  double grading = 1.0;  // each increment over the one before
  // Of flowing pore water.  Largest error of one step that is chosen by its error, as a share of the largest root mean square
  // of excess pressure in the stage; 0 = steps are those of the increments.
  double time_error = 0.0;
  // The stage ends as soon as this degree of consolidation is reached, or no excess pressure is above that; 0 = by its time.
  double end_degree = 0.0, end_pressure = 0.0;
  std::vector<double> output_times;  // since the start of the stage; each is the end of an increment
  std::vector<double> ends;          // load factors at the ends of increments; empty = by the grading
  int divisions =
      0;  // increments of the card, where `increments` counts those of output and table times too; 0 = none are added
  Method method = Method::newton;
  int max_iterations = 25;
  int output_every = 1;
  std::vector<int> output_at;         // increments asked for besides, when the deck was run; ascending
  double tolerance = 1e-8;            // relative out-of-balance force at the end of an increment
  Vector2 gravity = Vector2::Zero();  // added over the stage, in multiples of the materials' unit weight
  std::vector<Fixity> fixities;
  std::vector<TurnedFixity> turned_fixities;
  std::vector<NodalLoad> loads;
  std::vector<FieldFixity> field_fixities;
  std::vector<FieldLoad> field_loads;
  std::vector<Exit> exits;
  std::vector<EdgeLoad> pressures;
  std::vector<int> births, deaths;      // groups
  std::vector<InitialStress> initials;  // of groups born in this stage
  double strength_factor = 0.0;         // by which the strengths were divided for it; 0 = it is about no factor
  bool resets_displacements = false;    // displacements count from its start
  LoadControl control;
  SourcePosition where;

  int given_increments() const { return divisions > 0 ? divisions : increments; }
  // Of displacements, forces and edge loads.
  bool has_mechanical_histories() const {
    const auto has = [](const auto& card) { return !card.history.empty(); };
    return std::ranges::any_of(fixities, has) || std::ranges::any_of(loads, has) ||
           std::ranges::any_of(pressures, has);
  }
  bool has_histories() const {
    const auto has = [](const auto& card) { return !card.history.empty(); };
    return has_mechanical_histories() || std::ranges::any_of(field_fixities, has) ||
           std::ranges::any_of(field_loads, has);
  }
  // Supports of displacements do.
  bool moves_supports() const {
    const auto moves = [](const Fixity& f) { return f.value[0] != 0.0 || f.value[1] != 0.0; };
    return std::ranges::any_of(fixities, moves) || std::ranges::any_of(turned_fixities, moves);
  }
  bool is_controlled() const { return control.node >= 0; }
  bool may_end_early() const { return end_degree > 0.0 || end_pressure > 0.0; }
};

enum class ReportKind { triaxial = 1, nodes = 2, point = 3, discharge = 4, uplift = 5, section = 6 };

// triaxial: axial force of the listed nodes against the law's own answer for frictionless ends.
// nodes: displacement and force summed over the listed nodes, a row an increment.
// point: displacement, strain and stress at a place, a row an increment.
// discharge: what flows through a line of nodes, from its left to its right, a row an increment.
// uplift: the weight above a line of nodes against the water below it, a row at the end of each stage.
// section: normal force, shear force and bending moment of the solids along a straight cut, a row an increment.
struct Report {
  ReportKind kind = ReportKind::triaxial;
  // triaxial: of the specimen; point: the one that answers where several meet, -1 = the first; section: the one that is cut,
  // -1 = all solids
  int group = -1;
  std::vector<int> nodes;
  double height = 0.0, area = 0.0, cell_pressure = 0.0;
  Vector2 place = Vector2::Zero();  // point; section: first end of the cut
  Vector2 end = Vector2::Zero();    // section: its second end
  std::string name;                 // point, section; may be empty
  std::vector<std::string> fields;  // point: more than the usual ones, by name
  int stage = 0;                    // strain and deviator count from the start of this stage (0-based)
  SourcePosition where;
};

struct Model {
  std::string file, title;
  Geometry geometry = Geometry::plane_strain;
  UnitSystem units;
  int solver = 0;  // catalogue code, 0 = automatic
  // Strains of any size: all elements are those of ElementEntry::make_large.
  bool large_strain = false;
  FieldTable fields;  // what results have, besides the history of the laws
  Mesh mesh;
  std::vector<Material> materials;
  std::vector<Group> groups;
  std::vector<UnknownField> unknowns{displacement_field()};  // displacement, then those of the elements
  std::vector<Fixity> fixities;                              // before the first stage; values must be zero
  std::vector<TurnedFixity> turned_fixities;                 // likewise
  std::vector<Tie> ties;
  std::vector<FieldFixity> field_fixities;  // likewise
  std::vector<InitialStress> initials;
  std::vector<Stage> stages;
  std::vector<WaterCard> water;  // in the order of the deck
  std::vector<Report> reports;
  Diagnostics diagnostics;            // warnings and notes of reading and building
  std::vector<std::string> left_out;  // what the deck asks for and this is without, to be named with results
  std::vector<std::string> plugins;   // that the deck names

  const Material& material_of(const Group& group) const { return materials[group.material]; }
  // Place among the unknowns of the excess pressure of pore water; -1 = no element solves for it.
  int pore_field() const {
    const auto found = std::ranges::find(unknowns, true, &UnknownField::of_pores);
    return found == unknowns.end() ? -1 : static_cast<int>(found - unknowns.begin());
  }
  bool has_pores() const { return pore_field() >= 0; }
  bool has_turned_supports() const {
    return !turned_fixities.empty() ||
           std::ranges::any_of(stages, [](const Stage& stage) { return !stage.turned_fixities.empty(); });
  }
  // Several dofs may have one equation.
  bool combines_dofs() const { return has_turned_supports() || !ties.empty(); }
  // Holds nullptr where the group has one law.
  LawRef second_law_of(const Group& group) const {
    if (group.second_material < 0) return {};
    return materials[group.second_material].law_ref();
  }
};

// Area under a triaxial report's nodes: the deck's, or pi r_max^2, or the width in plane
// strain.  NaN without nodes.
double report_area(const Model& model, const Report& report);

// Local number of the node in the middle of an element's edge, a card's mid-side node; -1 where there is none
// (degrees 1 and 3).
inline int middle_of(const std::vector<int>& edge) {
  const std::size_t inner = edge.size() - 2;
  return inner % 2 == 1 ? edge[2 + inner / 2] : -1;
}

// Local number of the i-th of so many nodes that an element's card gives: corners and the middle nodes of the
// sides, or more.
std::size_t node_of_card(const Group& group, std::size_t i, std::size_t given);

// Coordinates of an element's nodes, in x (2 x nodes).
void element_coordinates(const Mesh& mesh, const Group& group, int element, Eigen::Matrix2Xd& x);

}  // namespace sage
