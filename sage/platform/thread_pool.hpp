// A few threads that wait for work, so that those who have some neither start threads nor allocate.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace sage {

class ThreadPool {
 public:
  // The caller is one of the threads: a pool of 1 starts none.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  // Calls work(index, thread) for index 0 .. count - 1, thread in 0 .. threads() - 1, and returns when all are
  // done.  Indices are taken in ascending order by whoever is free.  Every one runs, whatever the others throw;
  // then the exception of the smallest index is thrown again.
  template <class Work>
  void run(int count, const Work& work) {
    run_all(
        count,
        [](const void* context, int index, int thread) { (*static_cast<const Work*>(context))(index, thread); },
        &work);
  }

 private:
  using Call = void (*)(const void* context, int index, int thread);
  void run_all(int count, Call call, const void* context);
  void take_part(int thread);
  void serve(int thread);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable start_, finish_;
  // All below belongs to the mutex.
  Call call_ = nullptr;
  const void* context_ = nullptr;
  int count_ = 0, next_ = 0, running_ = 0;
  long round_ = 0;
  bool stop_ = false;
  int failed_ = -1;  // smallest index that threw
  std::exception_ptr error_;
};

// Calls work(first, last) for pieces of 0 .. count - 1 that do not depend on each other: on the pool's threads where there
// is one and the rows are many, else once.
template <class Work>
void in_pieces(ThreadPool* pool, std::size_t count, const Work& work) {
  constexpr std::size_t kPiece = 1024, kMany = 8 * kPiece;
  if (pool == nullptr || count < kMany) return work(std::size_t{0}, count);
  pool->run(static_cast<int>((count + kPiece - 1) / kPiece), [&](int piece, int /*thread*/) {
    const std::size_t first = static_cast<std::size_t>(piece) * kPiece;
    work(first, std::min(first + kPiece, count));
  });
}

}  // namespace sage
