// Many cases of one deck in one process: threads over cases, finished ones kept on the disk.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sage/analysis/run.hpp"
#include "sage/sweep/journal.hpp"
#include "sage/sweep/quantity.hpp"
#include "sage/sweep/study.hpp"

namespace sage::sweep {

struct SweepOptions {
  int threads = 1;            // cases at a time; each has one thread
  int part = 0, parts = 1;    // only cases part, part + parts ... from 0
  std::uint64_t program = 0;  // tells programs apart: their outcomes are not mixed
  StopAsked stop_asked{};     // ends it early
  std::function<int(const SystemSize&)> choose_solver{};
  // What observes the run of a case (from 0) besides; called from the threads of the cases.  A case with observers is run
  // though its outcome is kept.
  std::function<std::vector<std::unique_ptr<Observer>>(std::size_t index, CaseKey key)> observers{};
  // From the calling thread, now and then.
  std::function<void(std::size_t done, std::size_t count)> progress{};
};

struct CaseRow {
  bool done = false;
  CaseOutcome outcome;
  CaseKey key = 0;       // 0: no model could be made
  std::size_t same = 0;  // number, from 1, of the first case with the same model; 0 = it has its own
};

struct SweepResult {
  std::vector<CaseRow> rows;  // in the order of the cases, whatever ran first
  std::size_t ran = 0, kept = 0, left = 0;
};

class Sweep {
 public:
  // Finds out all that can be wrong before the first case: names and values, quantities, values that no model reads
  // (S734).  The catalogue must outlive it.  deck: that of the study.  Throws InputError.
  Sweep(Study study, const Deck& deck, const Catalogue& catalogue, const BuildOptions& build);

  // Throws OutputError where the journal can't be written.
  SweepResult run(Journal& journal, const SweepOptions& options) const;

  const Study& study() const { return study_; }
  const Model& model() const { return model_; }  // of the deck, with what the study sets in all cases
  const std::vector<Quantity>& quantities() const { return quantities_; }

 private:
  class Work;
  void check_values() const;
  void check_field(std::size_t name) const;
  void check_read(std::size_t name) const;
  void check_used(const std::string& name) const;
  void find_quantities();
  std::string new_warning(const Model& model) const;
  CaseOutcome compute(std::size_t index, const Model& model, const RunSettings& settings,
                      std::span<const std::unique_ptr<Observer>> more) const;
  Model build(std::size_t index) const;

  Study study_;
  const Catalogue* catalogue_;
  NamedModel named_;
  Model model_;
  std::vector<Quantity> quantities_;
  std::vector<std::string> allowed_;  // codes of warnings
  std::uint64_t options_key_ = 0;
};

}  // namespace sage::sweep
