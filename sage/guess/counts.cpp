#include "sage/guess/counts.hpp"

#include <algorithm>
#include <cmath>

namespace sage::guess {

namespace {

constexpr std::size_t kMostSources = 16;  // of one value
constexpr double kLargest = 1e8;

}  // namespace

void Counts::add(int card, int field, int line, double value, const std::string& name) {
  if (!(value >= 1.0 && value <= kLargest) || value != std::floor(value)) return;
  std::vector<std::size_t>& same = by_value_[static_cast<int>(value)];
  if (same.size() >= kMostSources) return;
  same.push_back(sources_.size());
  sources_.push_back({card, field, line, static_cast<int>(value), name, false});
}

bool Counts::has(double value) const {
  return std::abs(value) <= kLargest && by_value_.count(static_cast<int>(value)) > 0;
}

std::optional<Counts::Source> Counts::take_next(double value) {
  const std::size_t next = last_ + 1;
  if (next >= sources_.size() || !sources_[last_].used || sources_[next].used) return std::nullopt;
  if (sources_[next].card != sources_[last_].card || sources_[next].value != static_cast<int>(value))
    return std::nullopt;
  sources_[next].used = true;
  last_ = next;
  return sources_[next];
}

std::optional<Counts::Source> Counts::take(double value, int card) {
  if (!has(value)) return std::nullopt;
  std::vector<std::size_t> same = by_value_.at(static_cast<int>(value));
  if (card >= 0) std::erase_if(same, [&](std::size_t i) { return sources_[i].card != card; });
  if (same.empty()) return std::nullopt;
  const auto fresh = [&](std::size_t i) { return !sources_[i].used; };
  auto choice = std::find_if(same.begin(), same.end(), [&](std::size_t i) { return fresh(i) && i >= last_; });
  if (choice == same.end()) choice = std::find_if(same.begin(), same.end(), fresh);
  if (choice == same.end()) choice = same.begin();
  sources_[*choice].used = true;
  last_ = *choice;
  return sources_[*choice];
}

std::vector<std::string> Counts::also(const Source& source) const {
  std::vector<std::string> names;
  for (const std::size_t i : by_value_.at(source.value))
    if (sources_[i].name != source.name) names.push_back(sources_[i].name);
  return names;
}

bool Counts::used(int card) const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [card](const Source& source) { return source.card == card && source.used; });
}

}  // namespace sage::guess
