// Gives a deck its meaning: numbers become indices, generation cards become nodes and
// elements, signs are flipped.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/mesh/mesh_options.hpp"
#include "sage/model/model.hpp"
#include "sage/model/partial_factors.hpp"

namespace sage {

// A point report beside those of the deck's cards: displacement and strain count from the first stage.
struct PointRequest {
  Vector2 place = Vector2::Zero();
  std::string name;
  int group = 0;  // the deck's number; 0 = the first that holds the place
};

// Heads of an earlier run, wanted at nodes of a mesh that is whole.
struct HeadRequest {
  std::string file;              // the result file
  int stage = 0;                 // of the earlier run, from 1; 0 = its last
  const Model* model = nullptr;  // that of the nodes
  std::vector<int> nodes;
  std::vector<Vector2>
      inside;  // of each node: the middle of an element that has it, for nodes on a slit of the mesh
};
// A head for every node; NaN where the mesh of the earlier run does not hold its place.  Throws InputError that
// says why the file can't serve.
using HeadReader = std::function<std::vector<double>(const HeadRequest&)>;

// A parameter of a law that differs from place to place.
struct PlacedParameter {
  std::string material, parameter;              // name or number of the material; the law's name of it
  std::function<double(const Vector2&)> value;  // at a place, as the deck writes it
};

struct BuildOptions : MeshOptions {
  // Replaces the deck's formulation code of solid groups where it exists; -1 = as the deck says.
  int formulation = -1;
  // Replaces 4-node quadrilaterals by this element code (mid-side nodes are made); 0 = as the deck says.
  int element = 0;
  int solver = -1;       // catalogue code, 0 automatic; -1 = as the deck says
  int geometry = 0;      // 1 plane strain, 2 axisymmetric; 0 = as the deck says
  bool partial = false;  // what the program lacks may be left out (Deck::left_out); otherwise it is an error
  std::vector<PointRequest> points;  // behind the deck's reports
  HeadReader heads;                  // for water cards that name a result file; empty = they are refused
  bool dilates =
      true;  // false: the analysis takes all dilation away, and nothing is chosen or said because of it
  bool associated = false;  // solids dilate by their friction angle, whatever dilation the deck states
  std::vector<PartialFactors> factors;  // one set at most; empty = none
  ActionStages actions;                 // with factors
  bool points_outside = false;          // a requested point may lie outside: its report is blank then
  std::vector<PlacedParameter> placed = {};
};

// Throws InputError with every mistake found.  Warnings and notes end up in Model::diagnostics.
Model build_model(const Deck& deck, const Catalogue& catalogue, const BuildOptions& options = {});

// Units and materials only: the deck may lack everything else, or have it wrong.  Throws InputError for mistakes in those.
Model build_materials_alone(const Deck& deck, const Catalogue& catalogue, const BuildOptions& options = {});

}  // namespace sage
