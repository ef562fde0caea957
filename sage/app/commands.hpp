// The subcommands.  Each adds its options to its parser and returns what main() calls when it was chosen.  The
// catalogue says what decks can ask for, and outlives the command.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <string>

#include "sage/core/catalogue.hpp"
#include "sage/umat/law.hpp"

namespace sage::app {

using Command = std::function<int()>;  // gives an exit code

// Every piece of the program itself: elements, materials, solvers; with the routines of law `umat`.
Catalogue full_catalogue(std::vector<umat::Binding> umats = {});

// Catalogue code of a solver, -1 for an empty name.  Throws InputError for one that is unknown.
int solver_code(const Catalogue& catalogue, const std::string& name);
// A check of CLI11: a message if no solver has the name.
std::function<std::string(const std::string&)> known_solver(const Catalogue& catalogue);

// The folder of the decks that come with the program: beside an installed one, else that of the source tree.
std::filesystem::path shipped_decks();

// Does the work; what it throws goes to standard error, and its kind into the exit code.  `name` stands before
// messages that name no place in a file.
int guarded(const std::string& name, const std::function<int()>& work);

Command run_command(CLI::App& parser, const Catalogue& catalogue);
Command check_command(CLI::App& parser, const Catalogue& catalogue);
Command align_command(CLI::App& parser, const Catalogue& catalogue);
Command echo_command(CLI::App& parser, const Catalogue& catalogue);
Command conform_command(CLI::App& parser, const Catalogue& catalogue);
Command list_command(CLI::App& parser, const Catalogue& catalogue);
Command new_command(CLI::App& parser, const Catalogue& catalogue);
Command plot_command(CLI::App& parser, const Catalogue& catalogue);
Command tables_command(CLI::App& parser, const Catalogue& catalogue);
Command convert_command(CLI::App& parser, const Catalogue& catalogue);
Command verify_command(CLI::App& parser, const Catalogue& catalogue);
Command compare_command(CLI::App& parser, const Catalogue& catalogue);
Command drive_command(CLI::App& parser, const Catalogue& catalogue);
Command figures_command(CLI::App& parser, const Catalogue& catalogue);
Command report_command(CLI::App& parser, const Catalogue& catalogue);
Command bounds_command(CLI::App& parser, const Catalogue& catalogue);
Command safety_command(CLI::App& parser, const Catalogue& catalogue);
Command sweep_command(CLI::App& parser, const Catalogue& catalogue);
Command stress_command(CLI::App& parser, const Catalogue& catalogue);
Command layout_command(CLI::App& parser, const Catalogue& catalogue);
Command explain_command(CLI::App& parser, const Catalogue& catalogue);
Command completion_command(CLI::App& parser, const Catalogue& catalogue);

// The whole command line in one parser, which is to be looked at and not to parse: a run makes the options of
// its own command alone.
void add_all_commands(CLI::App& root, const Catalogue& catalogue);

}  // namespace sage::app
