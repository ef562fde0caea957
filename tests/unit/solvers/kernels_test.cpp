// Kernels for other processors: the bits are those of AVX2.
#include "solvers/choose_kernels.hpp"

#include <gtest/gtest.h>

#include <span>

#include "sage/conformance/solver_systems.hpp"
#include "sage/core/catalogue.hpp"
#include "sage/messages/error.hpp"
#include "solvers/frontal.hpp"
#include "solvers/skyline.hpp"

namespace sage::test {

using namespace conformance;

namespace {

using Eigen::VectorXd;

std::span<double> span_of(VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// All that a solver computes of one matrix.
struct Answers {
  VectorXd x, transposed, eliminated, filled;
  Eigen::MatrixXd border;
  FactorReport report;
};

Answers answers(const SolverEntry& entry, const System& system, int border, int threads, Kernels kernels) {
  const auto solver = entry.make();
  solver->configure({.threads = threads, .kernels = kernels});
  EXPECT_TRUE(border == 0 || offered_by<BorderSolver>(*solver).set_border(border));
  load(*solver, system);
  EXPECT_EQ(solver->report().kernels, choose_kernels(kernels).name);
  solver->factorise();
  Answers a;
  VectorXd b = VectorXd::LinSpaced(system.equations, 1.0, 50.0).array().sin();
  for (VectorXd* x : {&a.x, &a.transposed, &a.eliminated}) x->setZero(system.equations);
  if (border > 0) {
    a.border.resize(border, border);
    const auto& with_border = offered_by<BorderSolver>(*solver);
    with_border.border_matrix(a.border.data());
    with_border.eliminate(span_of(b), span_of(a.eliminated));
    a.filled = a.eliminated;
    with_border.recover(span_of(a.filled));
  } else {
    EXPECT_EQ(solver->solve(span_of(b), span_of(a.x)), SolveStatus::ok);
    offered_by<KeptMatrix>(*solver).solve_transposed(span_of(b), span_of(a.transposed));
  }
  a.report = solver->report();
  return a;
}

void expect_same(const Answers& a, const Answers& b) {
  EXPECT_TRUE(a.x == b.x && a.transposed == b.transposed);
  EXPECT_TRUE(a.border == b.border && a.eliminated == b.eliminated && a.filled == b.filled);
  EXPECT_EQ(a.report.smallest_pivot_ratio, b.report.smallest_pivot_ratio);
  EXPECT_EQ(a.report.growth, b.report.growth);
  EXPECT_EQ(a.report.negative_pivots, b.report.negative_pivots);
}

std::vector<SolverEntry> own_solvers() {
  return {{"skyline_lu", "", false, make_skyline_lu},
          {"skyline_ldlt", "", true, make_skyline_ldlt},
          {"frontal", "", false, make_frontal},
          {"frontal_ldlt", "", true, make_frontal_ldlt}};
}

// A change of units is no growth of terms: what fills up the last tile does not count.
TEST(Kernels, GrowthHasNoUnit) {
  const System system = q4_mesh({.columns = 3, .rows = 3});
  ASSERT_NE(system.equations % 8, 0);
  for (const SolverEntry& entry : own_solvers())
    for (const double unit : {0x1p-60, 0x1p60}) {
      SCOPED_TRACE(entry.name);
      System other = system;
      for (Eigen::MatrixXd& K : other.K) K *= unit;
      EXPECT_EQ(answers(entry, other, 0, 1, Kernels::automatic).report.growth,
                answers(entry, system, 0, 1, Kernels::automatic).report.growth);
    }
}

// Matrices whose last tiles are full and not, borders of any width, and a mesh that several threads share.
TEST(Kernels, Avx512HasTheBitsOfAvx2) {
  for (const Kernels kernels : {Kernels::avx2, Kernels::avx512})
    if (const std::string why = why_no_kernels(kernels); !why.empty()) GTEST_SKIP() << why;
  for (const SolverEntry& entry : own_solvers()) {
    SCOPED_TRACE(entry.name);
    const double share = entry.symmetric ? 0.0 : 0.5;
    std::vector<System> systems;
    for (const int equations : {1, 7, 8, 9, 65, 150})
      systems.push_back(random_system(equations, entry.symmetric, static_cast<unsigned>(equations)));
    systems.push_back(q4_mesh({.columns = 14, .rows = 28, .unsymmetric = share}));
    systems.push_back(q4_mesh({.columns = 70, .rows = 90, .unsymmetric = share}));
    for (const System& system : systems)
      for (const int threads : {1, 2})
        expect_same(answers(entry, system, 0, threads, Kernels::avx2),
                    answers(entry, system, 0, threads, Kernels::avx512));
    if (!entry.name.starts_with("frontal")) continue;
    for (const int border : {1, 8, 30, 61})
      expect_same(answers(entry, systems[5], border, 1, Kernels::avx2),
                  answers(entry, systems[5], border, 1, Kernels::avx512));
    expect_same(answers(entry, systems.back(), 150, 2, Kernels::avx2),
                answers(entry, systems.back(), 150, 2, Kernels::avx512));
  }
}

// The same equation is named, although kernels look at no pivot themselves.
TEST(Kernels, NameTheSameSingularEquation) {
  for (const Kernels kernels : {Kernels::avx2, Kernels::avx512})
    if (const std::string why = why_no_kernels(kernels); !why.empty()) GTEST_SKIP() << why;
  const System free = q4_mesh({.columns = 12, .rows = 12, .supports = Supports::none});
  for (const SolverEntry& entry : own_solvers()) {
    std::vector<int> named;
    for (const Kernels kernels : {Kernels::avx2, Kernels::avx512}) {
      const auto solver = entry.make();
      solver->configure({.kernels = kernels});
      load(*solver, free);
      try {
        solver->factorise();
      } catch (const SingularMatrix& error) {
        named.push_back(error.equation());
      }
    }
    ASSERT_EQ(named.size(), 2u) << entry.name;
    EXPECT_EQ(named[0], named[1]) << entry.name;
  }
}

TEST(Kernels, ThoseThatTheMachineLacksAreRefused) {
  EXPECT_EQ(why_no_kernels(Kernels::automatic), "");
  for (const Kernels kernels : {Kernels::avx2, Kernels::avx512}) {
    if (why_no_kernels(kernels).empty()) {
      EXPECT_EQ(choose_kernels(kernels).name, std::string(kernels == Kernels::avx2 ? "avx2" : "avx512"));
    } else {
      EXPECT_THROW(choose_kernels(kernels), AnalysisError);
    }
  }
}

}  // namespace
}  // namespace sage::test
