// docs/manual/own_layout.md: its code is what a reader types, and its answers are what he gets.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

struct Block {
  std::string kind, text;
  int line = 0;
};

// What stands between ``` lines.
std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream in(page);
  std::string line;
  bool inside = false;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), "", number});
    } else if (inside) {
      blocks.back().text += line + '\n';
    }
  }
  return blocks;
}

// Each line of the page stands in the answer, in this order; "..." is any number of others.
void expect_lines(const std::vector<std::string>& wanted, const std::string& answer, int page_line) {
  std::istringstream in(answer);
  std::string line;
  bool skips = false;
  for (const std::string& one : wanted) {
    if (one == "...") {
      skips = true;
      continue;
    }
    bool found = false;
    while (!found && std::getline(in, line)) {
      found = line == one;
      if (!found && !skips) break;
    }
    ASSERT_TRUE(found) << "own_layout.md, line " << page_line << " and behind: no \"" << one << "\" in\n"
                       << answer;
    skips = false;
  }
}

// "$ sagefe ..." and the answer that the page shows.
void run_console(const std::filesystem::path& folder, const Block& block) {
  std::istringstream in(block.text);
  std::string line, answer;
  std::vector<std::string> wanted;
  int number = block.line;
  const auto compare = [&] {
    if (!answer.empty()) expect_lines(wanted, answer, number);
    wanted.clear();
  };
  while (std::getline(in, line)) {
    if (line.rfind("$ sagefe ", 0) != 0) {
      wanted.push_back(line);
      continue;
    }
    compare();
    const Finished finished = sagefe(folder, line.substr(9));
    EXPECT_EQ(finished.exit_code, 0) << line << '\n' << finished.err;
    answer = finished.out + finished.err;
  }
  compare();
}

TEST(OwnLayout, EveryStepOfThePageRuns) {
  const std::filesystem::path folder = empty_folder("own_layout");
  std::string layout;
  int decks = 0, tomls = 0, runs = 0;
  for (const Block& block : blocks_of(read(std::string(SAGE_SOURCE_DIR) + "/docs/manual/own_layout.md"))) {
    if (const std::size_t blank = block.kind.find(' '); blank != std::string::npos) {
      write(folder / block.kind.substr(blank + 1), block.text);  // of another program
    } else if (block.kind == "deck") {
      write(folder / "deck.dat", block.text);
      ++decks;
    } else if (block.kind == "toml") {
      layout += block.text + '\n';
      write(folder / "bank.toml", layout);
      ++tomls;
    } else if (block.kind == "console") {
      run_console(folder, block);
      ++runs;
    } else {
      ADD_FAILURE() << "own_layout.md, line " << block.line << ": a block of unknown kind " << block.kind;
    }
  }
  // Confined compression: 2 kgf/cm2 on 200 cm of either soil, M = E (1 - nu) / ((1 + nu) (1 - 2 nu)).
  const double top = 2.0 * 200.0 * (1.3 * 0.4 / 0.7) * (1.0 / 100.0 + 1.0 / 200.0);
  const std::string report = read(folder / "out" / "deck.report1.csv");
  const std::size_t last = report.rfind("3,1,");
  ASSERT_NE(last, std::string::npos) << report;
  EXPECT_NEAR(std::stod(report.substr(report.find(',', last + 4) + 1)), -top, 1e-9 * top) << report;
  EXPECT_EQ(decks, 1);
  EXPECT_EQ(tomls, 7);
  EXPECT_GE(runs, 7);
  EXPECT_EQ(sagefe(folder, "check deck.dat --layout bank.toml --strict").exit_code, 0);
}

// Section 7: 10 psi on 20 in, E = 1000 psi, nu = .3; in m and kPa by the definitions of the inch and the pound.
TEST(OwnLayout, TheSecondProgramIsConverted) {
  const std::filesystem::path folder = empty_folder("own_layout_units");
  for (const Block& block : blocks_of(read(std::string(SAGE_SOURCE_DIR) + "/docs/manual/own_layout.md")))
    if (const std::size_t blank = block.kind.find(' '); blank != std::string::npos)
      write(folder / block.kind.substr(blank + 1), block.text);
  const Finished run = sagefe(folder, "run strip.dat --layout strip.toml -o out");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const double inch = 0.0254, kpa_in_psi = 0.45359237 * 9.80665 / (inch * inch) / 1000.0;
  const auto value = [&](const char* file, int column) {
    const std::string report = read(folder / "out" / file);
    std::size_t at = report.rfind("\n1,1,") + 1;
    for (int i = 1; i < column; ++i) at = report.find(',', at) + 1;
    return std::stod(report.substr(at));
  };
  const double top = 10.0 * 20.0 * (1.3 * 0.4 / 0.7) / 1000.0 * inch;
  EXPECT_NEAR(value("strip.report1.csv", 4), -top, 1e-9 * top);  // the layout's factors have ten digits
  EXPECT_NEAR(value("strip.report1.csv", 6), -200.0 * kpa_in_psi * inch, 1e-7);
  EXPECT_NEAR(value("strip.report2.csv", 10), 10.0 * kpa_in_psi, 1e-7);
  EXPECT_EQ(sagefe(folder, "check strip.dat --layout strip.toml --strict").exit_code, 0);
}

// A layout file that the first line names: beside the deck, or in the folder of the command.
TEST(OwnLayout, ADeckNamesItsLayoutFile) {
  const std::filesystem::path folder = empty_folder("own_layout_named");
  std::filesystem::create_directory(folder / "sub");
  const std::regex comment("(^|\n)C ");
  for (const Block& block : blocks_of(read(std::string(SAGE_SOURCE_DIR) + "/docs/manual/own_layout.md")))
    if (block.kind == "toml strip.toml")
      write(folder / "sub/strip.toml",
            std::regex_replace(block.text, std::regex("comment = \"C\""), "comment = \"*\""));
    else if (block.kind == "deck strip.dat")
      write(folder / "sub/strip.dat",
            "* layout: strip.toml\n" + std::regex_replace(block.text, comment, "$1* "));
  const Finished beside = sagefe(folder, "check sub/strip.dat");
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  std::filesystem::rename(folder / "sub/strip.toml", folder / "strip.toml");
  const Finished here = sagefe(folder, "check sub/strip.dat");
  EXPECT_EQ(here.exit_code, 0) << here.err;
  std::filesystem::remove(folder / "strip.toml");
  const Finished nowhere = sagefe(folder, "check sub/strip.dat");
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_TRUE(nowhere.err.starts_with("sub/strip.dat:1: error: the layout strip.toml that this line names"))
      << nowhere.err;
}

}  // namespace
}  // namespace sage::test
