// The search alone: a body that falls at a known factor is found from everywhere, in a bracket of the width asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "sage/safety/critical_kh.hpp"
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

// A block on a plane: F = tan(phi) (cos b - k sin b) / (sin b + k cos b), 1 at k = tan(phi - b).  Brackets of F that hold 1
// say nothing about k.
TEST(CriticalKh, IsBracketedWhereTheFactorIsOne) {
  for (const double excess : {0.5, 3.0, 20.0, 60.0})
    for (const double tolerance : {0.05, 0.005, 0.001}) {
      const double b = 0.2, phi = b + excess * std::numbers::pi / 180.0, critical = std::tan(phi - b);
      int trials = 0;
      const CriticalKh found = find_critical_kh(
          [&](double k) {
            ++trials;
            const double F = std::tan(phi) * (std::cos(b) - k * std::sin(b)) / (std::sin(b) + k * std::cos(b));
            Safety safety;
            safety.lower = F - 0.3 * tolerance;
            safety.upper = F + 0.3 * tolerance;
            return safety;
          },
          tolerance);
      ASSERT_TRUE(found.complete()) << excess << " " << tolerance << " " << found.incomplete;
      EXPECT_LE(*found.lower, critical);
      EXPECT_GE(*found.upper, critical);
      EXPECT_LE(*found.upper - *found.lower, tolerance * (1.0 + 1e-6));
      EXPECT_LE(trials, 14);
    }
}

TEST(CriticalKh, NamesWhyThereIsNone) {
  const auto of = [](double F, const std::string& incomplete) {
    return find_critical_kh(
        [&](double) {
          Safety safety;
          safety.lower = F - 0.001;
          safety.upper = F + 0.001;
          safety.incomplete = incomplete;
          return safety;
        },
        0.01);
  };
  EXPECT_NE(of(0.9, "").incomplete.find("without an earthquake"), std::string::npos);
  EXPECT_NE(of(3.0, "").incomplete.find("still in equilibrium"), std::string::npos);
}

}  // namespace
}  // namespace sage::safety
