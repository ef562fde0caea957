// The multifrontal solver of frontal.hpp.  Fronts that repeat are the work of repeated_fronts.cpp, which derives from it.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "sage/platform/thread_pool.hpp"
#include "solvers/aligned_array.hpp"
#include "solvers/choose_kernels.hpp"
#include "solvers/early_pages.hpp"
#include "solvers/front_tree.hpp"
#include "solvers/matrix_solver.hpp"

namespace sage {

// K = L U, or K = U^T D^-1 U with D the diagonal of U where K is symmetric.
class Frontal : public MatrixSolver, public BorderSolver {
  // What one thread has of its own.
  struct Lane {
    AlignedArray workspace, scratch;
    PivotCheck check{"", {}};
    alignas(64) double maximum[kTile] = {};  // largest terms, see TileKernels
  };
  // What one thread needs for substitutions: values of a front, and sums of its rows.
  struct Sweep {
    AlignedArray values, sums;
  };

 public:
  explicit Frontal(SolverTraits solver_traits) : MatrixSolver(solver_traits) {}
  void configure(const SolverSettings& settings) override;
  void factorise_matrix() override;
  void solve_matrix(std::span<const double> b, std::span<double> x) const override {
    solve_fronts(b, x, traits().symmetric);
  }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    solve_fronts(b, x, true);
  }

  bool set_border(int equations) override { return take_border(equations); }
  void border_matrix(double* S) const override;
  void eliminate(std::span<const double> b, std::span<double> y) const override;
  void recover(std::span<double> x) const override;

 protected:
  void analyse_matrix(const EquationGraph& graph) override;

  // Fronts that share factors and border matrices with others (repeated_fronts.cpp).  This solver itself has none.
  // Of every front the first one that may turn out to have its factors, for a new tree, whose values are not known yet;
  // and, once they are, the first one that has them.  Empty: all have their own.
  virtual std::vector<int> fronts_that_may_share() { return {}; }
  virtual std::vector<int> fronts_that_share() { return {}; }
  // Memory for the border matrix of a front where several others read it; nullptr: its place is in the workspace.
  virtual double* lent_border(int /*front*/) { return nullptr; }
  // Such borders of the fronts begin .. end - 1 are complete, or, after an error, will never be.
  virtual void finish_borders(int /*begin*/, int /*end*/, bool /*complete*/) {}
  // Waits until it is complete, for one of its readers; nullptr as above.  Then that one has read it.
  virtual const double* read_border(int /*front*/) { return nullptr; }
  virtual void release_border(int /*front*/) {}

  bool once() const { return settings().one_factorisation; }
  const FrontTree& tree() const { return tree_; }

 private:
  int threads() const { return std::max(1, settings().threads); }
  // first_of: as above.
  void take_sharing(std::vector<int> first_of);
  bool has_own_factors(int front) const { return first_of_[front] == front; }
  // Where the factors of every front stand: one after the other, those that are shared where the first front has them.
  void place_factors();

  // Their room is needed first.  That of the largest fronts comes when the workspaces of the subtrees have gone: the
  // run is largest then.  No more than what there is if all fronts of one shape turn out to be the same.
  void touch_subtrees_early();

  std::int64_t terms_of(int f) const { return (traits().symmetric ? 1 : 2) * tree_.fronts[f].arm_terms(); }
  double operations() const;

  // Of what is touched: of the factors, those that are kept.
  std::size_t memory_bytes() const;

  // The first thread works on the fronts above the subtrees too, and all others in the arms of the first.
  void make_workspace();

  bool is_large() const { return matrix().row().size() > std::size_t{1} << 20; }
  void give_back_entries(int subtree);
  // What only the subtrees needed goes before the largest fronts come: the run is largest at its last front.
  void give_back_subtrees();
  // Of the children of a front that is assembled; later borders that get their places take new pages.
  void give_back_borders(int f);
  void give_back_rest();
  void take_room();

