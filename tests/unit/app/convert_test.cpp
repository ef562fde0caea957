// Decks into decks, Gmsh meshes and CalculiX input, and back.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/exchange/mesh_model.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

namespace fs = std::filesystem;
using scenes::DeckWriter;
using scenes::StageCards;

const std::string kInputs = SAGE_SOURCE_DIR "/legacy_inputs/";

fs::path scratch() {
  return test::scratch_folder("convert");
}

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string write(const std::string& name, const std::string& text) {
  const fs::path path = scratch() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

Model model_of(const std::string& path, const std::string& layout = "") {
  InputOptions input;
  input.layout = layout;
  return build_model(read_input(path, input), full_catalogue());
}

// Displacements and reactions with all their digits.
std::string results(const std::string& deck) {
  RunRequest request;
  request.deck = deck;
  request.quiet = true;
  request.output.folder = scratch() / "out";
  request.output.nodes = true;
  request.output.points = true;
  const RunOutcome outcome = run_deck(request, full_catalogue());
  EXPECT_EQ(outcome.exit_code, 0);
  std::string all;
  for (const char* kind : {".nodes.csv", ".points.csv"}) {
    const fs::path path = request.output.folder / (case_name(deck) + kind);
    EXPECT_TRUE(fs::exists(path));
    all += read(path);
  }
  return all;
}

// Two stages, two laws, all kinds of loads; every number fits ten columns.
const char* const kDeck = R"(Strip on a layer
* length force   stress         p_a   gamma_w
m       kN      kPa        101.325      9.81
* geom solv node fill matl grup elem fixi init stag rept nnod nele
    1    0    4    1    2    2    2    3    1    2    1   15    8
    1    0    0       0.0       0.0
    3    1    0       1.0       0.0
   13    0    0       0.0       2.0
   15    1    0       1.0       2.0
    1    2    1    4    3
    1    1    2      18.5 clay
    20000.      0.30
    2    4    5      19.0 sand
    30000.      0.25       5.0       32.        2.
    1    1    2    1 lower
    2    1    1    2 upper
    1    1    1    2    5    4                        2    2    1    3
    5    2    7    8   11   10                        2    2    1    3
    1   13    3    1    0
    3   15    3    1    0
    1    3    1    0    1
    1    0        5.       10.        5.        0.
Weight
    1    0    0    0    0    0    0    0    0    0       0.0      -1.0       0.0
Load
    4    0   25    1    1    1    2    0    0    0       0.0       0.0    1.0E-9
   15    0    1    0    1       0.0   -0.0015
   14    0    19.765625-4      -1.5
    7    3    8    1      10.0      20.0       0.5       0.0
    5    4    7    2       1.0       1.0
    2    0   13   15    1    1
END
)";

// As a FORMAT reads it: 1.5-7 is 1.5E-7.
double value_of(std::string text) {
  const std::size_t sign = text.find_first_of("+-", 1);
  if (sign != std::string::npos && text[sign - 1] != 'E') text.insert(sign, "E");
  return std::strtod(text.c_str(), nullptr);
}

TEST(FieldText, ReadsBackExactlyOrSaysNot) {
  for (double value :
       {0.0, 1.0, -0.05, 0.125, 101.325, 2.0e5, 1.5e-7, -1e-12, 3.0e18, 99999999.0, 1.0 / 1024}) {
    const FieldText field = field_text(value, 10);
    EXPECT_TRUE(field.exact) << value;
    EXPECT_EQ(value_of(field.text), value) << field.text;
    EXPECT_LE(field.text.size(), 10u);
    EXPECT_NE(field.text.find('.'), std::string::npos)
        << "a FORMAT would put the point elsewhere: " << field.text;
  }
  for (double value : {1.0 / 3.0, -1.0 / 3.0, -2.0e-5 / 3.0, 1.23456789012e-205, 123456789012.5}) {
    const FieldText field = field_text(value, 10);
    EXPECT_FALSE(field.exact) << value;
    EXPECT_LE(field.text.size(), 10u);
    EXPECT_NEAR(value_of(field.text) / value, 1.0, 1.01 * field.change) << field.text;
  }
  EXPECT_EQ(field_text(-1.0 / 3.0, 10).text, "-.33333333");
  EXPECT_NEAR(field_text(-1.0 / 3.0, 10).change, 1e-8, 1e-12);
  EXPECT_EQ(field_text(1.0 / 1024, 10).text, "9.765625-4");
}

