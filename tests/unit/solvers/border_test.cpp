// Solvers that keep a border: what is left of it against A_nn - A_nl A_ll^-1 A_ln of dense matrices.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "sage/conformance/solver_systems.hpp"
#include "sage/messages/error.hpp"
#include "solvers/frontal.hpp"
#include "solvers/skyline.hpp"

namespace sage::test {

using namespace conformance;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::unique_ptr<LinearSolver> solver_with_border(const System& system, int border, bool symmetric,
                                                 int threads = 1) {
  std::unique_ptr<LinearSolver> solver = symmetric ? make_frontal_ldlt() : make_frontal();
  solver->configure({.threads = threads});
  EXPECT_TRUE(offered_by<BorderSolver>(*solver).set_border(border));
  load(*solver, system);
  solver->factorise();
  return solver;
}

MatrixXd border_of(const LinearSolver& solver, int border) {
  MatrixXd S = MatrixXd::Constant(border, border, std::numeric_limits<double>::quiet_NaN());
  offered_by<BorderSolver>(solver).border_matrix(S.data());
  return S;
}

// Matrices of these tests have a condition below 1e5 and diagonals that dominate: elimination without pivoting keeps
// the digits to 1e-12 with room.
constexpr double kAllowed = 1e-12;

void expect_close(const MatrixXd& found, const MatrixXd& expected, double scale) {
  if (expected.size() == 0) return;
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), kAllowed * scale);
}

// The border matrix, loads that are eliminated, and the others filled in.
void expect_border(const System& system, int border, bool symmetric) {
  const int inner = system.equations - border;
  const MatrixXd A = dense(system);
  const Eigen::PartialPivLU<MatrixXd> A_ll(A.topLeftCorner(inner, inner));
  const auto A_ln = A.topRightCorner(inner, border), A_nl = A.bottomLeftCorner(border, inner);
  const auto A_nn = A.bottomRightCorner(border, border);
  const auto solver = solver_with_border(system, border, symmetric);
  const MatrixXd closed = inner > 0 ? MatrixXd(A_nn - A_nl * A_ll.solve(A_ln)) : MatrixXd(A_nn);
  const double size = A.cwiseAbs().maxCoeff();
  expect_close(border_of(*solver, border), closed, size);

  VectorXd b = random_vector(system.equations, 7), y(system.equations);
  const auto& with_border = offered_by<BorderSolver>(*solver);
  with_border.eliminate(span_of(b), span_of(y));
  const VectorXd from_loads = inner > 0 ? VectorXd(A_ll.solve(b.head(inner))) : VectorXd(0);
  expect_close(y.tail(border), b.tail(border) - A_nl * from_loads, size * system.equations);
  const VectorXd x_n = random_vector(border, 8);
  y.tail(border) = x_n;
  with_border.recover(span_of(y));
  EXPECT_EQ(y.tail(border), x_n);
  const VectorXd x_l = inner > 0 ? VectorXd(A_ll.solve(b.head(inner) - A_ln * x_n)) : VectorXd(0);
  expect_close(y.head(inner), x_l, 1.0 + x_l.norm());
}

TEST(Border, IsTheSchurComplementOfRandomMatrices) {
  for (const bool symmetric : {true, false})
    for (const int n : {1, 2, 7, 8, 9, 17, 64, 200})
      for (const int border : {1, 2, 7, 8, 9, 30, n / 2, n - 1, n}) {
        if (border < 1 || border > n) continue;
        SCOPED_TRACE(testing::Message()
                     << n << " equations, border " << border << (symmetric ? ", symmetric" : ""));
        expect_border(random_system(n, symmetric, static_cast<unsigned>(n + border)), border, symmetric);
      }
}

