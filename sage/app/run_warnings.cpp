#include "sage/app/run_warnings.hpp"

#include <fmt/format.h>

#include "sage/analysis/stage_warnings.hpp"
#include "sage/app/answer.hpp"
#include "sage/app/screen.hpp"

namespace sage::app {

void RunWarnings::on_warning(const Diagnostic& diagnostic) {
  constexpr int kShown = 3;  // of a code: stages repeat them
  const bool detail = diagnostic.severity == Severity::note && diagnostic.code == kDetailNote;
  if (diagnostic.severity == Severity::note && !(detail && screen().verbose)) return;
  if (request_->quiet) return;
  Diagnostic shown = diagnostic;
  if (request_->input.strict && shown.severity == Severity::warning) shown.severity = Severity::error;
  const int count = ++counts_[shown.code.number()];
  if (count > kShown) return keep_message(shown);
  Diagnostics one;
  one.add(shown);
  print_diagnostics(one);
  if (count == kShown)
    say_detail(request_->deck, fmt::format("more messages {} are in the listing alone", to_string(shown.code)));
}

bool free_of_warnings(const RunRequest& request, const RunRecord& record) {
  if (!request.input.strict || record.warnings == 0) return true;
  say_error(request.deck,
            fmt::format("{} warning{} of the run count{} as errors (--strict); the results are complete",
                        record.warnings, record.warnings == 1 ? "" : "s", record.warnings == 1 ? "s" : ""),
            "S906");
  return false;
}

}  // namespace sage::app
