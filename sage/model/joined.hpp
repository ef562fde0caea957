// Which of many things hang together: each starts alone, and sets grow as two of their members are joined.
#pragma once

#include <numeric>
#include <vector>

namespace sage {

class Joined {
 public:
  explicit Joined(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  // One member that stands for all of the set of `i`, until sets are joined.
  int set_of(int i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(int a, int b) { parent(set_of(a)) = set_of(b); }

 private:
  int& parent(int i) { return parent_[i]; }

  std::vector<int> parent_;
};

}  // namespace sage
