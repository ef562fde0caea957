// Several decks at a time: order, one that crashes, an interrupt.
#include "sage/app/jobs.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <set>
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

std::vector<std::string> outputs(const Reported& reported) {
  std::vector<std::string> all;
  for (const JobEnd& end : reported.ends) all.push_back(end.out);
  return all;
}

int print_process() {
  std::printf("%d", getpid());
  return 0;
}

TEST(Jobs, ProcessesTakeOneAfterTheOther) {
  Reported reported;
  do_jobs(reported.list(40, [](std::size_t) { return print_process(); }), 2);
  const std::vector<std::string> all = outputs(reported);
  ASSERT_EQ(all.size(), 40u);
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), 2u);
}

// Whatever a job may leave behind ends with its process: those behind it are done in another, as if in a first one.
TEST(Jobs, AProcessThatIsNoLongerAsNewTakesNoOther) {
  const auto run = [](std::size_t job) {
    print_process();
    std::fflush(stdout);
    if (job == 1) raise(SIGKILL);  // a signal that no sanitizer takes
    if (job == 3) {
      rlimit limit = {0, RLIM_INFINITY};  // processes: those behind it could not begin a thread
      setrlimit(RLIMIT_NPROC, &limit);
      return 3;
    }
    if (job == 5) {
      const std::vector<double> much(std::size_t{1} << 23, 1.0);  // 64 MB
      return much.back() > 2.0 ? 1 : 0;
    }
    if (job == 7) std::exit(0);
    return 0;
  };
  Reported reported;
  do_jobs(reported.list(10, run), 1);
  const std::vector<std::string> process = outputs(reported);
  ASSERT_EQ(process.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(reported.ends[i].signal, i == 1 ? SIGKILL : 0) << i;
    EXPECT_EQ(reported.ends[i].exit_code, i == 3 ? 3 : 0) << i;
    EXPECT_EQ(process[i], process[i - i % 2]) << i << " is done by the process of the job before";
    if (i > 0 && i % 2 == 0) {
      EXPECT_NE(process[i], process[i - 1]) << i;
    }
  }
}

// A limit of the system on a process is one on each job.
TEST(Jobs, UnderALimitEachHasAProcess) {
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_CPU, &before), 0);
  const rlimit limit = {100000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_CPU, &limit), 0);
  Reported reported;
  do_jobs(reported.list(4, [](std::size_t) { return print_process(); }), 2);
  setrlimit(RLIMIT_CPU, &before);
  const std::vector<std::string> all = outputs(reported);
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), 4u);
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
