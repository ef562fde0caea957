// Where the corrections of a damped step lead: whether the ground goes on moving, or is only shaken to and fro.
#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

namespace sage {

class Creep {
 public:
  // of_solids: by dof of displacements, whether a solid has it; it must outlive this.  size: of the model, a length.
  Creep(const std::vector<char>& of_solids, double size) : of_solids_(&of_solids), size_(size) {}

  // After every correction.  du: the step so far, every dof.  residual: its size.
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
  double one_way() const;

  const std::vector<char>* of_solids_;
  double size_;
  std::deque<Eigen::VectorXd> steps_;  // the last ones
  std::vector<double> residuals_;      // all
};

}  // namespace sage
