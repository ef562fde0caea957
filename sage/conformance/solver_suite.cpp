// What every solver must do: the answer of a dense L U with pivoting, a matrix that is singular refused, the same bits
// every time: sage/conformance/suites.hpp.
#include "sage/conformance/suites.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <ostream>

#include "sage/conformance/solver_systems.hpp"
#include "sage/core/catalogue.hpp"
#include "sage/messages/error.hpp"

namespace sage::conformance {

void PrintTo(const SolverSubject& subject, std::ostream* out) {
  *out << subject.entry().name;
}
std::string name_of_solver(const testing::TestParamInfo<SolverSubject>& info) {
  return info.param.entry().name;
}
std::vector<SolverSubject> solver_subjects(const Catalogue& catalogue, const std::vector<int>& codes) {
  std::vector<SolverSubject> subjects;
  for (const auto& [code, entry] : catalogue.solvers.entries())
    if (codes.empty() || std::find(codes.begin(), codes.end(), code) != codes.end())
      subjects.push_back({&catalogue, code});
  return subjects;
}

Eigen::VectorXd Solvers::solve(const LinearSolver& solver, Eigen::VectorXd b) {
  Eigen::VectorXd x = Eigen::VectorXd::Constant(b.size(), std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(solver.solve(span_of(b), span_of(x)), SolveStatus::ok);
  return x;
}

// ||K x - b|| <= 1e-12 (||K|| ||x|| + ||b||) in the largest norm: a backward-stable answer has 1e-15 times a
// small factor; 1e-12 leaves room for elimination without pivoting.
void Solvers::expect_solved(const Eigen::MatrixXd& K, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
  const double scale =
      K.cwiseAbs().rowwise().sum().maxCoeff() * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff();
  EXPECT_LE((K * x - b).cwiseAbs().maxCoeff(), 1e-12 * scale);
}

// Against a dense L U with pivoting.  The error may be the condition number times the rounding error, ~1e-12
// for these systems (condition below 1e5).
void Solvers::expect_answer(const System& system) {
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const Eigen::MatrixXd K = dense(system);
  const Eigen::PartialPivLU<Eigen::MatrixXd> reference(K);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Eigen::VectorXd b = random_vector(system.equations, seed);
    const Eigen::VectorXd x = solve(*solver, b), expected = reference.solve(b);
    expect_solved(K, x, b);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
  }
}

SingularMatrix Solvers::singular(const System& system) {
  const auto solver = make();
  load(*solver, system);
  try {
    solver->factorise();
  } catch (const SingularMatrix& error) {
    return error;
  }
  ADD_FAILURE() << "no SingularMatrix, smallest pivot ratio " << solver->report().smallest_pivot_ratio;
  return SingularMatrix(-1, 0.0, "");
}

namespace {

TEST_P(Solvers, TraitsAgreeWithTheCatalogue) {
  EXPECT_EQ(make()->traits().name, entry().name);
  EXPECT_EQ(make()->traits().symmetric, entry().symmetric);
}

TEST_P(Solvers, SolvesRandomSystemsOfEverySize) {
  for (const int n : {1, 2, 3, 7, 8, 9, 15, 16, 17, 40, 63, 64, 65, 200}) {
    SCOPED_TRACE(n);
    expect_answer(random_system(n, symmetric(), static_cast<unsigned>(n)));
  }
}

TEST_P(Solvers, SolvesElasticMeshes) {
  expect_answer(q4_mesh({.columns = 14, .rows = 28}));
  expect_answer(q4_mesh({.columns = 9, .rows = 5, .supports = Supports::bottom, .poisson = 0.49}));
  expect_answer(q4_mesh({.columns = 1, .rows = 40, .supports = Supports::triaxial}));
}

TEST_P(Solvers, SolvesUnsymmetricMeshes) {
  if (symmetric()) GTEST_SKIP() << "symmetric solver";
  const System system = q4_mesh({.columns = 14, .rows = 28, .unsymmetric = 0.7});
  ASSERT_GT((dense(system) - dense(system).transpose()).cwiseAbs().maxCoeff(), 50.0);  // of ~1000
  expect_answer(system);
}

TEST_P(Solvers, SolvesAMeshLargeEnoughForTheSupernodalPath) {
  const System system = q4_mesh({.columns = 40, .rows = 60, .unsymmetric = symmetric() ? 0.0 : 0.5});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const Eigen::VectorXd b = random_vector(system.equations, 5), x = solve(*solver, b);
  EXPECT_LE((product(system, x) - b).cwiseAbs().maxCoeff(), 1e-12 * norm1(system) * x.cwiseAbs().maxCoeff());
}

// A symmetric matrix with negative eigenvalues: softening.  The middle of the mesh is shifted by -K.
TEST_P(Solvers, SolvesAnIndefiniteMatrix) {
  for (const int columns : {6, 40}) {
    System system = q4_mesh({.columns = columns, .rows = columns});
    for (std::size_t e = 0; e < system.K.size(); e += 7) system.K[e] *= -0.5;
    const auto solver = make();
    load(*solver, system);
    solver->factorise();
    const Eigen::VectorXd b = random_vector(system.equations, 5);
    expect_solved(dense(system), solve(*solver, b), b);
  }
}

TEST_P(Solvers, SolvesInPlace) {
  const System system = q4_mesh({.columns = 4, .rows = 4});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  Eigen::VectorXd b = random_vector(system.equations, 2);
  const Eigen::VectorXd x = solve(*solver, b);
  EXPECT_EQ(solver->solve(span_of(b), span_of(b)), SolveStatus::ok);
  EXPECT_EQ(x, b);
}

TEST_P(Solvers, FactorisesAgainWithNewValues) {
  System system = q4_mesh({.columns = 8, .rows = 8});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const Eigen::VectorXd b = random_vector(system.equations, 2);
  const Eigen::VectorXd first = solve(*solver, b);
  for (std::size_t e = 0; e < system.K.size(); ++e) system.K[e] *= 1.0 + static_cast<double>(e % 5);
  solver->clear();
  for (int e = 0; e < system.elements.count(); ++e) solver->add(e, system.K[e].data());
  solver->factorise();
  expect_solved(dense(system), solve(*solver, b), b);
  // And a new pattern, smaller than the first.
  const System other = random_system(20, symmetric(), 8);
  load(*solver, other);
  solver->factorise();
  const Eigen::VectorXd c = random_vector(20, 2);
  expect_solved(dense(other), solve(*solver, c), c);
  load(*solver, q4_mesh({.columns = 8, .rows = 8}));
  solver->factorise();
  EXPECT_EQ(solve(*solver, b), first);
}

TEST_P(Solvers, RepeatsItselfToTheLastBit) {
  const System system = q4_mesh({.columns = 20, .rows = 20});
  const Eigen::VectorXd b = random_vector(system.equations, 2);
  Eigen::VectorXd first;
  for (int run = 0; run < 3; ++run) {
    const auto solver = make();
    load(*solver, system);
    solver->factorise();
    const Eigen::VectorXd x = solve(*solver, b);
    if (run == 0) first = x;
    EXPECT_EQ(x, first);
  }
}

TEST_P(Solvers, GivesItsWorkspaceBackAndTakesItAgain) {
  const System system = q4_mesh({.columns = 40, .rows = 60});
  const Eigen::VectorXd b = random_vector(system.equations, 3);
  const auto solver = make();
  solver->configure({.threads = 2});
  load(*solver, system);
  solver->factorise();
  const Eigen::VectorXd x = solve(*solver, b);
  solver->configure({.threads = 2, .one_factorisation = true});
  load(*solver, system);
  for (int again = 0; again < 2; ++again) {
    solver->factorise();
    EXPECT_EQ(solve(*solver, b), x);
  }
}

TEST_P(Solvers, OneEquation) {
  System system;
  system.equations = 1;
  add_spring(system, 0, -1, 4.0);
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  EXPECT_DOUBLE_EQ(solve(*solver, Eigen::VectorXd::Constant(1, 2.0))(0), 0.5);
}

TEST_P(Solvers, NoEquations) {
  System system;
  add_spring(system, -1, -1, 4.0);
  const auto solver = make();
  load(*solver, system);
  EXPECT_NO_THROW(solver->factorise());
  EXPECT_EQ(solver->solve({}, {}), SolveStatus::ok);
}

TEST_P(Solvers, AFreeBodyNearlyIncompressibleIsSingular) {
  singular(q4_mesh({.columns = 10, .rows = 10, .supports = Supports::none, .poisson = 0.499}));
  singular(q4_mesh({.columns = 40, .rows = 80, .supports = Supports::none, .poisson = 0.49}));
}

// A stiff block on top of a soft one: the rounding error of stiff terms may leave a soft pivot of 1e3 times the
// usual size, 1e3 x 1e-15.  What is not refused must at least show in the report.
TEST_P(Solvers, AFreeBodyOfUnequalStiffnessIsRefusedOrReported) {
  const System system = q4_mesh({.columns = 8, .rows = 8, .supports = Supports::none, .stiff_top = 1e3});
  const auto solver = make();
  load(*solver, system);
  try {
    solver->factorise();
    EXPECT_LT(solver->report().smallest_pivot_ratio, 1e-11);
  } catch (const SingularMatrix& error) {
    EXPECT_LT(error.pivot_ratio(), 1e-11);
  }
}

TEST_P(Solvers, AStiffPlatenOnSoftSoilIsNotSingular) {
  const System system = q4_mesh({.columns = 8, .rows = 12, .supports = Supports::bottom, .stiff_top = 1e8});
  const auto solver = make();
  load(*solver, system);
  ASSERT_NO_THROW(solver->factorise());
  const Eigen::VectorXd b = random_vector(system.equations, 2);
  expect_solved(dense(system), solve(*solver, b), b);
}

// Small diagonal terms beside large ones off the diagonal: elimination in the given order spoils the answer.
// Solvers that do not pivot notice the growth and refine, or say that they have no answer.
TEST_P(Solvers, AMatrixThatNeedsPivotingIsMendedOrRefused) {
  for (const double small : {1e-4, 1e-7, 1e-10, 1e-12})
    for (const int pairs : {1, 5, 30}) {
      SCOPED_TRACE(small);
      System system;
      system.equations = 2 * pairs;
      Eigen::MatrixXd K(2, 2);
      K << small, 1.0, 1.0, small;
      for (int i = 0; i < pairs; ++i) system.add_element({2 * i, 2 * i + 1}, K);
      for (int i = 0; i + 1 < pairs; ++i) add_spring(system, 2 * i + 1, 2 * i + 2, small);
      const auto solver = make();
      load(*solver, system);
      const Eigen::VectorXd b = random_vector(system.equations, 3);
      const Eigen::VectorXd expected = Eigen::FullPivLU<Eigen::MatrixXd>(dense(system)).solve(b);
      try {
        solver->factorise();
        Eigen::VectorXd x = b;
        if (solver->solve(span_of(x), span_of(x)) == SolveStatus::inaccurate) throw AnalysisError("no digits");
        EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
      } catch (const std::runtime_error& refusal) {
        EXPECT_LT(small, 1e-9) << refusal.what();
      }
    }
}

TEST_P(Solvers, AMatrixThatIsNotANumberIsRefused) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  system.K[4](0, 0) = std::numeric_limits<double>::quiet_NaN();
  const auto solver = make();
  load(*solver, system);
  EXPECT_THROW(solver->factorise(), std::runtime_error);
}

TEST_P(Solvers, WorksAgainAfterASingularMatrix) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const auto solver = make();
  load(*solver, system);
  solver->clear();
  EXPECT_THROW(solver->factorise(), SingularMatrix);
  for (int e = 0; e < system.elements.count(); ++e) solver->add(e, system.K[e].data());
  solver->factorise();
  const Eigen::VectorXd b = random_vector(system.equations, 2);
  expect_solved(dense(system), solve(*solver, b), b);
}

