// Displacement, strain and stress at a place against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/record/report.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/scenes/lame.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

using scenes::Block;
using scenes::Cell;
using scenes::DeckWriter;

constexpr double kE = 1000.0, kNu = 0.3;

struct PointRun {
  std::unique_ptr<Model> model;
  std::unique_ptr<Reports> reports;
  RunResult result;

  const PointRow& last(std::size_t i = 0) const { return reports->points(i).back(); }
};

const Catalogue& catalogue() {
  static const Catalogue all = app::full_catalogue();
  return all;
}

Model build(const std::string& deck, const BuildOptions& options) {
  static const Layout layout = load_layout("sage1");
  return build_model(read_deck_text(deck, "deck", layout), catalogue(), options);
}

PointRun run(Model model) {
  PointRun run;
  run.model = std::make_unique<Model>(std::move(model));
  run.reports = std::make_unique<Reports>(test::scratch_folder("points"), "p");
  RunSettings settings;
  settings.choose_solver = choose_solver;
  Observer* observers[] = {run.reports.get()};
  run.result = sage::run(*run.model, catalogue(), settings, observers);
  return run;
}

BuildOptions at(const std::vector<Vector2>& places, int element = 0) {
  BuildOptions options;
  options.element = element;
  for (const Vector2& place : places) options.points.push_back({place, "", 0});
  return options;
}

using Field = std::function<Vector2(const Vector2&)>;

// All outer nodes are moved as `field` says, to the last digit.
PointRun moved(const Block& block, int geometry, const Field& field, const BuildOptions& options) {
  DeckWriter deck(geometry);
  block.write_nodes(deck);
  deck.material(1, 1, {kE, kNu});
  deck.group(1, static_cast<int>(block.cell), 0, 1);
  block.write_elements(deck, 1);
  scenes::StageCards& stage = deck.stage();
  for (const std::vector<int>& side : {block.bottom(), block.right(), block.top(), block.left()})
    for (int n : side) stage.fix(n, 1, 1);
  Model model = build(deck.text(), options);
  for (Fixity& f : model.stages[0].fixities) {
    const Vector2 u = field(model.mesh.x.col(f.node));
    f.value = {u.x(), u.y()};
  }
  return run(std::move(model));
}

Block block_of(Cell cell, int n, const std::function<Vector2(double, double)>& place) {
  Block block;
  block.cell = cell;
  block.columns = block.rows = n;
  block.place = place;
  block.straight = true;
  return block;
}

// A uniform strain in a mesh of crooked elements: exact inside, on edges and at nodes, for every element.
TEST(PointReport, PatchTest) {
  const auto crooked = [](double s, double t) {
    return Vector2(2 * s + 0.1 * std::sin(5 * t) * s * (1 - s),
                   t + 0.1 * s * t + 0.1 * std::sin(7 * s) * t * (1 - t));
  };
  const Field field = [](const Vector2& x) {
    return Vector2(0.01 * x.x() + 0.002 * x.y(), -0.003 * x.x() + 0.02 * x.y());
  };
  const double lambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu)), G = kE / (2 * (1 + kNu)), e = 0.03;
  const double stress[4] = {-lambda * e - 2 * G * 0.01, -lambda * e - 2 * G * 0.02, -lambda * e, -G * -0.001};
  for (const auto& [cell, element] : {std::pair{Cell::quad4, 0},
                                      {Cell::quad4, 7},
                                      {Cell::quad4, 9},
                                      {Cell::quad8, 0},
                                      {Cell::quad9, 0},
                                      {Cell::tri3, 0},
                                      {Cell::tri6, 0}}) {
    const Block block = block_of(cell, 3, crooked);
    const int middle = block.order();
    const std::vector<Vector2> places{
        block.place(0.37, 0.61), block.place(0.05, 0.05), block.at(middle, middle),
        0.5 * (block.at(middle, middle) + block.at(2 * middle, middle)), block.at(0, 0)};
    const PointRun r = moved(block, 1, field, at(places, element));
    ASSERT_EQ(r.result.status, RunStatus::completed);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const PointRow& row = r.last(i);
      const Vector2 u = field(places[i]);
      for (int c = 0; c < 2; ++c) EXPECT_NEAR(row.displacement[c], u[c], 1e-12) << i;
      const double strain[4] = {-0.01, -0.02, 0.0, 0.001};
      for (int c = 0; c < 4; ++c) {
        EXPECT_NEAR(row.strain[c], strain[c], 1e-11) << "cell " << static_cast<int>(cell) << " place " << i;
        EXPECT_NEAR(row.stress[c], stress[c], 1e-8) << "cell " << static_cast<int>(cell) << " place " << i;
      }
    }
  }
}

