// sagefe echo: every card as it was read, under a column ruler.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <memory>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/deck/layout.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"

namespace sage::app {

namespace {

struct EchoOptions {
  std::string deck;
  bool names = false;
  InputOptions input;
};

// A layout that is being written reads, and echoes, before it makes a model.
void note_half_layout(const std::string& name) {
  if (name.empty()) return;
  if (const int missing = name_problems(load_layout(name, false)).errors(); missing > 0)
    fmt::print(
        stderr,
        "{}: note: the layout makes no model yet: {} missing or used by nothing; sagefe echo --names lists "
        "them\n",
        name, missing == 1 ? "one name is" : std::to_string(missing) + " names are");
}

std::string names_of(const EchoOptions& options) {
  const std::string name =
      options.input.layout.empty() ? detect_layout(read_file(options.deck)) : options.input.layout;
  const Layout layout = load_layout(name, false);
  return "names of layout " + layout.name + (layout.title.empty() ? "" : ", " + layout.title) + '\n' +
         names_listing(layout);
}

}  // namespace

Command echo_command(CLI::App& parser, const Catalogue&) {
  auto options = std::make_shared<EchoOptions>();
  parser.add_option("DECK", options->deck, "deck file")->required();
  add_input_options(parser, options->input);
  parser.add_flag(
      "--names", options->names,
      "list instead the names of the deck's layout: which the program uses, which the layout itself, "
      "which are ignored or used by nothing, and which could be given too");
  return [options] {
    if (options->names) {
      fmt::print("{}", names_of(*options));
      return kOk;
    }
    const Deck deck = read_input(options->deck, options->input, false);
    fmt::print("{}", echo(deck));
    print_diagnostics(deck.diagnostics);
    note_half_layout(options->input.layout);
    return kOk;
  };
}

}  // namespace sage::app
