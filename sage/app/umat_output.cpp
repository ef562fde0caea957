#include "sage/app/umat_output.hpp"

#include <fmt/format.h>

#include "sage/record/out_file.hpp"
#include "sage/umat/capture.hpp"
#include "sage/umat/law.hpp"

namespace sage::app {

namespace {

constexpr std::size_t kMostKept = std::size_t{256} << 10;

void write_log(const RunRequest& request, const umat::Capture::Text& text) {
  if (text.bytes == 0) return;
  OutFile file(request.output.folder / (stem_of(request) + ".umat.log"));
  file.text() = text.first;
  if (text.bytes > text.first.size())
    file.text() += fmt::format("\n... and {} more bytes, which are not kept\n", text.bytes - text.first.size());
  file.finish();
  if (!request.quiet)
    fmt::print(stderr, "{}: note: user materials printed {} bytes: {}{}\n", request.deck, text.bytes,
               file.path().string(), text.bytes > text.first.size() ? " has the first of them" : "");
}

void say_notes(const RunRequest& request) {
  for (const std::string& note : umat::take_notes())
    if (!request.quiet) fmt::print(stderr, "{}: note: {}\n", request.deck, note);
}

}  // namespace

void with_umat_output(const RunRequest& request, const std::function<void()>& work) {
  if (umat::opened_libraries().empty()) return work();
  umat::set_job(std::filesystem::absolute(request.output.folder).string(), stem_of(request));
  umat::Capture capture(kMostKept);
  try {
    work();
  } catch (...) {
    write_log(request, capture.end());
    throw;
  }
  write_log(request, capture.end());
  say_notes(request);
}

}  // namespace sage::app
