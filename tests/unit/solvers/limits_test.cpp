// Sizes that no index or memory holds are refused by name, before anything overflows, and work of several
// threads that fails tells its first failure.
#include <atomic>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "sage/conformance/solver_systems.hpp"
#include "sage/messages/error.hpp"
#include "sage/platform/thread_pool.hpp"
#include "solvers/aligned_array.hpp"
#include "solvers/front_tree.hpp"
#include "solvers/matrix_solver.hpp"
#include "solvers/register_solvers.hpp"
#include "solvers/tile_profile.hpp"

namespace sage::test {

using namespace conformance;

namespace {

// `equations` equations that all meet one another, as one element that has them all would make them.
EquationGraph dense_graph(int equations) {
  EquationGraph graph;
  graph.group_of.assign(equations, 0);
  for (int i = 0; i < equations; ++i) graph.members.item.push_back(i);
  graph.members.start = {0, equations};
  graph.neighbours.start = {0, 0};
  return graph;
}

template <class Call>
std::string length_error_of(const Call& call) {
  try {
    call();
  } catch (const std::length_error& error) {
    return error.what();
  }
  return "no length_error";
}

TEST(SolverLimits, AnArrayLargerThanTheAddressSpaceIsBadAlloc) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer ends a program that asks for so much";
#endif
  EXPECT_THROW(AlignedArray(std::size_t{1} << 52), std::bad_alloc);
  EXPECT_EQ(AlignedArray(0).size(), 0u);
}

TEST(SolverLimits, AFrontOfMoreThan2To31TermsIsRefused) {
  const AssembledMatrix matrix;
  EXPECT_EQ(length_error_of([&] { make_front_tree(dense_graph(60000), matrix, 16, 1); }),
            "a front of the matrix has more than 2^31 terms");
}

TEST(SolverLimits, AProfileOfMoreThan2To31TermsIsRefused) {
  TileProfile profile;
  profile.offset = {0, std::int64_t{1} << 31};
  EXPECT_EQ(length_error_of([&] { make_tile_scatter(profile, AssembledMatrix()); }),
            "the profile has more than 2^31 terms: choose a sparse solver");
}

TEST(SolverLimits, AMatrixWithoutEquationsHasNoLargestTerm) {
  EXPECT_EQ(PivotCheck("", {}).largest_term(), 0.0);
}

// Index 0 waits until index 1 has failed and the same thread is at index 2: its failure comes last, and counts.
TEST(ThreadPool, AFailureThatComesLaterButHasASmallerIndexCounts) {
  ThreadPool pool(2);
  std::atomic<bool> failed{false};
  const auto work = [&](int index, int) {
    if (index == 2) failed = true;
    if (index == 0)
      while (!failed) std::this_thread::yield();
    if (index < 2) throw std::out_of_range(std::to_string(index));
  };
  try {
    pool.run(3, work);
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "0");
  }
}

// One solver, made to work with more and fewer threads: every analysis takes the number that holds then.
TEST(Frontal, TakesAnotherNumberOfThreadsAtTheNextAnalysis) {
  Catalogue catalogue;
  register_solvers(catalogue);
  const System system = q4_mesh({.columns = 70, .rows = 90});
  const std::vector<double> b(static_cast<std::size_t>(system.equations), 1.0);
  for (const auto& [code, entry] : catalogue.solvers.entries()) {
    if (!entry.name.starts_with("frontal")) continue;
    const auto solver = entry.make();
    std::vector<double> first, x(b.size());
    for (const int threads : {2, 2, 3, 1}) {
      solver->configure({.threads = threads});
      load(*solver, system);
      solver->factorise();
      EXPECT_EQ(solver->solve(b, x), SolveStatus::ok);
      if (first.empty()) first = x;
      EXPECT_EQ(x, first) << entry.name << ", " << threads << " threads";
    }
  }
}

std::unique_ptr<LinearSolver> make(const char* name) {
  Catalogue catalogue;
  register_solvers(catalogue);
  for (const auto& [code, entry] : catalogue.solvers.entries())
    if (entry.name == name) return entry.make();
  throw std::out_of_range(name);
}

