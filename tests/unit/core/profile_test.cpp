// The tree of phases: who is charged for what.
#include "sage/platform/profile.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace sage {
namespace {

constexpr double kNap = 2e-3;  // s
void nap() {
  usleep(static_cast<useconds_t>(1e6 * kNap));  // at least
}

int find(const Profile& profile, std::string_view name) {
  for (std::size_t i = 0; i < profile.phases().size(); ++i)
    if (profile.phases()[i].name == name) return static_cast<int>(i);
  return -1;
}

TEST(Profile, EveryMomentBelongsToOnePhase) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  const Clock::time_point before = Clock::now();
  Profile profile;
  const Clock::time_point after = Clock::now();
  for (int i = 0; i < 3; ++i) {
    const Profile::Scope outer(profile, "outer");
    nap();
    {
      const Profile::Scope inner(profile, "inner");
      nap();
    }
    const Profile::Scope inner(profile, "inner");
  }
  nap();
  const double least = since(after);
  profile.stop();
  const double most = since(before);

  ASSERT_EQ(profile.phases().size(), 3u);
  const int outer = find(profile, "outer"), inner = find(profile, "inner");
  EXPECT_EQ(profile.phases()[outer].calls, 3);
  EXPECT_EQ(profile.phases()[inner].calls, 6);
  EXPECT_EQ(profile.phases()[inner].parent, outer);
  EXPECT_GE(profile.seconds("inner"), 3 * kNap);
  EXPECT_GE(profile.seconds("outer"), 3 * kNap);
  EXPECT_GE(profile.phases()[0].seconds, kNap);
  // Own times are a partition of the whole; the sums round differently.
  EXPECT_NEAR(profile.seconds_with_all(outer), profile.seconds("outer") + profile.seconds("inner"), 1e-12);
  EXPECT_NEAR(profile.seconds_with_all(0), profile.phases()[0].seconds + profile.seconds_with_all(outer),
              1e-12);
  EXPECT_LE(profile.seconds_with_all(0), most + 1e-12) << "no moment counts twice";
  EXPECT_GE(profile.seconds_with_all(0), least - 1e-12) << "none is lost";
}

TEST(Profile, ThrownThroughAPhaseEndsIt) {
  Profile profile;
  try {
    const Profile::Scope phase(profile, "fails");
    throw std::runtime_error("");
  } catch (const std::runtime_error&) {
  }
  const Profile::Scope next(profile, "next");
  EXPECT_EQ(profile.phases()[find(profile, "next")].parent, 0);
}

TEST(Profile, APartBringsItsPhases) {
  Profile part;
  {
    Profile::Scope phase(part, "factorisation");
    phase.add_operations(5e6);
    phase.add_operations(-1.0);  // not known
    nap();
  }
  {
    const Profile::Scope phase(part, "rest of it");
    Profile::Scope below(part, "factorisation");
    below.add_operations(1e6);
  }
  part.stop();
  Profile whole;
  for (int i = 0; i < 2; ++i) {
    const Profile::Scope phase(whole, "analysis");
    nap();
    whole.add(part);  // as if it had run here: a nap that was one of the part's
  }
  whole.stop();
  const int analysis = find(whole, "analysis");
  ASSERT_EQ(whole.phases().size(), 5u);
  EXPECT_EQ(whole.phases()[2].name, "factorisation");
  EXPECT_EQ(whole.phases()[2].parent, analysis);
  EXPECT_EQ(whole.phases()[2].calls, 2);
  EXPECT_NEAR(whole.seconds("factorisation"), 2.0 * part.seconds("factorisation"), 1e-12);
  EXPECT_EQ(whole.operations_with_all(analysis), 12e6);
  EXPECT_EQ(whole.operations_with_all(2), 10e6) << "of one of two phases of the name";
  EXPECT_NEAR(whole.seconds_with_all(analysis),
              whole.phases()[analysis].seconds + whole.seconds("factorisation") + whole.seconds("rest of it"),
              1e-12);
}

TEST(Profile, GrowthIsChargedToThePhaseThatTouchesTheMemory) {
  constexpr std::size_t kBytes = 256u << 20;  // larger than what the process has had before
  Profile profile(true);
  std::vector<char> large;
  {
    const Profile::Scope phase(profile, "large");
    large.assign(kBytes, 1);
  }
  { const Profile::Scope phase(profile, "small"); }
  EXPECT_GE(profile.memory_with_all(find(profile, "large")), static_cast<std::int64_t>(0.9 * kBytes));
  EXPECT_LE(profile.memory_with_all(find(profile, "small")), 1 << 20);
  EXPECT_EQ(Profile().with_memory(), false);
}

}  // namespace
}  // namespace sage
