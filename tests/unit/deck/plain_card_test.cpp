// Cards of plain numbers are read by a short way, and a deck stores little more than their numbers.  The long way,
// FORMAT control field by field, is the reference: a colon in the FORMAT, which changes nothing where a value
// follows it, sends every card there.
#include "sage/deck/plain_card.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "sage/deck/card_formats.hpp"
#include "sage/deck/read_deck.hpp"

namespace sage {
namespace {

struct Form {
  const char* format;    // of the short way
  const char* long_way;  // the same with a colon
  std::vector<int> columns;
  const char* kinds;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> all{
      {"(3I5,3F10.0)", "(I5,:,2I5,3F10.0)", {5, 5, 5, 10, 10, 10}, "IIIDDD"},
      {"(14I5)", "(I5,:,13I5)", std::vector<int>(14, 5), "IIIIIIIIIIIIII"},
      {"(I10,2F20.0,I10)", "(I10,:,2F20.0,I10)", {10, 20, 20, 10}, "IDDI"},
      {"(2I4,3X,F8.3,T30,E12.4,A6)", "(2I4,:,3X,F8.3,T30,E12.4,A6)", {4, 4, 3, 8, 10, 12, 6}, "II D DA"},
      {"(8F10.0)", "(F10.0,:,7F10.0)", std::vector<int>(8, 10), "DDDDDDDD"},
  };
  return all;
}

Layout layout_of(const Form& form, bool long_way) {
  std::string fields;
  int n = 0;
  for (const char kind : std::string(form.kinds)) {
    if (kind == ' ') continue;
    fields += std::string(n == 0 ? "" : ", ") + "{ name = 'f" + std::to_string(n) + "'";
    fields += n == 1 ? ", required = true }" : n == 2 ? ", blank = 'noted' }" : " }";
    ++n;
  }
  return load_layout_text(
      "name = 'x'\ncomment = '*'\nrecord_length = 80\nsequence_columns = [73, 80]\n[[card]]\nname = "
      "'c'\nformat = '" +
          std::string(long_way ? form.long_way : form.format) + "'\nfields = [" + fields + "]\n",
      "my.toml");
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  bool chance(int percent) { return below(100) < percent; }
  char of(std::string_view letters) { return letters[below(static_cast<int>(letters.size()))]; }

 private:
  std::mt19937 engine_;
};

std::string number(Random& random, char kind, int width) {
  std::string text = random.chance(15) ? std::string(1, random.of("+-")) : "";
  const int digits = random.chance(25) ? width - static_cast<int>(text.size()) : 1 + random.below(width);
  for (int i = 0; i < digits; ++i) text += random.of("0123456789");
  if (kind == 'D' && random.chance(85)) text[random.below(static_cast<int>(text.size()))] = '.';
  if (kind == 'D' && random.chance(10)) text += random.of("EDed+-") + std::to_string(random.below(30));
  if (kind == 'A') text = random.chance(70) ? "" : "clay";
  return random.chance(12) ? "" : text;
}

std::string record(Random& random, const Form& form) {
  std::string text;
  for (std::size_t i = 0; i < form.columns.size(); ++i) {
    const int width = form.columns[i];
    const char kind = form.kinds[i];
    std::string field = kind == ' ' ? "" : number(random, kind, width);
    const int free = width - static_cast<int>(field.size());
    const int before = free <= 0 ? 0 : random.chance(85) ? free : random.below(free + 1);
    field.insert(0, static_cast<std::size_t>(before), ' ');
    field.resize(width, ' ');
    text += field;
  }
  if (random.chance(5)) text[random.below(static_cast<int>(text.size()))] = random.of(" ,.+-0Ox\tE");
  if (random.chance(4)) text.insert(static_cast<std::size_t>(random.below(static_cast<int>(text.size()))), " ");
  if (random.chance(4)) text.erase(static_cast<std::size_t>(random.below(static_cast<int>(text.size()))), 1);
  if (random.chance(30)) text.erase(text.find_last_not_of(' ') + 1);
  if (random.chance(15)) text.resize(72, ' '), text += "00000010";
  if (random.chance(10)) text.resize(80, ' ');
  if (random.chance(5)) text += random.chance(50) ? "  a remark" : "9";
  return text;
}

// Numbers to the last bit, places, and every message but the FORMAT that some of them quote.
std::string outcome(const std::string& card, const Layout& layout) {
  std::string text;
  Diagnostics said;
  try {
    const Deck deck = read_deck_text(card, "deck", layout);
    for (const Card& one : deck.cards)
      for (const FieldValue& value : deck.values(one)) {
        text += std::to_string(std::bit_cast<std::uint64_t>(value.number)) + (value.blank ? "b " : " ");
        text += std::to_string(value.line) + ":" + std::to_string(value.first_column) + "-" +
                std::to_string(value.last_column) + " <" + std::string(value.text) + ">\n";
      }
    said = deck.diagnostics;
  } catch (const InputError& error) {
    said = error.diagnostics();
  }
  for (const Diagnostic& one : said.list()) {
    std::string message = one.message;
    for (const char* format : {layout.cards[0].spec.format.c_str()})
      if (const std::size_t at = message.find(format); at != std::string::npos)
        message.erase(at, std::string_view(format).size());
    text += std::to_string(one.where.line) + ":" + std::to_string(one.where.first_column) + "-" +
            std::to_string(one.where.last_column) + " " + message + "\n";
    for (const std::string& line : one.detail) text += line + "\n";
  }
  return text;
}

TEST(PlainCards, TheShortWayIsTheLongOne) {
  Random random(411);
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.format);
    const Layout plain = layout_of(form, false), full = layout_of(form, true);
    const std::optional<PlainCard> card = plain_card(plain.cards[0], plain.records);
    ASSERT_TRUE(card);
    ASSERT_FALSE(plain_card(full.cards[0], full.records));
    int by_short_way = 0, different = 0;
    for (int i = 0; i < 20000 && different < 5; ++i) {
      const std::string text = record(random, form);
      if (text.find_first_not_of(" \t") == std::string::npos || text[0] == '*') continue;
      std::vector<double> numbers;
      by_short_way += read_plain(*card, std::string_view(text).substr(0, 80), numbers) ? 1 : 0;
      const std::string a = outcome(text + "\n", plain), b = outcome(text + "\n", full);
      if (a == b) continue;
      ++different;
      ADD_FAILURE() << text << "\nshort way:\n" << a << "long way:\n" << b;
    }
    EXPECT_GT(by_short_way, 4000);   // the comparison is not empty
    EXPECT_LT(by_short_way, 19000);  // and not without oddities
  }
}

