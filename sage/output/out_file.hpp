// A result file that bears its name only when it is complete.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "sage/core/archive.hpp"

namespace sage {

// Written to NAME.partial in the same folder, renamed by finish().  What a stopped run left there stays until
// the first write, so that a run that is continued can keep it.  Text is collected and written in large pieces.
// A link is followed; a pipe or device is written to as it is.
// Every failure is an OutputError that names the file and the reason; after one, nothing more is tried.
class OutFile {
 public:
  OutFile() = default;
  // Opens at once, so that an unwritable folder shows before anything is computed.  Makes missing folders.
  explicit OutFile(std::filesystem::path path);
  // Without finish() what was collected is written (errors are ignored) and stays as NAME.partial.
  ~OutFile();
  OutFile(OutFile&&) noexcept = default;
  OutFile& operator=(OutFile&&) noexcept = default;

  // Append here.
  std::string& text() { return text_; }
  // Writes if much is waiting or half a second has passed: a killed run then leaves a useful NAME.partial.
  void checkpoint();
  // Writes the rest, closes, renames.
  void finish();

  // Checkpoint: everything so far is written, and where it ends is kept.  Reading: NAME.partial is cut back to
  // that place and goes on from there.  Throws InputError if it is shorter.
  void exchange(Archive& archive);

  bool open() const { return file_ != nullptr; }
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write();
  void cut_to(std::uint64_t size);
  [[noreturn]] void fail(const std::filesystem::path& path, int error);

  std::filesystem::path path_, partial_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string text_;
  std::uint64_t written_ = 0;
  bool begun_ = false;  // what an earlier run left is gone
  std::chrono::steady_clock::time_point last_write_{};
};

// Whether a file is there and has so many bytes or more.
bool holds(const std::filesystem::path& file, std::uint64_t bytes);

// Paths of those that are open.
std::vector<std::filesystem::path> paths_of_open(std::initializer_list<const OutFile*> files);

// A whole file at once, by the same way.
void write_file(const std::filesystem::path& path, std::string text);

}  // namespace sage
