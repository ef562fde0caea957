// What routines of others write to standard output (unit 6 of Fortran) while this lives, which would flood the
// program's own.
#pragma once

#include <string>
#include <thread>

#include "sage/umat/routine.hpp"

namespace sage::umat {

class Capture {
 public:
  // Keeps the first `most` bytes.  Throws std::system_error.
  explicit Capture(std::size_t most);
  ~Capture();
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  // Standard output is as before; gives what came, and how many bytes.  Once.
  struct Text {
    std::string first;
    std::size_t bytes = 0;
  };
  Text end();

 private:
  void read();
  std::size_t most_;
  int own_ = -1, from_ = -1;  // the program's standard output; the end of the pipe that is read
  Text text_;
  std::thread reader_;
};

}  // namespace sage::umat
