// What the reader says about damaged decks.  One small deck, damaged one way at a time.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sage/deck/read_deck.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

const Layout& sage1() {
  static const Layout layout = load_layout("sage1");
  return layout;
}

using Lines = std::vector<std::string>;

// The manual's example; line 5 is the control card, 7 to 10 are nodes, 12 a fill, 14 a material, 16 its
// parameters, 18 a group, 20 an element.
Lines lines() {
  Lines all(1);
  for (char c : sage1().example)
    if (c == '\n')
      all.emplace_back();
    else
      all.back() += c;
  all.pop_back();
  return all;
}

Lines with_line(int number, const std::string& text) {
  Lines all = lines();
  all[static_cast<std::size_t>(number) - 1] = text;
  return all;
}

std::string joined(const Lines& all) {
  std::string text;
  for (const std::string& line : all) text += line + "\n";
  return text;
}

Diagnostics diagnostics(const std::string& text, const Layout& layout = sage1(),
                        const ReadOptions& options = {}) {
  try {
    return read_deck_text(text, "deck.dat", layout, options).diagnostics;
  } catch (const InputError& error) {
    return error.diagnostics();
  }
}

// First line of each diagnostic.
Lines messages(const std::string& text, const Layout& layout = sage1(), const ReadOptions& options = {}) {
  Lines all;
  const Diagnostics printed = diagnostics(text, layout, options);
  for (const Diagnostic& d : printed.list()) {
    const std::string shown = to_string(d);
    all.push_back(shown.substr(0, shown.find('\n')));
  }
  return all;
}

Lines messages(const Lines& deck) {
  return messages(joined(deck));
}

// The "note: ..." lines below the first diagnostic.
std::string hint(const Lines& deck) {
  const Diagnostics all = diagnostics(joined(deck));
  if (all.list().empty() || all.list().front().detail.empty()) return {};
  return all.list().front().detail.back();
}

TEST(Diagnostics, ShowTheFieldUnderARuler) {
  const Diagnostics all = diagnostics(joined(with_line(10, "   25    1    0     0.0.5      0.05       0.5")));
  ASSERT_EQ(all.list().size(), 1u);
  EXPECT_EQ(to_string(all.list()[0]),
            "deck.dat:10:16-25: error: \"0.0.5\" is not a number (node card, x or radius, length) [S120]\n"
            "      | ....+....1....+....2....+....3....+....4....+\n"
            "   10 |    25    1    0     0.0.5      0.05       0.5\n"
            "      |                ^^^^^^^^^^");
}

TEST(Diagnostics, GuessWhatWasMeant) {
  EXPECT_EQ(hint(with_line(10, "   25    1    0      O.05      0.05       0.5")),
            "note: the letter O stands where the digit 0 may be meant");
  EXPECT_EQ(hint(with_line(10, "   25    l    0      0.05      0.05       0.5")),
            "note: the letter l stands where the digit 1 may be meant");
  EXPECT_EQ(hint(with_line(10, "   25\t   1    0      0.05      0.05       0.5")),
            "note: a tab counts as one column: replace tabs by blanks");
  EXPECT_EQ(hint(with_line(10, "   25   1.    0      0.05      0.05       0.5")),
            "note: an integer is wanted: no point, no exponent (or the card is shifted)");
  EXPECT_EQ(hint(with_line(10, "   25    1    0   \xa0  0.05      0.05       0.5")),
            "note: a character that is not plain ASCII (a no-break space?)");
}

TEST(Diagnostics, SequenceNumbersThatRunIntoAField) {
  const std::string stage = "    4    0   25    1    1    0    1    0    0    0       0.0       0.0  ";
  EXPECT_EQ(hint(with_line(28, stage + "SAGE0280")),
            "note: columns 73-80 may hold a sequence number, which runs into this field");
  const Lines printed = messages(with_line(28, stage + "00000280"));
  ASSERT_EQ(printed.size(), 1u);
  EXPECT_EQ(printed[0],
            "deck.dat:28:73-80: warning: \"00000280\" looks like a sequence number, but the fields of the "
            "stage card reach "
            "into columns 73-80 (reported once) [S130]");
}

