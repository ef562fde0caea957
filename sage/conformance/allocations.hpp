// Counts calls of operator new and posix_memalign in an executable that asks for them.
#pragma once

#include <cstddef>

namespace sage::conformance {

// Calls since the start of the program.
std::size_t allocations();

}  // namespace sage::conformance