TEST(Convert, DeckToDeckGivesTheSameResultsBitForBit) {
  const std::string first = write("strip.dat", kDeck);
  Model model = model_of(first);
  const std::string text = sage1_text(model, model.diagnostics);
  EXPECT_EQ(model.diagnostics.warnings(), 1);  // 4-node elements with a dilation angle (S355)
  const std::string before = results(first);
  const std::string second = write("strip.dat", text);
  EXPECT_EQ(results(second), before);
  Model again = model_of(second);
  EXPECT_EQ(sage1_text(again, again.diagnostics), text);
}

// Text to text: every number of the narrow deck stands in the wide one, and comes back.
TEST(Convert, NarrowToWideToNarrowIsTheSameDeck) {
  for (const std::string& deck :
       {write("strip.dat", kDeck), kInputs + "chapter7/dp_285/deck.dat", kInputs + "quad4m/MDL.Q4I"}) {
    SCOPED_TRACE(deck);
    Model model = model_of(deck);
    Model as_written = model_of(write("narrow.dat", sage1_text(model, model.diagnostics)));
    const std::string narrow = sage1_text(as_written, as_written.diagnostics);  // its numbers fit ten columns
    const std::string wide = sage1_text(as_written, as_written.diagnostics, FieldWidth::wide);
    EXPECT_TRUE(wide.starts_with("* layout: sage1_wide\n"));
    Model back = model_of(write("wide.dat", wide));
    EXPECT_EQ(sage1_text(back, back.diagnostics), narrow);
    EXPECT_EQ(sage1_text(back, back.diagnostics, FieldWidth::wide), wide);
  }
}

// Five columns end at 99 999.
TEST(Convert, WideFieldsWhereANumberNeedsThem) {
  Model model = model_of(write("strip.dat", kDeck));
  for (int& number : model.mesh.number) number += 99'999 - model.mesh.number.back();
  EXPECT_FALSE(sage1_text(model, model.diagnostics).starts_with("*"));
  for (int& number : model.mesh.number) number += 1;
  const std::string text = sage1_text(model, model.diagnostics);
  EXPECT_TRUE(text.starts_with("* layout: sage1_wide\n"));
  Model back = model_of(write("wide.dat", text));
  EXPECT_EQ(back.mesh.number, model.mesh.number);
  EXPECT_EQ(back.mesh.x, model.mesh.x);
  EXPECT_EQ(sage1_text(back, back.diagnostics), text);
}

// Ten columns lose digits of this deck's numbers (below); twenty don't.
TEST(Convert, WideFieldsHoldEveryDigit) {
  Model model = model_of(kInputs + "smith_griffiths/p51_5.dat");
  const int before = model.diagnostics.warnings();
  const std::string text = sage1_text(model, model.diagnostics, FieldWidth::wide);
  EXPECT_EQ(model.diagnostics.warnings(), before);
  EXPECT_EQ(model_of(write("wide.dat", text)).mesh.x, model.mesh.x);
}

TEST(Convert, TellsTheLargestChangeOfNumbersThatDoNotFit) {
  Model model = model_of(kInputs + "smith_griffiths/p51_5.dat");
  const std::string text = sage1_text(model, model.diagnostics, FieldWidth::narrow);
  ASSERT_EQ(model.diagnostics.warnings(), 1);
  EXPECT_NE(model.diagnostics.list().back().message.find("3 number(s) need more digits"), std::string::npos)
      << model.diagnostics.list().back().message;
  EXPECT_NO_THROW(model_of(write("p51_5.dat", text)));
}

