// Models as TOML files: what they may say, and what is said of those with mistakes.
#include "sage/model_file/model_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/analysis/run.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/model_file/unit_of.hpp"
#include "sage/record/result.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"

namespace sage {
namespace {

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue list;
    register_elements(list);
    register_materials(list);
    register_solvers(list);
    return list;
  }();
  return all;
}

// A column of one element, 1 m x 2 m, pressed by 100 kPa.
const std::string kColumn = R"(title = "column"
geometry = "plane strain"
node = [
  {x = 0.0, y = 0.0}, {x = 1.0, y = 0.0},
  {x = 1.0, y = 2.0}, {x = 0.0, y = "200 cm"},
]
element = [{group = "soil", nodes = [1, 2, 3, 4]}]
fixity = [{first = 1, last = 2, x = "fixed", y = "fixed"}, {first = 3, last = 4, x = "fixed"}]

[units]
length = "m"
force = "kN"
stress = "kPa"

[[material]]
name = "clay"
law = "linear_elastic"
unit_weight = "20 kN/m^3"
youngs_modulus = "20 MPa"
poissons_ratio = 0.0

[[group]]
name = "soil"
element = "quad4"
formulation = "b-bar"
material = "clay"

[[stage]]
title = "press"
increments = 2
pressure = [{element = 1, edge = 3, normal1 = 100, normal2 = 100.0}]

[[report]]
kind = "point"
x = 0.5
y = 1.0
name = "middle"
)";

Model model_of(const std::string& text) {
  return build_model(read_model_file_text(text, "column.sage.toml"), catalogue());
}

std::string with(const std::string& old, const std::string& now) {
  std::string text = kColumn;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), now);
}

TEST(ModelFile, ReadsNamesNumbersAndUnits) {
  const Model model = model_of(kColumn);
  EXPECT_EQ(model.title, "column");
  ASSERT_EQ(model.mesh.nodes(), 4);
  EXPECT_EQ(model.mesh.number, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(model.mesh.x(1, 3), 2.0);
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].law_name, "linear_elastic");
  EXPECT_EQ(model.materials[0].parameters, (std::vector<double>{20e3, 0.0}));
  EXPECT_EQ(model.materials[0].unit_weight, 20.0);
  EXPECT_EQ(model.groups[0].element_name, "quad4 b-bar");
  ASSERT_EQ(model.stages.size(), 1u);
  EXPECT_EQ(model.stages[0].title, "press");
  EXPECT_EQ(model.stages[0].increments, 2);
  EXPECT_EQ(model.stages[0].pressures[0].normal, Vector2(100.0, 100.0));
  EXPECT_EQ(model.reports[0].place, Vector2(0.5, 1.0));
}

TEST(ModelFile, IsWrittenAndReadAgain) {
  const Model model = model_of(kColumn);
  Diagnostics lost;
  const std::string text = model_file_text(model, catalogue(), lost);
  EXPECT_TRUE(lost.list().empty());
  EXPECT_EQ(model_file_text(model_of(text), catalogue(), lost), text);
}

struct Broken {
  const char* old;
  const char* now;
  int line;
  const char* code;
  const char* says;
};

class BrokenModelFile : public testing::TestWithParam<Broken> {};

TEST_P(BrokenModelFile, IsRefusedAtItsLineWithWhatHelps) {
  const Broken& broken = GetParam();
  try {
    model_of(with(broken.old, broken.now));
    FAIL() << "taken";
  } catch (const InputError& error) {
    const Diagnostic* found = nullptr;
    for (const Diagnostic& one : error.diagnostics().list())
      if (found == nullptr && one.severity == Severity::error) found = &one;
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->where.line, broken.line);
    EXPECT_GT(found->where.first_column, 0);
    EXPECT_EQ(to_string(found->code), broken.code);
    EXPECT_NE(found->message.find(broken.says), std::string::npos) << found->message;
  }
}

