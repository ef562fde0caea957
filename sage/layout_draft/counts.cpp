#include "sage/layout_draft/counts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace sage::layout_draft {

namespace {

constexpr std::size_t kMostSources = 16;  // of one value
constexpr double kLargest = 1e8;

}  // namespace

void Counts::add(int card, int field, int line, double value, const std::string& name) {
  if (!(value >= 1.0 && value <= kLargest) || value != std::floor(value)) return;
  std::vector<std::size_t>& same = by_value_[static_cast<int>(value)];
  if (same.size() >= kMostSources) return;
  same.push_back(sources_.size());
  sources_.push_back({card, field, line, static_cast<int>(value), name});
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
  Source& source = sources_[*choice];
  source.again = std::exchange(source.used, true);
  source.backward = *choice < last_;
  last_ = *choice;
  return source;
}

// Different numbers from half to twice the value, as a share of all that there are.
double Counts::share_around(int value) const {
  const auto begin = by_value_.lower_bound((value + 1) / 2), end = by_value_.upper_bound(2 * value);
  return static_cast<double>(std::distance(begin, end)) / (1.5 * value + 1.0);
}

std::string Counts::chance(const Source& source, int control) const {
  constexpr std::size_t kNamed = 4;
  constexpr int kSmall = 3;          // small numbers stand everywhere
  constexpr double kCrowded = 0.25;  // one in four: an agreement within a few tries
  std::vector<std::string> why;
  if (source.value <= kSmall) why.emplace_back("a small number");
  if (source.again) why.emplace_back("it counts other lines too");
  if (source.backward) why.emplace_back("later counts of that card already fit other lines");
  if (source.value > kSmall && source.card != control && share_around(source.value) > kCrowded)
    why.emplace_back("many numbers of that size stand above");
  std::string others;
  std::size_t shown = 0;
  for (const std::size_t i : by_value_.at(source.value))
    if (sources_[i].name != source.name && ++shown <= kNamed)
      others += (others.empty() ? "" : ", ") + sources_[i].name;
  if (!others.empty())
    why.push_back(others + (shown > kNamed ? " and others" : "") +
                  (shown > 1 ? " say it too" : " says it too"));
  std::string text;
  for (const std::string& one : why) text += (text.empty() ? "; it may be chance: " : "; ") + one;
  return text;
}

bool Counts::used(int card) const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [card](const Source& source) { return source.card == card && source.used; });
}

}  // namespace sage::layout_draft