// Bodies of one row of elements, and of two triangles: their places of accurate stress lie on two lines or on a
// conic, which a full polynomial of degree 2 can't tell from nothing.
TEST(PointReport, PatchTestOfOneRow) {
  const Field field = [](const Vector2& x) {
    return Vector2(0.01 * x.x() + 0.002 * x.y(), -0.003 * x.x() + 0.02 * x.y());
  };
  const double lambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu)), G = kE / (2 * (1 + kNu)), e = 0.03;
  const double stress[4] = {-lambda * e - 2 * G * 0.01, -lambda * e - 2 * G * 0.02, -lambda * e, -G * -0.001};
  for (const double bend : {0.0, 1e-4, 0.1})
    for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 2}, {1, 6}, {6, 1}})
      for (const Cell cell : {Cell::quad8, Cell::quad9, Cell::tri3, Cell::tri6}) {
        Block block = block_of(cell, 1, [&](double s, double t) {
          return Vector2(2 * s + bend * std::sin(3 * t), t + bend * std::sin(2 * s));
        });
        block.columns = columns;
        block.rows = rows;
        const std::vector<Vector2> places{block.place(0.37, 0.61), block.place(0.5, 0.5),
                                          block.place(0.9, 0.9)};
        const PointRun r = moved(block, 1, field, at(places));
        ASSERT_EQ(r.result.status, RunStatus::completed);
        for (std::size_t i = 0; i < places.size(); ++i)
          for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(r.last(i).stress[c], stress[c], 1e-8)
                << "cell " << static_cast<int>(cell) << ", " << columns << " x " << rows << ", bend " << bend;
      }
}

double lame_defect(const PointRun& r, scenes::LameBody body, const std::vector<Vector2>& places) {
  double worst = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector4 exact = scenes::lame_stress(body, 0.3, places[i]);
    for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(r.last(i).stress[c] + exact[c]));
  }
  return worst;
}

// Lame's cylinder and sphere under p = 1, at the inner and outer face and between.  8-node elements: the stress
// at any place converges like h^3 (that of an element's own polynomial like h^2), degree 8 gives it at once.
TEST(PointReport, LameCylinderAndSphere) {
  using scenes::LameBody;
  for (LameBody body : {LameBody::strip, LameBody::sector, LameBody::sphere}) {
    std::vector<Vector2> places;
    for (double radius : {1.0, 1.07, 1.37, 1.5, 2.0})
      places.push_back(body == LameBody::strip ? Vector2(radius, 0.11) : Vector2(radius, 0.0));
    double errors[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      scenes::LameDeck deck;
      deck.body = body;
      deck.n = 2 << k;
      const PointRun r = run(build(deck.text(), at(places)));
      errors[k] = lame_defect(r, body, places);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const Vector2 u = scenes::lame_displacement(body, 0.3, places[i]);
        EXPECT_NEAR(r.last(i).displacement[0], u.x(), 0.1 / std::pow(deck.n, 3)) << i;
      }
    }
    EXPECT_LT(errors[2], 1e-2) << static_cast<int>(body);
    EXPECT_GT(std::log2(errors[1] / errors[2]), 2.4) << static_cast<int>(body);
    if (body != LameBody::strip) continue;
    scenes::LameDeck one;
    one.body = body;
    one.n = 2;
    one.cell = Cell::quad4;
    const PointRun r = run(build(one.text(), at(places, 9)));
    EXPECT_LT(lame_defect(r, body, places), 1e-5);
    BuildOptions finer = at(places, 9);
    finer.refine = 2;
    EXPECT_LT(lame_defect(run(build(one.text(), finer)), body, places), 1e-9);
  }
}

