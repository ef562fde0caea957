// What a run reports about itself: iterations, increments, work counters.  Plain data for listings and tests.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/law.hpp"
#include "sage/messages/code.hpp"
#include "sage/platform/profile.hpp"

namespace sage {

inline constexpr int kStatuses = 7;  // values of PointStatus
// Those of points that have reached their strength, in the order of outputs.
inline constexpr std::array kAtStrength = {PointStatus::yielded, PointStatus::slipping, PointStatus::open,
                                           PointStatus::apex, PointStatus::cut_off};
// Flow or slip: an interface without contact is at its strength, but not plastic.
constexpr bool is_plastic(PointStatus status) {
  return status != PointStatus::elastic && status != PointStatus::unloading && status != PointStatus::open;
}

// How often each kind of work ran.
struct WorkCounts {
  long assemblies = 0;           // passes over the elements that built K
  long residuals = 0;            // passes over the elements for internal forces only
  long element_evaluations = 0;  // elements whose law was called
  long linear_products = 0;      // elements answered by a stored K instead
  long analyses = 0, factorisations = 0, solves = 0;
  long kept_factors = 0;    // corrections with factors of an earlier one
  long repeats = 0;         // increments that are a copy of the one before
  long condensed = 0;       // equations removed once for all from the iterations
  long border_steps = 0;    // steps without a recovery of condensed regions
  long twin_equations = 0;  // equations that took the factors of others; of the factorisation with most of them
};

// Names of the phases of a run, and of the analysis within it.
namespace phase {
inline constexpr std::string_view kReading = "reading the deck", kModel = "building the model",
                                  kFiles = "opening and closing files", kAnalysis = "analysis";
inline constexpr std::string_view kStart = "start of stages", kNumbering = "numbering", kAssembly = "assembly",
                                  kCondensation = "condensation", kFactors = "factorisation",
                                  kSolution = "solution", kIteration = "iteration", kChecks = "checks",
                                  kOutput = "output", kCheckpoint = "checkpoint";
}  // namespace phase

// The work of a run, and where its time went since the process began with it.
struct WorkCounters : WorkCounts {
  Profile profile;
};

struct IterationRecord {
  double force = 0.0;         // |out-of-balance force| / force scale
  double displacement = 0.0;  // |correction| / |increment|
  double energy = 0.0;        // |correction . residual| / work of the increment
  double step_length = 1.0;   // line search: factor on the correction; dogleg: |step| / |Newton step|
};

// The dof with the largest unbalanced force.
struct WorstDof {
  int node = -1;
  int field = 0;          // of Model::unknowns, 0 = displacement
  int component = 0;      // of a displacement: 0 = x (r), 1 = y (z)
  double residual = 0.0;  // in the unit of the field's loads
};

struct StepReport {
  int stage = 0;      // 0-based
  int increment = 0;  // 1-based within the stage; 0 = its start
  int increments = 0;
  double load_factor = 0.0;  // part of the stage applied, 0 .. 1
  double early = 0.0;        // time by which stages before ended early
  double started_at = -1.0;  // load factor at the start of the increment; negative = increments are equal
  double failed_at = 2.0;    // load factor of the last attempt that found no equilibrium; 2 = none
  // After a failure: stiffness along the motion, as a share of the largest in the stage; negative = not known.
  double stiffness_share = -1.0;
  bool converged = true;
  // After a failure of the last attempt: the ground moved on and on, and nothing but what hangs on joints did.
  bool flows = false, spares_ground = false;
  // `flows` was found by motion through the size of the model, not by a residual that grows.
  bool proved = false;
  int cuts = 0;  // halvings needed within this increment
  int substeps = 1;
  std::vector<IterationRecord> iterations;  // of the last substep
  int total_iterations = 0;                 // of all substeps, cut ones included
  std::array<long, kStatuses> points{};     // by PointStatus
  WorstDof worst;  // after a failure: of the iteration that came nearest to equilibrium
  double smallest_pivot_ratio = -1.0;
  // So far: difference of displacements along an axis over the model's extent along it; NaN while a condensed region is
  // behind (Assembly::is_behind).
  double motion = 0.0;
  double refused = 0.0;  // the same of the last step that was refused as flow without end; 0 = none was
};

// Sum of forces over the whole model at the end of a stage.
// Sum of what one further field of unknowns balances.
struct FieldAudit {
  double applied = 0.0, reactions = 0.0, scale = 0.0;
};

struct EquilibriumAudit {
  double applied[2] = {0, 0};  // external loads in x and y
  double reactions[2] = {0, 0};
  double moment = 0.0;             // of loads and reactions together, about the origin (plane strain)
  double out_of_balance = 0.0;     // largest of |sum| / force scale over the checks that apply
  double scale = 0.0;              // the largest force or moment that took part
  std::vector<FieldAudit> fields;  // those behind the displacement, in the order of Model::unknowns
};

// Up to here small strains describe displacements well (shares of the model's size, the longer side of the box
// around its nodes): what the change of shape does to the strains is then of the order of a tenth of them.
inline constexpr double kLargeMotion = 0.2;

// stopped: by RunSettings::stop_asked, or closed early; the last increment that observers received is complete.
enum class RunStatus { completed, not_converged, singular, failed, stopped };

struct RunResult {
  RunStatus status = RunStatus::completed;
  std::string reason;        // one page for a person, with the code; empty when completed
  std::optional<Code> code;  // of the reason; none when completed or stopped
  int stages_done = 0;
  int increments_done = 0;
  double motion = 0.0;  // largest difference of displacements along an axis over the model's extent along it
  std::string kernels;  // that the linear solver worked with (LinearSolver::kernels()); empty: it has no choice
  WorkCounters work;
};

}  // namespace sage
