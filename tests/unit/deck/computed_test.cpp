// Fields that stand on no card, and cards that stand in no record.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "sage/deck/layout_names.hpp"
#include "sage/deck/read_deck.hpp"

namespace sage {
namespace {

Deck read(const std::string& toml, const std::string& text) {
  return read_deck_text(text, "my.dat", load_layout_text("name = 'my'\n" + toml, "my.toml"));
}

// "deck line:columns message", one a line.
std::string complaints(const std::string& toml, const std::string& text) {
  std::string all;
  try {
    read(toml, text);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics().list())
      if (d.severity == Severity::error)
        all += std::to_string(d.where.line) + ":" + std::to_string(d.where.first_column) + "-" +
               std::to_string(d.where.last_column) + " " + d.message + "\n";
  }
  return all;
}

std::string refusal(const std::string& toml) {
  try {
    load_layout_text("name = 'my'\n" + toml, "my.toml");
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().list().front();
    return std::to_string(d.where.line) + ": " + d.message;
  }
  return {};
}

const std::string kMaterials = R"toml(
[[card]]
name = "row"
format = "(I5,2F10.0,A8)"
repeat = 2
opens = true
fields = [
  { name = "number" }, { name = "yield" }, { name = "modulus" }, { name = "mark" },
  { name = "cohesion", value = "yield / sqrt(3)" },
]
)toml";
const std::string kTwoRows = "    1      300.     2.0E4 clay\n    2      600.     4.0E4 rock\n";

TEST(Computed, AFieldTakesNoColumns) {
  const Deck deck = read(kMaterials, kTwoRows);
  ASSERT_EQ(deck.cards.size(), 2u);
  const CardView second(deck, 1);
  EXPECT_EQ(second.real("cohesion"), 600.0 / std::sqrt(3.0));
  EXPECT_EQ(second.text("mark"), "rock");
  // An error about it shows what it was computed from.
  EXPECT_EQ(second.where("cohesion").line, 2);
  EXPECT_EQ(second.where("cohesion").first_column, 6);
  EXPECT_EQ(second.where("cohesion").last_column, 15);
}

TEST(Computed, ACountOfTheLayoutIsNamedAsOne) {
  try {
    read(kMaterials, "    1      300.     2.0E4 clay\n");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(error.diagnostics().list().front().message.find("1 missing; given by the layout)"),
              std::string::npos)
        << error.what();
  }
}

// A count without a field is checked like one of the deck.
TEST(Computed, ACountOfTheLayoutMustBeWhole) {
  std::string layout = kMaterials;
  layout.replace(layout.find("repeat = 2"), 10, "repeat = '5 / 2'");
  try {
    read(layout, kTwoRows);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(error.diagnostics().list().front().message.find("can't be 2.5"), std::string::npos)
        << error.what();
  }
}

TEST(Computed, StandsAnywhereAmongTheFields) {
  const Deck deck = read(R"toml(
[[card]]
name = "node"
format = "(2F10.0)"
repeat = 3
fields = [
  { name = "number", kind = "integer", value = "order" },
  { name = "y", value = "-depth" },
  { name = "x" }, { name = "depth" },
  { name = "before", value = "previous(x)" },
  { name = "along", value = "sum(x)" },
]
)toml",
                         "       1.0      10.0\n       2.0      20.0\n       4.0      30.0\n");
  const double along[] = {1.0, 3.0, 7.0}, before[] = {0.0, 1.0, 2.0};
  for (int i = 0; i < 3; ++i) {
    const CardView card(deck, i);
    EXPECT_EQ(card.integer("number"), i + 1);
    EXPECT_EQ(card.real("y"), -10.0 * (i + 1));
    EXPECT_EQ(card.real("before"), before[i]);
    EXPECT_EQ(card.real("along"), along[i]);
  }
}

