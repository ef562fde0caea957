// Steady seepage, whole models, against closed forms and against itself in other guises.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/observer.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/model_input.hpp"
#include "tests/studies/scenes/seepage.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

constexpr double kPi = std::numbers::pi;
Block cells(int columns, int rows, Cell cell) {
  Block block;
  block.columns = columns;
  block.rows = rows;
  block.cell = cell;
  return block;
}

// A block of flow elements of one material, with one stage.
struct Flow {
  Block block;
  DeckWriter deck;
  explicit Flow(const Block& b, int geometry = 1, const std::vector<double>& permeability = {1.0})
      : block(b), deck(geometry) {
    block.write_nodes(deck);
    deck.material(1, kDarcyLaw, permeability);
    deck.group(1, flow_element(block.cell), 0, 1);
    block.write_elements(deck, 1);
    deck.stage();
  }
  void hold(const std::vector<int>& nodes, double head) {
    for (const int n : nodes) deck.stages.back().fixities.push_back(head_card(n, head));
  }
};

// What flows through the model's discharge reports at the end of the last increment.
class Discharges final : public Observer {
 public:
  void on_increment(const Model& model, const StepReport&, const Solution& solution) override {
    through.clear();
    for (const Report& report : model.reports) {
      const FlowLine line = flow_line(model, solution.activity->group, report.nodes);
      EXPECT_EQ(line.fault, "");
      through.push_back(
          flow_through(model, line, report.nodes, solution.groups(), *solution.activity, *solution.u));
    }
    u = *solution.u;
    internal = *solution.internal;
    external = *solution.external;
  }
  void on_stage_end(const Model&, int, const EquilibriumAudit& audit, const Solution&) override {
    balance = audit.out_of_balance;
    sums = audit.fields.at(0);
  }
  std::vector<FlowThrough> through;
  Eigen::VectorXd u, internal, external;
  double balance = 1.0;
  FieldAudit sums;
};

struct Seepage {
  std::unique_ptr<Model> model;
  DofMap map;
  RunResult result;
  Discharges seen;
  int index(int number) const {
    for (int node = 0; node < model->mesh.nodes(); ++node)
      if (model->mesh.number[node] == number) return node;
    throw std::logic_error("no such node");
  }
  double head(int number) const { return seen.u[map.of(index(number), 1)]; }
  // What the node takes in beyond the deck's own inflow.
  double inflow(int number) const {
    const int dof = map.of(index(number), 1);
    return seen.internal[dof] - seen.external[dof];
  }
  double discharge(std::size_t line = 0) const { return seen.through.at(line).discharge; }
};

Seepage seep(const std::string& deck, const BuildOptions& options = {}, double balance = 1e-10) {
  Seepage run;
  static const Workbench bench = app::make_workbench();
  run.model = std::make_unique<Model>(bench.build(deck, options));
  run.map = DofMap(*run.model);
  Observer* const observers[] = {&run.seen};
  run.result = bench.run(*run.model, observers);
  EXPECT_EQ(run.result.status, RunStatus::completed) << run.result.reason;
  EXPECT_LT(run.seen.balance, balance) << "what comes in goes out";
  return run;
}

// Heads of two runs of the same node numbers.
double largest_difference(const Seepage& a, const Seepage& b) {
  const int n = 2 * a.model->mesh.nodes();
  return (a.seen.u.tail(a.seen.u.size() - n) - b.seen.u.tail(b.seen.u.size() - n)).cwiseAbs().maxCoeff();
}

std::string name_of(const testing::TestParamInfo<Cell>& info) {
  static const std::map<Cell, std::string> names{{Cell::quad4, "Quad4"},
                                                 {Cell::quad8, "Quad8"},
                                                 {Cell::quad9, "Quad9"},
                                                 {Cell::tri3, "Tri3"},
                                                 {Cell::tri6, "Tri6"}};
  return names.at(info.param);
}
class EveryShape : public testing::TestWithParam<Cell> {};
INSTANTIATE_TEST_SUITE_P(Seepage, EveryShape,
                         testing::Values(Cell::quad4, Cell::quad8, Cell::quad9, Cell::tri3, Cell::tri6),
                         name_of);

