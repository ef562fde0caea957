// Tasks that another thread does one after the other, while their owner makes the next.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace sage {

// What tasks do does not depend on who does them: without a thread of its own each is done as it is added.
class InOrder {
 public:
  // most_bytes: of what waits; where it is more, add() waits.
  InOrder(bool own_thread, std::size_t most_bytes);
  // What still waits is not done.
  ~InOrder();
  InOrder(const InOrder&) = delete;
  InOrder& operator=(const InOrder&) = delete;

  // bytes: that the task holds.  Throws what an earlier task threw; behind that one nothing is done.
  void add(std::size_t bytes, std::function<void()> task);
  // Returns when all are done, or throws as add() does.
  void finish();

 private:
  void serve();

  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable more_, less_;
  // All below belongs to the mutex.
  std::deque<std::pair<std::size_t, std::function<void()>>> waiting_;
  std::size_t bytes_ = 0;  // of those that wait and the one under way
  bool busy_ = false, stop_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // the last member: it sees all others
};

// Lists that are used again, so that their memory is not asked for, and filled with zeros, once more.
template <class List>
class ListPool {
 public:
  // Holds `size` items of any value.
  List take(std::size_t size) {
    List list;
    {
      const std::lock_guard lock(mutex_);
      const auto fits = [&](const List& one) { return one.capacity() >= size; };
      if (const auto found = std::ranges::find_if(free_, fits); found != free_.end()) {
        list = std::move(*found);
        free_.erase(found);
      }
    }
    list.resize(size);
    return list;
  }
  void give(List list) {
    const std::lock_guard lock(mutex_);
    const auto at =
        std::ranges::find_if(free_, [&](const List& one) { return one.capacity() >= list.capacity(); });
    if (free_.size() < kMost) free_.insert(at, std::move(list));
  }

 private:
  static constexpr std::size_t kMost = 32;
  std::mutex mutex_;
  std::vector<List> free_;  // from the smallest on
};

}  // namespace sage
