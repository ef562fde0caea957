// Models from arrays are those of decks: the same fingerprint as the deck that is written of them and as one that the
// deck writer makes, the same answers, and a deck's messages with the line of what is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sage/app/commands.hpp"
#include "sage/builder/model_input.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/fingerprint.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

const Catalogue& everything() {
  static const Catalogue catalogue = app::full_catalogue();
  return catalogue;
}

// Two by two elements of side 1 on a smooth base between smooth sides.
ModelInput block() {
  ModelInput input{.title = "block", .units = {"m", "kN", "kPa", 101.325, 9.81}};
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 2; ++i) input.nodes.emplace_back(i, j);
  input.materials = {{"linear_elastic", {{"youngs_modulus", 1000.0}, {"poissons_ratio", 0.3}}, 20.0, "soft"},
                     {"drucker_prager",
                      {{"youngs_modulus", 5000.0},
                       {"poissons_ratio", 0.25},
                       {"cohesion", 10.0},
                       {"friction_angle", 30.0},
                       {"cone", 3.0}},
                      18.0,
                      "cone"}};
  input.groups = {{.element = "quad4", .material = 1, .elements = {{1, 2, 5, 4}, {2, 3, 6, 5}}},
                  {.element = "quad4",
                   .material = 2,
                   .elements = {{4, 5, 8, 7}, {5, 6, 9, 8}},
                   .formulation = "b-bar",
                   .name = "upper"}};
  input.supports = {{.nodes = {1, 4, 7, 3, 6, 9}, .x = FixityCode::fixed},
                    {.nodes = {1, 2, 3}, .y = FixityCode::fixed}};
  input.initials = {{1, InitialKind::geostatic, {2.0, 19.0, 0.5}},
                    {2, InitialKind::uniform, {5.0, 10.0, 5.0, 0.0}}};
  StageInput weight{.title = "weight", .increments = 2, .gravity = {0.0, -1.0}};
  StageInput load{.title = "load", .increments = 3, .tolerance = 1e-9};
  load.supports = {{.nodes = {7, 9}, .x = FixityCode::released}};
  load.loads = {{.nodes = {8}, .x = 0.5, .y = -1.0}};
  load.pressures = {{.elements = {3, 4}, .edge = 3, .normal1 = 30.0, .normal2 = 20.0, .shear1 = 1.0}};
  input.stages = {weight, load};
  input.reports = {{.kind = ReportKind::nodes, .nodes = {7, 8, 9}, .stage = 2},
                   {.kind = ReportKind::point, .group = 2, .place = {0.5, 1.5}, .name = "within"}};
  return input;
}

Model model_of_text(const std::string& text) {
  return build_model(read_deck_text(text, "written", load_layout("sage1")), everything());
}

std::string refusal(const ModelInput& input) {
  try {
    build_model(input, everything());
  } catch (const InputError& e) {
    std::string all;
    for (const Diagnostic& d : e.diagnostics().list()) all += to_string(d) + "\n";
    return all;
  }
  return "taken";
}

TEST(ModelInput, IsTheModelOfTheDeckThatIsWrittenOfIt) {
  const Model model = build_model(block(), everything());
  Diagnostics notes;
  const Model again = model_of_text(sage1_text(model, notes));
  EXPECT_EQ(notes.warnings(), 0);
  EXPECT_EQ(fingerprint(model), fingerprint(again));
}

TEST(ModelInput, EveryPartOfItReachesTheModel) {
  const auto print = [](const auto& change) {
    ModelInput input = block();
    change(input);
    return fingerprint(build_model(input, everything()));
  };
  const std::uint64_t plain = print([](ModelInput&) {});
  EXPECT_EQ(plain, print([](ModelInput& i) { i.name = "other"; })) << "names no file";
  EXPECT_NE(plain, print([](ModelInput& i) { i.title = "other"; }));
  const auto off_the_axis = [](ModelInput& i) {
    for (Vector2& x : i.nodes) x.x() += 1.0;
    for (ReportInput& report : i.reports) report.place.x() += 1.0;
  };
  EXPECT_NE(print(off_the_axis), print([&](ModelInput& i) {
              off_the_axis(i);
              i.geometry = Geometry::axisymmetric;
            }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.units.stress = "psi"; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.nodes[4].x() = 1.1; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.materials[1].parameters["cone"] = 1.0; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.materials[0].unit_weight = 21.0; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.groups[1].formulation = "full"; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.supports[1].x = FixityCode::fixed; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.initials[0].values[2] = 0.6; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[0].gravity.x() = 0.1; }));
  const auto held = [](double value) {
    return [value](ModelInput& i) {
      i.stages[1].supports[0].y = FixityCode::fixed;
      i.stages[1].supports[0].y_value = value;
    };
  };
  EXPECT_NE(print(held(0.1)), print(held(0.2)));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[1].loads[0].x = 0.6; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[1].pressures[0].shear2 = 0.6; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[1].duration = 2.0; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[1].method = Method::modified_newton; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[1].births = {2}; }));
  EXPECT_NE(plain, print([](ModelInput& i) { i.stages[1].deaths = {2}; }));
}