// A field of one slope is in every element's space, also where its sides lean: v = k i exactly, whatever the
// direction of the permeability.
TEST_P(EveryShape, AnEvenSlopeIsExact) {
  const auto leaning = [](double s, double t) {
    return Vector2(3.0 * s + 0.4 * t + 0.2 * s * t, 2.0 * t + 0.3 * s);
  };
  Block block = cells(3, 2, GetParam());
  block.place = leaning;
  block.straight = true;
  Flow flow(block, 1, {3.0, 0.5, 30.0});
  const Vector2 slope(0.7, -0.2);
  const auto head = [&](const Vector2& x) { return 5.0 + slope.dot(x); };
  for (const auto& side : {block.left(), block.right(), block.bottom(), block.top()})
    for (const int n : side) {
      const int i = (n - 1) % block.across(), j = (n - 1) / block.across();
      flow.hold({n}, head(block.at(i, j)));
    }
  flow.deck.reports.push_back(discharge_card(block.right()));
  const Seepage run = seep(flow.deck.text());
  for (int node = 0; node < run.model->mesh.nodes(); ++node)
    EXPECT_NEAR(run.seen.u[run.map.of(node, 1)], head(run.model->mesh.x.col(node)),
                1e-6);  // ten columns of a card
  const Vector2 along = leaning(1.0, 1.0) - leaning(1.0, 0.0), out(along.y(), -along.x());
  EXPECT_NEAR(run.seen.through[0].gradient, -slope.dot(out.normalized()), 1e-5);
}

// Two layers in a row: what one lets through, the other does.
TEST(Seepage, LayersInARow) {
  Flow flow({4, 2, Cell::quad4, 1, 1, rectangle(0.0, 4.0, 0.0, 1.5)});
  flow.deck.material(2, kDarcyLaw, {0.1});
  flow.deck.group(2, 41, 0, 2);
  for (std::string& element : flow.deck.elements) {
    const int number = std::stoi(element.substr(0, 5));
    if ((number - 1) % 4 >= 2) element.replace(5, 5, "    2");
  }
  flow.hold(flow.block.left(), 7.0);
  flow.hold(flow.block.right(), 3.0);
  std::vector<int> middle, first;
  for (int j = 0; j <= 2; ++j) {
    middle.push_back(flow.block.node(2, j));
    first.push_back(flow.block.node(1, j));
  }
  for (const auto& line : {first, middle, flow.block.right()})
    flow.deck.reports.push_back(discharge_card(line));
  const Seepage run = seep(flow.deck.text());
  const double q = 4.0 / (2.0 / 1.0 + 2.0 / 0.1), expected = 1.5 * q;
  for (std::size_t line = 0; line < 3; ++line) EXPECT_NEAR(run.discharge(line), expected, 1e-13);
  EXPECT_NEAR(run.head(middle[1]), 7.0 - 2.0 * q, 1e-13);
  EXPECT_NEAR(run.seen.through[2].gradient, q / 0.1, 1e-12);
}

// Radial flow to a well: Q = 2 pi k D dh / ln(r2 / r1).
double radial_error(Cell cell, int n, double* head_error = nullptr) {
  const double D = 2.0, r1 = 0.1, r2 = 10.0;
  Block block = cells(n, 1, cell);
  block.place = [=](double s, double t) { return Vector2(r1 * std::pow(r2 / r1, s), D * t); };
  block.straight = true;
  Flow flow(block, 2);
  flow.hold(block.left(), 0.0);
  flow.hold(block.right(), 1.0);
  std::vector<int> line = block.left();
  std::reverse(line.begin(), line.end());  // the soil on its left
  flow.deck.reports.push_back(discharge_card(line));
  const Seepage run = seep(flow.deck.text());
  const int order = block.order();
  if (head_error != nullptr) *head_error = std::abs(run.head(block.node(order * n / 2, 0)) - 0.5);  // r = 1
  return std::abs(run.discharge() / 2.7287527077 - 1.0);
}

TEST(Seepage, ConfinedWell) {
  struct Case {
    Cell cell;
    int n;
    double error, rate;
  };
  // The rate of the discharge is twice the degree (an energy).
  for (const Case& c : {Case{Cell::quad4, 48, 1e-3, 2.0},
                        {Cell::tri3, 48, 1e-3, 2.0},
                        {Cell::quad8, 24, 1e-4, 4.0},
                        {Cell::quad9, 24, 1e-4, 4.0},
                        {Cell::tri6, 24, 1e-4, 4.0}}) {
    double head = 1.0;
    const double coarse = radial_error(c.cell, c.n / 2), fine = radial_error(c.cell, c.n, &head);
    EXPECT_LT(fine, c.error) << flow_element(c.cell);
    EXPECT_LT(head, 1e-3) << flow_element(c.cell);
    EXPECT_NEAR(std::log2(coarse / fine), c.rate, 0.3) << flow_element(c.cell);
  }
}

