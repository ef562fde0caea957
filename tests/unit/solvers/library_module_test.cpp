// The module of library solvers is found where it may be, and nothing else is taken for it.
#include "solvers/library_module.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "sage/core/error.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

constexpr char kNowhere[] = "/nowhere/libsage_library_solvers.so";
const std::string kNoLibrary = __FILE__;

TEST(LibraryModule, RefusesANameItDoesNotKnow) {
  EXPECT_THROW(make_library_solver("pardiso"), AnalysisError);
}

TEST(LibraryModule, ThePlaceThatTheUserNamesComesFirst) {
  unsetenv("SAGE_SOLVER_MODULE");
  const std::vector<std::string> usual = solver_module_places();
  EXPECT_GE(usual.size(), 2u);
  setenv("SAGE_SOLVER_MODULE", kNowhere, 1);
  std::vector<std::string> places = solver_module_places();
  unsetenv("SAGE_SOLVER_MODULE");
  EXPECT_EQ(places.front(), kNowhere);
  places.erase(places.begin());
  EXPECT_EQ(places, usual);
}

// A file that is not there, one that is no library, libraries without one or both of the functions, and a
// module of another version stand before the right one.
TEST(LibraryModule, PassesOverWhatIsNotTheModule) {
  std::vector<std::string> places{kNowhere, kNoLibrary, OTHER_VERSION, NO_VERSION, NO_MAKER};
  const std::vector<std::string> usual = solver_module_places();
  places.insert(places.end(), usual.begin(), usual.end());
  const std::unique_ptr<LinearSolver> solver(load_solver_module(places)("umfpack"));
  ASSERT_NE(solver, nullptr);
  EXPECT_EQ(solver->traits().name, "umfpack");
}

// The version is read in the file: nothing of a module that does not belong here runs.
TEST(LibraryModule, RunsNothingOfAForeignModule) {
  unsetenv("SAGE_FOREIGN_MODULE_RAN");
  EXPECT_THROW(load_solver_module({OTHER_VERSION, NO_VERSION}), AnalysisError);
  EXPECT_EQ(std::getenv("SAGE_FOREIGN_MODULE_RAN"), nullptr);
}

TEST(LibraryModule, ListsWhatItTriedAndWhyItWasRefused) {
  try {
    load_solver_module({kNowhere, kNoLibrary, OTHER_VERSION, NO_VERSION, NO_MAKER});
    FAIL() << "loaded";
  } catch (const AnalysisError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(std::string("\n  ") + kNowhere + "\n"), std::string::npos) << text;
    for (const std::string& other : {kNoLibrary, std::string(OTHER_VERSION), std::string(NO_VERSION)})
      EXPECT_NE(text.find("\n  " + other + ": belongs to another version"), std::string::npos) << text;
    EXPECT_NE(text.find(std::string("\n  ") + NO_MAKER + ": has no sage_make_library_solver"),
              std::string::npos)
        << text;
  }
}

// A file that is cut short, or whose tables point beyond its end, has no sections.
TEST(LibraryModule, ReadsDamagedFilesAsFilesWithoutSections) {
  std::ifstream in(OTHER_VERSION, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(elf_section(OTHER_VERSION, SAGE_SOLVER_MODULE_SECTION), std::string("sage-solvers-0\0", 15));
  EXPECT_EQ(elf_section(OTHER_VERSION, ".no_such_section"), "");
  const std::filesystem::path file = test::scratch_folder("elf") / "damaged.so";
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged = whole;
    if (trial % 2 == 0) damaged.resize(random() % whole.size());
    for (std::size_t at = trial % 2 == 0 ? 64 : 16; at < 64; ++at)
      if (random() % 8 == 0 && at < damaged.size()) damaged[at] = static_cast<char>(random());
    std::ofstream(file, std::ios::binary) << damaged;
    const std::string section = elf_section(file, SAGE_SOLVER_MODULE_SECTION);
    EXPECT_TRUE(section.empty() || section.size() == 15 || trial % 2 == 1) << trial;
  }
}

}  // namespace
}  // namespace sage