// Which equation it is may stay unknown (-1), not that there is one.
TEST_P(Solvers, WhatIsLeftFreeIsSingular) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const int lonely = system.equations++;
  EXPECT_TRUE(singular(system).equation() == lonely || singular(system).equation() == -1) << "of no element";
  add_spring(system, 4, lonely, 0.0);
  EXPECT_TRUE(singular(system).equation() == lonely || singular(system).equation() == -1) << "a zero row";
  const System held = q4_mesh({.columns = 5, .rows = 5});
  for (const int size : {1, 3, 10, 30}) {
    SCOPED_TRACE(size);
    const System free = q4_mesh({.columns = size, .rows = size, .supports = Supports::none});
    const int named = singular(join(held, free)).equation();
    EXPECT_TRUE(named == -1 || named >= held.equations) << "the equation belongs to the free body";
  }
}

// The dogleg and the estimate of the condition number need it; a solver may do without.
TEST_P(Solvers, TheMatrixThatItKeepsIsRight) {
  const System system = random_system(60, symmetric(), 3);
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const auto* const matrix = dynamic_cast<const KeptMatrix*>(solver.get());
  if (matrix == nullptr) GTEST_SKIP() << "keeps no matrix";
  const Eigen::MatrixXd K = dense(system);
  Eigen::VectorXd x = random_vector(60, 1), y(60);
  matrix->multiply(span_of(x), span_of(y));
  EXPECT_LE((y - K * x).cwiseAbs().maxCoeff(), 1e-13 * y.cwiseAbs().maxCoeff());
  matrix->multiply_transposed(span_of(x), span_of(y));
  EXPECT_LE((y - K.transpose() * x).cwiseAbs().maxCoeff(), 1e-13 * y.cwiseAbs().maxCoeff());
  matrix->solve_transposed(span_of(x), span_of(y));
  expect_solved(K.transpose(), y, x);
  EXPECT_NEAR(matrix->norm1(), K.cwiseAbs().colwise().sum().maxCoeff(), 1e-13 * matrix->norm1());
}

// Parts that are added in any order make the same matrix as elements one after the other.
TEST_P(Solvers, PartsOfAnAssemblyChangeNoBit) {
  const System system = q4_mesh({.columns = 9, .rows = 14, .unsymmetric = symmetric() ? 0.0 : 0.5});
  const auto solver = make();
  load(*solver, system);
  auto* const parallel = dynamic_cast<ParallelAssembly*>(solver.get());
  if (parallel == nullptr) GTEST_SKIP() << "assembles on one thread";
  solver->factorise();
  const Eigen::VectorXd b = random_vector(system.equations, 2), expected = solve(*solver, b);
  const std::size_t size = static_cast<std::size_t>(system.K[0].size());
  std::vector<double> all;
  for (const Eigen::MatrixXd& K : system.K) all.insert(all.end(), K.data(), K.data() + size);
  solver->clear();
  for (const int part : {2, 0, 1}) parallel->add_part({0, system.elements.count(), all.data(), size}, part, 3);
  solver->factorise();
  EXPECT_EQ(solve(*solver, b), expected);
}

}  // namespace

}  // namespace sage::conformance
