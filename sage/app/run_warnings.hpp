// Warnings of a run on the screen and in the JSON answer, as they come.
#pragma once

#include <map>
#include <span>

#include "sage/app/run_deck.hpp"

namespace sage::app {

class RunWarnings final : public Observer {
 public:
  explicit RunWarnings(const RunRequest& request) : request_(&request) {}

  void on_warning(const Diagnostic& diagnostic) override;
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }

 private:
  const RunRequest* request_;
  std::map<int, int> counts_;  // by the numbers of codes
};

// Of --strict: false, and a message, where the record or a report has warnings; those of reports are printed as errors.
bool free_of_warnings(const RunRequest& request, const RunRecord& record, const Reports& reports);

// Messages of reports, as warnings or, with --strict, as errors.
void say_report_messages(const RunRequest& request, const Reports& reports);

}  // namespace sage::app
