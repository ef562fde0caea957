// Displacement and stress at any place: the solid element that holds it is found, and what its nodes have is
// interpolated by its shape functions.
#pragma once

#include "sage/output/nodal_values.hpp"

namespace sage {

struct Sample {
  Vector2 at = Vector2::Zero();
  int element = 0;                    // deck number; 0 = in no active solid, and then all below is NaN
  Vector2 u = Vector2::Zero();        // along +x (+r) and +y (+z)
  Vector4 stress = Vector4::Zero();   // compression positive [xx yy zz xy]
  double mean = 0.0, deviator = 0.0;  // p (compression positive) and q = sqrt(3 J2) of that stress
};

class Sampler {
 public:
  // Stress at nodes: extrapolated from the points, averaged over the elements of the same material.  Model and
  // solution must outlive the sampler.
  Sampler(const Model& model, const Solution& solution);

  // On an edge that two materials share the element that comes first in the deck answers.
  Sample at(const Vector2& place) const;

 private:
  struct Box {
    std::size_t group = 0;
    int element = 0;
    Vector2 low, high;
  };
  bool inside(const Box& box, const Vector2& place, std::vector<double>& N) const;

  const Model* model_;
  Solution solution_;
  NodalLayout layout_;
  std::vector<double> stress_;  // entries x 4, tension positive
  std::vector<Box> boxes_;      // of all active solid elements
};

}  // namespace sage
