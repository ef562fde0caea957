// evaluate() and geometry() of every element allocate nothing.
#include <gtest/gtest.h>

#include "sage/conformance/allocations.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

TEST(Allocation, NoneInEvaluateAndGeometry) {
  const AnySmoothLaw laws;
  for (const ElementCase& c : element_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const Eigen::Matrix2Xd x = sample_shape_on_axis(*c.entry);
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