// The last equations of a mesh are those of its upper rows: several fronts touch them.
TEST(Border, IsTheSchurComplementOfMeshes) {
  for (const bool symmetric : {true, false})
    for (const int border : {3, 26, 60})
      expect_border(
          q4_mesh(
              {.columns = 12, .rows = 20, .supports = Supports::bottom, .unsymmetric = symmetric ? 0.0 : 0.5}),
          border, symmetric);
}

// Everything is border: nothing is eliminated, and the matrix is what was added.
TEST(Border, ThatIsEverythingIsTheMatrixItself) {
  const System system = random_system(40, false, 3);
  EXPECT_EQ(border_of(*solver_with_border(system, 40, false), 40), dense(system));
}

TEST(Border, ThatIsEmptyLeavesAnOrdinarySolver) {
  for (const bool symmetric : {true, false}) {
    const System system = random_system(60, symmetric, 3);
    const auto with = solver_with_border(system, 0, symmetric);
    const auto without = symmetric ? make_frontal_ldlt() : make_frontal();
    load(*without, system);
    without->factorise();
    VectorXd b = random_vector(60, 1), x(60), z(60);
    EXPECT_EQ(with->solve(span_of(b), span_of(x)), SolveStatus::ok);
    EXPECT_EQ(without->solve(span_of(b), span_of(z)), SolveStatus::ok);
    EXPECT_EQ(x, z);
  }
}

// Two equations of the same elements alone, one of which is border, stay apart.
TEST(Border, DividesTheEquationsOfANode) {
  System system;
  system.equations = 4;
  system.add_element({0, 1, 2, 3}, MatrixXd::Identity(4, 4) * 8.0 + MatrixXd::Ones(4, 4));
  expect_border(system, 1, true);
  expect_border(system, 2, false);
}

// A region that is loose without its border: the equation that has no pivot is that of the region alone.
TEST(Border, ASingularInteriorIsNamedAsWithoutIt) {
  const System loose = q4_mesh({.columns = 6, .rows = 6, .supports = Supports::none});
  const auto named = [](const System& system, int border) {
    const auto solver = make_frontal_ldlt();
    offered_by<BorderSolver>(*solver).set_border(border);
    load(*solver, system);
    try {
      solver->factorise();
    } catch (const SingularMatrix& error) {
      return error.equation();
    }
    return -1;
  };
  System with_border = loose;  // and two more equations that a spring holds together, which touch nothing else
  with_border.equations += 2;
  add_spring(with_border, loose.equations, loose.equations + 1, 1.0);
  EXPECT_GE(named(loose, 0), 0);
  EXPECT_EQ(named(with_border, 2), named(loose, 0));
}

// The meshes are large enough to be divided among threads.
TEST(Border, ThreadsChangeNoBit) {
  for (const bool symmetric : {true, false}) {
    const System system = q4_mesh({.columns = 70, .rows = 90, .unsymmetric = symmetric ? 0.0 : 0.5});
    const int border = 140;
    const VectorXd b = random_vector(system.equations, 2);
    MatrixXd first;
    VectorXd first_x;
    for (const int threads : {1, 2, 3}) {
      const auto solver = solver_with_border(system, border, symmetric, threads);
      VectorXd x = b;
      offered_by<BorderSolver>(*solver).eliminate(span_of(x), span_of(x));
      offered_by<BorderSolver>(*solver).recover(span_of(x));
      const MatrixXd S = border_of(*solver, border);
      if (threads == 1) {
        first = S;
        first_x = x;
      }
      EXPECT_EQ(S, first) << threads;
      EXPECT_EQ(x, first_x) << threads;
    }
  }
}

// Answers that are to be refined, and solvers without the interface: no border.
TEST(Border, IsRefusedWhereItCantBeKept) {
  const auto refined = make_frontal();
  refined->configure({.refinement_steps = 2});
  EXPECT_FALSE(offered_by<BorderSolver>(*refined).set_border(3));
  EXPECT_THROW(offered_by<BorderSolver>(*make_skyline_lu()), std::bad_cast);
}

}  // namespace
}  // namespace sage::test
