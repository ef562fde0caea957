#include "sage/umat/capture.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace sage::umat {

namespace {

// All units of the libraries' Fortran runtime, gfortran's.
void flush_fortran() {
  if (!may_flush()) return;
  for (const OpenedLibrary& library : opened_libraries())
    if (void* flush = dlsym(library.handle, "_gfortran_flush_i4"))
      reinterpret_cast<void (*)(const int*)>(flush)(nullptr);
}

}  // namespace

Capture::Capture(std::size_t most) : most_(most) {
  std::fflush(stdout);
  std::array<int, 2> ends{};
  own_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (own_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0) {
    const int reason = errno;
    if (own_ >= 0) close(own_);
    throw std::system_error(reason, std::generic_category(), "the output of a UMAT can't be caught");
  }
  from_ = ends[0];
  dup2(ends[1], STDOUT_FILENO);
  close(ends[1]);
  reader_ = std::thread([this] { read(); });
}

Capture::~Capture() {
  end();
}

void Capture::read() {
  std::array<char, 65536> piece;
  for (ssize_t n = 0; (n = ::read(from_, piece.data(), piece.size())) != 0;) {
    if (n < 0 && errno != EINTR) break;
    if (n < 0) continue;
    const auto size = static_cast<std::size_t>(n);
    text_.first.append(piece.data(), std::min(size, most_ - std::min(most_, text_.first.size())));
    text_.bytes += size;
  }
}

Capture::Text Capture::end() {
  if (own_ < 0) return {};
  flush_fortran();
  std::fflush(stdout);
  dup2(own_, STDOUT_FILENO);  // closes the pipe's last end: the reader finishes
  close(std::exchange(own_, -1));
  reader_.join();
  close(from_);
  return std::move(text_);
}

}  // namespace sage::umat
