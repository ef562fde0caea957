// Point reports from cards and options, in files, with as many digits as asked.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/converge.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "tests/studies/scenes/lame.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

namespace fs = std::filesystem;

const std::string kPointCards =
    "    3    0    0    0    0    1\n"
    "      1.37      0.11inner third\n"
    "    3    1    0    0    0    1\n"
    "        2.        0.\n";

// Lame's cylinder with cards behind its stage.
std::string cylinder(const std::string& cards, int reports) {
  std::string text = scenes::LameDeck{}.text();
  std::istringstream lines(text);
  std::string result, line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (number == 3) line = line.substr(0, 50) + "    " + std::to_string(reports);
    result += (line == "END" ? cards : "") + line + "\n";
  }
  return result;
}

RunRequest request_for(const std::string& name, const std::string& text) {
  const fs::path folder = test::scratch_folder("points_app");
  std::ofstream(folder / (name + ".dat")) << text;
  RunRequest request;
  request.deck = (folder / (name + ".dat")).string();
  request.quiet = true;
  request.output.folder = folder;
  return request;
}

std::string contents(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> last_cells(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line, last;
  while (std::getline(lines, line))
    if (!line.empty() && line[0] != '#') last = line;
  std::vector<std::string> cells;
  std::istringstream parts(last);
  for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST(PointCards, AreReadWithNameAndPlace) {
  const RunRequest request = request_for("cards", cylinder(kPointCards, 2));
  const RunOutcome outcome = run_deck(request, full_catalogue());
  ASSERT_EQ(outcome.exit_code, kOk);
  ASSERT_EQ(outcome.model->reports.size(), 2u);
  EXPECT_EQ(outcome.model->reports[0].name, "inner third");
  EXPECT_EQ(outcome.model->reports[0].place, Vector2(1.37, 0.11));
  EXPECT_EQ(outcome.model->reports[1].group, 0);
  EXPECT_NEAR(outcome.reports->points(0).back().stress[0],
              -scenes::lame(scenes::LameBody::strip, 0.3, 1.37).radial, 2e-3);
  const std::string csv = contents(request.output.folder / "cards.report1.csv");
  EXPECT_NE(csv.find("report 1, inner third at (1.37; 0.11)"), std::string::npos) << csv;
  EXPECT_NE(csv.find("stage,increment,ux[m],uy[m],strain_xx[-]"), std::string::npos);
  EXPECT_NE(csv.find("deviator[kPa]\n"), std::string::npos);
  const std::string screen =
      summary(*outcome.model, outcome.record, outcome.reports.get(), outcome.files, nullptr, 0);
  EXPECT_NE(screen.find("inner third (1.37; 0.11)"), std::string::npos) << screen;
  EXPECT_NE(contents(request.output.folder / "cards.lst").find("REPORT 1: POINT inner third (1.37; 0.11)"),
            std::string::npos);
}

// A first node on the card of a point report looks as if it gave the place: the point card does.
TEST(PointCards, FieldsThatAPointDoesNotUseAreNoted) {
  const auto notes = [](const std::string& first_node) {
    const std::string cards = "    3    0" + first_node + "    0    0    1\n      1.37      0.11inner third\n";
    const Model model =
        build_model(read_input(request_for("unused", cylinder(cards, 1)).deck, {}), full_catalogue());
    int found = 0;
    for (const Diagnostic& d : model.diagnostics.list())
      found += d.message.find("of this card it does not use: first node") != std::string::npos ? 1 : 0;
    return found;
  };
  EXPECT_EQ(notes("    1"), 1);
  EXPECT_EQ(notes("    0"), 0);
}

// What convert writes says the same.
TEST(PointCards, SurviveConversion) {
  const RunRequest request = request_for("convert", cylinder(kPointCards, 2));
  const Catalogue catalogue = full_catalogue();
  const Model model = build_model(read_input(request.deck, {}), catalogue, {});
  Diagnostics printed;
  const Model again =
      build_model(read_deck_text(sage1_text(model, printed), "again", load_layout("sage1")), catalogue, {});
  ASSERT_EQ(again.reports.size(), 2u);
  EXPECT_EQ(again.reports[0].place, model.reports[0].place);
  EXPECT_EQ(again.reports[0].name, "inner third");
  EXPECT_EQ(again.reports[1].group, 0);
}

// --converge goes on until displacement and stress of the point are certain; Lame knows them.
TEST(PointCards, ConvergeFollowsThem) {
  const std::string card = "    3    0    0    0    0    1\n      1.37      0.11\n";
  const RunRequest request = request_for("converged", cylinder(card, 1));
  ConvergeOptions options;
  options.tolerance = 1e-6;
  ASSERT_EQ(converge(request, options, full_catalogue()), kOk);
  const std::string table = contents(request.output.folder / "converged.convergence.csv");
  for (const auto& [name, exact] :
       {std::pair{"report1.ux ", scenes::lame(scenes::LameBody::strip, 0.3, 1.37).u},
        {"report1.stress_xx ", -scenes::lame(scenes::LameBody::strip, 0.3, 1.37).radial},
        {"report1.stress_zz ", -scenes::lame(scenes::LameBody::strip, 0.3, 1.37).hoop}}) {
    const std::size_t at = table.rfind(name);
    ASSERT_NE(at, std::string::npos) << table;
    const double value = std::strtod(table.c_str() + at + std::string(name).size(), nullptr);
    EXPECT_NEAR(value, exact, 2e-6 * std::abs(exact)) << name;
  }
}

// A block on another is taken away in stage 2, with what pressed it: the point in it has no value at the end.
std::string excavation() {
  scenes::DeckWriter deck(1);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 2; ++i) deck.node(1 + i + 2 * j, i, j);
  deck.material(1, 1, {1000.0, 0.0});
  deck.group(1, 1, 2, 1);
  deck.group(2, 1, 2, 1);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.element(2, 2, {3, 4, 6, 5});
  for (int n = 1; n <= 6; ++n) deck.fix(n, 1, n <= 2 ? 1 : 0);
  deck.stage().pressure(2, 3, 20.0, 20.0);
  scenes::StageCards& second = deck.stage(2);
  second.deaths = {2};
  second.pressure(1, 3, 50.0, 50.0);
  return deck.text();
}

TEST(PointCards, ConvergeNamesThoseWithoutAValueAtTheEnd) {
  RunRequest request = request_for("excavated", excavation());
  request.input.build.points = {{{0.5, 0.5}, "", 0}, {{0.5, 1.5}, "", 0}};
  ConvergeOptions options;
  options.tolerance = 1e-6;
  const std::string why = "group 2, which holds the point (0.5; 1.5), is removed in stage 2";
  EXPECT_EQ(converge(request, options, full_catalogue()), kOk);
  const std::string table = contents(request.output.folder / "excavated.convergence.csv");
  EXPECT_NE(table.find("# left out  report2: no value at the end of the run: " + why), std::string::npos)
      << table;
  EXPECT_EQ(table.find("left out  report1: no value"), std::string::npos) << table;
  const auto refusal = [&] {
    try {
      converge(request, options, full_catalogue());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  options.follow = {"report2.stress_yy"};
  EXPECT_NE(refusal().find("--follow report2.stress_yy: it has no value at the end of the run: " + why),
            std::string::npos)
      << refusal();
  options.follow = {"report1.stress_yy"};
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(contents(request.output.folder / "excavated.convergence.csv").find("left out"), std::string::npos);
  options.follow.clear();
  request.input.build.points.erase(request.input.build.points.begin());
  EXPECT_NE(refusal().find("report1: no value at the end of the run: " + why), std::string::npos) << refusal();
}

std::string refusal_of(const std::string& text, const BuildOptions& build) {
  RunRequest request = request_for("refused", text);
  request.input.build = build;
  try {
    run_deck(request, full_catalogue());
  } catch (const InputError& error) {
    return to_string(error.diagnostics().list().back());
  }
  return "";
}

TEST(PointCards, OutsideTheMeshIsAnError) {
  const std::string deck = cylinder("", 0);
  BuildOptions build;
  build.points.push_back({{0.99, 0.1}, "", 0});
  EXPECT_NE(refusal_of(deck, build).find("the point (0.99; 0.1) lies outside the mesh"), std::string::npos);
  build.points[0] = {{1.5, 0.1}, "", 7};
  EXPECT_NE(refusal_of(deck, build).find("group 7"), std::string::npos);
  build.points[0] = {{1.0, 0.1}, "", 0};  // on the face
  EXPECT_EQ(refusal_of(deck, build), "");
  const std::string card = "    3    0    0    0    0    1\n       2.1      0.11\n";
  const std::string message = refusal_of(cylinder(card, 1), {});
  EXPECT_NE(message.find("the point (2.1; 0.11) lies outside the mesh: no solid element holds it"),
            std::string::npos)
      << message;
}

// A ring sector of two 8-node squares with curved sides, pressed from inside.
std::string curved_ring() {
  scenes::DeckWriter deck(1);
  scenes::Block block{1, 2, scenes::Cell::quad8, 1, 1, scenes::rectangle(1.0, 2.0, 0.0, 90.0)};
  block.polar = true;
  block.write_nodes(deck);
  deck.material(1, 1, {1.0, 0.3});
  deck.group(1, static_cast<int>(block.cell), 0, 1);
  block.write_elements(deck, 1);
  for (int n : block.bottom()) deck.fix(n, 0, 1);
  for (int n : block.top()) deck.fix(n, 1, 0);
  scenes::StageCards& stage = deck.stage();
  for (int j = 0; j < 2; ++j) stage.pressure(block.element(0, j), 4, 1.0, 1.0);
  return deck.text();
}

// Places within 1e-6 of an element outside its sides, straight and curved: every mesh that is made of the
// deck's holds them, and their displacement is that of the place on the side.
TEST(PointCards, APlaceOnAnEdgeStaysOnItInFinerMeshes) {
  const double s = std::sqrt(0.5), m = std::cos(22.5 * kRadiansPerDegree),
               h = std::sin(22.5 * kRadiansPerDegree);
  const auto on_curve = [&](double t) {  // the parabola through three nodes of the inner side, t from 0 to 1
    const double a = (1 - t) * (1 - 2 * t), b = 4 * t * (1 - t), c = t * (2 * t - 1);
    return Vector2(a + b * m + c * s, b * h + c * s);
  };
  RunRequest request = request_for("curved", curved_ring());
  for (const double t : {0.0, 0.3, 0.83, 1.0}) {
    const Vector2 edge = on_curve(t), outside = edge - 4e-7 * edge.normalized();
    std::vector<Vector2> moved;
    for (const int refine : {0, 1, 3, 5})
      for (const int layers : {0, 2, 12}) {
        if (test::kSanitized && refine + layers > 5) continue;
        BuildOptions build;
        build.refine = refine;
        if (layers > 0) build.gradings.push_back({1, layers, 0.15});  // node 1 is (1; 0)
        if (refine == 3) build.element = 9;                           // 81 nodes
        if (refine == 5 && layers > 0) continue;
        for (const Vector2& place : {outside, edge}) build.points.push_back({place, "", 0});
        request.input.build = build;
        SCOPED_TRACE(std::to_string(t) + ", refined " + std::to_string(refine) + ", layers " +
                     std::to_string(layers));
        const RunOutcome outcome = run_deck(request, full_catalogue());
        ASSERT_EQ(outcome.exit_code, kOk);
        const PointRow &out = outcome.reports->points(0).back(), &on = outcome.reports->points(1).back();
        for (int c : {0, 1}) EXPECT_NEAR(out.displacement[c], on.displacement[c], 4e-6);
      }
  }
}

// No further than that: a place beyond it is outside, on every mesh.
TEST(PointCards, APlaceBeyondTheReachIsOutside) {
  for (const int refine : {0, 4}) {
    BuildOptions build;
    build.refine = refine;
    build.points.push_back({{0.99999, 0.0}, "", 0});
    EXPECT_NE(refusal_of(curved_ring(), build).find("lies outside the mesh"), std::string::npos) << refine;
  }
}

TEST(PointOption, TakesPlaceNameAndGroup) {
  const PointRequest point = point_from("-1.5e-1,2:toe:3");
  EXPECT_EQ(point.place, Vector2(-0.15, 2.0));
  EXPECT_EQ(point.name, "toe");
  EXPECT_EQ(point.group, 3);
  EXPECT_EQ(point_from("1,2").name, "");
  for (const char* bad : {"", "1", "1,2,3", "a,b", "1,nan", "1,inf", "1,2:n:x", "1, "})
    EXPECT_THROW(point_from(bad), std::invalid_argument) << bad;
}

// 17 digits give back every bit, 16 all but the last; ten as ever without the option.
TEST(Digits, AsManyAsAsked) {
  for (int digits : {0, 3, 16, 17}) {
    RunRequest request = request_for("digits", cylinder("", 0));
    request.output.digits = digits;
    request.output.nodes = request.output.points = true;
    request.input.build.points.push_back({{1.37, 0.11}, "", 0});
    const RunOutcome outcome = run_deck(request, full_catalogue());
    const PointRow& row = outcome.reports->points(0).back();
    const std::vector<std::string> cells = last_cells(contents(request.output.folder / "digits.report1.csv"));
    ASSERT_EQ(cells.size(), 14u);
    const double read = std::strtod(cells[8].c_str(), nullptr);
    if (digits == 17)
      EXPECT_EQ(read, row.stress[0]);
    else
      EXPECT_NEAR(read, row.stress[0],
                  0.51 * std::pow(10.0, -(digits > 0 ? digits : 10)) * 10 * std::abs(row.stress[0]));
    std::size_t most = 0;  // of the points' and nodes' files too
    for (const char* file : {"digits.report1.csv", "digits.points.csv", "digits.nodes.csv"})
      for (const std::string& cell : last_cells(contents(request.output.folder / file))) {
        std::size_t count = 0;
        bool begun = false;
        for (char c : cell.substr(0, cell.find('e'))) {
          begun = begun || (c >= '1' && c <= '9');
          count += begun && std::isdigit(static_cast<unsigned char>(c)) ? 1 : 0;
        }
        most = std::max(most, count);
      }
    EXPECT_LE(most, static_cast<std::size_t>(digits > 0 ? digits : 10));
    EXPECT_GE(most, static_cast<std::size_t>(digits > 0 ? digits : 10) - 1);
    const std::string screen =
        summary(*outcome.model, outcome.record, outcome.reports.get(), outcome.files, nullptr, digits);
    char sixteen[40];
    std::snprintf(sixteen, sizeof sixteen, "%.16g", row.stress[0]);
    const bool found = screen.find(sixteen) != std::string::npos;
    EXPECT_TRUE(digits == 17 || found == (digits == 16)) << screen;
  }
}

}  // namespace
}  // namespace sage::app