TEST(Convert, ElementsThatNoCardHoldsAreRefused) {
  Model model = model_of(kInputs + "chapter7/pinned_ld1_nu025_accurate/deck.dat");
  EXPECT_NO_THROW(sage1_text(model, model.diagnostics)) << "49 nodes, of which the card gives 4";
  model.mesh.made_between = 0;  // as if a mesher had placed all of them
  EXPECT_THROW(sage1_text(model, model.diagnostics), InputError);
}

TEST(Convert, DeckToGmshToDeckKeepsTheMesh) {
  for (const std::string& deck : {write("strip.dat", kDeck), kInputs + "smith_griffiths/p51_5.dat",
                                  kInputs + "smith_griffiths/p51_2.dat", kInputs + "quad4m/MDL.Q4I"}) {
    Model model = model_of(deck);
    const std::string msh = msh_text(model, model.diagnostics);
    const Model back = model_from_mesh(msh, "mesh.msh", full_catalogue(), {});
    EXPECT_EQ(back.mesh.number, model.mesh.number);
    EXPECT_EQ(back.mesh.x, model.mesh.x);
    ASSERT_EQ(back.groups.size(), model.groups.size());
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      EXPECT_EQ(back.groups[g].nodes, model.groups[g].nodes);
      EXPECT_EQ(back.groups[g].element_numbers, model.groups[g].element_numbers);
      EXPECT_EQ(back.groups[g].element_code, model.groups[g].element_code);
    }
    EXPECT_FALSE(back.fixities.empty());
  }
}

// Both sides of interfaces, their numbers and order of nodes; groups and places as they were.
TEST(Convert, DeckToGmshToDeckKeepsInterfaces) {
  for (const char* element : {"", "quad8"}) {
    SCOPED_TRACE(element);
    const std::string deck = kInputs + "chapter7/friction_285_nu0495/deck.dat";
    BuildOptions options;
    if (*element != '\0') options.element = full_catalogue().elements.code_of(element);
    Model model = build_model(read_input(deck, {}), full_catalogue(), options);
    const Model back = model_from_mesh(msh_text(model, model.diagnostics), "mesh.msh", full_catalogue(), {});
    EXPECT_EQ(back.mesh.number, model.mesh.number);
    EXPECT_EQ(back.mesh.x, model.mesh.x);
    ASSERT_EQ(back.groups.size(), model.groups.size());
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      EXPECT_EQ(back.groups[g].name, model.groups[g].name);
      EXPECT_EQ(back.groups[g].nodes, model.groups[g].nodes);
      EXPECT_EQ(back.groups[g].element_numbers, model.groups[g].element_numbers);
      EXPECT_EQ(back.groups[g].element_code, model.groups[g].element_code);
    }
  }
}

// A mesher need not list the lines of both sides in one order, nor in one direction.
TEST(Convert, InterfacesOfAMesherAreFoundByPlace) {
  const Model deck = model_of(kInputs + "chapter7/friction_285_nu0495/deck.dat");
  Diagnostics ignored;
  std::string msh = msh_text(deck, ignored);
  const auto change = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(msh.find(from), std::string::npos) << from;
    msh.replace(msh.find(from), from.size(), to);
  };
  change("407 436 437\n408 437 438\n", "408 438 437\n407 436 437\n");
  const Model back = model_from_mesh(msh, "mesh.msh", full_catalogue(), {});
  EXPECT_EQ(back.groups[1].nodes, deck.groups[1].nodes);
  change("407 436 437\n", "407 436 438\n");
  try {
    model_from_mesh(msh, "mesh.msh", full_catalogue(), {});
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line 393 of interface_bottom=end interface has no line"),
              std::string::npos)
        << error.what();
  }
}

