// Every solver of the catalogue gives the answer of a dense L U with pivoting, names what is singular and
// repeats itself to the last bit.
#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "sage/analysis/condition.hpp"
#include "sage/core/error.hpp"
#include "solvers/register_solvers.hpp"
#include "tests/conformance/solver_systems.hpp"

namespace sage::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Catalogue solver_catalogue() {
  Catalogue catalogue;
  register_solvers(catalogue);
  return catalogue;
}

std::vector<int> codes() {
  std::vector<int> list;
  const Catalogue catalogue = solver_catalogue();
  for (const auto& [code, entry] : catalogue.solvers.entries()) list.push_back(code);
  return list;
}

VectorXd random_vector(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> term(-1.0, 1.0);
  return VectorXd::NullaryExpr(n, [&] { return term(random); });
}

std::span<double> span_of(VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

class SolverConformance : public testing::TestWithParam<int> {
 protected:
  std::unique_ptr<LinearSolver> make() const { return catalogue_.solvers.find(GetParam())->make(); }
  bool symmetric() const { return catalogue_.solvers.find(GetParam())->symmetric; }
  // Libraries take no number of threads, and their BLAS may round otherwise from one place in memory to the
  // next (MUMPS does, from some thousand equations).
  bool own() const {
    const std::string& name = catalogue_.solvers.find(GetParam())->name;
    return name.starts_with("skyline") || name.starts_with("frontal");
  }

  static VectorXd solve(const LinearSolver& solver, VectorXd b) {
    VectorXd x = VectorXd::Constant(b.size(), std::numeric_limits<double>::quiet_NaN());
    solver.solve(span_of(b), span_of(x));
    return x;
  }

  // ||K x - b|| <= 1e-12 (||K|| ||x|| + ||b||) in the largest norm: a backward-stable answer has 1e-15 times a
  // small factor; 1e-12 leaves room for elimination without pivoting.
  static void expect_solved(const MatrixXd& K, const VectorXd& x, const VectorXd& b) {
    const double scale =
        K.cwiseAbs().rowwise().sum().maxCoeff() * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff();
    EXPECT_LE((K * x - b).cwiseAbs().maxCoeff(), 1e-12 * scale);
  }

  // Against a dense L U with pivoting.  The error may be the condition number times the rounding error, ~1e-12
  // for these systems (condition below 1e5).
  void expect_answer(const System& system) const {
    const auto solver = make();
    load(*solver, system);
    solver->factorise();
    const MatrixXd K = dense(system);
    const Eigen::PartialPivLU<MatrixXd> reference(K);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const VectorXd b = random_vector(system.equations, seed);
      const VectorXd x = solve(*solver, b), expected = reference.solve(b);
      expect_solved(K, x, b);
      EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
    }
  }

  SingularMatrix singular(const System& system) const {
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

 private:
  Catalogue catalogue_ = solver_catalogue();
};

std::string name_of(const testing::TestParamInfo<int>& info) {
  const Catalogue catalogue = solver_catalogue();
  return catalogue.solvers.find(info.param)->name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SolverConformance, testing::ValuesIn(codes()), name_of);

TEST_P(SolverConformance, TraitsAgreeWithTheCatalogue) {
  const Catalogue catalogue = solver_catalogue();
  const SolverEntry& entry = *catalogue.solvers.find(GetParam());
  EXPECT_EQ(entry.make()->traits().name, entry.name);
  EXPECT_EQ(entry.make()->traits().symmetric, entry.symmetric);
}

TEST_P(SolverConformance, SolvesRandomSystemsOfEverySize) {
  for (const int n : {1, 2, 3, 7, 8, 9, 15, 16, 17, 40, 63, 64, 65, 200}) {
    SCOPED_TRACE(n);
    expect_answer(random_system(n, symmetric(), static_cast<unsigned>(n)));
  }
}

TEST_P(SolverConformance, SolvesElasticMeshes) {
  expect_answer(q4_mesh({.columns = 14, .rows = 28}));
  expect_answer(q4_mesh({.columns = 9, .rows = 5, .supports = Supports::bottom, .poisson = 0.49}));
  expect_answer(q4_mesh({.columns = 1, .rows = 40, .supports = Supports::triaxial}));
}

TEST_P(SolverConformance, SolvesUnsymmetricMeshes) {
  if (symmetric()) GTEST_SKIP() << "symmetric solver";
  const System system = q4_mesh({.columns = 14, .rows = 28, .unsymmetric = 0.7});
  ASSERT_GT((dense(system) - dense(system).transpose()).cwiseAbs().maxCoeff(), 50.0);  // of ~1000
  expect_answer(system);
}

TEST_P(SolverConformance, SolvesAMeshLargeEnoughForTheSupernodalPath) {
  const System system = q4_mesh({.columns = 40, .rows = 60, .unsymmetric = symmetric() ? 0.0 : 0.5});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  VectorXd b = random_vector(system.equations, 5), r(system.equations);
  VectorXd x = solve(*solver, b);
  solver->multiply(span_of(x), span_of(r));
  EXPECT_LE((r - b).cwiseAbs().maxCoeff(), 1e-12 * (solver->norm1() * x.cwiseAbs().maxCoeff()));
}

// A symmetric matrix with negative eigenvalues: softening.  The middle of the mesh is shifted by -K.
TEST_P(SolverConformance, SolvesAnIndefiniteMatrix) {
  for (const int columns : {6, 40}) {
    System system = q4_mesh({.columns = columns, .rows = columns});
    for (std::size_t e = 0; e < system.K.size(); e += 7) system.K[e] *= -0.5;
    const auto solver = make();
    load(*solver, system);
    solver->factorise();
    const VectorXd b = random_vector(system.equations, 5);
    expect_solved(dense(system), solve(*solver, b), b);
  }
}

TEST_P(SolverConformance, MultipliesNormsAndSolvesTransposed) {
  const System system = random_system(60, symmetric(), 3);
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const MatrixXd K = dense(system);
  VectorXd x = random_vector(60, 1), y(60), z(60);
  solver->multiply(span_of(x), span_of(y));
  EXPECT_LE((y - K * x).cwiseAbs().maxCoeff(), 1e-13 * y.cwiseAbs().maxCoeff());
  solver->multiply_transposed(span_of(x), span_of(y));
  EXPECT_LE((y - K.transpose() * x).cwiseAbs().maxCoeff(), 1e-13 * y.cwiseAbs().maxCoeff());
  EXPECT_NEAR(solver->norm1(), K.cwiseAbs().colwise().sum().maxCoeff(), 1e-13 * solver->norm1());
  solver->solve_transposed(span_of(x), span_of(z));
  expect_solved(K.transpose(), z, x);
}

TEST_P(SolverConformance, SolvesInPlace) {
  const System system = q4_mesh({.columns = 4, .rows = 4});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  VectorXd b = random_vector(system.equations, 2);
  const VectorXd x = solve(*solver, b);
  solver->solve(span_of(b), span_of(b));
  EXPECT_EQ(x, b);
}

TEST_P(SolverConformance, FactorisesAgainWithNewValues) {
  System system = q4_mesh({.columns = 8, .rows = 8});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const VectorXd b = random_vector(system.equations, 2);
  const VectorXd first = solve(*solver, b);
  for (std::size_t e = 0; e < system.K.size(); ++e) system.K[e] *= 1.0 + static_cast<double>(e % 5);
  solver->clear();
  for (int e = 0; e < system.elements.count(); ++e)
    solver->add(e, system.K[static_cast<std::size_t>(e)].data());
  solver->factorise();
  expect_solved(dense(system), solve(*solver, b), b);
  // And a new pattern, smaller than the first.
  const System other = random_system(20, symmetric(), 8);
  load(*solver, other);
  solver->factorise();
  const VectorXd c = random_vector(20, 2);
  expect_solved(dense(other), solve(*solver, c), c);
  load(*solver, q4_mesh({.columns = 8, .rows = 8}));
  solver->factorise();
  EXPECT_EQ(solve(*solver, b), first);
}

TEST_P(SolverConformance, RepeatsItselfToTheLastBit) {
  const System system = q4_mesh({.columns = 20, .rows = 20});
  const VectorXd b = random_vector(system.equations, 2);
  VectorXd first;
  for (int run = 0; run < 3; ++run) {
    const auto solver = make();
    load(*solver, system);
    solver->factorise();
    const VectorXd x = solve(*solver, b);
    if (run == 0) first = x;
    EXPECT_EQ(x, first);
  }
}

TEST_P(SolverConformance, GivesItsWorkspaceBackAndTakesItAgain) {
  const System system = q4_mesh({.columns = 40, .rows = 60});
  const VectorXd b = random_vector(system.equations, 3);
  const auto solver = make();
  solver->set_threads(2);
  load(*solver, system);
  solver->factorise();
  const VectorXd x = solve(*solver, b);
  solver->release_workspace();
  EXPECT_EQ(solve(*solver, b), x);
  solver->factorise();
  EXPECT_EQ(solve(*solver, b), x);
}

// Answers, transposed answers and the report; the last mesh is large enough to be divided among threads.
TEST_P(SolverConformance, ThreadsChangeNoBit) {
  if (!own()) GTEST_SKIP() << "a library";
  const double share = symmetric() ? 0.0 : 0.5;
  const System systems[] = {
      random_system(65, symmetric(), 4), q4_mesh({.columns = 14, .rows = 28}),
      join(q4_mesh({.columns = 40, .rows = 60, .unsymmetric = share}), q4_mesh({.columns = 9, .rows = 9})),
      q4_mesh({.columns = 70, .rows = 90, .unsymmetric = share})};
  for (const System& system : systems) {
    VectorXd b = random_vector(system.equations, 2), first, first_transposed;
    FactorReport first_report;
    for (const int threads : {1, 2, 3}) {
      const auto solver = make();
      solver->set_threads(threads);
      load(*solver, system);
      for (int again = 0; again < 2; ++again) solver->factorise();
      const VectorXd x = solve(*solver, b);
      VectorXd z(system.equations);
      solver->solve_transposed(span_of(b), span_of(z));
      const FactorReport report = solver->report();
      if (threads == 1) {
        first = x;
        first_transposed = z;
        first_report = report;
      }
      EXPECT_EQ(x, first) << threads;
      EXPECT_EQ(z, first_transposed) << threads;
      EXPECT_EQ(report.smallest_pivot_ratio, first_report.smallest_pivot_ratio);
      EXPECT_EQ(report.growth, first_report.growth);
      EXPECT_EQ(report.negative_pivots, first_report.negative_pivots);
    }
  }
}

// Two bodies left free: every number of threads names the same equation, and all threads work again afterwards.
TEST_P(SolverConformance, ThreadsNameTheSameSingularEquation) {
  if (!own()) GTEST_SKIP() << "a library";
  const System free = q4_mesh({.columns = 50, .rows = 50, .supports = Supports::none});
  const System system = join(join(q4_mesh({.columns = 50, .rows = 50}), free), free);
  std::vector<int> named;
  for (const int threads : {1, 2, 3}) {
    const auto solver = make();
    solver->set_threads(threads);
    load(*solver, system);
    try {
      solver->factorise();
    } catch (const SingularMatrix& error) {
      named.push_back(error.equation());
    }
    const System sound = q4_mesh({.columns = 50, .rows = 50});
    load(*solver, sound);
    solver->factorise();
    VectorXd b = random_vector(sound.equations, 2), r(sound.equations);
    VectorXd x = solve(*solver, b);
    solver->multiply(span_of(x), span_of(r));
    EXPECT_LE((r - b).cwiseAbs().maxCoeff(), 1e-12 * (solver->norm1() * x.cwiseAbs().maxCoeff()));
  }
  ASSERT_EQ(named.size(), 3u);
  EXPECT_EQ(named[0], named[1]);
  EXPECT_EQ(named[0], named[2]);
}

TEST_P(SolverConformance, OneEquation) {
  System system;
  system.equations = 1;
  add_spring(system, 0, -1, 4.0);
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  EXPECT_DOUBLE_EQ(solve(*solver, VectorXd::Constant(1, 2.0))(0), 0.5);
}

TEST_P(SolverConformance, NoEquations) {
  System system;
  add_spring(system, -1, -1, 4.0);
  const auto solver = make();
  load(*solver, system);
  EXPECT_NO_THROW(solver->factorise());
  EXPECT_NO_THROW(solver->solve({}, {}));
}

TEST_P(SolverConformance, AnEquationOfNoElementIsNamed) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const int lonely = system.equations++;
  EXPECT_EQ(singular(system).equation(), lonely);
}

