// The acoustic tensor against closed forms.
#include "sage/analysis/uniqueness.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "materials/linear_elastic.hpp"
#include "sage/app/commands.hpp"
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

// Elastic until its largest stretch, then without stress and tangent, and says that it is elastic.
class Torn final : public SolidLaw {
 public:
  explicit Torn(double stretch) : D_(elastic_matrix(moduli_from_young(1000.0, 0.0))), stretch_(stretch) {}
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    const double stretch = (in.eps0 + in.deps).head<3>().maxCoeff();
    const bool whole = stretch < stretch_;
    out.sigma = whole ? Vector4(in.sigma0 + D_ * in.deps) : Vector4(Vector4::Zero());
    out.D = whole ? D_ : Matrix4(Matrix4::Zero());
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  Matrix4 D_;
  double stretch_;
};

// Three columns of one element each, pulled by 0.01; the middle one tears at the given stretch, the right one is elastic.  Its points are counted by
// their tangent, whatever status the law gives.
TEST(PointsWithoutStiffness, AreCountedByTheirTangent) {
  Catalogue catalogue = app::full_catalogue();
  catalogue.materials.add(90, {"torn",
                               "",
                               4,
                               {required("stretch", Dimension::none, "of its end")},
                               [](std::span<const double> values, const UnitSystem&) -> LawPtr {
                                 return std::make_unique<Torn>(values[0]);
                               }});
  const scenes::Workbench bench{catalogue, [](const SystemSize&) { return 1; }};
  for (const double stretch : {0.005, 0.02}) {
    test::Block block;
    block.columns = 3;
    block.place = test::rectangle(0.0, 3.0, 0.0, 1.0);
    test::DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 90, {1.0});
    deck.material(2, 90, {stretch});
    deck.material(3, 1, {1000.0, 0.3});
    for (int group : {1, 2, 3}) {
      deck.group(group, 1, 0, group);
      deck.element(
          group, group,
          {block.node(group - 1, 0), block.node(group, 0), block.node(group, 1), block.node(group - 1, 1)});
    }
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    test::StageCards& stage = deck.stage();
    for (int n : block.top()) stage.fix(n, n == block.top().back() ? 0 : 1, 1, 0.0, 0.01);
    const test::WholeRun run = bench.run(bench.build(deck.text()));
    ASSERT_TRUE(run.completed()) << run.failure;
    const bool warned = std::ranges::any_of(run.warnings, [](const std::string& warning) {
      return warning.find("4 point(s) with a tangent that has no stiffness, in element(s) 2: ") !=
             std::string::npos;
    });
    EXPECT_EQ(warned, stretch < 0.01) << stretch;
  }
}

}  // namespace
}  // namespace sage
