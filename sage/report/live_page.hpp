// The page of a run that goes on: written again and again while it computes.
#pragma once

#include <chrono>
#include <limits>

#include "sage/record/output.hpp"
#include "sage/report/page.hpp"

namespace sage::report {

// Ends of stages and the latest output increment, in memory.  The page is written at an output increment when the last
// one is `seconds` old and writing it took less than a tenth of that time.  It is no result yet: neither lists of
// results nor checkpoints know it, and the page of the finished run takes its place.
// With kAtTheEnd it is that of the finished run, and is written once.
class LivePage final : public Observer {
 public:
  static constexpr double kAtTheEnd = std::numeric_limits<double>::infinity();

  // result: STEM.h5 of the run; the page is STEM.html beside it.  seconds < 0: at every output increment.
  LivePage(std::filesystem::path result, std::string deck_name, std::string deck, double seconds = 2.0);

  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_finish(const Model&, const RunResult&) override;
  bool wants_states(const Model& model, const StepReport& report) const override {
    return is_output_increment(stage_of(model, report.stage), report);
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return wants_states(model, report);
  }
  int written() const { return written_; }  // pages so far

 private:
  using Clock = std::chrono::steady_clock;

  bool due() const;
  void write(const Model& model);
  Page page_of(const Model& model, bool goes_on, const std::string& failure);

  std::filesystem::path result_;
  std::string deck_name_, deck_;
  double seconds_;
  std::vector<Frame> frames_;
  Clock::time_point last_ = Clock::now();
  double cost_ = 0.0;  // s that the last page took
  int written_ = 0;
};

}  // namespace sage::report
