// A build with sanitizers runs some ten times as slow and is there to see every line once: tests of many like cases try
// some of them there, and all in the other builds.
#pragma once

#include <cstddef>

namespace sage::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

constexpr std::size_t few_of(std::size_t all, std::size_t few) {
  return kSanitized && few < all ? few : all;
}

}  // namespace sage::test
