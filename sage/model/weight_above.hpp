// Vertical stress from all that lies above a place.
#pragma once

#include <optional>
#include <vector>

#include "sage/model/water.hpp"

namespace sage {

// At the end of a stage (0-based) in which these groups are active: soil, and on the ground structures with their loads and
// the water along them, or else free water.
class WeightAbove {
 public:
  WeightAbove(const Model& model, const std::vector<char>& groups, int stage);

  struct Above {
    double stress = 0.0;  // compression positive
    double level = 0.0;   // of free water, or else of the ground
  };
  // free_level: of free water; below the ground there is none.
  Above at(const Vector2& place, double free_level) const;

 private:
  // Edge of a structure on the ground.
  struct Line {
    Vector2 from, to;
    double stress;
  };
  std::optional<double> of_structures(const Vector2& place, double top) const;
  void add_structures(const Model& model, const std::vector<char>& groups, int stage);

  Overburden soil_;
  std::vector<Line> lines_;
  double gravity_ = 0.0, water_unit_weight_, reach_;
};

}  // namespace sage
