// K of the equations in use: the solver that holds it, and the state of what it holds.
#pragma once

#include <memory>

#include "sage/analysis/elastic_matrices.hpp"
#include "sage/analysis/equations.hpp"
#include "sage/analysis/group_data.hpp"
#include "sage/analysis/matrix_sizes.hpp"
#include "sage/analysis/records.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"

namespace sage {

class Tangent {
 public:
  enum class State {
    empty,       // the solver holds no K that could be used
    stale,       // K as it was last assembled, at a state from which no correction starts any more
    current,     // K for the next correction
    factorised,  // and its factors
  };

  // linear: K can never change while the pattern stays.  keeps: its factors are kept as long.
  Tangent(bool linear, bool keeps) : linear_(linear), constant_(linear && keeps) {}

  // A new pattern of equations, and a solver for it.
  void analyse(std::unique_ptr<LinearSolver> solver, int equations, ElementEquations elements,
               ElementCombinations combinations, WorkCounters& work);
  // rate: displacement of every prescribed dof over the stage, for coupling().  It must stay where it is.
  void set_rate(const Eigen::VectorXd& rate) {
    rate_ = &rate;
    if (rate.isZero(0.0)) coupling_.setZero(rate.size());  // factors may go on to serve
  }

  bool linear() const { return linear_; }
  bool constant() const { return constant_; }
  bool current() const { return state_ >= State::current; }
  bool factorised() const { return state_ == State::factorised; }
  const LinearSolver& solver() const { return *solver_; }
  const Eigen::VectorXd& coupling() const { return coupling_; }  // K(free, prescribed) rate, every dof

  void forget() { state_ = State::empty; }
  // K and its factors are no longer needed: their memory is freed.
  void release() {
    solver_.reset();
    sizes_.take(nullptr, 0);
    state_ = State::empty;
  }
  // The next correction starts at another state: K and its factors hold only if an assembly there finds the same K.
  void set_aside() {
    if (current()) state_ = State::stale;
  }

  // One assembly.  `elements` computes all matrices that can change.  It adds those that are not stored, and calls differs()
  // where one is not equal to the stored one.  `kept` adds all stored ones, and is called only if the solver does not hold
  // them already.  all_kept: all are stored.
  template <class Elements, class Kept>
  Outcome assemble(bool all_kept, Elements elements, Kept kept);
  // From within: the element's matrix, column-major; couple() too, where one of its dofs is prescribed.
  void add(int element, const double* K) {
    if (combinations_.changes(element)) K = combinations_.combine(element, K);
    solver_->add(element, K);
    if (elastic_.is_taking()) elastic_.keep(element, K);
  }
  // ParallelAssembly::add_part of many; couple() is then for those with prescribed dofs.
  void add_part(const ElementMatrices& some, int part, int parts) {
    if (parallel_ != nullptr) parallel_->add_part(some, part, parts);
    for (int e = 0; part == 0 && e < some.count; ++e) {
      const double* const K = some.K + static_cast<std::size_t>(e) * some.size;
      if (parallel_ == nullptr) {
        add(some.first + e, K);
        continue;
      }
      if (elastic_.is_taking()) elastic_.keep(some.first + e, K);
    }
  }
  void couple(const ElementDofs& dofs, const double* K);
  void differs() { changed_ = true; }
  // After it: K of a pass that failed, or whose forces are not finite, is dropped.
  void settle(Outcome pass);
  // False: the last assembly found the very K that the solver holds, and left it alone.
  bool changed() const { return changed_; }

  // Does nothing where there are factors already.  Throws SingularMatrix.
  void factorise(WorkCounters& work);
  // Needs factors.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, WorkCounters& work) const;

  // Of the pattern in hand: assemblies between begin() and end() go there too, and K is then of no use.
  ElasticMatrices& elastic() { return elastic_; }
  // Adds that share of the elastic matrices to the K of the last assembly, for one correction; then forget().
  void damp(double share);

  // Of K until it changes; they need an assembly.
  const MatrixSizes& sizes() const { return sizes_; }

 private:
  void clear();

  bool linear_, constant_;
  State state_ = State::empty;
  bool changed_ = true;
  std::unique_ptr<LinearSolver> solver_;
  ParallelAssembly* parallel_ = nullptr;  // nullptr: the solver does not offer it, or dofs are combined
  ElementCombinations combinations_;
  const Eigen::VectorXd* rate_ = nullptr;
  Eigen::VectorXd coupling_;
  ElasticMatrices elastic_;
  MatrixSizes sizes_;
};

// An element of the system.
inline void add_matrix(const GroupData& data, int element, const double* K, Tangent& tangent) {
  const int place = data.first_element + element;
  tangent.add(place, K);
  if (data.moved[element]) tangent.couple(data.dofs_of(element), K);
}

template <class Elements, class Kept>
Outcome Tangent::assemble(bool all_kept, Elements elements, Kept kept) {
  changed_ = !all_kept || state_ == State::empty;
  if (!all_kept) clear();
  if (elements() == Outcome::cut_step) {
    state_ = State::empty;
    return Outcome::cut_step;
  }
  if (!changed_) return Outcome::ok;
  if (all_kept) clear();
  kept();
  state_ = State::stale;
  return Outcome::ok;
}

}  // namespace sage
