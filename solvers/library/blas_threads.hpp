// Calls of library solvers.
#pragma once

#include <mutex>

namespace sage {

// One call of a library for a system of so many equations.  The number of threads of OpenBLAS, and variables of MUMPS,
// belong to the process: analyses in several threads call the libraries one after the other, each with its own number, so
// that no result depends on another analysis.
// One thread below 50 000 equations, where a second one costs more than it saves; all above.  Without OpenBLAS the number
// is left alone.
class LibraryCall {
 public:
  explicit LibraryCall(int equations);
  // Held during a call.
  static std::mutex& mutex();

 private:
  std::lock_guard<std::mutex> lock_;
};

}  // namespace sage
