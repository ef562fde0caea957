#include "sage/analysis/tangent.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "sage/analysis/by_field.hpp"
#include "sage/analysis/checked_solve.hpp"

namespace sage {

namespace {

// 1 and -1 without an order: no row of a matrix cancels against them but by chance.
Eigen::VectorXd signs(Eigen::Index equations) {
  Eigen::VectorXd v(equations);
  std::minstd_rand next;
  for (double& sign : v) sign = next() % 2 == 0 ? 1.0 : -1.0;
  return v;
}

}  // namespace

void Tangent::analyse(std::unique_ptr<LinearSolver> solver, const std::string& name, int equations,
                      ElementEquations elements, WorkCounters& work) {
  const Profile::Scope scope(work.profile, phase::kNumbering);
  ++work.analyses;
  state_ = State::empty;
  forget_sizes();
  equations_ = equations;
  solver_ = std::move(solver);
  name_ = name;
  parallel_ = dynamic_cast<ParallelAssembly*>(solver_.get());
  matrix_ = dynamic_cast<const KeptMatrix*>(solver_.get());
  repeated_ = dynamic_cast<const RepeatedParts*>(solver_.get());
  elastic_.clear();
  elastic_from_.assign(1, 0);
  for (int e = 0; e < elements.count(); ++e) {
    const std::size_t dofs = elements.of(e).size();
    elastic_from_.push_back(elastic_from_.back() + dofs * dofs);
  }
  solver_->analyse(equations, std::move(elements));
}

void Tangent::add_one_by_one(const ElementMatrices& some) {
  for (int e = 0; e < some.count; ++e)
    solver_->add(some.first + e, some.K + static_cast<std::size_t>(e) * some.size);
}

void Tangent::forget_sizes() {
  norm1_.reset();
  sizes_.clear();
}

void Tangent::clear() {
  forget_sizes();
  solver_->clear();
  coupling_.setZero(rate_->size());
}

void Tangent::add(int element, const ElementDofs& dofs, const double* K) {
  add(element, K);
  couple(dofs, K);
}

void Tangent::begin_elastic() {
  forget();
  elastic_.assign(elastic_from_.back(), 0.0);
  takes_elastic_ = true;
}

void Tangent::end_elastic(Outcome pass) {
  takes_elastic_ = false;
  if (pass == Outcome::cut_step) elastic_.clear();
  forget();
}

void Tangent::keep_elastic(int element, const double* K) {
  const auto e = static_cast<std::size_t>(element);
  std::copy_n(K, elastic_from_[e + 1] - elastic_from_[e], elastic_.data() + elastic_from_[e]);
}

void Tangent::damp(double share) {
  std::vector<double> scaled;
  for (std::size_t e = 0; e + 1 < elastic_from_.size(); ++e) {
    scaled.assign(elastic_.data() + elastic_from_[e], elastic_.data() + elastic_from_[e + 1]);
    for (double& term : scaled) term *= share;
    solver_->add(static_cast<int>(e), scaled.data());
  }
  forget_sizes();
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
  scope.add_operations(solver_->report().factor_operations);
  if (repeated_ != nullptr)
    work.twin_equations = std::max(work.twin_equations, long{repeated_->repeated_equations()});
  state_ = State::factorised;
}

void Tangent::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, WorkCounters& work) const {
  Profile::Scope scope(work.profile, phase::kSolution);
  ++work.solves;
  const auto n = static_cast<std::size_t>(b.size());
  checked_solve(*solver_, {b.data(), n}, {x.data(), n});
  scope.add_operations(solver_->report().solve_operations);
}

double Tangent::norm1() const {
  if (!norm1_) norm1_ = matrix_ != nullptr ? matrix_->norm1() : -1.0;
  return *norm1_;
}

Eigen::VectorXd Tangent::times(const Eigen::VectorXd& x) const {
  Eigen::VectorXd product(x.size());
  const auto n = static_cast<std::size_t>(x.size());
  matrix_->multiply({x.data(), n}, {product.data(), n});
  return product;
}

double Tangent::coupling_of(const ByField& fields, int to, int from) const {
  const auto count = static_cast<std::size_t>(fields.count());
  if (sizes_.empty()) {
    const Eigen::VectorXd all = signs(equations_);
    for (int f = 0; f < fields.count(); ++f) {
      const Eigen::VectorXd forces = times(fields.part(all, f));
      for (int row = 0; row < fields.count(); ++row) sizes_.push_back(fields.largest(forces, row));
    }
  }
  return sizes_[static_cast<std::size_t>(from) * count + static_cast<std::size_t>(to)];
}

}  // namespace sage