// A copy of what is left blank is blank, not zero; a default of the copied field or a computation makes a number of it.
TEST(Computed, ACopyOfABlankIsBlank) {
  const std::string layout = R"toml(
[[card]]
name = "soil"
format = "(3F10.0)"
fields = [{ name = "weight" }, { name = "rest" }, { name = "share", default = 0.25 }, { name = "own", value = "rest" }]
[[card]]
name = "made"
made_from = "soil"
fields = [
  { name = "k0", value = "rest" }, { name = "again", value = "soil.own" }, { name = "part", value = "share" },
  { name = "half", value = "rest / 2" }, { name = "weight", value = "soil.weight" },
]
)toml";
  const Deck deck = read(layout, "       20.\n");
  const CardView soil(deck, 0), made(deck, 1);
  for (const char* field : {"k0", "again"}) EXPECT_TRUE(made.blank(field)) << field;
  EXPECT_TRUE(soil.blank("own"));
  EXPECT_FALSE(made.blank("part"));
  EXPECT_EQ(made.real("part"), 0.25);
  EXPECT_FALSE(made.blank("half"));
  EXPECT_EQ(made.real("half"), 0.0);
  EXPECT_EQ(made.real("weight"), 20.0);
  const Deck given = read(layout, "       20.        0.\n");
  EXPECT_FALSE(CardView(given, 1).blank("k0"));
}

TEST(Computed, AListHasAValueAPlace) {
  const Deck deck = read(R"toml(
[[card]]
name = "increments"
format = "*"
fields = [{ name = "steps", kind = "integer" }, { name = "factors", kind = "real", count = "steps" }]

[[card]]
name = "totals"
made = true
fields = [
  { name = "steps", value = "increments.steps" },
  { name = "totals", value = "sum(increments.factors, index)", count = "increments.steps" },
]

[[card]]
name = "ends"
made = true
fields = [{ name = "ends", value = ["item(increments.factors, 1)", "sum(increments.factors)", 7.5] }]
)toml",
                         "4 0.5 0.25 0.125 0.125\n");
  ASSERT_EQ(deck.cards.size(), 3u);
  const double totals[] = {0.5, 0.75, 0.875, 1.0};
  const auto list = CardView(deck, 1).list("totals");
  ASSERT_EQ(list.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(list[i].number, totals[i]);
  const auto ends = CardView(deck, 2).list("ends");
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_EQ(ends[0].number, 0.5);
  EXPECT_EQ(ends[1].number, 1.0);
  EXPECT_EQ(ends[2].number, 7.5);
}

TEST(Computed, MadeCardsStandBehindTheirCard) {
  const Deck deck = read(kMaterials + R"toml(
[[card]]
name = "material"
made_from = "row"
opens = true
fields = [
  { name = "number", kind = "integer", value = "100 + number" },
  { name = "law", kind = "integer", value = "if(mark == 'clay', 5, 6)" },
  { name = "name", value = "mark" },
  { name = "unit", value = "'kN'" },
  { name = "tens", value = "10 * number" },
  { name = "own", value = "number + material.tens" },
]

[[card]]
name = "soft"
as = "parameters"
made_from = "material"
when = "row.mark == 'clay'"
fields = [{ name = "values", value = ["row.modulus", 0.3, "row.cohesion"] }]

[[card]]
name = "hard"
as = "parameters"
made_from = "material"
when = "row.mark == 'rock'"
fields = [{ name = "values", value = ["row.modulus", 0.2] }]
)toml",
                         kTwoRows);
  ASSERT_EQ(deck.cards.size(), 6u);
  const std::vector<CardView> materials = deck.all("material");
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_EQ(materials[0].integer("law"), 5);
  EXPECT_EQ(materials[1].integer("law"), 6);
  EXPECT_EQ(materials[1].text("name"), "rock");
  EXPECT_EQ(materials[1].text("unit"), "kN");
  // A bare name is of the row in every field, whatever the card itself has computed under it.
  EXPECT_EQ(materials[1].integer("number"), 102);
  EXPECT_EQ(materials[1].real("tens"), 20.0);
  EXPECT_EQ(materials[1].real("own"), 22.0);
  EXPECT_EQ(materials[1].where().line, 2);
  const std::vector<CardView> parameters = deck.all("parameters", materials[1]);
  ASSERT_EQ(parameters.size(), 1u);
  const auto values = parameters[0].list("values");
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(values[0].number, 4.0e4);
  EXPECT_EQ(parameters[0].where(values[0]).first_column, 16);
  EXPECT_EQ(deck.all("parameters", materials[0])[0].list("values")[2].number, 300.0 / std::sqrt(3.0));
}

