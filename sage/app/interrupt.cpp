#include "sage/app/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <string_view>

#include "sage/app/progress.hpp"

namespace sage::app {

namespace {

constexpr int kSignals[2] = {SIGINT, SIGTERM};
std::atomic<bool> heard{false};
std::atomic<bool> announce{true};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

void on_signal(int number) {
  if (heard.exchange(true)) {
    end_progress_at_signal();
    signal(number, SIG_DFL);
    raise(number);
    return;
  }
  if (!announce) return;
  clear_progress_at_signal();
  constexpr std::string_view kText =
      "\nsagefe: stops after the increment in hand, or in 10 s; once more ends at once, without a checkpoint\n";
  if (write(STDERR_FILENO, kText.data(), kText.size()) < 0) return;  // nobody reads it
}

}  // namespace

InterruptWatch::InterruptWatch() {
  heard = false;
  struct sigaction ours = {};
  ours.sa_handler = on_signal;
  ours.sa_flags = SA_RESTART;
  sigemptyset(&ours.sa_mask);
  for (int i = 0; i < 2; ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &ours, nullptr);
  }
}

InterruptWatch::~InterruptWatch() {
  for (int i = 0; i < 2; ++i) sigaction(kSignals[i], &before_[i], nullptr);
  heard = false;
}

void interrupts_are_announced(bool announced) {
  announce = announced;
}

bool interrupted() {
  return heard.load(std::memory_order_relaxed);
}

}  // namespace sage::app