// A square of two triangles as Gmsh writes one, the second clockwise.
const char* const kMesh = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
4
1 1 "fix_xy"
1 2 "pressure=25"
1 3 "wall"
2 4 "sand"
$EndPhysicalNames
$Entities
1 3 1 0
1 0 0 0 0
1 0 0 0 1 0 0 1 1 2 1 -1
2 0 1 0 1 1 0 1 2 2 1 -1
3 0 0 0 0 1 0 1 3 2 1 -1
1 0 0 0 1 1 0 1 4 0
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
5 6 1 6
0 1 15 1
1 1
1 1 1 1
2 1 2
1 2 1 1
3 3 4
1 3 1 1
4 4 1
2 1 2 2
5 1 2 3
6 1 4 3
$EndElements
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string refusal(const std::string& msh) {
  try {
    model_from_mesh(msh, "square.msh", full_catalogue(), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

// The nodes in other planes: x-z, y-z, and a roof; another height is none.
TEST(Convert, AMeshInAnotherPlaneIsRejectedByName) {
  const std::string nodes = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", mesh(kMesh);
  EXPECT_NE(refusal(with(mesh, nodes, "0 0 0\n1 0 0\n1 0 1\n0 0 1\n")).find("lies in the x-z plane y = 0"),
            std::string::npos);
  EXPECT_NE(refusal(with(mesh, nodes, "2 0 0\n2 1 0\n2 1 1\n2 0 1\n")).find("lies in the y-z plane x = 2"),
            std::string::npos);
  EXPECT_EQ(refusal(with(mesh, nodes, "0 0 5\n1 0 5\n1 1 5\n0 1 5\n")), "none") << "one z, whichever it is";
  EXPECT_NE(refusal(with(mesh, nodes, "0 0 0\n1 0 0\n1 1 1\n0 1 1\n")).find("z goes from 0 to 1"),
            std::string::npos);
  EXPECT_EQ(refusal(with(mesh, nodes, "0 0 0\n1 0 1e-12\n1 1 0\n0 1 0\n")), "none");
}

TEST(Convert, ASurfaceHasOnePhysicalGroupAndACurveMayHaveSeveral) {
  const std::string named = with(with(kMesh, "$PhysicalNames\n4\n", "$PhysicalNames\n6\n"), "2 4 \"sand\"\n",
                                 "2 4 \"sand\"\n2 5 \"clay\"\n1 6 \"fix_y\"\n");
  EXPECT_NE(refusal(with(named, "1 0 0 0 1 1 0 1 4 0\n", "1 0 0 0 1 1 0 2 4 5 0\n"))
                .find("surface 1 belongs to 'sand' and 'clay'"),
            std::string::npos);
  // Curve 2 is pressed and held.
  const Model both = model_from_mesh(with(named, "2 0 1 0 1 1 0 1 2 2 1 -1\n", "2 0 1 0 1 1 0 2 2 6 2 1 -1\n"),
                                     "square.msh", full_catalogue(), {});
  const Model one = model_from_mesh(kMesh, "square.msh", full_catalogue(), {});
  EXPECT_EQ(both.stages[0].pressures.size(), one.stages[0].pressures.size());
  EXPECT_EQ(both.fixities.size(), one.fixities.size() + 2);
}

TEST(Convert, GmshMeshBecomesASkeletonThatCheckExplains) {
  Model skeleton = model_from_mesh(kMesh, "square.msh", full_catalogue(), {});
  ASSERT_EQ(skeleton.groups.size(), 1u);
  EXPECT_EQ(skeleton.groups[0].nodes, (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(skeleton.fixities.size(), 2u);
  ASSERT_EQ(skeleton.stages[0].pressures.size(), 1u);
  EXPECT_EQ(skeleton.stages[0].pressures[0].normal[0], 25.0);
  EXPECT_EQ(skeleton.stages[0].pressures[0].element, 1);
  EXPECT_EQ(skeleton.diagnostics.warnings(), 1) << "the curve 'wall'";
  const std::string deck = write("square.dat", sage1_text(skeleton, skeleton.diagnostics));
  try {
    model_of(deck);
    FAIL() << "a placeholder must not run";
  } catch (const InputError& error) {
    EXPECT_NE(error.diagnostics().list().front().message.find("youngs_modulus must be greater than 0"),
              std::string::npos);
  }
  Model filled =
      model_from_mesh(kMesh, "square.msh", full_catalogue(), {Geometry::plane_strain, 1000.0, 0.3, 18.0});
  EXPECT_FALSE(results(write("square.dat", sage1_text(filled, filled.diagnostics))).empty());
}

double area_of(const Model& model, const Group& group) {
  std::vector<double> geometry(static_cast<std::size_t>(group.element->traits().geometry_size()));
  const ElementTraits& traits = group.element->traits();
  Eigen::Matrix2Xd x;
  double area = 0.0;
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(model.mesh, group, e, x);
    group.element->geometry(x, geometry);
    for (int p = 0; p < traits.points; ++p) area += geometry[p * (1 + traits.law_size * traits.dofs)];
  }
  return area;
}

// A file that Gmsh itself wrote (data/README.md): quadrilaterals and triangles of second order, curved edges.
TEST(Convert, AMeshThatGmshWroteRuns) {
  const std::string text = read(SAGE_SOURCE_DIR "/tests/unit/app/data/slope.msh");
  Model mesh =
      model_from_mesh(text, "slope.msh", full_catalogue(), {Geometry::plane_strain, 20000.0, 0.3, 18.0});
  EXPECT_EQ(mesh.diagnostics.warnings(), 0);
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].name, "layer");
  EXPECT_EQ(mesh.groups[0].element->traits().nodes, 8);
  EXPECT_EQ(mesh.groups[1].name, "bank");
  EXPECT_EQ(mesh.groups[1].element->traits().nodes, 6);
  const std::string deck = write("slope.dat", sage1_text(mesh, mesh.diagnostics));
  const Model model = model_of(deck);
  EXPECT_EQ(model.diagnostics.warnings(), 0);
  // 20 x 6 without a trench of radius 2: four triangles from its centre and four segments under parabolas, 2/3
  // of chord times rise (a half circle would be 2 pi).  A bank 8 to 4 wide and 4 high.
  const double half = M_PI / 8.0;
  const double trench =
      4.0 * (2.0 * std::sin(2.0 * half) + 2.0 / 3.0 * 4.0 * std::sin(half) * 2.0 * (1.0 - std::cos(half)));
  EXPECT_NEAR(area_of(model, model.groups[0]), 120.0 - trench, 1e-6);
  EXPECT_NEAR(area_of(model, model.groups[1]), 24.0, 1e-6);
  EXPECT_EQ(model.stages[0].pressures.size(), 2u) << "the crest, 4 wide, has two edges";
  EXPECT_FALSE(results(deck).empty());
}

TEST(Convert, BrokenMeshesAreRefusedWithTheirLine) {
  const std::string good = kMesh;
  for (std::size_t cut = 0; cut + 40 < good.size(); cut += 7) {
    try {
      model_from_mesh(good.substr(0, cut), "cut.msh", full_catalogue(), {});
      ADD_FAILURE() << "cut at " << cut;
    } catch (const InputError& error) {
      EXPECT_GE(error.diagnostics().list().front().where.line, 0);
    }
  }
  std::string other = good;
  other.replace(other.find("4.1"), 3, "2.2");
  EXPECT_THROW(model_from_mesh(other, "old.msh", full_catalogue(), {}), InputError);
}

// A deck for `sagefe check` to refuse would be written otherwise.
TEST(Convert, ConstantsThatNoMaterialHasAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Geometry plane = Geometry::plane_strain;
  const std::pair<ForeignMeshOptions, const char*> cases[] = {
      {{plane, kNan, 0.3, 18.0}, "Young's modulus"},   {{plane, -1.0, 0.3, 18.0}, "Young's modulus"},
      {{plane, 1e200, 0.3, 18.0}, "Young's modulus"},  {{plane, 1000.0, kNan, 18.0}, "Poisson's ratio"},
      {{plane, 1000.0, 0.5, 18.0}, "Poisson's ratio"}, {{plane, 1000.0, -1.0, 18.0}, "Poisson's ratio"},
      {{plane, 1000.0, 0.3, kNan}, "unit weight"},     {{plane, 1000.0, 0.3, -1e200}, "unit weight"}};
  for (const auto& [options, name] : cases) try {
      model_from_mesh(kMesh, "square.msh", full_catalogue(), options);
      ADD_FAILURE() << options.youngs_modulus << " " << options.poissons_ratio << " " << options.unit_weight;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
}

TEST(Convert, MeshioReadsTheMesh) {
  const char* const python = "/usr/bin/python3";
  if (std::system((std::string(python) + " -c 'import meshio' 2> /dev/null").c_str()) != 0)
    GTEST_SKIP() << "meshio is not installed";
  Model model = model_of(write("strip.dat", kDeck));
  const std::string path = write("strip.msh", msh_text(model, model.diagnostics));
  const std::string script = "import meshio; m = meshio.read('" + path +
                             "'); q = sum(len(c.data) for c in m.cells if c.type == 'quad'); "
                             "assert len(m.points) == 15 and q == 8, (len(m.points), q); "
                             "assert {'lower', 'upper', 'fix_x', 'fix_y'} <= set(m.field_data), m.field_data";
  EXPECT_EQ(std::system((std::string(python) + " -c \"" + script + "\" > /dev/null").c_str()), 0);
}

TEST(Convert, CalculixFindsTheSameDisplacements) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "ccx is not installed";
  // Constant strain: every program must find the exact answer, -0.91e-6 at the top (p51_1.res).
  Model model = model_of(kInputs + "smith_griffiths/p51_1.dat");
  write("p51_1.inp", inp_text(model, model.diagnostics));
  ASSERT_EQ(std::system(("cd " + scratch().string() + " && ccx p51_1 > ccx.log 2>&1").c_str()), 0);
  std::ifstream in(scratch() / "p51_1.dat");
  int found = 0;
  for (std::string line; std::getline(in, line);) {
    int node = 0;
    double u[3];
    if (std::sscanf(line.c_str(), "%d %lf %lf %lf", &node, &u[0], &u[1], &u[2]) != 4 || node > 3) continue;
    EXPECT_NEAR(u[1], -0.91e-6, 1e-11) << "node " << node;
    ++found;
  }
  EXPECT_EQ(found, 3);
}

// A column of two squares, nu = 0 and E = 1000: the force of 10 at its top shortens each square by 0.01.
DeckWriter column() {
  const scenes::Block block{1, 2, scenes::Cell::quad4, 1, 1, scenes::rectangle(0.0, 1.0, 0.0, 2.0)};
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 1, {1000.0, 0.0});
  deck.group(1, 1, 2, 1);
  block.write_elements(deck, 1);
  for (int node : block.bottom()) deck.fix(node, 1, 1);
  return deck;
}

void move_top(StageCards& stage, int code, double by) {
  for (int node : {5, 6}) stage.fix(node, 0, code, 0.0, by);
}

Model model_of(const std::string& name, const DeckWriter& deck) {
  return model_of(write(name, deck.text()));
}

// u_y of node 5 at the end of each step, as ccx prints it.
std::vector<double> calculix_top(const std::string& job, const std::string& inp) {
  write(job + ".inp", inp);
  EXPECT_EQ(std::system(("cd " + scratch().string() + " && ccx " + job + " > ccx.log 2>&1").c_str()), 0);
  std::ifstream in(scratch() / (job + ".dat"));
  std::vector<double> top;
  for (std::string line; std::getline(in, line);) {
    int node = 0;
    double u[2];
    if (std::sscanf(line.c_str(), "%d %lf %lf", &node, &u[0], &u[1]) == 3 && node == 5) top.push_back(u[1]);
  }
  return top;
}

TEST(Convert, CalculixGetsTotalDisplacements) {
  DeckWriter deck = column();
  move_top(deck.stage(), 1, -0.02);
  move_top(deck.stage(), 1, -0.01);
  move_top(deck.stage(), 1, 0.0);
  Model model = model_of("totals.dat", deck);
  const std::string inp = inp_text(model, model.diagnostics);
  EXPECT_EQ(model.diagnostics.warnings(), 0);
  EXPECT_NE(inp.find("5, 2, 2, -0.02\n"), std::string::npos) << inp;
  EXPECT_NE(inp.find("5, 2, 2, -0.03\n"), std::string::npos) << inp;
  EXPECT_EQ(inp.find("FIXED"), std::string::npos);
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) return;
  const std::vector<double> top = calculix_top("totals_ccx", inp);
  ASSERT_EQ(top.size(), 3u);
  EXPECT_NEAR(top[0], -0.02, 1e-8);
  EXPECT_NEAR(top[1], -0.03, 1e-8);
  EXPECT_NEAR(top[2], -0.03, 1e-8);
}

