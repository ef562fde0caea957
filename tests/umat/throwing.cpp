// A user material in C++ that throws.
#include <stdexcept>

extern "C" void umat() {
  throw std::runtime_error("no licence");
}
