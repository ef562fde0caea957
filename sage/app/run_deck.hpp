// One deck from file to results: what `run`, `tables` and the regression tests share.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "sage/analysis/run.hpp"
#include "sage/app/input.hpp"
#include "sage/app/result_files.hpp"
#include "sage/record/listing.hpp"
#include "sage/record/report.hpp"
#include "sage/record/result.hpp"
#include "sage/record/summary.hpp"

namespace sage::app {

struct OutputOptions {
  std::filesystem::path folder = "out";
  bool listing = true;
  Tables tables = Tables::automatic;
  bool increments = true;  // STEM.increments.csv
  bool nodes = false, points = false;
  int digits = 0;                     // of numbers in CSV files and in the summary's reports; 0 = the usual
  bool error = false;                 // estimate of the discretisation error
  bool vtu = false;                   // STEM_0001.vtu ... and STEM.pvd
  bool msh = false;                   // STEM.msh
  bool msh_text = false;              // as text; only with msh
  bool result = false;                // STEM.h5
  std::vector<std::string> pictures;  // fields, as SVG at the end of each stage and at `states`
  std::vector<std::string> states;    // more output increments than the deck's (state_choices)
  std::vector<std::string> fields;    // more columns of tables and of reports of points, by name
};

struct RunRequest {
  std::string deck;
  InputOptions input;
  OutputOptions output;
  std::string stem;    // of the names of result files; empty = the deck's name
  std::string solver;  // a name of the catalogue; empty = the deck's choice
  int threads = 0;     // of the linear solver; 0 = one for each processor
  Kernels kernels = Kernels::automatic;
  int refinement = 0;                // steps of iterative refinement in every solution
  bool condition = false;            // say the condition number at the end of each stage
  bool quiet = false;                // no messages about the deck
  Skips skips;                       // all are on
  int max_dofs = 0;                  // larger models are built but not run; 0 = no limit
  bool restart = false;              // go on from STEM.restart, if there is one
  double checkpoint_seconds = 30.0;  // between checkpoints; 0 = after every increment, negative = none
  double interrupt_patience = 7.0;   // s that an interrupted run gives the increment in hand to end
  StopAsked stop_asked;              // ends the run early, see RunSettings
  ResultFiles* results = nullptr;    // of the run that this one is a part of; null = it has its own
  bool profile = false;              // STEM.profile.json, and memory in RunRecord::profile
  bool keep_result = false;          // RunOutcome::result is wanted
  Observer* watch = nullptr;         // sees the run too
  // Makes a page of STEM.h5 when all other results are complete, as one of them, and gives its path; empty = none is
  // wanted.
  std::function<std::filesystem::path(const std::filesystem::path& result)> write_page = {};
};

// Reports and record stay readable after the run.
struct RunOutcome {
  int exit_code = 0;
  bool too_large = false;  // more than max_dofs: not run
  // Interrupted (kInterrupted): from which checkpoint a restart goes on; empty where there is none.
  std::filesystem::path checkpoint;
  std::unique_ptr<Model> model;
  std::unique_ptr<Reports> reports;
  std::unique_ptr<DiscretisationError> error;  // where asked for
  RunRecord record;
  std::unique_ptr<Result> result;  // of the model above; where it is wanted
  std::vector<std::filesystem::path> files;
};

// STEM of STEM.lst, STEM.report1.csv ...
std::string stem_of(const RunRequest& request);

void add_threads_option(CLI::App& parser, int& threads);
void add_kernels_option(CLI::App& parser, Kernels& kernels);
// Those of the linear solver: what was asked for, or one for each processor where that is 0.
int threads_for(int asked);

// Throws InputError, OutputError, and AnalysisError with the reason of a run that failed (RunStatus::failed).
RunOutcome run_deck(const RunRequest& request, const Catalogue& catalogue);

}  // namespace sage::app
