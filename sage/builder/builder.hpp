// Shared by the files that build a model; not part of the public interface.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "sage/builder/build_model.hpp"
#include "sage/deck/deck.hpp"
#include "sage/mesh/work.hpp"
#include "sage/model/dof_map.hpp"
#include "sage/model/solid_edges.hpp"

namespace sage::builder {

inline constexpr std::int64_t kLargestNumber = std::numeric_limits<int>::max();  // of a node or an element

// Where an element of the deck ended up.
struct ElementPlace {
  int group = 0, element = 0;
  int folded = -1;  // edge of the card, from 0, that vanished when its quadrilateral became a triangle
};

// Numbers first, first + step ... last.  Wider than the deck's integers, so that
// counting past the last is safe.
struct NumberRange {
  std::int64_t first = 0, last = -1, step = 1;  // empty as it stands
};

// An edge of a solid by its end nodes, counter-clockwise around the element.
struct DirectedEdge {
  int group = 0, element = 0, edge = 0;
};

// Ground of one unit weight over the whole width.
struct GroundLayer {
  double top = 0.0, bottom = 0.0, unit_weight = 0.0;
  double stress = 0.0;  // vertical at its top, compression positive: the weight of all above
};

// A water card whose pressures come from heads of an earlier run, once the mesh is whole.
struct StoredHeads {
  std::size_t card = 0;  // of Model::water
  std::string file;      // as the card names it
  SourcePosition where;  // of the name
  int stage = 0;
};

// Everything that the steps of building share; operations on the mesh see the part that is theirs.
struct Builder : mesh::Work {
  const BuildOptions& options;
  std::unordered_map<int, int> group_index = {};
  std::unordered_map<int, int> material_index = {};
  ByNumber<ElementPlace> element_place = {};
  std::optional<SolidEdges> solids = {};  // of the finished mesh: solid_edges()
  DofMap dof_map = {};                    // once the elements are known
  // By indices of their end nodes; filled when first asked.
  std::map<std::pair<int, int>, DirectedEdge> edges = {};
  std::vector<int> blank_weights = {};  // materials whose unit weight is left blank
  // Groups that a removal card takes away, by the card's index: its elements have groups of their own.
  std::unordered_map<int, std::vector<int>> removed = {};
  // The ground at the start, from the top down, where a start_stress card asks for it.
  std::vector<GroundLayer> layers = {};
  std::vector<StoredHeads> stored_heads = {};
  int water_nodes = 0;                 // when the water cards were read
  std::vector<int> layer_pieces = {};  // groups whose elements had to be told apart by layers
  // False once a card of that kind was refused: what refers to it is then not reported as missing as well.
  bool nodes_known = true, materials_known = true, groups_known = true, elements_known = true;