TEST(Computed, ConstantCardsNeedNoRecord) {
  const Deck deck = read(R"toml(
[[card]]
name = "units"
made = true
fields = [{ name = "length", value = "'m'" }, { name = "water", value = 9.81 }]

[[card]]
name = "n"
format = "(I5)"
fields = [{ name = "n" }]

[[card]]
block = "all"
repeat = "n.n"
  [[card.card]]
  name = "stage"
  made = true
  fields = [{ name = "number", kind = "integer", value = "order" }, { name = "of", value = "n.n" }]
  [[card.card]]
  name = "load"
  made = true
  repeat = "stage.number"
  fields = [{ name = "first", value = "order" }]
)toml",
                         "    3\n");
  EXPECT_EQ(deck.one("units").text("length"), "m");
  EXPECT_EQ(deck.one("units").real("water"), 9.81);
  const std::vector<CardView> stages = deck.all("stage");
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_EQ(stages[2].integer("number"), 3);
  EXPECT_EQ(stages[2].where().line, 1);
  EXPECT_EQ(stages[2].where("of").first_column, 1);
  const std::vector<CardView> loads = deck.all("load", stages[2]);
  ASSERT_EQ(loads.size(), 3u);
  EXPECT_EQ(loads[2].integer("first"), 6);
}

// The card that only ends a run is not computed and not counted.
TEST(Computed, TheCardThatEndsARunCountsNowhere) {
  const Deck deck = read(R"toml(
[[card]]
name = "row"
format = "(2F10.0)"
until_dropped = "a == 0"
fields = [{ name = "a" }, { name = "b" }, { name = "ratio", value = "b / a" }]

[[card]]
name = "behind"
made_from = "row"
fields = [{ name = "ratio", value = "ratio" }]

[[card]]
name = "total"
made = true
fields = [{ name = "rows", value = "count(row)" }, { name = "a", value = "sum(row.a)" }]
)toml",
                         "       2.0       8.0\n       4.0       8.0\n\n");
  EXPECT_EQ(deck.all("behind").size(), 2u);
  EXPECT_EQ(deck.one("total").real("rows"), 2.0);
  EXPECT_EQ(deck.one("total").real("a"), 6.0);
}

TEST(Computed, AValueThatCannotBeIsShownInDeckAndLayout) {
  const std::string toml = R"toml([[card]]
name = "row"
format = "(2F10.0)"
repeat = 2
fields = [{ name = "a" }, { name = "b" },
  { name = "ratio", value = "a / b" },
  { name = "root", value = "sqrt(b)" },
  { name = "whole", kind = "integer", value = "a" }]
)toml";
  EXPECT_EQ(
      complaints(toml, "       1.0       4.0\n       2.0       0.0\n"),
      "2:1-10 the ratio of the row card can't be computed: division by zero in \"a / b\" (my.toml, line 7)\n");
  EXPECT_EQ(complaints(toml, "       1.0       4.0\n       2.5      -4.0\n"),
            "2:11-20 the root of the row card can't be computed: the square root of a negative number, -4, in "
            "\"sqrt(b)\" (my.toml, line 8)\n"
            "2:1-10 the value 2.5 is no integer (row card, whole): a (my.toml, line 9)\n");
  // A field that can't be read is one error, not one more for each value computed from it.
  EXPECT_EQ(complaints(toml, "       1.0       4.0\n       x.0       1.0\n"),
            "2:1-10 \"x.0\" is not a number (row card, a)\n");
  EXPECT_EQ(
      complaints("[[card]]\nname = 'n'\nformat = '(I5)'\nfields = [{ name = 'n' }]\n[[card]]\nname = 'm'\n"
                 "made = true\nwhen = '1 / n.n > 0'\nfields = [{ name = 'k', value = 1 }]\n",
                 "    0\n"),
      "1:1-5 what follows can't be computed: division by zero in \"1 / n.n > 0\" (my.toml, line 9)\n");
}

