// No deck may become a model under a layout that is not its own, and decks of programs that compute something
// else are told from ours.  List-directed decks bear no marks: counts, codes and what is left over decide.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/other_programs.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

namespace fs = std::filesystem;

const fs::path kInputs = SAGE_SOURCE_DIR "/legacy_inputs";

// Small decks of programs outside of ours, written here by the record orders of their READ statements.
struct Other {
  const char *program, *text;
};

constexpr Other kOthers[] = {
    {"4.1", "4 1\n1.0e5\n.25 .25 .25 .25\n1\n5 0\n5\n1 -.625 2 -1.25 3 -1.25 4 -1.25 5 -.625\n0\n"},
    {"4.2", "3 3 2 1\n2.0e5\n0. 0. 4. 0. 4. 3.\n1 2 1 3 2 3\n2\n1 0 0 2 1 0\n1\n3 0. -10.\n0\n"},
    {"4.3", "2 1 1\n4.0e4\n2. 2.\n1\n1 0 0\n1\n3 -20. 0.\n1\n2 1 -.005\n"},
    {"4.4", "2 3 2 2 1\n5.e3 6.e3\n0. 0. 6. 0. 6. -4.\n1 2 2 3\n2\n1 0 0 1 3 0 0 0\n1\n2 0. -60. -60.\n0\n"},
    {"4.5", "2 3 1 2 1\n1.e3 5.\n0. 2. 4.\n1 2 2 3\n1\n1 0 0\n1\n3 -1. 0.\n200 1.e-5 3\n1. .5 .25\n"},
    {"4.6", "2 1 1\n1.e4\n.5 .5\n2\n1 0 1 3 0 1 100 1.e-5\n"},
    {"4.6", "2 2 2\n1.e4 8. 2.e4 8.\n1 2\n.5 .5\n1\n1 0 0 100 1.e-5\n"},
    {"4.7", "2 2 1 .25 .25 1.\n10.92 .3\n3\n1 0 0 0 1 2 0 0 1 1 3 0 0 0 1\n1\n9 .25 0. 0. 0.\n0\n"},
    {"5.3", "8 1 1 2 8 1\n100. .3\n0. .5\n0. 1.\n0. -1. -2.\n2\n3 0 0 1 4 0 0 0\n1\n1 0. 0. -1.\n0\n"},
    {"6.12", "1. 2. 1. 1. 1. 1. 2 1 1 1 1 2 1\n0. 40. 0. 20. 1.e5 .3\n.0001 500 2\n1. 2.\n"},
    {"7.1", "2 3 1\n2.e-3\n1. 1.\n1 2 2 3\n0\n2\n1 10. 3 0.\n"},
    {"7.4", "'quadrilateral' 4 1 4 4 2 1\n1. 1.\n0. 0. 1. 0. 1. 1. 0. 1.\n1 4 3 2\n1\n1 .5\n1\n3 0.\n8\n"},
    {"8.1", "2 1\n1.e-3\n.5 .5\n.01 100 .5 10 3 50\n100. 100. 100.\n1\n1 0.\n"},
    {"8.2", "2 1\n1.e-3 1.e-3 10.\n.5 .5 .01 100 .5 10 3 50\n100. 100. 100.\n1\n1 0.\n"},
    {"8.4", "'plane' 'x' 1 1 1\n1. 1.\n0. 1. 0. -1.\n.01 20 .5 1 1 20\n100. 100. 100. 100.\n1\n2 0.\n5\n"},
    {"8.3", "2 1\n1.e-3\n.5 .5 .01 100 10 3 50\n100. 100. 100.\n0\n"},
    {"8.4, 8.5 or 8.7",
     "'axisymmetric' 'y' 1 1 1\n1. 1.\n0. 1. 0. -1.\n.01 20 .5 1 1 20\n100. 100. 100. 100.\n0\n5\n"},
    {"8.8",
     "'quadrilateral' 1 4 4 4 2 1\n1. 1.\n0. 0. 1. 0. 1. 1. 0. 1.\n1 4 3 2\n.01 20 .5 1 1\n20 5\n"
     "100. 100. 100. 100.\n1\n2 0.\n"},
    {"8.8",
     "'hexahedron' 1 8 8 8 3 1\n1. 1. 1.\n0. 0. 0. 1. 0. 0. 1. 0. -1. 0. 0. -1. 0. 1. 0. 1. 1. 0. 1. 1. -1. 0. "
     "1. "
     "-1.\n1 2 3 4 5 6 7 8\n.01 20 .5 1 1\n1. 1. 1. 1. 1. 1. 1. 1.\n0\n"},
    {"8.9", "1 2 1\n1. 1.\n0. 1. 0. -1. -2.\n.01 20 .5 1 1 20 0. 1.\n5\n"},
    {"8.10", "1 2 1\n1. 1.\n0. 1. 0. -1. -2.\n.01 20 .5 1 1 20 0. 1.\n2\n1 2\n"},
    {"8.11",
     "'plane' 'x' 1 1 1\n1. 1. 2.\n0. 1. 0. -1.\n.01 20 .5 1 1 20\n1 1 5.\n1\n1 2 .5 20.\n"
     "100. 100. 100. 100.\n1\n2 0.\n5\n"},
    {"9.1", "1 1 .001 30 .01 1.\n0. 1. 0. -1.\n2\n1 0 1 0 3 1 0 1\n1\n2 1 1.\n"},
    {"9.3", "2 1\n1. 1.\n.5 .5\n.1 20 .5 1 2 10\n2\n1 1 0 3 0 1\n1\n1 -1.\n2\n0. 0. 100. 1.\n"},
    {"10.1", "2 1\n.0833 1.\n.5 .5\n1\n1 0 0\n3\n"},
    {"10.2", "2 1 8 1\n1. .3 1.\n0. 1. 2. 0. -1.\n3\n1 0 0 2 0 0 3 0 0\n4\n"},
    {"10.4", "2 1 4 1\n1. .3 1.\n0. 1. 2. 0. -1.\n2\n1 0 0 2 0 0\n2 5 'I' 'LM' 1.e-5 300\n"},
    {"11.1", "1 1\n3.194 3.194e-2\n1. 1. .25 .5 0. 0.\n1\n1 0 0\n1\n2 1 2\n0. 1. 10. 1.\n1\n2 1\n"},
    {"11.2", "1 2 4 1\n1. .3 1.\n0. 1. 0. -1. -2. 1. 20 1 5 .05\n2\n1 0 0 2 0 0\n3 .3\n"},
    {"11.3", "1 2 1\n1. .3 1.\n0. 1. 0. -1. -2. 1. 20 .5 1 5 .005 .272\n2\n1 0 0 2 0 0\n1\n13 0. 1.\n"},
    {"11.5", "1 2 1\n1. .3 1. .05\n0. 1. 0. -1. -2. 1. 20 1 5\n2\n1 0 0 2 0 0\n"},
    {"11.6", "1 2 1\n1. .3 1.\n0. 1. 0. -1. -2. .5 20 .25 .5 1 5\n2\n1 0 0 2 0 0\n'c' 'l'\n"},
    {"11.7",
     "1 2 .0001 100 1\n1. .3 1.\n0. 1. 0. -1. -2. 1. 20 .5 1 5 .005 .272\n2\n1 0 0 2 0 0\n1\n13 0. 1.\n"},
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool becomes_a_model(const std::string& text, const std::string& layout) {
  static const Catalogue catalogue = full_catalogue();
  BuildOptions options;
  options.partial = true;  // parts that are left out are no reason here
  try {
    build_model(read_deck_text(text, "deck", load_layout(layout)), catalogue, options);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

// "smith_griffiths/p61.dat" -> "sg_p61", "quad4m/..." -> "quad4m", all others are sage1.
std::string own_layout(const fs::path& deck) {
  const std::string folder = fs::relative(deck, kInputs).begin()->string(), stem = deck.stem().string();
  if (folder == "smith_griffiths") return "sg_" + stem.substr(0, stem.find('_'));
  const std::vector<std::string> names = built_in_layouts();
  return std::find(names.begin(), names.end(), folder) != names.end() ? folder : "sage1";
}

std::vector<fs::path> decks() {
  std::vector<fs::path> all;
  for (const auto& entry : fs::recursive_directory_iterator(kInputs)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".dat" || ending == ".cid" || ending == ".Q4I") all.push_back(entry.path());
  }
  return all;
}

TEST(WrongLayout, NoDeckBecomesAModelUnderIt) {
  const std::vector<fs::path> all = decks();
  EXPECT_GE(all.size(), 40u);
  std::size_t own = 0;
  for (const fs::path& deck : all) {
    const std::string text = text_of(deck);
    for (const std::string& layout : built_in_layouts()) {
      const bool model = becomes_a_model(text, layout);
      if (layout == own_layout(deck))
        own += model ? 1 : 0;
      else
        EXPECT_FALSE(model) << deck << " under " << layout;
    }
  }
  EXPECT_GE(own, 30u);
}

TEST(WrongLayout, DecksOfOtherProgramsAreNone) {
  for (const Other& other : kOthers)
    for (const std::string& layout : built_in_layouts())
      EXPECT_FALSE(becomes_a_model(other.text, layout)) << other.program << " under " << layout;
}

TEST(OtherPrograms, AreKnownByHowTheyRead) {
  for (const Other& other : kOthers)
    EXPECT_TRUE(
        other_program(SourceText(other.text, "deck")).starts_with(std::string("program ") + other.program))
        << other.program << ": " << other_program(SourceText(other.text, "deck"));
  for (const fs::path& deck : decks()) EXPECT_EQ(other_program(SourceText(text_of(deck), "deck")), "") << deck;
  // One number more or less is no such deck.
  const std::string rods = kOthers[0].text;
  EXPECT_EQ(other_program(SourceText(rods + "1\n", "deck")), "");
  EXPECT_EQ(other_program(SourceText(rods.substr(0, rods.size() - 2), "deck")), "");
}

// Where the deck's first word is that of a layout, too.
TEST(OtherPrograms, AreRefusedByWhatTheyAre) {
  const fs::path path = test::scratch_folder("other_programs") / "deck.dat";
  for (const Other& other : kOthers) {
    std::ofstream(path) << other.text;
    try {
      read_deck(path.string());
      ADD_FAILURE() << other.program << " was read";
    } catch (const InputError& error) {
      const std::string& message = error.diagnostics().list().front().message;
      EXPECT_NE(message.find(std::string("program ") + other.program), std::string::npos) << message;
      // Bars, beams and steady flow are computed here, and no layout reads those decks.
      const std::string program = other.program;
      const bool computed = program.starts_with("7.") || (program.starts_with("4.") && program < "4.5");
      EXPECT_EQ(message.find("outside of what this program does") == std::string::npos, computed) << message;
      EXPECT_EQ(message.find("which no layout reads") != std::string::npos, computed) << message;
    }
  }
}

}  // namespace
}  // namespace sage::app
