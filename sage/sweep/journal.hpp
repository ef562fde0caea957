// Finished cases of a sweep on the disk: a line a case, which a kill at any moment leaves whole or out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace sage::sweep {

// Status of a case with an answer.
inline constexpr const char* kAnswered = "ok";

// What became of a case.  Equal cases (by key) have equal outcomes.
struct CaseOutcome {
  std::string status;          // kAnswered, or in a word why there is no answer
  std::vector<double> values;  // one a collected quantity; NaN = none
  std::string warnings;        // codes of the run, "S301 S520"
  std::string reason;          // one line; empty where all is well
};

// Of the model, what is collected, and the program.
using CaseKey = std::uint64_t;

class Journal {
 public:
  // Reads all journals of the sweep in the folder, and goes on with that of `part` (0: the only one).  Throws OutputError.
  Journal(std::filesystem::path folder, std::string stem, int part);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const CaseOutcome* find(CaseKey key) const;  // of what was read or added
  // On the disk when it returns.  Several threads may call.
  void add(CaseKey key, const CaseOutcome& outcome);
  // Again from the disk: what others have added.
  void read_all();
  std::size_t size() const { return known_.size(); }

 private:
  void read(const std::filesystem::path& file);

  std::filesystem::path folder_, file_;
  std::string stem_;
  int descriptor_ = -1;
  std::unordered_map<CaseKey, CaseOutcome> known_;
  mutable std::mutex lock_;
};

}  // namespace sage::sweep
