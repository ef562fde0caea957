// Decks of other programs and files that are no decks, as the command line meets them.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

const std::string kInputs = SAGE_SOURCE_DIR "/legacy_inputs/";

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in\n" << text;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// A soil is missing: no answer without a word from the user, and then the line that
// says how the run ended says what it is without.
TEST(ForeignDecks, CandeWithoutItsSoil) {
  const fs::path folder = empty_folder("cande");
  const std::string deck = (folder / "candejar_input_test1.cid").string();
  std::string text = read(kInputs + "cande_level3/candejar_input_test1.cid");
  const std::size_t name = text.find("115CL90");
  ASSERT_NE(name, std::string::npos);
  text.replace(name, 7, "115CX90");  // a name that no table has
  std::ofstream(deck) << text;
  for (const char* command : {"run ", "check ", "compare --both ", "run --converge 1e-2 "}) {
    const Finished refused = sagefe(folder, command + deck);
    EXPECT_EQ(refused.exit_code, 2) << command;
    expect_words(refused.err, {"material 2 (CX90)", "--partial"});
  }
  const Finished converted = sagefe(folder, "convert " + deck + " pipe.dat");
  EXPECT_EQ(converted.exit_code, 2);
  EXPECT_FALSE(fs::exists(folder / "pipe.dat"));

  const Finished run = sagefe(folder, "run --partial -o out " + deck);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::size_t status = run.out.find("  status ");
  ASSERT_NE(status, std::string::npos) << run.out;
  expect_words(first_line(run.out.substr(status)), {"PARTIAL: left out", "material 2 (CX90)"});
  EXPECT_EQ(run.out.find("completed: every"), std::string::npos) << run.out;
  expect_words(read(folder / "out" / "candejar_input_test1.lst"), {"RUN COMPLETED, BUT PARTIAL: left out"});
  expect_words(first_line(read(folder / "out" / "candejar_input_test1.increments.csv")), {"PARTIAL: "});
  const Finished checked = sagefe(folder, "check --partial " + deck);
  EXPECT_EQ(checked.exit_code, 0);
  expect_words(checked.out, {"ready to run, but PARTIAL: left out"});
  // The new deck can't be refused any more: its title tells.
  EXPECT_EQ(sagefe(folder, "convert --partial " + deck + " pipe.dat").exit_code, 0);
  expect_words(read(folder / "pipe.dat").substr(0, 60), {"PARTIAL: "});
}

// Decks of Smith and Griffiths bear no marks; as sage1 they are nonsense from the second line on.
TEST(ForeignDecks, ThatNoLayoutFitsAreToldSoFirst) {
  const fs::path folder = empty_folder("no_layout");
  for (const char* name : {"p52", "p61", "p611_1", "p63", "p66", "p68", "p69"}) {
    const Finished run = sagefe(folder, "run " + kInputs + "smith_griffiths/" + name + ".dat");
    EXPECT_EQ(run.exit_code, 2) << name;
    const std::string program = std::string(name).substr(0, std::string(name).find('_'));
    expect_words(first_line(run.err), {"error: the deck has the marks of no layout", "--layout",
                                       "without a mistake it reads as", ("sg_" + program).c_str()});
    EXPECT_EQ(count(run.err, "error:"), 1) << run.err;  // none of those as sage1
    // With its layout it is an ordinary deck, with mistakes of its own.
    const Finished known =
        sagefe(folder, "check --layout sg_" + program + " " + kInputs + "smith_griffiths/" + name + ".dat");
    EXPECT_EQ(known.err.find("no layout fits"), std::string::npos);
  }
  // Text of all kinds, and decks of programs that have no layout here.
  const std::pair<const char*, const char*> texts[] = {
      {"page.md", "# Notes\n\nsome words\n- a list\n"},
      {"mesh.inp", "*HEADING\n plate\n*NODE\n1, 0., 0.\n2, 1., 0.\n"},
      {"truss.dat", "4 2 2 1 2 1 1 1 2\n2.0e5  1.0e5\n1.0 2.0\n0.5\n"},
      {"feap.dat", "feap * * plate\n4,1,1,2,2,4\ncoor\n1,1,0.,0.\n2,0,1.,0.\n"},
  };
  for (const auto& [name, text] : texts) {
    write(folder / name, text);
    const Finished run = sagefe(folder, std::string("check ") + name);
    EXPECT_EQ(run.exit_code, 2) << name;
    expect_words(first_line(run.err),
                 {name, "error: no layout fits this deck", "--layout NAME", "quad4m", "sagefe layout guess "});
  }
  // Whose first cards might be those of sage1, with a card missing: its mistakes, and the layouts behind them.
  const std::pair<const char*, const char*> doubtful[] = {
      {"numbers.dat", "A PLATE\n    4    1    1\n         0         0\n         1         0\n"},
      {"sap.dat",
       "SAP IV DAM\n    4    1    1    0    0    0    0\n    1    0    0    1    1    1    1       0.0\n"},
      {"words.dat", "some words\nand more of them\n"},
      {"word.dat", "word\n"},
  };
  for (const auto& [name, text] : doubtful) {
    write(folder / name, text);
    const Finished run = sagefe(folder, std::string("check ") + name);
    EXPECT_EQ(run.exit_code, 2) << name;
    expect_words(run.err, {"read as sage1", "--layout NAME", "quad4m",
                           (std::string("sagefe layout guess ") + name).c_str()});
  }
}

