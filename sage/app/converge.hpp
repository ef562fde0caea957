// --converge of run and compare: finer and finer meshes until what the deck's reports
// say is as certain as asked.
#pragma once

#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sage/app/answer.hpp"
#include "sage/app/run_deck.hpp"

namespace sage::app {

struct ConvergeOptions {
  double tolerance = 0.0;  // relative, of every reported quantity; 0 = not asked for
  int max_dofs = 400'000;
  double max_seconds = 120.0;       // a mesh that is in work then is left
  std::vector<std::string> follow;  // components of reports by name (component_names); empty = the main ones
  std::FILE* screen = stdout;       // where the table goes, beside its file

  bool asked() const { return tolerance > 0.0; }
};

// --converge, --follow, --max-dofs and --max-seconds.  whose: of what the limits hold, "of each side, ".
void add_converge_options(CLI::App& parser, ConvergeOptions& options, const std::string& whose = "");

// What the meshes say of one component of a report.
struct ConvergedValue {
  std::string name;  // "report1.fy"
  double value = 0.0;
  double error = std::numeric_limits<double>::infinity();  // infinite = nothing is known
  bool reached = false;                                    // as certain as asked for, or not followed
};

struct Convergence {
  int exit_code = 0;        // kOk: reached; kNotConverged: a limit came first, or no equilibrium
  std::string not_reached;  // "relative error 1e-05 asked for; ...: why"; empty when reached
  // On the best mesh: all that is followed, and of the other columns of the reports those whose error is known.
  std::vector<ConvergedValue> values;
  // Of the best mesh, or of the first one where that found no equilibrium; nothing where not even that was run.
  std::string options;                   // what a user would ask for to have that mesh
  std::string geometry;                  // what no error holds of curved sides; empty where all are straight
  std::shared_ptr<RunOutcome> best_run;  // where the request asks for results to be kept
  std::filesystem::path table;
  std::vector<std::filesystem::path> reports;  // files of the best mesh
};

// Prints a row a mesh and the result; writes STEM.convergence.csv and the reports of the best mesh (those of
// request.results where that is given).  Throws InputError (also for a deck without reports or with none of a
// name that is to be followed), AnalysisError (of the first mesh), OutputError.
Convergence refine_until_converged(const RunRequest& request, const ConvergeOptions& options,
                                   const Catalogue& catalogue);
// The exit code alone.  found: what --json says of it; null = nobody asks.
int converge(const RunRequest& request, const ConvergeOptions& options, const Catalogue& catalogue,
             Json* found = nullptr);
Json convergence_json(const Convergence& found);

}  // namespace sage::app
