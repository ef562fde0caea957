// The skip 'repeats': after a step that was linear to the last digit, the next one of the same size is tried as
// its repetition, which costs one force pass.
#pragma once

#include <algorithm>
#include <cmath>

#include "sage/core/archive.hpp"

namespace sage {

class Repeats {
 public:
  // size: the step's share of the stage.  linear: one correction, and the very same K at its end.
  void take(bool linear, double size) { size_ = linear ? size : 0.0; }
  void forget() { size_ = 0.0; }
  bool due(double size) const { return size_ > 0.0 && std::abs(size - size_) < 1e-12; }
  void exchange(Archive& archive) { archive(size_); }

  // Rounding: a share of the forces beyond it would be another answer than that of a correction.
  static double limit(double tolerance) { return std::min(1e-14, 1e-3 * tolerance); }

 private:
  double size_ = 0.0;  // of the last step, where it was linear; 0 = it was not
};

}  // namespace sage
