// An element that the program does not know, with a third unknown at its nodes, goes through everything that
// displacements do: cards, equations, convergence, sums, outputs, restart, refinement, errors.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sage/analysis/run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/conformance/element_cases.hpp"
#include "sage/core/solver_extensions.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/dof_map.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/install/consumer/diffusion.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/csv_column.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

constexpr int kElement = 1041, kLaw = 92;

Catalogue with_diffusion(bool balanced = false) {
  Catalogue catalogue = app::full_catalogue();
  ElementEntry entry = own::diffusion_quad();
  entry.unknowns[1].field.balanced = balanced;
  catalogue.elements.add(kElement, entry);
  catalogue.materials.add(kLaw, own::swelling_soil());
  return catalogue;
}

// A column of width 1 and height 5, held at both sides along x and at its base along y, of elements one above
// the other.
struct Column {
  static constexpr int elements = 5;
  double E = 1000.0, nu = 0.25, k0 = 2.0, growth = 0.0, swelling = 0.0, storage = 0.0;
  int increments = 1;
  std::vector<std::string> before{}, fixities{},
      loads{};           // cards: supports of all stages, then of the first one
  std::string second{};  // another stage, whole

  static std::string level(int node, double c) {
    return fmt::format("{:5}{:5}{:5}{:5}{:5}{:10.4f}{:10}concentration", node, node + 1, 1, 1, 0, c, "");
  }
  static std::string held(int node) {
    return fmt::format("{:5}{:5}{:5}{:5}{:5}{:20}concentration", node, node + 1, 1, 1, 0, "");
  }
  static std::string inflow(int node, double q) {
    return fmt::format("{:5}{:5}{:5}{:10.4f}{:10}concentration", node, node + 1, 1, q, "");
  }
  static int row(int i) { return 2 * i + 1; }  // its left node
  static int top() { return row(elements); }
  double oedometric() const { return E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)); }

  std::string text() const {
    std::string deck = "swelling column\nm       kN      kPa\n";
    deck += fmt::format("    1    0{:5}    0    1    1{:5}{:5}    0{:5}    0\n", 2 * elements + 2, elements,
                        2 + before.size(), second.empty() ? 1 : 2);
    for (int i = 0; i <= elements; ++i)
      for (int j = 0; j < 2; ++j)
        deck += fmt::format("{:5}          {:10.4f}{:10.4f}\n", row(i) + j, double(j), double(i));
    deck += fmt::format("    1{:5}    6\n{:10.4g}{:10.4g}{:10.4g}{:10.4g}{:10.4g}{:10.4g}\n", kLaw, E, nu, k0,
                        growth, swelling, storage);
    deck += fmt::format("    1{:5}    0    1\n", kElement);
    for (int i = 0; i < elements; ++i)
      deck += fmt::format("{:5}    1{:5}{:5}{:5}{:5}\n", i + 1, row(i), row(i) + 1, row(i + 1) + 1, row(i + 1));
    deck += fmt::format("    1{:5}    1    1    0\n    1    2    1    0    1\n", 2 * elements + 2);
    for (const std::string& card : before) deck += card + "\n";
    deck += fmt::format("wetting\n{:5}    0    0    1{:5}{:5}\n", increments, fixities.size(), loads.size());
    for (const std::string& card : fixities) deck += card + "\n";
    for (const std::string& card : loads) deck += card + "\n";
    return deck + second + "END\n";
  }
};

Column between_levels() {
  Column column;
  column.before = {Column::held(1)};
  column.fixities = {Column::level(Column::top(), 1.0)};
  return column;
}

