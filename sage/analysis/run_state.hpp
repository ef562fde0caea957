// What a run carries from step to step.
#pragma once

#include <string>

#include <Eigen/Core>

#include "sage/analysis/stepping_policy.hpp"
#include "sage/core/archive.hpp"

namespace sage {

// How far a run has come: complete increments of a stage.
struct RunPlace {
  int stage = 0, increment = 0;
};

// Steps of flowing pore water that are chosen by their error, and how far the water has gone (pore_steps.hpp).
struct PorePath {
  double size = 0.0;                        // of the next step, as a share of the stage; 0 = not known yet
  double error = 0.0;                       // sum of the bounds on errors of steps, in the unit of pressure
  double largest = 0.0;                     // largest root mean square of pressure so far
  double most = 0.0, water_pressure = 0.0;  // integral of pressure: largest magnitude so far, and now
  long steps = 0;
  bool ended = false;    // the degree or pressure that ends the stage is reached
  Eigen::VectorXd rate;  // of pressures at the committed state, every dof; empty = not known
  // Steps of that share of the stage have that theta; others have 1, and without a share (0) that of the stage.
  double theta = 1.0, theta_share = 0.0;
  Eigen::VectorXd volumes;  // of soil at each pressure, every dof; found again by a run that resumes

  void exchange(Archive& archive) {
    for (double* value : {&size, &error, &largest, &most, &water_pressure, &theta, &theta_share})
      archive(*value);
    archive(steps);
    archive(ended);
    archive(rate);
  }
};

// The load path of a stage.  Vectors have one entry per dof.
struct StagePath {
  Eigen::VectorXd external_start, force_start;  // loads and internal forces at its start
  Eigen::VectorXd force_end;                    // loads at its end
  Eigen::VectorXd water_force;                  // of them, those of water; empty = no water
  Eigen::VectorXd u_start;                      // unknowns at its start, where dofs are eliminated
  // Of excess pressures, what has come or gone where stages before held them and this one does not; empty = no such field.
  Eigen::VectorXd let_in;
  PorePath pores;
  std::unique_ptr<SteppingPolicy> policy = std::make_unique<SteppingPolicy>();
  double last_size = 0.0;                       // of the last step, as a share of the stage; 0 = there is none
  double stiffest = 0.0, last_stiffness = 0.0;  // along the motion: largest so far, of the last step
  double path_error = 0.0;                      // largest so far
  double load_share = 0.0;     // of the stage's loads, at the committed state; where it is controlled
  double largest_share = 0.0;  // of these so far
  double control_start = 0.0;  // the displacement that controls it, at the start of the stage
  bool own_tangent = false;    // modified Newton, initial stiffness: steps begin with K of their start
  int relaxed = 0;         // steps found by dynamic relaxation: if any, others are relaxed before they are cut
  std::string loose_part;  // the first; empty = none
  std::vector<std::vector<double>> pore_start, pore_end;  // pore pressure at points, by group; empty = no water

  // No step of the stage has been taken yet; loads and pore pressures stay.
  void begin() {
    forget_steps();
    path_error = load_share = largest_share = 0.0;
    own_tangent = false;
    relaxed = 0;
    loose_part.clear();
    pores = {};
  }
  // What is known of the last steps.
  void forget_steps() {
    policy->forget(SteppingPolicy::Past::stage);
    last_size = stiffest = last_stiffness = 0.0;
  }
};

struct RunState {
  Eigen::VectorXd u, external;  // displacements and loads at the committed state, every dof
  Eigen::VectorXd du;           // the step in hand or just taken
  Eigen::VectorXd u_before;     // before that step, where elements see unknowns
  Eigen::VectorXd target;       // loads at the end of that step
  // Internal forces and loads as outputs see them, where loads follow the motion.
  Eigen::VectorXd moved_internal, moved_external;
  StagePath path;
  RunPlace place;  // the increment in hand
  // Load factor of the stage in hand at the committed state; of a stage whose load is controlled, the share of the
  // displacement that controls it.
  double reached = 0.0;
  double easing = 1.0;  // of laws of water, while a free surface is searched for
  double early = 0.0;   // time by which stages before ended early

  // To a checkpoint or back: after an increment (within a stage), or between two stages.
  void exchange_totals(Archive& archive) {
    archive(u);
    archive(external);
    archive(early);
  }
  void exchange_path(Archive& archive) {
    archive(du);
    archive(u_before);
    path.policy->exchange(archive);
    archive(path.last_size);
    archive(path.stiffest);
    archive(path.last_stiffness);
    archive(path.path_error);
    archive(path.load_share);
    archive(path.largest_share);
    archive(path.control_start);
    archive(path.own_tangent);
    archive(path.relaxed);
    archive(path.loose_part);
    archive(path.external_start);
    archive(path.force_start);
    archive(path.force_end);
    archive(path.u_start);
    archive(path.let_in);
    path.pores.exchange(archive);
  }
};

}  // namespace sage
