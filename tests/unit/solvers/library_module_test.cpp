// The module of library solvers is found where it may be, and nothing else is taken for it.
#include "solvers/library_module.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "sage/core/error.hpp"

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

TEST(LibraryModule, ListsWhatItTriedAndWhyItWasRefused) {
  try {
    load_solver_module({kNowhere, kNoLibrary, OTHER_VERSION, NO_VERSION, NO_MAKER});
    FAIL() << "loaded";
  } catch (const AnalysisError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(std::string("\n  ") + kNowhere + "\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\n  " + kNoLibrary + ": "), std::string::npos) << text;
    for (const char* other : {OTHER_VERSION, NO_VERSION, NO_MAKER})
      EXPECT_NE(text.find(std::string("\n  ") + other + ": belongs to another version"), std::string::npos)
          << text;
  }
}

}  // namespace
}  // namespace sage