const Broken kBroken[] = {
    {"[units]", "[units", 10, "S150", "this is no TOML"},
    {"title = \"column\"", "titel = \"column\"", 1, "S151", "did you mean title?"},
    {"geometry = \"plane strain\"", "geometry = \"plain strain\"", 2, "S153", "did you mean plane strain?"},
    {"{x = 0.0, y = 0.0}", "{x = \"a\", y = 0.0}", 4, "S152", "a number and its unit"},
    {"{x = 1.0, y = 0.0}", "{z = 1.0, y = 0.0}", 4, "S151",
     "the table node has no key \"z\"; known: number, step"},
    {"stress = \"kPa\"\n", "stress = \"kPa\"\ntension = 1\n", 14, "S151", "the table units has no key"},
    {"\"200 cm\"", "\"200 kPa\"", 5, "S154", "can't be turned into"},
    {"\"200 cm\"", "\"200 furlongs\"", 5, "S154", "no unit that the program knows"},
    {"nodes = [1, 2, 3, 4]", "nodes = 1", 7, "S152", "stands in a list"},
    {"nodes = [1, 2, 3, 4]", "nodes = [1, 2, 3.5, 4]", 7, "S152", "whole number"},
    {"nodes = [1, 2, 3, 4]", "nodes = [1, 2, 3, 9]", 7, "S201", "node 9"},
    {"group = \"soil\", nodes", "group = \"sol\", nodes", 7, "S153", "did you mean soil?"},
    {"x = \"fixed\", y", "x = \"fixd\", y", 8, "S153", "did you mean fixed?"},
    {"length = \"m\"\n", "", 10, "S155", "the table units needs its length"},
    {"law = \"linear_elastic\"", "law = \"linear_plastic\"", 17, "S153", "did you mean linear_elastic?"},
    {"law = \"linear_elastic\"\n", "", 15, "S155", "needs its law"},
    {"youngs_modulus = ", "young_modulus = ", 19, "S151", "did you mean youngs_modulus?"},
    {"poissons_ratio = 0.0", "poissons_ratio = 0.5", 20, "S224", "ratio"},
    {"element = \"quad4\"", "element = \"quad5\"", 24, "S153", "did you mean quad4?"},
    {"formulation = \"b-bar\"", "formulation = \"bbar\"", 25, "S153", "did you mean b-bar?"},
    {"material = \"clay\"", "material = \"sand\"", 26, "S153", "no [[material]]"},
    {"increments = 2", "increments = \"two\"", 30, "S152", "whole number"},
    {"edge = 3", "edge = 5", 31, "S230", "edge"},
    {"kind = \"point\"", "kind = \"nodes\"\nline = \"base\"", 35, "S153", "need a drawing"},
    {"first = 3, last = 4,", "point = \"A\",", 8, "S153", "need a drawing"},
    {"[[report]]", "[[bar]]\nname = \"anchor\"\n[[report]]", 1, "S155", "a drawing needs a table [mesh]"},
    {"kind = \"point\"", "kind = \"pont\"", 34, "S153", "did you mean point?"},
    {"y = 1.0\nname", "y = inf\nname", 36, "S152", "not finite"},
};

INSTANTIATE_TEST_SUITE_P(All, BrokenModelFile, testing::ValuesIn(kBroken));

TEST(ModelFile, AllMistakesAreShownAtOnce) {
  std::string text = with("increments = 2", "increments = 2.5");
  text.replace(text.find("\"quad4\""), 7, "\"quad5\"");
  try {
    model_of(text);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().errors(), 2);
  }
}

TEST(ModelFile, UnitsAreTurnedIntoThoseOfTheModel) {
  using model_file::unit_of;
  EXPECT_DOUBLE_EQ(unit_of("psi")->size, 4.4482216152605 / (0.0254 * 0.0254));
  EXPECT_TRUE(unit_of("kN/m^3")->same_kind(*unit_of("lbf/in3")));
  EXPECT_TRUE(unit_of("kN m^2")->same_kind(*unit_of("N mm2")));
  EXPECT_DOUBLE_EQ(unit_of("kN/m3")->size, 1e3);
  EXPECT_FALSE(unit_of("kN/m/m").has_value());
  EXPECT_FALSE(unit_of("").has_value());
  EXPECT_FALSE(unit_of("kNm").has_value());
}

// What editors and the manual say of the keys is written from the table that the reader has.
// Two blocks with a joint between them that reaches the base.
const std::string kJoint = R"(title = "joint"
geometry = "plane strain"
fixity = [{line = "base", x = "fixed", y = "fixed"}]
[units]
length = "m"
force = "kN"
stress = "kPa"
[mesh]
element = "quad4"
size = 1.0
mesher = "blocks"
[[material]]
name = "rock"
law = "linear_elastic"
youngs_modulus = 1e4
poissons_ratio = 0.2
[[material]]
name = "gap"
law = "goodman"
shear_stiffness = 1e5
normal_stiffness = 1e5
[[line]]
name = "joint"
points = [[2, 0], [2, 2]]
interface = {material = "gap"}
[[line]]
name = "base"
points = [[0, 0], [4, 0]]
[[area]]
name = "one"
outline = [[0, 0], [4, 0], [4, 2], [0, 2]]
material = "rock"
[[stage]]
title = "weight"
gravity_y = -1
)";

// Elements of size 1: the base has 5 places, two nodes at the joint's.
TEST(ModelFile, SupportsAlongALineHoldBothSidesOfAJoint) {
  const Model model = model_of(kJoint);
  EXPECT_EQ(model.mesh.nodes(), 5 * 3 + 3);
  EXPECT_EQ(model.fixities.size(), 6U);
}

TEST(ModelFile, AJointIsNotJoinedAtItsEnd) {
  std::string text = kJoint;
  text.replace(text.find("[2, 2]"), 6, "[2, 1]");
  EXPECT_EQ(model_of(text).mesh.nodes(), 5 * 3 + 2);
  text.insert(text.find("interface ="), "last_end = \"joined\"\n");
  try {
    model_of(text);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line joint: the end of a joint"), std::string::npos)
        << error.what();
  }
}

