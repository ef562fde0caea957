// The profile of a run as a table for people and as JSON for programs.
#pragma once

#include <string>

#include "sage/platform/profile.hpp"

namespace sage {

// Phases below those that hold them: calls, seconds with and without those below, share of the whole run, billions
// of floating-point operations and their rate where they are known, and memory where it was measured.
std::string profile_table(const Profile& profile);

// {"sagefe", "case", "threads", "seconds", "accounted", "run": {"phase", "calls", "seconds", "own_seconds",
// "operations", "memory_bytes", "phases": [...]}}.  Times in s, with all phases below but for own_seconds;
// operations (floating-point) and memory_bytes (growth of the process) stand only where they are known.
// accounted: share of the time that named phases have.
std::string profile_json(const Profile& profile, const std::string& case_name, int threads,
                         const std::string& kernels);

}  // namespace sage
