#include "solvers/library/blas_threads.hpp"

#include <algorithm>
#include <thread>

#include "solvers/address_space.hpp"

// Weak: absent where another BLAS is installed.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace sage {

std::mutex& LibraryCall::mutex() {
  static std::mutex of_process;
  return of_process;
}

LibraryCall::LibraryCall(int equations) : lock_(mutex()) {
  constexpr int kThreadedEquations = 50000;
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (!openblas_set_num_threads) return;
  const int wanted = equations < kThreadedEquations ? 1 : all;
  static int with_buffers = 0;  // once it has them they are kept
  if (wanted > with_buffers)
    expect_address_space(kBlasBuffer * static_cast<std::size_t>(wanted - with_buffers));
  with_buffers = std::max(with_buffers, wanted);
  openblas_set_num_threads(wanted);
}

}  // namespace sage
