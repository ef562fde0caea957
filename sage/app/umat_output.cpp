#include "sage/app/umat_output.hpp"

#include <fmt/format.h>

#include "sage/app/screen.hpp"
#include "sage/record/out_file.hpp"
#include "sage/umat/capture.hpp"
#include "sage/umat/law.hpp"

namespace sage::app {

namespace {

constexpr std::size_t kMostKept = std::size_t{256} << 10, kMostShown = std::size_t{8} << 10;

void write_log(const RunRequest& request, const umat::Capture::Text& text) {
  if (text.bytes == 0) return;
  OutFile file(request.output.folder / (stem_of(request) + ".umat.log"));
  file.text() = text.first;
  if (text.bytes > text.first.size())
    file.text() += fmt::format("\n... and {} more bytes, which are not kept\n", text.bytes - text.first.size());
  file.finish();
  if (!request.quiet)
    say_note(request.deck,
             fmt::format("user materials printed {} bytes: {}{}", text.bytes, file.path().string(),
                         text.bytes > text.first.size() ? " has the first of them" : ""),
             "S809");
}

void show(const std::string& who, const umat::Capture::Text& text) {
  if (text.bytes == 0) return;
  say_note(who,
           fmt::format("user materials printed {} bytes{}:", text.bytes,
                       text.bytes > text.first.size() ? ", of which these are the first" : ""),
           "S809");
  print_stderr(text.first + (text.first.ends_with('\n') ? "" : "\n"));
}

void say_notes(const std::string& who) {
  for (const std::string& note : umat::take_notes()) say_note(who, note, "S809");
}

// After the work, also where it failed, what was caught goes to `take`.
void with_capture(std::size_t most, const std::function<void()>& work,
                  const std::function<void(const umat::Capture::Text&)>& take) {
  umat::Capture capture(most);
  try {
    work();
  } catch (...) {
    take(capture.end());
    throw;
  }
  take(capture.end());
}

}  // namespace

void with_umat_output(const RunRequest& request, const std::function<void()>& work) {
  if (umat::opened_libraries().empty()) return work();
  umat::set_job(std::filesystem::absolute(request.output.folder).string(), stem_of(request));
  with_capture(kMostKept, work, [&](const umat::Capture::Text& text) {
    write_log(request, text);
    if (!request.quiet) say_notes(request.deck);
  });
}

void with_umat_output(const std::string& who, const std::function<void()>& work) {
  if (umat::opened_libraries().empty()) return work();
  with_capture(kMostShown, work, [&](const umat::Capture::Text& text) {
    show(who, text);
    say_notes(who);
  });
}

}  // namespace sage::app
