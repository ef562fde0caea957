// A result file that bears its name only when it is complete.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sage/core/archive.hpp"
#include "sage/messages/error.hpp"
#include "sage/platform/checksum.hpp"

namespace sage {

// A result would take the place of a file that the program reads.  The command line is at fault (exit code 1).
class OverInput : public OutputError {
 public:
  using OutputError::OutputError;
};

// From now on no result of this process is written over `file`, by whatever name or link it is reached; a file
// that is not there is no matter.
void keep_input(const std::filesystem::path& file);
// Throws OverInput if `file` is one of those that keep_input was called for.
void expect_no_input(const std::filesystem::path& file);

// Sees every result file of the process: what a run wrote is known without asking each of its outputs.
class ResultLog {
 public:
  ResultLog() = default;
  ResultLog(const ResultLog&) = delete;
  ResultLog& operator=(const ResultLog&) = delete;
  virtual ~ResultLog() = default;
  // By the name that the file is going to have, before anything is written.  May throw.
  virtual void opened(const std::filesystem::path& file) = 0;
  // So much is written, for a checkpoint or (`complete`) because the file is about to get its name.
  virtual void reached(const std::filesystem::path& file, const Checksum& sum, bool complete) = 0;
  // Whether nothing keeps another program from writing into the same files: they are read back before they get their
  // names.
  virtual bool may_be_mixed() const { return false; }
};
// Gives the one before; nullptr: nobody is interested.
ResultLog* exchange_result_log(ResultLog* log);

// Written to NAME.partial in the same folder, renamed by finish().  What a stopped run left there stays until
// the first write, so that a run that is continued can keep it.  Text is collected and written in large pieces.
// A link is followed where it bears the file's own name, never where it bears that of the .partial file; a pipe
// or device is written to as it is.
// Every failure is an OutputError that names the file and the reason; after one, nothing more is tried.
class OutFile {
 public:
  OutFile() = default;
  // Opens at once, so that an unwritable folder, or one in the file's place, shows before anything is computed.
  // Makes missing folders.  Throws OverInput.
  explicit OutFile(std::filesystem::path path);
  // Without finish() what was collected is written (errors are ignored) and stays as NAME.partial.
  ~OutFile();
  OutFile(OutFile&&) noexcept = default;
  OutFile& operator=(OutFile&&) noexcept = default;

  // Append here.
  std::string& text() { return text_; }
  // Writes if much is waiting or half a second has passed: a killed run then leaves a useful NAME.partial.
  // Throws OutputError where that has been removed meanwhile.
  void checkpoint();
  // Writes all that is waiting.
  void flush() { write(); }
  // Writes the rest, closes, renames.  Throws OutputError where another program has written into the file.
  void finish();
  // A library writes the whole file, under the name that it is given; finish() comes next.  What the library
  // throws goes through, and NAME.partial is removed.
  void written_by(const std::function<void(const std::filesystem::path& partial)>& write);
  // Nobody wants the file: NAME.partial is removed.
  void discard();

  // Checkpoint: everything so far is written and on the disk, and where it ends is kept.  Reading: NAME.partial
  // is cut back to that place and goes on from there.  Throws InputError if what stands before it is not what
  // was written.  From then on the file reaches the disk before it gets its name.
  void exchange(Archive& archive);
  void sync_when_finished() { sync_ = true; }

  bool open() const { return file_ != nullptr; }
  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& partial() const { return partial_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void open_ordinary();
  void write();
  void cut_to(std::uint64_t size);
  void take_over(const Checksum& sum);
  void expect_in_place();
  void expect_own_bytes();
  void sync();
  [[noreturn]] void fail(const std::filesystem::path& path, int error);
  [[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason);

  std::filesystem::path path_, partial_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string text_;
  Checksum sum_;        // of what is written
  bool begun_ = false;  // what an earlier run left is gone
  bool sync_ = false;
  std::chrono::steady_clock::time_point last_write_{}, last_look_{};
};

// Of the first bytes of a file, `most` of them or all; nothing where it can't be read.
std::optional<Checksum> checksum_of(const std::filesystem::path& file, std::uint64_t most = UINT64_MAX);

// Whether a file is there and begins with the bytes that the sum was taken of.
bool begins_with(const std::filesystem::path& file, const Checksum& sum);

// The file's bytes, or the folder's list of names, are on the disk.  A system that can't do that for this kind
// of file is not asked twice; throws OutputError where the disk fails.
void sync_path(const std::filesystem::path& path);

// Throws OutputError if `folder` holds a folder whose name begins and ends so: a file could not get that name.
void expect_no_folders(const std::filesystem::path& folder, std::string_view begin, std::string_view end);

// A whole file at once, by the same way.
void write_file(const std::filesystem::path& path, std::string text);

}  // namespace sage
