#pragma once

namespace sage::app {

/// For a process that is about to compute: the next blocks of the heap lie in large pages too (sage/platform/large_pages.hpp),
/// and what is freed stays for those that come.  Runs of 3000 to 50 000 equations spent a fifth of their time on small
/// pages.  Nothing where the address space or the heap of a process is limited: that is what this takes.
void keep_heap_in_large_pages();

}  // namespace sage::app
