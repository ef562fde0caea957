// The Zienkiewicz-Zhu estimate against the true error in the energy norm, on the thick cylinder: effectivity =
// estimated over true.
#include "sage/analysis/error_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sage/app/commands.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/output/discretisation.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// a = 1, b = 2, p = E = 1 (REFERENCES 2.1): stress at x in a sector (plane strain) or a strip of the ring.
Vector4 lame_stress(bool ring, double nu, const Vector2& x) {
  const double r = ring ? x.x() : x.norm(), c = 1.0 / 3.0;
  const double radial = c * (1.0 - 4.0 / (r * r)), hoop = c * (1.0 + 4.0 / (r * r)), along = 2.0 * nu * c;
  if (ring) return {radial, along, hoop, 0.0};
  const double cos = x.x() / r, sin = x.y() / r;
  return {radial * cos * cos + hoop * sin * sin, radial * sin * sin + hoop * cos * cos, along,
          (radial - hoop) * sin * cos};
}

// Estimates at the end of a run, and measures the true error at the integration points.
class Judge final : public Observer {
 public:
  Judge(bool ring, double nu) : ring_(ring), nu_(nu) {}
  void on_increment(const Model& model, const StepReport&, const Solution& solution) override {
    estimate = estimate_error(model, solution);
    const Matrix4 C = compliance();
    Eigen::Matrix2Xd x;
    std::vector<double> geometry;
    for (const GroupData& data : solution.assembly->groups()) {
      const Element& element = *data.group->element;
      const ElementTraits& t = element.traits();
      geometry.resize(static_cast<std::size_t>(t.geometry_size()));
      for (int e = 0; e < data.group->elements(); ++e) {
        element_coordinates(model.mesh, *data.group, e, x);
        element.geometry(x, geometry);
        for (int p = 0; p < t.points; ++p) {
          const Eigen::Map<const Vector4> own(data.state.committed.sigma.data() +
                                              4 * (static_cast<std::size_t>(e * t.points + p)));
          const Vector4 difference = own - lame_stress(ring_, nu_, element.position(x, p));
          error += geometry[static_cast<std::size_t>(p * (1 + 4 * t.dofs))] * difference.dot(C * difference);
        }
      }
    }
  }
  double effectivity() const { return std::sqrt(estimate.error / error); }

  ErrorEstimate estimate;
  double error = 0.0;

 private:
  Matrix4 compliance() const {
    Matrix4 C = Matrix4::Constant(-nu_);
    C.diagonal().setOnes();
    C.row(3).setZero();
    C.col(3).setZero();
    C(3, 3) = 2.0 * (1.0 + nu_);
    return C;  // E = 1
  }
  bool ring_;
  double nu_;
};

std::string cylinder(bool ring, Cell cell, int formulation, int n, double nu) {
  Block block;
  block.cell = cell;
  block.columns = n;
  block.rows = ring ? std::max(1, n / 2) : n;
  block.polar = !ring;
  block.place = ring ? rectangle(1.0, 2.0, 0.0, 0.5) : rectangle(1.0, 2.0, 0.0, 90.0);
  DeckWriter deck(ring ? 2 : 1);
  block.write_nodes(deck);
  deck.material(1, 1, {1.0, nu});
  deck.group(1, static_cast<int>(cell), formulation, 1);
  block.write_elements(deck, 1);
  for (int node : block.bottom()) deck.fix(node, 0, 1);
  for (int node : block.top()) deck.fix(node, ring ? 0 : 1, ring ? 1 : 0);
  StageCards& stage = deck.stage();
  const int inner = cell == Cell::tri3 || cell == Cell::tri6 ? 3 : 4;
  for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(0, j), inner, 1.0, 1.0);
  return deck.text();
}

Judge judge(bool ring, double nu, const std::string& deck, const BuildOptions& options = {}) {
  static const Catalogue catalogue = app::full_catalogue();
  const Model model = build_model(read_deck_text(deck, "deck", load_layout("sage1")), catalogue, options);
  RunSettings settings;
  settings.choose_solver = [](int equations, bool symmetric) { return choose_solver(equations, symmetric); };
  Judge watch(ring, nu);
  Observer* observers[] = {&watch};
  EXPECT_EQ(run(model, catalogue, settings, observers).status, RunStatus::completed);
  return watch;
}

struct Case {
  const char* name;
  Cell cell;
  int formulation, element, n;
};

// Fully integrated elements, whose error can be measured at their points.
const Case kCases[] = {
    {"quad4 full", Cell::quad4, 1, 0, 8}, {"quad4 b-bar", Cell::quad4, 2, 0, 8},
    {"quad8 full", Cell::quad8, 2, 0, 8}, {"quad9", Cell::quad9, 1, 0, 8},
    {"tri6", Cell::tri6, 2, 0, 8},        {"quad25", Cell::quad4, 0, 7, 4},
};

TEST(ErrorEstimate, EffectivityOnTheThickCylinder) {
  for (const bool ring : {false, true})
    for (const Case& c : kCases) {
      if (!ring && c.element != 0) continue;  // straight sides would be its only error
      for (const int n : {c.n, 2 * c.n}) {
        BuildOptions options;
        options.element = c.element;
        const Judge now = judge(ring, 0.3, cylinder(ring, c.cell, c.formulation, n, 0.3), options);
        std::printf("    %-12s %-6s n %2d  relative error %.2e  effectivity %.3f\n", c.name,
                    ring ? "ring" : "sector", n, now.estimate.relative(), now.effectivity());
        EXPECT_TRUE(now.estimate.energy);
        EXPECT_GT(now.effectivity(), 0.8) << c.name << " n " << n;
        EXPECT_LT(now.effectivity(), 1.25) << c.name << " n " << n;
      }
    }
}

TEST(ErrorEstimate, PartsOfTheElementsSumToTheWhole) {
  const Judge now = judge(true, 0.3, cylinder(true, Cell::quad4, 2, 6, 0.3));
  double sum = 0.0;
  for (const auto& group : now.estimate.element)
    for (double part : group) {
      EXPECT_GE(part, 0.0);
      sum += part;
    }
  EXPECT_NEAR(sum, now.estimate.error, 1e-14 * sum);
  EXPECT_EQ(now.estimate.worst_group, 0);
}

TEST(WithError, ShowsTheDigitsThatAreCertain) {
  EXPECT_EQ(with_error(1.0863123, 0.00034), "1.0863 +- 0.0004");
  EXPECT_EQ(with_error(1.0863123, 0.0), "1.0863123");
  EXPECT_EQ(with_error(123.4, 20.0), "123 +- 20");
  EXPECT_EQ(with_error(-2.5, 0.096), "-2.50 +- 0.10");
}

}  // namespace
}  // namespace sage::test
