#include "sage/convergence/attempt.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace sage::convergence {
namespace {

TEST(Attempt, WhateverIsThrownIsAnAnswer) {
  EXPECT_FALSE(attempt([] {}).threw);
  const Attempt words = attempt([] { throw std::runtime_error("no such thing"); });
  EXPECT_TRUE(words.threw);
  EXPECT_EQ(words.thrown, "no such thing");
  const Attempt number = attempt([] { throw 1; });
  EXPECT_TRUE(number.threw);
  EXPECT_FALSE(number.thrown.empty());
  EXPECT_GE(number.seconds, 0.0);
}

}  // namespace
}  // namespace sage::convergence
