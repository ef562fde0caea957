#include "sage/record/in_order.hpp"

#include <system_error>

namespace sage {

InOrder::InOrder(bool own_thread, std::size_t most_bytes) : most_bytes_(most_bytes) {
  if (!own_thread) return;
  try {
    thread_ = std::thread([this] { serve(); });
  } catch (const std::system_error&) {
    // The system gives no more threads (memory, a limit): the owner does the tasks.
  }
}

InOrder::~InOrder() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  more_.notify_all();
  thread_.join();
}

void InOrder::add(std::size_t bytes, std::function<void()> task) {
  if (!thread_.joinable()) return task();
  std::unique_lock lock(mutex_);
  less_.wait(lock, [&] { return error_ || bytes_ == 0 || bytes_ + bytes <= most_bytes_; });
  if (error_) std::rethrow_exception(error_);
  waiting_.emplace_back(bytes, std::move(task));
  bytes_ += bytes;
  lock.unlock();
  more_.notify_one();
}

void InOrder::finish() {
  std::unique_lock lock(mutex_);
  less_.wait(lock, [&] { return error_ || (waiting_.empty() && !busy_); });
  if (error_) std::rethrow_exception(error_);
}

void InOrder::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    more_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
    if (stop_) return;
    auto [bytes, task] = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr error;
    try {
      task();
    } catch (...) {
      error = std::current_exception();
    }
    task = nullptr;
    lock.lock();
    busy_ = false;
    bytes_ -= bytes;
    if (error) {
      error_ = error;
      waiting_.clear();
      bytes_ = 0;
    }
    less_.notify_all();
    if (error) return;
  }
}

}  // namespace sage
