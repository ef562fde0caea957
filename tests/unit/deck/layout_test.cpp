#include "sage/deck/layout.hpp"

#include <gtest/gtest.h>

#include <map>

#include <fstream>
#include <sstream>

#include "sage/deck/layout_bytes.hpp"
#include "sage/deck/layout_names.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"
#include "sage/deck/wide_layout.hpp"

namespace sage {
namespace {

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// "7: message" of the first complaint about a layout; empty if there is none.
std::string complaint(const std::string& toml) {
  try {
    load_layout_text(toml, "my.toml");
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().list().front();
    EXPECT_EQ(d.where.file, "my.toml");
    return std::to_string(d.where.line) + ": " + d.message;
  }
  return {};
}

TEST(Layout, EveryBuiltInLayoutLoads) {
  const std::vector<std::string> names = built_in_layouts();
  EXPECT_EQ(names.size(), 23u);
  for (const std::string& name : names) {
    const Layout layout = load_layout(name);
    EXPECT_EQ(layout.name, name);
    EXPECT_FALSE(layout.cards.empty());
    EXPECT_FALSE(layout_manual(layout).empty());
  }
}

TEST(Layout, TheBuiltInCopyIsTheFile) {
  const auto bytes = [](Layout layout) {
    Archive archive;
    exchange(archive, layout);
    return archive.bytes();
  };
  for (const std::string& name : built_in_layouts()) {
    if (name == kWideLayout) continue;  // made from another
    const std::string file = name + ".toml";
    const Layout read = load_layout_text(file_text(SAGE_SOURCE_DIR "/legacy_inputs/layouts/" + file), file);
    EXPECT_EQ(bytes(load_layout(name)), bytes(read)) << name;
    EXPECT_EQ(layout_manual(load_layout(name)), layout_manual(read)) << name;
  }
}

TEST(Layout, LoadsFromAPath) {
  const Layout layout = load_layout(SAGE_SOURCE_DIR "/legacy_inputs/layouts/quad4m.toml");
  EXPECT_EQ(layout.name, "quad4m");
  EXPECT_THROW(load_layout("no_such_layout"), InputError);
  EXPECT_THROW(load_layout("./no_such_layout.toml"), InputError);
}

TEST(Layout, MistakesNameTheirLine) {
  const std::string head = "name = 'x'\n[[card]]\nname = 'a'\n";
  const std::string good = head + "format = '(I5)'\nfields = [{ name = 'n' }]\n";
  EXPECT_EQ(complaint(good), "");
  EXPECT_EQ(complaint("name = \n").substr(0, 2), "1:");
  EXPECT_EQ(complaint("[[card]]\n").substr(0, 2), "1:");
  EXPECT_EQ(complaint(head + "\u0457 = 1\n").substr(0, 2), "4:");
  EXPECT_EQ(complaint(head + "format = \u0457\n").substr(0, 2), "4:");
  EXPECT_EQ(complaint(head + "format = '(F10)'\nfields = [{ name = 'n' }]\n"),
            "4: FORMAT (F10), character 5: a real field needs its decimals: F10.0, not F10");
  EXPECT_EQ(complaint(head + "format = '(I5)'\nfields = [{ name = 'n', kind = 'real' }]\n"),
            "4: FORMAT (I5) doesn't suit field \"n\": its kind is another");
  EXPECT_EQ(complaint(head + "format = '(I5)'\nfields = [{ name = 'n', colour = 'red' }]\n"),
            "5: unknown key \"colour\"");
  EXPECT_EQ(complaint(good + "repeat = 'b.n'\n"), "6: no card \"b\" stands before this");
  EXPECT_EQ(complaint(good + "repeat = 'a.m'\n"), "6: card \"a\" has no field \"m\"");
  EXPECT_EQ(complaint(good + "repeat = 'n +'\n").substr(0, 2), "6:");
  EXPECT_EQ(complaint(good + "repeat = 'named'\n"),
            "6: repeat = \"named\" needs cards with names (card_separator)");
  EXPECT_EQ(complaint(head + "format = '*'\nfields = [{ name = 'n' }]\n"),
            "5: a field of a list-directed card needs its kind");
  EXPECT_EQ(complaint(head + "format = '(2I5)'\nfields = [{ name = 'n' }, { name = 'n' }]\n"),
            "5: field \"n\" is named twice in card \"a\"");
  EXPECT_EQ(complaint(head + "format = '(2I5)'\nfields = [{ name = 'n', count = 2 }, { name = 'm' }]\n"),
            "5: only the last field of a card can repeat (count)");
  EXPECT_EQ(complaint(good + "[[card]]\nname = 'a'\nformat = '(I5)'\nfields = [{ name = 'n' }]\n").substr(0, 2),
            "6:");
  EXPECT_EQ(complaint(head + "format = '(I5)'\nitems = { name = 'b', count = 2, fields = [{ name = 'n', kind = "
                             "'integer' }] }\n"),
            "5: items belong to list-directed cards");
  EXPECT_EQ(complaint("name = 'x'\nblanks = 'maybe'\n[[card]]\n"), "2: blanks must be \"null\" or \"zero\"");
}

// Each of these crashed, took minutes or filled the memory.
TEST(Layout, HostileFilesMeetLimits) {
  const std::string card = "[[card]]\nname = 'a'\nformat = '(I5)'\nfields = [{ name = 'n' }]\n";
  std::string dotted = "a";
  for (int i = 0; i < 160'000; ++i) dotted += ".a";
  for (const std::string& key : {dotted + " = 1\n", "[" + dotted + "]\n", "x = { " + dotted + " = 1 }\n"})
    EXPECT_EQ(complaint("name = 'x'\n" + key), "2: a key of more than 16 parts with points between them");
  // Points in texts and comments are none of a key's.
  const std::string points(100, '.');
  EXPECT_EQ(complaint("name = '" + points + "' # " + points + "\ntitle = \"\\\"" + points +
                      "\"\nclosing = '''\n" + points + "\n" + points + "'''\n" + card),
            "");
  std::string cards = "name = 'x'\n";
  for (int i = 0; i <= 10'000; ++i)
    cards += "[[card]]\nname = 'c" + std::to_string(i) + "'\nformat = '(I5)'\nfields = [{ name = 'n' }]\n";
  EXPECT_EQ(complaint(cards), "40002: a layout has at most 10000 kinds of cards");
  std::string fields;
  for (int i = 0; i <= 1000; ++i) fields += "{ name = 'n" + std::to_string(i) + "' },";
  EXPECT_EQ(complaint("name = 'x'\n[[card]]\nname = 'a'\nformat = '(1001I5)'\nfields = [" + fields + "]\n"),
            "5: card \"a\" has more than 1000 fields");
  EXPECT_EQ(complaint(std::string(17u << 20, '#')), "0: the layout file is larger than 16 MiB");
}

TEST(Layout, ADeviceWithoutAnEndIsNoFile) {
  try {
    read_file("/dev/zero");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gives more than 256 MiB without an end"), std::string::npos);
  }
}

// A copy of the built-in layout with one mistake; the layout file's own complaint.
std::string names_complaint(const std::string& from, const std::string& to,
                            const std::string& layout = "sage1") {
  std::string toml = file_text(SAGE_SOURCE_DIR "/legacy_inputs/layouts/" + layout + ".toml");
  const std::size_t at = toml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  toml.replace(at, from.size(), to);
  try {
    load_checked_layout(toml, "my.toml");
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().list().front();
    EXPECT_EQ(d.where.file, "my.toml");
    EXPECT_GT(d.where.line, 0);
    return d.message;
  }
  return {};
}

TEST(LayoutNames, EveryBuiltInLayoutIsMeant) {
  for (const std::string& name : built_in_layouts()) {
    if (name == kWideLayout) continue;  // made from another
    const std::string file = SAGE_SOURCE_DIR "/legacy_inputs/layouts/" + name + ".toml";
    try {
      load_layout(file);
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics().list()) ADD_FAILURE() << to_string(d);
    }
  }
}

// Each of these ran with exit 0 and without its loads.
TEST(LayoutNames, ALoadIsNotLostInSilence) {
  EXPECT_EQ(names_complaint("\"y_force\"", "\"fy\""),
            "field \"fy\" of card \"load\" is used by nothing; the nearest name is \"y_force\" (or mark it: "
            "ignored = true)");
  EXPECT_EQ(names_complaint("\"y_force\"", "\"y_forse\""),
            "field \"y_forse\" of card \"load\" is used by nothing; the nearest name is \"y_force\" (or mark "
            "it: ignored = true)");
  EXPECT_EQ(names_complaint("\"y_force\",", "\"other\", ignored = true,"), "");
  EXPECT_EQ(names_complaint("name = \"normal2\",", "name = \"other\", ignored = true,"),
            "card \"pressure\" has no field \"normal2\", which it needs");
  EXPECT_EQ(names_complaint("name = \"load\"", "name = \"loads\""),
            "card \"loads\" is used by nothing; the nearest name is \"load\" (as = \"...\" renames it, ignored "
            "= true "
            "passes over it)");
  EXPECT_EQ(names_complaint("  opens = true\n", ""),
            "card \"fixity\" must belong to a card \"stage\" and belongs to card \"stage_title\": put opens = "
            "true on "
            "the \"stage\" card of its block");
}

TEST(Layout, AListMustSuitTheWholeFormat) {
  const std::string head = "name = 'x'\n[[card]]\nname = 'a'\n";
  const std::string fields = "fields = [{ name = 'n' }, { name = 'v', count = 'n' }]\n";
  EXPECT_EQ(complaint(head + "format = '(I5,(3F10.0))'\n" + fields), "");
  EXPECT_EQ(complaint(head + "format = '(I5,3F10.0)'\n" + fields),  // reversion meets I5 again
            "4: FORMAT (I5,3F10.0) doesn't suit field \"v\": its kind is another where a longer list goes on "
            "(brackets of its own, as in (I5,(10F5.0)), let it go on with itself)");
  EXPECT_EQ(complaint(head + "format = '(I5,F10.0,A3)'\n" + fields).substr(0, 2), "4:");
}

// Blocks of which nothing can be read must not be read for ever.
TEST(Layout, EmptyBlocksEnd) {
  const std::string head =
      "name = 'x'\n[[card]]\nname = 'a'\nformat = '(I5)'\nfields = [{ name = 'n' }]\n[[card]]\nblock = 'b'\n";
  const std::string inner =
      "[[card.card]]\nname = 'c'\nwhen = 'a.n > 5'\nformat = '(I5)'\nfields = [{ name = 'n' }]\n";
  const Layout counted = load_layout_text(head + "repeat = 'a.n * 100000000'\n" + inner, "my.toml");
  ReadOptions half;
  half.whole = false;  // the second line is read by nothing
  EXPECT_EQ(read_deck_text("    4\n    1\n", "deck", counted, half).cards.size(), 1u);
  const Layout until = load_layout_text(head + "until = 'c.n == 9'\n" + inner, "my.toml");
  EXPECT_THROW(read_deck_text("    4\n    1\n", "deck", until), InputError);
}

TEST(Layout, AFieldTakesItsKindFromTheFormat) {
  const Layout layout = load_layout_text(
      "name = 'x'\n[[card]]\nname = 'a'\nformat = '(I5,F10.0,A3,L1)'\n"
      "fields = [{ name = 'i' }, { name = 'r' }, { name = 't' }, { name = 'l' }]\n",
      "my.toml");
  const auto& fields = layout.cards[0].spec.fields;
  EXPECT_EQ(fields[0].kind, FieldKind::integer);
  EXPECT_EQ(fields[1].kind, FieldKind::real);
  EXPECT_EQ(fields[2].kind, FieldKind::text);
  EXPECT_EQ(fields[3].kind, FieldKind::logical);
}

TEST(Layout, IsFoundFromTheDeck) {
  EXPECT_EQ(detect_layout("Any title\nm       kN      kPa\n"), "sage1");
  EXPECT_EQ(detect_layout("* layout: sg_p61\n8 4 1\n"), "sg_p61");
  EXPECT_EQ(detect_layout("                      A-1!!ANALYS   3\n"), "cande_level3");
  EXPECT_EQ(detect_layout("test\nUNITS (E for English, S for SI):\nS\n"), "quad4m");
  EXPECT_EQ(detect_layout("'axisymmetric'\n'quadrilateral' 4 'z'\n"), "sg_p51");
  EXPECT_EQ(detect_layout(""), "sage1");
}

// docs/manual/deck_format.md is written by layout_manual: write it anew when this fails
// (SAGE_WRITE_MANUAL=1 test_deck --gtest_filter=Manual.*).
TEST(Manual, TheCommittedFileIsTheGeneratedText) {
  const std::string path = SAGE_SOURCE_DIR "/docs/manual/deck_format.md";
  const std::string manual = layout_manual(load_layout("sage1"));
  if (std::getenv("SAGE_WRITE_MANUAL")) std::ofstream(path, std::ios::binary) << manual;
  EXPECT_EQ(file_text(path), manual);
}

// Made by rule: every card of sage1, number fields of twice the width, texts as they are.  Elements and stages go
// on behind them.
TEST(WideLayout, IsSage1WithWideFields) {
  EXPECT_EQ(wide_format("(3I5,F10.0,A20)"), "(3I10,F20.0,A20)");
  EXPECT_EQ(wide_format("(A80)"), "(A80)");
  const Layout narrow = load_layout("sage1"), wide = load_layout("sage1_wide");
  ASSERT_EQ(wide.cards.size(), narrow.cards.size());
  const std::map<std::string, std::pair<std::size_t, const char*>> behind{
      {"element", {7, ",7I10"}},
      {"stage", {11, ",2F20.0,I10,2F20.0,I10,3F20.0,2A80"}},
      {"initial", {2, ",I10,A40"}},
      {"stage_initial", {2, ",I10,A40"}},
      {"stage_fixity", {4, ",A80,F20.0,2I10"}},
      {"fixity", {3, ",F20.0,2I10"}},
      {"load", {1, ",A80"}},
      {"pressure", {2, ",A20,A80"}},
      {"group", {1, ",I10"}},
      {"material", {1, ",F20.0"}}};
  for (std::size_t i = 0; i < wide.cards.size(); ++i) {
    const std::string& key = narrow.cards[i].key;
    const auto found = behind.find(key);
    const auto [more, fields] = found == behind.end() ? std::pair{std::size_t{0}, ""} : found->second;
    EXPECT_EQ(wide.cards[i].spec.fields.size(), narrow.cards[i].spec.fields.size() + more);
    std::string format = wide_format(narrow.cards[i].spec.format);
    if (more > 0) format.insert(format.size() - 1, fields);
    EXPECT_EQ(wide.cards[i].spec.format, format);
  }
  EXPECT_NE(layout_manual(wide).find("| 31-50 | `x` | real | x or radius | length |"), std::string::npos);
}

// A narrow deck is none under the wide layout, and a wide one none under the narrow: never another answer.
TEST(WideLayout, DecksOfOneAreRefusedByTheOther) {
  const Layout narrow = load_layout("sage1"), wide = load_layout("sage1_wide");
  EXPECT_THROW(read_deck_text(narrow.example, "example", wide), InputError);
  const std::string deck =
      "* layout: sage1_wide\ntitle\nm       kN      kPa\n         1         0    100000         0\n"
      "         1         0         0                 0.0                 0.5\n";
  EXPECT_EQ(recognised_layout(deck), "sage1_wide");
  EXPECT_THROW(read_deck_text(deck, "deck", narrow), InputError);
}

TEST(Manual, ColumnsFollowTheFormat) {
  const std::string manual = layout_manual(load_layout("sage1"));
  EXPECT_NE(manual.find("| 16-25 | `x` | real | x or radius | length |"), std::string::npos);
  EXPECT_NE(manual.find("| 61-65 | `total_elements` |"), std::string::npos);
}

TEST(Manual, TheExampleReadsWithoutAWord) {
  const Layout layout = load_layout("sage1");
  const Deck deck = read_deck_text(layout.example, "example", layout);
  for (const Diagnostic& d : deck.diagnostics.list()) ADD_FAILURE() << to_string(d);
  EXPECT_EQ(deck.all("node").size(), 4u);
  EXPECT_EQ(deck.one("report").real("cell_pressure"), 100.0);
}

}  // namespace
}  // namespace sage
