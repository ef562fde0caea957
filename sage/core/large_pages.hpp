// Memory in large pages: touching a new page of 4 kB costs more than filling it, and a run touches each once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#include <sys/resource.h>
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

// For a process that is about to compute: the next blocks of the heap lie in large pages too, and what is freed stays for
// those that come.  Runs of 3000 to 50 000 equations spent a fifth of their time on small pages.  Not where the address
// space or the heap of a process is limited: that is what this takes.
inline void keep_heap_in_large_pages() {
#if defined(__GLIBC__) && defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr int kLargestInHeap = 32 * 1024 * 1024, kNever = std::numeric_limits<int>::max();
  for (const auto of_process : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (getrlimit(of_process, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return;
  }
  mallopt(M_MMAP_THRESHOLD, kLargestInHeap);
  mallopt(M_TRIM_THRESHOLD, kNever);
  std::array<void*, 8> blocks{};  // only to make the heap grow: nothing is touched
  constexpr std::size_t kBlock = kLargestInHeap - kLargePage;
  for (void*& block : blocks) block = std::malloc(kBlock);
  for (void*& block : blocks) {
    if (block == nullptr) continue;
    const std::uintptr_t first = (reinterpret_cast<std::uintptr_t>(block) + kPage - 1) / kPage * kPage;
    madvise(reinterpret_cast<void*>(first), kBlock - kPage, MADV_HUGEPAGE);  // a wish
  }
  for (void* block : blocks) std::free(block);
#endif
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
