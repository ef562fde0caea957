// The built-in layout: what a deck says, card by card.
#include "sage/deck/deck.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "sage/deck/read_deck.hpp"

namespace sage {
namespace {

const Layout& sage1() {
  static const Layout layout = load_layout("sage1");
  return layout;
}

// Two stages, a material with ten parameters, lists, comments and defaults.
const char* const kDeck =
    "A small deck\n"
    "m       kN      kPa        101.325      9.81\n"
    "* a comment between cards\n"
    "    1    0    2    0    1    1    1    1    0    2    0\n"
    "    1               0.5      -1.5\n"
    "    2    1    1    1.D1    .5E+02        2.\n"
    "    7    3   10     19.25Sand, loose\n"
    "       1.0       2.0       3.0       4.0       5.0       6.0       7.0       8.0\n"
    "* parameters go on in the next card\n"
    "       9.0      10.0\n"
    "    1    2    0    7all of it\n"
    "   10    1    1    2    2    1\n"
    "    1    2    1    1    1\n"
    "First\n"
    "    4                   0    1    0    0    0    0       0.0      -1.0\n"
    "    2                          -7.5\n"
    "Second\n"
    "    1    0    0    0    1    0    0   17    1    1\n"
    "    1    0    0    1    0      0.25       0.0\n"
    "    1    2    3    4    5    6    7    8    9   10   11   12   13   14   15   16\n"
    "   17\n"
    "    3\n"
    "    1    1       5.0      18.0       0.5\n"
    "END\n";

Deck read(const std::string& text) {
  return read_deck_text(text, "deck.dat", sage1());
}

TEST(Deck, ReadsFieldsByName) {
  const Deck deck = read(kDeck);
  EXPECT_EQ(deck.one("title").text("title"), "A small deck");
  const CardView units = deck.one("units");
  EXPECT_EQ(units.text("length"), "m");
  EXPECT_EQ(units.text("stress"), "kPa");
  EXPECT_EQ(units.real("atmospheric_pressure"), 101.325);
  const std::vector<CardView> nodes = deck.all("node");
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].integer("number"), 1);
  EXPECT_EQ(nodes[0].real("x"), 0.5);
  EXPECT_EQ(nodes[0].real("y"), -1.5);
  EXPECT_EQ(nodes[1].real("x"), 10.0);
  EXPECT_EQ(nodes[1].real("y"), 50.0);
  EXPECT_EQ(nodes[1].integer("system"), 1);
  EXPECT_EQ(nodes[1].real("ratio"), 2.0);
  EXPECT_EQ(deck.one("material").text("name"), "Sand, loose");
  EXPECT_EQ(deck.one("end").card().line, 24);
  EXPECT_EQ(deck.diagnostics.warnings(), 0);
}

