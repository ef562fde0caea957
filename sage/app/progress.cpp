#include "sage/app/progress.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <ctime>
#include <thread>
#include <vector>

#include "sage/app/screen.hpp"
#include "sage/deck/text.hpp"

namespace sage::app {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kFirst{500}, kBetween{200};  // what is over soon is not worth a line
constexpr std::string_view kClear = "\r\033[K";

std::atomic<bool> line_stands{false}, being_drawn{false}, process_ends{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers read them");

// A signal that would end the process would leave the line behind.
void on_fatal_signal(int number) {
  end_progress_at_signal();
  signal(number, SIG_DFL);
  raise(number);
}

void clear_at_fatal_signals() {
  struct sigaction ours = {}, before = {};
  ours.sa_handler = on_fatal_signal;
  sigemptyset(&ours.sa_mask);
  for (int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    sigaction(number, nullptr, &before);
    if (before.sa_handler == SIG_DFL) sigaction(number, &ours, nullptr);
  }
}

// "0:41", "1:02:03"
std::string clock_text(double seconds) {
  const auto all = static_cast<long>(seconds);
  const long hours = all / 3600, minutes = all / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, all % 60)
                   : fmt::format("{}:{:02}", minutes, all % 60);
}

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

// Where the analysis stands, and the phase in hand with its time where it takes a second or more.
std::string pulse_text(const Pulse& pulse, Clock::time_point now) {
  std::string text;
  if (const int stage = pulse.stage; stage > 0) {
    text += fmt::format(", stage {} of {}", stage, pulse.stages.load());
    if (const int increment = pulse.increment; increment > 0)
      text += fmt::format(", increment {} of {}", increment, pulse.increments.load());
    if (const int iteration = pulse.iteration; iteration > 0)
      text += fmt::format(", iteration {}, residual {:.1e}", iteration, pulse.residual.load());
  }
  const char* const phase = pulse.phase;
  if (phase == nullptr || std::string_view(phase) == "whole run") return text;
  text += fmt::format(", {}", phase);
  const double seconds = seconds_between(Clock::time_point(Clock::duration(pulse.phase_began)), now);
  return seconds < 1.0 ? text : text + fmt::format(" {:.0f} s", seconds);
}

// Code points that may be two columns wide count as two: a line that wraps can't be taken away.
std::string cut_to(const std::string& line, int columns) {
  int used = 0;
  for (std::size_t at = 0; at < line.size();) {
    const auto lead = static_cast<unsigned char>(line[at]);
    const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    used += lead < 0xe1 ? 1 : 2;
    if (used > columns) return line.substr(0, at);
    at += bytes;
  }
  return line;
}

}  // namespace

// All tasks that live, and the thread that shows them.
struct TaskLine {
  std::recursive_mutex mutex;
  std::condition_variable_any wake;
  std::vector<Task*> tasks;
  std::thread thread;
  bool ends = false, switched_off = false;
  Clock::time_point next;

  static TaskLine& get() {
    static TaskLine line;
    return line;
  }

  bool wanted() const { return !switched_off && !screen().quiet && is_screen(stderr); }

  void add(Task* task, bool without_thread) {
    const std::lock_guard lock(mutex);
    tasks.push_back(task);
    if (tasks.size() > 1) return;
    clear_at_fatal_signals();
    next = Clock::now() + kFirst;
    if (!without_thread) start_thread();
  }

  void remove(Task* task) {
    std::unique_lock lock(mutex);
    std::erase(tasks, task);
    if (!tasks.empty()) return;
    clear();
    if (!thread.joinable()) return;
    ends = true;
    wake.notify_all();
    lock.unlock();
    thread.join();
    thread = {};
    ends = false;
  }

