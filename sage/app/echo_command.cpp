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
    const Deck deck = read_input(options->deck, options->input);
    fmt::print("{}", echo(deck));
    print_diagnostics(deck.diagnostics);
    return kOk;
  };
}

}  // namespace sage::app
