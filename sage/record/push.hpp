// Forces of supports that are moved, increment by increment, and their plateau.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

// Of the second half of a push, which is even in time.
struct Plateau {
  double mean = 0.0, scatter = 0.0;                // scatter: standard deviation of the increments
  double third_quarter = 0.0, last_quarter = 0.0;  // means
};

// forces: one per increment, eight or more.
Plateau plateau_of(const std::vector<double>& forces);

// Gathers the force on moved supports, per stage, from the calls of an Observer.
class Pushes {
 public:
  struct Push {
    int stage = 0;               // from 0
    int increments = 0;          // of the stage
    double weight = 0.0;         // of the ground on these supports, along the motion
    std::vector<double> forces;  // of loads and supports along the motion, by increment
  };

  // Whether some support is moved in the stage, and one of its nodes is flagged.
  static bool needs_nodes(const Model& model, int stage, std::span<const char> flags);
  void increment(const Model& model, const StepReport& report, const Solution& solution);
  void exchange(Archive& archive);

  // A line or two per push that reached its end, with `yielded` points at the last increment; else nothing.
  std::string text(const Model& model, long yielded) const;

 private:
  std::vector<Push> pushes_;
};

}  // namespace sage
