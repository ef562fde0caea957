// Every card of every shipped deck, shifted whole by one column, and with one blank inserted or deleted in each
// gap.  What comes out is an error, a warning that the sound deck does not get, or the same deck; never another
// deck in silence (a note is silence: --strict passes it).
// A sample of the cards is damaged in every test run; SAGE_SHIFT_ALL=1 takes them all (minutes) and
// SAGE_SHIFT_LIST=1 lists what is in no class.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "problem_bytes.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/register_solvers.hpp"
#include "tests/support/sanitized.hpp"

namespace sage {
namespace {

namespace fs = std::filesystem;
using test::ProblemBytes;
using test::values_as_read;

enum class Answer { error, warning, same, another };
constexpr const char* kAnswers[] = {"error", "warning", "same", "another"};

enum class Slip { card_right, card_left, insert, remove };
constexpr const char* kSlips[] = {"card right", "card left", "blank inserted", "blank deleted"};

// CANDE's decks ask for more than there is.
const BuildOptions kPartial = [] {
  BuildOptions options;
  options.partial = true;
  return options;
}();

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue catalogue;
    register_elements(catalogue);
    register_materials(catalogue);
    register_solvers(catalogue);
    return catalogue;
  }();
  return all;
}

std::string file_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Every warning counts, wherever it stands in the list.
ReadOptions all_shown() {
  ReadOptions options;
  options.shown = 1'000'000;
  return options;
}

std::set<std::string> warnings_of(const Diagnostics& diagnostics) {
  std::set<std::string> all;
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::warning) all.insert(std::to_string(d.where.line) + ": " + d.message);
  return all;
}

bool is_told(const std::set<std::string>& sound, const Diagnostics& diagnostics) {
  const std::set<std::string> now = warnings_of(diagnostics);
  return !std::includes(sound.begin(), sound.end(), now.begin(), now.end());
}

// The problem, how it is solved, and the names of its units.
std::string problem_of(const Model& model) {
  const ProblemBytes bytes(model);
  return bytes.bytes() + "\n" + bytes.control() + "\n" + model.units.length + "|" + model.units.force + "|" +
         model.units.stress;
}

struct Sound {
  std::string name, text;
  Layout layout;
  Deck deck;
  std::string values, problem;
  std::set<std::string> warnings;
  bool buildable = true;  // some shipped decks are read and refused: their answers are those of the reader
};

// Folders bear the names of their layouts; "p51_2" is a deck of program 5.1.
std::string layout_of(const fs::path& path, const std::string& text) {
  const std::string folder = path.parent_path().filename().string(), stem = path.stem().string();
  if (folder == "smith_griffiths") return "sg_" + stem.substr(0, stem.find('_'));
  return folder == "plast" || folder == "stap" ? folder : detect_layout(text);
}

Sound sound(const fs::path& path) {
  Sound s;
  s.name = path.lexically_relative(SAGE_SOURCE_DIR "/legacy_inputs").string();
  s.text = file_text(path);
  s.layout = load_layout(layout_of(path, s.text));
  s.deck = read_deck_text(s.text, "deck", s.layout, all_shown());
  s.values = values_as_read(s.deck);
  s.warnings = warnings_of(s.deck.diagnostics);
  try {
    const Model model = build_model(s.deck, catalogue(), kPartial);
    s.problem = problem_of(model);
    s.warnings.merge(warnings_of(model.diagnostics));
  } catch (const InputError&) {
    s.buildable = false;
  }
  return s;
}

Answer answer(const Sound& s, const std::string& text) {
  try {
    const Deck deck = read_deck_text(text, "deck", s.layout, all_shown());
    if (is_told(s.warnings, deck.diagnostics)) return Answer::warning;
    const bool same_numbers = values_as_read(deck) == s.values;
    if (!s.buildable) return same_numbers ? Answer::same : Answer::another;
    if (same_numbers && s.layout.name != "sage1") return Answer::same;  // units have no names there
    const Model model = build_model(deck, catalogue(), kPartial);
    if (is_told(s.warnings, model.diagnostics)) return Answer::warning;
    return problem_of(model) == s.problem ? Answer::same : Answer::another;
  } catch (const InputError& error) {
    EXPECT_GT(error.diagnostics().errors(), 0);
    return Answer::error;
  }
}

// A line that belongs to a card, and where its record begins.
struct CardLine {
  int number = 0;
  std::size_t begin = 0, record = 0, end = 0;  // offsets in the text
  const CardSpec* spec = nullptr;
};

std::vector<CardLine> card_lines(const Sound& s) {
  std::map<int, const CardSpec*> spec_of;
  for (const Card& card : s.deck.cards) {
    const CardSpec* spec = &s.deck.specs[card.spec];
    spec_of.try_emplace(card.line, spec);
    for (const FieldValue& value : s.deck.values(card)) spec_of.try_emplace(value.line, spec);
  }
  std::vector<CardLine> lines;
  for (const auto& [number, spec] : spec_of) {
    const std::string_view line = s.deck.line_text(number);
    CardLine one{number, s.deck.source.starts()[static_cast<std::size_t>(number) - 1], 0, 0, spec};
    one.end = one.begin + line.size();
    const std::size_t name =
        s.layout.card_separator.empty() ? std::string_view::npos : line.find(s.layout.card_separator);
    one.record = one.begin + (name == std::string_view::npos ? 0 : name + s.layout.card_separator.size());
    lines.push_back(one);
  }
  return lines;
}

