// What a run computes with: the parts of the model that take part in a stage, their equations and the solver.
#pragma once

#include <optional>
#include <string>

#include "sage/analysis/condition.hpp"
#include "sage/analysis/exits.hpp"
#include "sage/analysis/newton.hpp"
#include "sage/analysis/run.hpp"

namespace sage {

class System {
 public:
  // All arguments but the catalogue's entries must outlive it.
  System(const Model& model, const Catalogue& catalogue, const RunSettings& settings, WorkCounters& work);

  // A stage (0-based) that was complete before a checkpoint: only what it leaves to later ones.
  void pass_stage(int s);
  // Activity, equations and numbering.  K and its factors are kept where they still hold.
  void open_stage(int s);

  // The rest of the stage goes on with equations for all dofs that are not held now: none is eliminated.
  void renumber();

  // Seepage faces and drains.  Before a step from the unknowns u that takes this part of the stage: exits at their limit
  // are held there.
  void start_exits(const Eigen::VectorXd& u, double part);
  // After that step, to u + du: true where some were switched, and the step is to be tried again.
  bool switch_exits(const Eigen::VectorXd& u, const Eigen::VectorXd& du, const Eigen::VectorXd& target,
                    double part);
  // Supports with a history, in a step between two load factors of the stage.
  void take_histories(const Stage& stage, double from, double to);
  const Exits& exits() const { return exits_; }

  const Scene& scene() const { return scene_; }
  const Activity& activity() const { return activity_; }
  const Eigen::VectorXd& rate() const { return rate_; }  // prescribed displacements over the stage, every dof
  Assembly& assembly() { return *assembly_; }
  const Assembly& assembly() const { return *assembly_; }
  Tangent& tangent() { return tangent_; }
  const Tangent& tangent() const { return tangent_; }

  int equations() const;  // those of eliminated dofs too
  double smallest_pivot() const;
  DigitsReport digits() const;  // of the factorisation at hand, if there is one
  std::string kernels() const;  // of the solver

  // The last step of the run is complete: K and its factors, most of the memory of a large run, are freed before its
  // outputs allocate theirs.  The functions above return the same as before.
  void release_solver();

 private:
  void enter(const Stage& stage);
  const SolverEntry* choose_solver(const SystemSize& size) const;
  std::unique_ptr<LinearSolver> make(const SolverEntry& entry, bool one_factorisation) const;
  void analyse(bool one_factorisation);
  void take_exits(const Eigen::VectorXd& u, double part);

  const Model& model_;
  const Catalogue& catalogue_;
  const RunSettings& settings_;
  WorkCounters& work_;
  Scene scene_;
  std::unique_ptr<Assembly> assembly_;
  Activity activity_;
  Exits exits_;
  Eigen::VectorXd rate_;
  Tangent tangent_;
  std::vector<char> held_before_, groups_before_, lived_;
  std::vector<TurnedNode> turned_before_;
  struct Last {
    double smallest_pivot = -1.0;
    DigitsReport digits;
    std::string kernels;
  };
  std::optional<Last> last_;  // what the solver reported before it was released
};

// The solver of an entry, or one that leaves out what the skips allow.  one_factorisation: as in SolverSettings.
std::unique_ptr<LinearSolver> make_solver(const Skips& skips, const SolverEntry& entry, bool one_factorisation);

}  // namespace sage
