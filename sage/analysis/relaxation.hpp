// Dynamic relaxation: a step as a motion of masses that comes to rest in equilibrium.  docs/theory/analysis.md
#pragma once

#include <vector>

#include "sage/analysis/run_parts.hpp"

namespace sage {

// The elastic stiffness is the mass.  The history follows the motion: every state that it passes is committed.
class Relaxation {
 public:
  enum class End {
    rest,  // the residual is as small as required
    flow,  // the ground moves on and on: by the size of the model, or far or ever faster with a residual that stays
    restless,  // neither, after many passes
    lost,      // a law has no answer on the way, or the elastic stiffness is singular
  };

  // of_solids: by dof of displacements, whether a solid has it.  Both must outlive it.
  Relaxation(const RunParts& run, const std::vector<char>& of_solids) : run_(run), of_solids_(of_solids) {}
  // All unknowns of the model have a mass, or nothing to move: heads of steady flow.
  static bool suits(const Model& model);

  // From the committed state at one load factor of the stage in hand towards another, by an elastic step that leaves only a
  // small residual; the end of that step.
  double start(double from, double to);
  // Moves on until |residual| / |forces of the elements| is at most `goal`.  Where other corrections have been tried since
  // the last call, the tangent must be empty (Tangent::forget).
  End settle(double goal);

  // Committed points that are elastic, and were at their strength in the last quarter of the passes, get that status: the last
  // correction of a step is too short to reach it.
  void show_strength() const;

  int passes() const { return passes_; }      // over the elements, since start()
  double residual() const { return force_; }  // relative, of the last pass

 private:
  bool hold_elastic();
  bool is_ready();
  bool try_step(double from, double to);
  void accelerate();
  bool advance();
  void form_residual();
  void note_strength();
  double largest_motion() const;
  bool flows() const;
  void watch();

  const RunParts& run_;
  const std::vector<char>& of_solids_;
  Eigen::VectorXd residual_, velocity_, acceleration_;  // by equation
  Eigen::VectorXd start_u_;                             // by dof
  struct AtStrength {
    PointStatus status = PointStatus::elastic;
    int pass = -1;  // the last one in which the point was at its strength
  };
  std::vector<std::vector<AtStrength>> at_strength_;  // by group and point
  double to_ = 0.0;                                   // load factor at the end of the step
  double force_ = 0.0;
  double share_ = 0.0;  // of the acceleration that a pass adds to the velocity
  struct Window {
    double least = 0.0;  // relative residual in so many passes
    double moved = 0.0;  // at their end, since the start
  };
  std::vector<Window> windows_;
  double least_ = 0.0;  // of the window that is not complete
  int passes_ = 0;
  bool lost_ = false;
};

}  // namespace sage
