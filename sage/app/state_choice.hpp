// States of a run by the words of a command line: stage and increment, axial strain, part of the load.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sage/model/model.hpp"

namespace sage::app {

inline constexpr const char* kStatesWanted =
    "STAGE[:INCREMENT], both from 1, strain=VALUE[,VALUE...] or load=VALUE[,VALUE...]";

// An increment of a stage, from 1 (increment 0 = the stage's last, stage 0 = the last), or a value that is reached
// within one: the axial strain of the specimen, or the load factor of the last stage.
struct StateChoice {
  int stage = 0, increment = 0;
  std::optional<double> strain, load;
  std::string words;  // "strain=0.05", for messages
};

// "strain=.05,.1", "load=.5", "1:5,2".  Throws std::invalid_argument that says what is wanted.
std::vector<StateChoice> state_choices(const std::string& text);
// A check of CLI11 of `option`: an empty text, or what is wrong.
std::string state_error(const std::string& option, const std::string& text);

// The deck's nodes of a triaxial report, whose mean motion is the strain.
std::vector<int> report_nodes(const Model& model, const Report& report);

// Before a run: adds the increments that come nearest to what is asked for to Stage::output_at.  Gives a note for
// each that no increment hits.  Throws std::invalid_argument where the deck has none such: a stage or increment
// that it lacks, or a strain where its displacements do not say which.
std::vector<std::string> ask_for_states(Model& model, const std::vector<std::string>& texts);

}  // namespace sage::app
