// What belongs to the numbers of nodes or elements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sage {

// A map from positive numbers.  Numbers of a deck lie close together: they are places in a list.  Those that
// would make the list much longer than what it holds, and those below zero, go to a map.
template <class T>
class ByNumber {
 public:
  // What belongs to the number, and whether it is new; a value that is there stays.
  std::pair<T*, bool> try_emplace(int number, const T& value) {
    if (!has_place(number)) {
      const auto [it, added] = others_.try_emplace(number, value);
      return {&it->second, added};
    }
    const auto i = static_cast<std::size_t>(number);
    const bool added = !known_[i];
    if (added) {
      values_[i] = value;
      known_[i] = 1;
      ++count_;
    }
    return {&values_[i], added};
  }
  // nullptr where nothing belongs to it.
  const T* find(int number) const {
    const auto i = static_cast<std::size_t>(number);  // a negative number is beyond the list
    if (i < values_.size() && known_[i]) return &values_[i];
    if (others_.empty()) return nullptr;
    const auto it = others_.find(number);
    return it == others_.end() ? nullptr : &it->second;
  }
  T* find(int number) { return const_cast<T*>(std::as_const(*this).find(number)); }
  bool contains(int number) const { return find(number) != nullptr; }
  T& at(int number) {
    T* found = find(number);
    if (found == nullptr) throw std::out_of_range("ByNumber::at");
    return *found;
  }
  std::size_t size() const { return count_ + others_.size(); }
  bool empty() const { return size() == 0; }

  // visit(number, value), numbers ascending.
  template <class Visit>
  void for_each(const Visit& visit) {
    auto other = others_.begin();
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (!known_[i]) continue;
      const int number = static_cast<int>(i);
      for (; other != others_.end() && other->first < number; ++other) visit(other->first, other->second);
      visit(number, values_[i]);
    }
    for (; other != others_.end(); ++other) visit(other->first, other->second);
  }
  // Takes out those for which gone(value).
  template <class Gone>
  void erase_if(const Gone& gone) {
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (known_[i] && gone(values_[i])) {
        known_[i] = 0;
        --count_;
      }
    std::erase_if(others_, [&](const auto& entry) { return gone(entry.second); });
  }

 private:
  // A number keeps the place where it was put first.
  bool has_place(int number) {
    if (number < 0) return false;
    const auto i = static_cast<std::size_t>(number);
    if (i < values_.size()) return others_.empty() || !others_.contains(number);
    constexpr std::size_t small = 1u << 18U;
    if (i > 4 * size() + small || others_.contains(number)) return false;
    const std::size_t longer = std::max(i + 1, values_.size() + values_.size() / 2);
    values_.resize(longer);
    known_.resize(longer, 0);
    return true;
  }

  std::vector<T> values_;
  std::vector<char> known_;
  std::size_t count_ = 0;
  std::map<int, T> others_;
};

}  // namespace sage