  // Of every front of a subtree the part of the border that lies outside of it, the last so many.
  void list_outside();
  std::span<const int> border_of(const Front& front) const {
    return {tree_.border.data() + front.border_begin, static_cast<std::size_t>(front.border)};
  }

  // Pivots of fronts that were eliminated, and of those that are like one of them.
  int negative_pivots() const;
  void take_report();

  Arms arms(int f, Lane& lane) {
    const Front& front = tree_.fronts[f];
    double* upper = factors_.data() + front.arms;
    double* lower = traits().symmetric ? lane.scratch.data() : upper + front.arm_terms();
    return {front, upper, lower, reciprocal_.data() + first_pivot_[f]};
  }
  double* border(int f, Lane& lane);
  // A border that is complete.
  const double* border_of_child(int child, Lane& lane);
  void eliminate_subtree(const Subtree& subtree, Lane& lane);

  // Original terms and the border matrices of the children.  Of a symmetric matrix only the upper triangle is
  // assembled; what lands below the diagonal of a diagonal tile is never read.
  void assemble(int f, Lane& lane);

  // Extended addition of a child's border matrix, eight columns at a time.
  void add_border(const Front& child, const double* child_border, const Arms& a, double* border);

  // Elimination of the pivots: as in the skyline solver with full columns, and then the border matrix.
  void eliminate(int f, Lane& lane);

  // The same with the columns of the border divided among all threads.
  void eliminate_together(int f);
  void eliminate_pivots(const Arms& a, Lane& lane) const;
  void reduce_border_columns(const Arms& a, int begin, int end, Lane& lane) const;

  // Border columns begin .. end - 1 take the product of all pivots, in blocks of pivots whose arms stay in the
  // nearest cache.
  void update_border(const Arms& a, double* border_matrix, int begin, int end) const;
  void solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const;
  void forward_fronts(bool transposed) const;
  void backward_fronts(bool transposed) const;
  void forward(int f, bool transposed, Sweep& sweep) const;
  void backward(int f, bool transposed, Sweep& sweep) const;
  void take_outside(int f) const;
  // U, or L transposed, which only unsymmetric matrices have.
  const double* arm_of(int f, bool lower) const {
    const Front& front = tree_.fronts[f];
    return factors_.data() + front.arms + (lower ? front.arm_terms() : 0);
  }
  // Asks the memory for an arm of the front that comes next, while the one before it is in work: fronts are short, and
  // the processor finds where the next one lies only when it is there.  Measured: solutions take 2/3 of the time.
  // Always inlined: the compiler drops calls of a function that only asks.
  [[gnu::always_inline]] void ask_for_front(int f, bool lower) const {
    constexpr std::int64_t kLine = 8, kMost = 16384;  // terms: of a cache line; half of a small second cache
    if (f < 0 || static_cast<std::size_t>(f) >= tree_.fronts.size()) return;
    const double* const arm = arm_of(f, lower);
    const std::int64_t terms = std::min(tree_.fronts[f].arm_terms(), kMost);
    for (std::int64_t t = 0; t < terms; t += kLine) __builtin_prefetch(arm + t, 0, 2);
  }

  const TileKernels* wanted_kernels_ = &choose_kernels(Kernels::automatic);
  const TileKernels* kernels_ = wanted_kernels_;  // since analyse(): the tree is laid out for them
  FrontTree tree_;
  AlignedArray factors_, shared_;
  EarlyPages early_;  // of factors_
  std::vector<Lane> lanes_;
  std::unique_ptr<ThreadPool> pool_;
  std::vector<int> first_of_;     // of every front the first one with its factors
  std::vector<int> first_pivot_;  // of every front, in reciprocal_
  std::vector<double> reciprocal_;
  bool given_back_ = false;
  int widest_ = 0;                  // tiles of the widest front
  std::vector<int> outside_begin_;  // of every front, in outside_values_
  // Used by one solution at a time:
  mutable AlignedArray position_values_, outside_values_;
  mutable std::vector<Sweep> sweeps_;
};

}  // namespace sage
