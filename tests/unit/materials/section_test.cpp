// Laws of sections and bars: docs/theory/structures.md.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/axial.hpp"
#include "materials/section.hpp"
#include "sage/conformance/law_driver.hpp"

namespace sage {
namespace {

using conformance::update;

constexpr double kEA = 1e6, kEI = 2e4, kN = 5e3, kM = 100.0;
const SectionPlastic kLaw({kEA, 0.0, 3e5, kEI, 0.0, 0.0}, kN, kM);

Vector<5> strain(double axial, double bending) {
  return {axial, 0.0, 0.0, bending, 0.0};
}

// Bending alone ends at M_p, tension alone at N_p, and the moment that is left beside a force is M_p (1 - (N/N_p)^2).
TEST(SectionPlastic, EndsOnItsParabola) {
  const std::vector<double> h(2, 0.0);
  EXPECT_NEAR(update<5>(kLaw, Vector<5>::Zero(), strain(0.0, 1.0), h).sigma[3], kM, 1e-10);
  EXPECT_NEAR(update<5>(kLaw, Vector<5>::Zero(), strain(0.0, -1.0), h).sigma[3], -kM, 1e-10);
  EXPECT_NEAR(update<5>(kLaw, Vector<5>::Zero(), strain(-1.0, 0.0), h).sigma[0], -kN, 1e-8);
  for (const double share : {0.3, 0.6, 0.95}) {
    // The axial strain that keeps N where it is while the section turns flows with the normal.
    const double N = share * kN, turn = 0.01;
    const double flow = (turn - kM * (1.0 - share * share) / kEI) * kM * 2.0 * N / (kN * kN);
    const auto a = update<5>(kLaw, Vector<5>::Zero(), strain(N / kEA + flow, turn), h);
    EXPECT_NEAR(a.sigma[0], N, 1e-9 * kN) << share;
    EXPECT_NEAR(a.sigma[3], kM * (1.0 - share * share), 1e-9 * kM) << share;
    EXPECT_NEAR(a.h[0], flow, 1e-12);
    EXPECT_EQ(a.status, PointStatus::yielded);
  }
}

// At the tip of the parabola all is force; strains back to it are elastic again.
TEST(SectionPlastic, TheTipCarriesNoMoment) {
  const std::vector<double> h(2, 0.0);
  const auto tip = update<5>(kLaw, Vector<5>::Zero(), strain(0.5, 1e-5), h);
  EXPECT_DOUBLE_EQ(tip.sigma[0], kN);
  EXPECT_EQ(tip.sigma[3], 0.0);
  const auto back = update<5>(kLaw, tip.sigma, strain(-1e-4, 0.0), tip.h);
  EXPECT_NEAR(back.sigma[0], kN - 100.0, 1e-9);
  EXPECT_EQ(back.status, PointStatus::elastic);
}

TEST(SectionPlastic, WithoutALimitOfForceTheMomentAloneYields) {
  const SectionPlastic law({kEA, 0.0, 3e5, kEI, 0.0, 0.0}, std::numeric_limits<double>::infinity(), kM);
  const auto a = update<5>(law, Vector<5>::Zero(), strain(1.0, 1.0), {0.0, 0.0});
  EXPECT_DOUBLE_EQ(a.sigma[0], kEA);
  EXPECT_NEAR(a.sigma[3], kM, 1e-10);
}

// Slackened by 0.03 and pulled by 0.05 a tie carries EA 0.02 / spacing.
TEST(AxialOneWay, SlackIsUsedUpFirst) {
  const AxialOneWay tie(1000.0, 2.0, true);
  const auto slack = update<1>(tie, Vector<1>::Zero(), Vector<1>(-0.03), {0.0});
  EXPECT_EQ(slack.sigma[0], 0.0);
  EXPECT_EQ(slack.status, PointStatus::open);
  EXPECT_NEAR(update<1>(tie, slack.sigma, Vector<1>(0.05), slack.h).sigma[0], 500.0 * 0.02, 1e-12);
}

TEST(AxialPlastic, StopsAtItsForces) {
  const AxialPlastic bar(1000.0, 2.0, 8.0, 5.0);
  EXPECT_DOUBLE_EQ(update<1>(bar, Vector<1>::Zero(), Vector<1>(0.1), {0.0}).sigma[0], 4.0);
  EXPECT_DOUBLE_EQ(update<1>(bar, Vector<1>::Zero(), Vector<1>(-0.1), {0.0}).sigma[0], -2.5);
  EXPECT_DOUBLE_EQ(bar.spacing(), 2.0);
}

}  // namespace
}  // namespace sage
