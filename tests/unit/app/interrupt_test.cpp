// Ctrl-C and SIGTERM: the first is heard, the second ends the process.
#include "sage/app/interrupt.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/shipped_decks.hpp"

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

// The signal comes within the first increment: without patience the run is left there, with it the increment is
// finished and has its checkpoint.
TEST(Interrupt, AnIncrementThatTakesLongIsLeft) {
  RunRequest request;
  request.deck = SAGE_SOURCE_DIR "/legacy_inputs/chapter7/dp_08_kj5/deck.dat";
  request.output.folder = test::scratch_folder("long_increment");
  request.quiet = true;
  const auto polls_after_the_signal = [&](double patience) {
    const InterruptWatch watch;
    long polls = 0;
    request.interrupt_patience = patience;
    request.stop_asked = [&polls] {
      if (++polls == 3) raise(SIGTERM);
      return false;
    };
    const RunOutcome outcome = run_deck(request, full_catalogue());
    EXPECT_EQ(outcome.exit_code, kInterrupted);
    EXPECT_EQ(outcome.checkpoint.empty(), patience == 0.0) << outcome.checkpoint;
    return polls - 3;
  };
  EXPECT_LE(polls_after_the_signal(0.0), 1);
  EXPECT_GT(polls_after_the_signal(1e9), 3) << "the increment takes several iterations";
}

// The signal comes before a restarted run has gone on with the files of the one before: it stops, and what stands in
// them is still there for the next restart.
TEST(Interrupt, ARestartThatIsStoppedAtOnceLosesNothing) {
  RunRequest request;
  request.deck = SAGE_SOURCE_DIR "/legacy_inputs/chapter7/friction_285_nu025/deck.dat";
  request.quiet = true;
  request.interrupt_patience = 1e9;
  request.output.folder = test::scratch_folder("restart_never_stopped");
  ASSERT_EQ(run_deck(request, full_catalogue()).exit_code, kOk);
  const std::filesystem::path whole = request.output.folder;

  request.output.folder = test::scratch_folder("restart_stopped_at_once");
  {
    const InterruptWatch watch;
    long polls = 0;
    request.stop_asked = [&polls] {
      if (++polls == 60) raise(SIGTERM);
      return false;
    };
    ASSERT_EQ(run_deck(request, full_catalogue()).exit_code, kInterrupted);
  }
  request.stop_asked = {};
  request.restart = true;
  for (int round = 0; round < 2; ++round) {
    const InterruptWatch watch;
    raise(SIGTERM);
    const RunOutcome outcome = run_deck(request, full_catalogue());
    EXPECT_EQ(outcome.exit_code, kInterrupted);
    EXPECT_FALSE(outcome.checkpoint.empty());
    EXPECT_GT(outcome.record.result.increments_done, 0);
  }
  ASSERT_EQ(run_deck(request, full_catalogue()).exit_code, kOk);
  for (const char* name : {"friction_285_nu025.increments.csv", "friction_285_nu025.report1.csv"})
    EXPECT_EQ(test::bytes_of(request.output.folder / name), test::bytes_of(whole / name)) << name;
}

}  // namespace
}  // namespace sage::app
