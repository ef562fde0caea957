// sagefe layout check: which columns of which lines a layout reads.
#include "sage/layout_draft/coverage.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "sage/deck/layout_names.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/messages/error.hpp"

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
  ASSERT_EQ(node.records.size(), 1u);
  const RecordCoverage& record = node.records[0];
  ASSERT_EQ(record.unread.size(), 21u);
  EXPECT_EQ(record.unread[19], 1u);  // the first 7 of 77
  EXPECT_EQ(record.unread[20], 2u);
  EXPECT_EQ(record.sample, 4);  // has two unread characters
  ASSERT_EQ(record.fields.size(), 2u);
  EXPECT_EQ(record.fields[1].first, 6);
  EXPECT_EQ(record.fields[1].last, 15);
  EXPECT_EQ(node.filled, (std::vector<std::size_t>{2, 2, 0}));
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

std::string report_of(const std::string& toml, const std::string& text) {
  const Layout layout = load_checked_layout(toml, "my.toml");
  const Deck deck = read_deck_text(text, "my.dat", layout);
  std::ostringstream out;
  print_coverage(layout, deck, find_coverage(layout, deck), out);
  return out.str();
}

void expect_report(const std::string& report, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(report.find(part), std::string::npos) << part << "\nin\n" << report;
}

// A card of two records and a list: every record has its line and its ruler, and a field that stands on the second
// is not on no line.
TEST(Coverage, ACardOfSeveralRecordsShowsEach) {
  const std::string report =
      report_of(R"toml(name = "two"
draft = true
[[card]]
name = "element"
repeat = 2
format = "(I5,F10.0/3I5/(4F5.0))"
fields = [{ name = "number" }, { name = "t" }, { name = "a" }, { name = "b" }, { name = "c" },
          { name = "v", count = "6" }]
)toml",
                "    1       2.5\n    7    8    9\n  1.0  2.0  3.0  4.0\n  5.0  6.0\n"
                "    2       3.5\n    7    8    9   x\n  1.0  2.0  3.0  4.0\n  5.0  6.0\n");
  expect_report(report, {"element  (I5,F10.0/3I5/(4F5.0)): 2 cards, lines 1 to 8\n"
                         "      record 1\n"
                         "      | ....+....1....+....2\n"
                         "    1 |     1       2.5\n"
                         "      | ----1---------2\n"
                         "      record 2\n"
                         "      | ....+....1....+....2\n"
                         "    6 |     7    8    9   x\n"
                         "      | ----3----4----5\n"
                         "      |                   ^ UNREAD: columns 19 of 1 line\n"
                         "      records 3 to 4\n"
                         "      | ....+....1....+....2\n"
                         "    3 |   1.0  2.0  3.0  4.0\n"
                         "      | ----6----6----6----6\n",
                         "4 b                     record 2, columns 6-10        2 filled",
                         "6 v                     record 3, columns 1-20        12 filled"});
  EXPECT_EQ(report.find("on no line"), std::string::npos) << report;
}

// A computed field takes the place of what it is computed from in messages, but no columns; made cards are shown.
TEST(Coverage, ComputedFieldsHaveNoColumnsAndMadeCardsAreListed) {
  const std::string report = report_of(R"toml(name = "made"
draft = true
[[card]]
name = "row"
repeat = 2
format = "(2I5)"
fields = [{ name = "a" }, { name = "b" }, { name = "twice", value = "2 * a" }]
[[card]]
name = "node"
made_from = "row"
fields = [{ name = "number", kind = "integer", value = "row.a" }]
[[card]]
name = "units"
made = true
fields = [{ name = "length", value = "'m'" }]
[[card]]
name = "load"
made_from = "row"
when = "row.a > 5"
fields = [{ name = "first", kind = "integer", value = "row.a" }]
)toml",
                                       "    1    2\n    3    4\n");
  expect_report(report, {"      | ----1----2\n", "3 twice                 computed          2 filled",
                         "\nnode  made from row: 2 cards, by lines 1 to 2\n"
                         "    1 number                computed          2 filled        used by the program\n",
                         "\nunits  made: 1 card\n", "\nCards that the layout makes of none here: load\n"});
}

// List-directed values stand anywhere: the rulers are those of the first card.
TEST(Coverage, AListDirectedCardShowsItsFirst) {
  const std::string report = report_of(R"toml(name = "listed"
draft = true
[[card]]
name = "row"
repeat = 2
format = "*"
fields = [{ name = "n", kind = "integer" }, { name = "x", kind = "real", count = "n" }]
)toml",
                                       "3\n 1.0 2.0\n 3.0\n1 7.0\n");
  expect_report(report,
                {"      record 1\n      | ....+....1....+....2\n    1 | 3\n      | 1\n",
                 "      records 2 to 3\n      | ....+....1....+....2\n    2 |  1.0 2.0\n      |  --2 --2\n",
                 "2 x                     list-directed     4 filled"});
}

}  // namespace
}  // namespace sage