app::RunRequest request_of(const Column& column, const std::string& name) {
  const std::filesystem::path folder = test::scratch_folder("outside_unknown") / name;
  std::filesystem::create_directories(folder);
  app::RunRequest request;
  request.deck = (folder / "deck.dat").string();
  std::ofstream(request.deck) << column.text();
  request.output.folder = folder;
  request.stem = "deck";
  request.output.nodes = true;
  request.quiet = true;
  return request;
}

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Of the last output increment, by node.
std::vector<double> last(const app::RunRequest& request, const std::string& name) {
  std::vector<double> all = test::csv_column(read(request.output.folder / "deck.nodes.csv"), name);
  const std::size_t nodes = 2 * Column::elements + 2;
  return all.size() < nodes ? all
                            : std::vector<double>(all.end() - static_cast<std::ptrdiff_t>(nodes), all.end());
}

// k = k0 (1 + a c): the flux is the same at every height, so that c + a c^2 / 2 grows in proportion to it
// (Kirchhoff 1894); linear elements meet that at their nodes.
double kirchhoff(double a, double share) {
  return (std::sqrt(1.0 + a * (2.0 + a) * share) - 1.0) / a;
}

TEST(OutsideUnknown, LevelsFluxAndSwellingAreExactAtTheNodes) {
  Column column = between_levels();
  column.growth = 0.8;
  column.swelling = 90.0;
  column.increments = 4;
  const app::RunRequest request = request_of(column, "levels");
  ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk);
  const std::vector<double> c = last(request, "concentration"), uy = last(request, "uy"),
                            flux = last(request, "concentration_reaction");
  ASSERT_EQ(c.size(), 12u);
  double settled = 0.0;
  for (int i = 0; i <= Column::elements; ++i) {
    const auto n = static_cast<std::size_t>(Column::row(i) - 1);
    EXPECT_NEAR(c[n], kirchhoff(0.8, i / 5.0), 1e-9) << i;
    EXPECT_NEAR(c[n + 1], c[n], 1e-12);
    // Free of vertical stress: M eps_y = beta times the mean c of the element.
    if (i > 0)
      settled += 90.0 * 0.5 * (kirchhoff(0.8, (i - 1) / 5.0) + kirchhoff(0.8, i / 5.0)) / column.oedometric();
    EXPECT_NEAR(uy[n], settled, 1e-9) << i;
  }
  const double whole = 2.0 * (1.0 + 0.8 / 2.0) / 5.0;  // k0 (1 + a/2) / H over a width of 1
  EXPECT_NEAR(flux[10] + flux[11], whole, 1e-8);
  EXPECT_NEAR(flux[0] + flux[1], -whole, 1e-8);
  EXPECT_TRUE(std::isnan(flux[4])) << "nothing holds it there";
  const std::string listing = read(request.output.folder / "deck.lst");
  EXPECT_NE(listing.find("(concentration;"), std::string::npos) << "its sums, beside those of the forces";
}

TEST(OutsideUnknown, LoadsAreFluxes) {
  Column column;
  column.before = {Column::held(1)};
  column.loads = {Column::inflow(Column::top(), 3.0)};
  const app::RunRequest request = request_of(column, "loads");
  ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk);
  const std::vector<double> c = last(request, "concentration"), load = last(request, "concentration_flux");
  for (int i = 0; i <= Column::elements; ++i)
    EXPECT_NEAR(c[Column::row(i) - 1], 6.0 / 2.0 * i, 1e-10) << "q y / k";
  EXPECT_EQ(load[10], 3.0);
  EXPECT_EQ(load[0], 0.0);
}

// Backward Euler with an inflow that grows in proportion to time: S V (c_n - c_n-1) / dt = q n / N.
TEST(OutsideUnknown, RatesSeeTheTimeOfTheStep) {
  Column column;
  column.storage = 0.5;
  column.increments = 8;
  for (int i = 0; i <= Column::elements; ++i)
    column.loads.push_back(Column::inflow(Column::row(i), i == 0 || i == Column::elements ? 0.5 : 1.0));
  const app::RunRequest request = request_of(column, "rates");
  ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk);
  const double N = 8.0, q = 10.0, SV = 0.5 * 5.0;  // 10 of inflow in all
  for (double c : last(request, "concentration")) EXPECT_NEAR(c, q / SV / N * (N + 1) / 2.0, 1e-9);
}

