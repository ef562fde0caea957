// sagefe layout check: which columns of which lines a layout reads.
#include "sage/guess/coverage.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "sage/core/error.hpp"
#include "sage/deck/layout_names.hpp"
#include "sage/deck/read_deck.hpp"

namespace sage {
namespace {

constexpr const char* kLayout = R"toml(name = "small"
draft = true
comment = "*"
sequence_columns = [73, 80]
[[card]]
name = "title"
format = "(A20)"
fields = [{ name = "title" }]
[[card]]
name = "node"
headings = 1
repeat = 2
format = "(I5,F10.0,5X,F10.0)"
fields = [{ name = "number" }, { name = "x" }, { name = "y" }]
[[card]]
name = "load"
when = "node.number > 5"
format = "(I5)"
fields = [{ name = "first", ignored = true }]
)toml";

//                              columns:  ....+....1....+....2....+....3
constexpr const char* kDeck =
    "a title\n"
    "* a comment\n"
    " node  x   y\n"
    "    1       1.0   77\n"
    "    2       2.0    7\n"
    "\n"
    "    1    2\n";

struct Read {
  Layout layout = load_checked_layout(kLayout, "small.toml");
  Diagnostics problems;
  Deck deck;
  Coverage coverage;
  explicit Read(const std::string& text)
      : deck(read_what_can_be(text, "small.dat", layout, {}, problems)),
        coverage(find_coverage(layout, deck)) {}
  std::string report() const {
    std::ostringstream out;
    print_coverage(layout, deck, coverage, out);
    return out.str();
  }
};

// Counted by hand.
TEST(Coverage, CountsLinesAndUnreadColumns) {
  const Read read(kDeck);
  const Coverage& c = read.coverage;
  EXPECT_EQ(c.card_lines, 3u);
  EXPECT_EQ(c.headings, 1u);
  EXPECT_EQ(c.comments, 1u);
  EXPECT_EQ(c.blanks, 1u);
  EXPECT_EQ(c.no_card, (std::vector<int>{7}));
  const CardCoverage& node = c.cards[1];
  EXPECT_EQ(node.cards, 2u);
  EXPECT_EQ(node.first_line, 4);
  EXPECT_EQ(node.last_line, 5);
  EXPECT_EQ(node.unread_lines, 2u);
  ASSERT_EQ(node.unread.size(), 21u);
  EXPECT_EQ(node.unread[19], 1u);  // the first 7 of 77
  EXPECT_EQ(node.unread[20], 2u);
  EXPECT_EQ(node.sample, 4);  // has two unread characters
  EXPECT_EQ(node.fields[1].first_column, 6);
  EXPECT_EQ(node.fields[1].last_column, 15);
  EXPECT_EQ(node.fields[1].filled, 2u);
  EXPECT_EQ(node.fields[2].filled, 0u);
  EXPECT_EQ(c.cards[2].cards, 0u);
}

TEST(Coverage, TheReportShowsThemUnderARuler) {
  const std::string report = Read(kDeck).report();
  for (const char* part :
       {"small.dat, layout small (a draft): 7 lines; 3 read by cards, 1 headings, 1 comments, 1 blank or end "
        "marks, 1 under "
        "no card",
        "      | ....+....1....+....2\n    4 |     1       1.0   77\n      | ----1---------2\n",
        "      |                   ^^ UNREAD: columns 19-20 of 2 lines",
        "    3 y                     on no line        ALWAYS BLANK",
        "Cards of the layout that the deck doesn't have: load", "LINES UNDER NO CARD: 1\n    7 |     1    2\n"})
    EXPECT_NE(report.find(part), std::string::npos) << part << "\nin\n" << report;
}

// Sequence numbers are no unread columns.
TEST(Coverage, SequenceNumbersAreNotUnread) {
  std::string text = kDeck;
  const std::size_t at = text.find("   77\n");
  text.replace(at, 5, std::string(57, ' ') + "SEQ00001");
  EXPECT_EQ(Read(text).coverage.cards[1].unread_lines, 1u);
}

// Where reading stops, what was read is shown, and the rest is under no card.
TEST(Coverage, OfADeckWithMistakes) {
  const Read read("a title\n node  x   y\n    1       1.0\n");
  EXPECT_GT(read.problems.errors(), 0);
  EXPECT_EQ(read.coverage.cards[0].cards, 1u);
  EXPECT_EQ(read.coverage.cards[1].cards, 1u);
}

// Every line of a shipped deck under its own layout is taken, and no column with a character left.
TEST(Coverage, ShippedDeckUnderItsLayout) {
  const std::string path = SAGE_SOURCE_DIR "/legacy_inputs/stages/shaft_lifts/deck.dat";
  const Layout layout = load_layout("sage1");
  const Coverage coverage = find_coverage(layout, read_deck(path, layout));
  EXPECT_TRUE(coverage.no_card.empty());
  for (const CardCoverage& card : coverage.cards) EXPECT_EQ(card.unread_lines, 0u);
  const std::vector<std::vector<NameUse>> uses = name_uses(layout);
  for (const auto& card : uses)
    for (const NameUse use : card) EXPECT_NE(use, NameUse::nothing);
}

}  // namespace
}  // namespace sage
