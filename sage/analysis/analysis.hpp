// A model analysed increment by increment, under the control of a host program.  run() is a loop over it.
#pragma once

#include <memory>
#include <span>

#include "sage/analysis/run.hpp"

namespace sage {

//   Analysis analysis(model, catalogue, settings);
//   analysis.open();
//   while (analysis.advance())
//     if (settlement(analysis.state()) > limit) break;
//   const RunResult result = analysis.close();
//
// Any number of analyses may live in one process, one after the other, interleaved or each in a thread of its own: they
// share nothing but what they only read (the catalogue, and a model where they have the same).  One analysis must not be
// used by two threads at once.
//
// All functions throw what run() throws, and std::logic_error where they are called out of order.  After another exception
// only the destructor may be called.
class Analysis {
 public:
  // The model, the catalogue and the observers must outlive it.  Observers may be none: state() is there for the host.
  Analysis(const Model& model, const Catalogue& catalogue, RunSettings settings,
           std::span<Observer* const> observers = {});
  ~Analysis();
  Analysis(Analysis&&) noexcept;
  Analysis& operator=(Analysis&&) noexcept;

  // Sets initial stresses and opens the first stage, or goes back to the checkpoint RunSettings::resume_from.
  // False: that failed, and close() says why.
  bool open();

  // Takes the next increment; at the end of a stage the next call opens the next stage.  True: an increment is complete and
  // in equilibrium.  False: the last one was complete before, or there is no equilibrium, or the analysis was stopped;
  // close() says which, and state() is still the last one in equilibrium.  With RunSettings::trials one call takes all
  // trials behind the last stage before them, and returns false.
  bool advance();

  // The last committed state: unknowns and forces of every dof (model axes, tension positive, dofs as in
  // Assembly::dof_map), stresses, strains and histories of all points.  It is valid until the next call of a function that
  // is not const.  Reading it changes no later result beyond rounding.
  Solution state();

  // The host has changed loads of the model: nodal loads, edge loads or body forces of the stage in hand or of those
  // before it.  The loads of the stage go from what acts now to the new loads at its end, in proportion to what is left of
  // the load factor.  Without increments left in the stage the difference is applied over the next stage.
  // Loads, supports and water of stages that have not been opened may be changed at any time, without this call.  Nothing
  // else of the model may be changed while an analysis uses it.
  void take_loads();

  // Of the stage in hand, from 0, and increments of it that are complete.
  int stage() const;
  int increment() const;
  // The last increment of the last stage is complete.
  bool is_complete() const;

  // Tells the observers that the analysis is finished (Observer::on_finish), and returns how it ended.  Where increments
  // are left, its status is RunStatus::stopped and observers hear nothing.
  RunResult close();

 private:
  class Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace sage
