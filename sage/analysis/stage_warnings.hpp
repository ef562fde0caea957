// What a reader should know about a stage before trusting its results.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/condition.hpp"
#include "sage/analysis/observer.hpp"
#include "sage/analysis/records.hpp"

namespace sage {

Diagnostic stage_message(const Stage& stage, Code code, const std::string& message,
                         Severity severity = Severity::warning);

// A note of this code is for the listing and for -v alone.
inline constexpr Code kDetailNote{"S523"};

// Displacements beyond those that small strains describe; motion: RunResult::motion.
std::vector<Diagnostic> motion_warnings(const Stage& stage, double motion);

// What has been gathered when a stage is complete.
struct StageFindings {
  double motion = 0.0;          // RunResult::motion
  double out_of_balance = 0.0;  // EquilibriumAudit::out_of_balance
  DigitsReport digits;
  double path_error = 0.0;  // PathError, the largest of the stage
  std::string loose_part;   // the first of the stage; empty = none
  int relaxed = 0;          // steps found by dynamic relaxation
  double last_force = 0.0;  // out of balance at the end of the last increment, relative
};

// Answers about a free surface that depend on how it is smoothed.
std::vector<Diagnostic> free_surface_warnings(const Model& model, const Stage& stage, const Assembly& assembly);

// Reports of lines whose largest gradient has no bound.
std::vector<Diagnostic> gradient_warnings(const Model& model, const Stage& stage, const Activity& activity);

// Where the flow has no stream function, and why.
std::vector<Diagnostic> stream_warnings(const Model& model, const Stage& stage, const Solution& solution);

std::vector<Diagnostic> stage_warnings(const Stage& stage, const StageFindings& findings,
                                       const Assembly& assembly);

}  // namespace sage