// Forces of 1e9 beside fluxes of 1e-9: each field converges by its own size.
TEST(OutsideUnknown, FieldsConvergeEachByItsOwnSize) {
  Column column = between_levels();
  column.E = 1e9;
  column.k0 = 1e-9;
  column.growth = 0.8;
  column.swelling = 9e7;
  const app::RunRequest request = request_of(column, "sizes");
  const app::RunOutcome outcome = app::run_deck(request, with_diffusion());
  ASSERT_EQ(outcome.exit_code, app::kOk);
  const std::vector<double> c = last(request, "concentration");
  for (int i = 0; i <= Column::elements; ++i) EXPECT_NEAR(c[Column::row(i) - 1], kirchhoff(0.8, i / 5.0), 1e-9);
}

TEST(OutsideUnknown, WhatComesInGoesOutWhereTheFieldSaysSo) {
  Column column = between_levels();
  EXPECT_LT(app::run_deck(request_of(column, "balance"), with_diffusion(true)).record.out_of_balance, 1e-10);
  column.storage = 1.0;
  EXPECT_GT(app::run_deck(request_of(column, "stored"), with_diffusion(true)).record.out_of_balance, 0.01);
  EXPECT_LT(app::run_deck(request_of(column, "stored2"), with_diffusion(false)).record.out_of_balance, 1e-10);
}

TEST(OutsideUnknown, ALevelThatNothingDeterminesIsNamed) {
  Column column;
  column.loads = {Column::inflow(Column::top(), 1.0)};
  const app::RunRequest request = request_of(column, "no_level");
  EXPECT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kNotConverged);
  const std::string listing = read(request.output.folder / "deck.lst");
  EXPECT_NE(listing.find(", concentration ("), std::string::npos) << listing;
  EXPECT_NE(listing.find("nothing determines the level of the concentration"), std::string::npos) << listing;
}

TEST(OutsideUnknown, IsInEveryOutput) {
  Column column = between_levels();
  app::RunRequest request = request_of(column, "outputs");
  request.output.vtu = true;
  request.output.result = true;
  request.output.pictures = {"concentration"};
  ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk);
  const std::filesystem::path folder = request.output.folder;
  EXPECT_NE(read(folder / "deck_0001.vtu").find("Name=\"concentration\""), std::string::npos);
  EXPECT_NE(read(folder / "deck_stage1_concentration.svg").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(read(folder / "deck.h5").find("concentration_reaction"), std::string::npos);
  EXPECT_NE(read(folder / "deck.lst").find("concentration"), std::string::npos);
}

// Nodes of quad4 alone have no concentration: blank, and a card that holds it there is an error.
TEST(OutsideUnknown, NodesOfOtherElementsLackIt) {
  Column column = between_levels();
  std::string text = column.text();
  const auto replace = [&](const std::string& a, const std::string& b) {
    const std::size_t at = text.find(a);
    ASSERT_NE(at, std::string::npos) << a;
    text.replace(at, a.size(), b);
  };
  replace("    1    1    5    3", "    2    2    5    3");  // counts: materials, groups; see Column::text
  replace(fmt::format("    1{:5}    0    1\n", kElement),
          fmt::format("    1{:5}    0    1\n    2    1    2    2\n", kElement));
  replace("\n    1" + fmt::format("{:5}    6\n", kLaw),
          "\n    2    1    2\n     1000.      0.25\n    1" + fmt::format("{:5}    6\n", kLaw));
  replace("\n    1    1    1    2    4    3\n", "\n    1    2    1    2    4    3\n");
  const auto outcome_of = [&](const std::string& name, const std::string& deck) {
    app::RunRequest request = request_of(column, name);
    std::ofstream(request.deck) << deck;
    return std::pair(app::run_deck(request, with_diffusion()).exit_code, request);
  };
  try {
    outcome_of("lacking", text);
    FAIL() << "node 1 has no concentration";
  } catch (const InputError& errors) {
    EXPECT_NE(std::string(errors.what()).find("no element there solves for it"), std::string::npos)
        << errors.what();
  }
  replace(Column::held(1), Column::held(3));
  const auto [code, request] = outcome_of("mixed", text);
  ASSERT_EQ(code, app::kOk);
  const std::vector<double> c = last(request, "concentration");
  EXPECT_TRUE(std::isnan(c[0]));
  EXPECT_NEAR(c[6], 0.5, 1e-12) << "half way between rows 1 and 5";
}

