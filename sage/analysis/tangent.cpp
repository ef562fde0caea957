#include "sage/analysis/tangent.hpp"

#include <algorithm>
#include <utility>

#include "sage/analysis/checked_solve.hpp"

namespace sage {

void Tangent::analyse(std::unique_ptr<LinearSolver> solver, int equations, ElementEquations elements,
                      ElementCombinations combinations, WorkCounters& work) {
  const Profile::Scope scope(work.profile, phase::kNumbering);
  ++work.analyses;
  state_ = State::empty;
  solver_ = std::move(solver);
  combinations_ = std::move(combinations);
  parallel_ = combinations_.empty() ? dynamic_cast<ParallelAssembly*>(solver_.get()) : nullptr;
  elastic_.analyse(elements);
  sizes_.take(dynamic_cast<const KeptMatrix*>(solver_.get()), equations);
  solver_->analyse(equations, std::move(elements));
}

void Tangent::clear() {
  sizes_.forget();
  solver_->clear();
  coupling_.setZero(rate_->size());
}

void Tangent::damp(double share) {
  elastic_.add(share, *solver_);
  sizes_.forget();
  state_ = State::current;
}

void Tangent::couple(const ElementDofs& dofs, const double* K) {
  const std::size_t n = dofs.size();
  for (std::size_t j = 0; j < n; ++j) {
    const double rate = (*rate_)[dofs[j]];
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
  Profile::Scope scope(work.profile, phase::kFactors);
  ++work.factorisations;
  solver_->factorise();
  const FactorReport report = solver_->report();
  scope.add_operations(report.factor_operations);
  work.twin_equations = std::max(work.twin_equations, long{report.repeated_equations});
  state_ = State::factorised;
}

void Tangent::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, WorkCounters& work) const {
  Profile::Scope scope(work.profile, phase::kSolution);
  ++work.solves;
  const auto n = static_cast<std::size_t>(b.size());
  checked_solve(*solver_, {b.data(), n}, {x.data(), n});
  scope.add_operations(solver_->report().solve_operations);
}

}  // namespace sage
