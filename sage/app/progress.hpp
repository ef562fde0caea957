// A line on the terminal that says what goes on, how much is done and how long the rest may take; nothing where
// standard error is no screen, or with --quiet.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "sage/platform/pulse.hpp"

namespace sage::app {

// Something that takes time.  While one lives, a thread shows it several times a second; tasks within tasks stand
// on one line, the outer ones first.  Made and ended by one thread.
class Task {
 public:
  // without_thread: of a process that will fork; it is shown by show_progress() alone.
  explicit Task(std::string name, bool without_thread = false);
  ~Task();
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  // Number `number` (from 1) of `count` parts begins.
  void part(const std::string& name, int number, int count);
  // For the analysis of this task to be shown in; null where nothing is shown.
  Pulse* pulse();

 private:
  friend struct TaskLine;
  using Clock = std::chrono::steady_clock;
  std::string name_, part_;
  int number_ = 0, count_ = 0;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point counted_;   // when the share of the analysis was first known
  double share_at_start_ = -1;  // then: a restart begins behind its checkpoint
  Pulse pulse_;
  bool shown_ = false;
};

// Shows the tasks as they are now, if it is time to.
void show_progress();

// While one lives the terminal has no such line: for other text on it.
class ProgressPause {
 public:
  ProgressPause();
  ~ProgressPause();
  ProgressPause(const ProgressPause&) = delete;
  ProgressPause& operator=(const ProgressPause&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

// Takes the line away; for signal handlers.
void clear_progress_at_signal();

// The same where the signal ends the process: no line follows.
void end_progress_at_signal();
// No lines from now on: in a process whose streams are another's.
void no_progress_here();

}  // namespace sage::app
