// The suite of laws over every law of the catalogue.  A new law needs a row of parameters in law_samples.hpp,
// nothing else.
#include <gtest/gtest-spi.h>

#include <map>

#include "sage/conformance/law_checks.hpp"
#include "tests/conformance/law_samples.hpp"
#include "tests/install/consumer/bar.hpp"
#include "tests/install/consumer/creep.hpp"
#include "tests/support/laws.hpp"

namespace sage::conformance {
namespace {

INSTANTIATE_TEST_SUITE_P(Catalogue, Laws, ::testing::ValuesIn(law_subjects(test::catalogue(), test::samples())),
                         name_of_law);

// What the catalogue has none of: a law of one component, and one that depends on time.
const Catalogue& own_laws() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.materials.add(80, own::rod());
    c.materials.add(91, own::maxwell());
    return c;
  }();
  return catalogue;
}
INSTANTIATE_TEST_SUITE_P(
    Own, Laws,
    ::testing::ValuesIn(law_subjects(own_laws(), {{.what = "rod", .code = 80, .values = {2e5, 0.01}},
                                                  {.what = "maxwell", .code = 91, .values = {1e4, 0.3, 2.0}}})),
    name_of_law);

// Elastic, with one fault planted.
enum class Fault { none, refuses, stiff_in_shear };

class PlantedLaw final : public SolidLaw {
 public:
  explicit PlantedLaw(Fault fault) : fault_(fault) {
    constexpr double K = 8000.0, G = 4000.0;
    D_.setZero();
    D_.topLeftCorner<3, 3>().setConstant(K - 2.0 * G / 3.0);
    D_.diagonal() << K + 4.0 * G / 3.0, K + 4.0 * G / 3.0, K + 4.0 * G / 3.0, G;
    if (fault == Fault::stiff_in_shear) D_(3, 3) *= 2.0;
  }
  LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    out.sigma = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = PointStatus::elastic;
    return fault_ == Fault::refuses && !in.deps.isZero(0.0) ? Outcome::cut_step : Outcome::ok;
  }

 private:
  Fault fault_;
  Matrix4 D_;
};

// Failures that a check reports, kept from the test that looks for them.
template <class Check>
int failures(const Check& check) {
  ::testing::TestPartResultArray results;
  {
    const ::testing::ScopedFakeTestPartResultReporter catcher(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    check();
  }
  int failed = 0;
  for (int i = 0; i < results.size(); ++i) failed += results.GetTestPartResult(i).failed() ? 1 : 0;
  return failed;
}

// The suite sees what it is there for.
TEST(PlantedFaults, AreCaught) {
  const auto all = [](Fault fault) {
    const PlantedLaw law(fault);
    constexpr double kStrain = 0.01;
    std::map<std::string, int> failed;
    failed["answers"] = failures([&] { check_answers<4>(law, kStrain); });
    failed["tangent"] = failures([&] { check_tangent<4>(law, kStrain); });
    failed["surface"] = failures([&] { check_surface<4>(law, kStrain); });
    failed["turning"] = failures([&] { check_turning(law, kStrain); });
    failed["others"] = failures([&] {
      check_zero_increment<4>(law, kStrain);
      check_symmetry<4>(law, kStrain);
      check_linear<4>(law, kStrain);
      check_finite<4>(law);
    });
    return failed;
  };
  for (const auto& [check, count] : all(Fault::none)) EXPECT_EQ(count, 0) << check;
  std::map<std::string, int> refuses = all(Fault::refuses);
  EXPECT_GT(refuses["answers"], 0);
  EXPECT_GT(refuses["tangent"], 0);
  EXPECT_GT(refuses["surface"], 0);
  EXPECT_GT(all(Fault::stiff_in_shear)["turning"], 0);
}

// A law without a sample would escape the suite.
TEST(Catalogue, EveryLawHasASample) {
  for (const auto& [code, entry] : test::catalogue().materials.entries()) {
    int count = 0;
    for (const LawSample& sample : test::samples()) count += sample.code == code;
    // Storage has no path of its own: elements with pore pressures test it (consolidation_test.cpp).
    EXPECT_GT(count, entry.of_pores ? -1 : 0) << entry.name;
  }
}

// The manual and the parser read the rows: they must be complete.
TEST(Catalogue, RowsAreComplete) {
  for (const auto& [code, entry] : test::catalogue().materials.entries()) {
    EXPECT_FALSE(entry.summary.empty());
    bool optional_seen = false;
    for (const Parameter& row : entry.parameters) {
      EXPECT_FALSE(row.name.empty() || row.meaning.empty()) << entry.name;
      EXPECT_FALSE(optional_seen && row.required) << entry.name << ": required after optional";
      optional_seen = optional_seen || !row.required;
    }
  }
}

}  // namespace
}  // namespace sage::conformance
