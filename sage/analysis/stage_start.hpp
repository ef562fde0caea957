// The state and the loads at the start of a stage.
#pragma once

#include "sage/analysis/run_parts.hpp"

namespace sage {

class StageStart {
 public:
  // `run` must outlive it.
  explicit StageStart(const RunParts& run) : run_(run) {}

  // The states that the first stage starts from; before it is opened.
  void start_first_states();
  // Activates and removes groups, and finds both ends of the stage's load path (A1).  Forces that removed parts, initial
  // stress and released supports leave unbalanced are held at the start and released in proportion over the stage.
  // Throws AnalysisError where a law cannot start from the state that it is given.
  void open(int stage);

 private:
  void choose_laws(int stage);
  void reset_displacements(int stage);
  void start_new_nodes();
  void start_states(int stage, const Activity& activity, const std::vector<InitialStress>& initials,
                    bool drainage);
  void find_loads(int stage);
  std::vector<int> free_stored_dofs(int stage) const;
  void let_in_what_came(int stage);
  void take_pressures_of_supports(int stage);
  void begin_water(int stage, const PorePressure* water);
  bool begins_with_stress(int stage, std::size_t group) const;
  void evaluate();
  void note_imbalance(int stage);

  const RunParts& run_;
};

}  // namespace sage