TEST(OutsideUnknown, CardsOfUnknownsAreChecked) {
  Column column = between_levels();
  const auto error_of = [&](const std::string& card) {
    column.fixities = {card};
    try {
      app::run_deck(request_of(column, "cards"), with_diffusion());
    } catch (const InputError& errors) {
      return std::string(errors.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(
      error_of("   11   12    1    1    0       1.0          salt").find("it has: displacement, concentration"),
      std::string::npos);
  EXPECT_NE(error_of("   11   12    1    1    1       1.0          concentration").find("must be blank"),
            std::string::npos);
  EXPECT_NE(error_of("   11   12    1    0    0       1.0          concentration")
                .find("a value is given but the code is not 1"),
            std::string::npos);
}

TEST(OutsideUnknown, RefinedEdgesInheritLevels) {
  Column column = between_levels();
  app::RunRequest request = request_of(column, "refined");
  request.input.build.refine = 1;
  ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk);
  const std::string csv = read(request.output.folder / "deck.nodes.csv");
  const std::vector<double> c = test::csv_column(csv, "concentration"), y = test::csv_column(csv, "y");
  ASSERT_EQ(c.size(), 33u);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c[i], y[i] / 5.0, 1e-12);
}

TEST(OutsideUnknown, RestartsGoOnBitByBit) {
  Column column = between_levels();
  column.growth = 0.8;
  column.storage = 0.3;
  column.swelling = 90.0;
  column.increments = 6;
  const app::RunRequest request = request_of(column, "restart");
  const Catalogue catalogue = with_diffusion();
  const std::unique_ptr<Model> model = [&] {
    app::RunRequest only = request;
    only.max_dofs = 1;
    return std::move(app::run_deck(only, catalogue).model);
  }();
  struct Keep : Observer {
    Eigen::VectorXd u;
    void on_increment(const Model&, const StepReport&, const Solution& now) override { u = *now.u; }
  };
  const auto end_of = [&](RunSettings settings) {
    Keep keep;
    Observer* const watch[] = {&keep};
    settings.choose_solver = choose_solver;
    EXPECT_EQ(run(*model, catalogue, settings, watch).status, RunStatus::completed);
    return keep.u;
  };
  std::vector<std::string> saved;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { saved.push_back(bytes); };
  const Eigen::VectorXd straight = end_of(settings);
  ASSERT_EQ(saved.size(), 5u);
  for (const std::string& bytes : saved) {
    RunSettings resumed;
    resumed.resume_from = bytes;
    EXPECT_EQ(end_of(resumed), straight);
  }
}

// The same concentration everywhere makes fluxes of rounding alone: they must not keep a mechanical stage from its
// end.
TEST(OutsideUnknown, AnEvenLevelHasNothingToBalance) {
  for (const double level : {0.3, 0.1234, 1e4}) {
    Column column;
    column.swelling = 90.0;
    column.fixities = {Column::level(1, level), Column::level(Column::top(), level)};
    column.second =
        fmt::format("pressing\n    2    0    0    1    0    0    1\n{:5}    3          {:10.1f}{:10.1f}\n",
                    Column::elements, 10.0, 10.0);
    const app::RunRequest request = request_of(column, "even");
    ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk) << level;
    for (double c : last(request, "concentration")) EXPECT_NEAR(c, level, 1e-12 * level);
    const double strain = (90.0 * level - 10.0) / column.oedometric();
    EXPECT_NEAR(last(request, "uy").back(), Column::elements * strain, 1e-9 * level);
  }
}