TEST(Computed, CodesOfComputedFieldsAreChecked) {
  const std::string toml = R"toml([[card]]
name = "row"
format = "(I5)"
fields = [{ name = "code" }, { name = "turned", value = "code + 1", allowed = [1, 2], codes = "1 yes, 2 no" }]
)toml";
  EXPECT_EQ(complaints(toml, "    1\n"), "");
  EXPECT_EQ(complaints(toml, "    2\n"), "1:1-5 the turned can't be 3: 1 yes, 2 no\n");
}

TEST(Computed, MistakesOfALayoutNameTheirLine) {
  const std::string read = "[[card]]\nname = 'a'\nformat = '(I5)'\nfields = [{ name = 'n' }, ";
  const std::string made = "[[card]]\nname = 'a'\nmade = true\n";
  EXPECT_EQ(refusal(read + "{ name = 'k', value = 'm' }]\n"), "5: card \"a\" has no field \"m\"");
  EXPECT_EQ(refusal(read + "{ name = 'k', value = 'l' }, { name = 'l', value = 'n' }]\n"),
            "5: field \"l\" of card \"a\" is computed later than this");
  EXPECT_EQ(refusal(read + "{ name = 'k', value = 'n', default = 2 }]\n"),
            "5: a computed field (value) is never read: it has no default");
  EXPECT_EQ(refusal(read + "{ name = 'k', value = \"n + 'x'\" }]\n"),
            "5: a text stands where a number is needed in \"n + 'x'\"");
  EXPECT_EQ(refusal(made + "fields = [{ name = 'n' }]\n"), "5: a field of a made card needs its value");
  EXPECT_EQ(refusal(made + "format = '(I5)'\nfields = [{ name = 'n', value = 1 }]\n"),
            "5: a made card stands in no record: it has no format");
  EXPECT_EQ(refusal("[[card]]\nname = 'a'\nmade_from = 'b'\nfields = [{ name = 'n', value = 1 }]\n"),
            "4: no card \"b\" stands before this");
  EXPECT_EQ(refusal("[[card]]\nname = 'a'\nformat = '(I5)'\nfields = [{ name = 'k', value = 1 }]\n"),
            "2: no field of the card is read: give made = true instead of a FORMAT");
  for (const char* bad : {"nan", "inf", "-inf"})
    for (const std::string field : {"value = ", "kind = 'integer', value = "})
      EXPECT_EQ(refusal(made + "fields = [{ name = 'n', " + field + bad + " }]\n"),
                "5: " + std::string(bad) + " is no number that a layout can hold");
  EXPECT_EQ(refusal(made + "fields = [\n{ name = 'n', value = [\n1, nan] }]\n"),
            "7: nan is no number that a layout can hold");
  EXPECT_EQ(refusal("[[card]]\nname = 'a'\nformat = '(I5)'\nfields = [{ name = 'n', default = inf }]\n"),
            "5: inf is no number that a layout can hold");
}

// "(master card, ...)": a label that ends with the word is not given it twice.
TEST(Computed, ALabelMaySayThatItIsACard) {
  const auto layout = [](const std::string& label) {
    return "[[card]]\nname = 'a'\nlabel = '" + label +
           "'\nformat = '(I5/F5.0)'\nrepeat = 2\nfields = [{ name = 'n', required = true }, { name = 'x' }]\n";
  };
  EXPECT_EQ(complaints(layout("master card"), "    x\n  1.0\n    1\n  2.0\n"),
            "1:1-5 \"x\" is not an integer (master card, n)\n");
  EXPECT_EQ(complaints(layout("master"), "    x\n  1.0\n    1\n  2.0\n"),
            "1:1-5 \"x\" is not an integer (master card, n)\n");
  EXPECT_NE(complaints(layout("master card"), "    1\n  1.0\n").find("a master card was expected"),
            std::string::npos)
      << complaints(layout("master card"), "    1\n  1.0\n");
}

