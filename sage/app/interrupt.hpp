// Ctrl-C and SIGTERM while decks are computed: the first is a wish, which runs end by;
// the second ends the process.
#pragma once

#include <signal.h>

namespace sage::app {

// While one lives, SIGINT and SIGTERM are heard.  A signal that the caller has the process ignore stays
// ignored. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  struct sigaction before_[2];
};

// Whether the first signal writes to standard error how the run ends (it does unless this is called).
void interrupts_are_announced(bool announced);

// Whether a signal has come since the watch began; false where there is none.  From any thread.
bool interrupted();

}  // namespace sage::app