TEST(Diagnostics, NearMissesAreWarnings) {
  EXPECT_EQ(messages(with_line(10, "   25    1    0   0.0 5      0.05        0.5")),
            (Lines{"deck.dat:10:16-25: warning: \"0.0 5\" has a blank inside the number (node card, x or "
                   "radius, length) [S122]"}));
  EXPECT_EQ(
      messages(with_line(10, "25,1,0,0.05,0.05,0.5")),
      (Lines{
          "deck.dat:10:1-2: warning: a comma ended the field after \"25\" (node card, node number) [S123]"}));
  EXPECT_EQ(messages(with_line(10, "   25    1    0         -      0.05       0.5")),
            (Lines{"deck.dat:10:16-25: warning: \"-\" has no digit and reads as 0 (node card, x or radius, "
                   "length) [S124]"}));
  EXPECT_EQ(
      messages(with_line(10, "   25    1    0    0.5Q-1      0.05       0.5")),
      (Lines{"deck.dat:10:16-25: warning: \"0.5Q-1\" has the exponent letter Q and reads as if it were E (node "
             "card, x or radius, length) [S124]"}));
  EXPECT_EQ(
      messages(with_line(10, lines()[9] + "      oops")),
      (Lines{"deck.dat:10:52-55: note: characters behind the last field of the node card are ignored [S129]"}));
  EXPECT_EQ(messages(with_line(10, lines()[9] + std::string(40, ' ') + "oops")),
            (Lines{"deck.dat:10:81-89: note: characters beyond column 80 are ignored (reported once) [S129]"}));
}

TEST(Diagnostics, StrictTurnsWarningsIntoErrors) {
  const std::string text = joined(with_line(10, "25,1,0,0.05,0.05,0.5"));
  EXPECT_EQ(diagnostics(text).errors(), 0);
  ReadOptions strict;
  strict.strict = true;
  EXPECT_EQ(diagnostics(text, sage1(), strict).errors(), 1);
  EXPECT_EQ(diagnostics(joined(lines()), sage1(), strict).errors(), 0);
}

TEST(Diagnostics, NumbersThatAreNone) {
  EXPECT_EQ(
      messages(with_line(10, "   25    1    0       NaN     1e400 Infinity")),
      (Lines{"deck.dat:10:16-25: error: \"NaN\" is not a finite number (node card, x or radius, length) [S121]",
             "deck.dat:10:26-35: error: \"1e400\" is too large for a number (node card, y or angle, "
             "length or degrees) [S121]",
             "deck.dat:10:36-44: error: \"Infinity\" is not a finite number (node card, last interval divided "
             "by the first interval) [S121]"}));
  EXPECT_EQ(messages(with_line(10, "   25    1    0     1e308      0.05       0.5")), Lines{});
  EXPECT_EQ(messages(with_line(10, "   25    1    0     1.5E         5       0.5")),
            (Lines{"deck.dat:10:16-25: error: \"1.5E\" has an exponent letter without an exponent (node card, "
                   "x or radius, length) [S120]"}));
}

TEST(Diagnostics, MissingValues) {
  EXPECT_EQ(messages(with_line(10, "         1    0      0.05      0.05       0.5")),
            (Lines{"deck.dat:10:1-5: error: a value is missing (node card, node number) [S115]"}));
  EXPECT_EQ(messages(with_line(12, "    1    4")),
            (Lines{"deck.dat:12: error: a value is missing (fill card, number of rows of elements) [S115]",
                   "deck.dat:12: error: a value is missing (fill card, increment of node numbers from row to "
                   "row) [S115]"}));
}

TEST(Diagnostics, AllMistakesInOnePass) {
  Lines deck = with_line(10, "   25    x    0      0.05      0.y5       0.5");
  deck[11] = "    1    z    1    4    5       0.5       0.5";
  deck[31] = "    4    2   16    4      1OO.      100.";
  EXPECT_EQ(messages(deck).size(), 4u);
}

TEST(Diagnostics, ACardTooFew) {
  Lines deck = lines();
  deck.erase(deck.begin() + 9);
  EXPECT_EQ(messages(deck),
            (Lines{"deck.dat:11: error: this reads as a fill card, but a node card was expected: 3 of 4 read "
                   "(number of node cards of the control card, line 5) [S111]"}));
  deck = lines();
  deck.erase(deck.begin() + 4);
  EXPECT_EQ(messages(deck),
            (Lines{"deck.dat:6: error: this reads as a node card, but a control card was expected [S111]",
                   "deck.dat:6: note: the control card is missing: reading stops here [S132]"}));
}

TEST(Diagnostics, ACardTooMany) {
  Lines deck = lines();
  deck.insert(deck.begin() + 10, "   26    0    0       0.1      0.05");
  EXPECT_EQ(messages(deck),
            (Lines{"deck.dat:11: error: this reads as a node card, but the 4 that were announced (number of "
                   "node cards of the control card, line 5) have been read [S111]"}));
  EXPECT_EQ(
      messages(with_line(5, "    2    0    4    0    1    1    1    2    1    1    1   25   16")),
      (Lines{
          "deck.dat:12: error: this reads as a fill card, but none was announced (number of fill cards of the "
          "control card, line 5) [S111]"}));
}

