// Ctrl-C and SIGTERM: the first is heard, the second ends the process.
#include "sage/app/interrupt.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace sage::app {
namespace {

TEST(Interrupt, IsHeardWhileSomebodyListens) {
  for (int number : {SIGINT, SIGTERM}) {
    EXPECT_FALSE(interrupted());
    const InterruptWatch watch;
    EXPECT_FALSE(interrupted());
    raise(number);
    EXPECT_TRUE(interrupted());
  }
  EXPECT_FALSE(interrupted()) << "the next deck starts anew";
}

TEST(Interrupt, TheSecondEndsTheProcess) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  for (int second : {SIGINT, SIGTERM})
    EXPECT_EXIT(
        {
          const InterruptWatch watch;
          raise(SIGINT);
          raise(second);
          std::exit(0);
        },
        testing::KilledBySignal(second), "once more ends at once");
}

// A job that its shell protects from Ctrl-C stays protected.
TEST(Interrupt, WhatIsIgnoredStaysIgnored) {
  const auto before = signal(SIGINT, SIG_IGN);
  {
    const InterruptWatch watch;
    raise(SIGINT);
    EXPECT_FALSE(interrupted());
  }
  signal(SIGINT, before);
}

}  // namespace
}  // namespace sage::app
