// sagefe: the command line.  The only folder that knows all others.
#include "sage/app/program.hpp"

int main(int argc, char** argv) {
  return sage::sagefe(argc, argv);
}
