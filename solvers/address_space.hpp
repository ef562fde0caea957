// Whether the process may have more memory, asked before a library that could not bear to be refused any.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>

namespace sage {

// What OpenBLAS maps for each thread that computes; where it is refused (ulimit -v) it asks again for ever.
inline constexpr std::size_t kBlasBuffer = std::size_t{128} << 20;

// Throws std::bad_alloc if so many bytes can't be mapped now.
inline void expect_address_space(std::size_t bytes) {
  void* place = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  munmap(place, bytes);
}

}  // namespace sage
