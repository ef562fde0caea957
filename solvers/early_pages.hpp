// Pages of a large block, touched by another thread while this one prepares what comes into them.
#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <system_error>

#include "sage/platform/large_pages.hpp"

namespace sage {

// The first touch of a page costs as much as filling it: a fifth of the factorisation of 800 000 equations.
class EarlyPages {
 public:
  EarlyPages() = default;
  ~EarlyPages() { stop(); }
  EarlyPages(const EarlyPages&) = delete;
  EarlyPages& operator=(const EarlyPages&) = delete;

  // Writes a zero into every page of a block that is not initialised.  stop() must come before the block is used.
  void start(void* block, std::size_t bytes) {
    stop();
    stopped_ = false;
    try {
      work_ = std::async(std::launch::async, [this, first = static_cast<char*>(block), bytes] {
        for (std::size_t at = 0; at < bytes && !stopped_; at += kPage) first[at] = 0;
      });
    } catch (const std::system_error&) {
      // The system gives no more threads: pages come when they are used.
    }
  }

  void stop() {
    stopped_ = true;
    if (work_.valid()) work_.wait();
    work_ = {};
  }

 private:
  std::future<void> work_;
  std::atomic<bool> stopped_{true};
};

}  // namespace sage
