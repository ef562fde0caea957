// `sagefe` with pieces of one's own (own_pieces.cpp).  This is the example of docs/manual/own_program.md.
#include "own_pieces.hpp"
#include "sage/app/program.hpp"

int main(int argc, char** argv) {
  return sage::sagefe(argc, argv, own::add_pieces);
}
