// Limits that the system sets a process (ulimit).
#pragma once

#include <sys/resource.h>

namespace sage::app {

/// Whether there is one, RLIMIT_AS for instance; also where the system does not say.
inline bool is_limited(decltype(RLIMIT_AS) what) {
  rlimit limit = {};
  return getrlimit(what, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace sage::app
