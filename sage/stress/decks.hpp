// Decks that several rows share.
#pragma once

#include "sage/study/deck_writer.hpp"
#include "sage/study/whole_run.hpp"

namespace sage::stress {

using study::Block;
using study::Cell;
using study::DeckWriter;
using study::StageCards;

// Hyperbolic interface without hyperbola: k_s constant until slip at c + sigma_n tan phi.  Needs gamma_w = 1.
std::vector<double> coulomb(double c, double phi, double ks, double kn);

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
  std::string text() const;
};

// Axial stress (compression +) of a triaxial deck's run after a stage's last increment.
double axial_stress(const TriaxialDeck& deck, const study::WholeRun& run, std::size_t stage);

}  // namespace sage::stress