TEST_P(SolverConformance, AZeroRowIsNamed) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const int zero = system.equations++;
  add_spring(system, 4, zero, 0.0);
  EXPECT_EQ(singular(system).equation(), zero);
}

// A body held nowhere beside one that is held: the equation belongs to the free one.
TEST_P(SolverConformance, ABodyLeftFreeIsNamed) {
  for (const int size : {1, 3, 10, 30, 60}) {
    SCOPED_TRACE(size);
    const System held = q4_mesh({.columns = 5, .rows = 5});
    const System free = q4_mesh({.columns = size, .rows = size, .supports = Supports::none});
    const SingularMatrix first = singular(join(held, free));
    EXPECT_GE(first.equation(), held.equations);
    EXPECT_LE(first.pivot_ratio(), 1e-11);
    const SingularMatrix second = singular(join(free, held));
    EXPECT_LT(second.equation(), free.equations);
    EXPECT_GE(second.equation(), 0);
  }
}

TEST_P(SolverConformance, AFreeBodyNearlyIncompressibleIsSingular) {
  singular(q4_mesh({.columns = 10, .rows = 10, .supports = Supports::none, .poisson = 0.499}));
  singular(q4_mesh({.columns = 40, .rows = 80, .supports = Supports::none, .poisson = 0.49}));
}

