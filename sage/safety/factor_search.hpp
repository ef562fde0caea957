// Which factor to try next, from what the earlier ones came to.  Knows no model.
#pragma once

#include <optional>
#include <vector>

namespace sage::safety {

struct SearchLimits {
  double start = 1.0;        // first factor
  double tolerance = 0.005;  // widest bracket that ends the search
  double smallest = 0.05, largest = 20.0;
};

class FactorSearch {
 public:
  explicit FactorSearch(const SearchLimits& limits) : limits_(limits) {}

  // A factor may be tried twice: what stands the second time does not fall any more.
  void stands(double factor);
  void falls(double factor);
  // A factor of which nothing is known counts as an end no more.
  void drop(double factor);

  // The largest factor that stands, and the smallest above it that does not.
  std::optional<double> lower() const { return lower_; }
  std::optional<double> upper() const;
  bool bracketed() const;

  // Nothing: the bracket is narrow enough, or the range of factors is exhausted.  Once a factor stands, nothing
  // below it is tried any more.
  std::optional<double> next() const;

 private:
  SearchLimits limits_;
  std::optional<double> lower_;
  double step_ = 0.0;  // of the last rise of lower_
  std::vector<double> falls_;
};

}  // namespace sage::safety
