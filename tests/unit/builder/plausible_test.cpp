// Valid decks with a number that is unlikely to be meant: each gets its warning or
// note, and the sound deck none.
#include <gtest/gtest.h>

#include <functional>

#include "materials/linear_elastic.hpp"
#include "materials/parameters.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

DeckWriter sound() {
  DeckWriter deck(1);
  Block block;
  block.columns = block.rows = 2;
  block.place = rectangle(0.0, 2.0, 0.0, 2.0);
  block.write_nodes(deck);
  deck.material(1, 1, {1e4, 0.3}, 20.0);
  deck.group(1, 1, 0, 1);
  block.write_elements(deck, 1);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  deck.initial(1, 0, 1.0, 1.0, 1.0, 0.0);
  StageCards& stage = deck.stage();
  stage.gravity_y = -1.0;
  stage.pressure(3, 3, 10.0, 10.0);
  return deck;
}

// Element 5 on top of elements 3 and 4's left half, born in a second stage.
void place_later(DeckWriter& deck) {
  deck.node(10, 0.0, 3.0);
  deck.node(11, 1.0, 3.0);
  deck.group(2, 1, 0, 1);
  deck.element(5, 2, {7, 8, 11, 10});
  deck.stage().births = {2};
}

// "warning: ...\nnote: ...\n" of the model; what the law's own checks say at run time is not among them.
std::string messages(const DeckWriter& deck) {
  const WholeRun run = run_text(deck.text());
  std::string text;
  for (const Diagnostic& d : run.model->diagnostics.list())
    text += (d.severity == Severity::warning ? "warning: " : "note: ") + d.message + "\n";
  return text;
}

struct Unlikely {
  const char* name;
  std::function<void(DeckWriter&)> change;
  const char* says;
};

void PrintTo(const Unlikely& one, std::ostream* out) {
  *out << one.name;
}

class Plausible : public testing::TestWithParam<Unlikely> {};

TEST_P(Plausible, IsTold) {
  DeckWriter deck = sound();
  GetParam().change(deck);
  const std::string printed = messages(deck);
  EXPECT_NE(printed.find(GetParam().says), std::string::npos) << "expected \"" << GetParam().says << "\" in\n"
                                                              << printed;
}

// The checks know parameters by their roles: a law of other words and another order is judged as the rest.
TEST(PlausibleRoles, AreSeenInALawThatTheProgramDoesNotKnow) {
  Catalogue catalogue = app::full_catalogue();
  catalogue.materials.add(50,
                          {"mine",
                           "a law of the user's own",
                           4,
                           {required("own_weight", Dimension::unit_weight, "", ParameterRole::unit_weight),
                            required("grip", Dimension::stress, "", ParameterRole::strength),
                            required("slope", Dimension::angle, "", ParameterRole::friction_angle),
                            required("ratio", Dimension::none, "", ParameterRole::poissons_ratio),
                            required("stiffness", Dimension::stress, "", ParameterRole::youngs_modulus)},
                           [](std::span<const double> values, const UnitSystem&) -> LawPtr {
                             return std::make_unique<LinearElastic>(moduli_from_young(values[4], values[3]));
                           }});
  const auto printed = [&](const std::vector<double>& values) {
    DeckWriter deck = sound();
    deck.materials.clear();
    deck.material(1, 50, values, 20.0);
    const Model model = build_model(read_deck_text(deck.text(), "mine.dat", load_layout("sage1")), catalogue);
    std::string text;
    for (const Diagnostic& d : model.diagnostics.list()) text += d.message + "\n";
    return text;
  };
  EXPECT_EQ(printed({18.0, 10.0, 30.0, 0.3, 1e4}), "");
  EXPECT_EQ(
      printed({-18.0, 2e4, 0.5, -0.1, 1e4}),
      "material 1: grip is 2e+04, 197 times the atmosphere; soils have up to 5 times: is it in Pa? 2e+04 Pa "
      "are 20 kPa\n"
      "material 1: Poisson's ratio is negative, -0.1\n"
      "material 1: the friction angle is 0.5 degrees; was it meant in radians, 28.65 degrees?\n"
      "material 1: own_weight, -18, is a negative unit weight\n"
      "material 1: grip, 2e+04, exceeds the material's modulus, 1e+04\n");
  const std::string soft = printed({18.0, 10.0, 30.0, 0.3, 15.0});
  EXPECT_NE(soft.find("the weight of a column as high as the mesh, 40, exceeds its modulus, 15"),
            std::string::npos)
      << soft;
}

