// The suites that come with the package, over pieces of one's own.
#include "layered.hpp"
#include "sage/conformance/element_suite.hpp"
#include "sage/conformance/law_suite.hpp"
#include "sage/conformance/solver_suite.hpp"
#include "sparse_lu.hpp"
#include "tri10.hpp"

namespace sage::conformance {

const Catalogue& pieces() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.materials.add(90, own::layered());
    c.elements.add(40, own::tri10());
    c.solvers.add(90, own::sparse_lu());
    return c;
  }();
  return catalogue;
}

INSTANTIATE_TEST_SUITE_P(Own, Laws,
                         testing::ValuesIn(law_subjects(pieces(), {{.what = "layered",
                                                                    .code = 90,
                                                                    .values = {2e4, 1e4, 0.2, 0.3, 4e3},
                                                                    .knows_directions = true}})),
                         name_of_law);
INSTANTIATE_TEST_SUITE_P(Own, Elements, testing::Values(ElementSubject{"tri10", &pieces()}), name_of_elements);
INSTANTIATE_TEST_SUITE_P(Own, Solvers, testing::ValuesIn(solver_subjects(pieces())), name_of_solver);

}  // namespace sage::conformance
