// What a run is doing at this moment, for a thread that shows it while the run goes on.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>

namespace sage {

// The run writes, anybody reads; numbers read together may belong to two moments.
struct Pulse {
  using Clock = std::chrono::steady_clock;

  std::atomic<const char*> phase{nullptr};       // a literal; null before the first
  std::atomic<Clock::rep> phase_began{0};        // since the clock's epoch
  std::atomic<int> stage{0}, stages{0};          // from 1; 0 = none has begun
  std::atomic<int> increment{0}, increments{0};  // of the stage, from 1
  std::atomic<int> iteration{0};                 // of the step in hand
  std::atomic<double> residual{
      std::numeric_limits<double>::quiet_NaN()};  // |force out of balance| / force scale
  std::atomic<double> share{0.0};                 // of all increments, 0 ... 1

  void enter(const char* name, Clock::time_point now) {
    phase_began.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    phase.store(name, std::memory_order_relaxed);
  }
  void iterated(int count, double force) {
    iteration.store(count, std::memory_order_relaxed);
    residual.store(force, std::memory_order_relaxed);
  }
};

}  // namespace sage
