// Several decks at a time, in processes of their own: one that crashes or runs out of memory harms no other.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace sage::app {

/// What a job left behind.
struct JobEnd {
  int exit_code = 0;
  int signal = 0;        // that ended its process, 0 where it ended by itself
  std::string out, err;  // what it wrote to its standard streams
};

/// Jobs 0 ... count - 1: what each does, and what becomes of what it wrote.
struct JobList {
  std::size_t count = 0;
  std::function<int(std::size_t job)> run;                      // in another process; gives the exit code
  std::function<void(std::size_t job, const JobEnd& end)> end;  // here, in order of the jobs
  std::function<void(std::size_t job)> skip;                    // here, instead of both, after an interrupt
  // Here, several times a second: how many jobs have ended and how many are under way.  May be empty.
  std::function<void(std::size_t ended, std::size_t under_way)> wait = {};
};

/// Does the jobs, at most `at_a_time` at once.  A process does one after the other while they end with 0, leave no
/// memory behind and the system limits neither time nor memory of a process; else the next gets a new one.  Under an InterruptWatch an interrupt is passed on to the jobs
/// under way, and none begins after it.  The calling process must have no other thread.  Throws
/// std::system_error where no process can be started.
void do_jobs(const JobList& jobs, int at_a_time);

}  // namespace sage::app
