// The least and the largest of each force and moment of a structure, stage by stage and over all stages.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sage/record/end_forces.hpp"

namespace sage {

// Of a group at the end of a stage.  Without padding: its bytes stand in checkpoints.
struct ExtremeRow {
  std::int64_t stage = 0;                // from 0
  std::int64_t group = 0, field = 0;     // places in Model::groups and structure_forces()
  std::int64_t low_at = 0, high_at = 0;  // the deck's element numbers
  std::int64_t low_stage = 0, high_stage = 0;
  double low = 0.0, high = 0.0;  // as people read them
};

// Fields of structures that are forces or moments.
FieldList structure_forces(const Model& model);
bool has_structures(const Model& model);

// Of all groups of structures that are active.
std::vector<ExtremeRow> extremes(const Model& model, int stage, const Solution& solution);
// Rows of one group and field made one: the envelope of the stages.
std::vector<ExtremeRow> envelope(const std::vector<ExtremeRow>& rows);

// Of a group: its number, and its name or element.
std::string structure_name(const Group& group);
// A table, a line a row; with the stages of the values where there are several.  Empty without rows.
std::string extremes_table(const Model& model, const std::vector<ExtremeRow>& rows, bool with_stages);
// The same of every end, a line an end, with the stages.  Empty without rows.
std::string envelope_table(const Model& model, const std::vector<EnvelopeEnd>& rows);

}  // namespace sage
