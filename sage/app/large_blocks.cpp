// Replaces the global operator new: blocks of some megabytes lie in large pages (sage/platform/large_pages.hpp).
// A run of 800 000 equations spent as long on page faults as on arithmetic.
#include <new>

#include "sage/platform/large_pages.hpp"

void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return bytes < 2 * sage::kLargePage ? std::malloc(bytes > 0 ? bytes : 1) : sage::allocate_block(bytes);
}
void* operator new(std::size_t bytes) {
  void* p = ::operator new(bytes, std::nothrow);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
