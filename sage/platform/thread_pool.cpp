#include "sage/platform/thread_pool.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace sage {

ThreadPool::ThreadPool(int threads) {
  workers_.reserve(std::max(0, threads - 1));
  try {
    for (int t = 1; t < threads; ++t) workers_.emplace_back([this, t] { serve(t); });
  } catch (const std::system_error&) {
    // The system gives no more threads (memory, a limit): the work is done by those that there are.
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::run_all(int count, Call call, const void* context) {
  {
    const std::lock_guard lock(mutex_);
    call_ = call;
    context_ = context;
    count_ = count;
    next_ = 0;
    failed_ = -1;
    running_ = threads();
    ++round_;
  }
  start_.notify_all();
  take_part(0);
  std::unique_lock lock(mutex_);
  finish_.wait(lock, [&] { return running_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void ThreadPool::take_part(int thread) {
  std::unique_lock lock(mutex_);
  while (next_ < count_) {
    const int index = next_++;
    lock.unlock();
    std::exception_ptr error;
    try {
      call_(context_, index, thread);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error && (failed_ < 0 || index < failed_)) {
      failed_ = index;
      error_ = error;
    }
  }
  if (--running_ == 0) finish_.notify_one();
}

void ThreadPool::serve(int thread) {
  long done = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      start_.wait(lock, [&] { return stop_ || round_ != done; });
      if (stop_) return;
      done = round_;
    }
    take_part(thread);
  }
}

}  // namespace sage
