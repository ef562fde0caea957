#include "sage/analysis/tangent.hpp"

#include <utility>

namespace sage {

void Tangent::analyse(std::unique_ptr<LinearSolver> solver, const std::string& name, int equations,
                      ElementEquations elements, WorkCounters& work) {
  const Timer timer(work.analyse_seconds);
  ++work.analyses;
  state_ = State::empty;
  solver_ = std::move(solver);
  name_ = name;
  solver_->analyse(equations, std::move(elements));
}

void Tangent::clear() {
  solver_->clear();
  coupling_.setZero(rate_.size());
}

void Tangent::add(int element, const ElementDofs& dofs, const double* K) {
  solver_->add(element, K);
  const std::size_t n = dofs.size();
  for (std::size_t j = 0; j < n; ++j) {
    const double rate = rate_[dofs[j]];
    if (rate == 0.0) continue;
    for (std::size_t i = 0; i < n; ++i) coupling_[dofs[i]] += K[j * n + i] * rate;
  }
}

void Tangent::settle(Outcome pass) {
  if (pass == Outcome::cut_step)
    set_aside();
  else if (state_ == State::stale)
    state_ = State::current;
}

void Tangent::factorise(WorkCounters& work) {
  if (factorised()) {
    ++work.kept_factors;
    return;
  }
  const Timer timer(work.factor_seconds);
  ++work.factorisations;
  solver_->factorise();
  if (constant_) solver_->release_workspace();
  state_ = State::factorised;
}

void Tangent::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, WorkCounters& work) const {
  const Timer timer(work.solve_seconds);
  ++work.solves;
  const auto n = static_cast<std::size_t>(b.size());
  solver_->solve({b.data(), n}, {x.data(), n});
}

}  // namespace sage
