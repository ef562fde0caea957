// Parts of the matrix that repeat are eliminated once: nothing but the work may tell it from elimination in full.
#include <gtest/gtest.h>

#include "sage/conformance/solver_systems.hpp"
#include "sage/messages/error.hpp"
#include "solvers/frontal.hpp"
#include "solvers/register_solvers.hpp"
#include "solvers/repeated_fronts.hpp"

namespace sage::test {

using namespace conformance;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Way {
  bool symmetric = true, twins = true, once = true;
  int threads = 1, border = 0;
};

std::unique_ptr<LinearSolver> solver_for(const System& system, const Way& way) {
  std::unique_ptr<LinearSolver> solver = way.twins       ? frontal_with_repeats(way.symmetric)()
                                         : way.symmetric ? make_frontal_ldlt()
                                                         : make_frontal();
  solver->configure({.threads = way.threads, .one_factorisation = way.once});
  if (way.border > 0) {
    EXPECT_TRUE(offered_by<BorderSolver>(*solver).set_border(way.border));
  }
  load(*solver, system);
  return solver;
}

void add_all(LinearSolver& solver, const System& system) {
  solver.clear();
  for (int e = 0; e < system.elements.count(); ++e) solver.add(e, system.K[e].data());
}

void expect_same_answers(const LinearSolver& one, const LinearSolver& other, int equations, int border) {
  VectorXd b = random_vector(equations, 5);
  VectorXd x(equations), y(equations);
  const auto both = [&](auto&& call) {
    call(one, x);
    call(other, y);
    EXPECT_TRUE(x == y);
  };
  if (border > 0) {
    both([&](const LinearSolver& solver, VectorXd& z) {
      offered_by<BorderSolver>(solver).eliminate(span_of(b), span_of(z));
      offered_by<BorderSolver>(solver).recover(span_of(z));
    });
    MatrixXd S(border, border), T(border, border);
    offered_by<BorderSolver>(one).border_matrix(S.data());
    offered_by<BorderSolver>(other).border_matrix(T.data());
    EXPECT_TRUE(S == T);
  } else {
    both([&](const LinearSolver& solver, VectorXd& z) {
      EXPECT_EQ(solver.solve(span_of(b), span_of(z)), SolveStatus::ok);
    });
    both([&](const LinearSolver& solver, VectorXd& z) {
      offered_by<KeptMatrix>(solver).solve_transposed(span_of(b), span_of(z));
    });
  }
  const FactorReport a = one.report(), c = other.report();
  EXPECT_EQ(a.smallest_pivot_ratio, c.smallest_pivot_ratio);
  EXPECT_EQ(a.growth, c.growth);
  EXPECT_EQ(a.negative_pivots, c.negative_pivots);
}

// The mesh of equal elements, and others where some differ.
std::vector<System> meshes(bool symmetric) {
  const double unsymmetric = symmetric ? 0.0 : 0.5;
  std::vector<System> systems;
  systems.push_back(q4_mesh({.columns = 40, .rows = 60, .unsymmetric = unsymmetric}));
  systems.push_back(systems[0]);
  systems[1].K[1000] *= 1.0 + 1e-15;  // one of 2400
  systems.push_back(systems[0]);
  for (std::size_t e = 0; e < systems[2].K.size(); e += 7) systems[2].K[e] *= -0.5;  // softening
  systems.push_back(join(systems[0], systems[0]));
  systems.push_back(q4_mesh({.columns = 70, .rows = 100, .unsymmetric = unsymmetric}));  // several subtrees
  return systems;
}

TEST(TwinFronts, LeaveEveryBit) {
  for (const bool symmetric : {true, false})
    for (const System& system : meshes(symmetric))
      for (const int border : {0, 1, 82})
        for (const int threads : {1, 3}) {
          SCOPED_TRACE(testing::Message() << system.equations << " equations, border " << border << ", "
                                          << threads << " threads" << (symmetric ? ", symmetric" : ""));
          Way way{.symmetric = symmetric, .threads = threads, .border = border};
          const auto with = solver_for(system, way);
          way.twins = false;
          const auto without = solver_for(system, way);
          way.once = false;
          const auto often = solver_for(system, way);
          for (LinearSolver* solver : {with.get(), without.get(), often.get()}) solver->factorise();
          expect_same_answers(*with, *without, system.equations, border);
          expect_same_answers(*with, *often, system.equations, border);
        }
}

// The entries of the multifrontal solvers name both solvers, under one name; no other solver has a second one.
TEST(TwinFronts, AreASecondSolverOfTheSameEntry) {
  Catalogue catalogue;
  register_solvers(catalogue);
  int both = 0;
  for (const auto& [code, entry] : catalogue.solvers.entries()) {
    const bool multifrontal = entry.name == "frontal" || entry.name == "frontal_ldlt";
    ASSERT_EQ(static_cast<bool>(entry.make_with_repeats), multifrontal) << entry.name;
    if (!multifrontal) continue;
    ++both;
    EXPECT_EQ(entry.make_with_repeats()->traits().name, entry.name);
    EXPECT_EQ(entry.make_with_repeats()->traits().symmetric, entry.symmetric);
  }
  EXPECT_EQ(both, 2);
}

// Most of a mesh of equal elements repeats; of one whose elements all differ nothing does.
TEST(TwinFronts, SaveWorkWhereElementsAreEqual) {
  System system = q4_mesh({.columns = 70, .rows = 100});
  const auto solver = solver_for(system, {}), in_full = solver_for(system, {.twins = false});
  solver->factorise();
  in_full->factorise();
  const FactorReport saved = solver->report(), full = in_full->report();
  EXPECT_LT(saved.factor_operations, 0.8 * full.factor_operations);
  EXPECT_LT(static_cast<double>(saved.factor_entries), 0.6 * static_cast<double>(full.factor_entries));
  EXPECT_EQ(full.memory_bytes - saved.memory_bytes,
            static_cast<std::size_t>(full.factor_entries - saved.factor_entries) * sizeof(double));
  EXPECT_EQ(full.solve_operations, saved.solve_operations);
  EXPECT_GT(solver->report().repeated_equations, system.equations / 2);
  EXPECT_EQ(in_full->report().repeated_equations, 0);
  for (std::size_t e = 0; e < system.K.size(); ++e) system.K[e] *= 1.0 + 1e-9 * static_cast<double>(e);
  for (LinearSolver* each : {solver.get(), in_full.get()}) {
    add_all(*each, system);
    each->factorise();
  }
  EXPECT_EQ(solver->report().repeated_equations, 0);
  EXPECT_EQ(solver->report().factor_operations, full.factor_operations);
  EXPECT_EQ(solver->report().factor_entries, full.factor_entries);
  EXPECT_EQ(solver->report().memory_bytes, in_full->report().memory_bytes);
}

// Elements change from one factorisation to the next: fewer fronts repeat, then none, then all again.
TEST(TwinFronts, FollowNewValues) {
  for (const bool symmetric : {true, false})
    for (const int threads : {1, 2}) {
      const System start = q4_mesh({.columns = 70, .rows = 100, .unsymmetric = symmetric ? 0.0 : 0.5});
      const auto with = solver_for(start, {.symmetric = symmetric, .threads = threads});
      const auto without = solver_for(start, {.symmetric = symmetric, .twins = false});
      for (const std::size_t step : {0u, 3000u, 50u, 1u, 0u}) {
        System system = start;
        for (std::size_t e = 0; step > 0 && e < system.K.size(); e += step)
          system.K[e] *= 1.0 + 1e-3 * static_cast<double>(e);
        for (LinearSolver* solver : {with.get(), without.get()}) {
          add_all(*solver, system);
          solver->factorise();
        }
        expect_same_answers(*with, *without, system.equations, 0);
      }
    }
}

// A part that can move freely stands in the mesh more than once: the error names the first, on any number of threads,
// and nobody waits for a border that does not come.
TEST(TwinFronts, NameTheSameSingularEquation) {
  System system = q4_mesh({.columns = 70, .rows = 100});
  // Three times 8 elements without stiffness, around three nodes.
  for (const std::size_t first : {1010u, 3010u, 5010u})
    for (const std::size_t row : {0u, 70u})
      for (std::size_t e = 0; e < 4; ++e) system.K[first + row + e].setZero();
  std::vector<int> named;
  for (const bool twins : {true, false})
    for (const int threads : {1, 2, 3})
      for (int time = 0; time < 5; ++time) {
        const auto solver = solver_for(system, {.twins = twins, .threads = threads});
        try {
          solver->factorise();
        } catch (const SingularMatrix& error) {
          named.push_back(error.equation());
        }
      }
  ASSERT_EQ(named.size(), 30u);
  for (const int equation : named) EXPECT_EQ(equation, named.front());
}

}  // namespace
}  // namespace sage::test
