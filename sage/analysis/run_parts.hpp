// What the parts of a run share: the model, its equations, the state, the result and the observers.
#pragma once

#include <optional>
#include <string>

#include "sage/analysis/extent.hpp"
#include "sage/analysis/observer_list.hpp"
#include "sage/analysis/run_state.hpp"
#include "sage/analysis/system.hpp"
#include "sage/model/water.hpp"

namespace sage {

// References only: all that they refer to must outlive it.
struct RunParts {
  const Model& model;
  const RunSettings& settings;
  const Extent& extent;
  System& system;
  RunState& state;
  RunResult& result;
  ObserverList& observer_list;

  Assembly& assembly() const { return system.assembly(); }
  Tangent& tangent() const { return system.tangent(); }
  Profile& profile() const { return result.work.profile; }
  // The stage in hand.
  const Stage& stage() const { return model.stages[state.place.stage]; }

  // Share of the stage's loads at the committed state.
  double load_share() const { return stage().is_controlled() ? state.path.load_share : state.reached; }
  // The committed state.
  Solution solution() const;
  void warn(const std::vector<Diagnostic>& list) const;

  // Laws and elements that depend on time are evaluated at this load factor of the stage in hand, after a step of that
  // share of the stage; share 0 = a state at rest.
  void set_step_time(double load_factor, double share) const;
  StepTime step_time(const RunPlace& place, double load_factor, double share) const;
  // Pore pressures at points, at this load factor of the stage in hand.
  void set_water(double load_factor) const;
  // Pore pressures at the end of a stage; nothing where the model has no water.  u: unknowns of an earlier flow, or null.
  std::optional<PorePressure> water_at(int stage, const Activity& activity, const Eigen::VectorXd* u) const;
  // Load factor of a stage at the end of an increment (0 = its start).  Throws std::logic_error where a time scheme breaks
  // its contract.
  double end_of(const RunPlace& place) const;
  // Loads at this load factor of the stage in hand (A1), every dof.
  Eigen::VectorXd loads_at(double load_factor) const;
  // What loads with a history differ there from loads that grow in proportion.
  void add_histories(double load_factor, Eigen::VectorXd& loads) const;
  // What has left through an exit of excess pressure is a load from then on: the node may close in the next step.
  void collect_at_exits() const;
  // All that a step starts from at the committed state, except for the tangent; and back to it, with no step in hand.
  std::string keep_state() const;
  void restore_state(const std::string& kept) const;
  // Shows the progress of the run where somebody watches (RunSettings::pulse).
  void show_progress(const StepReport& report, double load_factor) const;
};

// All groups of the model are flow elements.
bool is_flow_alone(const Model& model);

}  // namespace sage