// What a drawing has no use for could be meant otherwise, so it is not passed over.
TEST(ModelFile, MistakesInDrawingsAreNamedOnce) {
  struct Mistake {
    const char *old, *now, *code, *says;
  };
  const std::string arc = "\n[[line]]\nname = \"arc\"\nshape = \"arc\"\npoints = [[1, 0], [0, 1]]\n";
  const std::string drawing = kJoint + arc + "centre = [0, 0]\nclockwise = false\n";
  for (const Mistake& mistake :
       {Mistake{"centre = [0, 0]\n", "", "S155", "an arc needs its centre"},
        Mistake{"clockwise = false", "clockwise = \"yes\"", "S152", "is true or false"},
        Mistake{"clockwise = false", "radius = 2", "S152", "an arc has no radius"},
        Mistake{"[[1, 0], [0, 1]]", "[[1, 0]]", "S254", "an arc needs two points"},
        Mistake{"points = [[0, 0], [4, 0]]", "points = [[0, 0], [4, 0]]\ncentre = [1, 1]", "S152",
                "a polyline has no centre"},
        Mistake{"shape = \"arc\"", "shape = \"circle\"\nradius = 2", "S152", "a circle has no points"},
        Mistake{"material = \"rock\"", "material = \"rock\"\nholes = \"joint\"", "S152", "list of outlines"},
        Mistake{nullptr, "point = [4, 0]", "S153", "give it a name in [points]"}}) {
    const bool of_joint = mistake.old == nullptr;  // by itself: places are known only in a mesh
    std::string text = of_joint ? kJoint : drawing;
    const std::string old = of_joint ? "line = \"base\"" : mistake.old;
    text.replace(text.find(old), old.size(), mistake.now);
    try {
      model_of(text);
      ADD_FAILURE() << "taken: " << mistake.now;
    } catch (const InputError& error) {
      const std::vector<Diagnostic>& found = error.diagnostics().list();
      ASSERT_EQ(found.size(), 1u) << error.what();
      EXPECT_EQ(to_string(found[0].code), mistake.code) << error.what();
      EXPECT_NE(found[0].message.find(mistake.says), std::string::npos) << error.what();
    }
  }
}

// Two layers with nu = 0 between smooth sides settle by p (h1/E1 + h2/E2), whatever the mesh: 80 (1/1e4 + .5/2e4) = .01.
// A joint that lies across them adds p/k_n = 80/1e5.
TEST(ModelFile, ADrawnColumnSettlesAsItsClosedForm) {
  const std::string text = R"(
title = "column"
geometry = "plane strain"
[units]
length = "m"
force = "kN"
stress = "kPa"
[mesh]
element = "quad8"
size = 0.3
[points]
top = [1.2, 1.5]
[[material]]
name = "lower"
law = "linear_elastic"
youngs_modulus = 1e4
poissons_ratio = 0
[[material]]
name = "upper"
law = "linear_elastic"
youngs_modulus = "20 MPa"
poissons_ratio = 0
[[material]]
name = "gap"
law = "goodman"
shear_stiffness = 1e5
normal_stiffness = 1e5
[[line]]
name = "base"
points = [[0, 0], [1.2, 0]]
[[line]]
name = "left"
points = [[0, 0], [0, 1.5]]
[[line]]
name = "right"
points = [[1.2, 0], [1.2, 1.5]]
[[line]]
name = "surface"
points = [[0, 1.5], "top"]
[[line]]
name = "between"
points = [[0, 1], [1.2, 1]]
interface = {material = "gap"}
[[area]]
name = "below"
outline = [[0, 0], [1.2, 0], [1.2, 1], [0, 1]]
material = "lower"
[[area]]
name = "above"
outline = [[0, 1], [1.2, 1], "top", [0, 1.5]]
material = "upper"
[[fixity]]
line = "base"
y = "fixed"
[[fixity]]
line = "left"
x = "fixed"
[[fixity]]
line = "right"
x = "fixed"
[[stage]]
pressure = [{line = "surface", normal1 = 80, normal2 = 80}]
[[report]]
kind = "nodes"
point = "top"
)";
  const Model model = model_of(text);
  Result result;
  Observer* observers[] = {&result};
  RunSettings settings;
  settings.choose_solver = choose_solver;
  const RunResult run = sage::run(model, catalogue(), settings, observers);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const int top = model.reports[0].nodes[0];
  EXPECT_NEAR((*result.ends()[0].view().u)[2 * top + 1], -(0.01 + 80.0 / 1e5), 1e-12);
}

TEST(ModelFile, SchemaAndTablesAreWrittenFromTheKeys) {
  const std::filesystem::path source = SAGE_SOURCE_DIR;
  const std::pair<std::filesystem::path, std::string> pages[] = {
      {source / "docs/schema/model_file.schema.json", model_file_schema(catalogue())},
      {source / "docs/manual/model_file_keys.md", model_file_tables()}};
  for (const auto& [file, text] : pages) {
    if (std::getenv("SAGE_WRITE_MANUAL") != nullptr) std::ofstream(file, std::ios::binary) << text;
    std::ifstream in(file, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), text)
        << "SAGE_WRITE_MANUAL=1 test_model --gtest_filter=ModelFile.* writes " << file << " anew";
  }
}

}  // namespace
}  // namespace sage
