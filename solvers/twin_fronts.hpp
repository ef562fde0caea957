// Fronts that repeat.  Where an earlier front has the same terms in the same places, and the same fronts below it, both
// have the same factors and border matrices to the last bit: they are made and kept once.  Meshes of equal elements in
// rows have many such fronts, all others next to none.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "solvers/aligned_array.hpp"
#include "solvers/front_tree.hpp"

namespace sage {

// For matrices that are factorised once: where points yield, fronts soon differ.  They are used where they save a tenth
// of the factors at least.
class TwinFronts {
 public:
  // Of a new tree, whose values are not known yet: no front has a twin.
  void analyse(const FrontTree& tree, bool wanted);
  // Needs the lists of entries.
  void find(const FrontTree& tree, std::span<const double> values);

  // The first front with the factors of this one; itself where it is the first.
  int first(int front) const { return first_[static_cast<std::size_t>(front)]; }
  std::span<const int> first() const { return first_; }
  bool is_first(int front) const { return first(front) == front; }
  // Whether it may be found to be the twin of an earlier one.
  bool may_repeat(int front) const {
    return !shape_.empty() && shape_[static_cast<std::size_t>(front)] != front;
  }

 private:
  std::vector<int> first_;  // of every front
  std::vector<int> shape_;  // of every front the first one of its shape; empty: there is no use in looking
};

// Border matrices that more than one front takes.  They outlive the place that a border has in a workspace, and who
// takes one may have to wait for the thread that makes it.
class LentBorders {
 public:
  // first: of every front the first one like it.  None is made yet.
  void plan(const FrontTree& tree, std::span<const int> first);
  bool lends(int front) const { return !slot_.empty() && slot_[static_cast<std::size_t>(front)] >= 0; }

  // Room for the border of a front that lends; who has filled it publishes it.
  double* make(int front, std::size_t terms);
  double* room(int front) { return border_of(front).terms.data(); }
  void publish(int front);
  // The border once it is published; nullptr where its maker has given it up.
  const double* wait_for(int front);
  // The last of those that take it frees it; after an error the rest goes with the next plan().
  void release(int front);
  // What the fronts begin .. end - 1 lend and have not published will not come.
  void give_up(int begin, int end);

 private:
  enum State { kPending, kPublished, kGivenUp };
  struct Border {
    AlignedArray terms;
    std::atomic<int> state{kPending}, takers{0};
  };
  Border& border_of(int front) {
    return borders_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(front)])];
  }

  std::vector<int> slot_;  // of every front, -1 = lends none; empty: nobody does
  std::vector<Border> borders_;
};

}  // namespace sage
