// sagefe: the command line.  The only folder that knows all others.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

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

// True, and said, where the first word is no command: the parser itself would only ask for one.
bool unknown_command(const CLI::App& root, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::string known;
  for (const CLI::App* command : root.get_subcommands(nullptr)) {
    if (command->get_name() == argv[1]) return false;
    known += " " + command->get_name();
  }
  fmt::print(stderr, "sagefe: unknown command {}; known:{}\n", argv[1], known);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App root(kDescription, "sagefe");
  root.footer(kFooter);
  root.require_subcommand(1);
  root.set_version_flag("--version", "sagefe " SAGE_VERSION);
  const Command commands[] = {run_command(root),    check_command(root),   echo_command(root),
                              list_command(root),   tables_command(root),  convert_command(root),
                              verify_command(root), compare_command(root), stress_command(root)};
  if (unknown_command(root, argc, argv)) return kUsage;
  try {
    root.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return root.exit(error) == 0 ? kOk : kUsage;
  }
  for (const Command& command : commands)
    if (command.parser->parsed()) return guarded("sagefe", command.execute);
  return kUsage;
}
