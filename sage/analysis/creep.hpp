// Where the corrections of a damped step lead: whether the ground goes on moving, or is only shaken to and fro.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace sage {

class Creep {
 public:
  // of_solids: by dof of displacements, whether a solid has it; it must outlive this.  size: of the model, a length.
  Creep(const std::vector<char>& of_solids, double size) : of_solids_(&of_solids), size_(size) {}

  // After every correction.  du: the step so far, every dof; it begins with zero.  residual: its size.
  void take(const Eigen::VectorXd& du, double residual);

  // The last corrections moved the ground by the size of the model, or no number is left.
  bool flows() const;
  // They only moved what hangs on joints, structures as a rule.
  bool spares_ground() const;
  // They cancel each other, and the residual no longer falls: more of them are of no use.
  bool is_shaken() const;

 private:
  double largest(bool of_solids) const;
  double length(const Eigen::VectorXd& motion) const;

  const std::vector<char>* of_solids_;
  double size_;
  Eigen::VectorXd du_, recent_;    // the step so far; sum of its corrections, of which older ones count less
  double path_ = 0.0;              // the same sum of their lengths
  std::vector<double> residuals_;  // all
};

}  // namespace sage