// 1.5 in ten columns and 123456789012345678 in twenty: digits that one division gives, and digits that it doesn't.
TEST(PlainCards, NumbersOfManyDigitsAreRoundedOnce) {
  const struct {
    const char* text;
    double value;
  } cases[] = {{"1.5", 1.5},
               {".1", 0.1},
               {"-0.0", -0.0},
               {"9007199254740993.", 9007199254740992.0},   // 2^53 + 1, a tie
               {"9007199254740993.1", 9007199254740994.0},  // just above it
               {"123456789.01234567", 123456789.01234567},
               {"0.30000000000000004", 0.30000000000000004},
               {".000000000000000001", 1e-18},
               {"99999999999999999999", 1e20}};
  for (const auto& c : cases) {
    const FieldResult read = read_real_field(c.text, {});
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.value), std::bit_cast<std::uint64_t>(c.value)) << c.text;
  }
}

// A number a value, nothing for the blanks behind the last: 100 000 nodes and as many elements in 40 MB.
TEST(LargeDecks, StoreANumberAValue) {
  std::string text = "title\nm       kN      kPa\n    1    0    2    0    0    0    1\n";
  text += "    1    0    0       0.0       0.0" + std::string(45, ' ') + "\n";
  text += "    2    0    0       1.5       0.0" + std::string(45, ' ') + "\n";
  text += "    1    1    1    2    1    2" + std::string(50, ' ') + "\nEND\n";
  const Deck deck = read_deck_text(text, "deck", load_layout("sage1"));
  EXPECT_TRUE(deck.places.empty());
  std::vector<CardView> nodes = deck.all("node");
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].card().value_count, 5);
  EXPECT_EQ(deck.one("element").card().value_count, 6);
  EXPECT_LE(sizeof(Card), 24u);
  // What is not stored is read again where a message asks for it.
  EXPECT_EQ(nodes[1].real("x"), 1.5);
  EXPECT_EQ(nodes[1].where("x").first_column, 16);
  EXPECT_EQ(nodes[1].where("x").last_column, 25);
  EXPECT_TRUE(nodes[1].blank("ratio"));
  EXPECT_EQ(nodes[1].where("ratio").line, 5);
  EXPECT_EQ(nodes[1].where("ratio").first_column, 36);
  EXPECT_EQ(nodes[1].where("ratio").last_column, 45);
  EXPECT_EQ(deck.one("element").real("column_step"), 1.0);  // the layout's default
  EXPECT_EQ(deck.one("units").text("stress"), "kPa");
  EXPECT_EQ(deck.values(nodes[1].card()).size(), 6u);
}

// Two kinds of card may bear one name and have the field at different places.
TEST(FieldNames, AreSoughtAgainForEachKindOfCard) {
  const Layout layout = load_layout_text(
      "name = 'x'\n[[card]]\nname = 'a'\nformat = '(2I5)'\nfields = [{ name = 'n' }, { name = 'm' }]\n"
      "[[card]]\nname = 'b'\nas = 'a'\nformat = '(2I5)'\nfields = [{ name = 'm' }, { name = 'n', default = 9 "
      "}]\n"
      "[[card]]\nname = 'c'\nas = 'a'\nformat = '(I5)'\nfields = [{ name = 'm' }]\n",
      "my.toml");
  const Deck deck = read_deck_text("    1    2\n    3     \n    4\n", "deck", layout);
  FieldName n("n");
  std::vector<int> found;
  for (const CardView& card : deck.all("a")) found.push_back(card.integer(n, 7));
  EXPECT_EQ(found, (std::vector<int>{1, 9, 7}));
  std::vector<double> real;
  std::vector<bool> blank;
  for (const CardView& card : deck.all("a")) {
    real.push_back(card.real(n, 7.5));
    blank.push_back(card.blank(n));
  }
  EXPECT_EQ(real, (std::vector<double>{1.0, 9.0, 7.5}));
  EXPECT_EQ(blank, (std::vector<bool>{false, true, true}));
  EXPECT_TRUE(deck.has("a"));
  EXPECT_FALSE(deck.has("n"));
}

}  // namespace
}  // namespace sage
