// The suite of solvers over every solver of the catalogue, and what these do beyond it: they name the equation
// that is singular, estimate the condition, refine, stop as asked and give the same bits on any number of threads.
#include <atomic>

#include "sage/analysis/condition.hpp"
#include "sage/conformance/solver_systems.hpp"
#include "sage/conformance/suites.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::conformance {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const Catalogue& solver_catalogue() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    register_solvers(c);
    return c;
  }();
  return catalogue;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Solvers, testing::ValuesIn(solver_subjects(solver_catalogue())),
                         name_of_solver);

class OwnSolvers : public Solvers {
 protected:
  // Libraries take no number of threads, and their BLAS may round otherwise from one place in memory to the
  // next (MUMPS does, from some thousand equations).
  static bool own() { return entry().name.starts_with("skyline") || entry().name.starts_with("frontal"); }
};

INSTANTIATE_TEST_SUITE_P(Catalogue, OwnSolvers, testing::ValuesIn(solver_subjects(solver_catalogue())),
                         name_of_solver);

TEST_P(OwnSolvers, KeepTheirMatrix) {
  EXPECT_NE(dynamic_cast<const KeptMatrix*>(make().get()), nullptr);
}

// Answers, transposed answers and the report; the last mesh is large enough to be divided among threads.
TEST_P(OwnSolvers, ThreadsChangeNoBit) {
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
      solver->configure({.threads = threads});
      load(*solver, system);
      for (int again = 0; again < 2; ++again) solver->factorise();
      const VectorXd x = solve(*solver, b);
      VectorXd z(system.equations);
      offered_by<KeptMatrix>(*solver).solve_transposed(span_of(b), span_of(z));
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
TEST_P(OwnSolvers, ThreadsNameTheSameSingularEquation) {
  if (!own()) GTEST_SKIP() << "a library";
  const System free = q4_mesh({.columns = 50, .rows = 50, .supports = Supports::none});
  const System system = join(join(q4_mesh({.columns = 50, .rows = 50}), free), free);
  std::vector<int> named;
  for (const int threads : {1, 2, 3}) {
    const auto solver = make();
    solver->configure({.threads = threads});
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
    const auto& matrix = offered_by<KeptMatrix>(*solver);
    matrix.multiply(span_of(x), span_of(r));
    EXPECT_LE((r - b).cwiseAbs().maxCoeff(), 1e-12 * (matrix.norm1() * x.cwiseAbs().maxCoeff()));
  }
  ASSERT_EQ(named.size(), 3u);
  EXPECT_EQ(named[0], named[1]);
  EXPECT_EQ(named[0], named[2]);
}

TEST_P(OwnSolvers, AnEquationOfNoElementIsNamed) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const int lonely = system.equations++;
  EXPECT_EQ(singular(system).equation(), lonely);
}

TEST_P(OwnSolvers, AZeroRowIsNamed) {
  System system = q4_mesh({.columns = 3, .rows = 3});
  const int zero = system.equations++;
  add_spring(system, 4, zero, 0.0);
  EXPECT_EQ(singular(system).equation(), zero);
}

// A body held nowhere beside one that is held: the equation belongs to the free one.
TEST_P(OwnSolvers, ABodyLeftFreeIsNamed) {
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

// Two equations joined by a unit spring and held by a weak one: the pivot ratio is that of the springs, 1e-9.
TEST_P(OwnSolvers, ANearlySingularMatrixIsReported) {
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
TEST_P(OwnSolvers, EstimatesTheCondition) {
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
TEST_P(OwnSolvers, EstimatesTheConditionOfAMesh) {
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

TEST_P(OwnSolvers, EstimatesLargeConditionsWithinAFactorOfTen) {
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

TEST_P(OwnSolvers, SaysHowManyDigitsAreLost) {
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
TEST_P(OwnSolvers, RefinementRecoversDigits) {
  const System system = hilbert(8);
  const VectorXd exact = VectorXd::LinSpaced(8, 1.0, 8.0);
  const VectorXd b = dense(system) * exact;  // whole numbers below 2^53
  const auto error = [&](int steps) {
    const auto solver = make();
    solver->configure({.refinement_steps = steps});
    load(*solver, system);
    solver->factorise();
    const VectorXd x = solve(*solver, b);
    EXPECT_EQ(solver->report().backward_error >= 0.0, steps > 0);
    return (x - exact).cwiseAbs().maxCoeff() / 8.0;
  };
  EXPECT_GT(error(0), 1e-11);
  EXPECT_LE(error(5), 4e-16);
}

// Solvers that do not pivot notice the growth of small diagonal terms beside large ones, and refine.
TEST_P(OwnSolvers, GrowthIsRefined) {
  if (!own()) GTEST_SKIP() << "a library";
  System system;
  system.equations = 2;
  system.add_element({0, 1}, (MatrixXd(2, 2) << 1e-7, 1.0, 1.0, 1e-7).finished());
  const auto solver = make();
  load(*solver, system);
  solver->factorise();
  const VectorXd b = random_vector(2, 3);
  solve(*solver, b);
  EXPECT_GE(solver->report().backward_error, 0.0);
}

// A wish to stop is heard before every long call, and within the factorisations that are this program's own;
// the answer afterwards is the same to the last bit, also where room has been given back meanwhile.  The large mesh is
// work for several threads.
TEST_P(OwnSolvers, StopsAsAskedAndWorksAgain) {
  for (const auto& [threads, once, columns] :
       {std::tuple{1, false, 12}, {3, false, 12}, {1, true, 12}, {3, true, 12}, {3, true, 60}}) {
    const System system = q4_mesh({.columns = columns, .rows = columns + 8});
    const auto solver = make();
    std::atomic<long> asked{0}, yes{1L << 60};
    solver->configure(
        {.threads = threads, .one_factorisation = once, .stop_asked = [&] { return ++asked > yes; }});
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

}  // namespace
}  // namespace sage::conformance