TEST(OutsideUnknown, CardsThatContradictOrDoNothingAreNamed) {
  const auto warnings_of = [](const Column& column) {
    const app::RunOutcome run = app::run_deck(request_of(column, "warned"), with_diffusion());
    std::string all;
    for (const Diagnostic& d : run.model->diagnostics.list()) all += d.message + "\n";
    return all;
  };
  Column twice = between_levels();
  twice.fixities.push_back(Column::level(Column::top(), 2.0));
  EXPECT_NE(warnings_of(twice).find("node 11 is given two values in concentration: 1 by line"),
            std::string::npos);
  EXPECT_EQ(warnings_of(between_levels()).find("null step"), std::string::npos);
  Column point = between_levels();
  point.loads = {Column::inflow(5, 1.0)};
  EXPECT_EQ(warnings_of(point).find("does nothing"), std::string::npos);
}

Model built(const Column& column, const std::string& name) {
  return build_model(read_deck(request_of(column, name).deck), with_diffusion());
}

TEST(OutsideUnknown, ACardThatChangesNothingIsNoted) {
  Column column = between_levels();
  std::string idle = Column::held(5);
  idle[19] = '0';  // the code
  column.before.push_back(idle);
  const Model model = built(column, "idle");
  std::string notes;
  for (const Diagnostic& d : model.diagnostics.list()) notes += d.message + "\n";
  EXPECT_NE(notes.find("this fixity card changes nothing: its code is 0 or blank"), std::string::npos) << notes;
}

// The lowest element comes in stage 2: before that, nothing solves for the concentration of its base.
TEST(OutsideUnknown, CardsOnNodesWithoutAnActiveElementDoNothing) {
  Column column;
  column.before = {Column::held(3), "    3    4    1    0    1"};
  column.fixities = {Column::level(1, 1.0)};
  column.loads = {Column::inflow(2, 3.0)};
  column.loads[0].replace(5, 5, "    2");
  column.second = "birth\n    1    0    0    1    0    0    0    1\n    2\n";
  std::string text = column.text();
  const auto replace = [&](const std::string& a, const std::string& b) {
    const std::size_t at = text.find(a);
    ASSERT_NE(at, std::string::npos) << a;
    text.replace(at, a.size(), b);
  };
  replace("    0    1    1    5    4", "    0    1    2    5    4");  // groups
  const std::string group = fmt::format("    1{:5}    0    1\n", kElement);
  replace(group, group + fmt::format("    2{:5}    0    1\n", kElement));
  replace("\n    1    1    1    2    4    3\n", "\n    1    2    1    2    4    3\n");
  const Model model = build_model(read_deck_text(text, "deck", load_layout("sage1")), with_diffusion());
  std::string warnings;
  for (const Diagnostic& d : model.diagnostics.list()) warnings += d.message + "\n";
  const std::string why = ": no element that is active then solves for the concentration there";
  EXPECT_NE(warnings.find("the concentration of node 1 (and 1 more) of stage 1 does nothing" + why),
            std::string::npos)
      << warnings;
  EXPECT_NE(warnings.find("the flux of node 2 of stage 1 does nothing" + why), std::string::npos) << warnings;
}

