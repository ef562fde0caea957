// Where the pore water of coupled elements has gone: what has left through each boundary, and what the soil has taken up.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

// Neighbouring nodes at which water may pass: supports, exits and loads of the excess pressure.
struct WaterBoundary {
  std::vector<int> nodes;  // indices, ascending
  double left = 0.0;       // volume since the beginning: full circle, or unit thickness
};

struct WaterBalance {
  std::vector<WaterBoundary> boundaries;  // by their first nodes
  double elsewhere = 0.0;                 // at nodes that let water through in an earlier stage
  double taken_up = 0.0;                  // by the soil, and by gaps of its interfaces
  double scale = 0.0;                     // sum of the volumes at all nodes, without their signs

  // 0 but for rounding.
  double difference() const;
};

// Of the active elements.  stage: from 0.
WaterBalance water_balance(const Model& model, int stage, const Solution& solution);
std::string water_balance_table(const Model& model, const WaterBalance& balance);

}  // namespace sage
