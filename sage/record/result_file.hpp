// STEM.h5: all fields at all output increments in one file of HDF5, which Python, ParaView (VTKHDF) and others
// read; docs/manual/result_file.md is its layout, docs/decisions/0012 says why it is so.
#pragma once

#include <functional>

#include "sage/record/out_file.hpp"
#include "sage/record/result.hpp"

namespace sage {

// What a run was made of: with it the model can be built again, and its states be shown without a run.
struct RunSource {
  std::string deck;         // the file's characters; empty = not known, and nothing is kept to be shown again
  std::string layout;       // name of a built-in layout, or empty
  std::string layout_text;  // of a layout of the user's own
  std::string options;      // how the model differs from the deck, as words of a command line
  // Heads of earlier runs, as its water cards asked for them: doubles one behind the other.
  std::string heads{};
};

// Fields that follow from the stress of a point by itself are left out of the files of large models.
struct ResultFields {
  std::vector<std::string> asked = {};  // names of those that are there all the same
  int most_points = 100000;             // integration points of a model that is not large
};

// While the run goes, its states wait in memory, and where they are many or a checkpoint is made in
// STEM.h5.states.partial, from which --restart goes on.  STEM.h5 is written when the run has ended, whole, or not at
// all.
class ResultOutput final : public Output {
 public:
  // threads: with more than one the file is written while its fields are computed; its bytes are the same.
  // Throws OutputError, also where the module that writes such files can't be loaded.
  ResultOutput(const std::filesystem::path& folder, const std::string& stem, RunSource source = {},
               int threads = 1, ResultFields fields = {});
  // Once the file is written nobody needs the states; until then only a checkpoint may name them.
  ~ResultOutput() override;
  ResultOutput(const ResultOutput&) = delete;
  ResultOutput& operator=(const ResultOutput&) = delete;

  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  void on_finish(const Model&, const RunResult&) override;
  bool wants_states(const Model& model, const StepReport& report) const override {
    return is_output_increment(stage_of(model, report.stage), report);
  }
  void exchange(Archive& archive) override;
  void stop(const std::string&) override {}
  std::vector<std::filesystem::path> files() const override { return files_; }

 private:
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 29;  // bytes

  void add(const Model&, const StepReport&, const Solution&);
  void write_states();
  void write_result(const Model& model, const RunResult& result, const std::filesystem::path& partial);
  void each_state(const Model&, const std::function<void(Frame&)>& use);

  std::filesystem::path path_;
  RunSource source_;
  int threads_;
  ResultFields fields_;
  OutFile states_;
  bool in_checkpoint_ = false;          // --restart goes on from the states
  std::vector<std::uint64_t> written_;  // to states_, bytes of each
  std::vector<Frame> waiting_;          // behind those
  std::size_t waiting_bytes_ = 0;
  std::string failure_;  // what the run says that found no equilibrium
  std::vector<std::filesystem::path> files_;
};

}  // namespace sage
