// Counts calls of operator new in this executable.  Link allocation_counter.cpp once.
#pragma once

#include <cstddef>

namespace sage::test {

// Calls of operator new since the start of the program.
std::size_t allocations();

}  // namespace sage::test
