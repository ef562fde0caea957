#include "sage/record/apart.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <new>

#include "sage/messages/error.hpp"

namespace sage {

namespace {

// Exit codes of the child.
constexpr int kDone = 0, kFailed = 1, kNoMemory = 2;

bool is_limited(int what) {
  rlimit limit = {};
  return getrlimit(static_cast<decltype(RLIMIT_AS)>(what), &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

// The messages of libraries that crash would stand beside the program's own.
void become_silent() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(signal, SIG_DFL);
  const rlimit none = {0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
}

void send(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t done = ::write(descriptor, text.data() + at, text.size() - at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return;
    at += static_cast<std::size_t>(done);
  }
}

std::string received(int descriptor) {
  std::string text;
  std::array<char, 1024> piece;
  for (ssize_t got = 1; got != 0;) {
    got = ::read(descriptor, piece.data(), piece.size());
    if (got < 0 && errno != EINTR) break;
    if (got > 0) text.append(piece.data(), static_cast<std::size_t>(got));
  }
  return text;
}

[[noreturn]] void work_as_child(int channel, const std::function<void()>& work) {
  become_silent();
  int code = kDone;
  try {
    work();
  } catch (const std::bad_alloc&) {
    code = kNoMemory;
  } catch (const std::exception& error) {
    code = kFailed;
    send(channel, message_of(error));
  }
  std::_Exit(code);
}

}  // namespace

bool memory_may_fail() {
  constexpr int kStrict = 2;  // nothing is promised that is not there
  int mode = 0;
  std::ifstream("/proc/sys/vm/overcommit_memory") >> mode;
  return mode == kStrict || is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA);
}

void run_apart(const std::string& what, const std::function<void()>& work) {
  std::array<int, 2> channel{};
  if (pipe2(channel.data(), O_CLOEXEC) != 0) return work();
  const pid_t child = fork();
  if (child == 0) work_as_child(channel[1], work);
  close(channel[1]);
  const std::string message = child > 0 ? received(channel[0]) : "";
  close(channel[0]);
  if (child < 0) return work();
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status))
    throw OutputError("S605", what + ": the library crashed (signal " + std::to_string(WTERMSIG(status)) +
                                  "), as it does where memory runs out under a limit");
  const int code = WEXITSTATUS(status);
  if (code == kNoMemory) throw std::bad_alloc();
  if (code != kDone) throw OutputError(code_in(message).value_or(Code("S601")), message);
}

}  // namespace sage
