// The suites that come with the package, over pieces of one's own.
#include "bar.hpp"
#include "consolidation.hpp"
#include "creep.hpp"
#include "diffusion.hpp"
#include "layered.hpp"
#include "sage/conformance/element_suite.hpp"
#include "sage/conformance/law_suite.hpp"
#include "sage/conformance/solver_suite.hpp"
#include "sparse_lu.hpp"
#include "tri10.hpp"
#include "truss.hpp"

namespace sage::conformance {

const Catalogue& pieces() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.materials.add(90, own::layered());
    c.materials.add(80, own::rod());
    c.materials.add(91, own::maxwell());
    c.elements.add(40, own::tri10());
    c.elements.add(50, own::bar2());
    c.elements.add(1041, own::diffusion_quad());
    c.elements.add(1060, own::truss2());
    c.elements.add(1061, own::consolidation2());
    c.solvers.add(90, own::sparse_lu());
    return c;
  }();
  return catalogue;
}

INSTANTIATE_TEST_SUITE_P(
    Own, Laws,
    testing::ValuesIn(law_subjects(
        pieces(),
        {{.what = "layered", .code = 90, .values = {2e4, 1e4, 0.2, 0.3, 4e3}, .knows_directions = true},
         {.what = "rod", .code = 80, .values = {2e5, 0.01}},
         {.what = "maxwell", .code = 91, .values = {1e4, 0.3, 2.0}}})),
    name_of_law);
INSTANTIATE_TEST_SUITE_P(Own, Elements, testing::Values(ElementSubject{"own", &pieces()}), name_of_elements);
INSTANTIATE_TEST_SUITE_P(Own, Solvers, testing::ValuesIn(solver_subjects(pieces())), name_of_solver);

}  // namespace sage::conformance
