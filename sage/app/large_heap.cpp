#include "sage/app/large_heap.hpp"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "sage/app/process_limit.hpp"
#include "sage/platform/large_pages.hpp"

namespace sage::app {

void keep_heap_in_large_pages() {
#if defined(__GLIBC__) && defined(__linux__) && defined(MADV_HUGEPAGE)
  if (is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA)) return;
  constexpr int kLargestInHeap = 32 * 1024 * 1024, kNever = std::numeric_limits<int>::max();
  mallopt(M_MMAP_THRESHOLD, kLargestInHeap);
  mallopt(M_TRIM_THRESHOLD, kNever);
  std::array<void*, 8> blocks{};  // only to make the heap grow: nothing is touched
  constexpr std::size_t kBlock = kLargestInHeap - kLargePage;
  for (void*& block : blocks) block = std::malloc(kBlock);
  for (void* const block : blocks) {
    if (block == nullptr) continue;
    const std::uintptr_t first = (reinterpret_cast<std::uintptr_t>(block) + kPage - 1) / kPage * kPage;
    madvise(reinterpret_cast<void*>(first), kBlock - kPage, MADV_HUGEPAGE);  // a wish
  }
  for (void* const block : blocks) std::free(block);
#endif
}

}  // namespace sage::app
