// A solver that runs out of memory says so: it never returns an answer.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "sage/conformance/solver_systems.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::test {

using namespace conformance;

namespace {

// Pages that the process has, by the first number of /proc/self/statm, in bytes.
rlim_t address_space() {
  long pages = 0;
  if (FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * 4096;
}

// Ends the process: 0 = bad_alloc, 1 = an answer, 2 = something else.
[[noreturn]] void run_short_of_memory(const SolverEntry& entry, const System& warm_up, const System& system) {
  int outcome = 2;
  try {
    const auto first = entry.make();  // libraries take their own buffers here
    load(*first, warm_up);
    first->factorise();
    const auto solver = entry.make();
    const rlim_t limit = address_space() + 8 * 1024 * 1024;
    const rlimit few{limit, limit};
    setrlimit(RLIMIT_AS, &few);
    load(*solver, system);
    solver->factorise();
    outcome = 1;
  } catch (const std::bad_alloc&) {
    outcome = 0;
  } catch (...) {
  }
  std::_Exit(outcome);
}

TEST(SolverMemory, ExhaustionThrowsInEverySolver) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer reserves the address space";
#endif
  GTEST_FLAG_SET(death_test_style, "fast");
  Catalogue catalogue;
  register_solvers(catalogue);
  const System warm_up = q4_mesh({.columns = 40, .rows = 40});
  const System system = q4_mesh({.columns = 120, .rows = 120});
  for (const auto& [code, entry] : catalogue.solvers.entries())
    EXPECT_EXIT(run_short_of_memory(entry, warm_up, system), testing::ExitedWithCode(0), "") << entry.name;
}

}  // namespace
}  // namespace sage::test
