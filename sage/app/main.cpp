// sagefe: the command line.  The only folder that knows all others.
#include <CLI/CLI.hpp>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"

namespace {

using namespace sage::app;

constexpr const char* kDescription =
    "sagefe: 2-D geotechnical finite elements (plane strain and axisymmetry) from fixed-format decks.\n"
    "Try:  sagefe run DECK         compute a deck\n"
    "      sagefe check DECK       read and validate it, compute nothing\n"
    "      sagefe list elements    what a deck can ask for";
constexpr const char* kFooter =
    "Signs: outside, compression is positive for stress and strain; inside and in displacements, axes are.\n"
    "Exit codes: 0 done, 1 command line, 2 input, 3 no equilibrium or singular, 4 output could not be written.";

}  // namespace

int main(int argc, char** argv) {
  CLI::App root(kDescription, "sagefe");
  root.footer(kFooter);
  root.require_subcommand(1);
  root.set_version_flag("--version", "sagefe " SAGE_VERSION);
  const Command commands[] = {run_command(root), check_command(root), echo_command(root), list_command(root),
                              tables_command(root)};
  try {
    root.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return root.exit(error) == 0 ? kOk : kUsage;
  }
  for (const Command& command : commands)
    if (command.parser->parsed()) return guarded("sagefe", command.execute);
  return kUsage;
}