TEST(PlausibleDeck, MayHaveAModulusOfOneForResultsAsItsMultiples) {
  DeckWriter deck = sound();
  deck.materials.clear();
  deck.material(1, 1, {1.0, 0.3}, 0.0);
  EXPECT_EQ(messages(deck).find("youngs_modulus"), std::string::npos) << messages(deck);
}

TEST(PlausibleDeck, HasNothingToSay) {
  EXPECT_EQ(messages(sound()), "");
}

// One element more on the nodes of the first, in a group of its own.
void lay_over(DeckWriter& deck, bool twin) {
  deck.group(2, 1, 0, 1);
  deck.element(9, 2, {1, 2, 5, 4});
  if (!twin) return;
  deck.group(3, 1, 0, 1);
  deck.elements.front() = deck.elements.front().substr(0, 5) + "    3" + deck.elements.front().substr(10);
  StageCards& stage = deck.stage();
  stage.births = {2};
  stage.deaths = {3};
}

// The formulation that is named is one of the element's own.
TEST(Locking, TheRemedyFitsTheElement) {
  const struct {
    Cell cell;
    int formulation;
    const char* remedy;
  } cases[] = {{Cell::quad4, 1, "b-bar (formulation 2) does not"},
               {Cell::quad8, 2, "reduced integration (formulation 1) does not"},
               {Cell::quad9, 1, "quad4 enhanced or 8-node quadrilaterals (reduced) do not"},
               {Cell::tri3, 1, "6-node triangles (three points) do not"},
               {Cell::tri6, 2, "three points (formulation 1) do not"}};
  for (const auto& [cell, formulation, remedy] : cases) {
    Block block;
    block.cell = cell;
    block.columns = block.rows = 2;
    block.place = rectangle(0.0, 2.0, 0.0, 2.0);
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 1, {1e4, 0.49});
    deck.group(1, static_cast<int>(cell), formulation, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    deck.stage().load(block.top().front(), 0.0, -1.0);
    EXPECT_NE(messages(deck).find(std::string("too much stiffness; ") + remedy + "\n"), std::string::npos)
        << messages(deck);
  }
}

TEST(PlausibleDeck, TwinsThatFollowEachOtherDoNotOverlap) {
  DeckWriter deck = sound();
  lay_over(deck, true);
  EXPECT_EQ(messages(deck).find("overlap"), std::string::npos) << messages(deck);
}

// Elements 3 and 4, the upper half, as group 2; a stage that removes groups.
void dig(DeckWriter& deck, const std::vector<int>& deaths) {
  if (deck.groups.size() == 1) {
    deck.group(2, 1, 0, 1);
    for (std::size_t e : {2, 3}) deck.elements[e].replace(5, 5, "    2");
    deck.initial(2, 0, 1.0, 1.0, 1.0, 0.0);
  }
  deck.stage().deaths = deaths;
}

TEST(PlausibleDeck, AReleaseOfWhatTheSameStageHeldIsNoReleaseOfNothing) {
  DeckWriter deck = sound();
  deck.stages[0].fix(9, 0, 1, 0.0, -0.02);
  deck.stages[0].fix(9, 0, -1);
  EXPECT_EQ(messages(deck).find("which nothing held"), std::string::npos) << messages(deck);
}

TEST(PlausibleDeck, EqualCardsDoNotContradictEachOther) {
  DeckWriter deck = sound();
  deck.stages[0].fix(9, 0, 1, 0.0, -0.02);
  deck.stages[0].fix(9, 0, 1, 0.0, -0.02);
  EXPECT_EQ(messages(deck), "");
}

// The message of the first error.
std::string refusal(const DeckWriter& deck) {
  try {
    run_text(deck.text());
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics().list())
      if (d.severity == Severity::error) return to_string(d);
  }
  return "";
}

