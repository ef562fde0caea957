// Counts calls of operator new and posix_memalign in this executable.  Link allocation_counter.cpp once.
#pragma once

#include <cstddef>

namespace sage::test {

// Calls since the start of the program.
std::size_t allocations();

}  // namespace sage::test
