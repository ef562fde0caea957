// A line on the terminal while a run goes on; nothing where stderr is not a terminal.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "sage/analysis/observer.hpp"

namespace sage {

class Progress final : public Observer {
 public:
  Progress() : on_(isatty(STDERR_FILENO) != 0), next_(Clock::now() + std::chrono::milliseconds(500)) {}
  ~Progress() override { clear(); }

  // The first increment of a large model, with its first factors, is a long silence.
  void on_stage_start(const Model& model, int stage, const Solution& start) override {
    const int dofs = start.activity->dof_map.dofs();
    if (!on_ || dofs < 200'000) return;
    std::fprintf(stderr, "\r\033[Kstage %d of %zu, %d degrees of freedom, first increment", stage + 1,
                 model.stages.size(), dofs);
    std::fflush(stderr);
    shown_ = true;
  }
  void on_increment(const Model& model, const StepReport& report, const Solution&) override {
    if (!on_ || Clock::now() < next_) return;
    next_ = Clock::now() + std::chrono::milliseconds(100);
    std::fprintf(stderr, "\r\033[Kstage %d of %zu, increment %d of %d, %d iterations", report.stage + 1,
                 model.stages.size(), report.increment, report.increments, report.total_iterations);
    std::fflush(stderr);
    shown_ = true;
  }
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  void on_finish(const Model&, const RunResult&) override { clear(); }

 private:
  using Clock = std::chrono::steady_clock;
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
  }

  bool on_, shown_ = false;
  Clock::time_point next_;
};

}  // namespace sage
