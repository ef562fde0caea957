// Work in a process of its own, so that a library that crashes does not take the program with it.
#pragma once

#include <functional>
#include <string>

namespace sage {

// Whether the system limits the memory of this process (ulimit -v, ulimit -d), or promises none that it does not have:
// an allocation may fail then.
bool memory_may_fail();

// Does the work in a child of this process and waits for its end; here, where no child can be made.  What the work
// changes in memory is lost.  Throws what the work throws, as OutputError or std::bad_alloc; OutputError, which begins
// with `what`, where a signal ends the child.
void run_apart(const std::string& what, const std::function<void()>& work);

}  // namespace sage