// The deck writer goes through cards of ten columns and the reader; only what the cards say can be equal.
TEST(ModelInput, IsTheModelOfTheDeckWriter) {
  DeckWriter deck(2);
  for (int i = 0; i < 4; ++i) deck.node(i + 1, 1.0 + i % 2, i / 2);
  deck.material(1, 1, {1000.0, 0.3}, 20.0);
  deck.group(1, 1, 1, 1);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.fix(1, 0, 1);
  deck.fix(2, 0, 1);
  StageCards& stage = deck.stage(2);
  stage.fix(3, 1, 0, 0.25, 0.0);
  stage.pressure(1, 2, 50.0, 60.0);
  const Model written = model_of_text(deck.text());

  ModelInput input{.title = written.title, .geometry = Geometry::axisymmetric, .units = written.units};
  for (int i = 0; i < 4; ++i) input.nodes.emplace_back(1.0 + i % 2, i / 2);
  input.materials = {{"linear_elastic", {{"youngs_modulus", 1000.0}, {"poissons_ratio", 0.3}}, 20.0}};
  input.materials[0].name = written.materials[0].name;
  input.groups = {{.element = "quad4", .elements = {{1, 2, 4, 3}}, .formulation = "full"}};
  input.groups[0].name = written.groups[0].name;
  input.supports = {{.nodes = {1, 2}, .y = FixityCode::fixed}};
  StageInput press{.title = written.stages[0].title, .increments = 2};
  press.supports = {{.nodes = {3}, .x = FixityCode::fixed, .x_value = 0.25}};
  press.pressures = {{.elements = {1}, .edge = 2, .normal1 = 50.0, .normal2 = 60.0}};
  input.stages = {press};
  EXPECT_EQ(fingerprint(build_model(input, everything())), fingerprint(written));
}

TEST(ModelInput, NamesThatTheCatalogueLacksAreAllReportedWithThoseItHas) {
  ModelInput input = block();
  input.solver = "abacus";
  input.materials[0].law = "clay";
  input.materials[1].parameters["friction"] = 30.0;
  input.groups[0].element = "quad5";
  input.groups[1].formulation = "c-bar";
  input.initials[0].values.assign(7, 1.0);
  const std::string text = refusal(input);
  for (const char* words :
       {"the solver 'abacus' is unknown; known: ", "material 1: the law 'clay' is unknown; known: ",
        "material 2: parameter 'friction' of drucker_prager is unknown; known: youngs_modulus, ",
        "group 1: the element 'quad5' is unknown; known: ",
        "group 2: the formulation 'c-bar' of quad4 is unknown; known: b-bar, full",
        "group 1: 7 initial values, at most 6 are possible"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

TEST(ModelInput, MistakesAreShownOnTheirLine) {
  ModelInput input = block();
  input.groups[0].elements[1][2] = 99;
  EXPECT_NE(refusal(input).find("element  number 2  group 1  n1 2  n2 3  n3 99  n4 5"), std::string::npos)
      << refusal(input);
  EXPECT_NE(refusal(input).find("node 99"), std::string::npos);
  input = block();
  input.materials[0].parameters.erase("poissons_ratio");
  EXPECT_NE(refusal(input).find("poissons_ratio (-), is missing"), std::string::npos) << refusal(input);
  input = block();
  input.nodes[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(input).find("node  number 4  x 0  y nan"), std::string::npos) << refusal(input);
  input = block();
  input.title = "two\nlines";
  EXPECT_EQ(refusal(input), "taken");
  EXPECT_NE(refusal(ModelInput{}).find("the deck defines no nodes"), std::string::npos)
      << refusal(ModelInput{});
}

TEST(ModelInput, LargeListsAndStrangeNumbersAreRefused) {
  ModelInput input = block();
  input.groups[0].elements[0] = std::vector<int>(70000, 1);
  EXPECT_NE(refusal(input), "taken");
  input = block();
  input.groups[0].elements[0].clear();
  EXPECT_NE(refusal(input), "taken");
  input = block();
  input.stages[1].pressures[0].elements = {-5};
  EXPECT_NE(refusal(input), "taken");
  input = block();
  input.stages[1].increments = -1;
  EXPECT_NE(refusal(input), "taken");
  input = block();
  input.stages[1].births = {77};
  EXPECT_NE(refusal(input), "taken");
}

}  // namespace
}  // namespace sage::test