// A stiff block on top of a soft one: the rounding error of stiff terms may leave a soft pivot of 1e3 times the
// usual size, 1e3 x 1e-15.  What is not refused must at least show in the report.
TEST_P(SolverConformance, AFreeBodyOfUnequalStiffnessIsRefusedOrReported) {
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

TEST_P(SolverConformance, AStiffPlatenOnSoftSoilIsNotSingular) {
  const System system = q4_mesh({.columns = 8, .rows = 12, .supports = Supports::bottom, .stiff_top = 1e8});
  const auto solver = make();
  load(*solver, system);
  ASSERT_NO_THROW(solver->factorise());
  const VectorXd b = random_vector(system.equations, 2);
  expect_solved(dense(system), solve(*solver, b), b);
}

// Two equations joined by a unit spring and held by a weak one: the pivot ratio is that of the springs, 1e-9.
TEST_P(SolverConformance, ANearlySingularMatrixIsReported) {
  System system;
  system.equations = 2;
  add_spring(system, 0, 1, 1.0);
  add_spring(system, 1, -1, 1e-9);
  const auto solver = make();
  load(*solver, system);
  ASSERT_NO_THROW(solver->factorise());
  const double ratio = solver->report().smallest_pivot_ratio;
  if (ratio < 0.0) GTEST_SKIP() << "this library does not show its pivots";
  EXPECT_GT(ratio, 0.99e-9);
  EXPECT_LT(ratio, 1.01e-9);
}

// K = [[1, -1], [-1, 1 + d]] with d = 1e-9: ||K|| = 2 + d, ||K^-1|| = (2 + d) / d, so rcond = d / (2 + d)^2.
TEST_P(SolverConformance, EstimatesTheCondition) {
  System system;
  system.equations = 2;
  add_spring(system, 0, 1, 1.0);
  add_spring(system, 1, -1, 1e-9);
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  EXPECT_NEAR(reciprocal_condition(*solver, 2), 0.25e-9, 1e-15);
}

// Against the explicit inverse.  The estimate is a lower bound of ||K^-1||, rarely off by more than a factor
// of 3.
TEST_P(SolverConformance, EstimatesTheConditionOfAMesh) {
  const System system = q4_mesh({.columns = 6, .rows = 9, .unsymmetric = symmetric() ? 0.0 : 0.5});
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const MatrixXd K = dense(system);
  const double exact =
      1.0 / (K.cwiseAbs().colwise().sum().maxCoeff() * K.inverse().cwiseAbs().colwise().sum().maxCoeff());
  const double estimate = reciprocal_condition(*solver, system.equations);
  EXPECT_GE(estimate, 0.999 * exact);
  EXPECT_LE(estimate, 3.0 * exact);
}

// Stiffness in a chain of springs, soft and stiff by turns as elements and interfaces are.
System spring_chain(int springs, double stiff) {
  System system;
  system.equations = springs;
  for (int i = 0; i < springs; ++i) add_spring(system, i - 1, i, i % 2 == 0 ? 1.0 : stiff);
  return system;
}

// 360360 / (i + j + 1): every term is a whole number, so that right sides of whole answers are exact.
System hilbert(int n) {
  MatrixXd K(n, n);
  std::vector<int> equations;
  for (int i = 0; i < n; ++i) {
    equations.push_back(i);
    for (int j = 0; j < n; ++j) K(i, j) = 360360.0 / (i + j + 1);
  }
  System system;
  system.equations = n;
  system.add_element(equations, K);
  return system;
}

// Truth from an inverse with 64 binary digits.
double exact_condition(const System& system) {
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Wide K = dense(system).cast<long double>(), inverse = Eigen::FullPivLU<Wide>(K).inverse();
  return static_cast<double>(K.cwiseAbs().colwise().sum().maxCoeff() *
                             inverse.cwiseAbs().colwise().sum().maxCoeff());
}

TEST_P(SolverConformance, EstimatesLargeConditionsWithinAFactorOfTen) {
  std::vector<System> systems{hilbert(4), hilbert(6), hilbert(8)};
  for (const double stiff : {1e3, 1e6, 1e9, 1e12}) systems.push_back(spring_chain(12, stiff));
  System graded;
  graded.equations = 13;
  for (int i = 0; i < 13; ++i) add_spring(graded, i, -1, std::pow(10.0, i));
  systems.push_back(graded);
  for (const System& system : systems) {
    const auto solver = make();
    load(*solver, system);
    solver->factorise();
    const double exact = exact_condition(system);
    SCOPED_TRACE(exact);
    const double estimate = 1.0 / reciprocal_condition(*solver, system.equations);
    EXPECT_GE(estimate, 0.1 * exact);
    EXPECT_LE(estimate, 10.0 * exact);
  }
}

TEST_P(SolverConformance, SaysHowManyDigitsAreLost) {
  const auto solver = make();
  load(*solver, spring_chain(12, 1e12));
  solver->factorise();
  const DigitsReport report = report_digits(*solver, 12, solver->report().smallest_pivot_ratio, true);
  EXPECT_TRUE(report.poor);
  EXPECT_NE(report.words.find("about 14 of 16 digits"), std::string::npos) << report.words;
  load(*solver, q4_mesh({.columns = 6, .rows = 9}));
  solver->factorise();
  EXPECT_EQ(report_digits(*solver, 108, 0.1, false).words, "");
  EXPECT_FALSE(report_digits(*solver, 108, 0.1, true).poor);
}

// Condition 1.5e10: plain answers keep six digits; refined ones have all.
TEST_P(SolverConformance, RefinementRecoversDigits) {
  const System system = hilbert(8);
  const VectorXd exact = VectorXd::LinSpaced(8, 1.0, 8.0);
  const VectorXd b = dense(system) * exact;  // whole numbers below 2^53
  const auto error = [&](int steps) {
    const auto solver = make();
    solver->set_refinement(steps);
    load(*solver, system);
    solver->factorise();
    const VectorXd x = solve(*solver, b);
    EXPECT_EQ(solver->report().backward_error >= 0.0, steps > 0);
    return (x - exact).cwiseAbs().maxCoeff() / 8.0;
  };
  EXPECT_GT(error(0), 1e-11);
  EXPECT_LE(error(5), 4e-16);
}

// Small diagonal terms beside large ones off the diagonal: elimination in the given order spoils the answer.
// Solvers that do not pivot notice the growth and refine, or say that they have no answer.
TEST_P(SolverConformance, AMatrixThatNeedsPivotingIsMendedOrRefused) {
  for (const double small : {1e-4, 1e-7, 1e-10, 1e-12})
    for (const int pairs : {1, 5, 30}) {
      SCOPED_TRACE(small);
      System system;
      system.equations = 2 * pairs;
      MatrixXd K(2, 2);
      K << small, 1.0, 1.0, small;
      for (int i = 0; i < pairs; ++i) system.add_element({2 * i, 2 * i + 1}, K);
      for (int i = 0; i + 1 < pairs; ++i) add_spring(system, 2 * i + 1, 2 * i + 2, small);
      const auto solver = make();
      load(*solver, system);
      const VectorXd b = random_vector(system.equations, 3);
      const VectorXd expected = Eigen::FullPivLU<MatrixXd>(dense(system)).solve(b);
      try {
        solver->factorise();
        const VectorXd x = solve(*solver, b);
        EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
        if (own()) {
          EXPECT_GE(solver->report().backward_error, 0.0);
        }
      } catch (const std::runtime_error& refusal) {
        EXPECT_LT(small, 1e-9) << refusal.what();
      }
    }
}

TEST_P(SolverConformance, AMatrixThatIsNotANumberIsRefused) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  system.K[4](0, 0) = std::numeric_limits<double>::quiet_NaN();
  const auto solver = make();
  load(*solver, system);
  EXPECT_THROW(solver->factorise(), std::runtime_error);
}

