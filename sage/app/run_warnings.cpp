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

void say_report_messages(const RunRequest& request, const Reports& reports) {
  for (std::size_t i = 0; i < reports.count(); ++i)
    for (const std::string& message : reports.messages(i)) {
      const std::string words = fmt::format("report {}: {}", i + 1, message);
      const Code code = code_in(message).value_or(Code("S530"));
      request.input.strict ? say_error(request.deck, words, code) : say_warning(request.deck, words, code);
    }
}

bool free_of_warnings(const RunRequest& request, const RunRecord& record, const Reports& reports) {
  long warnings = record.warnings;
  for (std::size_t i = 0; i < reports.count(); ++i) warnings += std::ssize(reports.messages(i));
  if (!request.input.strict || warnings == 0) return true;
  say_error(request.deck,
            fmt::format("{} warning{} of the run count{} as errors (--strict); the results are complete",
                        warnings, warnings == 1 ? "" : "s", warnings == 1 ? "s" : ""),
            "S906");
  return false;
}

}  // namespace sage::app
