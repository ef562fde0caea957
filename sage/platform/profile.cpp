#include "sage/platform/profile.hpp"

#include <sys/resource.h>

#include <algorithm>

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

std::int64_t largest_size() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<std::int64_t>(usage.ru_maxrss);  // Linux counts in kB
}

}  // namespace

Profile::Profile(bool with_memory) : since_(Clock::now()), with_memory_(with_memory) {
  phases_.push_back({"whole run", -1, 1, 0.0, 0.0, 0});
  if (with_memory) largest_ = largest_size();
}

int Profile::child(int parent, std::string_view name) {
  for (int i = parent + 1; i < static_cast<int>(phases_.size()); ++i)
    if (phases_[at(i)].parent == parent && phases_[at(i)].name == name) return i;
  phases_.push_back({name, parent, 0, 0.0, 0.0, 0});
  return static_cast<int>(phases_.size()) - 1;
}

void Profile::enter(std::string_view name) {
  const int phase = child(at_, name);
  ++phases_[at(phase)].calls;
  switch_to(phase);
}

void Profile::switch_to(int phase) {
  const Clock::time_point now = Clock::now();
  phases_[at(at_)].seconds += std::chrono::duration<double>(now - since_).count();
  since_ = now;
  if (with_memory_) {
    const std::int64_t size = largest_size();
    phases_[at(at_)].memory += size - largest_;
    largest_ = size;
  }
  at_ = phase;
  if (pulse_ != nullptr) pulse_->enter(phases_[at(phase)].name.data(), now);
}

void Profile::add(const Profile& part) {
  stop();
  std::vector<int> place(part.phases_.size(), at_);
  for (std::size_t i = 1; i < part.phases_.size(); ++i) {
    const Phase& from = part.phases_[i];
    place[i] = child(place[at(from.parent)], from.name);
    Phase& to = phases_[at(place[i])];
    to.calls += from.calls;
    to.seconds += from.seconds;
    to.operations += from.operations;
    to.memory += from.memory;
    phases_[at(at_)].seconds -= from.seconds;
    phases_[at(at_)].memory -= from.memory;
  }
}

template <class Value>
Value Profile::sum(int phase, Value Phase::*value) const {
  std::vector<char> below(phases_.size(), 0);
  Value total = 0;
  for (std::size_t i = at(phase); i < phases_.size(); ++i) {
    const int parent = phases_[i].parent;
    below[i] = static_cast<int>(i) == phase || (parent >= 0 && below[at(parent)] != 0);
    if (below[i] != 0) total += phases_[i].*value;
  }
  return total;
}

double Profile::seconds_with_all(int phase) const {
  return sum(phase, &Phase::seconds);
}

double Profile::operations_with_all(int phase) const {
  return sum(phase, &Phase::operations);
}

std::int64_t Profile::memory_with_all(int phase) const {
  return sum(phase, &Phase::memory);
}

double Profile::seconds(std::string_view name) const {
  double total = 0.0;
  for (const Phase& phase : phases_)
    if (phase.name == name) total += phase.seconds;
  return total;
}

}  // namespace sage
