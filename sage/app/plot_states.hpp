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

// Places in run.stored.states() of what is asked for (state_choices), each once; without that the ends of all
// stages.  Throws UsageError that says which states the file has.
std::vector<std::size_t> states_of(const StoredRun& run, const std::vector<std::string>& at);

using StoredRuns = std::vector<std::unique_ptr<StoredRun>>;

// Labels of runs that are drawn together: those asked for, else the titles; files where titles are alike, and the
// geometry behind them where it is not the same in all.  Throws UsageError where units differ, which no common axis
// or scale can show.
std::vector<std::string> labels_of(const StoredRuns& runs, const std::vector<std::string>& asked);

// Throws UsageError where no interface, or else no element that fills an area (soil, or water's way through it), has
// a number of the field in any of these states.  Fields of nodes have one wherever there is a mesh.
void expect_numbers(const StoredRun& run, const std::vector<std::size_t>& states, const FieldChoice& field,
                    const std::string& name, ElementKind kind);

// Throws UsageError where no structure has an end with the force of a diagram (diagram_of) in any of these states.
void expect_diagram(const StoredRun& run, const std::vector<std::size_t>& states, const std::string& name);

// "end of stage 2, axial strain 0.05"
std::string words_of_state(const StoredRun& run, std::size_t state, const Frame& frame);

}  // namespace sage::app