TEST(Convert, CalculixHoldsWhatIsHeldLaterWhereItIs) {
  DeckWriter deck = column();
  StageCards& loaded = deck.stage();
  loaded.load(5, 0.0, -5.0);
  loaded.load(6, 0.0, -5.0);
  move_top(deck.stage(), 1, 0.0);
  StageCards& pushed = deck.stage();
  pushed.load(3, 0.0, -2.0);
  pushed.load(4, 0.0, -2.0);
  Model model = model_of("held.dat", deck);
  const std::string inp = inp_text(model, model.diagnostics);
  EXPECT_EQ(model.diagnostics.warnings(), 0);
  EXPECT_NE(inp.find("*BOUNDARY, FIXED\n5, 2, 2\n6, 2, 2\n"), std::string::npos) << inp;
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) return;
  const std::vector<double> top = calculix_top("held_ccx", inp);
  ASSERT_EQ(top.size(), 3u);
  for (double u : top) EXPECT_NEAR(u, -0.02, 1e-8);
}

// A held dof whose displacement is zero is written so, not left blank.
TEST(Convert, HeldDofsGetNoNoteOnReadingBack) {
  DeckWriter deck = column();
  move_top(deck.stage(), 1, 0.0);
  Model model = model_of("zero.dat", deck);
  const Model back = model_of(write("zero.dat", sage1_text(model, model.diagnostics)));
  for (const Diagnostic& d : back.diagnostics.list())
    EXPECT_EQ(d.message.find("is left blank"), std::string::npos) << to_string(d);
}

