// Every kind of field of every shipped deck, damaged in turn and read and built again.  Each answer falls in
// one class:
//   error     refused
//   reported      accepted with a warning or a note that the sound deck does not get
//   same      the same problem: mesh, materials, groups, supports, stages and reports are equal bit for bit
//   control   the same problem, solved with other iteration control or written out more or less often
//   another   another valid deck, which nobody can tell from one that was meant (a load of 9 instead of 10)
// A blank field, letters, and a deck that is cut off must never be in the last class.  SAGE_MUTATION_LIST=1
// lists it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "problem_bytes.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/sanitized.hpp"

namespace sage {
namespace {

using test::ProblemBytes;
using test::values_as_read;

namespace fs = std::filesystem;

enum class Answer { error, reported, same, control, another };
constexpr const char* kAnswers[] = {"error", "reported", "same", "control", "another"};

enum class Damage { blank, letters, huge, infinite, negative, line_cut, deck_cut, shift_right, shift_left };
constexpr Damage kDamages[] = {Damage::blank,    Damage::letters,     Damage::huge,
                               Damage::infinite, Damage::negative,    Damage::line_cut,
                               Damage::deck_cut, Damage::shift_right, Damage::shift_left};
constexpr const char* kDamageNames[] = {"blank",    "letters",  "huge",        "infinite",  "negative",
                                        "line cut", "deck cut", "shift right", "shift left"};

std::set<std::string> messages_of(const Diagnostics& diagnostics) {
  std::set<std::string> messages;
  for (const Diagnostic& d : diagnostics.list()) messages.insert(d.message);
  return messages;
}

struct Sound {
  std::string name, text;
  Layout layout;
  Deck deck;
  std::string problem, control;
  std::set<std::string> messages;
  bool buildable = true;  // some shipped decks are read and refused: their answers are those of the reader
};

const Catalogue& catalogue() {
  static const Catalogue all = app::full_catalogue();
  return all;
}

// CANDE's decks ask for more than there is.
BuildOptions options() {
  BuildOptions options;
  options.partial = true;
  return options;
}

std::string file_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Sound sound(const fs::path& path, const std::string& layout) {
  Sound s{path.parent_path().filename().string() + "/" + path.filename().string(),
          file_text(path),
          load_layout(layout),
          {},
          {},
          {},
          {}};
  s.deck = read_deck_text(s.text, "deck", s.layout);
  s.messages = messages_of(s.deck.diagnostics);
  try {
    const Model model = build_model(s.deck, catalogue(), options());
    s.problem = ProblemBytes(model).bytes();
    s.control = ProblemBytes(model).control();
    s.messages = messages_of(model.diagnostics);
  } catch (const InputError&) {
    s.buildable = false;
    s.problem = values_as_read(s.deck);
  }
  return s;
}

Answer answer(const Sound& s, const std::string& text) {
  if (text == s.text) return Answer::same;
  try {
    const Deck deck = read_deck_text(text, "deck", s.layout);
    std::set<std::string> messages = messages_of(deck.diagnostics);
    std::string problem, control;
    if (s.buildable) {
      const Model model = build_model(deck, catalogue(), options());
      messages = messages_of(model.diagnostics);
      const ProblemBytes bytes(model);
      problem = bytes.bytes();
      control = bytes.control();
    } else {
      problem = values_as_read(deck);
    }
    if (problem == s.problem && control == s.control) return Answer::same;
    if (!std::includes(s.messages.begin(), s.messages.end(), messages.begin(), messages.end()))
      return Answer::reported;
    return problem == s.problem ? Answer::control : Answer::another;
  } catch (const InputError& error) {
    EXPECT_GT(error.diagnostics().errors(), 0);
    EXPECT_FALSE(error.diagnostics().list().front().message.empty());
    return Answer::error;
  }
}

// A field's characters replaced by others of the same length (right-justified, cut on the left).
std::string replaced(const std::string& text, std::size_t at, std::size_t size, std::string by) {
  if (by.size() > size) by.erase(0, by.size() - size);
  by.insert(0, size - by.size(), ' ');
  return text.substr(0, at) + by + text.substr(at + size);
}

// A place to damage: one value of a card.
struct Site {
  const FieldSpec* spec = nullptr;
  FieldValue value;
  std::string key;  // "node.x"
};

std::string damaged(const Sound& s, const Site& site, Damage damage) {
  const std::string& text = *s.deck.source.text();
  const FieldValue& value = site.value;
  const auto at = static_cast<std::size_t>(value.text.data() - text.data());
  const std::size_t size = value.text.size();
  std::size_t line = s.deck.source.starts()[static_cast<std::size_t>(value.line) - 1];
  if (!s.layout.card_separator.empty()) {  // the record begins behind the card's name
    const std::size_t name = text.find(s.layout.card_separator, line);
    if (name < at) line = name + s.layout.card_separator.size();
  }
  const std::size_t line_end = std::min(text.size(), text.find('\n', line));
  const bool listed = s.deck.specs.empty() || s.deck.specs[0].format.empty();
  const auto with = [&](const char* by) {
    return listed ? text.substr(0, at) + by + text.substr(at + size) : replaced(text, at, size, by);
  };
  switch (damage) {
    case Damage::blank:
      return replaced(text, at, size, "");
    case Damage::letters:
      return with("abc");
    case Damage::huge:
      return with("99999999");
    case Damage::infinite:
      return with("1e999");
    case Damage::negative: {
      std::string number(value.text);
      number.erase(0, std::min(number.find_first_not_of(' '), number.size()));
      number.erase(number.find_last_not_of(' ') + 1);
      if (number.empty()) number = "1";
      if (number[0] == '-') return replaced(text, at, size, number.substr(1));
      return listed ? text.substr(0, at) + "-" + text.substr(at) : replaced(text, at, size, "-" + number);
    }
    case Damage::line_cut:
      return text.substr(0, at) + text.substr(line_end);
    case Damage::deck_cut:
      return text.substr(0, at);
    case Damage::shift_right:
      return text.substr(0, line) + " " + text.substr(line);
    case Damage::shift_left:
      return line < line_end ? text.substr(0, line) + text.substr(line + 1) : text;
  }
  return text;
}

std::vector<Site> sites(const Sound& s) {
  std::vector<Site> all;
  const std::string& text = *s.deck.source.text();
  for (const Card& card : s.deck.cards) {
    const CardSpec& spec = s.deck.specs[card.spec];
    const std::vector<FieldValue> values = s.deck.values(card);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t field = std::min(i, spec.fields.size() - 1);
      const FieldValue& value = values[i];
      const char* begin = value.text.data();
      if (value.text.empty() || begin < text.data() || begin >= text.data() + text.size()) continue;
      all.push_back({&spec.fields[field], value, spec.name + "." + spec.fields[field].name});
    }
  }
  return all;
}

struct Tally {
  int fields = 0;
  std::map<Damage, std::map<Answer, int>> counts;
  std::map<std::string, int> others;  // "huge node.x": how often
  std::map<std::string, std::string> example;

