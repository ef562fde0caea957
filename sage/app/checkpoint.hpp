// The file from which an interrupted run goes on: STEM.restart, beside the results.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sage::app {

class Checkpoint {
 public:
  // A checkpoint is due after `seconds` since the last; 0 = after every increment, negative = never.
  // `belongs_to` names the run: model, solver, outputs and program.
  Checkpoint(std::filesystem::path file, double seconds, std::string belongs_to);

  bool due() const;
  // `unfinished`: the results that the run would go on writing, by the names that they are going to have.
  // The old checkpoint stays until the new one is complete.  Throws OutputError.
  void save(const std::string& state, const std::vector<std::filesystem::path>& unfinished);
  // Nothing if there is no file.  Throws InputError where it is damaged or of another run, or results that were
  // there when it was saved are not: before any of them is touched.
  std::optional<std::string> load() const;
  void remove() const;

 private:
  std::filesystem::path file_;
  double seconds_;
  std::string belongs_to_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace sage::app
