// Scenes of walls, struts, linings, tanks, rafts and piles in soil: small decks, of which legacy_inputs/structures has a
// copy.
#pragma once

#include <string>
#include <vector>

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::scenes {

// Ground with a wall, both 1 m between nodes along depth: soil inside (left) and outside (right) of the wall, which ends
// inside the soil, interfaces on both faces.  Lifts inside are dug one a stage, from stage 2 on.  In axisymmetry a round
// shaft with rings in place of struts.
struct WallInGround {
  int geometry = 1;
  int inside = 6, outside = 8;          // columns
  double half_width = 6.0, far = 20.0;  // of the cut; from the wall to the side
  int depth = 16, toe = 10;             // of the ground, of the wall
  std::vector<int> levels{2, 4, 6};     // depth after each lift
  double cohesion = 5.0, friction = 30.0, dilation = 0.0, adhesion = 2.0, wall_friction = 20.0;
  double moment_strength = 0.0;         // M_p of the wall, of the stiffness of strips; 0 = elastic
  double E = 30000.0, thickness = 0.3;  // of the soil; of the wall
  bool goes_around =
      true;  // a plate; else strips side by side, without hoop force: of a shaft the rings then carry all
  double weight = 18.0, K0 = 0.5;
  double tip_spring = 0.0;  // stiffness of a vertical spring below the wall's tip; 0 = none

  struct Strut {
    int level;               // depth
    int born;                // stage, from 1
    int dies = 0;            // stage; 0 never
    double prestress = 0.0;  // of one strut, compression positive
    bool anchor = false;     // outside, tension alone, to held ground
  };
  double strut_stiffness = 6e5, spacing = 3.0;  // EA of one
  double anchor_strength = 0.0;                 // of one anchor; 0 = elastic
  std::vector<Strut> struts;

  // Numbers of groups.
  static constexpr int kSoil = 1, kWall = 10, kInside = 11, kOutside = 15, kStruts = 20;
  int stride() const { return inside + outside + 1; }
  int node(int i, int depth_of) const { return 1 + (depth - depth_of) * stride() + i; }
  int wall(int depth_of) const { return node(inside, depth_of) + 6000; }
  int stages() const;
  DeckWriter deck(int last_stage = 0) const;  // 0: all
};

// What the interfaces, struts and the toe put on a wall, for each unit of width or, in axisymmetry, of circumference.
struct WallForces {
  Vector2 outside = Vector2::Zero(), inside = Vector2::Zero();  // forces on the wall
  double outside_moment = 0.0, inside_moment = 0.0;             // of their x parts about the ground's surface
  double struts = 0.0, struts_moment = 0.0;                     // x force on the wall
  double hoop = 0.0, hoop_moment = 0.0;                         // of the shell, towards the axis negative
  std::vector<double> each;  // compression of a strut for each unit of width, by its place in the list
  std::vector<double> outer_pressure;  // of the earth outside by depth, 0, 1, ... (means over a node's part)
  double largest_moment = 0.0, top = 0.0;  // of the wall (absolute); its displacement
  double balance() const { return outside.x() + inside.x() + struts + hoop; }
  double moment_balance() const { return outside_moment + inside_moment + struts_moment + hoop_moment; }
};
WallForces wall_forces(const WallInGround& scene, const WholeRun& run);

WallInGround braced_excavation(int geometry);
WallInGround cantilever_sheet_pile();
WallInGround anchored_sheet_pile();

// Right half of a pipe, radius 1, in fill: the first lift is a box of 4 to each side, `lifts` of 1 m come above.
struct Culvert {
  bool slipping = false;
  double EA = 2e5, EI = 20.0, E = 1e4, nu = 0.3, weight = 20.0;
  int lifts = 4;
  static constexpr int kAround = 16;
  DeckWriter deck(int last_stage = 0) const;
};
// Upper half of the pipe: what the interface puts on it, downwards and from both sides, and its thrust beside the
// horizontal axis.
struct CulvertForces {
  double down = 0.0, thrust_down = 0.0;  // of one half; balance: equal
  double crown = 0.0, springline = 0.0;  // thrust of the nearest elements, compression positive
  double least = 0.0, most = 0.0;        // thrust of all
  double moment = 0.0;                   // at the crown, pulling the inner side
};
CulvertForces culvert_forces(const WholeRun& run);

// A round tank, radius 5, wall 6 high, filled with water of 10, on elastic ground 25 wide and deep.
struct TankOnSoil {
  double bottom = 0.2, wall = 0.1, E_soil = 2e4, nu_soil = 0.3;
  bool shell = true;  // else the load alone
  int columns = 5, rows = 8;
  static constexpr double radius = 5.0, height = 6.0;
  int surface(int i) const { return 1 + rows * stride() + i; }  // nodes along the ground, from the axis
  int stride() const { return 2 * columns + 1; }
  int wall_node(int j) const { return 5000 + j; }  // from the base, 1 to 25
  DeckWriter deck() const;
};

// Right half of a raft, 2 wide, under 1 for each unit of area on ground 5 wide and deep (E = 1), of layers or not.
struct RaftOnGround {
  double EI = 1.0, EA = 1e6, nu = 0.3;
  std::vector<double> moduli{1.0};  // of layers of one thickness, from the top
  bool whole_width = false;         // raft and load from side to side
  int columns = 5, outside = 5, rows = 8;
  double load = 1.0;
  int stride() const { return columns + outside + 1; }
  int surface(int i) const { return 1 + rows * stride() + i; }
  DeckWriter deck() const;
};

// A closed pipe pile, radius .25, in clay of strength that sticks to it (phi = 0), pushed down in stages.
struct PipePile {
  double radius = 0.25, length = 10.0, adhesion = 20.0, E = 2e4, nu = 0.3, strength = 40.0;
  double EA = 2e6;
  int rows = 16, pile_rows = 10, columns = 8;  // of elements; `columns` outside
  std::vector<double> settlements{0.01, 0.04};
  int stride() const { return columns + 3; }
  int pile(int depth) const { return 6001 + (rows - depth) * stride() + 2; }
  DeckWriter deck() const;
};
struct PileForces {
  double head = 0.0, shaft = 0.0;  // forces of the full circle, downwards on the pile and upwards by the soil
  double tip = 0.0;                // thrust at the lower end of the shell
};
PileForces pile_forces(const PipePile& pile, const WholeRun& run);

// A deck of legacy_inputs/structures.
struct ShippedDeck {
  std::string name;      // its folder
  std::string comments;  // lines before its first card
  DeckWriter deck;
  std::string text() const;
};
std::vector<ShippedDeck> structure_decks();

}  // namespace sage::scenes
