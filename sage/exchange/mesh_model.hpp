// A mesh of another program as the skeleton of a model: areas become groups, and named curves, points and sets of nodes
// become supports, loads, structures and water lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/model/model.hpp"

namespace sage {

// What a named part of the mesh is used for.
struct MeshUse {
  enum class Kind { none, fix, pressure, force, beam, bar, water };
  Kind kind = Kind::none;
  std::string name;           // of the part of the mesh
  bool x = false, y = false;  // fix
  Vector2 value{0.0, 0.0};    // force; the pressure at its x
};

// kind: "fix", "pressure", ...; text: "NAME=xy", "NAME=25", "NAME=5,-10", "NAME".  Throws std::invalid_argument with what
// was expected.
MeshUse mesh_use(std::string_view kind, std::string_view text);

// What a mesh can't say; zeros are placeholders that `sagefe check` rejects with the card to fill in.
struct ForeignMeshOptions {
  Geometry geometry = Geometry::plane_strain;
  double youngs_modulus = 0.0, poissons_ratio = 0.0, unit_weight = 0.0;
  double water_weight = 0.0;
  bool geometry_given = false;
  std::vector<MeshUse> uses = {};
};

// MSH 4.1 (text or binary) and 2.2 (text) of Gmsh, .inp of Abaqus and CalculiX.  Names in the mesh such as fix_xy and
// pressure=100 (or pressure:100) are uses too.  All act in the only stage, together with gravity.  Other curves are left out
// with a warning.  Elements listed clockwise are turned round, nodes of no element are dropped.  The laws are not made: the
// model is for writing, not for running.  Throws InputError with the line, for constants that no material has, and for a
// use whose name the mesh lacks.
Model model_from_mesh(std::string_view text, const std::string& file, const Catalogue& catalogue,
                      const ForeignMeshOptions& options);

}  // namespace sage
