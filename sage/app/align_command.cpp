// sagefe align: values that stand beside their columns are moved into them, and each move is named.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <filesystem>
#include <map>
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
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

namespace fs = std::filesystem;

struct AlignOptions {
  std::string deck, layout;
  fs::path output;
  bool in_place = false;
};

// By line; a line may have been read as a card more than once.
using AlignedLines = std::map<int, AlignedLine>;

AlignedLines aligned_lines(const std::string& text, const std::string& name, const Layout& layout) {
  std::vector<AlignedLine> lines;
  ReadOptions read;
  read.aligned = &lines;
  Diagnostics problems;
  read_what_can_be(text, name, layout, read, problems);
  AlignedLines by_number;
  for (AlignedLine& line : lines) by_number.insert_or_assign(line.line, std::move(line));
  return by_number;
}

// The file with these lines in the place of its own; ends of lines stay.
std::string with_lines(const std::string& text, const std::string& name, const AlignedLines& lines) {
  const SourceText source(text, name);
  std::string out;
  std::size_t done = 0;
  for (const auto& [number, line] : lines) {
    if (line.moves.empty()) continue;
    const std::size_t start = source.starts()[static_cast<std::size_t>(number) - 1];
    out.append(text, done, start - done);
    out += line.text;
    done = start + source.line(number).size();
  }
  return out.append(text, done);
}

fs::path output_of(const AlignOptions& options) {
  const fs::path deck = options.deck;
  if (options.in_place) return deck;
  if (options.output.empty()) return deck.stem().string() + "_aligned" + deck.extension().string();
  std::error_code error;
  if (fs::equivalent(options.output, deck, error))
    throw UsageError("S904", "--output is the deck itself: --in-place replaces it");
  return options.output;
}

void print_moves(const std::string& deck, const AlignedLines& lines) {
  for (const auto& [number, line] : lines)
    if (!line.moves.empty()) fmt::print("{}:{}: {}: {}\n", deck, number, line.card, line.moves);
}

void answer_moves(const AlignedLines& lines) {
  Json* const json = answer();
  if (json == nullptr) return;
  Json& moves = (*json)["moves"] = Json::array();
  for (const auto& [number, line] : lines)
    if (!line.moves.empty())
      moves.push_back({{"line", number}, {"card", json_text(line.card)}, {"moves", json_text(line.moves)}});
}

int align_deck(const AlignOptions& options) {
  const std::string text = read_file(options.deck);
  check_is_text(text, options.deck);
  const Layout layout =
      load_layout(options.layout.empty() ? detect_layout(text, options.deck) : options.layout);
  const AlignedLines lines = aligned_lines(text, options.deck, layout);
  int moved = 0;
  bool doubtful = false;
  for (const auto& [number, line] : lines) {
    doubtful = doubtful || line.moves.empty();
    if (!line.moves.empty())
      ++moved;
    else
      say_note(fmt::format("{}:{}", options.deck, number),
               fmt::format(
                   "the {} is not in its columns, and its values fit into more than one set of fields or none; "
                   "it was left as it is. Write 0 for each blank field, or move the values by hand",
                   line.card),
               "S590");
  }
  print_moves(options.deck, lines);
  answer_moves(lines);
  const std::string aligned = with_lines(text, options.deck, lines);
  if (moved == 0) {
    fmt::print("{}: no value was moved; no file was written\n", options.deck);
  } else {
    OutFile out(output_of(options));
    out.text() = aligned;
    out.finish();
    answer_file(out.path());
    fmt::print("{}: {} moved; written to {}\n", options.deck,
               moved == 1 ? "1 card" : fmt::format("{} cards", moved), out.path().string());
  }
  Diagnostics left;
  const Deck deck = read_what_can_be(aligned, options.deck, layout, {}, left);
  print_diagnostics(left.errors() > 0 ? left : deck.diagnostics);
  return left.errors() > 0 || doubtful ? kInput : kOk;
}

}  // namespace

Command align_command(CLI::App& parser, const Catalogue&) {
  auto options = std::make_shared<AlignOptions>();
  parser.add_option("DECK", options->deck, "deck file")->required();
  parser.add_option("--layout", options->layout,
                    "card layout: a built-in name or a .toml file (default: found from the deck)");
  CLI::Option* output =
      parser.add_option("-o,--output", options->output, "file to write (default: DECK's name with _aligned)");
  parser.add_flag("--in-place", options->in_place, "write over the deck itself")->excludes(output);
  parser.footer("Exit code 2: mistakes or doubtful cards are left in the deck; they are shown.");
  return [options] { return align_deck(*options); };
}

}  // namespace sage::app
