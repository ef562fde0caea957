// Every field of every small deck that is shipped, damaged in turn: the reader answers with errors, warnings or
// a deck, never with a crash, and some damages must be errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sage/deck/read_deck.hpp"

namespace sage {
namespace {

enum class Answer { error, warning, silent };

Answer answer(const std::string& text, const Layout& layout) {
  try {
    const Deck deck = read_deck_text(text, "mutated", layout);
    EXPECT_FALSE(echo(deck).empty());
    return deck.diagnostics.list().empty() ? Answer::silent : Answer::warning;
  } catch (const InputError& error) {
    EXPECT_GT(error.diagnostics().errors(), 0);
    EXPECT_FALSE(to_string(error.diagnostics().list().front()).empty());
    return Answer::error;
  }
}

// A field's characters replaced by others of the same length (right-justified, cut on the left).
std::string replaced(const std::string& text, std::size_t at, std::size_t size, std::string by) {
  if (by.size() > size) by.erase(0, by.size() - size);
  by.insert(0, size - by.size(), ' ');
  return text.substr(0, at) + by + text.substr(at + size);
}

std::string shifted(const std::string& text, std::size_t line_start) {
  return text.substr(0, line_start) + " " + text.substr(line_start);
}

struct Counts {
  int fields = 0, errors = 0, warnings = 0, silent = 0;
  void add(Answer a) {
    errors += a == Answer::error;
    warnings += a == Answer::warning;
    silent += a == Answer::silent;
  }
};

void mutate_field(const Deck& deck, const Layout& layout, const FieldSpec& spec, const FieldValue& value,
                  Counts& counts) {
  const std::string& text = *deck.source;
  if (value.text.empty() || value.text.data() < text.data() || value.text.data() >= text.data() + text.size())
    return;
  const auto at = static_cast<std::size_t>(value.text.data() - text.data());
  const std::size_t size = value.text.size();
  const std::size_t line = deck.line_starts[static_cast<std::size_t>(value.line) - 1];
  ++counts.fields;
  SCOPED_TRACE("line " + std::to_string(value.line) + ", " + spec.name);

  const Answer letters = answer(replaced(text, at, size, "abc"), layout);
  if (spec.kind != FieldKind::text) {
    EXPECT_EQ(letters, Answer::error) << "letters";
  }
  counts.add(letters);
  const Answer blank = answer(replaced(text, at, size, ""), layout);
  if (spec.required && !deck.specs[0].format.empty()) {
    EXPECT_EQ(blank, Answer::error) << "blank";
  }
  counts.add(blank);
  counts.add(answer(replaced(text, at, size, "99999999"), layout));
  counts.add(answer(replaced(text, at, size, "-1"), layout));
  counts.add(answer(replaced(text, at, size, "1e999"), layout));
  counts.add(answer(text.substr(0, at), layout));
  counts.add(answer(shifted(text, line), layout));
  counts.add(
      answer(text.substr(0, line) + text.substr(std::min(text.size(), text.find('\n', line) + 1)), layout));
}

Counts mutate(const std::string& text, const Layout& layout) {
  const Deck deck = read_deck_text(text, "deck", layout);
  Counts counts;
  for (const Card& card : deck.cards)
    for (std::int32_t i = 0; i < card.value_count; ++i) {
      const auto& fields = deck.specs[static_cast<std::size_t>(card.spec)].fields;
      const std::size_t field = std::min(static_cast<std::size_t>(i), fields.size() - 1);
      mutate_field(deck, layout, fields[field], deck.values[static_cast<std::size_t>(card.first_value + i)],
                   counts);
    }
  return counts;
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const std::filesystem::path kInputs = SAGE_SOURCE_DIR "/legacy_inputs";

TEST(Mutation, TheManualsExample) {
  const Layout layout = load_layout("sage1");
  const Counts counts = mutate(layout.example, layout);
  EXPECT_GT(counts.fields, 80);
  EXPECT_GT(counts.errors, 3 * counts.fields);  // letters, two numbers too large, a deck cut off
}

TEST(Mutation, DecksOfTheChapter) {
  const Layout layout = load_layout("sage1");
  int decks = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kInputs / "chapter7")) {
    if (!std::filesystem::exists(entry.path() / "deck.dat") || ++decks > 8) continue;
    SCOPED_TRACE(entry.path().filename().string());
    EXPECT_GT(mutate(file_text(entry.path() / "deck.dat"), layout).fields, 50);
  }
  EXPECT_GT(decks, 0);
}

TEST(Mutation, ForeignDecks) {
  const Counts mock = mutate(file_text(kInputs / "cande_level3" / "candejar_cidmock_standard_lines.cid"),
                             load_layout("cande_level3"));
  EXPECT_GT(mock.fields, 50);
  for (const char* name : {"p51_1", "p51_5", "p52", "p61", "p63", "p66", "p68", "p69", "p611_1"}) {
    SCOPED_TRACE(name);
    const std::string program = std::string(name).substr(0, std::string(name).find('_'));
    EXPECT_GT(mutate(file_text(kInputs / "smith_griffiths" / (std::string(name) + ".dat")),
                     load_layout("sg_" + program))
                  .fields,
              20);
  }
}

// Bytes of all kinds at every place of a deck.
TEST(Mutation, SingleBytes) {
  const Layout layout = load_layout("sage1");
  const std::string text = layout.example;
  for (std::size_t i = 0; i < text.size(); ++i)
    for (const char c : {'\0', '\n', '\r', '\t', '*', ',', '-', '9', '\x1a', '\xff'}) {
      std::string mutated = text;
      mutated[i] = c;
      answer(mutated, layout);
    }
}

}  // namespace
}  // namespace sage
