// Dofs that are eliminated from a stage before its iterations, as the iterations see them.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace sage {

// The answers where there are none.
class EliminatedDofs {
 public:
  virtual ~EliminatedDofs() = default;

  virtual const std::vector<int>& dofs() const { return none_; }
  // Of their factors; negative = not known.
  virtual double smallest_pivot() const { return -1.0; }
  // Work of the step's loads on them while all others are held (twice that of a ramp).
  virtual double held_work() const { return 0.0; }
  // Work of loads along the step du, whose eliminated dofs need not be recovered.
  virtual double load_work(const Eigen::VectorXd& loads, const Eigen::VectorXd& du) const {
    return loads.dot(du);
  }
  // One flag per node: it has such a dof.
  virtual const std::vector<char>& nodes() const { return no_nodes_; }

 private:
  std::vector<int> none_;
  std::vector<char> no_nodes_;
};

}  // namespace sage
