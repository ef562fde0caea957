// The Zienkiewicz-Zhu estimate against the true error in the energy norm, on the thick cylinder: effectivity
// = estimated over true.
#include "sage/analysis/error_estimate.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>

#include "sage/app/commands.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/record/discretisation.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/scenes/lame.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// Estimates at the end of a run, and measures the true error: at the integration points, and of the displacements
// everywhere, which is what a reduced element has wrong.
class ErrorComparison final : public Observer {
 public:
  ErrorComparison(LameBody body, double nu) : body_(body), nu_(nu) {}
  void on_increment(const Model& model, const StepReport&, const Solution& solution) override {
    estimate = estimate_error(model, solution);
    const Matrix4 C = compliance();
    const Matrix4 D = C.inverse();
    for (const GroupData& data : solution.assembly->groups())
      for (int e = 0; e < data.group->elements(); ++e)
        everywhere += of_displacements(model, *data.group, e, *solution.u, C, D);
    Eigen::Matrix2Xd x;
    std::vector<double> geometry;
    for (const GroupData& data : solution.assembly->groups()) {
      const Element& element = *data.group->element;
      const ElementTraits& t = element.traits();
      geometry.resize(t.geometry_size());
      for (int e = 0; e < data.group->elements(); ++e) {
        element_coordinates(model.mesh, *data.group, e, x);
        element.geometry(x, geometry);
        for (int p = 0; p < t.points; ++p) {
          const Eigen::Map<const Vector4> own(data.state.committed.sigma.data() +
                                              4 * (static_cast<std::size_t>(e * t.points + p)));
          const Vector4 difference = own - lame_stress(body_, nu_, element.position(x, p));
          error += geometry[p * (1 + 4 * t.dofs)] * difference.dot(C * difference);
        }
      }
    }
  }
  double effectivity() const { return std::sqrt(estimate.error / error); }
  double effectivity_everywhere() const { return std::sqrt(estimate.error / everywhere); }

  ErrorEstimate estimate;
  double error = 0.0, everywhere = 0.0;

 private:
  // By 6 x 6 points; of a triangle they crowd towards one corner.
  double of_displacements(const Model& model, const Group& group, int e, const Eigen::VectorXd& all,
                          const Matrix4& C, const Matrix4& D) const {
    const double places[] = {.932469514203152, .661209386466265, .238619186083197},
                 weights[] = {.171324492379170, .360761573048139, .467913934572691};
    Eigen::Matrix2Xd x;
    element_coordinates(model.mesh, group, e, x);
    const Eigen::Index nodes = x.cols();
    Eigen::Matrix2Xd u(2, nodes);
    for (Eigen::Index i = 0; i < nodes; ++i)
      u.col(i) = all.segment<2>(DofMap::displacement(group.nodes_of(e)[i]));
    std::vector<double> N(static_cast<std::size_t>(nodes)), dN(2 * N.size());
    const Eigen::Map<const Eigen::VectorXd> values(N.data(), nodes);
    const Eigen::Map<const Eigen::MatrixX2d> slopes(dN.data(), nodes, 2);
    double sum = 0.0;
    for (int i = 0; i < 36; ++i) {
      const int a = i % 6, b = i / 6;
      Vector2 place((a < 3 ? -1 : 1) * places[a % 3], (b < 3 ? -1 : 1) * places[b % 3]);
      double w = weights[a % 3] * weights[b % 3];
      if (group.entry->triangle()) {
        place = 0.5 * (place + Vector2::Ones());
        place.y() *= 1.0 - place.x();
        w *= 0.25 * (1.0 - place.x());
      }
      EXPECT_TRUE(group.element->shape_functions(place, N, dN));
      const Vector2 at = x * values;
      const Matrix2 J = x * slopes, G = u * slopes * J.inverse();
      const bool ring = model.geometry == Geometry::axisymmetric;
      const Vector4 strain(G(0, 0), G(1, 1), ring ? u.row(0).dot(values) / at.x() : 0.0, G(0, 1) + G(1, 0));
      const Vector4 difference = D * strain - lame_stress(body_, nu_, at);
      sum += w * J.determinant() * (ring ? 2.0 * M_PI * at.x() : 1.0) * difference.dot(C * difference);
    }
    return sum;
  }
  Matrix4 compliance() const {
    Matrix4 C = Matrix4::Constant(-nu_);
    C.diagonal().setOnes();
    C.row(3).setZero();
    C.col(3).setZero();
    C(3, 3) = 2.0 * (1.0 + nu_);
    return C;  // E = 1
  }
  LameBody body_;
  double nu_;
};

ErrorComparison compare_errors(const LameDeck& deck, const BuildOptions& options = {}, int threads = 1) {
  static const Catalogue catalogue = app::full_catalogue();
  const Model model =
      build_model(read_deck_text(deck.text(), "deck", load_layout("sage1")), catalogue, options);
  RunSettings settings;
  settings.choose_solver = choose_solver;
  settings.threads = threads;
  ErrorComparison watch(deck.body, deck.nu);
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
  for (const LameBody body : {LameBody::sector, LameBody::strip})
    for (const Case& c : kCases) {
      if (body == LameBody::sector && c.element != 0) continue;  // straight sides would be its only error
      for (const int n : {c.n, 2 * c.n}) {
        BuildOptions options;
        options.element = c.element;
        const ErrorComparison now = compare_errors({body, c.cell, c.formulation, n, 0.3}, options);
        std::printf("    %-12s %-6s n %2d  relative error %.2e  effectivity %.3f\n", c.name,
                    body == LameBody::strip ? "ring" : "sector", n, now.estimate.relative(), now.effectivity());
        EXPECT_TRUE(now.estimate.energy);
        EXPECT_GT(now.effectivity(), 0.8) << c.name << " n " << n;
        EXPECT_LT(now.effectivity(), 1.25) << c.name << " n " << n;
      }
    }
}

