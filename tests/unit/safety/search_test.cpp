// The search alone: a body that falls at a known factor is found from everywhere, in a bracket of the width asked for.
#include <gtest/gtest.h>

#include "sage/safety/factor_search.hpp"

namespace sage::safety {
namespace {

int search(FactorSearch& search, double limit) {
  int trials = 0;
  while (const auto factor = search.next()) {
    *factor <= limit ? search.stands(*factor) : search.falls(*factor);
    if (++trials > 200) break;
  }
  return trials;
}

TEST(FactorSearch, FindsTheLimitFromBothSides) {
  for (const double limit : {0.0601, 0.3, 0.98498502, 1.0, 1.368, 1.59, 4.0, 19.0})
    for (const double tolerance : {0.1, 0.01, 1e-6}) {
      FactorSearch one({.tolerance = tolerance});
      EXPECT_LE(search(one, limit), 50) << limit;
      ASSERT_TRUE(one.bracketed()) << limit;
      EXPECT_LE(*one.lower(), limit);
      EXPECT_GT(*one.upper(), limit);
      EXPECT_LE(*one.upper() - *one.lower(), tolerance * (1 + 1e-8));
    }
}

TEST(FactorSearch, EndsWhereThereIsNoBracket) {
  FactorSearch never({.largest = 3.0}), always({.smallest = 0.2});
  search(never, 1e9);
  EXPECT_EQ(never.lower(), 3.0);
  EXPECT_FALSE(never.upper() || never.bracketed());
  search(always, 0.0);
  EXPECT_EQ(always.upper(), 0.2);
  EXPECT_FALSE(always.lower() || always.bracketed());
}

// The upper end of a bracket is tried again and stands: the search goes on above it.
TEST(FactorSearch, SecondTrialMayStand) {
  FactorSearch one({.tolerance = 0.01});
  one.stands(1.3);
  one.falls(1.5);
  one.falls(1.306);
  EXPECT_FALSE(one.next());
  one.stands(1.306);
  EXPECT_FALSE(one.bracketed());
  EXPECT_EQ(one.upper(), 1.5);
  EXPECT_NEAR(one.next().value_or(0.0), 1.403, 1e-12);
}

}  // namespace
}  // namespace sage::safety
