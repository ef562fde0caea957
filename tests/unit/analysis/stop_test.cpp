// A run that is asked to stop ends with the increments that are complete, and they are those of the whole run.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// A plastic specimen on a sliding interface.
std::string specimen(int increments = 4) {
  SpecimenDeck deck;
  deck.columns = 3;
  deck.rows = 5;
  deck.increments = increments;
  deck.axial_strain = 0.03;
  deck.drucker_prager = true;
  return deck.text();
}

// As run_text, stopped at the question of this number (from 0).  asked: how many there were.
WholeRun stopped_at(const std::string& deck, long question, long& asked, const RunSettings& base = {}) {
  std::atomic<long> count{0};
  RunSettings settings = base;
  settings.stop_asked = [&] { return count++ >= question; };
  WholeRun run = run_text(deck, {}, settings);
  asked = count;
  return run;
}

TEST(Stop, NobodyAsksTwiceWithoutNeed) {
  long asked = 0;
  const WholeRun whole = stopped_at(specimen(), 1L << 60, asked);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  EXPECT_GT(asked, whole.iterations()) << "in every iteration at least";
}

TEST(Stop, AnywhereLeavesTheIncrementsThatWereComplete) {
  long questions = 0;
  const WholeRun whole = stopped_at(specimen(), 1L << 60, questions);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  std::size_t most = 0;
  for (long q = 0; q < questions; ++q) {
    SCOPED_TRACE(q);
    long asked = 0;
    const WholeRun run = stopped_at(specimen(), q, asked);
    ASSERT_EQ(run.result.status, RunStatus::stopped);
    EXPECT_EQ(asked, q + 1) << "the first yes ends it";
    EXPECT_NE(run.result.reason.find("stopped as asked"), std::string::npos) << run.result.reason;
    ASSERT_EQ(run.increments.size(), static_cast<std::size_t>(run.result.increments_done));
    for (std::size_t i = 0; i < run.increments.size(); ++i) {
      EXPECT_TRUE(run.increments[i].u == whole.increments[i].u);
      EXPECT_TRUE(run.increments[i].internal == whole.increments[i].internal);
    }
    most = std::max(most, run.increments.size());
  }
  EXPECT_EQ(most + 1, whole.increments.size()) << "questions all through the run; after its end there is none";
}

// After a checkpoint that is due: nothing is lost.
TEST(Stop, AfterAnIncrementComesBehindItsCheckpoint) {
  std::string saved;
  int increments = 0;
  RunSettings settings;
  settings.checkpoint_due = [&] { return ++increments == 2; };
  settings.save_checkpoint = [&](const std::string& state) { saved = state; };
  settings.stop_asked = [&] { return !saved.empty(); };
  const WholeRun run = run_text(specimen(), {}, settings), whole = run_text(specimen());
  EXPECT_EQ(run.result.status, RunStatus::stopped);
  RunSettings resumed;
  resumed.resume_from = saved;
  const WholeRun rest = run_text(specimen(), {}, resumed);
  ASSERT_TRUE(rest.completed()) << rest.failure;
  EXPECT_TRUE(rest.last().u == whole.last().u);
}

}  // namespace
}  // namespace sage::test