// Between spheres of radius 1 and 5: Q = 4 pi k dh / (1 - 1/5), half of it in the model.
TEST(Seepage, Sphere) {
  Block block = cells(20, 12, Cell::quad8);
  block.place = [](double s, double t) {
    const double R = std::pow(5.0, s), a = 0.5 * kPi * t;
    return Vector2(R * std::cos(a), R * std::sin(a));
  };
  Flow flow(block, 2);
  flow.hold(block.left(), 0.0);
  flow.hold(block.right(), 1.0);
  std::vector<int> line = block.left();
  std::reverse(line.begin(), line.end());
  flow.deck.reports.push_back(discharge_card(line));
  EXPECT_NEAR(seep(flow.deck.text()).discharge() / (0.5 * 15.7079632679), 1.0, 1e-4);
}

TEST(Seepage, SheetPileFloorAndCutOff) {
  // q / (k h) = K'(m) / 2 K(m).
  const std::pair<Barrier, double> cases[] = {{{0.0, 0.25}, .7346090158}, {{0.0, 0.5}, 0.5},
                                              {{0.0, 0.75}, .3403170865}, {{0.5, 0.0}, .5331795566},
                                              {{1.0, 0.0}, .3469517731},  {{0.5, 0.5}, .4063602699},
                                              {{1.0, 0.5}, .2983698755},  {{0.0, 0.1}, 1.0298065910}};
  for (const auto& [barrier, discharge] : cases) {
    // The tip makes the discharge converge with the size of its elements, which the cubes of the lattice make
    // small.
    const double q = seep(barrier.deck().text()).discharge();
    EXPECT_NEAR(q / discharge, 1.0, 1e-3) << barrier.b << " " << barrier.s;
  }
}

// Heads on the downstream face of the pile, and the gradient of the exit beside it.
TEST(Seepage, PressureAndExitGradientAtThePile) {
  const Barrier pile{0.0, 0.5, Cell::quad8, 8, {0.4, 0.25, 0.1}};
  const Block block = pile.block();
  const Seepage run = seep(pile.deck().text());
  const std::map<double, double> heads{{0.1, .060408441}, {0.25, .158443550}, {0.4, .285883831}};
  int found = 0;
  for (int j = 0; j < block.up(); ++j)
    for (const auto& [depth, head] : heads)
      if (std::abs(block.at(0, j).y() + depth) < 1e-9) {
        ++found;
        EXPECT_NEAR(run.head(block.node(0, j)), head, 1e-3) << depth;
      }
  EXPECT_EQ(found, 3);
  // Largest at the pile: i s / h = .299535.
  EXPECT_NEAR(run.seen.through[0].gradient * 0.5 / .299535059, 1.0, 3e-3);
}

// Stretched along x by sqrt(k1 / k2) soil that lets k1 through along x is isotropic soil of sqrt(k1 k2).
TEST_P(EveryShape, StretchedAnisotropicSoilIsIsotropic) {
  const auto deck = [&](double stretch, const std::vector<double>& k) {
    Block block = cells(8, 4, GetParam());
    block.place = [=](double s, double t) {
      return Vector2(stretch * (4.0 * s + 0.25 * t), 3.0 * t + 0.5 * s * t);
    };
    block.straight = true;
    Flow flow(block, 1, k);
    std::vector<int> inflow = block.top();
    inflow.resize(block.order() * 2 + 1);
    flow.hold(inflow, 4.0);
    flow.hold(block.right(), 1.0);
    flow.deck.reports.push_back(discharge_card(block.right()));
    return flow.deck.text();
  };
  const Seepage stretched = seep(deck(4.0, {16.0, 1.0})), plain = seep(deck(1.0, {4.0}));
  EXPECT_LT(largest_difference(stretched, plain), 4e-12);  // 1e-12 of the heads
  EXPECT_NEAR(stretched.discharge(), plain.discharge(), 1e-12 * plain.discharge());
}