// A wish to stop is heard before every long call, and within the factorisations that are this program's own;
// the answer afterwards is the same to the last bit.
TEST_P(SolverConformance, StopsAsAskedAndWorksAgain) {
  const System system = q4_mesh({.columns = 12, .rows = 20});
  for (const int threads : {1, 3}) {
    const auto solver = make();
    std::atomic<long> asked{0}, yes{1L << 60};
    solver->set_threads(threads);
    solver->set_stop([&] { return ++asked > yes; });
    load(*solver, system);
    EXPECT_GE(asked, 1) << "numbering";
    asked = 0;
    solver->factorise();
    const long within = asked;
    if (own()) {
      EXPECT_GE(within, system.equations / 64) << "once in a few columns";
    }
    const VectorXd b = random_vector(system.equations, 4), x = solve(*solver, b);
    EXPECT_GT(asked, within) << "solution";
    for (yes = 0; yes < within; yes += std::max(1L, within / 7)) {
      asked = 0;
      EXPECT_THROW(solver->factorise(), Stopped) << "at question " << yes;
    }
    yes = 0;
    EXPECT_THROW(solve(*solver, b), Stopped);
    yes = 1L << 60;
    solver->factorise();
    if (own()) {
      EXPECT_TRUE(solve(*solver, b) == x);
    }
    expect_solved(dense(system), solve(*solver, b), b);
  }
}

TEST_P(SolverConformance, WorksAgainAfterASingularMatrix) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const auto solver = make();
  load(*solver, system);
  solver->clear();
  EXPECT_THROW(solver->factorise(), SingularMatrix);
  for (int e = 0; e < system.elements.count(); ++e)
    solver->add(e, system.K[static_cast<std::size_t>(e)].data());
  solver->factorise();
  const VectorXd b = random_vector(system.equations, 2);
  expect_solved(dense(system), solve(*solver, b), b);
}

}  // namespace
}  // namespace sage::test
