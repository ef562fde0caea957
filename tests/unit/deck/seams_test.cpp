// Numbers cut by the end of their field are warned of; fields that are packed side by side are not.
#include "sage/deck/seams.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "sage/deck/read_deck.hpp"

namespace sage {
namespace {

// A layout of one card with these fields: "integer", "real" and "text" by their edit descriptors.
Layout one_card(const std::string& format, const std::string& names, const std::string& head = "") {
  std::string fields;
  for (const char name : names) fields += std::string(fields.empty() ? "" : ", ") + "{ name = '" + name + "' }";
  return load_layout_text(
      "name = 'x'\n" + head + "[[card]]\nname = 'c'\nformat = '" + format + "'\nfields = [" + fields + "]\n",
      "my.toml");
}

// "6-11: message" of the only warning; empty where there is none.
std::string warning(const Layout& layout, const std::string& card) {
  std::string text;
  const Deck deck = read_deck_text(card + "\n", "deck", layout);
  for (const Diagnostic& d : deck.diagnostics.list())
    if (d.severity == Severity::warning)
      text += (text.empty() ? "" : " & ") + std::to_string(d.where.first_column) + "-" +
              std::to_string(d.where.last_column) + ": " + d.message;
  return text;
}

TEST(Slip, ANumberCutByTheEndOfItsField) {
  const Layout load = one_card("(3I5,2F10.0)", "abcde");
  EXPECT_EQ(warning(load, "    1    0    0       0.0    12500."), "");
  // 12500 two columns to the right of its place would be a load of 125.
  EXPECT_EQ(warning(load, "    1    0    0       0.0       12500"),
            "33-37: \"12500\" is cut: the field ends at column 35, and what stands behind it is not read (c "
            "card, e)");
  EXPECT_EQ(warning(load, "    1    0    0      12500         0."),
            "22-26: \"12500\" is cut in two: the field ends at column 25, and the rest reads as the next (c "
            "card, d)");
}

TEST(Slip, ABlankTooManyBeforeTheLastNumber) {
  const Layout parameters = one_card("(8F10.0)", "ab");
  EXPECT_EQ(warning(parameters, "    20000.       0.3"), "");
  EXPECT_EQ(
      warning(parameters, "    20000.        0.3"),
      "19-21: \"0.3\" is cut: the field ends at column 20, and what stands behind it is not read (c card, b)");
  EXPECT_EQ(
      warning(parameters, "    20000.           0.3"),
      "22-24: a number stands behind the last field of the c card, which is blank: it is not read (c card, b)");
  EXPECT_EQ(warning(parameters, "    20000.       0.3  stiff clay, layer 2"), "");
  EXPECT_EQ(warning(parameters, "    20000.           stiff clay"), "");
}

// 1.E9 one or two columns to the right of its place read 1.
TEST(Slip, ANumberCutBeforeItsExponent) {
  const Layout two = one_card("(2F10.0)", "ab");
  EXPECT_EQ(warning(two, "       1.0      1.E9"), "");
  EXPECT_EQ(
      warning(two, "       1.0        1.E9"),
      "19-22: \"1.E9\" is cut: the field ends at column 20, and what stands behind it is not read (c card, b)");
  EXPECT_EQ(
      warning(two, "       1.0        1.d+05"),
      "19-24: \"1.d+05\" is cut: the field ends at column 20, and what stands behind it is not read (c card, "
      "b)");
  EXPECT_NE(warning(one_card("(F10.0,A20)", "at"), "        1.E9 clay"), "");
  EXPECT_EQ(warning(one_card("(F10.0,A20)", "at"), "        1.East clay"), "");
  // Within the card the exponent would be the next number.
  EXPECT_NE(warning(two, "        1.E9       2.0").find("\"1.E9\" is cut in two: the field ends at column 10"),
            std::string::npos);
}

TEST(Slip, NumbersBehindTheLastField) {
  const Layout two = one_card("(2F10.0)", "ab");
  EXPECT_EQ(warning(two, "       1.0       2.0       3.0"),
            "28-30: numbers stand behind the last field of the c card and are not read");
  EXPECT_EQ(warning(two, "       1.0       2.0   3 layers"), "");
  ReadOptions strict;
  strict.strict = true;
  EXPECT_THROW(read_deck_text("       1.0       2.0       3.0\n", "deck", two, strict), InputError);
}

// A name that begins or ends with digits is no slip; one that a number field reads the rest of is told as that.
TEST(Slip, NamesAndTitlesAreNone) {
  const std::string head = "name = 'x'\n[[card]]\nname = 'c'\n";
  const Layout name = load_layout_text(
      head +
          "format = '(I5,F10.0,A20,I5)'\nfields = [{ name = 'n' }, { name = 'w' }, { name = 'name' }, "
          "{ name = 'overlay' }]\n",
      "my.toml");
  EXPECT_EQ(warning(name, "    1          2 clay"), "");
  EXPECT_EQ(warning(name, "    1      19.5 section 12"), "");
  const std::string runs_over = warning(name, "    1      19.5 sand of section 1234");
  EXPECT_NE(runs_over.find("runs on beyond column 35"), std::string::npos) << runs_over;
}

// The message of the first error; "" where there is none.
std::string error(const Layout& layout, const std::string& text) {
  try {
    read_deck_text(text, "deck", layout);
  } catch (const InputError& e) {
    for (const Diagnostic& d : e.diagnostics().list())
      if (d.severity == Severity::error) return d.message;
  }
  return "";
}

TEST(Slip, ACardBesideItsColumnsIsNamedBeforeItsFields) {
  const Layout node = one_card("(3I5,2F10.0)", "abcxy");
  EXPECT_EQ(error(node, "    12   0    0       1.0      -4.0\n"), "");
  EXPECT_EQ(error(node, "    1    0    0        1.0      -4.0\n"),
            "the c card is shifted 1 column to the right from \"1.0\" on");
  EXPECT_EQ(error(node, "       1    0    0       1.0      -4.0\n"),
            "the c card is shifted 3 columns to the right");
  EXPECT_EQ(error(node, "    1    0    0    1 5\n"), "");  // a blank within a number: a warning
}

TEST(Slip, WarningsAreErrorsWhereThatIsAsked) {
  ReadOptions strict;
  strict.strict = true;
  EXPECT_THROW(read_deck_text("    20000.        0.3\n", "deck", one_card("(8F10.0)", "ab"), strict),
               InputError);
}

TEST(Slip, ADigitMovedIntoTheNextField) {
  const Layout fixity = one_card("(5I5)", "abcde");
  EXPECT_EQ(warning(fixity, "    1  181    9    1    0"), "");
  EXPECT_EQ(warning(fixity, "    1  181    9     1    0"),
            "21-21: \"1\" stands alone in the field's first column, 21, and the field before it is blank (c "
            "card, e)");
  EXPECT_NE(warning(fixity, "     1    2"), "");
  // Left-justified on purpose.
  EXPECT_EQ(warning(fixity, "1    181       1    0"), "");
  EXPECT_EQ(warning(fixity, "1         9    1    0"), "");
  EXPECT_EQ(warning(fixity, "21"), "");
}

TEST(Slip, FullFieldsSideBySideAreLegal) {
  const Layout integers = one_card("(6I5)", "abcdef");
  EXPECT_EQ(warning(integers, "100001000110002100031000410005"), "");
  EXPECT_EQ(warning(integers, "    110001100029999999998    1"), "");
  EXPECT_EQ(warning(integers, "10000    110001"), "");
  EXPECT_EQ(warning(integers, "10000100011000210003"), "");
  EXPECT_EQ(warning(integers, "10000100011    2    "), "");  // left-justified
  EXPECT_NE(warning(integers, " 1000010001100021000310004"), "");
  EXPECT_NE(warning(integers, "   10110001"), "");
  const Layout node = one_card("(I5,2F10.0)", "axy");
  EXPECT_EQ(warning(node, "999991234.567891234.56789"), "");
  EXPECT_EQ(warning(node, "99999-234.56789-234.56789"), "");
  EXPECT_EQ(warning(node, "    1    -0.5  -0.5"), "");
  EXPECT_EQ(warning(node, "999990.3       0.3"), "");  // each begins its field
  EXPECT_EQ(warning(node, "    1      0.3033.0E3"), "");
  EXPECT_NE(warning(node, "    11234.5678912345678."), "");  // right-justified, and yet the point stands last
}

TEST(Slip, NumbersBesideTexts) {
  const Layout material = one_card("(I5,F10.0,A20)", "awn");
  EXPECT_EQ(warning(material, "    1      19.5 clay"), "");
  EXPECT_EQ(warning(material, "    1      19.519962-3 culvert"), "");
  EXPECT_EQ(
      warning(material, "    1       19.5 clay"),
      "13-16: \"19.5\" is cut in two: the field ends at column 15, and the rest reads as the next (c card, w)");
  const Layout units = one_card("(3A8,F10.0)", "lfsp");
  EXPECT_EQ(warning(units, "m       kilonewtkilopasc"), "");
  EXPECT_EQ(warning(units, "m      kN      kPa"),
            "8-9: \"kN\" is cut in two: the text ends at column 8, and the rest begins the next (c card, l)");
}

TEST(Slip, ColumnsThatNothingReads) {
  const Layout gap = one_card("(I5,5X,I5)", "ab");
  EXPECT_EQ(warning(gap, "   12  x     34"), "");
  EXPECT_EQ(
      warning(gap, "    12        34"),
      "5-6: \"12\" is cut: the field ends at column 5, and what stands behind it is not read (c card, a)");
  EXPECT_EQ(warning(gap, "   12   123456 "),
            "9-14: \"123456\" is cut: the field begins behind column 10, and what stands there is not read (c "
            "card, b)");
  EXPECT_EQ(warning(gap, "     1        34"),
            "6-6: \"1\" is cut: the field ends at column 5, and what stands behind it is not read (c card, a)");
  // Tabs may go back to columns behind a field.
  EXPECT_EQ(warning(one_card("(T6,I5,T1,I5)", "ab"), "1000010001"), "");
}

TEST(Slip, SequenceNumbersMayTouch) {
  const Layout layout =
      one_card("(7F10.0,I2)", "abcdefgh", "record_length = 80\nsequence_columns = [73, 80]\n");
  const std::string blank(70, ' ');
  EXPECT_EQ(warning(layout, blank + "1200000010"), "");
  EXPECT_EQ(
      warning(layout, blank + " 12"),
      "72-73: \"12\" is cut: the field ends at column 72, and what stands behind it is not read (c card, h)");
  const Layout wide = one_card("(8F10.0)", "abcdefgh", "record_length = 80\n");
  EXPECT_EQ(
      warning(wide, blank + "        125"),
      "79-81: \"125\" is cut: the field ends at column 80, and what stands behind it is not read (c card, h)");
}

// Node numbers and coordinates that fill their fields: as programs write decks of 99 999 nodes.
TEST(Slip, ALargeDeckGetsNoWarning) {
  constexpr int kNodes = 99'999;
  std::string text = "Many nodes\nm       kN      kPa\n    2    099999    0    0    099999    1    0    1\n";
  char card[100];
  for (int i = 1; i <= kNodes; ++i) {
    std::snprintf(card, sizeof card, "%5d%5d%5d%10.4f%10.5f\n", i, 0, 0, 0.9 * i, -0.04 * i);
    text += card;
  }
  for (int i = 1; i <= kNodes; ++i) {
    const auto near = [&](int by) { return (i + by) % kNodes + 1; };
    std::snprintf(card, sizeof card, "%5d%5d%5d%5d%5d%5d\n", i, 1, near(0), near(1), near(320), near(319));
    text += card;
  }
  text += "    199999    1    1    0\nstage\n    1    0   25    1    0    1\n";
  text += "    1    099999-12500.123-12500.456\n";
  const Layout layout = load_layout("sage1");
  const Deck deck = read_deck_text(text + "END\n", "deck", layout);
  for (const Diagnostic& d : deck.diagnostics.list()) {
    if (d.severity == Severity::warning) FAIL() << to_string(d);
  }
  EXPECT_EQ(deck.all("node").size(), 99'999u);
}

}  // namespace
}  // namespace sage
