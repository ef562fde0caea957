// Where the time of a run goes: a tree of phases, each with its calls, its own time, its floating-point operations
// and the memory that it added.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sage/platform/pulse.hpp"

namespace sage {

class Profile {
 public:
  struct Phase {
    std::string_view name;  // a literal
    int parent = -1;        // in phases(); of the first, the whole: -1
    long calls = 0;
    double seconds = 0.0;     // of the phase itself, without those below it
    double operations = 0.0;  // floating-point, where they are known; of the phase itself
    std::int64_t memory = 0;  // bytes by which the process's largest size grew in the phase itself
  };

  // A phase from here to the end of the scope, within the phase that is under way.
  class Scope {
   public:
    Scope(Profile& profile, std::string_view name) : profile_(&profile), outer_(profile.at_) {
      profile.enter(name);
    }
    ~Scope() { profile_->switch_to(outer_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

    // Negative: not known.
    void add_operations(double count) {
      if (count > 0.0) profile_->phases_[profile_->at_].operations += count;
    }

   private:
    Profile* profile_;
    int outer_;
  };

  // The whole run begins.  with_memory: asks the system for the process's size at every change of phase.
  explicit Profile(bool with_memory = false);

  // Every phase is shown there as it begins, from now on; null: no more.
  void show_in(Pulse* pulse) { pulse_ = pulse; }

  // The phases of a part that kept a profile of its own, below the phase under way, which then owns that much less
  // time.  What the part charged to no phase of its own stays there.
  void add(const Profile& part);

  // Charges what has passed to the phase under way: before the numbers below are asked for.
  void stop() { switch_to(at_); }

  // A parent stands before its children.
  const std::vector<Phase>& phases() const { return phases_; }
  bool with_memory() const { return with_memory_; }
  // Of a phase and all below it.
  double seconds_with_all(int phase) const;
  double operations_with_all(int phase) const;
  std::int64_t memory_with_all(int phase) const;
  // Own time of all phases of a name.
  double seconds(std::string_view name) const;

 private:
  using Clock = std::chrono::steady_clock;
  void enter(std::string_view name);
  void switch_to(int phase);
  int child(int parent, std::string_view name);
  template <class Value>
  Value sum(int phase, Value Phase::*value) const;

  std::vector<Phase> phases_;
  int at_ = 0;  // under way
  Clock::time_point since_;
  bool with_memory_;
  std::int64_t largest_ = 0;  // size of the process so far, bytes
  Pulse* pulse_ = nullptr;
};

}  // namespace sage
