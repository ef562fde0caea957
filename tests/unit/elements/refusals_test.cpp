// What elements refuse, with what words, and what they make of a law that refuses.
#include <gtest/gtest.h>

#include <cmath>

#include "sage/conformance/sample_laws.hpp"
#include "sage/messages/error.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

// What geometry() says about these coordinates (x y of each node), "" if it accepts them.
std::string complaint(const Element& element, std::initializer_list<double> xy) {
  const Eigen::Matrix2Xd x =
      Eigen::Map<const Eigen::Matrix2Xd>(xy.begin(), 2, static_cast<Eigen::Index>(xy.size() / 2));
  std::vector<double> block(static_cast<std::size_t>(element.traits().geometry_size()));
  try {
    element.geometry(x, block);
  } catch (const ElementShapeError& error) {
    return error.what();
  }
  return "";
}
std::string complaint(int code, Geometry geometry, std::initializer_list<double> xy) {
  return complaint(*element_catalogue().elements.find(code)->make(geometry, 0), xy);
}

TEST(ElementEntries, AnUnknownFormulationIsRefusedWithTheKnownOnes) {
  for (const auto& [code, entry] : element_catalogue().elements.entries()) try {
      entry.make(Geometry::plane_strain, 77);
      ADD_FAILURE() << entry.name;
    } catch (const ParameterError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find(entry.name + ": formulation 77 unknown; known: "), 0u) << text;
      for (const Formulation& known : entry.formulations)
        EXPECT_NE(text.find(std::to_string(known.code) + " " + known.name), std::string::npos) << text;
    }
}

// Each point's law may refuse; the element passes it on and does not invent an answer.
TEST(Elements, PassOnThatTheLawWantsASmallerStep) {
  const AnySmoothLaw laws(1e-3);
  for (const ElementCase& c : element_cases()) {
    const std::unique_ptr<Element> element = c.make();
    const bool area = c.entry->solid() || c.entry->flow();
    const Eigen::Matrix2Xd ends = (Eigen::Matrix2Xd(2, 2) << 1.0, 2.0, 0.0, 0.0).finished();
    ElementRun run(*element, area ? sample_shape(*c.entry) : straight_element(*c.entry, ends), laws.of(c));
    Eigen::VectorXd du = Eigen::VectorXd::Zero(element->traits().dofs);
    const bool turns =
        c.entry->nodes == 1 && !c.entry->unknowns.empty();  // a rotational spring: no other strain
    const int moved = turns                  ? element->traits().dofs - 1
                      : c.entry->structure() ? 0
                                             : 1;  // along the line, or across the joint
    du(moved) = 1e-6;
    EXPECT_EQ(run.evaluate(du), Outcome::ok) << c.name;
    du(moved) = 1.0;
    EXPECT_EQ(run.evaluate(du), Outcome::cut_step) << c.name;
  }
}

TEST(SolidShape, NamesTheNodeWhoseCoordinateIsNotANumber) {
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
    EXPECT_EQ(complaint(1, geometry, {0, 0, 1, 0, NAN, 1, 0, 1}),
              "a coordinate of local node 3 is not a number");
    EXPECT_EQ(complaint(1, geometry, {0, 0, 1, 0, 1, 1, 0, INFINITY}),
              "a coordinate of local node 4 is not a number");
  }
}

TEST(SolidShape, NamesTheNodeFarthestBeyondTheAxis) {
  EXPECT_EQ(complaint(1, Geometry::axisymmetric, {-0.1, 0, 1, 0, 1, 1, -0.2, 1})
                .find("node on negative radius: local node 4 has r = -0.2"),
            0u);
}

// A triangle with node 4 on the edge from 3 to 1, hardly farther from 3 than a coincident node: both corners
// are flat to rounding, and no edges cross.
TEST(SolidShape, NearlyCoincidentNodesAreNotCalledCrossed) {
  EXPECT_EQ(complaint(1, Geometry::plane_strain, {0, 0, 1, 0, 0.5, 1, 0.5 - 0.75e-9, 1 - 1.5e-9})
                .find("re-entrant corner at local node 3"),
            0u);
}

TEST(InterfaceShape, ACoordinateThatIsNotANumber) {
  EXPECT_EQ(complaint(11, Geometry::plane_strain, {0, 0, 1, NAN, 1, 0, 0, 0}),
            "interface: a coordinate is not a number");
}

// One of the two pairs of another order is together, the other is not: no order would be right.
TEST(InterfaceShape, APairApartIsNotTakenForAnotherOrder) {
  EXPECT_EQ(complaint(11, Geometry::plane_strain, {0, 0, 1, 0, 0, 0, 0.5, 0}),
            "interface: the nodes of pair (1, 4) are 0.500000 apart; they must be at the same place");
  EXPECT_EQ(complaint(11, Geometry::plane_strain, {0, 0, 0, 0, 1, 0, 2, 0}),
            "interface: the nodes of pair (1, 4) are 2.000000 apart; they must be at the same place");
}

TEST(InterfaceShape, NewtonCotesAwayFromTheAxisNeedsNoCaution) {
  const Eigen::Matrix2Xd x = (Eigen::Matrix2Xd(2, 4) << 1, 2, 2, 1, 0, 0, 0, 0).finished();
  EXPECT_EQ(element_case(11, 3, Geometry::axisymmetric).make()->caution(x), "");
}

}  // namespace
}  // namespace sage::test