// k does not depend on c, so that c is linear in y, which fewer elements have as well as five.
TEST(OutsideUnknown, CoarsenedMeshesKeepLevels) {
  Column column = between_levels();
  app::RunRequest request = request_of(column, "coarsened");
  request.input.build.coarsen = true;
  ASSERT_EQ(app::run_deck(request, with_diffusion()).exit_code, app::kOk);
  const std::string csv = read(request.output.folder / "deck.nodes.csv");
  const std::vector<double> c = test::csv_column(csv, "concentration"), y = test::csv_column(csv, "y");
  EXPECT_LT(c.size(), 12u);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c[i], y[i] / 5.0, 1e-12);
}

// A name that results use for something else has no column of its own; the run is none the worse.
TEST(OutsideUnknown, ANameThatIsTakenCostsItsColumnAlone) {
  Catalogue catalogue = with_diffusion();
  ElementEntry entry = own::diffusion_quad();
  entry.name = "named_badly";
  entry.unknowns[1].field.name = "stage";
  catalogue.elements.add(kElement + 1, entry);
  Column column = between_levels();
  const app::RunRequest request = request_of(column, "taken");
  std::string text = column.text();
  for (std::size_t at = text.find("concentration"); at != std::string::npos;
       at = text.find("concentration", at))
    text.replace(at, 13, "stage");
  const std::string group = fmt::format("    1{:5}    0    1\n", kElement);
  text.replace(text.find(group), group.size(), fmt::format("    1{:5}    0    1\n", kElement + 1));
  std::ofstream(request.deck) << text;
  ASSERT_EQ(app::run_deck(request, catalogue).exit_code, app::kOk);
  EXPECT_EQ(last(request, "stage").back(), 1.0) << "the number of the stage";
  EXPECT_NEAR(last(request, "stage_reaction").back(), 0.2, 1e-12) << "k0 / H over half the width";
}

// A sage1 deck that the program writes of the model gives the same answer.
TEST(OutsideUnknown, DecksThatAreWrittenKeepIt) {
  Column column = between_levels();
  column.swelling = 90.0;
  column.loads = {Column::inflow(Column::row(2), 0.7)};
  const Catalogue catalogue = with_diffusion();
  app::RunRequest request = request_of(column, "written");
  const app::RunOutcome first = app::run_deck(request, catalogue);
  ASSERT_EQ(first.exit_code, app::kOk);
  const std::vector<double> c = last(request, "concentration"), uy = last(request, "uy");
  Diagnostics diagnostics;
  std::ofstream(request.deck) << sage1_text(*first.model, diagnostics);
  ASSERT_EQ(app::run_deck(request, catalogue).exit_code, app::kOk);
  EXPECT_EQ(last(request, "concentration"), c);
  EXPECT_EQ(last(request, "uy"), uy);
}

// A solver that asks where its equations stand, in front of another one.
class Surveyor final : public LinearSolver, public PlacedSolver {
 public:
  Surveyor(std::unique_ptr<LinearSolver> inner, std::vector<EquationPlace>& seen)
      : inner_(std::move(inner)), seen_(&seen) {}
  const SolverTraits& traits() const override { return traits_; }
  void set_places(std::span<const EquationPlace> places) override {
    seen_->assign(places.begin(), places.end());
  }
  void analyse(int equations, ElementEquations elements) override {
    inner_->analyse(equations, std::move(elements));
  }
  void clear() override { inner_->clear(); }
  void add(int element, const double* K) override { inner_->add(element, K); }
  void factorise() override { inner_->factorise(); }
  SolveStatus solve(std::span<const double> b, std::span<double> x) const override {
    return inner_->solve(b, x);
  }

 private:
  SolverTraits traits_{.name = "surveyor", .symmetric = false};
  std::unique_ptr<LinearSolver> inner_;
  std::vector<EquationPlace>* seen_;
};

