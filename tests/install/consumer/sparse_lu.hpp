// A solver of one's own: Eigen's SparseLU behind sage/core/linear_solver.hpp.  This is the example of
// solvers/README.md.
#pragma once

#include <Eigen/SparseLU>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"
#include "sage/messages/error.hpp"

namespace own {

class SparseLu final : public sage::LinearSolver, public sage::KeptMatrix {
 public:
  const sage::SolverTraits& traits() const override { return traits_; }

  void analyse(int equations, sage::ElementEquations elements) override {
    elements_ = std::move(elements);
    K_.resize(equations, equations);
    clear();
  }

  void clear() override { terms_.clear(); }

  // K comes column by column; equation -1 is a prescribed dof.
  void add(int element, const double* K) override {
    const std::span<const int> equations = elements_.of(element);
    for (const int column : equations)
      for (const int row : equations) {
        if (row >= 0 && column >= 0) terms_.emplace_back(row, column, *K);
        ++K;
      }
  }

  void factorise() override {
    if (K_.rows() == 0) return;  // every displacement is prescribed; SparseLU does not take such a matrix
    K_.setFromTriplets(terms_.begin(), terms_.end());
    lu_.compute(K_);
    if (lu_.info() != Eigen::Success) throw sage::SingularMatrix(-1, 0.0, lu_.lastErrorMessage());
    // SparseLU divides by any pivot that is not zero: 1 / (|K| |K^-1 1|) is what is left of one.
    const double left = 1.0 / (norm1() * lu_.solve(Eigen::VectorXd::Ones(K_.rows())).cwiseAbs().maxCoeff());
    constexpr double kRounding = 1e-15;
    if (!(left > kRounding)) throw sage::SingularMatrix(-1, left, "no digit of K is left in its inverse");
  }

  sage::SolveStatus solve(std::span<const double> b, std::span<double> x) const override {
    if (K_.rows() == 0) return sage::SolveStatus::ok;
    const Eigen::Map<const Eigen::VectorXd> right(b.data(), K_.rows());
    Eigen::Map<Eigen::VectorXd>(x.data(), K_.rows()) = lu_.solve(right);
    return sage::SolveStatus::ok;
  }

  void multiply(std::span<const double> x, std::span<double> y) const override {
    const Eigen::Map<const Eigen::VectorXd> from(x.data(), K_.rows());
    Eigen::Map<Eigen::VectorXd>(y.data(), K_.rows()) = K_ * from;
  }

  void multiply_transposed(std::span<const double> x, std::span<double> y) const override {
    const Eigen::Map<const Eigen::VectorXd> from(x.data(), K_.rows());
    Eigen::Map<Eigen::VectorXd>(y.data(), K_.rows()) = K_.transpose() * from;
  }

  double norm1() const override { return (Eigen::RowVectorXd::Ones(K_.rows()) * K_.cwiseAbs()).maxCoeff(); }

  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    const Eigen::Map<const Eigen::VectorXd> right(b.data(), K_.rows());
    Eigen::Map<Eigen::VectorXd>(x.data(), K_.rows()) = lu_.transpose().solve(right);
  }

 private:
  sage::SolverTraits traits_{.name = "sparse_lu", .symmetric = false};
  sage::ElementEquations elements_;
  std::vector<Eigen::Triplet<double>> terms_;
  Eigen::SparseMatrix<double> K_;
  mutable Eigen::SparseLU<Eigen::SparseMatrix<double>> lu_;  // its transpose() is not const
};

inline sage::SolverEntry sparse_lu() {
  return {"sparse_lu", "Eigen's supernodal LU with partial pivoting", false,
          [] { return std::make_unique<SparseLu>(); }};
}

}  // namespace own