TEST(Stages, WithoutSenseAreRefused) {
  DeckWriter deck = sound();
  dig(deck, {2});
  deck.stages[1].births = {2};
  EXPECT_NE(refusal(deck).find("group 2 is born and removed in the same stage"), std::string::npos)
      << refusal(deck);
  deck.stages[1].births = {};
  deck.stage().births = {2};
  EXPECT_NE(refusal(deck).find("group 2 is born in stage 3 but removed in stage 2"), std::string::npos)
      << refusal(deck);
  deck.stages.pop_back();
  dig(deck, {1});
  EXPECT_NE(refusal(deck).find("stage 3: no element takes part"), std::string::npos) << refusal(deck);
}

// The left side of the block on the axis of an axisymmetric deck.
DeckWriter on_axis() {
  DeckWriter deck = sound();
  deck.geometry = 2;
  for (int n : {1, 4, 7}) deck.fix(n, 1, n == 1 ? 1 : 0);
  return deck;
}

TEST(OnTheAxis, RadialDisplacementsAreRefusedAtTheirCard) {
  EXPECT_EQ(messages(on_axis()), "");
  DeckWriter moved = on_axis();
  moved.stages[0].fix(7, 1, 0, 0.01, 0.0);
  EXPECT_NE(refusal(moved).find(":29: error: node 7 lies on the axis r = 0"), std::string::npos)
      << refusal(moved);
  DeckWriter released = on_axis();
  released.stages[0].fix(7, -1, 0);
  EXPECT_NE(refusal(released).find("can't be released radially"), std::string::npos) << refusal(released);
  DeckWriter settled = on_axis();
  settled.stages[0].fix(7, 1, 1, 0.0, -0.01);
  EXPECT_EQ(messages(settled), "");
}

TEST(OnTheAxis, RadialLoadsAreToldToHaveNoEffect) {
  DeckWriter deck = on_axis();
  deck.stages[0].load(7, 10.0, 0.0);
  EXPECT_NE(messages(deck).find("warning: the radial force on node 7 has no effect"), std::string::npos)
      << messages(deck);
  deck = on_axis();
  deck.stages[0].pressure(3, 4, 10.0, 10.0);
  EXPECT_NE(messages(deck).find("warning: the pressure has no effect: its edge lies on the axis r = 0"),
            std::string::npos)
      << messages(deck);
}

std::string titled(const std::string& title) {
  const std::string text = sound().text();
  return title + text.substr(text.find('\n'));
}

TEST(Titles, AreTextWhateverTheCardHolds) {
  struct Case {
    std::string card, title, says;
  };
  std::string long_card = "x", long_title = "x";
  for (int i = 0; i < 60; ++i) long_card += "\u00e9";
  for (int i = 0; i < 39; ++i) long_title += "\u00e9";
  const Case cases[] = {{"B\u00f6schung", "B\u00f6schung", ""},
                        {"B\xf6schung", "B\u00f6schung", "not UTF-8 text: it is read as Latin-1"},
                        {"caf\xe9", "caf\u00e9", "not UTF-8 text: it is read as Latin-1"},
                        {"bad \x81", "bad ?", "not UTF-8 text: it is read as Latin-1"},
                        {"page\ffeed", "page?feed", "holds control characters"},
                        {long_card, long_title, ""}};
  for (const Case& c : cases) {
    const WholeRun run = run_text(titled(c.card));
    EXPECT_EQ(run.model->title, c.title);
    std::string printed;
    for (const Diagnostic& d : run.model->diagnostics.list())
      if (d.severity == Severity::warning) printed += d.message;
    EXPECT_NE(printed.find(c.says), std::string::npos) << printed;
    EXPECT_EQ(printed.empty(), c.says.empty()) << printed;
  }
}

