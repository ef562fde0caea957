// The program without its main(), so that a test can run it in a child process of its own.
#pragma once

namespace sage::app {

// From the command line to an exit code (sage/app/exit_codes.hpp); prints to the standard streams.
int run_program(int argc, char** argv);

}  // namespace sage::app
