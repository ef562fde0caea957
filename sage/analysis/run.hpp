// Runs all stages of a model.
#pragma once

#include <functional>
#include <span>

#include "sage/analysis/observer.hpp"
#include "sage/core/catalogue.hpp"
#include "sage/core/time_scheme.hpp"
#include "sage/platform/stop.hpp"

namespace sage {

class Trials;

struct RunSettings {
  int solver = -1;  // catalogue code; -1 = the model's, 0 = automatic
  // Picks a catalogue code when automatic.
  std::function<int(const SystemSize&)> choose_solver;
  int threads = 1;                       // of the linear solver; results do not depend on it
  Kernels kernels = Kernels::automatic;  // of the linear solver, likewise
  int refinement = 0;                    // steps of iterative refinement in every solution
  bool condition = false;        // report the condition number of the equations at the end of each stage
  bool stream_function = false;  // results need it: warn where there is none (S540)
  int max_cuts = 12;             // a step is given up when 2^-max_cuts of its increment finds no equilibrium
  bool line_search = true;
  const TimeScheme* time_scheme = nullptr;  // of the increments of all stages; null = equal ones
  Skips skips;
  bool profile_memory = false;  // the profile also measures where the process grew
  Pulse* pulse = nullptr;       // receives the progress of the run; null = none does

  // Checkpoints: after an increment for which `checkpoint_due` returns true, `save_checkpoint` receives the bytes from
  // which `resume_from` continues to the same results, bit for bit.  With initial stiffness (whose tangent
  // belongs to the start of the stage) only between stages.
  std::function<bool()> checkpoint_due;
  std::function<void(const std::string&)> save_checkpoint;
  std::string resume_from;

  // Not null: one stage does not follow those before it, but is tried with the laws that this one chooses
  // (trials.hpp), and ends the run.  Observers receive nothing of it.  Not together with checkpoints.
  Trials* trials = nullptr;

  // Ends the run early, with RunStatus::stopped: called after every increment (once a checkpoint that is due has
  // been saved), and within increments: in every pass over the elements, in factorisations and before every
  // solution. Observers have then received the last complete increment, and get no on_finish; what becomes of their
  // files is the caller's choice (Output::stop, or a restart).
  StopAsked stop_asked;
};

// Loss of equilibrium ends in RunResult, after the observers have received the last converged state (on_failure,
// on_finish).  So does what prevents the run from continuing: a solver that is unknown, does not suit, can't be loaded or
// gives up, a law that can't start from its state, an element that can't be integrated.  Its status is then
// RunStatus::failed, with the reason; as after RunStatus::stopped, observers get no on_finish, and what becomes of
// their files is the caller's choice (Output::stop).
// Throws:
//   InputError      what only shows at run time: a history that a law refuses, an interface that should take the
//                   traction of a group without initial stress, a checkpoint of another model
//   std::bad_alloc  not enough memory
//   std::logic_error  a piece that breaks its contract (a mistake of the programmer)
// and whatever observers and RunSettings::save_checkpoint throw (OutputError, AnalysisError of a result that is no
// number).
RunResult run(const Model& model, const Catalogue& catalogue, const RunSettings& settings,
              std::span<Observer* const> observers);

}  // namespace sage
