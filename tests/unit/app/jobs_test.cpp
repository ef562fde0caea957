// Several decks at a time: order, one that crashes, an interrupt.
#include "sage/app/jobs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "sage/app/interrupt.hpp"

namespace sage::app {
namespace {

// What became of each job, in the order in which it was reported.
struct Reported {
  std::vector<std::size_t> jobs, skipped;
  std::vector<JobEnd> ends;

  JobList list(std::size_t count, std::function<int(std::size_t)> run) {
    return {count, std::move(run),
            [this](std::size_t job, const JobEnd& end) {
              jobs.push_back(job);
              ends.push_back(end);
            },
            [this](std::size_t job) { skipped.push_back(job); }};
  }
};

TEST(Jobs, AreReportedInOrderWithWhatTheyWrote) {
  Reported reported;
  do_jobs(reported.list(7,
                        [](std::size_t job) {
                          usleep(static_cast<useconds_t>(20000 * (7 - job)));  // the last is the first to end
                          std::printf("out of %zu\n", job);
                          std::fprintf(stderr, "err of %zu\n", job);
                          return static_cast<int>(job);
                        }),
          3);
  ASSERT_EQ(reported.jobs, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(reported.skipped.empty());
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(reported.ends[i].exit_code, static_cast<int>(i));
    EXPECT_EQ(reported.ends[i].signal, 0);
    EXPECT_EQ(reported.ends[i].out, "out of " + std::to_string(i) + "\n");
    EXPECT_EQ(reported.ends[i].err, "err of " + std::to_string(i) + "\n");
  }
}

TEST(Jobs, OneThatIsKilledHarmsNoOther) {
  Reported reported;
  do_jobs(reported.list(5,
                        [](std::size_t job) {
                          std::printf("begun\n");
                          std::fflush(stdout);
                          if (job == 1) raise(SIGKILL);
                          return 0;
                        }),
          2);
  ASSERT_EQ(reported.ends.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(reported.ends[i].signal, i == 1 ? SIGKILL : 0) << i;
    EXPECT_EQ(reported.ends[i].out, "begun\n") << "what it had written before is kept";
  }
}

// Each job hears the interrupt once and ends as it does alone; those that had not begun are named.
TEST(Jobs, AnInterruptIsPassedOn) {
  const InterruptWatch watch;
  const pid_t whole = getpid();
  Reported reported;
  do_jobs(reported.list(4,
                        [whole](std::size_t job) {
                          if (job == 1) kill(whole, SIGINT);
                          while (!interrupted()) usleep(1000);
                          usleep(50000);  // a second signal would end it here
                          return 5;
                        }),
          2);
  ASSERT_EQ(reported.jobs, (std::vector<std::size_t>{0, 1}));
  for (const JobEnd& end : reported.ends) {
    EXPECT_EQ(end.signal, 0);
    EXPECT_EQ(end.exit_code, 5);
    EXPECT_EQ(end.err, "") << "only the whole says how the run ends";
  }
  EXPECT_EQ(reported.skipped, (std::vector<std::size_t>{2, 3}));
}

TEST(Jobs, WithoutAnyNothingHappens) {
  Reported reported;
  do_jobs(reported.list(0, [](std::size_t) { return 1; }), 4);
  EXPECT_TRUE(reported.jobs.empty());
}

}  // namespace
}  // namespace sage::app