// Near nu = 1/2 the displacements of reduced elements have a volume change that is far off between their integration
// points.  The estimate was .03 to 3 times the error.
TEST(ErrorEstimate, OfReducedElementsUpToIncompressible) {
  const Case reduced[] = {{"quad8 reduced", Cell::quad8, 1, 0, 8}, {"tri6 three points", Cell::tri6, 1, 0, 8}},
             own[] = {{"quad4 b-bar", Cell::quad4, 2, 0, 8}, {"quad4 selective", Cell::quad4, 3, 0, 8}};
  for (const LameBody body : {LameBody::sector, LameBody::strip})
    for (const double nu : {0.1, 0.3, 0.45, 0.49, 0.499, 0.4999}) {
      for (const Case& c : reduced)
        for (const int n : {8, 16}) {
          const double ratio = compare_errors({body, c.cell, c.formulation, n, nu}).effectivity_everywhere();
          std::printf("    %-18s %-6s n %2d nu %.4f effectivity %.3f\n", c.name,
                      body == LameBody::strip ? "ring" : "sector", n, nu, ratio);
          EXPECT_GT(ratio, 0.5) << c.name << " nu " << nu << " n " << n;
          EXPECT_LT(ratio, 2.0) << c.name << " nu " << nu << " n " << n;
        }
      for (const Case& c : own)
        EXPECT_NEAR(compare_errors({body, c.cell, c.formulation, 8, nu}).effectivity(), 0.93, 0.05);
    }
}

// Straight sides, and parabolas, whose distance from the circle is no part of the estimate: it is more than the error of
// degree 6.  That of degree 8 is rounding here.
TEST(ErrorEstimate, OfHighDegrees) {
  struct High {
    const char* name;
    Cell cell;
    int formulation, code, element, n;
    bool curved;
  };
  const High all[] = {{"tri15, 12 points", Cell::tri6, 1, 6, 0, 8, true},
                      {"tri15, 16 points", Cell::tri6, 2, 6, 0, 8, true},
                      {"quad25", Cell::quad8, 1, 0, 7, 8, true},
                      {"quad49", Cell::quad8, 1, 0, 8, 8, false}};
  for (const LameBody body : {LameBody::sector, LameBody::strip})
    for (const High& c : all)
      for (const double nu : {0.1, 0.3, 0.499, 0.4999}) {
        if (body == LameBody::sector && !c.curved) continue;
        BuildOptions options;
        options.element = c.element;
        LameDeck deck{body, c.cell, c.formulation, c.n, nu};
        deck.code = c.code;
        const double ratio = compare_errors(deck, options).effectivity();
        std::printf("    %-18s %-6s n %2d nu %.4f effectivity %.3f\n", c.name,
                    body == LameBody::strip ? "ring" : "sector", c.n, nu, ratio);
        EXPECT_GT(ratio, 0.5) << c.name << " nu " << nu;
        EXPECT_LT(ratio, 2.0) << c.name << " nu " << nu;
      }
}

TEST(ErrorEstimate, PartsOfTheElementsSumToTheWhole) {
  const ErrorComparison now = compare_errors({LameBody::strip, Cell::quad4, 2, 6, 0.3});
  double sum = 0.0;
  for (const auto& group : now.estimate.element)
    for (double part : group) {
      EXPECT_GE(part, 0.0);
      sum += part;
    }
  EXPECT_NEAR(sum, now.estimate.error, 1e-14 * sum);
  EXPECT_EQ(now.estimate.worst_group, 0);
}

TEST(ErrorEstimate, ThreadsChangeNoBit) {
  const LameDeck deck{LameBody::sector, Cell::quad4, 2, 8, 0.3};
  BuildOptions options;
  options.refine = 3;
  const ErrorComparison alone = compare_errors(deck, options, 1);
  ASSERT_GE(alone.estimate.element.at(0).size(), 2000u) << "fewer elements are left to one thread";
  for (const int threads : {2, 3}) {
    const ErrorComparison several = compare_errors(deck, options, threads);
    EXPECT_EQ(several.estimate.error, alone.estimate.error);
    EXPECT_EQ(several.estimate.size, alone.estimate.size);
    EXPECT_EQ(several.estimate.element, alone.estimate.element);
    EXPECT_EQ(several.estimate.worst_element, alone.estimate.worst_element);
  }
}

TEST(WithError, ShowsTheDigitsThatAreCertain) {
  EXPECT_EQ(with_error(1.0863123, 0.00034), "1.0863 +- 0.0004");
  EXPECT_EQ(with_error(1.0863123, 0.0), "1.0863123");
  EXPECT_EQ(with_error(123.4, 20.0), "123 +- 20");
  EXPECT_EQ(with_error(-2.5, 0.096), "-2.50 +- 0.10");
}

}  // namespace
}  // namespace sage::test