  // A number that an analysis can use: finite and below 1e100 (its square must not overflow).
  bool usable(const CardView& card, std::string_view field, double value);
  // A name or title; a warning where it had to be changed to be a text.
  std::string text(const CardView& card, std::string_view field);
  // Index of a deck node; -1 and an error where it doesn't exist.
  int node(const CardView& card, std::string_view field, std::int64_t number);
  // The fields `first_field`, last and step of a card.  A blank or zero last means the first only, step 0 is 1.
  // Empty, and an error, where they make no range.
  NumberRange range(const CardView& card, std::string_view first_field);
  // Made once, where a check asks for it.
  const SolidEdges& solid_edges() { return solids ? *solids : solids.emplace(model); }
  // Error at a place that names a group which no card defines.
  void group_missing(const SourcePosition& where, int number);
};

// Of build_stages.cpp, for the stages that build_steps.cpp makes.
std::vector<int> node_range(Builder& b, const CardView& card);  // empty after an error
bool outside_stages(const Deck& deck, const CardView& card);
// duration: of the stage of the card; 0 = it belongs to no stage.
void read_load(Builder& b, const CardView& card, std::vector<NodalLoad>& out,
               std::vector<FieldLoad>& out_fields, double duration = 0.0);
void read_pressure(Builder& b, const CardView& card, std::vector<EdgeLoad>& out);

// The cards that the builder knows, of a deck that has others: those of other programs, and model files.
std::optional<Deck> cards_of(const Deck& as_read, const Catalogue& catalogue);

void build_control(Builder& b);
void build_plugins(Builder& b);  // those that the deck names must have been loaded
// Behind a message about a code that is unknown; empty where no plug-in could have it.
std::string plugin_hint(int code);
// load_control of a stage card; check_controls: once all stages are known.
void read_control(Builder& b, const CardView& card, Stage& stage);
void check_controls(Builder& b);
void build_nodes(Builder& b);
void build_materials(Builder& b);
void build_groups(Builder& b);
void build_elements(Builder& b);
// Gives the elements that removal cards name by number groups of their own.
void split_removed(Builder& b);
void build_stages(Builder& b);
// Elements of a group whose key is not negative move to a group of their own, one a key; the groups by key.
// Their names end with `name` and the key, from 1.
std::map<int, int> split_group(Builder& b, int group, const std::vector<int>& keys, const std::string& name);
// Finds the layers of the ground for a start_stress card and gives the parts of a group in different layers
// groups of their own.  An error where layers of different unit weight lie side by side.
void split_layers(Builder& b);
// The start_stress card as the first stage; `stage` holds what else the stage does.
void add_start_stress(Builder& b, Stage stage);
// Stages that cards outside of stages ask for: start stress, loads by factors, displacements in equal
// increments, removals.
void build_steps(Builder& b);
// A stage for every factor by which the strengths are divided.
void build_strength_stages(Builder& b);
// Pressure and shear on an edge that is given by its nodes.  `forces`: of what is not linear along the edge.
void read_edge_load(Builder& b, const CardView& card, std::vector<EdgeLoad>& out,
                    std::vector<NodalLoad>& forces);
// An initial card about the law of its group (kinds 5 to 7); before: those of the same stage that stand before it.  False
// after an error.
bool read_law_card(Builder& b, const CardView& card, bool in_stage, InitialStress& initial,
                   const std::vector<InitialStress>& before);
// Laws that differ by point or stage, once the mesh is whole.
void build_laws(Builder& b);
// Makes every group one of elements under large strain.  An error for each that has none, and for what decks have that large
// strain can't be with.
void take_large_strain(Builder& b);
// Pore pressures and undrained groups.
void build_water(Builder& b);
// Pressures of cards that name the result file of an earlier run, at the nodes of the whole mesh.
void take_stored_heads(Builder& b);
void build_reports(Builder& b);
// Places of point reports: outside the mesh, or where several bodies meet.
void check_points(Builder& b);
// Nodes and elements made against the totals that the control card states.
void check_totals(Builder& b);
// Numbers that are valid and yet unlikely: warnings and notes.
void check_plausible(Builder& b);
// Units and magnitudes: warnings where a number is likely in another unit than the deck's.
void check_units(Builder& b);
// Footings on meshes that can't tell their collapse load: warnings.
void check_coarse(Builder& b);
// Solids that cover the same ground: an error; on the same hand of a common edge: a warning.
void check_overlap(Builder& b);
// Interfaces whose sides belong to the wrong bodies.
void check_interfaces(Builder& b);
void check_contact(Builder& b);
// Loads and displacements on inactive nodes and elements.
void check_inactive(Builder& b);
// Shapes, supports, unused nodes, radii, solver.
void check_model(Builder& b);
// Cards of stages that contradict each other or can't act.
void check_stages(Builder& b);
// Straight sides that are held over a part of their length.
void check_sides(Builder& b);
// Lines that discharge is asked for, weights of what has none, and water that nothing balances.
void check_water(Builder& b);
// Nodes at one place, hanging nodes, joints without a solid on one side.
void check_joints(Builder& b);
// Structures: which side of a joint is which, and ends that are released; what holds them, once supports are known
// to hold all.
void check_structures(Builder& b);
void check_held_structures(Builder& b);

}  // namespace sage::builder