// Nothing to solve, and nothing to solve for.
TEST(Refinement, OfNothingIsNothing) {
  for (const char* name : {"skyline_lu", "skyline_ldlt", "frontal", "frontal_ldlt"}) {
    const auto solver = make(name);
    solver->configure({.refinement_steps = 3});
    System empty;
    add_spring(empty, -1, -1, 4.0);
    load(*solver, empty);
    solver->factorise();
    EXPECT_EQ(solver->solve({}, {}), SolveStatus::ok);
    const System system = q4_mesh({.columns = 3, .rows = 3});
    load(*solver, system);
    solver->factorise();
    const std::vector<double> b(static_cast<std::size_t>(system.equations), 0.0);
    std::vector<double> x(b.size(), 1.0);
    EXPECT_EQ(solver->solve(b, x), SolveStatus::ok);
    EXPECT_EQ(x, b) << name;
    EXPECT_EQ(solver->report().backward_error, 0.0) << name;
  }
}

// [d A; A d] with d = 1e-12 and Hilbert's A: without pivoting the first half of the elimination leaves A A / d,
// with the square of A's condition: 3e5 for three rows, 2e14 for six.  The answer is right, or the status says that it
// is not.
TEST(Refinement, AnAnswerThatItCanNotMendIsInaccurate) {
  for (const char* name : {"skyline_lu", "skyline_ldlt", "frontal", "frontal_ldlt"})
    for (const int half : {2, 3, 6, 7}) {
      SCOPED_TRACE(name + std::to_string(half));
      const int n = 2 * half;
      Eigen::MatrixXd K = 1e-12 * Eigen::MatrixXd::Identity(n, n);
      for (int i = 0; i < half; ++i)
        for (int j = 0; j < half; ++j) K(i, half + j) = K(half + i, j) = 1.0 / (i + j + 1);
      std::vector<int> equations(static_cast<std::size_t>(n));
      std::iota(equations.begin(), equations.end(), 0);
      System system;
      system.equations = n;
      system.add_element(equations, K);
      const Eigen::VectorXd b = Eigen::VectorXd::Ones(n), expected = K.fullPivLu().solve(b);
      std::vector<double> x(equations.size());
      const auto solver = make(name);
      load(*solver, system);
      solver->factorise();
      const SolveStatus status = solver->solve({b.data(), x.size()}, x);
      EXPECT_EQ(status, half <= 3 ? SolveStatus::ok : SolveStatus::inaccurate);
      EXPECT_EQ(solver->report().backward_error > 1e-10, status == SolveStatus::inaccurate);
      if (status == SolveStatus::ok) {
        EXPECT_LE((Eigen::Map<Eigen::VectorXd>(x.data(), n) - expected).norm(), 1e-12 * expected.norm());
      }
    }
}

// Large and indefinite, twice: what was made ready for the first factorisation serves the second.
TEST(Cholmod, FactorisesALargeIndefiniteMatrixAgain) {
  System system = q4_mesh({.columns = 40, .rows = 40});
  for (std::size_t e = 0; e < system.K.size(); e += 7) system.K[e] *= -0.5;
  const auto solver = make("cholmod");
  const std::vector<double> b(static_cast<std::size_t>(system.equations), 1.0);
  std::vector<double> x(b.size()), r(b.size());
  load(*solver, system);
  for (const double scale : {1.0, 2.0}) {
    solver->clear();
    for (int e = 0; e < system.elements.count(); ++e) {
      const Eigen::MatrixXd K = scale * system.K[e];
      solver->add(e, K.data());
    }
    solver->factorise();
    EXPECT_GT(solver->report().negative_pivots, 0);
    EXPECT_EQ(solver->solve(b, x), SolveStatus::ok);
    offered_by<KeptMatrix>(*solver).multiply(x, r);
    for (std::size_t i = 0; i < r.size(); ++i) EXPECT_NEAR(r[i], 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace sage::test