// Turned by 90 degrees with its permeability, mirrored, in other units, numbered the other way round: the same heads.
TEST(Seepage, NothingDependsOnAxesUnitsAndNumbers) {
  const auto deck = [](const std::function<Vector2(double, double)>& place, bool turned_about, double direction,
                       double unit, int geometry = 1) {
    Block block = cells(8, 4, Cell::quad4);
    block.place = [=](double s, double t) {
      return Vector2(place(turned_about ? 1.0 - s : s, turned_about ? 1.0 - t : t) * unit);
    };
    Flow flow(block, geometry, {3.0 * unit, 0.2 * unit, direction});
    flow.hold(turned_about ? block.right() : block.left(), 5.0 * unit);
    flow.hold({turned_about ? block.bottom()[3] : block.top()[5]}, unit);
    flow.deck.stages[0].loads.push_back(inflow_card(block.node(4, 2), 0.25 * unit * unit));
    return flow.deck.text();
  };
  const auto plain = [](double s, double t) { return Vector2(4.0 * s, 2.0 * t + 0.25 * s); };
  const Seepage one = seep(deck(plain, false, 25.0, 1.0));
  const int nodes = one.model->mesh.nodes();
  const Seepage turned = seep(deck(
      [&](double s, double t) {
        const Vector2 x = plain(s, t);
        return Vector2(-x.y(), x.x());
      },
      false, 115.0, 1.0));
  EXPECT_LT(largest_difference(one, turned), 5e-12);
  const Seepage other = seep(deck(plain, true, 25.0, 1.0));
  for (int n = 1; n <= nodes; ++n) EXPECT_NEAR(one.head(n), other.head(nodes + 1 - n), 5e-12);
  const Seepage units = seep(deck(plain, false, 25.0, 1024.0));
  for (int n = 1; n <= nodes; ++n) EXPECT_NEAR(units.head(n) / 1024.0, one.head(n), 5e-12);
}

// Permeability over twelve orders side by side: the layers in a row have their closed form.  Heads of the
// permeable side differ by 1e-12, and their rounding is 1e-4 of that: so much of the water moved can't be balanced.
TEST(Seepage, PermeabilityOverTwelveOrders) {
  Flow flow({4, 1, Cell::quad4, 1, 1, rectangle(0.0, 4.0, 0.0, 1.0)});
  flow.deck.material(2, kDarcyLaw, {1e-12});
  flow.deck.group(2, 41, 0, 2);
  flow.deck.elements.back().replace(5, 5, "    2");
  flow.hold(flow.block.left(), 1.0);
  flow.hold(flow.block.right(), 0.0);
  flow.deck.reports.push_back(discharge_card(flow.block.right()));
  const Seepage run = seep(flow.deck.text(), {}, 1e-3);
  EXPECT_NEAR(run.discharge() * (3.0 + 1e12), 1.0, 1e-10);
}

// A well is an inflow at a node, rain an inflow through edges: the sums are those of the cards.
TEST(Seepage, WellsAndRainAreBalanced) {
  Flow flow({5, 4, Cell::quad8, 1, 1, rectangle(0.0, 5.0, 0.0, 4.0)}, 2, {2.0});
  flow.hold(flow.block.right(), 3.0);
  flow.deck.stages[0].loads.push_back(inflow_card(flow.block.node(4, 4), -7.0));
  for (int i = 0; i < 4; ++i) flow.deck.stages[0].pressure(flow.block.element(i, 3), 3, 0.125, 0.125);
  flow.deck.reports.push_back(discharge_card(flow.block.right()));
  const Seepage run = seep(flow.deck.text());
  const double rain = 0.125 * kPi * 16.0;
  EXPECT_NEAR(run.seen.sums.applied, rain - 7.0, 1e-10);
  EXPECT_NEAR(run.seen.sums.reactions, 7.0 - rain, 1e-10);
  EXPECT_NEAR(run.discharge(), rain - 7.0, 1e-10);
}

