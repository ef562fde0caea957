#include "sage/app/interrupt.hpp"

#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <string_view>

#include "sage/app/exit_codes.hpp"
#include "sage/app/progress.hpp"

namespace sage::app {

namespace {

constexpr int kSignals[3] = {SIGINT, SIGTERM, SIGALRM};
// s after the signal: a process ends that has not ended by itself.  A worker ends first, so that the process above it
// can still name it.
constexpr double kLastMoment = 9.5, kLastMomentOfWorkers = 9.0;
std::atomic<bool> heard{false};
std::atomic<bool> announce{true};
std::atomic<long> heard_at{0};  // ms of the monotonic clock
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<long>::is_always_lock_free,
              "a signal handler sets them");

long now_in_ms() {
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

void say_at_signal(std::string_view text) {
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // nobody reads it
}

void ring_after(double seconds) {
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec =
      static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(timer.it_value.tv_sec)));
  setitimer(ITIMER_REAL, &timer, nullptr);
}

// A routine that never returns or a file that nobody reads keeps the process from ending by itself.
void on_alarm(int) {
  end_progress_at_signal();
  say_at_signal(
      "sagefe: interrupted, and ended within 10 s because it could not stop by itself: a user routine, a file "
      "or a module does not return; files being written keep the name NAME.partial ["
      "S633"
      "]\n");
  // Not _exit(), which is a routine's own where the signal interrupts one (sage/umat/routine.cpp).
  for (;;) syscall(SYS_exit_group, kInterrupted);
}

void on_signal(int number) {
  if (heard.exchange(true)) {
    end_progress_at_signal();
    signal(number, SIG_DFL);
    raise(number);
    return;
  }
  heard_at = now_in_ms();
  ring_after(announce ? kLastMoment : kLastMomentOfWorkers);
  if (!announce) return;
  clear_progress_at_signal();
  say_at_signal(
      "\nsagefe: stops after the increment in hand, or in 10 s; once more ends at once, without a "
      "checkpoint\n");
}

}  // namespace

InterruptWatch::InterruptWatch() {
  heard = false;
  struct sigaction ours = {};
  ours.sa_flags = SA_RESTART;
  sigemptyset(&ours.sa_mask);
  for (int i = 0; i < 3; ++i) {
    ours.sa_handler = kSignals[i] == SIGALRM ? on_alarm : on_signal;
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN || kSignals[i] == SIGALRM) sigaction(kSignals[i], &ours, nullptr);
  }
}

InterruptWatch::~InterruptWatch() {
  if (heard) ring_after(0.0);  // never
  for (int i = 0; i < 3; ++i) sigaction(kSignals[i], &before_[i], nullptr);
  heard = false;
}

void interrupts_are_announced(bool announced) {
  announce = announced;
}

bool interrupted() {
  return heard.load(std::memory_order_relaxed);
}

double seconds_since_interrupt() {
  return interrupted() ? 1e-3 * static_cast<double>(now_in_ms() - heard_at) : 0.0;
}

}  // namespace sage::app
