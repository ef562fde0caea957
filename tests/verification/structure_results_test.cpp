// Forces at both ends of structures' elements, their envelope, releases, and the checks of what holds a structure.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/end_forces.hpp"
#include "sage/record/result.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/csv_column.hpp"
#include "tests/support/run_text.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::test {
namespace {

constexpr int kBar2 = 31, kBeam2 = 35, kBeam3 = 36, kPinned2 = 51, kPinned3 = 52, kAxialRelease2 = 53,
              kAxialRelease3 = 54, kShearRelease2 = 55, kShearRelease3 = 56, kHinged2 = 37, kHinged3 = 38,
              kRotationalSpring = 57;
constexpr int kAxial = 31, kPlateLaw = 35, kSection = 36, kPlasticLaw = 37, kGoodman = 21;
constexpr double kEI = 1e4, kGA = 4e5;

std::string held(int node, const std::string& unknown = "rotation") {
  return fmt::format("{:5}{:5}{:5}{:5}{:5}{:20}{}", node, 0, 0, 1, 0, "", unknown);
}

const Workbench& bench() {
  static const Workbench all = app::make_workbench();
  return all;
}

// A run whose states at the ends of stages stay.
struct Kept {
  Model model;
  Result result;
  RunResult run;

  explicit Kept(const DeckWriter& deck) : model(bench().build(deck.text())) {
    Observer* const observers[] = {&result};
    run = bench().run(model, observers);
  }
  bool completed() const { return run.status == RunStatus::completed; }
  std::vector<ElementEnd> ends(std::size_t group) const {
    return element_ends(model, result.ends().back().view(), group);
  }
};

void clamp(DeckWriter& deck, int node) {
  deck.fix(node, 1, 1);
  deck.fixities.push_back(held(node));
}

// What the build says of a deck.
std::string refusal(const DeckWriter& deck) {
  try {
    const Model model = bench().build(deck.text());
    std::string words;
    for (const Diagnostic& d : model.diagnostics.list()) words += to_string(d) + "\n";
    return words;
  } catch (const InputError& error) {
    return error.what();
  }
}

// Elements of a group in a row from node 1 to node n + 1, those of three nodes with others in the middle, along
// 0.8, 0.6; the material is number 1.
void add_row(DeckWriter& deck, int group, int element, int n, double L, int first_node = 1,
             double start = 0.0) {
  const bool middle =
      element == kBeam3 || element == kPinned3 || element == kAxialRelease3 || element == kShearRelease3;
  const auto place = [&](int node, double s) { deck.node(node, 0.8 * s, 0.6 * s); };
  deck.group(group, element, 0, 1);
  for (int i = 0; i <= n; ++i)
    if (i > 0 || first_node == 1) place(first_node + i, start + L * i / n);
  for (int i = 0; i < n; ++i) {
    std::vector<int> nodes{first_node + i, first_node + i + 1};
    if (middle) {
      nodes.push_back(500 + first_node + i);
      place(nodes.back(), start + L * (i + 0.5) / n);
    }
    deck.element(100 * group + i, group, nodes);
  }
}

DeckWriter beam_row(int element, int n, double L) {
  DeckWriter deck(1);
  deck.material(1, kSection, {1e6, kEI, kGA}, 3.0);
  add_row(deck, 1, element, n, L);
  return deck;
}

// q L^2/2 and q L at the clamp, nothing at the tip, from one element: nodes and loads along it alone make them.
TEST(EndForces, BalanceALoadAlongTheElement) {
  for (const int element : {kBeam2, kBeam3})
    for (const int n : {1, 3}) {
      DeckWriter deck = beam_row(element, n, 6.0);
      clamp(deck, 1);
      StageCards& stage = deck.stage();
      for (int i = 0; i < n; ++i) stage.pressure(100 + i, 1, 2.0, 2.0, 0.5, 0.5);
      const Kept kept(deck);
      ASSERT_TRUE(kept.completed());
      const std::vector<ElementEnd> ends = kept.ends(0);
      ASSERT_EQ(ends.size(), 2u * static_cast<std::size_t>(n));
      for (const ElementEnd& end : ends) {
        const double left = 6.0 - end.place.norm();  // to the tip
        EXPECT_NEAR(end.value[kAxialForce], -0.5 * left, 1e-10);
        EXPECT_NEAR(end.value[kShearForce], 2.0 * left, 1e-10);
        EXPECT_NEAR(end.value[kBendingMoment], 2.0 * left * left / 2.0, 1e-9);
      }
    }
}

// A single element that carries its own weight between two supports: q L/2 at both ends, no moment.
TEST(EndForces, BalanceTheWeight) {
  for (const int element : {kBeam2, kBeam3}) {
    DeckWriter deck = beam_row(element, 1, 5.0);
    deck.fix(1, 1, 1);
    deck.fix(2, 1, 1);
    deck.stage(2).gravity_y = -1.0;
    const Kept kept(deck);
    ASSERT_TRUE(kept.completed());
    const std::vector<ElementEnd> ends = kept.ends(0);
    const double across = 3.0 * 0.8 * 5.0 / 2.0;  // the weight has 0.8 of itself to the right of the line
    EXPECT_NEAR(ends[0].value[kShearForce], -across, 1e-9);
    EXPECT_NEAR(ends[1].value[kShearForce], across, 1e-9);
    for (const ElementEnd& end : ends) EXPECT_NEAR(end.value[kBendingMoment], 0.0, 1e-8);
  }
}

// A plate of 25 kN/m^3 and 0.5 m over 4 m: q L^2/8 = 25 in the middle, and a warning for those who meant 12.5 kN/m^3.  Of
// bars 2 apart each has half the weight of one for a unit of width.
TEST(EndForces, PlatesWeighByTheirThicknessAndBarsByTheirSpacing) {
  DeckWriter deck(1);
  for (int i = 0; i < 3; ++i) deck.node(i + 1, 2.0 * i, 0.0);
  deck.material(1, kPlateLaw, {3e7, 0.2, 0.5, 1.0}, 25.0);
  deck.group(1, kBeam2, 0, 1);
  for (int i = 0; i < 2; ++i) deck.element(i + 1, 1, {i + 1, i + 2});
  deck.fix(1, 1, 1);
  deck.fix(3, 0, 1);
  deck.stage().gravity_y = -1.0;
  const Kept kept(deck);
  ASSERT_TRUE(kept.completed());
  EXPECT_NEAR(kept.ends(0)[1].value[kBendingMoment], 25.0, 1e-9);
  EXPECT_NE(refusal(deck).find("times its thickness, 12.5 kPa; earlier versions took 25 [S350]"),
            std::string::npos)
      << refusal(deck);
  deck.materials.clear();
  deck.material(1, kPlateLaw, {3e7, 0.2, 1.0, 1.0}, 25.0);
  EXPECT_EQ(refusal(deck).find("S350"), std::string::npos) << "a metre thick it means the same";

  DeckWriter bars(1);
  bars.node(1, 0.0, 0.0);
  bars.node(2, 3.0, 0.0);
  bars.material(1, kAxial, {1e5, 2.0}, 5.0);
  bars.group(1, kBar2, 0, 1);
  bars.element(1, 1, {1, 2});
  bars.fix(1, 1, 1);
  bars.fix(2, 0, 1);
  bars.stage().gravity_y = -1.0;
  const WholeRun run = bench().run(bars.text());
  EXPECT_NEAR(run.reaction(1).y(), 5.0 / 2.0 * 3.0 / 2.0, 1e-12);
}

// A beam that is pulled along its line has no moments but rounding: they are none to warn of.
TEST(EndForces, MomentsOfZeroLoseNoDigits) {
  for (const int law : {kSection, kPlasticLaw}) {
    DeckWriter deck(1);
    for (int i = 0; i < 4; ++i) deck.node(i + 1, 1.3 * i, 0.7 * i);
    deck.material(1, law, law == kSection ? std::vector{1e6, kEI, kGA} : std::vector{1e6, kEI, 0.0, 10.0, kGA});
    deck.group(1, kBeam2, 0, 1);
    for (int i = 0; i < 3; ++i) deck.element(i + 1, 1, {i + 1, i + 2});
    clamp(deck, 1);
    deck.stage(3).load(4, 3.9, 2.1);
    const WholeRun run = bench().run(deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    EXPECT_FALSE(run.warns("no correction improves it")) << law;
  }
}

// Prestress that the law can't carry stops before the run; what it can is in the listing of its stage.
TEST(StructureChecks, PrestressThatTheLawCannotCarry) {
  const auto anchored = [](int law, const std::vector<double>& parameters, double force) {
    DeckWriter deck(1);
    deck.node(1, 0.0, 0.0);
    deck.node(2, 5.0, 0.0);
    deck.material(1, law, parameters);
    deck.group(1, kBar2, 0, 1);
    deck.element(1, 1, {1, 2});
    deck.fix(1, 1, 1);
    deck.fix(2, 1, 1);
    deck.initial(1, 0, force);
    deck.stage();
    return deck;
  };
  constexpr int kOneWay = 32, kAxialPlastic = 33;
  const auto wrong = [&](int law, const std::vector<double>& parameters, double force) {
    return refusal(anchored(law, parameters, force)).find("S351") != std::string::npos;
  };
  EXPECT_TRUE(wrong(kOneWay, {1e5, 1.0}, 40.0)) << "a pushed anchor";
  EXPECT_FALSE(wrong(kOneWay, {1e5, 1.0}, -40.0));
  EXPECT_TRUE(wrong(kOneWay, {1e5, -1.0}, -40.0)) << "a pulled strut";
  EXPECT_FALSE(wrong(kOneWay, {1e5, -1.0}, 40.0));
  EXPECT_TRUE(wrong(kAxialPlastic, {1e5, 30.0, 10.0, 1.0}, -40.0)) << "beyond its strength";
  EXPECT_FALSE(wrong(kAxialPlastic, {1e5, 50.0, 10.0, 1.0}, -40.0));
  EXPECT_NE(refusal(anchored(kOneWay, {1e5, 1.0}, 40.0)).find("an axial compression of 40 kN"),
            std::string::npos);

  const std::filesystem::path folder = scratch_folder("prestress");
  std::ofstream(folder / "deck.dat") << anchored(kOneWay, {1e5, 1.0}, -40.0).text();
  app::RunRequest request;
  request.deck = (folder / "deck.dat").string();
  request.quiet = true;
  request.stem = "deck";
  request.output.folder = folder;
  ASSERT_EQ(app::run_deck(request, app::full_catalogue()).exit_code, app::kOk);
  std::ifstream in(folder / "deck.lst");
  const std::string listing(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(listing.find("prestress, group 1: axial force -40\n"), std::string::npos) << listing;
}

// A wall with soil on one side, sharing its nodes, and a strut: what the ends of the elements at a node do to it is
// in balance with the soil's forces on it, that come from the internal forces less the beams' own.
TEST(EndForces, AreInEquilibriumAtEveryNode) {
  for (const int geometry : {1, 2})
    for (const bool quadratic : {false, true}) {
      Block soil;
      soil.columns = soil.rows = 3;
      soil.cell = quadratic ? Cell::quad8 : Cell::quad4;
      soil.place = rectangle(2.0, 5.0, 0.0, 3.0);
      DeckWriter deck(geometry);
      soil.write_nodes(deck);
      deck.material(1, 1, {1000.0, 0.3});
      deck.material(2, kSection, {1e5, 1e3, 4e4, 1e4, 1e2});
      deck.material(3, kAxial, {4e3, 2.0});
      deck.group(1, 1 + (quadratic ? 1 : 0), 1, 1);
      deck.group(2, quadratic ? kBeam3 : kBeam2, 0, 2);
      deck.group(3, kBar2, 0, 3);
      soil.write_elements(deck, 1);
      const std::vector<int> wall = soil.left();
      const int step = soil.order();
      for (int e = 0; e < 3; ++e) {
        const auto at = static_cast<std::size_t>(step * e);
        std::vector<int> nodes{wall[at], wall[at + static_cast<std::size_t>(step)]};
        if (quadratic) nodes.push_back(wall[at + 1]);
        deck.element(201 + e, 2, nodes);
      }
      deck.node(901, 1.0, 3.0);
      deck.fix(901, 1, 1);
      deck.element(301, 3, {901, wall.back()});
      for (const int n : soil.bottom()) deck.fix(n, 1, 1);
      StageCards& stage = deck.stage();
      for (const int n : soil.right()) stage.load(n, -10.0, -3.0);
      const Kept kept(deck);
      ASSERT_TRUE(kept.completed());
      const Solution now = kept.result.ends().back().view();
      // Moments at nodes between two elements: nobody else is there to bear one.
      const std::vector<ElementEnd> ends = kept.ends(1);
      ASSERT_EQ(ends.size(), 6u);
      double size = 0.0;
      for (const ElementEnd& end : ends) size = std::max(size, std::abs(end.value[kBendingMoment]));
      EXPECT_GT(size, 0.01);
      for (std::size_t e = 0; e + 1 < 3; ++e)
        EXPECT_NEAR(ends[2 * e + 1].value[kBendingMoment], ends[2 * e + 2].value[kBendingMoment], 1e-9 * size);
      EXPECT_NEAR(ends.back().value[kBendingMoment], 0.0, 1e-9 * size);  // the wall's upper end
      // Forces of the strut: of one, and for each unit of width; on the node with the circle that it stands for.
      const std::vector<ElementEnd> strut = kept.ends(2);
      ASSERT_EQ(strut.size(), 2u);
      EXPECT_NEAR(strut[1].value[kForceEach], 2.0 * strut[1].value[kAxialForce], 1e-12);
      if (geometry == 2) {
        EXPECT_NEAR(strut[0].value[kAxialForce] * 1.0, strut[1].value[kAxialForce] * 2.0, 1e-9);  // N r
      }
      const int support = 2 * (kept.model.mesh.nodes() - 1);  // the node given last
      const double circle = geometry == 2 ? 2.0 * kPi * 1.0 : 1.0;
      EXPECT_NEAR((*now.internal)[support], circle * strut[0].value[kAxialForce],
                  1e-9 * std::abs((*now.internal)[support]));
    }
}

// Looks at structures at the ends of stages, and at all at the end of the run or after every increment.
struct Looker : Observer {
  enum class Looks { always, last, never };
  explicit Looker(Looks how) : looks(how) {}
  bool wants_states(const Model& model, const StepReport& report) const override {
    const bool end = report.stage + 1 == static_cast<int>(model.stages.size()) && report.increment == 2;
    return looks == Looks::always || (looks == Looks::last && end);
  }
  bool wants_structures(const Model&, const StepReport& report) const override { return report.increment == 2; }
  void on_stage_end(const Model&, int, const EquilibriumAudit&, const Solution& now) override {
    soil = now.groups()[0].state.committed.sigma;
    wall.push_back(now.groups()[1].state.committed.sigma);
  }
  Looks looks;
  std::vector<double> soil;
  std::vector<std::vector<double>> wall;  // of each stage
};

void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  double size = 0.0;
  for (const double value : b) size = std::max(size, std::abs(value));
  ASSERT_GT(size, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * size) << i;
}

// Forces of structures are there for who looks at them alone, and stresses of elastic soil are not made for them; soil
// that is looked at later has all of its stress.
TEST(EndForces, OfStructuresAloneWhereNobodyLooksAtTheSoil) {
  Block soil;
  soil.columns = soil.rows = 3;
  soil.place = rectangle(2.0, 5.0, 0.0, 3.0);
  DeckWriter deck(1);
  soil.write_nodes(deck);
  deck.material(1, 1, {1000.0, 0.3});
  deck.material(2, kSection, {1e5, 1e3, 4e4});
  deck.group(1, 1, 1, 1);
  deck.group(2, kBeam2, 0, 2);
  soil.write_elements(deck, 1);
  const std::vector<int> wall = soil.left();
  for (std::size_t e = 0; e < 3; ++e) deck.element(201 + static_cast<int>(e), 2, {wall[e], wall[e + 1]});
  for (const int n : soil.bottom()) deck.fix(n, 1, 1);
  for (const double push : {-10.0, 7.0}) {
    StageCards& stage = deck.stage(2);
    for (const int n : soil.right()) stage.load(n, push, -3.0);
  }
  const Model model = bench().build(deck.text());
  const auto look = [&](Looker::Looks how, const RunSettings& settings = bench().settings()) {
    Looker looker(how);
    Observer* const observers[] = {&looker};
    EXPECT_EQ(run(model, bench().catalogue(), settings, observers).status, RunStatus::completed);
    return looker;
  };
  const Looker always = look(Looker::Looks::always);
  for (const Looker::Looks how : {Looker::Looks::last, Looker::Looks::never}) {
    const Looker some = look(how);
    ASSERT_EQ(some.wall.size(), 2u);
    for (std::size_t stage = 0; stage < 2; ++stage) expect_same(some.wall[stage], always.wall[stage]);
    if (how == Looker::Looks::last)
      expect_same(some.soil, always.soil);
    else
      EXPECT_TRUE(some.soil.empty());
  }
  // Checkpoints keep what is still to be made.
  std::vector<std::string> checkpoints;
  RunSettings settings = bench().settings();
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& state) { checkpoints.push_back(state); };
  const Looker whole = look(Looker::Looks::last, settings);
  ASSERT_EQ(checkpoints.size(), 3u);
  for (const std::string& state : checkpoints) {
    RunSettings resumed = bench().settings();
    resumed.resume_from = state;
    const Looker rest = look(Looker::Looks::last, resumed);
    EXPECT_EQ(rest.soil, whole.soil);
    EXPECT_EQ(rest.wall.back(), whole.wall.back());
  }
}

// Loads 1, then -3: moments 10 and -20 at the clamp, each with its stage; half of it after half of the stage.
TEST(EndForces, EnvelopeAndTablesOfAllStages) {
  DeckWriter deck(1);
  deck.material(1, kSection, {1e6, kEI, kGA});
  deck.group(1, kBeam2, 0, 1);
  for (int i = 0; i < 3; ++i) deck.node(i + 1, 5.0 * i, 0.0);
  deck.element(1, 1, {1, 2});
  deck.element(2, 1, {2, 3});
  clamp(deck, 1);
  StageCards& first = deck.stage(2);
  first.output_every = 1;
  first.load(3, 0.0, 1.0);
  deck.stage().load(3, 0.0, -3.0);
  const std::filesystem::path folder = scratch_folder("ends");
  std::ofstream(folder / "deck.dat") << deck.text();
  app::RunRequest request;
  request.deck = (folder / "deck.dat").string();
  request.quiet = true;
  request.stem = "deck";
  request.output.folder = folder;
  request.output.points = request.output.vtu = true;
  request.output.tables = Tables::all;
  request.output.pictures = {"bending_moment", "bending_moment_envelope"};
  const app::RunOutcome outcome = app::run_deck(request, app::full_catalogue());
  ASSERT_EQ(outcome.exit_code, app::kOk);
  const auto contents = [&](const std::string& name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::vector<double> M = csv_column(contents("deck.ends.csv"), "bending_moment");
  const std::vector<double> wanted{5.0, 2.5, 2.5, 0.0, 10.0, 5.0, 5.0, 0.0, -20.0, -10.0, -10.0, 0.0};
  ASSERT_EQ(M.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(M[i], wanted[i], 1e-9) << i;
  const std::string envelope = contents("deck.envelope.csv");
  const auto column = [&](const std::string& name) { return csv_column(envelope, "bending_moment_" + name); };
  ASSERT_EQ(column("least").size(), 4u);
  EXPECT_NEAR(column("least")[0], -20.0, 1e-9);
  EXPECT_NEAR(column("largest")[0], 10.0, 1e-9);
  EXPECT_EQ(column("least_stage")[0], 2.0);
  EXPECT_EQ(column("largest_stage")[0], 1.0);
  const std::string listing = contents("deck.lst");
  EXPECT_NE(listing.find("Ends of group 1"), std::string::npos);
  EXPECT_NE(listing.find("ENVELOPE OF STRUCTURES"), std::string::npos);
  EXPECT_NE(contents("deck_0001.vtu").find("Name=\"bending_moment_ends\""), std::string::npos);
  EXPECT_NE(contents("deck_stage1_bending_moment.svg").find("on the side that is pulled"), std::string::npos);
  EXPECT_NE(contents("deck_stage1_bending_moment.svg").find("from 0 to 10"), std::string::npos);
  EXPECT_EQ(contents("deck_stage1_bending_moment_envelope.svg"), "");
  EXPECT_NE(contents("deck_stage2_bending_moment_envelope.svg").find("from -20 to 10"), std::string::npos);
  const std::vector<EnvelopeEnd> rows = outcome.record.envelope.rows();
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NEAR(rows[0].low[kBendingMoment], -20.0, 1e-9);
  EXPECT_EQ(rows[0].low_stage[kBendingMoment], 1);
}

double step_time_at(const std::vector<ElementEnd>& ends, std::size_t i) {
  return ends[i].value[kBendingMoment];
}

// Between two clamps: what the released end hands on is taken by the other beam alone.
TEST(Releases, AnAxialReleaseLeavesTheOtherBeamTheForce) {
  for (const auto& [element, released] : {std::pair{kBeam2, kAxialRelease2}, {kBeam3, kAxialRelease3}}) {
    DeckWriter deck = beam_row(element, 1, 2.0);
    add_row(deck, 2, released, 1, 2.0, 2, 2.0);
    clamp(deck, 1);
    clamp(deck, 3);
    deck.stage().load(2, 8.0 * 0.8 - 3.0 * -0.6, 8.0 * 0.6 - 3.0 * 0.8);  // 8 along, 3 to the right
    const Kept kept(deck);
    ASSERT_TRUE(kept.completed());
    EXPECT_NEAR(kept.ends(0)[0].value[kAxialForce], -8.0, 1e-9);
    for (const ElementEnd& end : kept.ends(1)) EXPECT_NEAR(end.value[kAxialForce], 0.0, 1e-9);
    EXPECT_NEAR(kept.ends(0)[1].value[kShearForce], -1.5, 1e-9);  // bending as without the release
    EXPECT_NEAR(kept.ends(1)[0].value[kShearForce], 1.5, 1e-9);
    if (element == kBeam2) {
      EXPECT_NEAR(step_time_at(kept.ends(1), 1), -3.0 * 4.0 / 8.0, 1e-9);  // P L/8
    }
  }
}

// The released beam has no shear and one moment: P L/4, from the rotation that both share.
TEST(Releases, AShearReleaseLeavesTheOtherBeamTheShear) {
  for (const auto& [element, released] : {std::pair{kBeam2, kShearRelease2}, {kBeam3, kShearRelease3}}) {
    DeckWriter deck = beam_row(element, 1, 2.0);
    add_row(deck, 2, released, 1, 2.0, 2, 2.0);
    clamp(deck, 1);
    clamp(deck, 3);
    deck.stage().load(2, 3.0 * 0.6, -3.0 * 0.8);  // to the right of the line
    const Kept kept(deck);
    ASSERT_TRUE(kept.completed());
    for (const ElementEnd& end : kept.ends(1)) {
      EXPECT_NEAR(end.value[kShearForce], 0.0, 1e-9);
      EXPECT_NEAR(end.value[kBendingMoment], 3.0 * 2.0 / 4.0, 1e-9);
    }
    EXPECT_NEAR(kept.ends(0)[1].value[kShearForce], -3.0, 1e-9);
    EXPECT_NEAR(step_time_at(kept.ends(0), 0), -3.0 * 2.0 + 3.0 * 2.0 / 4.0, 1e-9);
  }
}

// A row of beams that are pinned at both ends hinges at every node, loaded or not: q L^2/8 nowhere at ends.
TEST(Releases, PinnedBeamsHaveNoMomentAtTheirEnds) {
  for (const int element : {kPinned2, kPinned3}) {
    DeckWriter deck = beam_row(element, 2, 6.0);
    for (const int node : {1, 2, 3}) deck.fix(node, 1, 1);
    StageCards& stage = deck.stage();
    for (const int e : {100, 101}) stage.pressure(e, 1, 4.0, 4.0);
    const Kept kept(deck);
    ASSERT_TRUE(kept.completed());
    const std::vector<ElementEnd> ends = kept.ends(0);
    for (const ElementEnd& end : ends) EXPECT_NEAR(end.value[kBendingMoment], 0.0, 1e-8);
    EXPECT_NEAR(ends[0].value[kShearForce], 6.0, 1e-8);
    EXPECT_NEAR(ends[1].value[kShearForce], -6.0, 1e-8);
  }
}

constexpr double kSpan = 6.0, kLoad = 4.0;

// Along x from node 1 to 3 two beams that start with hinges at the held ends, and a spring in either hinge.
DeckWriter sprung_span(int element, int spring_law, const std::vector<double>& spring) {
  DeckWriter deck(1);
  for (int i = 0; i < 3; ++i) deck.node(i + 1, 0.5 * kSpan * i, 0.0);
  deck.material(1, kSection, {1e6, kEI, kGA});
  deck.material(2, spring_law, spring);
  deck.group(1, element, 0, 1);
  deck.group(2, kRotationalSpring, 0, 2);
  if (element == kHinged3) {
    deck.node(4, 0.25 * kSpan, 0.0);
    deck.node(5, 0.75 * kSpan, 0.0);
    deck.element(1, 1, {1, 2, 4});
    deck.element(2, 1, {3, 2, 5});
  } else {
    deck.element(1, 1, {1, 2});
    deck.element(2, 1, {3, 2});
  }
  deck.element(3, 2, {1, 1});
  deck.element(4, 2, {3, 3});
  clamp(deck, 1);
  clamp(deck, 3);
  return deck;
}

// Downward on both beams: to the right of the first, to the left of the second.
void press(StageCards& stage, double q) {
  stage.pressure(1, 1, -q, -q);
  stage.pressure(2, 1, q, q);
}

// By symmetry the ends turn by (q L^3/24 - M L/2)/EI = M/k, whatever the beam's shear stiffness.
double sprung_moment(double k) {
  return kLoad * kSpan * kSpan / 12.0 / (1.0 + 2.0 * kEI / (k * kSpan));
}

// From a hinge to a clamp; beam2 is exact under a uniform load.
TEST(RotationalSprings, HoldTheEndsOfASpan) {
  for (const double k : {1e-6, 1e2, 2e3, 1e5, 1e12}) {
    DeckWriter deck = sprung_span(kHinged2, kSection, {1.0, k});
    press(deck.stage(), kLoad);
    const Kept kept(deck);
    ASSERT_TRUE(kept.completed()) << k;
    const double M = sprung_moment(k);
    const std::vector<ElementEnd> beams = kept.ends(0), springs = kept.ends(1);
    ASSERT_EQ(springs.size(), 2u);
    EXPECT_NEAR(springs[0].value[kBendingMoment], -M, 1e-10 * kLoad * kSpan * kSpan) << k;
    EXPECT_NEAR(springs[1].value[kBendingMoment], M, 1e-10 * kLoad * kSpan * kSpan) << k;
    EXPECT_NEAR(springs[0].value[kAxialForce], 0.0, 1e-12) << k;
    EXPECT_NEAR(beams[0].value[kBendingMoment], -M, 1e-10 * kLoad * kSpan * kSpan) << k;
    EXPECT_NEAR(beams[1].value[kBendingMoment], kLoad * kSpan * kSpan / 8.0 - M, 1e-10 * kLoad * kSpan * kSpan)
        << k;
  }
}

// Limits: qL^2/12 of the clamped span, nothing in the hinged one.
TEST(RotationalSprings, ReachTheClampAndTheHinge) {
  EXPECT_NEAR(sprung_moment(1e12), kLoad * kSpan * kSpan / 12.0, 1e-7);
  EXPECT_NEAR(sprung_moment(1e-6), 0.0, 1e-8);
}

// In beam3 too the spring is in equilibrium with the beam that starts at its hinge.
TEST(RotationalSprings, BalanceBeamsOfThreeNodes) {
  DeckWriter deck = sprung_span(kHinged3, kSection, {1.0, 2e3});
  press(deck.stage(), kLoad);
  const Kept kept(deck);
  ASSERT_TRUE(kept.completed());
  const std::vector<ElementEnd> beams = kept.ends(0), springs = kept.ends(1);
  EXPECT_NEAR(springs[0].value[kBendingMoment], beams[0].value[kBendingMoment], 1e-9);
  EXPECT_NEAR(beams[1].value[kBendingMoment] - beams[0].value[kBendingMoment], kLoad * kSpan * kSpan / 8.0,
              1e-9);
}

// M_p at the ends; statics give the middle q L^2/8 - M_p.
TEST(RotationalSprings, YieldAtTheirStrength) {
  constexpr double kStrength = 5.0;  // the elastic moment is 11.8
  DeckWriter deck = sprung_span(kHinged2, kPlasticLaw, {1.0, 1e5, 0.0, kStrength});
  press(deck.stage(4), kLoad);
  const Kept kept(deck);
  ASSERT_TRUE(kept.completed());
  EXPECT_NEAR(kept.ends(1)[0].value[kBendingMoment], -kStrength, 1e-10);
  EXPECT_NEAR(kept.ends(1)[1].value[kBendingMoment], kStrength, 1e-10);
  EXPECT_NEAR(kept.ends(0)[1].value[kBendingMoment], kLoad * kSpan * kSpan / 8.0 - kStrength, 1e-6);
}

// A joint that comes in the second stage has no part in the load of the first.
TEST(RotationalSprings, StartWithoutMomentInTheirStage) {
  DeckWriter deck = sprung_span(kHinged2, kSection, {1.0, 2e3});
  press(deck.stage(), 3.0);
  StageCards& second = deck.stage();
  second.births = {2};
  press(second, kLoad);
  const Kept kept(deck);
  ASSERT_TRUE(kept.completed());
  EXPECT_NEAR(kept.ends(1)[0].value[kBendingMoment], -sprung_moment(2e3), 1e-9);
}

// A cantilever with a joint in its middle: the tip gets P b^2/k more.
TEST(RotationalSprings, JoinTwoBeams) {
  constexpr double kForce = 3.0, k = 500.0;
  const auto tip = [&](bool sprung) {
    DeckWriter deck(1);
    for (int i = 0; i < 3; ++i) deck.node(i + 1, 2.0 * i, 0.0);
    deck.material(1, kSection, {1e6, kEI, kGA});
    deck.material(2, kSection, {1.0, k});
    deck.group(1, kBeam2, 0, 1);
    deck.group(2, sprung ? kHinged2 : kBeam2, 0, 1);
    deck.element(1, 1, {1, 2});
    deck.element(2, 2, {2, 3});
    if (sprung) {
      deck.group(3, kRotationalSpring, 0, 2);
      deck.element(3, 3, {2, 2});
    }
    clamp(deck, 1);
    deck.stage().load(3, 0.0, -kForce);
    const Kept kept(deck);
    EXPECT_TRUE(kept.completed());
    return (*kept.result.ends().back().view().u)[2 * 2 + 1];
  };
  EXPECT_NEAR(tip(true) - tip(false), -kForce * 2.0 * 2.0 / k, 1e-12);
}

TEST(RotationalSprings, AreRejectedWhereTheyCanNotWork) {
  DeckWriter plate = sprung_span(kHinged2, kPlateLaw, {1e6, 0.2, 0.5});
  press(plate.stage(), kLoad);
  EXPECT_NE(refusal(plate).find("S625"), std::string::npos) << refusal(plate);
  DeckWriter free = sprung_span(kHinged2, kSection, {1.0, 1e3});
  press(free.stage(), kLoad);
  EXPECT_EQ(refusal(free).find("S62"), std::string::npos) << refusal(free);
  free.fixities.pop_back();  // the rotation of node 3
  EXPECT_NE(refusal(free).find("node 3 has no beam with rotation"), std::string::npos) << refusal(free);
}

TEST(StructureChecks, ReleasedEndsDontMeet) {
  DeckWriter deck = beam_row(kBeam2, 1, 2.0);
  deck.node(3, 5.0, 0.0);
  deck.group(2, kAxialRelease2, 0, 1);
  deck.element(201, 2, {2, 3});
  deck.node(4, 5.0, 2.0);
  deck.element(202, 2, {2, 4});
  for (const int node : {1, 3, 4}) clamp(deck, node);
  deck.stage().load(2, 1.0, 0.0);
  EXPECT_NE(refusal(deck).find("S347"), std::string::npos) << refusal(deck);
}

// Four nodes of a solid; a beam sticks out of its corner.
TEST(StructureChecks, ABeamThatHangsOnOneNodeIsNamed) {
  DeckWriter deck(1);
  deck.node(1, 0.0, 0.0);
  deck.node(2, 1.0, 0.0);
  deck.node(3, 1.0, 1.0);
  deck.node(4, 0.0, 1.0);
  deck.node(5, 1.0, 3.0);
  deck.material(1, 1, {1000.0, 0.3});
  deck.material(2, kSection, {1e6, kEI, kGA});
  deck.group(1, 1, 1, 1);
  deck.group(2, kBeam2, 0, 2);
  deck.element(1, 1, {1, 2, 3, 4});
  deck.element(2, 2, {3, 5});
  deck.fix(1, 1, 1);
  deck.fix(2, 1, 1);
  deck.stage().load(5, 1.0, 0.0);
  const std::string words = refusal(deck);
  EXPECT_NE(words.find("hangs on node 3 alone and has no rotation support"), std::string::npos) << words;
  deck.fixities.push_back(held(3));
  EXPECT_EQ(refusal(deck).find("S346"), std::string::npos) << refusal(deck);
  deck.fixities.pop_back();
  deck.element(3, 2, {2, 3});  // goes on along the solid
  EXPECT_EQ(refusal(deck).find("S346"), std::string::npos) << refusal(deck);
}

// A raft on joints over held ground: no support of its own.
DeckWriter raft_on_joints(bool tension, bool both_sides) {
  DeckWriter deck(1);
  for (int i = 0; i < 3; ++i) {
    deck.node(1 + i, i, 0.0);
    deck.node(11 + i, i, 0.0);
    deck.node(21 + i, i, 0.0);
    deck.fix(1 + i, 1, 1);
    deck.fix(21 + i, 1, 1);
  }
  deck.material(1, kSection, {1e6, kEI, kGA});
  deck.material(2, kGoodman, {1e4, 1e4, tension ? 1.0 : 0.0});
  deck.group(1, kBeam2, 0, 1);
  deck.group(2, 11, 2, 2);
  for (int i = 0; i < 2; ++i) {
    deck.element(1 + i, 1, {11 + i, 12 + i});
    deck.element(11 + i, 2, {1 + i, 2 + i, 12 + i, 11 + i});
    if (both_sides) deck.element(21 + i, 2, {11 + i, 12 + i, 22 + i, 21 + i});
  }
  deck.stage().load(12, 0.0, -1.0);
  return deck;
}

TEST(StructureChecks, AStructureThatJointsAloneHoldIsNamed) {
  const std::string one = refusal(raft_on_joints(false, false));
  EXPECT_NE(one.find("held by joints alone, which open without tension: nothing but weight"), std::string::npos)
      << one;
  const std::string both = refusal(raft_on_joints(false, true));
  EXPECT_NE(both.find("S345"), std::string::npos) << both;
  EXPECT_NE(both.find("pressed on from both sides"), std::string::npos) << both;
  EXPECT_EQ(refusal(raft_on_joints(true, false)).find("S345"), std::string::npos);
  DeckWriter held_one = raft_on_joints(false, false);
  held_one.fix(11, 1, 0);
  EXPECT_EQ(refusal(held_one).find("S345"), std::string::npos);
}

// Beds on both sides of a beam, without any solid: the second of them lies on the face of the first.
TEST(StructureChecks, TwoJointsOnOneFaceAreNamed) {
  DeckWriter deck = raft_on_joints(true, false);
  EXPECT_EQ(refusal(deck).find("S327"), std::string::npos);
  deck.element(31, 2, {21, 22, 12, 11});  // below the beam, as element 11 is
  const std::string words = refusal(deck);
  EXPECT_NE(words.find("lies on the same side of the structure between nodes 11 and 12"), std::string::npos)
      << words;
}

}  // namespace
}  // namespace sage::test
