// The acoustic tensor against closed forms.
#include "sage/analysis/uniqueness.hpp"

#include <gtest/gtest.h>

#include "tests/support/run_text.hpp"

namespace sage {
namespace {

Matrix4 elastic(double K, double G) {
  Matrix4 D = Matrix4::Zero();
  D.topLeftCorner<3, 3>().setConstant(K - 2.0 * G / 3.0);
  for (int i = 0; i < 3; ++i) D(i, i) = K + 4.0 * G / 3.0;
  D(3, 3) = G;
  return D;
}

// det n D n = (K + 4G/3) G in every direction.
TEST(AcousticRatio, ElasticIsOne) {
  EXPECT_NEAR(smallest_acoustic_ratio(elastic(5.0, 2.0), elastic(5.0, 2.0)), 1.0, 1e-12);
  EXPECT_NEAR(smallest_acoustic_ratio(elastic(5.0, 1.0), elastic(5.0, 2.0)), 19.0 / 3.0 / (2.0 * 23.0 / 3.0),
              1e-12);
}

// A shear modulus that is -1/10 of the elastic one along the axes: det = (K + 4G/3)(-G/10) for n = x.
TEST(AcousticRatio, SofteningInShear) {
  Matrix4 D = elastic(5.0, 2.0);
  D(3, 3) = -0.2;
  EXPECT_NEAR(smallest_acoustic_ratio(D, elastic(5.0, 2.0)), -0.1, 1e-12);
}

// Compressed in plane strain far beyond yield: friction without dilation loses uniqueness at every point,
// associated flow at none.
TEST(LossOfUniqueness, IsForFlowThatIsNotAssociated) {
  for (double dilation : {0.0, 35.0}) {
    test::Block block;
    block.place = test::rectangle(0.0, 1.0, 0.0, 1.0);
    test::DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 4, {3000.0, 0.3, 1.0, 35.0, dilation});
    deck.group(1, 1, 2, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    test::StageCards& stage = deck.stage(10);
    for (int n : block.top()) stage.fix(n, 0, 1, 0.0, -0.05);
    const test::WholeRun run = test::run_text(deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    bool warned = false;
    for (const std::string& warning : run.warnings)
      warned =
          warned ||
          warning.find("loss of uniqueness: the determinant of the acoustic tensor is negative at 4 of 4") !=
              std::string::npos;
    EXPECT_EQ(warned, dilation == 0.0);
  }
}

}  // namespace
}  // namespace sage
