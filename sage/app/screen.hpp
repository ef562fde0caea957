// The standard streams as all commands use them: results to standard output, messages to standard error, and what
// --quiet, --verbose and --json make of both.
#pragma once

#include <CLI/App.hpp>
#include <cstdio>
#include <string>
#include <string_view>

#include "sage/messages/error.hpp"

namespace sage::app {

struct ScreenOptions {
  bool quiet = false;    // nothing on standard output, no progress; messages stay
  bool verbose = false;  // what was chosen and why, to standard error
  bool json = false;     // one JSON document on standard output, nothing else
};

// --quiet, --verbose and --json, of the command and of those below it.
void add_screen_options(CLI::App& parser, ScreenOptions& options);

// Those of the process; for the command line to set, once.
const ScreenOptions& screen();
void set_screen(const ScreenOptions& options);

// A whole text at once to standard error, where no line of progress stands then; without characters that steer a
// terminal (printable).
void print_stderr(const std::string& text);
// What print_stderr() and say() of a process of this program made.
void pass_on_stderr(const std::string& text);

// A message to standard error, "who: warning: text [S104]" as a person reads it; an error goes without its word.  It
// stands in the answer of --json too.
void say(Severity severity, const std::string& who, const std::string& text, Code code);
inline void say_error(const std::string& who, const std::string& text, Code code) {
  say(Severity::error, who, text, code);
}
void say_error(const std::string& who, const std::exception& error);
inline void say_warning(const std::string& who, const std::string& text, Code code) {
  say(Severity::warning, who, text, code);
}
inline void say_note(const std::string& who, const std::string& text, Code code) {
  say(Severity::note, who, text, code);
}
// "who: text", with --verbose only.
void say_detail(const std::string& who, const std::string& text);

// To standard error; errors first are not reordered, at most 50 are shown.  The answer of --json has all.
void print_diagnostics(const Diagnostics& diagnostics);

// Whether that stream is a terminal that can move its cursor and takes colours.  TERM=dumb is none.
bool is_screen(std::FILE* stream);
// `text` in the colour of the severity where stderr is a screen and NO_COLOR is empty or not set.
std::string coloured(Severity severity, std::string_view text);
// Columns of a terminal; 80 where it doesn't say.
int columns_of(std::FILE* stream);
// Whether the locale's characters are those of UTF-8.
bool unicode_locale();

// While one lives, nothing that is written to `stdout` can steer a terminal: decks, file names and the names in them
// may hold any characters, which are escaped on their way (printable).  Not nested.
class PrintableOutput {
 public:
  PrintableOutput();
  ~PrintableOutput();
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;

 private:
  static ssize_t write(void* self, const char* text, std::size_t size);

  // Lines that are complete, broken to the columns of a screen.
  std::string on_screen(std::string_view text, bool all);

  std::FILE *before_, *filter_;
  int columns_ = 0;      // of the screen; 0 = standard output is none
  std::string cut_;      // of a character whose other bytes are still to come
  std::string pending_;  // of a line whose end is still to come
};

// While one lives, standard output leads nowhere but through write().  Not nested.
class MutedOutput {
 public:
  MutedOutput();
  ~MutedOutput();
  MutedOutput(const MutedOutput&) = delete;
  MutedOutput& operator=(const MutedOutput&) = delete;
  // To where standard output led before, the bytes as they are.  False: it could not be written.
  bool write(std::string_view text) const;

 private:
  int kept_;
};

}  // namespace sage::app
