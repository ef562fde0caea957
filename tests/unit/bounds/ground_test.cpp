// Decks as limit analysis sees them, and what it rejects.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/bounds/bounds.hpp"
#include "sage/bounds/model_domain.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::bounds {
namespace {

Model model_of(const std::string& deck) {
  Catalogue catalogue;
  register_elements(catalogue);
  register_materials(catalogue);
  register_solvers(catalogue);
  const scenes::Workbench bench(std::move(catalogue), choose_solver);
  std::ifstream in(SAGE_SOURCE_DIR "/legacy_inputs/" + deck);
  return bench.build({std::istreambuf_iterator<char>(in), {}});
}

Bounds factor_of(const std::string& deck) {
  const Model model = model_of(deck);
  const Ground ground = make_ground(model, 0, static_cast<int>(model.stages.size()) - 1);
  Options options;
  options.quantity = Quantity::strength;
  options.elements = 0;
  return find_bounds(ground.domain, options);
}

void expect_around(const Bounds& found, double exact, double gap) {
  ASSERT_TRUE(found.lower.value) << found.lower.reason;
  ASSERT_TRUE(found.upper.value) << found.upper.reason;
  EXPECT_LE(*found.lower.value, exact);
  EXPECT_LE(*found.relative_gap(), gap);
  EXPECT_GE(*found.upper.value, 0.997 * exact);
}

// Log spirals through the toe, an upper bound (docs/theory/strength_reduction.md).
TEST(Ground, SlopeAndWaterPressures) {
  expect_around(factor_of("slopes/griffiths_lane/deck.dat"), 1.36821452, 0.02);
  expect_around(factor_of("slopes/griffiths_lane_ru/deck.dat"), 1.10035217, 0.02);
}

std::string code_of(const std::string& deck) {
  const Model model = model_of(deck);
  try {
    (void)make_ground(model, 0, static_cast<int>(model.stages.size()) - 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Ground, RejectsByName) {
  EXPECT_NE(code_of("chapter7/dp_285/deck.dat").find("axisymmetric"), std::string::npos);
  EXPECT_NE(code_of("structures/sheet_pile/deck.dat").find("is a structure"), std::string::npos);
  EXPECT_NE(code_of("hyperbolic/strip_footing/deck.dat").find("has no bounds"), std::string::npos);
}

}  // namespace
}  // namespace sage::bounds