// A closed line around a well has what the well takes, whatever line it is.
TEST(Seepage, ClosedLinesAndLinesThatEndInside) {
  Flow flow({6, 6, Cell::quad4, 1, 1, rectangle(0.0, 6.0, 0.0, 6.0)});
  const auto n = [&](int i, int j) { return flow.block.node(i, j); };
  flow.hold(flow.block.left(), 3.0);
  flow.hold(flow.block.right(), 2.0);
  flow.deck.stages[0].loads.push_back(inflow_card(n(3, 3), 0.75));
  const std::vector<int> small{n(2, 2), n(3, 2), n(4, 2), n(4, 3), n(4, 4), n(3, 4), n(2, 4), n(2, 3), n(2, 2)};
  std::vector<int> around(small.rbegin(), small.rend());
  flow.deck.reports = {discharge_card(small), discharge_card(around)};
  const Seepage run = seep(flow.deck.text());
  EXPECT_NEAR(run.discharge(0), 0.75, 1e-12);
  EXPECT_NEAR(run.discharge(1), -0.75, 1e-12);
  BuildOptions finer;
  finer.refine = 1;
  const Seepage refined = seep(flow.deck.text(), finer);
  EXPECT_NEAR(refined.discharge(0), 0.75, 1e-12);
  EXPECT_NEAR(refined.discharge(1), -0.75, 1e-12);
  flow.deck.reports = {discharge_card({n(2, 2), n(3, 2), n(4, 2)})};
  try {
    seep(flow.deck.text());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("inside the flow"), std::string::npos) << error.what();
  }
}

// Heads are added over a stage, as displacements are; a head that stays held stays.
TEST(Seepage, StagesAddHeads) {
  Flow flow({3, 1, Cell::quad4, 1, 1, rectangle(0.0, 3.0, 0.0, 1.0)});
  flow.hold(flow.block.left(), 2.0);
  flow.hold(flow.block.right(), 5.0);
  flow.deck.stage(2);
  flow.hold(flow.block.left(), 1.5);
  flow.deck.reports.push_back(discharge_card(flow.block.right()));
  const Seepage run = seep(flow.deck.text());
  EXPECT_NEAR(run.head(flow.block.left()[0]), 3.5, 1e-13);
  EXPECT_NEAR(run.discharge(), -0.5, 1e-13);
}

// Ground whose surface lets water out and none in, fed by a well; water may leave where it stands at the surface.
Flow springs(Cell cell, int n) {
  Flow flow({2 * n, n, cell, 1, 1, rectangle(0.0, 8.0, 0.0, 4.0)});
  flow.hold(flow.block.right(), 2.0);
  flow.deck.stages[0].loads.push_back(inflow_card(1, 8.0));
  for (const int node : flow.block.top())
    if (node != flow.block.right().back()) flow.deck.stages[0].fixities.push_back(head_card(node, 0.0, 2));
  flow.deck.reports.push_back(discharge_card(flow.block.right()));
  return flow;
}

// The head stands at the surface and water leaves, or it stands lower and nothing flows.
TEST(Exits, WaterLeavesOrStandsLower) {
  for (const Cell cell : {Cell::quad4, Cell::tri3, Cell::quad8}) {
    const Flow flow = springs(cell, 8);
    const Seepage run = seep(flow.deck.text());
    int wet = 0, dry = 0;
    for (const int node : flow.block.top()) {
      if (node == flow.block.right().back()) continue;
      const double head = run.head(node), inflow = run.inflow(node);
      EXPECT_LE(head, 4.0 + 1e-6);
      if (head > 4.0 - 1e-9) {
        EXPECT_LE(inflow, 1e-6);
        ++wet;
      } else {
        EXPECT_NEAR(inflow, 0.0, 1e-10);
        ++dry;
      }
    }
    EXPECT_GT(wet, 2);
    EXPECT_GT(dry, 2);
    // What does not leave at the right leaves at the springs.
    EXPECT_LT(run.discharge(), 8.0);
    EXPECT_NEAR(run.seen.sums.reactions, -8.0, 1e-9);
  }
}

// Mid-side nodes between exits that the program makes are exits too: a finer mesh has the answer of one whose
// cards give all of them.
TEST(Exits, FinerMeshesInheritThem) {
  BuildOptions finer;
  finer.refine = 1;
  const Seepage refined = seep(springs(Cell::quad4, 4).deck.text(), finer),
                given = seep(springs(Cell::quad4, 8).deck.text());
  EXPECT_NEAR(refined.discharge(), given.discharge(), 1e-11);
}

