// sagefe layout: a first layout for a deck that nobody knows, and what a layout reads of a deck.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/deck/layout.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"
#include "sage/layout_draft/coverage.hpp"
#include "sage/layout_draft/layout_draft.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

struct DraftOptions {
  std::string deck, out;
};

bool is_built_in(const std::string& name) {
  const std::vector<std::string> names = built_in_layouts();
  return std::ranges::find(names, name) != names.end();
}

// After the file that it is written to, or the deck; never the name of a layout that is built in.
std::string name_of_draft(const DraftOptions& options) {
  std::string name =
      options.out.empty() ? case_name(options.deck) : std::filesystem::path(options.out).stem().string();
  return is_built_in(name) || name.empty() ? name + "_guessed" : name;
}

int guess(const DraftOptions& options) {
  keep_input(options.deck);
  const std::string name = name_of_draft(options);
  const LayoutDraft layout = draft_layout(read_file(options.deck), options.deck, name);
  if (Json* json = answer()) {
    *json = {
        {"layout", json_text(name)}, {"cards", layout.cards}, {"lines_not_understood", layout.not_understood}};
    (*json)["file"] = options.out.empty() ? Json(nullptr) : Json(json_text(options.out));
    if (options.out.empty()) (*json)["toml"] = json_text(layout.toml);
  }
  if (options.out.empty()) {
    fmt::print("{}", layout.toml);
  } else {
    write_file(options.out, layout.toml);
    fmt::print("{}: {} kinds of cards", options.out, layout.cards);
    if (layout.not_understood > 0) fmt::print("; {} lines not understood, read as text", layout.not_understood);
    fmt::print("\n  sagefe layout check {} {}    what it reads, under a column ruler\n", options.out,
               options.deck);
  }
  return kOk;
}

struct CoverageOptions {
  std::string layout, deck;
  bool strict = false;
};

bool is_layout_file(const std::string& path) {
  return std::filesystem::path(path).extension() == ".toml";
}

// The layout; where it is none but the deck looks like one, an error that says so.
Layout layout_of(const CoverageOptions& options) {
  try {
    return load_layout(options.layout);
  } catch (const InputError& error) {
    if (is_built_in(options.layout) || is_layout_file(options.layout)) throw;
    if (is_built_in(options.deck) || is_layout_file(options.deck))
      throw InputError("S149", {options.layout, 0, 0, 0},
                       "this is no layout, but " + options.deck +
                           " is: the layout comes first, sagefe layout check " + options.deck + ' ' +
                           options.layout);
    Diagnostics problems = error.diagnostics();
    problems.note("S149", {options.layout, 0, 0, 0},
                  "it was read as the layout: sagefe layout check LAYOUT DECK takes the layout first, a file "
                  "or the name of one that is built in");
    throw InputError(std::move(problems));
  }
}

void answer_coverage(const Layout& layout, const Coverage& coverage) {
  Json* const json = answer();
  if (json == nullptr) return;
  Json cards = Json::array();
  for (std::size_t i = 0; i < coverage.cards.size(); ++i) {
    const CardCoverage& card = coverage.cards[i];
    cards.push_back({{"card", json_text(layout.cards[i].key)},
                     {"cards", card.cards},
                     {"lines", card.lines},
                     {"unread_lines", card.unread_lines}});
  }
  *json = {{"layout", json_text(layout.name)}, {"card_lines", coverage.card_lines},
           {"headings", coverage.headings},    {"comments", coverage.comments},
           {"blank_lines", coverage.blanks},   {"lines_under_no_card", coverage.no_card},
           {"cards", std::move(cards)}};
}

int check(const CoverageOptions& options) {
  keep_input(options.layout);
  keep_input(options.deck);
  const Layout layout = layout_of(options);
  ReadOptions read;
  read.strict = options.strict;
  Diagnostics problems;
  const Deck deck = read_what_can_be(read_file(options.deck), options.deck, layout, read, problems);
  std::ostringstream report;
  const Coverage coverage = find_coverage(layout, deck);
  answer_coverage(layout, coverage);
  print_coverage(layout, deck, coverage, report);
  fmt::print("{}", report.str());
  print_diagnostics(problems.errors() > 0 ? problems : deck.diagnostics);
  return problems.errors() > 0 ? kInput : kOk;
}

}  // namespace

Command layout_command(CLI::App& parser, const Catalogue&) {
  parser.require_subcommand(1);
  CLI::App* guessing = parser.add_subcommand(
      "guess", "draft a layout for an unknown deck, with the reason for every guess; finish the draft by hand");
  auto draft_options = std::make_shared<DraftOptions>();
  guessing->add_option("DECK", draft_options->deck, "deck file")->required();
  guessing->add_option("-o,--out", draft_options->out, "layout file to write (otherwise it is printed)");
  CLI::App* checking = parser.add_subcommand("check",
                                             "show what a layout reads of a deck: each kind of card under a "
                                             "column ruler, unread columns, unread lines");
  auto check_options = std::make_shared<CoverageOptions>();
  checking->add_option("LAYOUT", check_options->layout, "layout file, or the name of a built-in layout")
      ->required();
  checking->add_option("DECK", check_options->deck, "deck file")->required();
  checking->add_flag("--strict", check_options->strict, "warnings are errors");
  guessing->footer(
      "Example:\n  sagefe layout guess old.dat -o old.toml\n  sagefe layout check old.toml old.dat\n"
      "  sagefe echo old.dat --layout old.toml\nThe draft gives the reason for each guess: "
      "docs/manual/layout_guess.md\n");
  checking->footer(
      "Exit codes as for sagefe check: 0 sagefe can read the deck, 2 it can't. With --strict, warnings also "
      "give "
      "2.\n");
  return [=] { return guessing->parsed() ? guess(*draft_options) : check(*check_options); };
}

}  // namespace sage::app
