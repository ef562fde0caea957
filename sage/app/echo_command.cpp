// sagefe echo: every card as it was read, under a column ruler.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/deck/layout.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"
#include "sage/deck/text.hpp"

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
    say_note(name,
             fmt::format("the layout makes no model yet: {} missing or used by nothing; sagefe echo "
                         "--names lists them",
                         missing == 1 ? "one name is" : std::to_string(missing) + " names are"),
             "S147");
}

std::string names_of(const EchoOptions& options) {
  const std::string name = options.input.layout.empty() ? detect_layout(read_file(options.deck), options.deck)
                                                        : options.input.layout;
  const Layout layout = load_layout(name, false);
  return "names of layout " + layout.name + (layout.title.empty() ? "" : ", " + layout.title) + '\n' +
         names_listing(layout);
}

// A number as a number, a text as it stands; null where blank.
Json value_json(const FieldValue& value) {
  if (value.blank) return nullptr;
  if (value.kind == FieldKind::text) return json_text(trimmed(value.text));
  if (value.kind == FieldKind::logical) return value.number != 0.0;
  if (value.kind == FieldKind::integer) return static_cast<std::int64_t>(value.number);
  return value.number;
}

Json card_json(const Deck& deck, const Card& card) {
  const CardSpec& spec = deck.specs[card.spec];
  const std::vector<FieldValue> values = deck.values(card);
  Json fields = Json::array();
  for (std::size_t i = 0; i < values.size() && !spec.fields.empty(); ++i)
    fields.push_back({{"name", json_text(spec.fields[std::min(i, spec.fields.size() - 1)].name)},
                      {"value", value_json(values[i])},
                      {"line", values[i].line},
                      {"first_column", values[i].first_column},
                      {"last_column", values[i].last_column}});
  return {{"card", json_text(spec.name)},
          {"label", json_text(spec.label)},
          {"line", card.line},
          {"fields", std::move(fields)}};
}

void answer_cards(const Deck& deck) {
  Json* const json = answer();
  if (json == nullptr) return;
  (*json)["deck"] = json_text(deck.file);
  (*json)["layout"] = json_text(deck.layout);
  Json& cards = (*json)["cards"] = Json::array();
  for (const Card& card : deck.cards) cards.push_back(card_json(deck, card));
}

// Up to and including the card of the first mistake, and where no card was read from its line, the line.
void print_up_to_mistake(Deck& deck, const Diagnostics& problems) {
  int line = 0;
  for (const Diagnostic& one : problems.list())
    if (one.severity == Severity::error && one.where.line > 0 && (line == 0 || one.where.line < line))
      line = one.where.line;
  const auto behind = std::ranges::find_if(deck.cards, [&](const Card& card) { return card.line > line; });
  const bool read = behind != deck.cards.begin() && std::prev(behind)->line == line;
  deck.cut_back(static_cast<std::size_t>(behind - deck.cards.begin()));
  answer_cards(deck);
  fmt::print("{}", echo(deck));
  if (line > 0 && !read)
    fmt::print("\nnot read as a card\n      | {}\n{:5} | {}\n",
               "....+....1....+....2....+....3....+....4....+....5....+....6....+....7....+....8", line,
               well_formed(deck.line_text(line)).text);
}

// The deck, or, of one with mistakes, the cards before them; the error goes on.
int echo_broken(const EchoOptions& options, const InputError& error) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(options.deck, ignored)) {
    const std::string text = read_file(options.deck);
    const std::string name =
        options.input.layout.empty() ? detect_layout(text, options.deck) : options.input.layout;
    ReadOptions read;
    read.strict = options.input.strict;
    read.shown = 1'000'000;
    Diagnostics problems;
    Deck deck = read_what_can_be(text, options.deck, load_layout(name, false), read, problems);
    if (problems.errors() > 0) print_up_to_mistake(deck, problems);
  }
  print_diagnostics(error.diagnostics());
  return kInput;
}

int echo_deck(const EchoOptions& options) {
  try {
    const Deck deck = read_input(options.deck, options.input, false);
    answer_cards(deck);
    fmt::print("{}", echo(deck));
    print_diagnostics(deck.diagnostics);
  } catch (const InputError& error) {
    return echo_broken(options, error);
  }
  note_half_layout(options.input.layout);
  return kOk;
}

}  // namespace

Command echo_command(CLI::App& parser, const Catalogue&) {
  auto options = std::make_shared<EchoOptions>();
  parser.add_option("DECK", options->deck, "deck file")->required();
  add_input_options(parser, options->input);
  parser.add_flag(
      "--names", options->names,
      "list instead the names in the deck's layout: those that sagefe uses, those that only the layout uses, "
      "those that are ignored or not used, and those that could be added");
  return [options] {
    if (options->names) {
      const std::string names = names_of(*options);
      if (Json* json = answer()) (*json)["names"] = json_text(names);
      fmt::print("{}", names);
      return kOk;
    }
    return echo_deck(*options);
  };
}

}  // namespace sage::app
