// States of result files, chosen by stage and increment or by the strain of the specimen.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sage/model/model.hpp"
#include "sage/record/stored_result.hpp"

namespace sage::app {

// A result file with the model of its run.  Throws InputError where the file is none.
struct StoredRun {
  std::string file, label;
  StoredResult stored;
  Model model;

  StoredRun(const std::string& name, const Catalogue& catalogue);
  StoredRun(const StoredRun&) = delete;
  StoredRun& operator=(const StoredRun&) = delete;

  bool ends_its_stage(std::size_t state) const;
  bool failed(std::size_t state) const {
    return state + 1 == stored.states().size() && !stored.failure().empty();
  }
  // Of the first specimen that the deck's reports have, since the start of the report's stage, compression
  // positive; nothing where there is none or the stage has not come.
  std::optional<double> axial_strain(const Frame& frame) const;
};

// An empty text where `text` says one: STAGE[:INCREMENT] or strain=VALUE; else what is wanted.
std::string moment_error(const std::string& text);

// Places in run.stored.states() of what is asked for; without that the ends of all stages.  Throws UsageError that
// says which states the file has.
std::vector<std::size_t> states_of(const StoredRun& run, const std::vector<std::string>& at);

// "end of stage 2, axial strain 0.05"
std::string words_of_state(const StoredRun& run, std::size_t state, const Frame& frame);

}  // namespace sage::app
