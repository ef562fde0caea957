// K of the equations in use: the solver that holds it, and the state of what it holds.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sage/analysis/group_data.hpp"
#include "sage/analysis/records.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"

namespace sage {

class ByField;

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
  void analyse(std::unique_ptr<LinearSolver> solver, const std::string& name, int equations,
               ElementEquations elements, WorkCounters& work);
  // rate: displacement of every prescribed dof over the stage, for coupling().  It must stay where it is.
  void set_rate(const Eigen::VectorXd& rate) {
    rate_ = &rate;
    if (rate.isZero(0.0)) coupling_.setZero(rate.size());  // factors may go on to serve
  }

  State state() const { return state_; }
  bool linear() const { return linear_; }
  bool constant() const { return constant_; }
  bool analysed() const { return solver_ != nullptr; }
  bool current() const { return state_ >= State::current; }
  bool factorised() const { return state_ == State::factorised; }
  const LinearSolver& solver() const { return *solver_; }
  const KeptMatrix* matrix() const { return matrix_; }  // of the solver; nullptr where it keeps none
  const std::string& name() const { return name_; }
  const Eigen::VectorXd& coupling() const { return coupling_; }  // K(free, prescribed) rate, every dof

  void forget() { state_ = State::empty; }
  // K and its factors are no longer needed: their memory is freed.
  void release() {
    solver_.reset();
    matrix_ = nullptr;
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
  // From within: the element's matrix, column-major.
  void add(int element, const ElementDofs& dofs, const double* K);
  // The same where none of its dofs is prescribed.
  void add(int element, const double* K) {
    solver_->add(element, K);
    if (takes_elastic_) keep_elastic(element, K);
  }
  // ParallelAssembly::add_part of many; couple() is then for those with prescribed dofs.
  void add_part(const ElementMatrices& some, int part, int parts) {
    if (parallel_ != nullptr)
      parallel_->add_part(some, part, parts);
    else if (part == 0)
      add_one_by_one(some);
    if (takes_elastic_ && part == 0)
      for (int e = 0; e < some.count; ++e)
        keep_elastic(some.first + e, some.K + static_cast<std::size_t>(e) * some.size);
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

  // The element matrices of the assembly in between are kept for damp() until the pattern changes.  K is dropped.
  void begin_elastic();
  void end_elastic(Outcome pass);
  bool has_elastic() const { return !elastic_.empty() && !takes_elastic_; }
  // Adds that share of them to the K of the last assembly, for one correction; then forget().
  void damp(double share);

  // Sizes of K, kept until it changes; they need an assembly.
  // The largest column sum of |K|; -1 where the solver keeps no matrix.
  double norm1() const;
  // Largest size, in the equations of the field `to`, of K times signs without an order in those of the field
  // `from`: of the block's row sums from below.
  double coupling_of(const ByField& fields, int to, int from) const;
  // K x, where the solver keeps its matrix.
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;

 private:
  void clear();
  void forget_sizes();
  void add_one_by_one(const ElementMatrices& some);
  void keep_elastic(int element, const double* K);

  bool linear_, constant_;
  State state_ = State::empty;
  bool changed_ = true;
  std::unique_ptr<LinearSolver> solver_;
  // What the solver offers beyond a solution; nullptr: it does not.
  ParallelAssembly* parallel_ = nullptr;
  const KeptMatrix* matrix_ = nullptr;
  const RepeatedParts* repeated_ = nullptr;
  std::string name_;
  int equations_ = 0;
  const Eigen::VectorXd* rate_ = nullptr;
  Eigen::VectorXd coupling_;
  bool takes_elastic_ = false;
  std::vector<double> elastic_;            // matrices of all elements, one after the other; empty = not known
  std::vector<std::size_t> elastic_from_;  // of each element, and the end
  mutable std::optional<double> norm1_;
  mutable std::vector<double> sizes_;  // coupling_of() all fields, column by column
};

// An element of the system.
inline void add_matrix(const GroupData& data, int element, const double* K, Tangent& tangent) {
  const int place = data.first_element + element;
  if (data.moved[static_cast<std::size_t>(element)])
    tangent.add(place, data.dofs_of(element), K);
  else
    tangent.add(place, K);
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