  int count(Damage damage, Answer a) const {
    const auto it = counts.find(damage);
    return it != counts.end() && it->second.count(a) ? it->second.at(a) : 0;
  }
  void print() const {
    std::printf("%d fields\n%-12s", fields, "damage");
    for (const char* name : kAnswers) std::printf("%9s", name);
    std::printf("\n");
    for (const auto& [damage, by_answer] : counts) {
      std::printf("%-12s", kDamageNames[static_cast<int>(damage)]);
      for (int a = 0; a < 5; ++a) {
        const auto it = by_answer.find(static_cast<Answer>(a));
        std::printf("%9d", it == by_answer.end() ? 0 : it->second);
      }
      std::printf("\n");
    }
    if (!std::getenv("SAGE_MUTATION_LIST")) return;
    for (const auto& [key, n] : others) std::printf("%5d  %s  [%s]\n", n, key.c_str(), example.at(key).c_str());
  }
};

// At most `most` sites of every kind of field; each with every damage, or with `damages` of them by lot.
void mutate(const Sound& s, std::size_t most, std::size_t damages, unsigned seed, Tally& tally) {
  std::map<std::string, std::vector<Site>> by_key;
  std::map<std::string, FieldKind> kinds;
  for (Site& site : sites(s)) by_key[site.key].push_back(site);
  std::mt19937 random(seed);
  for (auto& [key, list] : by_key) {
    std::shuffle(list.begin(), list.end(), random);
    // Fields with something in them first: a blank one is not spoilt by a blank.
    std::stable_partition(list.begin(), list.end(), [](const Site& site) { return !site.value.blank; });
    if (list.size() > most) list.resize(most);
    for (const Site& site : list) {
      ++tally.fields;
      std::vector<Damage> chosen(std::begin(kDamages), std::end(kDamages));
      std::shuffle(chosen.begin(), chosen.end(), random);
      chosen.resize(std::min(test::few_of(damages, 1), chosen.size()));
      for (const Damage damage : chosen) {
        const Answer got = answer(s, damaged(s, site, damage));
        ++tally.counts[damage][got];
        if (damage == Damage::letters && site.spec->kind != FieldKind::text) {
          EXPECT_EQ(got, Answer::error) << s.name << ":" << site.value.line << " " << key;
        }
        if (got != Answer::another) continue;
        const std::string kind = std::string(kDamageNames[static_cast<int>(damage)]) + " " + key;
        ++tally.others[kind];
        tally.example[kind] =
            s.name + ":" + std::to_string(site.value.line) + " " + std::string(site.value.text);
      }
    }
  }
}

constexpr std::size_t kAll = 9;
const fs::path kInputs = SAGE_SOURCE_DIR "/legacy_inputs";

TEST(Mutation, AllSage1Decks) {
  Tally tally;
  unsigned seed = 1;
  std::vector<fs::path> decks;
  for (const auto& entry : fs::recursive_directory_iterator(kInputs))
    if (entry.path().filename() == "deck.dat") decks.push_back(entry.path());
  std::sort(decks.begin(), decks.end());
  ASSERT_GT(decks.size(), 20u);
  for (const fs::path& path : decks) {
    const Sound deck = sound(path, "sage1");
    ASSERT_TRUE(deck.buildable) << path;
    // Decks that are much alike share the damages: each kind of field gets all of them in several decks.
    const std::string name = path.string();
    const bool alike = name.find("chapter7") != std::string::npos || name.find("at_once") != std::string::npos;
    mutate(deck, 1, alike ? 4 : kAll, seed++, tally);
  }
  tally.print();
  for (const Damage damage :
       {Damage::letters, Damage::infinite, Damage::deck_cut, Damage::shift_left, Damage::shift_right})
    EXPECT_EQ(tally.count(damage, Answer::another), 0) << kDamageNames[static_cast<int>(damage)];
  // Numbers of which any value is a deck that somebody may want.
  // A block without grading is one, too; most blocks have none, and a note on each would be noise.
  const std::set<std::string> allowed{
      "blank fill.column_ratio", "blank fill.row_ratio", "line cut fill.column_ratio",
      "line cut fill.row_ratio",

      "huge parameters.values", "negative parameters.values", "huge fixity.x_value", "negative fixity.x_value",
      "huge fixity.y_value", "negative fixity.y_value", "huge initial.v4", "negative initial.v4",
      "negative load.x_force", "negative load.y_force", "negative pressure.shear1", "negative pressure.shear2",
      "huge stage.gravity_x", "negative stage.gravity_x", "negative node.x", "negative node.y",
      "negative initial.v1", "negative initial.v2", "huge report.area",
      // A rotation that is left free, on a card that then holds what another holds already.
      "blank fixity.unknown", "line cut fixity.unknown", "line cut fixity.x_value", "line cut fixity.y_value",
      // A stage whose gravity is cut off still has the water that its water card names: what it does to soil without weight.
      "line cut stage.deaths", "line cut stage.fixities", "line cut stage.loads",
      "line cut stage.max_iterations", "line cut stage.output_every", "line cut stage.pressures",
      // No law of a deck with flow alone needs it.
      "blank units.atmospheric_pressure", "line cut units.atmospheric_pressure"};
  for (const auto& [kind, count] : tally.others)
    EXPECT_TRUE(allowed.count(kind)) << kind << " " << tally.example[kind];
}

TEST(Mutation, ListDirectedDecks) {
  Tally tally;
  for (const char* name : {"p51_1", "p51_2", "p51_5", "p52", "p61", "p63", "p66", "p68", "p69", "p611_1"}) {
    const std::string program = std::string(name).substr(0, std::string(name).find('_'));
    mutate(sound(kInputs / "smith_griffiths" / (std::string(name) + ".dat"), "sg_" + program), 2, kAll, 1,
           tally);
  }
  tally.print();
  for (const Damage damage :
       {Damage::blank, Damage::letters, Damage::infinite, Damage::deck_cut, Damage::line_cut})
    EXPECT_EQ(tally.count(damage, Answer::another), 0) << kDamageNames[static_cast<int>(damage)];
}

// Thousands of cards: every kind of field, with some of the damages by lot.
TEST(Mutation, LargeDecks) {
  Tally tally;
  mutate(sound(kInputs / "cande_level3" / "candejar_cidmock_standard_lines.cid", "cande_level3"), 1, kAll, 1,
         tally);
  for (const char* name : {"candejar_input_test", "candejar_input_test1"})
    mutate(sound(kInputs / "cande_level3" / (std::string(name) + ".cid"), "cande_level3"), 1, 1, 2, tally);
  mutate(sound(kInputs / "quad4m" / "MDL.Q4I", "quad4m"), 1, 2, 1, tally);
  tally.print();
  EXPECT_GT(tally.fields, 200);
  for (const Damage damage : {Damage::letters, Damage::deck_cut})
    EXPECT_EQ(tally.count(damage, Answer::another), 0) << kDamageNames[static_cast<int>(damage)];
}

// Bytes of all kinds at every place of a deck.
TEST(Mutation, SingleBytes) {
  const Layout layout = load_layout("sage1");
  const std::string text = layout.example;
  for (std::size_t i = 0; i < text.size(); i += test::kSanitized ? 7 : 1)
    for (const char c : {'\0', '\n', '\r', '\t', '*', ',', '-', '9', '\x1a', '\xff'}) {
      std::string mutated = text;
      mutated[i] = c;
      try {
        EXPECT_FALSE(echo(read_deck_text(mutated, "mutated", layout)).empty());
      } catch (const InputError& error) {
        EXPECT_GT(error.diagnostics().errors(), 0);
      }
    }
}

}  // namespace
}  // namespace sage
