// What a condensed region is known to do since its displacements were recovered last, extrapolated to the step in hand.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "sage/analysis/iterated_step.hpp"
#include "sage/core/archive.hpp"

namespace sage {

class RegionPredictor {
 public:
  // Vectors of kept dofs have so many entries.
  void begin(Eigen::Index kept);
  // supports_move: some dof of the region is given a displacement in the stage.  force_squares: sum over its elements of
  // |f_e|^2.
  void begin_stage(bool supports_move, double force_squares);
  // A step of that share of the stage.  What so_far points to must outlive it.
  void begin_step(double part, const StageSoFar& so_far);
  // Whether the loads of the step are its share of the stage's; while the region is behind they are.
  void set_on_line(bool on_line) { now_.on_line = on_line; }

  double part() const { return part_; }
  // Share of the stage from the last recovery to the end of the step.
  double part_since() const { return part_since_; }
  bool on_line() const { return now_.on_line; }
  bool supports_move() const { return supports_move_; }
  bool begins_stage() const { return !(now_.share > 0.0); }
  // Committed steps have moved kept dofs since the last recovery, by since().
  bool is_behind() const { return now_.behind; }
  const Eigen::VectorXd& since() const { return now_.since; }

  // Displacements (condensed dofs, then kept ones; `dofs` says which) at the end of the step: the motion of the stage so
  // far, extrapolated in proportion to its loads, so that it balances them.  False: nothing is known; `to` becomes zero.
  bool extrapolate(const std::vector<int>& condensed, const std::vector<int>& kept, Eigen::VectorXd& to) const;
  // The step may end without a recovery: from one to the next the share of the loads at most doubles.  Then the forces of
  // the region, by which others are judged, are known well enough.
  bool may_wait() const;
  // The least that the sum of |f_e|^2 may be at the end of the step, as it has gone in the stage so far; 0 where little is
  // known.
  double least_force_squares() const;

  // The step in hand is committed: by its border alone (du: every dof), or with the region recovered.
  void accept_border(const std::vector<int>& kept, const Eigen::VectorXd& du);
  void accept_whole(double force_squares);
  // Writing gives what was known before the last step was committed.
  void exchange(Archive& archive);

 private:
  // The last recovery.
  struct Anchor {
    double share = 0.0;     // of the stage
    Eigen::VectorXd since;  // motion of the kept dofs since then
    bool behind = false;    // a step has been committed since then
    bool on_line = false;   // the region's forces grow from there with the loads of the stage
    // Sum of |f_e|^2 there and at the two recoveries before, and their shares; NaN = not known.
    std::array<double, 3> shares{}, force_squares{};

    void remember(double its_share, double its_force_squares);
  };

  Anchor now_, before_;  // before_: the last step was committed
  bool supports_move_ = false;
  double part_ = 0.0, to_ = 0.0, part_since_ = 0.0;
  StageSoFar so_far_;
};

}  // namespace sage
