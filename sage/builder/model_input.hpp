// A model from numbers in memory, for programs that have no deck: the same cards, checks and messages as a deck.
//
// Nodes, materials, groups, elements and stages are numbered from 1 in the order of their lists: here, in messages and
// in decks that are written of the model.  Signs and units are those of a deck: stress and pressure positive in
// compression, displacements and forces along the axes, in axisymmetry for the full circle, angles in degrees.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sage/builder/build_model.hpp"

namespace sage {

struct MaterialInput {
  std::string law;                           // name in the catalogue: "drucker_prager"
  std::map<std::string, double> parameters;  // by name; those left out have the law's own value, if it has one
  double unit_weight = 0.0;
  std::string name = {};
  double saturated_unit_weight = 0.0;  // of solids below a phreatic line; 0: the same
};

struct GroupInput {
  std::string element;  // name in the catalogue: "quad4"
  int material = 1;
  // The nodes of each: corners counter-clockwise, then the middle nodes of the sides 1-2, 2-3 ... (deck_format.md).
  std::vector<std::vector<int>> elements;
  std::string formulation = {};  // "b-bar"; empty: the element's own
  std::string name = {};
  bool overlay = false;     // lies on the elements of other groups on purpose
  int second_material = 0;  // of elements that have two laws; 0 = none
};

// Of each of the nodes.  Values are displacements of this stage.
struct SupportInput {
  std::vector<int> nodes;
  FixityCode x = FixityCode::unchanged, y = FixityCode::unchanged;
  double x_value = 0.0, y_value = 0.0;
  std::string unknown = {};  // another field than displacement, its code and value in x
  TimeTable history = {};    // of an excess pressure
  bool exit = false;         // of a field: water may leave at the value, none comes in (code 2)
  double angle = 0.0;        // degrees, anticlockwise from x: x is along a line at this angle, y normal to it
};

// In every stage the nodes move as another one does.  to_step: from it to the node that the next of them is tied to.
struct TieInput {
  std::vector<int> nodes;
  int to = 0;
  bool x = true, y = true;
  int to_step = 0;
};

// Added on each of the nodes in this stage.
struct LoadInput {
  std::vector<int> nodes;
  double x = 0.0, y = 0.0;
  std::string unknown = {};  // another field than displacement, its load in x
  TimeTable history = {};    // of an excess pressure
};

// Added in this stage on the same edge, counted from 1, of each of the elements; linear along it.
struct PressureInput {
  std::vector<int> elements;
  int edge = 1;
  double normal1 = 0.0, normal2 = 0.0, shear1 = 0.0, shear2 = 0.0;
  std::string unknown = {};  // excess_pressure: normal1 and normal2 are inflows per area and time
  TimeTable history = {};    // of such an inflow
};

struct InitialInput {
  int group = 1;
  InitialKind kind = InitialKind::uniform;
  std::vector<double> values;  // at most six, as on the card `initial`
};

struct StageInput {
  std::string title = {};
  int increments = 1;
  Method method = Method::newton;
  int max_iterations = 0;  // 0: the program's own, as for the tolerance
  double tolerance = 0.0;
  Vector2 gravity = Vector2::Zero();  // added, in multiples of the unit weights: (0, -1) is the whole weight
  double duration = 1.0;
  PoreWater pores = PoreWater::kept;
  double theta = 1.0;    // of the theta method of flowing pore water, 0.5 .. 1
  double grading = 1.0;  // each increment over the one before
  double time_error = 0.0, end_degree = 0.0, end_pressure = 0.0;  // as in Stage
  std::vector<double> output_times = {};
  std::string load_control = {};  // as on the card: "12 y -0.05"
  std::vector<SupportInput> supports = {};
  std::vector<LoadInput> loads = {};
  std::vector<PressureInput> pressures = {};
  std::vector<InitialInput> initials = {};
  std::vector<int> births = {}, deaths = {};  // groups
};

struct ReportInput {
  ReportKind kind = ReportKind::nodes;
  std::vector<int> nodes = {};  // not of a point
  int group = 0;                // of a triaxial specimen; of a point: the one that answers, 0 = the first
  int stage = 1;                // from which strains count
  double height = 0.0, area = 0.0, cell_pressure = 0.0;
  Vector2 place = Vector2::Zero();  // of a point; of a section: first end of its cut
  std::string name = {};            // of a point or section
  Vector2 end = Vector2::Zero();    // of a section: second end of its cut
};

struct ModelInput {
  std::string name = "model";  // stands before messages as a deck's file does
  std::string title = {};
  Geometry geometry = Geometry::plane_strain;
  UnitSystem units = {};
  std::string solver = {};  // name in the catalogue; empty: automatic
  bool large_strain = false;
  std::vector<Vector2> nodes = {};
  std::vector<MaterialInput> materials = {};
  std::vector<GroupInput> groups = {};
  std::vector<SupportInput> supports = {};  // in every stage
  std::vector<TieInput> ties = {};
  std::vector<InitialInput> initials = {};
  std::vector<StageInput> stages = {};
  std::vector<ReportInput> reports = {};
};

// The cards of the input.  Each has a line of its own, on which messages show it: "element  number 4  group 1  n1 7 ...".
// Throws InputError for laws, parameters, elements, formulations and solvers that the catalogue lacks.
Deck make_deck(const ModelInput& input, const Catalogue& catalogue);

// Throws InputError with every mistake found, as for a deck.  sage1_text() writes the model as one.
Model build_model(const ModelInput& input, const Catalogue& catalogue, const BuildOptions& options = {});

}  // namespace sage