// What README.md says of the first card, and of counts: the card that the expression stands on is not counted.
TEST(Computed, ThePreviousOfTheFirstAndTheCountOfItself) {
  const Deck deck = read(R"toml(
[[card]]
name = "row"
format = "(I5,A3)"
repeat = 2
fields = [
  { name = "number" }, { name = "word" }, { name = "before", value = "previous(number)" },
  { name = "text", kind = "text", value = "previous(word)" }, { name = "so_far", value = "count(row)" },
]
[[card]]
name = "made"
made_from = "row"
fields = [{ name = "seen", value = "count(row)" }, { name = "own", value = "count(made)" }]
)toml",
                         "    7 aa\n    8 bb\n");
  ASSERT_EQ(deck.cards.size(), 4u);
  const CardView first(deck, 0), made(deck, 1), second(deck, 2), last(deck, 3);
  EXPECT_EQ(first.real("before"), 0.0);
  EXPECT_EQ(first.text("text"), "");
  EXPECT_EQ(second.real("before"), 7.0);
  EXPECT_EQ(second.text("text"), "aa");
  EXPECT_EQ(first.real("so_far"), 0.0);
  EXPECT_EQ(second.real("so_far"), 1.0);
  EXPECT_EQ(made.real("seen"), 1.0);
  EXPECT_EQ(last.real("seen"), 2.0);
  EXPECT_EQ(last.real("own"), 1.0);
}

// What stands last on a card is what its values are about: an error is shown there, not at the number that an
// earlier card adds to it.
TEST(Computed, MistakesStandOnTheCardsOwnRecord) {
  const std::string layout = R"toml(
[[card]]
name = "head"
format = "(2I5)"
fields = [{ name = "before" }, { name = "count" }]
[[card]]
name = "row"
format = "(2I5)"
repeat = "head.count"
fields = [{ name = "number" }, { name = "soil" }, { name = "group", kind = "integer", value = "head.before + soil", allowed = [11, 12] }]
)toml";
  const std::string found = complaints(layout, "   10    2\n    1    1\n    2    3\n");
  EXPECT_EQ(found.substr(0, 6), "3:6-10") << found;
}

// A count of the deck can't ask for more memory than a deck of its size may need.
TEST(Computed, MadeCardsAreBounded) {
  const std::string toml = R"toml([[card]]
name = "n"
format = "(I10)"
fields = [{ name = "n" }]
[[card]]
name = "m"
made = true
repeat = "n.n"
fields = [{ name = "k", value = "order" }]
)toml";
  EXPECT_NE(complaints(toml, " 900000000\n").find("the layout makes more than"), std::string::npos);
}

TEST(Computed, EchoShowsWhatIsMade) {
  const Deck deck = read(kMaterials + R"toml(
[[card]]
name = "material"
made_from = "row"
fields = [{ name = "number", value = "number" }]
)toml",
                         kTwoRows);
  const std::string text = echo(deck);
  EXPECT_NE(text.find("cohesion := 173.2050807568877"), std::string::npos) << text;
  EXPECT_NE(text.find("    + material, made:\n        number := 2\n"), std::string::npos) << text;
}

// A computed field among those of a record has no characters that could touch its neighbours'.
TEST(Computed, ShiftedCardsAreSeenBesideComputedFields) {
  const std::string toml = R"toml([[card]]
name = "row"
format = "(3I5)"
fields = [{ name = "a" }, { name = "x", value = "a" }, { name = "b" }, { name = "y", value = "'t'" }, { name = "c" },
          { name = "z", value = "b" }]
)toml";
  const Deck shifted = read(toml, "   12   34   56\n");
  const Deck cut = read(toml, "    1  1234567   56\n");
  const Deck moved = read(toml, "    1     7    3\n");
  EXPECT_EQ(shifted.diagnostics.warnings(), 0);
  ASSERT_EQ(cut.diagnostics.warnings(), 1);
  EXPECT_NE(cut.diagnostics.list().front().message.find("\"1234567\" is cut in two"), std::string::npos)
      << cut.diagnostics.list().front().message;
  ASSERT_EQ(moved.diagnostics.warnings(), 1);
  EXPECT_NE(moved.diagnostics.list().front().message.find("stands alone"), std::string::npos);
}

TEST(Computed, ItemsBelongToTheirReadThoughCardsAreMadeFromIt) {
  const Deck deck = read(R"toml([[card]]
name = "head"
format = "*"
fields = [{ name = "n", kind = "integer" }]
items = { name = "item", count = "head.n", fields = [{ name = "a", kind = "integer" }] }

[[card]]
name = "made"
made_from = "head"
fields = [{ name = "n", value = "n" }]

[[card]]
name = "twice"
made_from = "item"
fields = [{ name = "a", value = "2 * a" }]
)toml",
                         "2 5 6\n");
  ASSERT_EQ(deck.cards.size(), 6u);
  const CardView head(deck, 0);
  EXPECT_EQ(deck.all("item", head).size(), 2u);
  EXPECT_EQ(deck.all("twice")[1].real("a"), 12.0);
}