// Boussinesq's point load on the surface, at a distance from it: compression +, r outwards, depth z.
struct Boussinesq {
  static constexpr double P = 100.0;
  static Vector2 u(const Vector2& x) {
    const double r = x.x(), z = -x.y(), R = std::hypot(r, z), f = P * (1 + kNu) / (2 * kPi * kE * R);
    return {f * (r * z / (R * R) - (1 - 2 * kNu) * r / (R + z)), -f * (z * z / (R * R) + 2 * (1 - kNu))};
  }
  static Vector4 stress(const Vector2& x) {
    const double r = x.x(), z = -x.y(), R = std::hypot(r, z), f = P / (2 * kPi), n = 1 - 2 * kNu;
    return {f * (3 * r * r * z / std::pow(R, 5) - n / (R * (R + z))), f * 3 * std::pow(z, 3) / std::pow(R, 5),
            -f * n * (z / std::pow(R, 3) - 1 / (R * (R + z))), -f * 3 * r * z * z / std::pow(R, 5)};
  }
};

// Largest error of any component, by the largest stress.
double boussinesq_error(Cell cell, int n, int element, const std::vector<Vector2>& places) {
  const Block block = block_of(cell, n, scenes::rectangle(0.0, 1.0, -2.0, -1.0));
  const PointRun r = moved(block, 2, Boussinesq::u, at(places, element));
  double worst = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector4 exact = Boussinesq::stress(places[i]);
    for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(r.last(i).stress[c] - exact[c]));
  }
  return worst / Boussinesq::stress({0.0, -1.0})[1];
}

// On the axis, at the rim and inside, under the load's displacements on the outline of a ring below it.  Linear
// elements h^2, 8-node ones h^3, 6-node ones h^2; on the axis, where the hoop strain is u / r, less.
TEST(PointReport, Boussinesq) {
  const std::vector<Vector2> axis{{0.0, -1.3}, {0.0, -2.0}}, places{{0.31, -1.17}, {0.5, -1.5}, {1.0, -1.0}};
  for (const auto& [cell, rate] : {std::pair{Cell::quad4, 1.8}, {Cell::quad8, 2.6}, {Cell::tri6, 1.7}}) {
    const double coarse = boussinesq_error(cell, 8, 0, places), fine = boussinesq_error(cell, 16, 0, places);
    EXPECT_GT(std::log2(coarse / fine), rate) << static_cast<int>(cell);
    EXPECT_LT(fine, cell == Cell::quad4 ? 1e-2 : 3e-4) << static_cast<int>(cell);
    EXPECT_LT(boussinesq_error(cell, 16, 0, axis), 5e-3) << static_cast<int>(cell);
  }
  for (const std::vector<Vector2>& all : {axis, places}) {
    EXPECT_LT(boussinesq_error(Cell::quad4, 2, 9, all), 1e-6);
    EXPECT_LT(boussinesq_error(Cell::quad4, 4, 9, all), 1e-8);
  }
}

