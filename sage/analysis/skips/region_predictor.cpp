#include "sage/analysis/skips/region_predictor.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

void RegionPredictor::Anchor::remember(double its_share, double its_force_squares) {
  shares = {its_share, shares[0], shares[1]};
  force_squares = {its_force_squares, force_squares[0], force_squares[1]};
}

void RegionPredictor::begin(Eigen::Index kept) {
  now_.since.setZero(kept);
  before_.since.setZero(kept);
  now_.force_squares.fill(std::numeric_limits<double>::quiet_NaN());
}

void RegionPredictor::begin_stage(bool supports_move, double force_squares) {
  supports_move_ = supports_move;
  if (std::isnan(now_.force_squares[0])) now_.remember(0.0, force_squares);
}

void RegionPredictor::begin_step(double part, const StageSoFar& so_far) {
  if (!is_behind()) now_.share = so_far.share;
  part_ = part;
  to_ = so_far.share + part;
  part_since_ = is_behind() ? to_ - now_.share : part;
  so_far_ = so_far;
}

bool RegionPredictor::extrapolate(const std::vector<int>& condensed, const std::vector<int>& kept,
                                  Eigen::VectorXd& to) const {
  to.setZero();
  if (!now_.on_line || begins_stage()) return false;
  const double factor = part_since_ / now_.share;
  Eigen::Index i = 0;
  for (const int dof : condensed) to[i++] = factor * ((*so_far_.now)[dof] - (*so_far_.start)[dof]);
  const Eigen::Index border = i;
  for (const int dof : kept) {
    to[i] = factor * ((*so_far_.now)[dof] - now_.since[i - border] - (*so_far_.start)[dof]);
    ++i;
  }
  return true;
}

bool RegionPredictor::may_wait() const {
  constexpr double kEnd = 1.0 - 1e-9, kTwice = 2.0 + 1e-9;
  return now_.on_line && !supports_move_ && to_ < kEnd && to_ <= kTwice * now_.share;
}

// Forces that grow evenly have squares that are a parabola over the share.  Half of those forces is the careful side.
double RegionPredictor::least_force_squares() const {
  constexpr double kCareful = 0.25;  // of a square
  const auto& [s0, s1, s2] = now_.shares;
  const auto& [q0, q1, q2] = now_.force_squares;
  const double slope = (q0 - q1) / (s0 - s1), before = (q1 - q2) / (s1 - s2);
  const double expected = q0 + (to_ - s0) * (slope + (to_ - s1) * (slope - before) / (s0 - s2));
  return std::isfinite(expected) ? kCareful * std::clamp(expected, 0.0, q0) : 0.0;
}

void RegionPredictor::accept_border(const std::vector<int>& kept, const Eigen::VectorXd& du) {
  before_ = now_;
  for (Eigen::Index i = 0; i < now_.since.size(); ++i) now_.since[i] += du[kept[i]];
  now_.behind = true;
}

void RegionPredictor::accept_whole(double force_squares) {
  before_ = now_;
  now_.share = to_;
  now_.since.setZero();
  now_.behind = false;
  now_.remember(to_, force_squares);
}

void RegionPredictor::exchange(Archive& archive) {
  Anchor& anchor = archive.reading() ? now_ : before_;
  archive(anchor.share);
  archive(anchor.since);
  archive(anchor.behind);
  archive(anchor.on_line);
  archive(anchor.shares);
  archive(anchor.force_squares);
  archive(to_);
}

}  // namespace sage
