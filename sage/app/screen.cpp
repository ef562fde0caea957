#include "sage/app/screen.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "sage/app/answer.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/wrap.hpp"
#include "sage/app/write_all.hpp"
#include "sage/deck/printable.hpp"

namespace sage::app {

namespace {

ScreenOptions& options_in_use() {
  static ScreenOptions options;
  return options;
}

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

std::string_view word_of(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

// The severity's word, as to_string() has it behind the place, in its colour.
std::string with_colour(const Diagnostic& diagnostic) {
  std::string text = printable(to_string(diagnostic));
  const std::string word = fmt::format("{}:", word_of(diagnostic.severity));
  const std::size_t place = printable(to_string(diagnostic.where)).size();
  const std::size_t at = text.find(word, std::min(place, text.size()));
  if (at != std::string::npos) text.replace(at, word.size(), coloured(diagnostic.severity, word));
  return text;
}

}  // namespace

void add_screen_options(CLI::App& parser, ScreenOptions& options) {
  for (CLI::App* below : parser.get_subcommands({})) add_screen_options(*below, options);
  CLI::Option* const quiet = parser.add_flag(
      "-q,--quiet", options.quiet, "print no results and no progress, only errors, warnings and notes");
  parser
      .add_flag("-v,--verbose", options.verbose,
                "print choices and reasons: solver, threads, kernels, skipped work, times")
      ->excludes(quiet);
  parser.add_flag("--json", options.json,
                  "print one JSON document instead of text (docs/manual/json.md); messages still go to "
                  "standard error");
}

const ScreenOptions& screen() {
  return options_in_use();
}

void set_screen(const ScreenOptions& options) {
  options_in_use() = options;
}

void print_stderr(const std::string& text) {
  pass_on_stderr(printable(text));
}

void pass_on_stderr(const std::string& text) {
  const ProgressPause pause;
  fmt::print(stderr, "{}", is_screen(stderr) ? wrapped(text, columns_of(stderr)) : text);
}

void say(Severity severity, const std::string& who, const std::string& text, Code code) {
  keep_message({severity, code, {who, 0, 0, 0}, text, {}});
  const std::string word =
      severity == Severity::error ? "" : coloured(severity, fmt::format("{}:", word_of(severity))) + ' ';
  pass_on_stderr(fmt::format("{}: {}{}\n", printable(who), word, printable(with_code(text, code))));
}

void say_error(const std::string& who, const std::exception& error) {
  say_error(who, std::string(error.what()), code_of(error));
}

void say_detail(const std::string& who, const std::string& text) {
  if (screen().verbose) print_stderr(fmt::format("{}: {}\n", who, text));
}

void print_diagnostics(const Diagnostics& diagnostics) {
  constexpr int kShown = 50;
  int shown = 0;
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.list()) {
    keep_message(diagnostic);
    if (++shown <= kShown) text += with_colour(diagnostic) + '\n';
  }
  if (shown > kShown) text += fmt::format("and {} more messages\n", shown - kShown);
  const auto count = [&](Severity severity, const char* word) {
    const auto listed = std::ranges::count(diagnostics.list(), severity, &Diagnostic::severity);
    return fmt::format("{} {}{}", listed, word, listed == 1 ? "" : "s");
  };
  if (diagnostics.errors() > 0)
    text += count(Severity::error, "error") + ", " + count(Severity::warning, "warning") + '\n';
  if (!text.empty()) pass_on_stderr(text);
}

namespace {

// `stdout` may be a filter without a descriptor of its own.
int descriptor_of(std::FILE* stream) {
  return stream == stdout ? STDOUT_FILENO : fileno(stream);
}

}  // namespace

bool is_screen(std::FILE* stream) {
  const std::string_view kind = environment("TERM");
  return isatty(descriptor_of(stream)) != 0 && !kind.empty() && kind != "dumb";
}

std::string coloured(Severity severity, std::string_view text) {
  static const bool on = is_screen(stderr) && environment("NO_COLOR").empty();
  if (!on) return std::string(text);
  const int colour = severity == Severity::error ? 31 : severity == Severity::warning ? 33 : 36;
  return fmt::format("\033[1;{}m{}\033[0m", colour, text);
}

int columns_of(std::FILE* stream) {
  winsize size = {};
  return ioctl(descriptor_of(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool unicode_locale() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"})
    if (const std::string_view locale = environment(name); !locale.empty())
      return locale.find("UTF-8") != std::string_view::npos || locale.find("utf8") != std::string_view::npos ||
             locale.find("UTF8") != std::string_view::npos || locale.find("utf-8") != std::string_view::npos;
  return false;
}

// Without memory for it the output stays as it was.
PrintableOutput::PrintableOutput()
    : before_(stdout), filter_(fopencookie(this, "w", {nullptr, write, nullptr, nullptr})) {
  std::fflush(before_);
  if (filter_ == nullptr) return;
  if (isatty(STDOUT_FILENO) != 0) std::setvbuf(filter_, nullptr, _IOLBF, BUFSIZ);
  if (is_screen(stdout)) columns_ = columns_of(stdout);
  stdout = filter_;
}

std::string PrintableOutput::on_screen(std::string_view text, bool all) {
  if (columns_ == 0) return std::string(text);
  pending_ += text;
  const std::size_t end = all ? pending_.size() : pending_.rfind('\n') + 1;  // npos + 1 = 0
  const std::string lines = wrapped(std::string_view(pending_).substr(0, end), columns_);
  pending_.erase(0, end);
  return lines;
}

PrintableOutput::~PrintableOutput() {
  if (filter_ == nullptr) return;
  stdout = before_;
  std::fclose(filter_);
  write_all(STDOUT_FILENO, on_screen(printable(cut_), true));
}

ssize_t PrintableOutput::write(void* self, const char* text, std::size_t size) {
  auto& output = *static_cast<PrintableOutput*>(self);
  const std::string whole = output.cut_ + std::string(text, size);
  const std::string lines = output.on_screen(printable(whole, &output.cut_), false);
  return write_all(STDOUT_FILENO, lines) ? static_cast<ssize_t>(size) : 0;
}

MutedOutput::MutedOutput() {
  std::fflush(stdout);
  kept_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const bool muted = kept_ >= 0 && nowhere >= 0 && dup2(nowhere, STDOUT_FILENO) >= 0;
  if (nowhere >= 0) ::close(nowhere);
  if (!muted) throw std::system_error(errno, std::generic_category(), "standard output");
}

MutedOutput::~MutedOutput() {
  std::fflush(stdout);
  dup2(kept_, STDOUT_FILENO);
  ::close(kept_);
}

bool MutedOutput::write(std::string_view text) const {
  return write_all(kept_, text);
}

}  // namespace sage::app
