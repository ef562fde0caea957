#include "sage/report/live_page.hpp"

#include <algorithm>

#include "sage/record/out_file.hpp"

namespace sage::report {

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// While one lives, no list of results hears of files.
class Unlisted {
 public:
  Unlisted() : log_(exchange_result_log(nullptr)) {}
  ~Unlisted() { exchange_result_log(log_); }
  Unlisted(const Unlisted&) = delete;
  Unlisted& operator=(const Unlisted&) = delete;

 private:
  ResultLog* log_;
};

}  // namespace

LivePage::LivePage(std::filesystem::path result, std::string deck_name, std::string deck, double seconds)
    : result_(std::move(result)), deck_name_(std::move(deck_name)), deck_(std::move(deck)), seconds_(seconds) {}

bool LivePage::due() const {
  return seconds_ < 0.0 || seconds_since(last_) >= std::max(seconds_, 10.0 * cost_);
}

void LivePage::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  if (!wants_states(model, report)) return;
  const bool is_end =
      !frames_.empty() && frames_.back().report().increment == frames_.back().report().increments;
  if (!frames_.empty() && !is_end) frames_.pop_back();
  frames_.emplace_back(model, report, solution);
  if (due()) write(model);
}

void LivePage::on_finish(const Model& model, const RunResult& result) {
  if (seconds_ != kAtTheEnd) return;
  const bool failed = result.status != RunStatus::completed;
  write_file(std::filesystem::path(result_).replace_extension(".html"),
             page_of(model, false, failed ? result.reason : std::string()).html);
  ++written_;
}

Page LivePage::page_of(const Model& model, bool goes_on, const std::string& failure) {
  PageRun run{result_, model, deck_name_, deck_, failure};
  run.goes_on = goes_on;
  for (const Frame& frame : frames_) run.states.push_back({frame.report().stage, frame.report().increment});
  run.frame = [this](std::size_t state) { return frames_[state]; };
  return make_page({run});
}

void LivePage::write(const Model& model) {
  const Clock::time_point begin = Clock::now();
  Page page = page_of(model, true, {});
  const Unlisted unlisted;
  write_file(std::filesystem::path(result_).replace_extension(".html"), std::move(page.html));
  ++written_;
  last_ = Clock::now();
  cost_ = seconds_since(begin);
}

}  // namespace sage::report
