#include "sage/platform/thread_pool.hpp"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace sage::test {
namespace {

TEST(ThreadPool, EveryIndexRunsOnceInEveryRound) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    for (int round = 0; round < 50; ++round) {
      std::vector<std::atomic<int>> runs(37);
      const auto work = [&](int index, int thread) {
        ++runs[index];
        EXPECT_LT(thread, pool.threads());
      };
      pool.run(37, work);
      for (const auto& count : runs) EXPECT_EQ(count, 1);
    }
    const auto nothing = [](int, int) { FAIL(); };
    pool.run(0, nothing);
  }
}

TEST(ThreadPool, PiecesCoverAllRowsOnce) {
  ThreadPool three(3);
  for (ThreadPool* pool : {static_cast<ThreadPool*>(nullptr), &three})
    for (const std::size_t rows : {std::size_t{0}, std::size_t{1}, std::size_t{8191}, std::size_t{20001}}) {
      std::vector<int> runs(rows, 0);
      in_pieces(pool, rows, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) ++runs[i];
      });
      EXPECT_EQ(std::ranges::count(runs, 1), static_cast<std::ptrdiff_t>(rows));
    }
}

TEST(ThreadPool, TheExceptionOfTheSmallestIndexArrivesAndAllOthersRun) {
  ThreadPool pool(3);
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> runs{0};
    const auto work = [&](int index, int) {
      ++runs;
      if (index % 5 == 3) throw std::out_of_range(std::to_string(index));
    };
    try {
      pool.run(20, work);
      FAIL();
    } catch (const std::out_of_range& error) {
      EXPECT_STREQ(error.what(), "3");
    }
    EXPECT_EQ(runs, 20);
  }
}

}  // namespace
}  // namespace sage::test