// What is held at the start of a step follows from the heads: a restart goes on to the same bits.
TEST(Exits, RestartsToTheSameBits) {
  Flow flow = springs(Cell::quad4, 6);
  flow.deck.stage(2);
  flow.deck.stages.back().loads.push_back(inflow_card(1, -4.0));
  const Workbench bench = app::make_workbench();
  const auto end_of = [&](const RunSettings& settings) {
    return bench.run(bench.build(flow.deck.text()), settings);
  };
  std::vector<std::string> saved;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { saved.push_back(bytes); };
  const WholeRun straight = end_of(settings);
  ASSERT_TRUE(straight.completed()) << straight.failure;
  ASSERT_EQ(saved.size(), 2u);
  for (const std::string& bytes : saved) {
    RunSettings resumed;
    resumed.resume_from = bytes;
    EXPECT_EQ(end_of(resumed).last().u, straight.last().u);
  }
}

// A drain at a pressure of its own takes water as long as there is any.
TEST(Exits, DrainsTakeWaterAndGiveNone) {
  for (const double outside : {3.0, 0.5}) {
    Flow flow({8, 4, Cell::quad4, 1, 1, rectangle(0.0, 8.0, 0.0, 4.0)});
    flow.hold(flow.block.left(), outside);
    flow.hold(flow.block.right(), outside);
    const int drain = flow.block.node(4, 0);
    flow.deck.stages.back().fixities.push_back(head_card(drain, 1.0, 2));  // lets out at 1 m of water
    flow.deck.reports.push_back(discharge_card(flow.block.right()));
    const Seepage run = seep(flow.deck.text());
    if (outside > 1.0) {
      EXPECT_NEAR(run.head(drain), 1.0, 1e-12);
      EXPECT_LT(run.discharge(), -0.1);
    } else {
      EXPECT_NEAR(run.head(drain), outside, 1e-12);
      EXPECT_NEAR(run.discharge(), 0.0, 1e-12);
    }
  }
}

std::string refusal_of(const std::string& deck) {
  try {
    app::make_workbench().build(deck);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Seepage, ContradictionsAreNamed) {
  const Block block{2, 1, Cell::quad4, 1, 1, rectangle(0.0, 2.0, 0.0, 1.0)};
  Flow solid(block);
  solid.deck.materials.clear();
  solid.deck.material(1, 1, {1e4, 0.3});
  EXPECT_NE(refusal_of(solid.deck.text()).find("needs a law for the flow of water"), std::string::npos);
  Flow dry(block);
  dry.deck.groups.clear();
  dry.deck.group(1, 1, 0, 1);
  EXPECT_NE(refusal_of(dry.deck.text()).find("needs a law for solids"), std::string::npos);
  Flow sheared(block);
  sheared.hold(block.left(), 1.0);
  sheared.deck.stages[0].pressure(1, 3, 1.0, 1.0, 1.0, 1.0);
  EXPECT_NE(refusal_of(sheared.deck.text()).find("no shear"), std::string::npos);
  Flow negative(block, 1, {-1.0});
  EXPECT_NE(refusal_of(negative.deck.text()).find("permeability"), std::string::npos);
  Flow floating(block);
  floating.deck.stages[0].loads.push_back(inflow_card(1, 1.0));
  const WholeRun run = run_text(floating.deck.text());
  EXPECT_FALSE(run.completed());
  EXPECT_NE(run.failure.find("nothing determines the level of the head"), std::string::npos) << run.failure;
}

// A floor that lies on half of the ground: the gradient beside its edge grows as the root of the distance falls, so that no
// mesh has its value.  Beside a pile, at a right angle, it is .2995 of h/s (above).
TEST(ExitGradient, WithoutBoundAtTheEdgeOfAFloor) {
  for (const int finer : {1, 2}) {
    Block block = cells(4 * finer, 2 * finer, Cell::quad8);
    block.place = [](double s, double t) { return Vector2(2.0 * s, t); };
    Flow flow(block);
    std::vector<int> top = flow.block.top(), ground(top.begin() + 4 * finer, top.end());
    flow.hold(ground, 0.0);
    flow.hold(flow.block.left(), 1.0);
    std::vector<int> inlet = flow.block.left();
    std::reverse(ground.begin(), ground.end());  // the soil on the left
    std::reverse(inlet.begin(), inlet.end());
    flow.deck.reports.push_back(discharge_card(ground));
    flow.deck.reports.push_back(discharge_card(inlet));
    const Seepage run = seep(flow.deck.text());
    EXPECT_TRUE(std::isnan(run.seen.through[0].gradient)) << run.seen.through[0].gradient;
    EXPECT_TRUE(std::isfinite(run.seen.through[1].gradient));
    EXPECT_NE(run.discharge(0), 0.0);
  }
}

}  // namespace
}  // namespace sage::test
