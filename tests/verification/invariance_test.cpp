// What must not change an answer: units, node numbers, order of elements, place and direction of the axis.
// Reference: the same model in its plain form.  Elastic specimen on a hyperbolic interface, and Drucker-Prager.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <random>

#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// What the program answers, free of units: platen force by area and cell pressure, displacements by the height
// with the platen coming from above.
struct Answer {
  std::vector<double> force;          // an increment each
  std::vector<double> displacements;  // r and z of the specimen's nodes, plain order, at the end
  std::vector<int> iterations;        // an increment each
  int cuts = 0;
};

Answer answer_of(const SpecimenDeck& deck) {
  const WholeRun run = run_text(deck.text());
  EXPECT_TRUE(run.completed()) << run.failure;
  EXPECT_LT(run.out_of_balance, 1e-7);
  const SpecimenVariant& v = deck.variant;
  const double sign = v.mirrored ? -1.0 : 1.0;
  Answer answer;
  for (const Snapshot& s : run.increments) {
    answer.force.push_back(-sign * run.reaction(s, deck.platen(), 1) / (50.0 * v.stress * v.length * v.length));
    answer.iterations.push_back(s.iterations);
    answer.cuts += s.cuts;
  }
  for (int n : deck.solid_nodes()) {
    answer.displacements.push_back(run.u(n).x() / v.length);
    answer.displacements.push_back(sign * run.u(n).y() / v.length);
  }
  return answer;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0, size = 0.0;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

class Invariance : public testing::TestWithParam<bool> {
 protected:
  SpecimenDeck plain() const {
    SpecimenDeck deck;
    deck.drucker_prager = GetParam();
    return deck;
  }
  void compare(const SpecimenVariant& variant, double tolerance, const char* what) const {
    SpecimenDeck changed = plain();
    changed.variant = variant;
    const Answer a = answer_of(changed), b = answer_of(plain());
    const double force = largest_difference(a.force, b.force);
    const double u = largest_difference(a.displacements, b.displacements);
    std::printf("    %-34s force %.1e, displacements %.1e, iterations %d and %d\n", what, force, u,
                std::accumulate(a.iterations.begin(), a.iterations.end(), 0),
                std::accumulate(b.iterations.begin(), b.iterations.end(), 0));
    EXPECT_LT(force, tolerance);
    EXPECT_LT(u, tolerance);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.cuts, b.cuts);
    EXPECT_GT(b.force.back(), 1.0);
  }
};

TEST_P(Invariance, Units) {
  SpecimenVariant variant;
  variant.length = 1e3;
  variant.stress = 1e-6;
  compare(variant, 1e-9, "lengths 1e3, stresses 1e-6");
  variant.length = 1e-3;
  variant.stress = 1e6;
  compare(variant, 1e-9, "lengths 1e-3, stresses 1e6");
}

TEST_P(Invariance, NodeNumbers) {
  SpecimenVariant variant;
  std::vector<int> numbers(7 * 13 + 7);
  std::iota(numbers.begin(), numbers.end(), 1);
  std::shuffle(numbers.begin(), numbers.end(), std::mt19937(20));
  variant.number = [numbers](int plain) { return numbers[plain - 1]; };
  compare(variant, 1e-10, "random node numbers");
}

TEST_P(Invariance, ElementOrder) {
  SpecimenVariant variant;
  variant.elements_backwards = true;
  compare(variant, 1e-10, "elements backwards");
}

// The shift is a power of two, so that coordinates lose no digits beyond those of a number of its size.
TEST_P(Invariance, Translation) {
  SpecimenVariant variant;
  variant.shift = 64.0;
  compare(variant, 1e-9, "shifted along z");
}

TEST_P(Invariance, Mirror) {
  SpecimenVariant variant;
  variant.mirrored = true;
  compare(variant, 1e-10, "z to -z");
}

INSTANTIATE_TEST_SUITE_P(Specimens, Invariance, testing::Values(false, true),
                         [](const auto& one) { return one.param ? "DruckerPrager" : "Elastic"; });

// The radial return errs in the direction of the stress, in proportion to the increment.  Measured
// here: 1.8e-5 of the force with 15 increments, 4e-6 with 60; four times as many increments must
// gain a factor of 3 at least.
TEST(IncrementCount, DruckerPragerSpecimen) {
  std::vector<double> force;
  for (int increments : {15, 60, 240}) {
    SpecimenDeck deck;
    deck.drucker_prager = true;
    deck.columns = 4;
    deck.rows = 8;
    deck.increments = increments;
    force.push_back(answer_of(deck).force.back());
  }
  const double coarse = std::abs(force[0] / force[2] - 1.0), fine = std::abs(force[1] / force[2] - 1.0);
  std::printf("    force %.8f %.8f %.8f: 15 to 240 %.2e, 60 to 240 %.2e\n", force[0], force[1], force[2],
              coarse, fine);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_LT(fine, coarse / 3.0);
}

}  // namespace
}  // namespace sage::test
