// A deck with one slip (a line lost, a line doubled, a blank too many) is accepted under no layout that it was not
// written for, as one without (exchange/wrong_layout_test.cpp).
#include <gtest/gtest.h>

#include <fstream>

#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/shipped_decks.hpp"

namespace sage {
namespace {

// As `sagefe check --partial`, which refuses less than `sagefe check`.
bool is_accepted(const std::string& text, const Layout& layout, const Catalogue& catalogue) {
  BuildOptions partial;
  partial.partial = true;
  try {
    build_model(read_deck_text(text, "deck", layout), catalogue, partial);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Places of a text where a line begins: all of a short one, of others the first few and some spread over the rest.
std::vector<std::size_t> some_lines(const std::string& text) {
  std::vector<std::size_t> all{0};
  for (std::size_t at = text.find('\n'); at != std::string::npos && at + 1 < text.size();
       at = text.find('\n', at + 1))
    all.push_back(at + 1);
  constexpr std::size_t kAll = 40, kFirst = 4, kOthers = 5;
  if (all.size() <= kAll) return all;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < std::min(kFirst, all.size()); ++i) some.push_back(all[i]);
  for (std::size_t i = 1; i <= kOthers && all.size() > kFirst; ++i)
    some.push_back(all[kFirst + (all.size() - kFirst) * i / (kOthers + 1)]);
  return some;
}

std::vector<std::string> variants(const std::string& text) {
  std::vector<std::string> all;
  if (text.size() > 100'000) return all;  // minutes, and their first cards decide
  for (const std::size_t begin : some_lines(text)) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string before = text.substr(0, begin), line = text.substr(begin, end - begin),
                      after = text.substr(end);
    all.push_back(before + after);
    all.push_back(before + line + line + after);
    const std::size_t middle = line.find_first_not_of(' ', line.size() / 2);
    if (middle != std::string::npos)
      all.push_back(before + line.substr(0, middle) + " " + line.substr(middle) + after);
  }
  return all;
}

class SlippedDeck : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(SlippedDeck, IsAcceptedUnderNoOtherLayout) {
  const std::string own = test::layout_of(GetParam());
  const Catalogue catalogue = app::full_catalogue();
  const std::vector<std::string> texts = variants(test::bytes_of(GetParam()));
  for (const std::string& name : built_in_layouts()) {
    if (name == own) continue;
    const Layout layout = load_layout(name);
    for (std::size_t i = 0; i < texts.size(); ++i)
      EXPECT_FALSE(is_accepted(texts[i], layout, catalogue)) << "as " << name << ", variant " << i;
  }
}

// What `check` says of the first error, and behind it of layouts that do read the deck; empty where it reads.
std::string said_of(const std::string& text, const std::string& layout) {
  const std::filesystem::path path = test::scratch_folder("slipped") / "deck.dat";
  std::ofstream(path) << text;
  try {
    layout.empty() ? read_deck(path.string()) : read_deck(path.string(), load_layout(layout));
  } catch (const InputError& error) {
    std::string all;
    for (const Diagnostic& one : error.diagnostics().list()) all += to_string(one) + '\n';
    return all;
  }
  return {};
}

std::string textbook(const std::string& name) {
  return test::bytes_of(SAGE_SOURCE_DIR "/legacy_inputs/smith_griffiths/" + name + ".dat");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_said(const std::string& said, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(said.find(part), std::string::npos) << part << "\nin\n" << said;
}

// Numbers that a READ leaves on its line, or that stand behind the last one, are wrong; words there are remarks.
TEST(SlippedDeckMessages, NumbersLeftOverAreErrors) {
  const std::string deck = textbook("p68");
  EXPECT_EQ(said_of(deck, "sg_p68"), "");
  expect_said(said_of(replaced(deck, "8   4   1   ", "8   4   1  7"), "sg_p68"),
              {"deck.dat:1:12: error: not read", "a slash (/) ends a READ"});
  EXPECT_EQ(said_of(replaced(deck, "8   4   1   ", "8   4   1 / 7"), "sg_p68"), "");
  EXPECT_EQ(said_of(replaced(deck, "8   4   1   ", "8   4   1  nxe nye 7"), "sg_p68"), "");
  expect_said(said_of(deck + "1.0 2.0\n", "sg_p68"), {"error: the deck is complete, but numbers follow"});
  EXPECT_EQ(said_of(deck + "end of the deck\n", "sg_p68"), "");
}

// Read one record on, the tolerance of program 6.6 would be what is the limit of iterations here.
TEST(SlippedDeckMessages, AToleranceIsNoCount) {
  expect_said(said_of(replaced(textbook("p68"), "0.001  25\n10\n", "0.001  25\n10\n10\n"), "sg_p66"),
              {"deck.dat:8:8-9: error: the tolerance of convergence can't be 25: allowed are what lies between "
               "0 and 1"});
}

// A deck that has mistakes under one program's layout and none under another's is not taken for that in silence.
TEST(SlippedDeckMessages, OtherLayoutsThatReadItAreNamed) {
  expect_said(said_of(textbook("p66"), "sg_p61"),
              {"the deck has mistakes as sg_p61, but without a mistake it reads as sg_p66: --layout sg_p66"});
}

// As 6.1: no restrained and no loaded node, tolerance 1, limit 1, one increment; as 6.6: no loaded node, tolerances
// 0 and 1, limit 1, one increment.
TEST(SlippedDeckMessages, WhereSeveralFitNoneIsTaken) {
  expect_said(
      said_of("1 1 1\n100. 1.e5 .3\n0. 1.\n0. -1.\n0\n0\n1\n1\n1\n1\n", ""),
      {"error: the deck has the marks of no layout",
       "reads as each of sg_p61, sg_p66, which are different programs: name the one that it was written for"});
}

INSTANTIATE_TEST_SUITE_P(Shipped, SlippedDeck, testing::ValuesIn(test::shipped_decks()),
                         [](const auto& one) { return test::name_of(one.param); });

}  // namespace
}  // namespace sage
