// The subcommands.  Each adds its options to its parser and returns what main() calls when it was chosen.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

#include "sage/core/catalogue.hpp"
#include "sage/scenes/whole_run.hpp"

namespace sage::app {

using Command = std::function<int()>;  // gives an exit code

// Everything that exists: elements, materials, solvers.
Catalogue full_catalogue();

// Catalogue code of a solver, -1 for an empty name.  Throws InputError for one that is unknown.
int solver_code(const Catalogue& catalogue, const std::string& name);
// A message if no solver has this name (a check of CLI11).
std::string unknown_solver(const std::string& name);

// The same, to run decks that the program writes itself.
scenes::Workbench make_workbench();

// Does the work; what it throws goes to standard error, and its kind into the exit code.  `name` stands before
// messages that name no place in a file.
int guarded(const std::string& name, const std::function<int()>& work);

Command run_command(CLI::App& parser);
Command check_command(CLI::App& parser);
Command echo_command(CLI::App& parser);
Command list_command(CLI::App& parser);
Command tables_command(CLI::App& parser);
Command convert_command(CLI::App& parser);
Command verify_command(CLI::App& parser);
Command compare_command(CLI::App& parser);
Command stress_command(CLI::App& parser);

}  // namespace sage::app
