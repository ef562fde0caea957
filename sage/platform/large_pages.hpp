// Memory in large pages: touching a new page of 4 kB costs more than filling it, and a run touches each once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sage {

inline constexpr std::size_t kLargePage = 2 * 1024 * 1024, kPage = 4096;

// A block for std::free, not initialised; nullptr if there is no memory.  Blocks that hold some large pages
// begin on one and ask the system for them; the rest of the last one stays small, so that little is wasted.
inline void* allocate_block(std::size_t bytes) {
  constexpr std::size_t kCacheLine = 64;
  const bool large = bytes >= 2 * kLargePage;
  void* p = nullptr;
  if (posix_memalign(&p, large ? kLargePage : kCacheLine, bytes > 0 ? bytes : 1) != 0) return nullptr;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (large) madvise(p, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);  // a wish: failure costs only time
#endif
  return p;
}

// Gives the system what was freed and is kept for later: before a phase that needs far more than that.
inline void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// Gives the system the whole pages of a part of such a block, whose contents are lost.
inline void return_pages([[maybe_unused]] void* part, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_DONTNEED)
  const auto begin = reinterpret_cast<std::uintptr_t>(part);
  const std::uintptr_t first = (begin + kPage - 1) / kPage * kPage, last = (begin + bytes) / kPage * kPage;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
#endif
}

// Gives a std::vector such blocks.
template <class T>
struct LargePageAllocator {
  using value_type = T;
  LargePageAllocator() = default;
  template <class Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}  // NOLINT: containers convert allocators
  T* allocate(std::size_t count) {
    void* p = allocate_block(count * sizeof(T));
    if (p == nullptr) throw std::bad_alloc();
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t) { std::free(p); }
  friend bool operator==(const LargePageAllocator&, const LargePageAllocator&) { return true; }
};

// For lists that grow with the matrix of a large system.
template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace sage
