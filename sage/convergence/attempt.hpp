// One case of a book of cases, run so that what it throws is an answer too.
#pragma once

#include <functional>
#include <string>

namespace sage::convergence {

struct Attempt {
  bool threw = false;
  std::string thrown;  // its words
  double seconds = 0.0;
};

// Never throws.
Attempt attempt(const std::function<void()>& run);

}  // namespace sage::convergence