TEST(Convert, AMeshFileTellsWhatItDoesNotHold) {
  Model model = model_of(write("strip.dat", kDeck));
  msh_text(model, model.diagnostics);
  const std::string printed = model.diagnostics.list().back().message;
  // Loads: gravity, one node, two edges by each of two cards.
  EXPECT_NE(printed.find("2 material(s), 2 stage(s), 6 load(s), 1 fixities of stages, 1 initial stress(es), "
                         "1 report(s)"),
            std::string::npos)
      << printed;
}

TEST(Convert, WarnsWhereCalculixCountsFromAnotherPlace) {
  DeckWriter deck = column();
  StageCards& loaded = deck.stage();
  loaded.load(5, 0.0, -5.0);
  loaded.load(6, 0.0, -5.0);
  move_top(deck.stage(), 1, -0.01);
  move_top(deck.stage(), -1, 0.0);
  Model model = model_of("unknown.dat", deck);
  inp_text(model, model.diagnostics);
  std::string printed;
  for (const Diagnostic& d : model.diagnostics.list())
    if (d.severity == Severity::warning) {
      EXPECT_GT(d.where.line, 0) << d.message;
      printed += d.message + "\n";
    }
  EXPECT_NE(printed.find("stage 2: node(s) 5 could move before"), std::string::npos) << printed;
  EXPECT_NE(printed.find("stage 3: the release of node(s) 5 is left out"), std::string::npos) << printed;
}

// Of a card that moves both of its dofs.
TEST(Convert, ANodeIsNamedOnceInAWarning) {
  DeckWriter deck = column();
  deck.stage().load(5, 1.0, -5.0);
  deck.stage().fix(5, 1, 1, 0.01, -0.01);
  deck.stage().fix(5, -1, -1);
  Model model = model_of("both.dat", deck);
  inp_text(model, model.diagnostics);
  std::string printed;
  for (const Diagnostic& d : model.diagnostics.list()) printed += d.message + "\n";
  EXPECT_NE(printed.find("stage 2: node(s) 5 could move before"), std::string::npos) << printed;
  EXPECT_NE(printed.find("stage 3: the release of node(s) 5 is left out"), std::string::npos) << printed;
}

}  // namespace
}  // namespace sage::app
