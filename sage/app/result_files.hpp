// The results of one run in a folder: nobody else writes them meanwhile, and those of an earlier run do not
// stay beside them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sage/record/out_file.hpp"

namespace sage::app {

// A result file by its name in the folder, or by its whole path where a link leads elsewhere.
struct ResultFile {
  Checksum sum;  // of what is written
  bool complete = false;
  bool synced = false;  // a complete file that is known to be on the disk
};

// Whose results they are.
struct ResultOwner {
  std::string deck;               // path
  std::uint64_t deck_sum = 0;     // of its characters
  std::string_view kind = "run";  // "run", "convergence" or "comparison"
};

// STEM.files.partial, while the run goes: locked by the operating system until the object or its process ends;
// names the process, the deck, and every result file from before its first byte.  STEM.files, after it: the
// complete files and their checksums.
class ResultFiles final : public ResultLog {
 public:
  // Makes the folder.  Throws OutputError, which names process and deck, where another run has the lock.
  ResultFiles(const std::filesystem::path& folder, const std::string& stem, const ResultOwner& owner);
  // Without close() the list stays as it is; where nothing was opened, as it was found.
  ~ResultFiles() override;

  void opened(const std::filesystem::path& file) override;
  void reached(const std::filesystem::path& file, const Checksum& sum, bool complete) override;

  // What a checkpoint builds on: the files so far, and their way back.
  const std::map<std::string, ResultFile>& files() const { return files_; }
  std::filesystem::path path_of(const std::string& name) const { return folder_ / name; }
  // Whether the list has a checksum of this complete file and the file is no longer that.
  bool changed_since(const std::string& name) const;
  void restore(const std::map<std::string, ResultFile>& files);
  // All complete files, and then their names, are on the disk.
  void sync();

  // The run has ended and all its files have their names: writes the list, and removes files that earlier lists
  // name, if they still hold what was written then.  What another kind of run made of the same deck stays.
  // Gives the files that were left because they have been changed, or which may be of an earlier run whose list is
  // damaged.
  struct Left {
    std::vector<std::filesystem::path> changed, unlisted;
    bool damaged = false;  // the list that was found
  };
  Left close();
  bool may_be_mixed() const override { return !locked_; }
  // Whether the file system of the folder has locks at all.
  bool locked() const { return locked_; }

 private:
  struct Earlier {
    std::string kind, deck;                   // deck: its checksum
    bool begun = false;                       // NAME.partial may be there
    std::optional<std::uint64_t> bytes, sum;  // of the complete file
  };
  using EarlierFiles = std::map<std::string, Earlier>;

  bool lock();
  [[noreturn]] void refuse() const;
  [[noreturn]] void fail(int error) const;
  std::string read_list() const;
  void rewrite(const std::string& text) const;
  void append(const std::string& line) const;
  std::string head() const;
  std::optional<std::string> name_of(const std::filesystem::path& file) const;
  bool keep(const std::string& name, const Earlier& earlier) const;
  // False where the text is no whole list.
  static bool parse(const std::string& text, EarlierFiles& files);
  std::vector<std::filesystem::path> unlisted() const;
  static std::string line(const std::string& name, const Earlier& file);
  bool remove(const std::string& name, const Earlier& earlier) const;

  std::filesystem::path folder_, list_, while_running_;
  std::string stem_;
  ResultOwner owner_;
  std::string deck_sum_;  // in hexadecimal digits
  int descriptor_ = -1;
  bool locked_ = true, closed_ = false, damaged_ = false;
  std::optional<std::string> found_;  // what while_running_ held before
  EarlierFiles earlier_;
  std::map<std::string, ResultFile> files_;
  ResultLog* log_before_ = nullptr;
};

// A note for each file that was changed, and a warning where the list was damaged.
void say_left(const std::string& who, const ResultFiles::Left& left);
// The files that a command has written, a line each.
void print_files(const std::vector<std::filesystem::path>& files);

}  // namespace sage::app