// One or two slips on a card, or many further down, are a sage1 deck with mistakes: those are what to see.
TEST(ForeignDecks, AStandardDeckWithMistakesIsStillOne) {
  const fs::path folder = empty_folder("own_mistakes");
  const std::string text = block_deck().text();
  const std::size_t control = text.find('\n', text.find('\n') + 1) + 1;
  std::string slip = text;
  slip.replace(control, 5, "    x");
  write(folder / "slip.dat", slip);
  std::string later = text;
  for (std::size_t at = later.find('\n', control) + 1; at < later.size(); at = later.find('\n', at) + 1) {
    if (later[at] == ' ') later[at] = '?';
    if (later.find('\n', at) == std::string::npos) break;
  }
  write(folder / "later.dat", later);
  for (const char* name : {"slip.dat", "later.dat"}) {
    const Finished run = sagefe(folder, std::string("check ") + name);
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_EQ(run.err.find("no layout fits"), std::string::npos) << run.err;
    // The first cards of the second deck are those of sage1.
    EXPECT_EQ(run.err.find("read as sage1") != std::string::npos, std::string(name) == "slip.dat") << run.err;
  }
}

TEST(ForeignDecks, FilesOfAnotherKindAreNoDecks) {
  const fs::path folder = empty_folder("no_decks");
  std::string noise;
  for (unsigned i = 0, x = 12345; i < 4000; ++i) {
    x = x * 1664525u + 1013904223u;
    noise += static_cast<char>(1 + (x >> 24) % 255);  // no NUL
  }
  const std::pair<std::string, const char*> files[] = {
      {"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n1 0 obj\n", "a PDF document"},
      {"\n<!DOCTYPE HTML>\n<html><body>deck</body></html>\n", "an HTML page"},
      {"<HTML>\n<pre>\n", "an HTML page"},
      {"<?xml version=\"1.0\"?>\n<deck/>\n", "an XML file"},
      {std::string("PK\x03\x04") + noise, "a ZIP archive"},
      {std::string("\x1f\x8b\x08") + noise, "gzip"},
      {"title\n" + noise, "binary"},
      {std::string("title\nm\0kN", 10), "binary"},
  };
  for (const auto& [bytes, kind] : files)
    for (const char* layout : {"", "--layout sg_p61 "}) {
      write(folder / "file.dat", bytes);
      const Finished run = sagefe(folder, std::string("run ") + layout + "file.dat");
      EXPECT_EQ(run.exit_code, 2) << kind;
      expect_words(run.err, {"file.dat: error: the file is ", kind, "not a deck of cards"});
      EXPECT_EQ(count(run.err, "error:"), 1) << run.err;
    }
  // A page break or a stray control character in a title is no reason.
  std::string deck = block_deck().text();
  deck.insert(3, "\f\x01");
  write(folder / "deck.dat", deck);
  EXPECT_EQ(sagefe(folder, "check deck.dat").exit_code, 0);
}

}  // namespace
}  // namespace sage::test
