// Two runs of one scene against each other.
#pragma once

#include <gtest/gtest.h>

#include "tests/studies/scenes/whole_run.hpp"

namespace sage::test {

// Displacements and forces of every increment, and stress at the end: differences beside the largest value of each.
inline void expect_same_increments(const scenes::WholeRun& a, const scenes::WholeRun& b, double tolerance) {
  ASSERT_EQ(a.increments.size(), b.increments.size());
  const auto close = [&](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
    return (x - y).cwiseAbs().maxCoeff() <= tolerance * y.cwiseAbs().maxCoeff();
  };
  for (std::size_t i = 0; i < a.increments.size(); ++i) {
    EXPECT_TRUE(close(a.increments[i].u, b.increments[i].u)) << "increment " << i;
    EXPECT_TRUE(close(a.increments[i].internal, b.increments[i].internal)) << "increment " << i;
  }
  ASSERT_EQ(a.stress.size(), b.stress.size());
  for (std::size_t g = 0; g < a.stress.size(); ++g)
    EXPECT_TRUE(close(a.stress[g], b.stress[g])) << "group " << g;
}

}  // namespace sage::test
