// Cholesky factors of a sum of small matrices, for the interior point method: matrices that become ill-conditioned
// on purpose, where a solver that rejects small pivots (PivotCheck) would stop too early.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace sage::bounds {

// One small matrix: the equations that it couples, and where it lies (for the numbering alone).
struct Coupling {
  std::vector<int> equations;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

// Multifrontal L L^T by nested dissection of the couplings by their places.
class SparseFactor {
 public:
  // left_out: equations whose unknown is 0.
  SparseFactor(int equations, std::span<const Coupling> couplings, std::span<const int> left_out = {});

  // The matrix to be factorised: `part(i)` gives the i-th small matrix (of which the lower triangle is read) in the
  // order of its equations.  Pivots below `negligible` of their diagonal term mark an equation that depends on
  // earlier ones: it is left out, and its unknown becomes 0.
  template <class Part>
  void factorise(const Part& part, double negligible) {
    dropped_ = 0;
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
      clear_front(f);
      for (const int i : fronts_[f].couplings) scatter(i, part(i));
      eliminate(f, negligible);
    }
  }
  // x = K^-1 b in place.
  void solve(Eigen::VectorXd& x) const;
  int dropped() const { return dropped_; }

 private:
  struct Front {
    int begin = 0, end = 0;  // of its set in the order of all couplings
    std::vector<int> couplings, children;
    std::vector<int> equations;  // those that are eliminated here come first
    int pivots = 0;
    Eigen::MatrixXd factor;  // equations x pivots
    Eigen::MatrixXd border;  // what remains for the parent; empty once it has been added there
  };

  int divide(std::vector<int>& order, int begin, int end, std::span<const Coupling> couplings);
  void number(const std::vector<int>& order, int equations);
  void clear_front(std::size_t f);
  void scatter(int coupling, const Eigen::MatrixXd& part);
  void eliminate(std::size_t f, double negligible);

  std::vector<Front> fronts_;  // children before their parents
  std::vector<Coupling> couplings_;
  std::vector<int> place_;      // of an equation in the front under way
  std::vector<char> left_out_;  // by equation
  Eigen::MatrixXd work_;
  int dropped_ = 0;
};

}  // namespace sage::bounds
