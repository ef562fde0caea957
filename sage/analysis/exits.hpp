// Where water may leave into air: seepage faces and drains.  At each of these nodes either the head (or excess pressure) is
// at its limit and water flows out, or it is lower and nothing flows but what a load brings: rain that soaks in, or ponds.
// Which of the two is found by switching.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sage/model/activity.hpp"

namespace sage {

class Exits {
 public:
  // Those of the model, up to and including a stage (from 0).
  void enter(const Model& model, const Activity& activity, int stage);
  bool any() const { return !places_.empty(); }

  // At the start of a step those are held whose head is at the limit; all, while no head is known anywhere.
  void start(const Eigen::VectorXd& u, std::vector<char>& held);
  // What the held ones have to rise in a step that is such a part of the stage, as a rate over the stage.
  void set_rates(const Eigen::VectorXd& u, double part, const std::vector<char>& held,
                 Eigen::VectorXd& rate) const;
  // After a step to the heads u with the inflows (internal - external) of all dofs: true where some place had to be
  // switched.
  bool update(const Eigen::VectorXd& u, const Eigen::VectorXd& inflow, std::vector<char>& held);
  // Dofs of excess pressures that are at their limit now.
  std::vector<int> open_pores(const std::vector<char>& held) const;
  std::vector<int> nodes() const;
  // Nodes that were switched last.
  const std::vector<int>& switched() const { return switched_; }

 private:
  struct Place {
    int node = 0, dof = 0;
    double limit = 0.0;
    bool of_pores = false;
  };
  void enter_field(const Model& model, const Activity& activity, int stage, int field, bool of_pores);
  double tolerance(const Place& place, const Eigen::VectorXd& u) const;

  std::vector<Place> places_;
  std::vector<int> switched_;
  double size_ = 0.0;  // height of the model
};

}  // namespace sage