TEST(Diagnostics, ABlockTooFew) {
  EXPECT_EQ(messages(with_line(5, "    2    0    4    1    2    1    1    2    1    1    1   25   16")),
            (Lines{"deck.dat:18: error: this reads as a group card, but a material card was expected: 1 of 2 "
                   "read (number of "
                   "material cards of the control card, line 5) [S111]"}));
}

TEST(Diagnostics, AListThatRunsIntoTheNextCards) {
  EXPECT_EQ(
      messages(with_line(14, "    1    1    9       0.0 clay")),
      (Lines{
          "deck.dat:18: error: this reads as a group card, but the parameters card goes on: 8 of 9 values read "
          "(number of parameters of the material card, line 14) [S111]"}));
}

TEST(Diagnostics, TruncatedDecks) {
  Lines deck = lines();
  deck.resize(9);
  EXPECT_EQ(
      messages(deck),
      (Lines{"deck.dat:9: error: the deck ends here, but a node card was expected (3 of 4 read, 1 missing; "
             "number of node cards of the control card, line 5) [S110]"}));
  deck = lines();
  deck.pop_back();
  EXPECT_EQ(messages(deck),
            (Lines{"deck.dat:34: error: the deck ends here, but an end card was expected [S110]"}));
  // Wherever the deck is cut, there is an error and it is the last.
  for (std::size_t n = 1; n + 1 < lines().size(); ++n) {
    deck = lines();
    deck.resize(n);
    const Diagnostics all = diagnostics(joined(deck));
    ASSERT_GE(all.errors(), 1) << n;
    EXPECT_NE(to_string(all.list().back()).find("the deck ends here, but a"), std::string::npos) << n;
  }
}

TEST(Diagnostics, CountsThatCannotBe) {
  EXPECT_EQ(messages(with_line(5, "    2    0   -4    1    1    1    1    2    1    1    1   25   16")),
            (Lines{"deck.dat:5:11-15: error: the number of node cards can't be -4 (number of node cards of the "
                   "control card, line 5) [S111]"}));
  EXPECT_EQ(
      messages(with_line(5, "    2    0    x    1    1    1    1    2    1    1    1   25   16")),
      (Lines{"deck.dat:5:11-15: error: \"x\" is not an integer (control card, number of node cards) [S120]",
             "deck.dat:5: note: the number of node cards is not known: reading stops here [S132]"}));
  EXPECT_EQ(messages(with_line(14, "    1    199999       0.0 clay")),
            (Lines{"deck.dat:16: error: 99999 values of parameter can't be in a deck of 1619 characters "
                   "(number of parameters "
                   "of the material card, line 14) [S111]"}));
}

// "200000000*1" would be eight gigabytes of values.
TEST(Diagnostics, RepeatsDoNotFillTheMemory) {
  const Layout layout = load_layout("sg_p51");
  const std::string head = "'plane'\n'quadrilateral' 4 'x'\n10000 20000 1 2\n2*1e6 2*.3\n";
  EXPECT_EQ(messages(head + "200000000*1\n", layout)[0],
            "deck.dat:5: error: 200000000 values of material of the element can't be in a deck of 69 "
            "characters (columns of "
            "elements nxe of the rectangle card, line 3) [S111]");
  EXPECT_EQ(
      messages("'plane'\n'quadrilateral' 4 'x'\n10 20 1 2\n2*1e6 2*.3\n200*1\n11*0 21*0\n0\n0\n0\n", layout),
      Lines{});
}

TEST(Diagnostics, TheEnd) {
  EXPECT_EQ(
      messages(with_line(35, "STOP")),
      (Lines{"deck.dat:35:1-3: error: the end card must read END, not \"STO\" [S116]",
             "deck.dat:35:4: note: characters behind the last field of the end card are ignored [S129]"}));
  EXPECT_EQ(messages(with_line(35, "end")), Lines{});
  Lines deck = lines();
  deck.push_back("");
  deck.push_back("more");
  EXPECT_EQ(
      messages(deck),
      (Lines{"deck.dat:37: warning: the deck is complete, but more lines follow: they are ignored [S113]"}));
}

TEST(Diagnostics, OnlySoManyAreShown) {
  std::string text = "title\nm       kN      kPa\n    1    0  200    0    0    0    0\n";
  for (int i = 0; i < 200; ++i) text += "    x    0    0       1.0       2.0\n";
  const Lines printed = messages(text + "END\n");
  ASSERT_EQ(printed.size(), 51u);
  EXPECT_EQ(printed[50], "deck.dat: error: and 150 more errors [S109]");
}

