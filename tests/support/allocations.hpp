// Counts every allocation of a test program that links allocations.cpp.
#pragma once

namespace sage::test {

long allocations();  // so far

}  // namespace sage::test
