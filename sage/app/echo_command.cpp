// sagefe echo: every card as it was read, under a column ruler.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <memory>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/deck/read_deck.hpp"

namespace sage::app {

namespace {

struct EchoOptions {
  std::string deck;
  InputOptions input;
};

}  // namespace

Command echo_command(CLI::App& parser, const Catalogue&) {
  auto options = std::make_shared<EchoOptions>();
  parser.add_option("DECK", options->deck, "deck file")->required();
  add_input_options(parser, options->input);
  return [options] {
    const Deck deck = read_input(options->deck, options->input);
    fmt::print("{}", echo(deck));
    print_diagnostics(deck.diagnostics);
    return kOk;
  };
}

}  // namespace sage::app
