// Stress, strain and history of every point of a group, in flat arrays: committed and
// trial.  A commit is a swap; a cut step needs no undo, because the committed side is never
// written.  Where the trial side of stress and strain is not needed, the committed one
// takes no room until somebody looks.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "sage/core/law.hpp"

namespace sage {

struct PointStates {
  std::vector<double> sigma, eps, h;  // points x law_size, points x law_size, points x history size
  std::vector<PointStatus> status;    // points
};

class StateStore {
 public:
  StateStore() = default;
  // with_trial: a law is going to write stress and strain here, step by step.
  StateStore(std::size_t points, int law_size, const PointHistory& history, bool with_trial = true)
      : law_size_(law_size), history_size_(static_cast<int>(history.size())) {
    committed.h.resize(points * history.size());
    for (std::size_t p = 0; p < points; ++p)
      for (std::size_t i = 0; i < history.size(); ++i) committed.h[p * history.size() + i] = history[i].initial;
    committed.status.assign(points, PointStatus::elastic);
    if (with_trial) make_room();
    trial = committed;
  }

  // Room for committed stress and strain, zero where there was none.
  void make_room() {
    const std::size_t terms = committed.status.size() * static_cast<std::size_t>(law_size_);
    committed.sigma.resize(terms, 0.0);
    committed.eps.resize(terms, 0.0);
  }

  void commit() { std::swap(committed, trial); }

  int law_size() const { return law_size_; }
  int history_size() const { return history_size_; }

  PointStates committed, trial;

 private:
  int law_size_ = 4;
  int history_size_ = 0;
};

}  // namespace sage