TEST(Diagnostics, ReadingStopsAtAThousandErrors) {
  std::string text = "title\nm       kN      kPa\n    1    0 9999    0    0    0    0\n";
  for (int i = 0; i < 9999; ++i) text += "    x    0    0       1.0       2.0\n";
  const Lines printed = messages(text + "END\n");
  EXPECT_EQ(printed[50], "deck.dat:1004: note: too many errors: reading stops here [S132]");
}

TEST(Diagnostics, ZeroModeWarnsOfTrimmedCards) {
  const Layout layout = load_layout_text(
      "name = 'z'\nblanks = 'zero'\n[[card]]\nname = 'a'\nformat = '(I5,F10.3)'\n"
      "fields = [{ name = 'n' }, { name = 'x', label = 'length' }]\n",
      "z.toml");
  // A Fortran runtime takes the blanks of a short record as absent: 15 instead of 15000.
  EXPECT_EQ(messages("    1  15\n", layout),
            (Lines{"deck.dat:1:6-9: warning: the card ends inside the field of \"15\" (a card, length) [S125]",
                   "deck.dat:1:6-9: note: \"15\" has no point: its last digits are taken as decimals, "
                   "(I5,F10.3) (a card, length) [S126]"}));
  EXPECT_EQ(messages("    1  15.      \n", layout),
            (Lines{"deck.dat:1:6-15: note: blanks behind \"15.\" count as zeros (a card, length) [S125]"}));
  EXPECT_EQ(messages("    1     15.0\n", layout).size(), 1u);
  EXPECT_EQ(messages("    1      15.0\n", layout), Lines{});
}

TEST(Diagnostics, ImpliedDecimalsAreNoted) {
  const Layout layout = load_layout_text(
      "name = 'z'\n[[card]]\nname = 'a'\nformat = '(I5,F10.5)'\nfields = [{ name = 'n' }, { name = 'x' }]\n",
      "z.toml");
  EXPECT_EQ(messages("    1        10\n", layout),
            (Lines{"deck.dat:1:6-15: note: \"10\" has no point: its last digits are taken as decimals, "
                   "(I5,F10.5) (a card, x) [S126]"}));
}

TEST(Diagnostics, FreeFormat) {
  const Layout layout = load_layout("sg_p51");
  const std::string head = "'plane'\n'triangle' 3 'x'\n";
  EXPECT_EQ(messages(head + "2 2 1 x\n", layout)[0],
            "deck.dat:3:7: error: \"x\" is not an integer (rectangle card, number of materials) [S120]");
  EXPECT_EQ(messages("'plain'\n", layout)[0],
            "deck.dat:1: error: the deck ends here, but a rectangle card was expected [S110]");
  EXPECT_EQ(messages("'plain'\n'triangle' 3 'x' 1 1 1 1\n", layout)[0],
            "deck.dat:1:1-7: error: \"plain\" is not a known code (rectangle card, type of analysis); known: "
            "axisymmetric, plane [S117]");
  EXPECT_EQ(messages(head + "2 2 1 1\n1e6 .3\n0 1 2 0 1 2\n2\n1 0 1\n", layout)[0],
            "deck.dat:7: error: the deck ends here, but a restraints card was expected (1 of 2 read, 1 "
            "missing) [S110]");
  EXPECT_EQ(messages(head + "2 / \n", layout)[0],
            "deck.dat:1: error: a value is missing (rectangle card, rows of elements nye) [S115]");
}

// ---- Files ----

std::string open_error(const std::string& path) {
  try {
    read_deck(path, sage1());
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().list().size(), 1u);
    return error.what();
  }
  return {};
}

TEST(Files, OneClearErrorEach) {
  const std::string folder = test::scratch_folder("deck_files").string();
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
    return folder + "/" + name;
  };
  EXPECT_EQ(open_error(folder), folder + ": error: is a directory, not a file [S101]");
  EXPECT_EQ(open_error(folder + "/none"),
            folder + "/none: error: can't be opened: No such file or directory [S101]");
  EXPECT_EQ(open_error(write("empty", "")), folder + "/empty: error: the file is empty [S103]");
  EXPECT_EQ(
      open_error(write("binary", std::string("\x7f"
                                             "ELF\0\0\0",
                                             7))),
      folder + "/binary: error: the file is binary (a NUL character at byte 5), not a deck of cards [S104]");
  EXPECT_EQ(open_error(write("wide", std::string("\xff\xfe"
                                                 "t\0i\0",
                                                 6))),
            folder + "/wide: error: the file is UTF-16 text: save it as plain ASCII or UTF-8 [S104]");
  EXPECT_EQ(open_error(write("blank", "  \n\n")),
            folder + "/blank: error: the file holds nothing but blanks [S103]");
  EXPECT_THROW(read_deck(folder + "/none"), InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sage
