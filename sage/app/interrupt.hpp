// Ctrl-C and SIGTERM while decks are computed: the first asks runs to end, and ends the process where they have not
// within 10 s; the second ends the process at once.
#pragma once

#include <signal.h>

namespace sage::app {

// While one lives, SIGINT and SIGTERM are heard, and SIGALRM and the timer of the process are its own.  A signal that
// the caller has the process ignore stays ignored. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  struct sigaction before_[3];
};

// Whether the first signal writes to standard error how the run ends (it does unless this is called).
void interrupts_are_announced(bool announced);

// Whether a signal has come since the watch began; false where there is none.  From any thread.
bool interrupted();

// s since that signal; 0 where there is none.
double seconds_since_interrupt();

}  // namespace sage::app
