// A wish from outside that a run should end early: a deadline, an interrupt.
#pragma once

#include <exception>
#include <functional>

namespace sage {

// True once the work should end; it stays true.  Called often and from several threads at once: it must be
// cheap and take no lock.  Empty = nobody asks.
using StopAsked = std::function<bool()>;

// Leaves the work in hand.  Caught by the run, whose committed state stands.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped as asked"; }
};

// Throws Stopped.
inline void stop_if_asked(const StopAsked& asked) {
  if (asked && asked()) throw Stopped();
}

}  // namespace sage
