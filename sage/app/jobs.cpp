#include "sage/app/jobs.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <system_error>
#include <vector>

#include "sage/app/interrupt.hpp"

namespace sage::app {

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

// A file in memory, without a name.
class Scratch {
 public:
  Scratch() : file_(memfd_create("output of a deck", 0)) {
    if (file_ < 0) fail("no room for the output of a deck");
  }
  ~Scratch() { close(file_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  int number() const { return file_; }

  std::string text() const {
    std::string all;
    char block[4096];
    for (ssize_t n = 0; (n = pread(file_, block, sizeof block, static_cast<off_t>(all.size()))) > 0;)
      all.append(block, static_cast<std::size_t>(n));
    return all;
  }

 private:
  int file_;
};

// The process of one job.  A pipe that only it writes to closes when it ends, whatever ends it.
class Process {
 public:
  Process(const JobList& jobs, std::size_t job) {
    int ends[2];
    if (pipe(ends) != 0) fail("no pipe for the process of a deck");
    std::fflush(nullptr);  // or the new process would write it too
    const pid_t parent = getpid();
    id_ = fork();
    if (id_ == 0) {
      close(ends[0]);
      become(jobs, job, parent);
    }
    close(ends[1]);
    alive_ = ends[0];
    if (id_ > 0) return;
    close(alive_);
    fail("no process for a deck");
  }
  ~Process() {
    if (id_ > 0) {  // an error ends the list
      kill(id_, SIGKILL);
      waitpid(id_, nullptr, 0);
    }
    close(alive_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  int alive() const { return alive_; }
  void interrupt() const { kill(id_, SIGTERM); }

  JobEnd end() {
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 0, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
            out_.text(), err_.text()};
  }

 private:
  // In the new process.  Ctrl-C reaches a whole group: in one of its own a job is interrupted once, by interrupt().
  [[noreturn]] void become(const JobList& jobs, std::size_t job, pid_t parent) const {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) std::_Exit(128 + SIGTERM);  // it ended before the line above
    dup2(out_.number(), STDOUT_FILENO);
    dup2(err_.number(), STDERR_FILENO);
    interrupts_are_announced(false);
    const int code = jobs.run(job);
    const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    std::fflush(stderr);
    std::_Exit(written ? code : EXIT_FAILURE);
  }

  Scratch out_, err_;
  pid_t id_ = 0;
  int alive_ = -1;
};

class Queue {
 public:
  Queue(const JobList& jobs, int at_a_time) : jobs_(jobs), at_a_time_(static_cast<std::size_t>(at_a_time)) {}

  void run() {
    while (ended_ < jobs_.count) {
      if (interrupted() && !passed_on_) pass_on();
      while (!passed_on_ && next_ < jobs_.count && under_way_.size() < at_a_time_) begin();
      if (!under_way_.empty()) wait();
      report();
    }
  }

 private:
  void begin() {
    under_way_.try_emplace(next_, jobs_, next_);
    ++next_;
  }

  void pass_on() {
    passed_on_ = true;
    for (const auto& [job, process] : under_way_) process.interrupt();
  }

  // An interrupt ends the wait too: poll() is never begun again by itself.
  void wait() {
    std::vector<pollfd> streams;
    for (const auto& [job, process] : under_way_) streams.push_back({process.alive(), POLLIN, 0});
    constexpr int kMilliseconds = 200;  // a signal that comes between the test of it and the wait
    if (poll(streams.data(), streams.size(), kMilliseconds) <= 0) return;
    auto process = under_way_.begin();
    for (const pollfd& stream : streams) {
      const auto here = process++;
      if (stream.revents == 0) continue;
      ends_.emplace(here->first, here->second.end());
      under_way_.erase(here);
    }
  }

  // In order: what ended early waits for those before it.
  void report() {
    for (;; ++ended_) {
      const auto end = ends_.find(ended_);
      if (end != ends_.end()) {
        jobs_.end(end->first, end->second);
        ends_.erase(end);
      } else if (passed_on_ && ended_ >= next_ && ended_ < jobs_.count) {
        jobs_.skip(ended_);
      } else {
        return;
      }
    }
  }

  const JobList& jobs_;
  std::size_t at_a_time_;
  std::size_t next_ = 0, ended_ = 0;
  bool passed_on_ = false;
  std::map<std::size_t, Process> under_way_;
  std::map<std::size_t, JobEnd> ends_;
};

}  // namespace

void do_jobs(const JobList& jobs, int at_a_time) {
  Queue(jobs, std::max(1, at_a_time)).run();
}

}  // namespace sage::app