TEST(OutsideUnknown, SolversSeePlaceAndFieldOfTheEquations) {
  Catalogue catalogue = with_diffusion();
  std::vector<EquationPlace> seen;
  const SolverEntry plain = *catalogue.solvers.find(catalogue.solvers.code_of("skyline_lu"));
  catalogue.solvers.add(95, {"surveyor", "asks where equations stand", false,
                             [&seen, plain] { return std::make_unique<Surveyor>(plain.make(), seen); }});
  app::RunRequest request = request_of(between_levels(), "places");
  request.solver = "surveyor";
  ASSERT_EQ(app::run_deck(request, catalogue).exit_code, app::kOk);
  // Heights 1 to 5 have u_y at both nodes, 1 to 4 their concentration.
  ASSERT_EQ(seen.size(), 18u);
  for (std::size_t eq = 0; eq < 10; ++eq) {
    EXPECT_EQ(seen[eq].field, 0);
    EXPECT_EQ(seen[eq].component, 1);
    EXPECT_EQ(seen[eq].x, Vector2(static_cast<double>(eq % 2), 1.0 + static_cast<double>(eq / 2)));
  }
  for (std::size_t eq = 10; eq < 18; ++eq) {
    EXPECT_EQ(seen[eq].field, 1);
    EXPECT_EQ(seen[eq].node, static_cast<int>(eq) - 8);
  }
}

// A field that corners alone have, as a pore pressure beside a quadratic displacement.
TEST(DofMap, NumbersFieldsOfSomeNodes) {
  Catalogue catalogue = app::full_catalogue();
  ElementEntry entry = *catalogue.elements.find(2);
  entry.name = "quad8 with a pressure at its corners";
  entry.unknowns = {{displacement_field()}, {{.name = "pore_pressure"}, {0, 1, 2, 3}}};
  catalogue.elements.add(kElement, entry);
  scenes::DeckWriter deck(1);
  const scenes::Block block{2, 1, scenes::Cell::quad8, 1, 1, scenes::rectangle(0.0, 2.0, 0.0, 1.0)};
  block.write_nodes(deck);
  deck.material(1, 1, {1e4, 0.3});
  deck.group(1, kElement, 0, 1);
  block.write_elements(deck, 1);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  deck.stage();
  const Model model = build_model(read_deck_text(deck.text(), "deck", load_layout("sage1")), catalogue);
  const DofMap map(model);
  const int nodes = model.mesh.nodes();
  EXPECT_EQ(map.fields(), 2);
  EXPECT_EQ(map.dofs(), 2 * nodes + 6) << "six corners";
  for (int dof = 0; dof < map.dofs(); ++dof) {
    const auto [node, field, component] = map.at(dof);
    EXPECT_EQ(map.of(node, field, component), dof);
  }
  std::vector<int> dofs;
  map.list(model.groups[0], 1, dofs);
  ASSERT_EQ(dofs.size(), 20u);
  for (std::size_t i = 0; i < 8; ++i) {
    const int node = model.groups[0].nodes_of(1)[i];
    EXPECT_EQ(dofs[2 * i], DofMap::displacement(node));
    EXPECT_EQ(map.of(node, 1), i < 4 ? dofs[16 + i] : -1);
  }
}

// K = df/du by central differences; f is of the second degree in the unknowns, so that they are exact but for
// rounding.
TEST(OutsideUnknown, StiffnessIsTheDerivativeOfTheForce) {
  const Catalogue catalogue = with_diffusion();
  const std::vector<double> values{1000.0, 0.25, 2.0, 0.8, 90.0, 0.3};
  const LawPtr law = catalogue.materials.find(kLaw)->make(values, {});
  const LawRef ref = std::get<std::unique_ptr<SolidLaw>>(law).get();
  for (const conformance::ElementCase& c : conformance::element_cases(catalogue, {kElement})) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    conformance::ElementRun run(*element, conformance::sample_shape(*c.entry), ref);
    run.u0 = Eigen::VectorXd::LinSpaced(12, 0.0, 1.1);
    run.dt = 0.2;
    const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(12, -0.3, 0.4);
    EXPECT_LT(conformance::tangent_error(run, u), 1e-10);
  }
}

}  // namespace
}  // namespace sage
