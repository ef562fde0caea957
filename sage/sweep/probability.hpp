// What a number of failures among independent cases says about their probability.
#pragma once

namespace sage::sweep {

struct Probability {
  double value = 0.0, low = 0.0, high = 0.0;
};

// Share of failures with the interval of Clopper and Pearson, which holds the probability at least as often as the
// confidence says.  Of no cases: 0 to 1.
Probability probability_of(long failures, long cases, double confidence);

}  // namespace sage::sweep
