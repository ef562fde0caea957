// The box around the nodes that elements have, and how far displacements differ in it.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

class Extent {
 public:
  explicit Extent(const Model& model);

  double size() const { return size_; }  // its longer side
  // u: one entry per dof.  How much displacements along an axis differ, as a share of the extent along it: about
  // the mean strain, and none for a translation.  Around an axis of symmetry the radial displacement itself
  // strains.
  double motion(const Eigen::VectorXd& u) const;

 private:
  bool axisymmetric_;
  std::vector<int> nodes_;
  Vector2 sides_ = Vector2::Zero();
  double size_ = 0.0;
};

}  // namespace sage
