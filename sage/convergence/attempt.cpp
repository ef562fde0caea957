#include "sage/convergence/attempt.hpp"

#include <chrono>
#include <exception>

namespace sage::convergence {

Attempt attempt(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  Attempt one;
  try {
    run();
  } catch (const std::exception& error) {
    one = {true, error.what(), 0.0};
  } catch (...) {
    one = {true, "something that is no std::exception", 0.0};
  }
  one.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return one;
}

}  // namespace sage::convergence