// Two soils beside each other that can't move sideways: sigma_xx = nu / (1 - nu) sigma_yy of each, up to their
// boundary; there the first group of the deck answers, or the one that is asked.
TEST(PointReport, NothingIsAveragedAcrossMaterials) {
  DeckWriter deck(1);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j) deck.node(1 + i + 5 * j, 0.5 * i, 0.5 * j);
  deck.material(1, 1, {kE, 0.1});
  deck.material(2, 1, {5 * kE, 0.4});
  deck.group(1, 1, 2, 1);
  deck.group(2, 1, 2, 2);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 4; ++i) {
      const int n = 1 + i + 5 * j;
      deck.element(1 + i + 4 * j, j == 0 ? 1 : 2, {n, n + 1, n + 6, n + 5});
    }
  for (int n = 1; n <= 15; ++n) deck.fix(n, 1, n <= 5 ? 1 : 0);
  scenes::StageCards& stage = deck.stage(2);
  for (int i = 0; i < 4; ++i) stage.pressure(5 + i, 3, 100.0, 100.0);
  BuildOptions options = at({{0.7, 0.5}, {0.7, 0.5}, {0.7, 0.5}, {0.7, 0.4999}, {1.0, 0.5001}});
  options.points[1].group = 1;
  options.points[2].group = 2;
  const PointRun r = run(build(deck.text(), options));
  const double expected[] = {0.1 / 0.9, 0.1 / 0.9, 0.4 / 0.6, 0.1 / 0.9, 0.4 / 0.6};
  for (std::size_t i = 0; i < 5; ++i) {
    ASSERT_EQ(r.reports->points(i).size(), 2u);
    EXPECT_NEAR(r.last(i).stress[1], 100.0, 1e-7) << i;
    EXPECT_NEAR(r.last(i).stress[0], 100.0 * expected[i], 1e-7) << i;
    EXPECT_NEAR(r.reports->points(i)[0].stress[0], 50.0 * expected[i], 1e-7) << i;
  }
  int notes = 0;
  for (const Diagnostic& d : r.model->diagnostics.list())
    notes += d.message.find("lies where bodies meet: group 1 answers while it is active, not group 2") !=
                     std::string::npos
                 ? 1
                 : 0;
  EXPECT_EQ(notes, 1);
}

// A block that comes in stage 2 on one that has settled: blank before; displacement and strain of the place
// count from then.
TEST(PointReport, CountsFromWhereTheGroupIsPlaced) {
  DeckWriter deck(1);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 2; ++i) deck.node(1 + i + 2 * j, i, j);
  deck.material(1, 1, {kE, 0.0}, 10.0);
  deck.group(1, 1, 2, 1);
  deck.group(2, 1, 2, 1);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.element(2, 2, {3, 4, 6, 5});
  for (int n = 1; n <= 6; ++n) deck.fix(n, 1, n <= 2 ? 1 : 0);
  deck.stage().pressure(1, 3, 50.0, 50.0);
  scenes::StageCards& second = deck.stage(2);
  second.births = {2};
  second.pressure(2, 3, 20.0, 20.0);
  BuildOptions options = at({{0.5, 1.5}, {0.5, 0.5}, {0.5, 1.0}});
  options.points[2].group = 2;
  const PointRun r = run(build(deck.text(), options));
  const std::vector<PointRow>& upper = r.reports->points(0);
  ASSERT_EQ(upper.size(), 3u);
  EXPECT_TRUE(std::isnan(upper[0].stress[1]) && std::isnan(upper[0].displacement[1]));
  EXPECT_EQ(upper[2].stage, 2);
  EXPECT_NEAR(upper[2].stress[1], 20.0, 1e-9);
  EXPECT_NEAR(upper[2].strain[1], 20.0 / kE, 1e-12);
  EXPECT_NEAR(r.last(1).stress[1], 70.0, 1e-9);
  EXPECT_NEAR(r.last(1).strain[1], 70.0 / kE, 1e-12);
  EXPECT_NEAR(r.last(1).displacement[1], -35.0 / kE, 1e-12);
  // The seam: it had gone down by 50 / E before.
  EXPECT_NEAR(r.last(2).displacement[1], -20.0 / kE, 1e-12);
}

}  // namespace
}  // namespace sage