TEST(Elements, EightNodesOnTheCardOfANineNodeElementAreAllThatItHolds) {
  DeckWriter deck(1);
  Block block;
  block.cell = Cell::quad8;
  block.place = rectangle(0.0, 2.0, 0.0, 2.0);
  block.write_nodes(deck);
  deck.material(1, 1, {1e4, 0.3});
  deck.group(1, 5, 0, 1);
  block.write_elements(deck, 1);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  deck.stage().pressure(1, 3, 10.0, 10.0);
  EXPECT_EQ(messages(deck).find("left blank"), std::string::npos) << messages(deck);
}

// The lower half (group 1) dry, or with a level of its own; the right half of a block of 2 x 2 has another group.
DeckWriter two_levels(double left, double right) {
  DeckWriter deck = sound();
  deck.group(2, 1, 0, 1);
  for (std::size_t e : {1, 3}) deck.elements[e].replace(5, 5, "    2");
  deck.initial(2, 0, 1.0, 1.0, 1.0, 0.0);
  deck.water(1, 1, 1, 0, {0.0, left, 2.0, left});
  deck.water(1, 2, 1, 0, {0.0, right, 2.0, right});
  return deck;
}

// Levels 1.5 and 1 at the common edges x = 1, y = 0 to 1 and 1 to 2: u differs by 9.81 * .5 = 4.905 up to y = 1 and
// by nothing at y = 2. Force of the two trapezia at the nodes' values: 4.905 * 1 + 4.905/2.
TEST(WaterLevels, ThatDifferBetweenNeighboursAreWarnedOfWithJumpAndEdges) {
  const std::string text = messages(two_levels(1.5, 1.0));
  EXPECT_NE(
      text.find(
          "the pore pressures of groups 1 and 2 jump by up to 4.905 kPa at 2 common edges without a wall, "
          "most at element 1, (1, 0): this pushes 7.35"),
      std::string::npos)
      << text;
  EXPECT_EQ(messages(two_levels(1.5, 1.5)).find("jump"), std::string::npos);
  // r_u beside a level jumps by what it differs; layers that each have their r_u do so by nature.
  DeckWriter ratio = two_levels(1.5, 1.0);
  ratio.waters.pop_back();
  ratio.water(2, 2, 1, 0, {}, 0.3);
  EXPECT_NE(messages(ratio).find("the pore pressures of groups 1 and 2 jump by"), std::string::npos)
      << messages(ratio);
  ratio.waters.clear();
  ratio.water(2, 1, 1, 0, {}, 0.1);
  ratio.water(2, 2, 1, 0, {}, 0.3);
  EXPECT_EQ(messages(ratio).find("jump"), std::string::npos) << messages(ratio);
  DeckWriter walled = two_levels(1.5, 1.0);
  walled.material(2, 36, {1e6, 1e4});
  walled.group(3, 35, 0, 2);
  walled.element(11, 3, {2, 5});
  walled.element(12, 3, {5, 8});
  EXPECT_EQ(messages(walled).find("jump"), std::string::npos) << messages(walled);
}

// A joint between two blocks that are activated together: its traction is that of the stage's card, of two cards the
// last one's, as in the soil: 30.
TEST(Joints, TakeTheTractionOfTheLastCardOfTheirStage) {
  const auto traction = [](bool at_once, bool twice) {
    DeckWriter deck(1);
    for (int i = 0; i < 8; ++i) deck.node(i + 1, i % 2, i / 2 < 2 ? i / 2 : i / 2 - 1);
    deck.material(1, 1, {1e4, 0.3});
    deck.material(2, 21, {1e4, 1e4});
    deck.group(1, 1, 0, 1);
    deck.group(2, 1, 0, 1);
    deck.group(3, 11, 0, 2);
    deck.element(1, 1, {1, 2, 4, 3});
    deck.element(2, 2, {5, 6, 8, 7});
    deck.element(3, 3, {3, 4, 6, 5});
    for (int n = 1; n <= 8; ++n) deck.fix(n, 1, n <= 6 ? 1 : 0);
    StageCards* stage = &deck.stage();
    if (!at_once) {
      stage = &deck.stage();
      stage->births = {2, 3};
    }
    const auto add = [&](int group, int kind, double v1, double v2, double v3) {
      if (at_once)
        deck.initial(group, kind, v1, v2, v3, 0.0);
      else
        stage->initial(group, kind, v1, v2, v3, 0.0);
    };
    if (twice) add(2, 0, 5.0, 7.0, 5.0);
    add(2, 0, 20.0, 30.0, 20.0);
    add(3, 3, 2.0, 0.0, 0.0);
    const WholeRun run = run_text(deck.text());
    EXPECT_TRUE(run.completed()) << run.failure;
    return run.stress[2](1, 0);
  };
  for (const bool at_once : {true, false})
    for (const bool twice : {false, true})
      EXPECT_NEAR(traction(at_once, twice), -30.0, 1e-9) << at_once << twice;
}

