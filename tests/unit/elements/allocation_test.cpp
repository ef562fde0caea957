// evaluate() and geometry() of every element allocate nothing.
#include <gtest/gtest.h>

#include "sage/conformance/allocations.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

// Ends of beams that slip are refused there.
Eigen::Matrix2Xd touches_axis_if_it_may(const Element& element, const ElementEntry& entry) {
  Eigen::Matrix2Xd x = sample_shape_on_axis(entry);
  std::vector<double> geometry(static_cast<std::size_t>(element.traits().geometry_size()));
  try {
    element.geometry(x, geometry);
  } catch (const ElementShapeError&) {
    x = sample_shape(entry);
  }
  return x;
}

TEST(Allocation, NoneInEvaluateAndGeometry) {
  const AnySmoothLaw laws;
  for (const ElementCase& c : element_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const Eigen::Matrix2Xd x = touches_axis_if_it_may(*element, *c.entry);
    ElementRun run(*element, x, laws.of(c));
    const Eigen::VectorXd du = Eigen::VectorXd::Constant(element->traits().dofs, 0.1);
    const std::size_t before = allocations();
    element->geometry(x, run.geometry);
    run.evaluate(du);
    run.evaluate(du, false);
    EXPECT_EQ(allocations(), before);
  }
}

// The counter must be able to fail.
TEST(Allocation, TheCounterCounts) {
  const std::size_t before = allocations();
  const std::vector<double> some(10, 1.0);
  EXPECT_EQ(allocations(), before + 1) << some.front();
}

}  // namespace
}  // namespace sage::test
