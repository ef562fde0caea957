#include <gtest/gtest.h>

#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"
#include "solvers/solver_codes.hpp"

namespace sage {
namespace {

TEST(ChooseSolver, TakesProfileSolversForSmallAndFrontsForLargeSystems) {
  EXPECT_EQ(choose_solver({800, false}), solver_code::skyline_lu);
  EXPECT_EQ(choose_solver({800, true}), solver_code::skyline_ldlt);
  EXPECT_EQ(choose_solver({100000, false}), solver_code::frontal);
  EXPECT_EQ(choose_solver({100000, true}), solver_code::frontal_ldlt);
  // Excess pressures widen the profile.
  EXPECT_EQ(choose_solver({800, false, true}), solver_code::frontal);
  EXPECT_EQ(choose_solver({300, false, true}), solver_code::skyline_lu);
}

TEST(ChooseSolver, NeverGivesAnUnsymmetricSystemToASymmetricSolver) {
  Catalogue catalogue;
  register_solvers(catalogue);
  for (int n = 0; n < 200000; n += 500) {
    ASSERT_NE(catalogue.solvers.find(choose_solver({n, false})), nullptr);
    EXPECT_FALSE(catalogue.solvers.find(choose_solver({n, false}))->symmetric);
    EXPECT_TRUE(catalogue.solvers.find(choose_solver({n, true}))->symmetric);
  }
}

}  // namespace
}  // namespace sage