TEST(Deck, ListsGoOnInTheNextCards) {
  const Deck deck = read(kDeck);
  const CardView material = deck.one("material");
  const std::vector<CardView> parameters = deck.all("parameters", material);
  ASSERT_EQ(parameters.size(), 1u);
  const ValueList values = parameters[0].list("values");
  ASSERT_EQ(values.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(values[i].number, static_cast<double>(i + 1));
  EXPECT_EQ(values[8].line, 10);  // behind a comment
  EXPECT_EQ(values[9].first_column, 11);
}

TEST(Deck, CardsBelongToTheirStage) {
  const Deck deck = read(kDeck);
  const std::vector<CardView> stages = deck.all("stage");
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(deck.all("stage_title").size(), 2u);
  ASSERT_EQ(deck.all("load", stages[0]).size(), 1u);
  EXPECT_EQ(deck.all("load", stages[0])[0].real("y_force"), -7.5);
  EXPECT_TRUE(deck.all("load", stages[1]).empty());
  EXPECT_EQ(deck.all("fixity").size(), 2u);  // one of the deck, one of a stage
  EXPECT_EQ(deck.all("fixity")[0].card().owner, -1);
  ASSERT_EQ(deck.all("fixity", stages[1]).size(), 1u);
  EXPECT_EQ(deck.all("fixity", stages[1])[0].real("x_value"), 0.25);
  ASSERT_EQ(deck.all("birth", stages[1]).size(), 1u);
  const auto groups = deck.all("birth", stages[1])[0].list("groups");
  ASSERT_EQ(groups.size(), 17u);
  EXPECT_EQ(groups[16].number, 17.0);
  EXPECT_EQ(groups[16].line, 21);
  EXPECT_EQ(deck.all("death", stages[1])[0].list("groups").size(), 1u);
  EXPECT_EQ(deck.all("initial", stages[1])[0].real("v3"), 0.5);
  EXPECT_EQ(stages[0].real("gravity_y"), -1.0);
}

TEST(Deck, BlankFieldsGiveDefaults) {
  const Deck deck = read(kDeck);
  const CardView element = deck.one("element");
  EXPECT_TRUE(element.blank("column_step"));
  EXPECT_EQ(element.integer("column_step"), 1);  // the layout's default
  EXPECT_EQ(element.integer("columns", 5), 5);   // the caller's
  EXPECT_EQ(element.integer("no_such_field", 3), 3);
  EXPECT_TRUE(element.blank("no_such_field"));
  EXPECT_EQ(deck.all("stage")[0].integer("method"), 0);
  EXPECT_FALSE(deck.all("stage")[1].blank("method"));
}

TEST(Deck, KnowsWhereFieldsStand) {
  const Deck deck = read(kDeck);
  const CardView node = deck.all("node")[1];
  EXPECT_EQ(to_string(node.where("y")), "deck.dat:6:26-35");
  EXPECT_EQ(to_string(node.where()), "deck.dat:6");
  EXPECT_EQ(node.label("x"), "x or radius, length");
  EXPECT_EQ(deck.line_text(1), "A small deck");
  EXPECT_EQ(deck.line_text(99), "");
  const Diagnostic d = card_diagnostic(deck, Severity::error, "S208", node.where("y"), "too large");
  EXPECT_EQ(to_string(d),
            "deck.dat:6:26-35: error: too large [S208]\n"
            "      | ....+....1....+....2....+....3....+....4...\n"
            "    6 |     2    1    1    1.D1    .5E+02        2.\n"
            "      |                          ^^^^^^^^^^");
}

TEST(Deck, SurvivesCopyingAndTheSource) {
  Deck copy;
  {
    const Deck deck = read(std::string(kDeck));
    copy = deck;
  }
  EXPECT_EQ(copy.one("material").text("name"), "Sand, loose");
}

TEST(Deck, MissingCardIsAnError) {
  EXPECT_THROW(read(kDeck).one("fill"), InputError);
}

// What must not change the values: line ends, sequence numbers, trimmed or padded cards, a byte order mark.
TEST(Deck, LineEndsAndCardEndsDoNotMatter) {
  const Deck plain = read(kDeck);
  const auto same = [&](const std::string& text, const char* what) {
    const Deck other = read(text);
    ASSERT_EQ(other.cards.size(), plain.cards.size()) << what;
    for (std::size_t c = 0; c < plain.cards.size(); ++c) {
      const std::vector<FieldValue> ours = plain.values(plain.cards[c]), theirs = other.values(other.cards[c]);
      ASSERT_EQ(theirs.size(), ours.size()) << what;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_EQ(theirs[i].number, ours[i].number) << what << " card " << c << " value " << i;
        EXPECT_EQ(theirs[i].blank, ours[i].blank) << what << " card " << c << " value " << i;
      }
    }
  };
  std::string dos, padded, numbered;
  int line = 0;
  for (const char* c = kDeck; *c; ++c) {
    if (*c != '\n') {
      dos += *c;
      padded += *c;
      numbered += *c;
      continue;
    }
    ++line;
    dos += "\r\n";
    const std::size_t start = padded.rfind('\n') + 1;  // npos + 1 = 0
    padded.resize(start + 80, ' ');
    padded += '\n';
    const std::size_t length = numbered.size() - (numbered.rfind('\n') + 1);
    // Titles, and cards whose fields reach beyond column 72, can't carry sequence numbers.
    static constexpr std::array without = {1, 8, 10, 14, 15, 17, 18, 20, 21, 22};
    if (std::find(without.begin(), without.end(), line) == without.end())
      numbered += std::string(72 - length, ' ') + "SAGE" + std::to_string(1000 + line);
    numbered += '\n';
  }
  same(dos, "CRLF");
  same(padded, "80 columns");
  same(numbered, "sequence numbers");
  same(std::string(kDeck, std::string(kDeck).size() - 1), "no last line end");
  same(std::string("\xef\xbb\xbf") + kDeck, "byte order mark");
}

TEST(Echo, ShowsEveryCardWithItsFields) {
  const std::string text = echo(read(kDeck));
  EXPECT_NE(text.find("node  (3I5,3F10.0)\n      | ....+....1"), std::string::npos);
  EXPECT_NE(text.find("    6 |     2    1    1    1.D1    .5E+02        2.\n"
                      "        number = 2  step = 1  system = 1  x = 10  y = 50  ratio = 2\n"),
            std::string::npos);
  EXPECT_NE(text.find("values(10) = 10"), std::string::npos);
  EXPECT_NE(text.find("name = \"Sand, loose\""), std::string::npos);
}

}  // namespace
}  // namespace sage
