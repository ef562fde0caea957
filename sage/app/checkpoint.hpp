// The file from which an interrupted run goes on: STEM.restart, beside the results.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sage/app/result_files.hpp"

namespace sage::app {

class Checkpoint {
 public:
  // A checkpoint is due after `seconds` since the last; 0 = after every increment, negative = never.
  // `belongs_to` names the run: model, solver and outputs; the build of the program is added.  `kernels`, of its
  // solvers, stand on record only: their answers are the same.  `results`, of the same run, outlive the checkpoint.
  // Throws OutputError where its name is taken by a folder or an input.
  Checkpoint(std::filesystem::path file, double seconds, std::string belongs_to, std::string kernels,
             ResultFiles& results);

  bool due() const;
  const std::filesystem::path& file() const { return file_; }
  bool ever_due() const { return seconds_ >= 0.0; }
  // After the results so far, which are brought to the disk first.  The old checkpoint stays until the new one
  // is complete.  Throws OutputError.
  void save(const std::string& state);
  // Nothing if there is no file.  Throws InputError where it is damaged or of another run or build, or a result
  // that was there when it was saved is not what it was: before any of them is touched.
  std::optional<std::string> load();
  // Of half-written files: what stands behind the checkpoint's end, which is cut off and written anew.
  struct Cut {
    std::filesystem::path file;
    std::uintmax_t bytes = 0;
  };
  const std::vector<Cut>& cut() const { return cut_; }
  // Those that computed what stands before the checkpoint that load() has read.
  const std::string& earlier_kernels() const { return earlier_kernels_; }
  // The run has ended: if it ever had a checkpoint, its results are brought to the disk before that is removed.
  void remove();

 private:
  std::filesystem::path file_;
  double seconds_;
  std::string belongs_to_, kernels_, earlier_kernels_;
  ResultFiles* results_;
  std::vector<Cut> cut_;
  bool used_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace sage::app
