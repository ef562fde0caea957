// Rigorous bounds on a collapse load or on the factor of safety on strength.  docs/theory/bounds.md
#pragma once

#include <optional>
#include <string>

#include "sage/bounds/programs.hpp"

namespace sage::bounds {

struct Options {
  Quantity quantity = Quantity::load;
  int elements = 2000;      // the mesh is refined until it has about so many triangles; 0 = as it is
  double gap = 0.01;        // or until the bounds are so close, relative to their mean
  double tolerance = 1e-4;  // relative, of a factor of safety
  double accuracy = 1e-5;   // relative, of the optimum of each program
  double smallest = 0.05, largest = 20.0;  // factors of safety that are tried
  std::function<bool()> stop_asked;
};

// One bound.  It has a value only where its field passed the check.
struct Bound {
  std::optional<double> value;
  std::string reason;     // why there is none
  double residual = 0.0;  // of equilibrium (lower) or of the flow rule (upper), relative
  double reserve =
      0.0;              // least distance to yield (lower) or of a strain rate to the limit of dilation (upper),
                        // relative; not negative
  double margin = 0.0;  // what strictness cost: distance to the optimum of the program, relative
  int solved = 0, iterations = 0;  // programs, and iterations of all of them
};

// One mesh.
struct Round {
  int triangles = 0;
  std::optional<double> lower, upper;
};

struct Bounds {
  Bound lower, upper;
  std::vector<Round> rounds;
  bool stopped = false;
  // Fields of the last mesh, in the units of the domain.
  Domain domain;
  Edges edges;
  Eigen::Matrix3Xd stress;    // effective [xx yy xy], tension +, by triangle and corner; empty = none
  Eigen::Matrix2Xd velocity;  // of nodes, then of the middles of edges; largest 1; empty = none
  std::vector<double> gap;    // by triangle: its part of the distance between the bounds, sum 1; empty = none

  // Relative to the mean of both; nothing where one is missing.
  std::optional<double> relative_gap() const;
};

Bounds find_bounds(const Domain& domain, const Options& options);

// What a coarser mesh proved stays proved: the last bounds, or the best before them where these lack one.  Rounds are
// those of the last.
Bounds proved(Bounds best, Bounds last);

// With c / F and tan(phi) / F.
Domain reduced(Domain domain, double factor);

}  // namespace sage::bounds
