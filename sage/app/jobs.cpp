#include "sage/app/jobs.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <system_error>
#include <vector>

#include "sage/app/interrupt.hpp"
#include "sage/app/process_limit.hpp"

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
    fcntl(file_, F_SETFL, O_APPEND);  // the next job's output begins where the file ends
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

  void empty() const {
    if (ftruncate(file_, 0) != 0) fail("the output of a deck can't be removed");
  }

 private:
  int file_;
};

// What the limits of the system count is of a whole process: then each job gets one of its own.
bool limits_count_a_process() {
  return is_limited(RLIMIT_CPU) || is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA);
}

// The largest size that the process has had, in kB.
long largest_size() {
  rusage use = {};
  getrusage(RUSAGE_SELF, &use);
  return use.ru_maxrss;
}

// A process that does one job after the other.  Parent and worker have an end each of a channel: a byte from the
// worker says that it has done its job with exit code 0 and takes another, a number from the parent is that of
// its next job.  The worker's end closes when it ends, whatever ends it.
class Worker {
 public:
  using Crew = std::vector<std::unique_ptr<Worker>>;

  // With its first job.  A new process has copies of the ends that the parent holds to the others of the crew:
  // it closes them, or those would not see the parent's end close.
  Worker(const JobList& jobs, std::size_t job, const Crew& crew) : job_(job) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) fail("no channel to the process of a deck");
    std::fflush(nullptr);  // or the new process would write it too
    const pid_t parent = getpid();
    id_ = fork();
    if (id_ == 0) {
      close(ends[0]);
      for (const auto& other : crew) close(other->channel_);
      channel_ = ends[1];
      become(jobs, parent);
    }
    close(ends[1]);
    channel_ = ends[0];
    if (id_ > 0) return;
    close(channel_);
    fail("no process for a deck");
  }
  ~Worker() {
    if (id_ > 0) {  // an error ends the list
      kill(id_, SIGKILL);
      waitpid(id_, nullptr, 0);
    }
    close(channel_);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  int channel() const { return channel_; }
  std::size_t job() const { return job_; }
  void interrupt() const { kill(id_, SIGTERM); }

  // Whether it has done its job and takes another; false: it has ended.
  bool takes_another() const {
    char done = 0;
    return receive(done);
  }

  JobEnd done() const { return {0, 0, out_.text(), err_.text()}; }

  // False where it has ended meanwhile: the job has not begun.
  bool give(std::size_t job) {
    out_.empty();
    err_.empty();
    job_ = job;
    return send(channel_, &job, sizeof job, MSG_NOSIGNAL) == sizeof job;
  }

  // Waits until it has ended, which it does soon behind its last job.
  JobEnd end() {
    shutdown(channel_, SHUT_RDWR);
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 0, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
            out_.text(), err_.text()};
  }

 private:
  // False where the other end is closed.
  bool receive(auto& message) const {
    ssize_t got = 0;
    while ((got = recv(channel_, &message, sizeof message, MSG_WAITALL)) < 0 && errno == EINTR) {
    }
    return got == sizeof message;
  }

  // In the new process.  Ctrl-C reaches a whole group: in one of its own a job is interrupted once, by interrupt().
  [[noreturn]] void become(const JobList& jobs, pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) std::_Exit(128 + SIGTERM);  // it ended before the line above
    dup2(out_.number(), STDOUT_FILENO);
    dup2(err_.number(), STDERR_FILENO);
    interrupts_are_announced(false);
    const bool one_job = limits_count_a_process();
    const long size = largest_size();
    for (;;) {
      const int code = jobs.run(job_);
      const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
      std::fflush(stderr);
      if (!written) std::_Exit(EXIT_FAILURE);
      if (code != 0 || one_job || largest_size() > size + kMostGrowth) std::_Exit(code);
      const char done = 0;
      send(channel_, &done, sizeof done, MSG_NOSIGNAL);
      if (!receive(job_)) std::_Exit(code);
    }
  }

  static constexpr long kMostGrowth = 32 * 1024;  // kB: what a larger job leaves behind goes with its process

  Scratch out_, err_;
  std::size_t job_;
  pid_t id_ = 0;
  int channel_ = -1;
};

class Queue {
 public:
  Queue(const JobList& jobs, int at_a_time) : jobs_(jobs), at_a_time_(static_cast<std::size_t>(at_a_time)) {}

  void run() {
    while (ended_ < jobs_.count) {
      if (interrupted() && !passed_on_) pass_on();
      while (more() && crew_.size() < at_a_time_) begin();
      if (!crew_.empty()) wait();
      report();
    }
  }

 private:
  bool more() const { return !interrupted() && next_ < jobs_.count; }

  void begin() {
    crew_.push_back(std::make_unique<Worker>(jobs_, next_, crew_));
    ++next_;
  }

  void pass_on() {
    passed_on_ = true;
    for (const auto& worker : crew_) worker->interrupt();
  }

  // An interrupt ends the wait too: poll() is never begun again by itself.
  void wait() {
    std::vector<pollfd> channels;
    for (const auto& worker : crew_) channels.push_back({worker->channel(), POLLIN, 0});
    if (jobs_.wait) jobs_.wait(ended_ + ends_.size(), crew_.size());
    constexpr int kMilliseconds = 200;  // a signal that comes between the test of it and the wait
    if (poll(channels.data(), channels.size(), kMilliseconds) <= 0) return;
    for (std::size_t i = 0; i < channels.size(); ++i)
      if (channels[i].revents != 0 && !goes_on(*crew_[i])) crew_[i].reset();
    std::erase(crew_, nullptr);
  }

  // Takes the end of the worker's job; false where the worker has ended with it, or there is nothing more to do.
  bool goes_on(Worker& worker) {
    const bool takes_another = worker.takes_another();
    ends_.emplace(worker.job(), takes_another ? worker.done() : worker.end());
    if (!takes_another) return false;
    if (more() && worker.give(next_)) {
      ++next_;
      return true;
    }
    worker.end();
    return false;
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
  Worker::Crew crew_;
  std::map<std::size_t, JobEnd> ends_;
};

}  // namespace

void do_jobs(const JobList& jobs, int at_a_time) {
  Queue(jobs, std::max(1, at_a_time)).run();
}

}  // namespace sage::app
