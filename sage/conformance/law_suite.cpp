// What every law must satisfy: sage/conformance/suites.hpp.
#include "sage/conformance/law_checks.hpp"
#include "sage/conformance/suites.hpp"

namespace sage::conformance {

void PrintTo(const LawSubject& subject, std::ostream* out) {
  *out << subject.sample.what;
}
std::string name_of_law(const testing::TestParamInfo<LawSubject>& info) {
  return info.param.sample.what;
}
std::vector<LawSubject> law_subjects(const Catalogue& catalogue, const std::vector<LawSample>& samples) {
  std::vector<LawSubject> subjects;
  for (const LawSample& sample : samples) subjects.push_back({&catalogue, sample});
  return subjects;
}

namespace {

// 1e-13 of the stress: returning from exactly on the surface may change the last digit.
TEST_P(Laws, ZeroIncrementIsAFixedPoint) {
  with_law([](const auto& law) { check_zero_increment(law, sample().strain); });
}

TEST_P(Laws, OrdinaryIncrementsAreAnswered) {
  with_law([](const auto& law) { check_answers(law, sample().strain); });
}

TEST_P(Laws, TangentIsTheDerivative) {
  with_law([](const auto& law) { check_tangent(law, sample().strain); });
}

TEST_P(Laws, SymmetryIsHonest) {
  with_law([](const auto& law) { check_symmetry(law, sample().strain); });
}

TEST_P(Laws, LinearIsHonest) {
  with_law([](const auto& law) { check_linear(law, sample().strain); });
}

TEST_P(Laws, StrengthIsNeverExceeded) {
  if (sample().bounded) with_law([](const auto& law) { check_surface(law, sample().strain); });
}

TEST_P(Laws, StatusIsThatOfTheState) {
  with_law([](const auto& law) { check_status_of_state(law, sample().strain); });
}

TEST_P(Laws, StatusIsHonest) {
  if (sample().bounded && sample().reaches_strength)
    with_law([](const auto& law) { check_status(law, sample().strain); });
}

TEST_P(Laws, NoNotANumber) {
  with_law([](const auto& law) { check_finite(law); });
}

TEST_P(Laws, EveryFieldIsWritten) {
  with_law([](const auto& law) { check_written(law, sample().strain); });
}

TEST_P(Laws, NoHiddenUnits) {
  for (const double factor : {1e12, 1e-12}) {
    UnitSystem units = kpa_units();
    units.atmospheric_pressure *= factor;
    units.water_unit_weight *= factor;  // stress per length
    std::vector<double> values = sample().values;
    const std::vector<Parameter>& rows = entry().parameters;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool stress = rows[i].dimension == Dimension::stress ||
                          rows[i].dimension == Dimension::stress_per_length ||
                          rows[i].dimension == Dimension::velocity ||  // what flow is to the slope of the head
                          rows[i].dimension == Dimension::force || rows[i].dimension == Dimension::moment ||
                          rows[i].dimension == Dimension::bending_stiffness;
      if (stress && values[i] != -1.0) values[i] *= factor;
    }
    with_law([&](const auto& law) {
      with_law(
          [&](const auto& scaled) {
            if constexpr (std::is_same_v<decltype(law), decltype(scaled)>)
              check_scaling(law, scaled, factor, sample().strain);
          },
          values, units);
    });
  }
}

TEST_P(Laws, TurnsWithTheAxes) {
  if (!sample().knows_directions) with_law([](const auto& law) { check_turning(law, sample().strain); });
}

// What the catalogue says of the history is what the law has.
TEST_P(Laws, HistoryIsThatOfTheEntry) {
  const LawPtr law = entry().make(sample().values, kpa_units());
  EXPECT_EQ(size_of_law(reference(law)), entry().law_size);
  const std::span<const Quantity> own = history_of(reference(law)), stated = entry().history;
  ASSERT_EQ(own.size(), stated.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(own[i].name, stated[i].name);
    EXPECT_EQ(own[i].dimension, stated[i].dimension);
  }
}

// The history that `initialise` makes is one to go on from; so is that of any state that update has reached.
TEST_P(Laws, OwnHistoryIsAccepted) {
  with_law([](const auto& law) {
    Walker walker(43);
    for (int trial = 0; trial < 50; ++trial) {
      const auto s = wander(law, walker, sample().strain, trial % 5);
      EXPECT_TRUE(law.accepts_history(s.sigma, s.h)) << trial;
    }
  });
}

// A state that `initialise` accepts is a state that update keeps.
TEST_P(Laws, InitialStressIsKept) {
  with_law([](const auto& law) {
    auto h = initial_history(law, start_stress(law));
    const bool accepted = law.initialise(start_stress(law), h);
    EXPECT_TRUE(accepted);
    auto zero = start_stress(law);
    zero.setZero();
    const auto a = update(law, start_stress(law), zero, h);
    EXPECT_EQ((a.sigma - start_stress(law)).norm(), 0.0);
    EXPECT_EQ(a.h, h);
  });
}

TEST_P(Laws, UpdateAllocatesNothing) {
  with_law([](const auto& law) {
    Walker walker(41);
    auto sigma = start_stress(law);
    auto h0 = initial_history(law, sigma);
    auto h1 = h0;
    auto deps = sigma;
    using Vec = decltype(deps);
    constexpr int N = Vec::RowsAtCompileTime;
    PointOut<N> out;
    out.h1 = h1;
    const long before = allocations();
    for (int trial = 0; trial < 50; ++trial) {
      deps = walker.strain(sample().strain * std::pow(10.0, trial % 4 - 1), &deps);
      law.update(point_in<N>(law, sigma, deps, h0), out);
      law.stress_level(out.sigma, h1);
    }
    EXPECT_EQ(allocations(), before);
  });
}

TEST_P(Laws, FourAtOnceAreAsOneByOne) {
  with_law([](const auto& law) {
    [&]<int N>(const Law<N>& one) {
      if (dynamic_cast<const FourPointLaw<N>*>(&one) != nullptr) check_four(one, sample().strain);
    }(law);
  });
}

}  // namespace

}  // namespace sage::conformance
