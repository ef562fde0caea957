// A shared object with the whole program behind one C function.
#include "sage/app/program.hpp"

extern "C" int run_sagefe(int argc, char** argv) {
  return sage::sagefe(argc, argv);
}