  // Signals are for the other threads.
  void start_thread() {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
      thread = std::thread([this] { repeat(); });
    } catch (const std::system_error&) {
      // No room for a thread: no line.
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  void repeat() {
    std::unique_lock lock(mutex);
    while (!ends) {
      wake.wait_for(lock, kBetween);
      if (!ends) draw_if_due();
    }
  }

  void draw_if_due() {
    const Clock::time_point now = Clock::now();
    if (tasks.empty() || switched_off || now < next) return;
    next = now + kBetween / 2;
    std::string line;
    for (std::size_t i = 0; i < tasks.size(); ++i) line += (i == 0 ? "" : ": ") + text_of(*tasks[i], now);
    draw(std::string(kClear) + cut_to(well_formed(line).text, columns_of(stderr) - 1));
  }

  // A fatal signal may come at any moment of this: its handler waits until the line is whole, and none follows.
  static void draw(const std::string& line) {
    being_drawn = true;
    if (!process_ends) {
      line_stands = true;
      write_out(line);
    }
    being_drawn = false;
  }

  void clear() {
    if (line_stands) write_out(kClear);
    line_stands = false;
  }

  static void write_out(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  }

  // "deck.dat 37 %, 0:41, about 1:10 left, stage 1 of 2, ..."
  static std::string text_of(Task& task, Clock::time_point now) {
    const double share =
        task.count_ > 0 ? static_cast<double>(task.number_ - 1) / task.count_ : task.pulse_.share.load();
    std::string text = task.name_;
    if (task.count_ > 0) text += fmt::format(" {} of {}", task.number_, task.count_);
    const double seconds = seconds_between(task.begun_, now);
    if (share > 0.0) text += fmt::format(" {:.0f} %", 100.0 * share);
    text += ", " + clock_text(seconds);
    text += left_text(task, share, now);
    text += pulse_text(task.pulse_, now);
    if (!task.part_.empty()) text += ", " + task.part_;
    return text;
  }

  // As if the rest went as what has been seen so far.
  static std::string left_text(Task& task, double share, Clock::time_point now) {
    constexpr double kSeen = 0.01, kSeconds = 2.0;  // of the whole, and of time: less says nothing
    if (task.share_at_start_ < 0.0 && (share > 0.0 || task.pulse_.stage > 0 || task.count_ > 0)) {
      task.share_at_start_ = share;
      task.counted_ = now;
    }
    const double seen = share - task.share_at_start_, seconds = seconds_between(task.counted_, now);
    if (task.share_at_start_ < 0.0 || seen < kSeen || seconds < kSeconds) return {};
    return fmt::format(", about {} left", clock_text(std::ceil(seconds * (1.0 - share) / seen)));
  }
};

Task::Task(std::string name, bool without_thread) : name_(std::move(name)) {
  shown_ = TaskLine::get().wanted();
  if (shown_) TaskLine::get().add(this, without_thread);
}

Task::~Task() {
  if (shown_) TaskLine::get().remove(this);
}

void Task::part(const std::string& name, int number, int count) {
  if (!shown_) return;
  const std::lock_guard lock(TaskLine::get().mutex);
  part_ = name;
  number_ = number;
  count_ = count;
}

Pulse* Task::pulse() {
  return shown_ ? &pulse_ : nullptr;
}

void show_progress() {
  TaskLine& line = TaskLine::get();
  const std::lock_guard lock(line.mutex);
  line.draw_if_due();
}

ProgressPause::ProgressPause() : lock_(TaskLine::get().mutex) {
  TaskLine::get().clear();
}

// What was printed to standard output may stand on the same terminal.
ProgressPause::~ProgressPause() {
  if (!TaskLine::get().tasks.empty()) std::fflush(stdout);
}

void clear_progress_at_signal() {
  // The line may be drawn by the very thread that the signal interrupts: the wait has an end.
  constexpr int kWaits = 100;
  const timespec millisecond{0, 1000000};
  for (int waits = 0; being_drawn && waits < kWaits; ++waits) nanosleep(&millisecond, nullptr);
  if (!line_stands.load(std::memory_order_relaxed)) return;
  if (write(STDERR_FILENO, kClear.data(), kClear.size()) < 0) return;  // nobody reads it
}

void end_progress_at_signal() {
  process_ends = true;
  clear_progress_at_signal();
}

void no_progress_here() {
  TaskLine::get().switched_off = true;
  line_stands = false;
}

}  // namespace sage::app
