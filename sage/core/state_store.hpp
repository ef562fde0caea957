// Stress, strain and history of every point of a group, in flat arrays: committed and trial.
// A commit is a swap; a cut step needs no undo, because the committed side is never written.
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
  StateStore(std::size_t points, int law_size, std::span<const Quantity> history)
      : law_size_(law_size), history_size_(static_cast<int>(history.size())) {
    const auto n = static_cast<std::size_t>(law_size);
    committed.sigma.assign(points * n, 0.0);
    committed.eps.assign(points * n, 0.0);
    committed.h.resize(points * history.size());
    for (std::size_t p = 0; p < points; ++p)
      for (std::size_t i = 0; i < history.size(); ++i) committed.h[p * history.size() + i] = history[i].initial;
    committed.status.assign(points, PointStatus::elastic);
    trial = committed;
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
