// STEM.h5 read back: the states of a run, for those who show them without running the model again.
#pragma once

#include <filesystem>
#include <memory>

#include "sage/record/data_file.hpp"
#include "sage/record/result.hpp"
#include "sage/record/result_file.hpp"

namespace sage {

// Where it lies in the file.  The states are bytes of Frame::exchange_state(): another format is another program's.
// In frames-1 they are whole; now they lack what Frame::follows_from_fields.
inline constexpr const char* kStoredFolder = "/sage/run";
inline constexpr const char *kStoredFormat = "frames-2", *kWholeFormat = "frames-1";
inline constexpr const char* kStoredHeads = "heads";  // of runs that took some from another run
// stage, increment, increments, checksum of the bytes, checksum of the fields that they lack (not in frames-1)
inline constexpr std::size_t kStoredColumns = 5, kWholeColumns = 4;
inline std::string stored_path(const std::string& name) {
  return std::string(kStoredFolder) + "/" + name;
}
// Where a group's tables lie.  Triangles among the quadrilaterals of a card are a group with its number too: the
// second has the name of its element behind that.
std::string group_path(const Model& model, const Group& group);

class StoredResult {
 public:
  struct State {
    int stage = 0, increment = 0, increments = 0;  // stage from 0
    std::uint64_t checksum = 0, fields_checksum = 0;
  };

  // Throws InputError where the file is none of this program's, or lacks what the states belong to.
  explicit StoredResult(const std::filesystem::path& file);

  const RunSource& source() const { return source_; }
  const std::string& deck_name() const { return deck_name_; }
  // Why the run ended without equilibrium; empty = it has not.
  const std::string& failure() const { return failure_; }
  const std::vector<State>& states() const { return states_; }
  // Throws InputError where the model is not that of the run: other pieces, or another version of the program.
  void expect_model(const Model& model) const;
  // By the place in states(), of the run's model.  Throws InputError where the file is damaged.
  Frame frame(const Model& model, std::size_t state) const;

 private:
  [[noreturn]] void fail(const std::string& what) const;
  std::string bytes(const std::string& name) const;
  std::string text(const char* name) const;
  void read_fields(const Model& model, std::size_t state, Frame& frame) const;

  std::filesystem::path path_;
  std::unique_ptr<DataFile> file_;
  RunSource source_;
  std::string deck_name_, failure_, model_;
  std::vector<State> states_;
  bool whole_ = false;  // the states' bytes lack nothing
};

}  // namespace sage
