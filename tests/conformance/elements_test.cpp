// The suite of elements over every element of the catalogue, and what is of this catalogue alone.
#include "tests/support/elements.hpp"
#include "sage/conformance/suites.hpp"
#include "tests/install/consumer/bar.hpp"

namespace sage::conformance {
namespace {

using test::element_catalogue;

INSTANTIATE_TEST_SUITE_P(Catalogue, Elements, ::testing::Values(ElementSubject{"all", &element_catalogue()}),
                         name_of_elements);

// A structure, which the catalogue has none of.
const Catalogue& bar_alone() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.elements.add(50, own::bar2());
    return c;
  }();
  return catalogue;
}
INSTANTIATE_TEST_SUITE_P(Own, Elements, ::testing::Values(ElementSubject{"bar2", &bar_alone()}),
                         name_of_elements);

TEST(Catalogue, CodesNamesAndDefaults) {
  const auto& entries = element_catalogue().elements.entries();
  EXPECT_EQ(entries.at(1).formulations.front().name, "b-bar");
  EXPECT_EQ(entries.at(2).formulations.front().name, "reduced");
  EXPECT_EQ(entries.at(11).formulations.front().name, "row-sum");
}

TEST(Catalogue, UnknownFormulationListsTheKnownOnes) {
  try {
    element_catalogue().elements.find(1)->make(Geometry::plane_strain, 7);
    FAIL() << "no exception";
  } catch (const ParameterError& e) {
    EXPECT_STREQ(e.what(),
                 "quad4: formulation 7 unknown; known: 2 b-bar, 1 full, 3 selective, 5 enhanced, 4 full 3x3");
  }
}

TEST(Interfaces, NewtonCotesWarnsAtTheAxisAndNoOtherRuleDoes) {
  for (const ElementCase& c : test::interface_cases()) {
    SCOPED_TRACE(c.name);
    for (const auto& x : {sample_shape(*c.entry), sample_shape_on_axis(*c.entry)}) {
      const bool warns = !c.make()->caution(x).empty();
      EXPECT_EQ(warns, c.axisymmetric() && c.formulation == 3 && x(0, 0) == 0.0);
    }
  }
}

}  // namespace
}  // namespace sage::conformance
