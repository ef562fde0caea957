// The suites that come with the package, over pieces of one's own.
#include "own_pieces.hpp"
#include "sage/conformance/suites.hpp"

namespace sage::conformance {

const Catalogue& pieces() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    own::add_pieces(c);
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
