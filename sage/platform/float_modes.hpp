// How the processor computes: rounding, traps, and whether small numbers are flushed to zero.  Code of others may change it
// and leave it so: a library built with -ffast-math does when it is loaded.
#pragma once

#include <fenv.h>

namespace sage {

class FloatModes {
 public:
  FloatModes() { fegetmode(&modes_); }
  // Of the thread that calls, as they were.
  void restore() const { fesetmode(&modes_); }

 private:
  femode_t modes_;
};

}  // namespace sage
