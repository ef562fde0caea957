// What becomes of a law's parameters under a factor.  Expected values are c / F and atan(tan(phi) / F) themselves.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/axial.hpp"
#include "materials/hoek_brown.hpp"
#include "materials/hyperbolic_mohr_coulomb.hpp"
#include "materials/linear_elastic.hpp"
#include "materials/mohr_coulomb.hpp"
#include "materials/mohr_coulomb_softening.hpp"
#include "materials/section.hpp"
#include "sage/model/strength.hpp"

namespace sage {
namespace {

double divided(double angle, double factor) {
  return std::atan(std::tan(angle * kRadiansPerDegree) / factor) / kRadiansPerDegree;
}

void expect_near(const std::vector<double>& got, const std::vector<double>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    EXPECT_NEAR(got[i], wanted[i], 1e-12 * (1 + std::abs(wanted[i])));
}

TEST(ReduceStrength, MohrCoulombByEachRuleOfDilation) {
  const MaterialEntry entry = mohr_coulomb_entry();
  const double phi = divided(30.0, 2.0);
  ASSERT_LT(phi, 20.0);
  for (const auto& [rule, psi] : {std::pair{DilationRule::reduced, divided(20.0, 2.0)},
                                  {DilationRule::kept, phi},
                                  {DilationRule::none, 0.0}}) {
    std::vector<double> p{1e4, 0.3, 10.0, 30.0, 20.0, 5.0};
    EXPECT_TRUE(reduce_strength(p, entry, {2.0, rule}));
    expect_near(p, {1e4, 0.3, 5.0, phi, psi, 2.5});
  }
}

// -1 is "no cut-off"; short cards stay short.
TEST(ReduceStrength, WhatStandsForNoneStays) {
  const MaterialEntry entry = mohr_coulomb_entry();
  std::vector<double> p{1e4, 0.3, 0.0, 30.0, 0.0, -1.0};
  reduce_strength(p, entry, {1.5, DilationRule::reduced});
  expect_near(p, {1e4, 0.3, 0.0, divided(30.0, 1.5), 0.0, -1.0});
  std::vector<double> four{1e4, 0.3, 9.0, 0.0};
  reduce_strength(four, entry, {1.5, DilationRule::kept});
  expect_near(four, {1e4, 0.3, 6.0, 0.0});
}

TEST(ReduceStrength, SofteningLawAllOfItsValues) {
  std::vector<double> p{1e4, 0.3, 12.0, 30.0, 10.0, 0.05, 6.0, 25.0, 5.0, 0.2, -1.0, -1.0, 0.0, 0.0, -1.0};
  EXPECT_TRUE(reduce_strength(p, mohr_coulomb_softening_entry(), {1.2, DilationRule::reduced}));
  expect_near(p, {1e4, 0.3, 10.0, divided(30.0, 1.2), divided(10.0, 1.2), 0.05, 5.0, divided(25.0, 1.2),
                  divided(5.0, 1.2), 0.2, -1.0, -1.0, 0.0, 0.0, -1.0});
}

// phi = phi_0 - loss log10(sigma_3 / p_a): divided exactly at p_a and at ten times that.
TEST(ReduceStrength, CurvedEnvelopeAtTwoPressures) {
  const MaterialEntry entry = hyperbolic_mohr_coulomb_entry();
  const int c = entry.find("cohesion"), phi = entry.find("friction_angle"), loss = entry.find("friction_loss");
  ASSERT_TRUE(c >= 0 && phi > c && loss > phi);
  std::vector<double> p(entry.parameters.size(), 0.5);
  p[c] = 8.0;
  p[phi] = 40.0;
  p[loss] = 6.0;
  EXPECT_TRUE(reduce_strength(p, entry, {1.6, DilationRule::none}));
  EXPECT_NEAR(p[c], 5.0, 1e-12);
  EXPECT_NEAR(p[phi], divided(40.0, 1.6), 1e-12);
  EXPECT_NEAR(p[phi] - p[loss], divided(34.0, 1.6), 1e-12);
}

// Force and moment / F; an axial strength of 0 is none.
TEST(ReduceStrength, BarsAndSections) {
  std::vector<double> bar{1e5, 60.0, 30.0, 2.5}, section{1e6, 1e4, 0.0, 150.0};
  EXPECT_TRUE(reduce_strength(bar, axial_plastic_entry(), {1.5, DilationRule::reduced}));
  EXPECT_EQ(bar, (std::vector<double>{1e5, 40.0, 20.0, 2.5}));
  EXPECT_TRUE(reduce_strength(section, section_plastic_entry(), {1.5, DilationRule::reduced}));
  EXPECT_EQ(section, (std::vector<double>{1e6, 1e4, 0.0, 100.0}));
  EXPECT_EQ(part_of(axial_plastic_entry()), ModelPart::anchors);
  EXPECT_EQ(part_of(section_plastic_entry()), ModelPart::walls);
}

TEST(ReduceStrength, LawsThatNameNoStrengthStay) {
  for (const MaterialEntry& entry : {linear_elastic_entry(), hoek_brown_entry()}) {
    std::vector<double> p(entry.parameters.size(), 7.0);
    EXPECT_FALSE(has_strength(entry));
    EXPECT_FALSE(reduce_strength(p, entry, {2.0, DilationRule::reduced}));
    EXPECT_EQ(p, std::vector<double>(entry.parameters.size(), 7.0));
  }
}

}  // namespace
}  // namespace sage