struct Mutant {
  Slip slip = Slip::insert;
  std::string text;
};

// The whole line, the record behind a card's name, and every gap of it.
std::vector<Mutant> slips(const std::string& text, const CardLine& line) {
  std::vector<Mutant> all;
  const auto insert = [&](Slip slip, std::size_t at) {
    all.push_back({slip, text.substr(0, at) + " " + text.substr(at)});
  };
  const auto remove = [&](Slip slip, std::size_t at) {
    all.push_back({slip, text.substr(0, at) + text.substr(at + 1)});
  };
  std::set<std::size_t> starts{line.begin, line.record};
  for (const std::size_t start : starts) {
    insert(Slip::card_right, start);
    if (start < line.end && text[start] == ' ') remove(Slip::card_left, start);
  }
  for (std::size_t i = line.record + 1; i < line.end; ++i) {
    const bool word_begins = text[i] != ' ' && text[i - 1] == ' ';
    if (!word_begins || text.find_first_not_of(' ', line.record) == i) continue;  // the card as a whole
    insert(Slip::insert, i);
    remove(Slip::remove, i - 1);
  }
  return all;
}

struct Tally {
  int cards = 0;
  std::map<Slip, std::map<Answer, int>> counts;
  std::map<std::string, int> others;
  std::map<std::string, std::string> example;

  void print() const {
    std::printf("%d cards\n%-15s", cards, "slip");
    for (const char* name : kAnswers) std::printf("%9s", name);
    std::printf("\n");
    for (const auto& [slip, by_answer] : counts) {
      std::printf("%-15s", kSlips[static_cast<int>(slip)]);
      for (int a = 0; a < 4; ++a) {
        const auto it = by_answer.find(static_cast<Answer>(a));
        std::printf("%9d", it == by_answer.end() ? 0 : it->second);
      }
      std::printf("\n");
    }
    if (!std::getenv("SAGE_SHIFT_LIST")) return;
    for (const auto& [key, n] : others) std::printf("%5d  %s  [%s]\n", n, key.c_str(), example.at(key).c_str());
  }
};

// Cards `first`, `first + step`, ... of a deck.
void slip_cards(const Sound& s, std::size_t first, std::size_t step, Tally& tally) {
  const std::vector<CardLine> lines = card_lines(s);
  for (std::size_t i = first; i < lines.size(); i += step) {
    ++tally.cards;
    for (const Mutant& mutant : slips(s.text, lines[i])) {
      const Answer got = answer(s, mutant.text);
      ++tally.counts[mutant.slip][got];
      if (got != Answer::another) continue;
      const std::string key =
          s.layout.name + " " + lines[i].spec->label + ": " + kSlips[static_cast<int>(mutant.slip)];
      ++tally.others[key];
      const std::size_t end = mutant.text.find('\n', lines[i].begin);
      tally.example[key] = s.name + ":" + std::to_string(lines[i].number) + " \"" +
                           mutant.text.substr(lines[i].begin, end - lines[i].begin) + "\"";
    }
  }
}

std::vector<fs::path> shipped_decks() {
  std::vector<fs::path> decks;
  for (const auto& entry : fs::recursive_directory_iterator(SAGE_SOURCE_DIR "/legacy_inputs")) {
    const std::string end = entry.path().extension().string();
    if (end == ".dat" || end == ".cid" || end == ".Q4I") decks.push_back(entry.path());
  }
  std::sort(decks.begin(), decks.end());
  return decks;
}

// The shipped decks themselves are packed in all the ways that programs and people pack them.
TEST(Shift, SoundDecksAreNotWarnedOf) {
  for (const fs::path& path : shipped_decks()) {
    for (const std::string& message : sound(path).warnings) {
      for (const char* slip : {" is cut", "stands alone", "a number stands behind"})
        EXPECT_EQ(message.find(slip), std::string::npos) << path << ":" << message;
    }
  }
}

TEST(Shift, EveryCardOfEveryDeck) {
  const char* whole = std::getenv("SAGE_SHIFT_ALL");
  const char* only = std::getenv("SAGE_SHIFT_DECK");
  const std::vector<fs::path> decks = shipped_decks();
  ASSERT_GT(decks.size(), 40u);
  Tally tally;
  std::size_t seed = 0;
  for (const fs::path& path : decks) {
    if (only && path.string().find(only) == std::string::npos) continue;
    const Sound s = sound(path);
    // Large decks hold thousands of cards of few kinds.
    const std::size_t cards = card_lines(s).size();
    const std::size_t step = (whole ? 1 : cards > 1000 ? 211 : 5) * (test::kSanitized ? 5 : 1);
    slip_cards(s, whole ? 0 : ++seed % step, step, tally);
  }
  tally.print();
  for (const auto& [kind, count] : tally.others)
    ADD_FAILURE() << count << " times another deck in silence: " << kind << " " << tally.example.at(kind);
}

}  // namespace
}  // namespace sage