// Sections below their names, in any order; a name that no section has is an error and not an end.
TEST(Computed, SectionsStandInAnyOrder) {
  const std::string toml = R"toml([[card]]
block = "sections"
until = "key.word == 'END'"
  [[card.card]]
  name = "key"
  format = "(A4)"
  fields = [{ name = "word", required = true, allowed = ["NODE", "LOAD", "END"] }]
  [[card.card]]
  name = "node"
  when = "key.word == 'NODE'"
  format = "(I5,F10.0)"
  until_dropped = "number == 0"
  fields = [{ name = "number" }, { name = "x" }]
  [[card.card]]
  name = "load"
  when = "key.word == 'LOAD'"
  format = "(I5,F10.0)"
  until_dropped = "number == 0"
  fields = [{ name = "number" }, { name = "f" }]
)toml";
  const std::string text =
      "LOAD\n    2       1.0\n\nNODE\n    1       0.0\n    2       3.0\n\nLOAD\n    1       4.0\n\nEND\n";
  const Deck deck = read(toml, text);
  EXPECT_EQ(deck.all("node").size(), 2u);
  EXPECT_EQ(deck.all("load").size(), 2u);
  EXPECT_EQ(deck.all("load")[1].real("f"), 4.0);
  EXPECT_EQ(complaints(toml, "NOED\n    1       0.0\n\nEND\n"),
            "1:1-4 the word can't be \"NOED\": allowed are NODE, LOAD, END\n");
  EXPECT_EQ(refusal("[[card]]\nname = 'a'\nformat = '(A4)'\nfields = [{ name = 'n', allowed = [1] }]\n"),
            "5: allowed must be [ 'text', ... ] for a text");
}

// Time grows with the cards: ten times the cards may take twenty times as long on a loaded machine, not a hundred.
TEST(Computed, ComputingIsLinearInTheCards) {
  const auto seconds = [](int nodes) {
    std::string text;
    char line[64];
    for (int i = 0; i < nodes; ++i) {
      std::snprintf(line, sizeof line, "%10.3f%10.3f\n", i % 1000 * 0.5, i / 1000 * 0.25);
      text += line;
    }
    const std::string toml =
        "[[card]]\nname = 'node'\nformat = '(2F10.0)'\nrepeat = " + std::to_string(nodes) +
        "\nfields = [{ name = 'number', value = 'order' }, { name = 'x' }, { name = 'y' }, "
        "{ name = 'r', value = 'sqrt(x * x + y * y)' }, { name = 's', value = 'sum(x)' }]\n"
        "[[card]]\nname = 'm'\nmade_from = 'node'\nwhen = 'x == 0'\n"
        "fields = [{ name = 'first', value = 'number' }]\n";
    const std::clock_t start = std::clock();
    EXPECT_EQ(static_cast<int>(read(toml, text).cards.size()), nodes + (nodes + 999) / 1000);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const double few = seconds(10'000);
  EXPECT_LT(seconds(100'000), 30.0 * few + 0.05);
}

TEST(LayoutNamesListing, SaysWhoUsesWhat) {
  const std::string text = names_listing(load_layout_text(R"toml(name = "my"
[[card]]
name = "counts"
format = "(2I5)"
fields = [{ name = "n" }, { name = "spare", ignored = true }]
[[card]]
name = "node"
format = "(I5,3F10.0)"
repeat = "counts.n"
fields = [{ name = "number" }, { name = "x" }, { name = "y" }, { name = "sistem" }]
)toml",
                                                          "my.toml"));
  EXPECT_NE(text.find("node\n  used by the program   number, x, y\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  used by nothing       sistem (the nearest name is \"system\")\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("  could be given too    step, system, ratio\n"), std::string::npos) << text;
  EXPECT_NE(text.find("counts\n  used by the layout    n\n  ignored               spare\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("  material (needed)     number law; also unit_weight name k0 saturated_unit_weight\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace sage
