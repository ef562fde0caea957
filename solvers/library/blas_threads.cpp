#include "solvers/library/blas_threads.hpp"

#include <algorithm>
#include <thread>

// Weak: absent where another BLAS is installed.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace sage {

void set_blas_threads(int equations) {
  constexpr int kThreadedEquations = 50000;
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (openblas_set_num_threads) openblas_set_num_threads(equations < kThreadedEquations ? 1 : all);
}

}  // namespace sage
