// What the process tells the shell; listed in `sagefe --help`.
#pragma once

namespace sage::app {

inline constexpr int kOk = 0;
inline constexpr int kUsage = 1;         // the command line
inline constexpr int kInput = 2;         // a deck, layout or mesh file
inline constexpr int kNotConverged = 3;  // the analysis: no equilibrium, singular matrix
inline constexpr int kOutput = 4;        // results could not be written
inline constexpr int kInterrupted = 5;   // Ctrl-C or SIGTERM, once: the run ended with a checkpoint

// All of them, for tests.
inline constexpr int kExitCodes[] = {kOk, kUsage, kInput, kNotConverged, kOutput, kInterrupted};

}  // namespace sage::app