INSTANTIATE_TEST_SUITE_P(
    Numbers, Plausible,
    testing::Values(
        Unlikely{"Atmosphere", [](DeckWriter& d) { d.atmospheric_pressure = 14.7; },
                 "warning: the atmospheric pressure, stress is 14.7; in these units it is about 101.3 kPa"},
        Unlikely{"Water", [](DeckWriter& d) { d.water_unit_weight = 62.4; },
                 "in these units it is about 9.807 kN/m^3"},
        Unlikely{"NoWeight",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 1, {1e4, 0.3}, 0.0);
                 },
                 "warning: stage 1: gravity acts, but no material has a unit weight"},
        Unlikely{"NegativeWeight",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 1, {1e4, 0.3}, -20.0);
                 },
                 "warning: material 1: the unit weight is negative"},
        Unlikely{"Heavy",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 1, {1e4, 0.3}, 2e4);
                 },
                 "the weight of a column as high as the mesh, 4e+04, exceeds its modulus, 1e+04"},
        Unlikely{
            "DensityInTonnes",
            [](DeckWriter& d) {
              d.materials.clear();
              d.material(1, 1, {1e4, 0.3}, 1.9);
            },
            "the unit weight is 1.9, 0.194 times that of water; soils have 1 to 2.5 times: is it in t/m^3? 1.9 "
            "t/m^3 are 18.6 kN/m^3"},
        Unlikely{"ModulusInMegapascals",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 4, {20.0, 0.3, 10.0, 30.0}, 19.0);
                 },
                 "youngs_modulus is 20, 0.197 times the atmosphere; soils have 5 to 10000 times: is it in MPa? "
                 "20 MPa "
                 "are 2e+04 kPa"},
        Unlikely{"ModulusInPascals",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 4, {2e7, 0.3, 10.0, 30.0}, 19.0);
                 },
                 "is it in Pa? 2e+07 Pa are 2e+04 kPa"},
        Unlikely{
            "CohesionInPascals",
            [](DeckWriter& d) {
              d.materials.clear();
              d.material(1, 4, {2e4, 0.3, 5000.0, 30.0}, 19.0);
            },
            "cohesion is 5000, 49.3 times the atmosphere; soils have up to 5 times: is it in Pa? 5000 Pa are 5 "
            "kPa"},
        Unlikely{"WeightOfTheInitialStress",
                 [](DeckWriter& d) {
                   d.initials.clear();
                   d.initial(1, 1, 2.0, 1900.0, 0.5, 0.0);
                 },
                 "initial stress: the unit weight is 1900, 194 times that of water"},
        Unlikely{"Acceleration", [](DeckWriter& d) { d.stages[0].gravity_y = -9.81; },
                 "warning: stage 1: gravity is 9.81 times the unit weights, and 1 is the full weight"},
        Unlikely{"DensitiesUnderAcceleration",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 1, {1e4, 0.3}, 1.9);
                   d.stages[0].gravity_y = -9.81;
                 },
                 "note: stage 1: gravity is 9.81 times the unit weights, which then look like densities"},
        Unlikely{"DilatantFourNodeElements",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 4, {1e4, 0.3, 10.0, 30.0, 5.0}, 20.0);
                   d.groups.clear();
                   d.group(1, 1, 2, 1);
                 },
                 "warning: group 1 of 4-node elements (quad4 b-bar) has a dilation angle of 5 degrees"},
        Unlikely{"NegativeNu",
                 [](DeckWriter& d) {
                   d.materials.clear();
                   d.material(1, 1, {1e4, -0.3}, 20.0);
                 },
                 "warning: material 1: Poisson's ratio is negative"},
        Unlikely{"GravityUp", [](DeckWriter& d) { d.stages[0].gravity_y = 1.0; },
                 "note: stage 1: gravity acts upwards"},
        Unlikely{
            "GravityTwice", [](DeckWriter& d) { d.stage().gravity_y = -1.0; },
            "note: stage 2: gravity is added to that of earlier stages: it is now 2 times the unit weights"},
        Unlikely{"GravityAlongTheRadius",
                 [](DeckWriter& d) {
                   d.geometry = 2;
                   d.stages[0].gravity_x = 0.1;
                 },
                 "warning: stage 1: gravity_x is 0.1: in axisymmetry it acts along the radius"},
        Unlikely{
            "RadiansPerhaps",
            [](DeckWriter& d) {
              d.materials.clear();
              d.material(1, 4, {1e4, 0.3, 50.0, 0.5236}, 20.0);
            },
            "warning: material 1: the friction angle is 0.5236 degrees; was it meant in radians, 30 degrees?"},
        Unlikely{"Tolerance", [](DeckWriter& d) { d.stages[0].tolerance = 0.01; },
                 "warning: stage 1: its tolerance lets 1 % of the forces be out of balance"},
        Unlikely{"InitialTwice", [](DeckWriter& d) { d.initial(1, 0, 2.0, 2.0, 2.0, 0.0); },
                 "warning: group 1 got an initial stress in line 23 already: this card replaces it"},
        Unlikely{"ReportOfNothing",
                 [](DeckWriter& d) {
                   dig(d, {2});
                   d.reports.push_back("    2    0    7    9    1    1        0.        0.        0.");
                 },
                 "warning: stage 2: no element that is active then has a node of this report"},
        Unlikely{"GravityHuge", [](DeckWriter& d) { d.stages[0].gravity_y = -2000.0; },
                 "gravity is 2000 times the unit weights"},
        Unlikely{"PressureHuge", [](DeckWriter& d) { d.stages[0].pressure(4, 3, 2e4, 0.0); },
                 "warning: the pressure or shear 2e+04 exceeds the largest modulus"},
        Unlikely{"Suction", [](DeckWriter& d) { d.stages[0].pressure(4, 3, -5.0, -5.0); },
                 "note: a negative pressure pulls at the edge"},
        Unlikely{"PressureOnOneSideOfAJoint",
                 [](DeckWriter& d) {
                   d.node(10, 0.0, 2.0);
                   d.node(11, 1.0, 2.0);
                   d.material(2, 21, {1e4, 1e4});
                   d.group(2, 11, 0, 2);
                   d.element(5, 2, {7, 8, 11, 10});
                   d.stages[0].pressure(5, 1, 5.0, 5.0);
                 },
                 "note: the pressure acts on one side of an interface alone, towards the joint"},
        Unlikely{"ForceHuge", [](DeckWriter& d) { d.stages[0].load(9, 0.0, -1e6); },
                 "would strain the whole mesh by more than 1"},
        Unlikely{"DisplacementHuge", [](DeckWriter& d) { d.stages[0].fix(9, 0, 1, 0.0, -50.0); },
                 "warning: the displacement -50 is larger than the mesh, 2"},
        Unlikely{"ReleasedTwice", [](DeckWriter& d) { d.stages[0].fix(9, -1, 0); },
                 "note: code -1 releases node 9 in x, which nothing held"},
        Unlikely{"LoadOnNothing",
                 [](DeckWriter& d) {
                   place_later(d);
                   d.stages[0].load(10, 0.0, -1.0);
                 },
                 "warning: the load of node 10 of stage 1 does nothing: no element that is active then has the "
                 "node"},
        Unlikely{"DisplacementOfNothing",
                 [](DeckWriter& d) {
                   place_later(d);
                   d.stages[0].fix(11, 0, 1, 0.0, -0.01);
                 },
                 "warning: the displacement of node 11 of stage 1 does nothing"},
        Unlikely{"PressureOnNothing",
                 [](DeckWriter& d) {
                   place_later(d);
                   d.stages[0].pressure(5, 3, 1.0, 1.0);
                 },
                 "warning: the pressure on element 5 of stage 1 does nothing: its group is not active then"},
        Unlikely{"TwoDisplacements",
                 [](DeckWriter& d) {
                   d.stages[0].fix(9, 0, 1, 0.0, -0.02);
                   d.stages[0].fix(9, 0, 1, 0.0, -0.01);
                 },
                 "warning: stage 1: node 9 is given two displacements in y: -0.02 by line 26, -0.01 here; the "
                 "last card stands"},
        Unlikely{"HeldAndReleased",
                 [](DeckWriter& d) {
                   d.stages[0].fix(9, 0, 1, 0.0, -0.02);
                   d.stages[0].fix(9, 0, -1);
                 },
                 "warning: stage 1: node 9 is released in y here but held by line 26 of the same stage; the "
                 "last card"},
        Unlikely{"DeathTwiceInAStage",
                 [](DeckWriter& d) {
                   dig(d, {2, 2});
                 },
                 "note: group 2 is listed twice among the deaths of this stage"},
        Unlikely{"DeathTwice",
                 [](DeckWriter& d) {
                   dig(d, {2});
                   dig(d, {2});
                 },
                 "note: group 2 is removed again: it is gone since stage 2"},
        Unlikely{"FixityOfNothing", [](DeckWriter& d) { d.stages[0].fix(9, 0, 0); },
                 "note: this fixity card changes nothing"},
        Unlikely{"NullStage", [](DeckWriter& d) { d.stage(); }, "note: stage 2 adds nothing"},
        Unlikely{"KZero",
                 [](DeckWriter& d) {
                   d.initials.clear();
                   d.initial(1, 1, 2.0, 20.0, 50.0, 0.0);
                 },
                 "the coefficient of earth pressure at rest is 50"},
        Unlikely{"GroundLevel",
                 [](DeckWriter& d) {
                   d.initials.clear();
                   d.initial(1, 1, 200.0, 20.0, 0.5, 0.0);
                 },
                 "the ground level of the initial stress, 200, is far from the mesh, 0 to 2"},
        Unlikely{"InitialTension",
                 [](DeckWriter& d) {
                   d.initials.clear();
                   d.initial(1, 0, 1.0, -1.0, 1.0, 0.0);
                 },
                 "note: group 1: value 2 of the initial stress is tension"},
        Unlikely{"Slender", [](DeckWriter& d) { d.nodes[2] = "    3    0    0      1.E6        0."; },
                 "more than 10000 times as long as wide"},
        Unlikely{"Overlap", [](DeckWriter& d) { lay_over(d, false); },
                 "warning: elements 1 and 9 lie on the same side of a common edge: they overlap"},
        Unlikely{"InnerEdge", [](DeckWriter& d) { d.stages[0].pressure(1, 3, 5.0, 5.0); },
                 "warning: the pressure acts on an edge inside the body, which two elements share"},
        Unlikely{"MissingNumbers",
                 [](DeckWriter& d) {
                   d.elements = {"    1    1    1    2    5    4                        2    1",
                                 "    7    1    4    5    8    7                        2    1"};
                   d.stages[0].pressures.clear();
                 },
                 "note: the element numbers are not consecutive: after 2 comes 7"},
        Unlikely{"StepWithoutLast",
                 [](DeckWriter& d) { d.fixities.push_back("    1         1    1    1        0.        0."); },
                 "note: a step is given but no last: only 1 is meant"},
        Unlikely{"LastWithoutStep",
                 [](DeckWriter& d) { d.fixities.push_back("    1    3         1    1        0.        0."); },
                 "note: the step is left blank, which reads as 1: all from 1 to 3"},
        Unlikely{"InitialBlank",
                 [](DeckWriter& d) { d.initials = {"    1    0        1.                  1."}; },
                 "note: left blank on this initial stress card, which reads as 0: value 2"},
        Unlikely{"NodeBlank", [](DeckWriter& d) { d.nodes[3] = "    4    0    0                  1."; },
                 "note: left blank, which reads as 0 (node card, x or radius, length)"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace sage::test
