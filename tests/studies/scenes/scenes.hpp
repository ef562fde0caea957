// Scenes that several studies and tests share.
#pragma once

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::scenes {

// Parameters of a hyperbolic interface (law 22) without hyperbola: k_s constant until slip at c + sigma_n tan
// phi. Needs gamma_w = 1.
std::vector<double> coulomb(double c, double phi, double ks, double kn);

// Ground of unit cells, surface at y = 0, sides on rollers, fixed below; no material, group or element yet.
struct Ground {
  Block block;
  DeckWriter deck;
  Ground(int geometry, Cell cell, int columns, int rows);
};

// A heavy block, 4 x 1, of unit weight 20 on an interface of law 22; what holds it
// sideways is the interface alone.
struct BlockOnPlane {
  static constexpr double weight = 80.0;  // of all of it
  Block block;
  DeckWriter deck{1};
  explicit BlockOnPlane(const std::vector<double>& joint);
};

// A solid of one law in a triaxial cell, radius 1, height 2, between smooth plates: law, parameters, cell
// pressure, strain (compression +) of each stage, increments a stage.
struct TriaxialDeck {
  int law = 1;
  std::vector<double> parameters;
  double cell = 0.0;
  std::vector<double> strains{0.01};
  int increments = 1, method = 0, max_iterations = 0;
  bool rough_base = false;
  int geometry = 2, columns = 2, rows = 2;

  Block block() const;
  DeckWriter deck() const;
  std::string text() const { return deck().text(); }
};
// Axial stress (compression +) of a triaxial deck's run after a stage's last increment.
double axial_stress(const TriaxialDeck& deck, const WholeRun& run, std::size_t stage);

// Quarter of a cylinder, radius 1, half-height L/D, E = 1, whose ends may be held: the
// source chapter's problem.
struct RestrainedCylinder {
  double slenderness = 1.0, nu = 0.25;  // L/D; nu >= .5: incompressible
  Cell cell = Cell::quad8;
  int formulation = 1, columns = 16, rows = 16;
  double power = 3.0;  // cells get finer towards the rim of the platen; 1 = uniform

  Block block() const;
  DeckWriter deck() const;                                      // one stage, in which nothing happens yet
  DeckWriter between_rough_platens(double strain = 1.0) const;  // compressed, all of the end in one piece
  // F / (pi a^2 E eps) of the run of the latter.
  double ratio(const WholeRun& run, double strain = 1.0) const;
};

// Cook's membrane (0, 0) (48, 44) (48, 60) (0, 44) in plane strain, clamped on the left,
// shear force F on the right.
struct CookDeck {
  double E = 1.0, nu = 1.0 / 3.0, F = 1.0;
  Cell cell = Cell::quad4;
  int formulation = 0, n = 16;
  double power = 1.0;  // above 1 cells get finer towards the left, right and upper sides: (0, 44) is singular,
                       // at (48, 60) the shear on one side and none on the other leave no single stress

  Block block() const;
  DeckWriter deck() const;
};

}  // namespace sage::scenes
