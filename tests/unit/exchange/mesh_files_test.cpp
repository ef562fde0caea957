// Meshes of other programs: MSH 2.2, MSH 4.1 as text and binary, and .inp of Abaqus and CalculiX.  One mesh in four formats
// gives one model; compressed blocks and rings follow closed forms; broken files are rejected with their line.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "sage/app/commands.hpp"
#include "sage/exchange/mesh_model.hpp"
#include "sage/model_file/model_file.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

using scenes::WholeRun;

const scenes::Workbench& mesh_bench() {
  static const scenes::Workbench bench = app::make_workbench();
  return bench;
}

Model mesh_of(const std::string& text, const ForeignMeshOptions& options = {}) {
  return model_from_mesh(text, "mesh", mesh_bench().catalogue(), options);
}

std::string rejection(const std::string& text, const ForeignMeshOptions& options = {}) {
  try {
    mesh_of(text, options);
  } catch (const InputError& error) {
    return to_string(error.diagnostics().list().front());
  }
  return "none";
}

// Of the lists of nodes, numbers, supports and pressures.
std::string summary(const Model& model) {
  std::string text;
  for (int i = 0; i < model.mesh.nodes(); ++i)
    text += fmt::format("{} {} {}\n", model.mesh.number[i], model.mesh.x(0, i), model.mesh.x(1, i));
  for (const Group& group : model.groups)
    text += fmt::format("{} {}: {} of {}\n", group.name, group.element_name, fmt::join(group.nodes, " "),
                        fmt::join(group.element_numbers, " "));
  for (const Fixity& one : model.fixities)
    text +=
        fmt::format("{} {} {}\n", one.node, one.code[0] == FixityCode::fixed, one.code[1] == FixityCode::fixed);
  for (const EdgeLoad& one : model.stages[0].pressures)
    text += fmt::format("{} {} {} {}\n", one.group, one.element, one.edge, one.normal.x());
  return text;
}

// A square of two triangles, the second clockwise: sand and wet clay, held below, pressed on the right.
const std::string kText41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
4
1 1 "fix_xy"
1 2 "pressure=25"
2 3 "sand"
2 4 "wet clay"
$EndPhysicalNames
$Entities
0 2 2 0
1 0 0 0 1 0 0 1 1 0
2 1 0 0 1 1 0 1 2 0
1 0 0 0 1 1 0 1 3 0
2 0 0 0 1 1 0 1 4 0
$EndEntities
$Nodes
1 5 1 9
2 1 0 5
1
2
3
4
9
0 0 0
1 0 0
1 1 0
0 1 0
5 5 0
$EndNodes
$Elements
4 4 11 21
1 1 1 1
11 1 2
1 2 1 1
12 2 3
2 1 2 1
20 1 2 3
2 2 2 1
21 1 4 3
$EndElements
)";

const std::string kText22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Comments
any words
$EndComments
$PhysicalNames
4
1 1 "fix_xy"
1 2 "pressure=25"
2 3 "sand"
2 4 "wet clay"
$EndPhysicalNames

$Nodes
5
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
9 5 5 0
$EndNodes
$Elements
5
10 15 2 0 1 9
11 1 2 1 1 1 2
12 1 2 2 2 2 3
20 2 2 3 1 1 2 3
21 2 4 4 2 1 1 1 4 3
$EndElements
)";

const std::string kInp = R"(** a comment
*Heading
 square
*Node, nset=Nall
 1, 0., 0.
 2, +1.0D0, 0., 0.
** between

 3, 1, 1
 4, , 1.
 9, 5., 5.
*ELEMENT, TYPE = T3D2, ELSET=fix_xy
11, 1, 2
*Element, type=B31, elset=pressure=25
12, 2, 3
*Element, type=CPE3
20, 1, 2, 3,
21, 1,
 4, 3
*Elset, elset=sand, generate
 20, 20
*Elset, elset="wet clay"
21
*Elset, elset=Eall
sand, "wet clay"
*Solid section, elset=sand, material=m1
*Material, name=m1
*Elastic
1., .3
*Step
*Static
*End step
)";

template <class Number>
void put(std::string& to, Number value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}
void put_all(std::string& to, std::initializer_list<std::size_t> values) {
  for (const std::size_t value : values) put(to, value);
}
void put_ints(std::string& to, std::initializer_list<int> values) {
  for (const int value : values) put(to, value);
}

// kText41 as Gmsh writes it in binary.
std::string binary41() {
  std::string text = "$MeshFormat\n4.1 1 8\n";
  put(text, 1);
  text += "\n$EndMeshFormat\n" + kText41.substr(kText41.find("$PhysicalNames"),
                                                kText41.find("$Entities") - kText41.find("$PhysicalNames"));
  text += "$Entities\n";
  put_all(text, {0, 2, 2, 0});
  for (const int entity : {1, 2, 3, 4}) {
    put(text, entity > 2 ? entity - 2 : entity);
    for (int i = 0; i < 6; ++i) put(text, 0.0);
    put_all(text, {1});
    put(text, entity);
    put_all(text, {0});
  }
  text += "\n$EndEntities\n$Nodes\n";
  put_all(text, {1, 5, 1, 9});
  put_ints(text, {2, 1, 0});
  put_all(text, {5, 1, 2, 3, 4, 9});
  for (const double x : {0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0., 5., 5., 0.}) put(text, x);
  text += "\n$EndNodes\n$Elements\n";
  put_all(text, {4, 4, 11, 21});
  put_ints(text, {1, 1, 1});
  put_all(text, {1, 11, 1, 2});
  put_ints(text, {1, 2, 1});
  put_all(text, {1, 12, 2, 3});
  put_ints(text, {2, 1, 2});
  put_all(text, {1, 20, 1, 2, 3});
  put_ints(text, {2, 2, 2});
  put_all(text, {1, 21, 1, 4, 3});
  return text + "\n$EndElements\n";
}

std::string with_line_ends(const std::string& text, const std::string& end) {
  std::string all;
  for (const char c : text) all += c == '\n' ? end : std::string(1, c);
  return all;
}

TEST(MeshFiles, OneMeshInFourFormatsIsOneModel) {
  const std::string wanted = summary(mesh_of(kText41));
  EXPECT_NE(wanted.find("wet clay tri3 one point: 0 2 3 of 21\n"), std::string::npos) << wanted;
  EXPECT_EQ(wanted.find("\n9 5 5"), std::string::npos) << "node 9 belongs to no element";
  EXPECT_NE(wanted.find("\n0 0 1 25\n"), std::string::npos) << wanted;
  EXPECT_EQ(summary(mesh_of(binary41())), wanted);
  EXPECT_EQ(summary(mesh_of(kText22)), wanted);
  EXPECT_EQ(summary(mesh_of(kInp)), wanted);
  for (const std::string& text : {kText41, kText22, kInp}) {
    EXPECT_EQ(summary(mesh_of(with_line_ends(text, "\r\n"))), wanted);
    EXPECT_EQ(summary(mesh_of("\xef\xbb\xbf" + text)), wanted);
  }
}

// A block 2 wide and 3 high of two quadrilaterals of eight nodes, the upper one clockwise, under a pressure p = 12 on its
// surface; left and bottom held by names that the mesh gives no meaning.
std::string block(const std::string& type) {
  return "*NODE\n1,1,0,7\n2,3,0,7\n3,3,1.5,7\n4,1,1.5,7\n5,3,3,7\n6,1,3,7\n11,2,0,7\n12,3,.75,7\n13,2,1.5,"
         "7\n14,1,.75,7\n"
         "15,3,2.25,7\n16,2,3,7\n17,1,2.25,7\n*ELEMENT,TYPE=" +
         type +
         ",ELSET=soil\n"
         "1,1,2,3,4,11,12,13,14\n2,4,6,5,3,\n17,16,15,13\n"
         "*NSET,NSET=Left\n1,4,6,14,17\n*NSET,NSET=bottom,GENERATE\n1,2\n11,11\n"
         "*NSET,NSET=top side\n5,6,16\n*SURFACE,TYPE=ELEMENT,NAME=crest\n2,S2\n";
}

ForeignMeshOptions of_block(const std::string& pressed) {
  ForeignMeshOptions options;
  options.youngs_modulus = 1000.0;
  options.poissons_ratio = 0.25;
  options.uses = {mesh_use("fix", "left=x"), mesh_use("fix", "BOTTOM=y"),
                  mesh_use("pressure", pressed + "=12")};
  return options;
}

Vector2 corner_of(const std::string& text, const ForeignMeshOptions& options) {
  Model skeleton = mesh_of(text, options);
  const std::string file = model_file_text(skeleton, mesh_bench().catalogue(), skeleton.diagnostics);
  const WholeRun run =
      mesh_bench().run(build_model(read_model_file_text(file, "mesh.sage.toml"), mesh_bench().catalogue()));
  EXPECT_TRUE(run.completed()) << run.failure;
  return run.u(5);
}

// Plane strain without lateral stress: eps_y = -(1 - nu^2) p / E, eps_x = nu (1 + nu) p / E.
TEST(MeshFiles, BlockUnderPressureFollowsTheClosedForm) {
  for (const char* pressed : {"top side", "crest"})
    for (const char* type : {"CPE8", "CPS8R"}) {
      const Vector2 u = corner_of(block(type), of_block(pressed));
      EXPECT_NEAR(u.y(), -(1.0 - 0.0625) * 12.0 / 1000.0 * 3.0, 1e-10) << pressed;
      EXPECT_NEAR(u.x(), 0.25 * 1.25 * 12.0 / 1000.0 * 2.0, 1e-10) << pressed;
    }
}

// A ring of inner radius 1 with free sides: eps_z = -p / E and u_r = nu p r / E, so nothing is held but its bottom.
TEST(MeshFiles, RingUnderPressureFollowsTheClosedForm) {
  ForeignMeshOptions options = of_block("crest");
  options.uses.erase(options.uses.begin());
  const Vector2 u = corner_of(block("CAX8R"), options);
  EXPECT_NEAR(u.y(), -12.0 / 1000.0 * 3.0, 1e-10);
  EXPECT_NEAR(u.x(), 0.25 * 12.0 / 1000.0 * 3.0, 1e-10);
}

// Along the left side of the block: a wall of two pieces from the top, with placeholders for its stiffness; and water.
TEST(MeshFiles, WallsAndWaterByName) {
  ForeignMeshOptions options;
  options.water_weight = 10.0;
  options.uses = {mesh_use("beam", "left"), mesh_use("water", "top side"), mesh_use("force", "corner=3,-4")};
  const Model model = mesh_of(block("CPE8") + "*NSET,NSET=corner\n5\n", options);
  ASSERT_EQ(model.groups.size(), 2u);
  EXPECT_EQ(model.groups[1].entry->name, "beam3");
  std::vector<int> numbers;
  for (const int node : model.groups[1].nodes) numbers.push_back(model.mesh.number[node]);
  EXPECT_EQ(numbers, (std::vector<int>{6, 4, 17, 4, 1, 14}));
  ASSERT_EQ(model.water.size(), 1u);
  EXPECT_EQ(model.water[0].line.size(), 3u);
  EXPECT_EQ(model.units.water_unit_weight, 10.0);
  ASSERT_EQ(model.stages[0].loads.size(), 1u);
  EXPECT_EQ(model.stages[0].loads[0].force, Vector2(3.0, -4.0));
}

// Without sections the largest lists that together hold all elements are the groups, else the sets of *ELEMENT cards.
TEST(MeshFiles, SetsThatNameGroups) {
  const std::string nodes = "*NODE\n1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n";
  const std::string elements =
      "*ELEMENT,TYPE=CPE4,ELSET=S1\n1,1,2,5,4\n*ELEMENT,TYPE=CPE4,ELSET=S2\n2,2,3,6,5\n";
  const auto names = [](const Model& model) {
    std::string all;
    for (const Group& group : model.groups) all += group.name + " ";
    return all;
  };
  EXPECT_EQ(names(mesh_of(nodes + elements)), "S1 S2 ");
  EXPECT_EQ(names(mesh_of(nodes + elements + "*ELSET,ELSET=watched\n2\n")), "S1 S2 ");
  EXPECT_EQ(names(mesh_of(nodes + elements +
                          "*ELSET,ELSET=Clay\nS1\n*ELSET,ELSET=Sand\n2\n*ELSET,ELSET=EALL\nCLAY,sand\n")),
            "Clay Sand ");
  EXPECT_EQ(names(mesh_of(nodes + elements + "*ELSET,ELSET=all\n1,2\n*ELSET,ELSET=watched\n2\n")), "all ");
  EXPECT_NE(rejection(nodes + elements +
                      "*ELSET,ELSET=both\n1,2\n*SOLID SECTION,ELSET=both\n*SOLID SECTION,ELSET=S2\n")
                .find("element 2 belongs to 'both' and 'S2'"),
            std::string::npos);
}

// A part with one instance, as Abaqus/CAE writes it: the assembly has a point of reference and sets by instance.
TEST(MeshFiles, PartAndAssembly) {
  const std::string text =
      "*Part, name=P\n*Node\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*Element, type=CPE4R\n1,1,2,3,4\n*Elset, elset=Soil, "
      "generate\n"
      "1,1,1\n*Solid Section, elset=Soil, material=M\n,\n*End Part\n*Assembly, name=A\n*Instance, name=P-1, "
      "part=P\n"
      "*End Instance\n*Node\n1,9,9,0\n*Nset, nset=RP\n1,\n*Nset, nset=Base, instance=P-1\n1,2\n*Nset, "
      "nset=Top\n"
      "P-1.3,P-1.4\n*End Assembly\n*Material, name=M\n*Elastic\n1.,.3\n";
  ForeignMeshOptions options;
  options.uses = {mesh_use("fix", "Base=xy"), mesh_use("pressure", "Top=5")};
  const Model model = mesh_of(text, options);
  EXPECT_EQ(model.mesh.nodes(), 4);
  EXPECT_EQ(model.groups[0].name, "Soil");
  EXPECT_EQ(model.fixities.size(), 2u);
  EXPECT_EQ(model.stages[0].pressures.size(), 1u);
  options.uses = {mesh_use("fix", "RP=xy")};
  EXPECT_NE(rejection(text, options).find("'RP' has no nodes of the mesh to hold"), std::string::npos);
}

// Names that differ in upper and lower case alone: an option means the one that it spells exactly.
TEST(MeshFiles, NamesThatDifferInCaseAloneNeedTheirCase) {
  std::string text = kText22;
  text.replace(text.find("\"fix_xy\""), 8, "\"road\"");
  text.replace(text.find("\"pressure=25\""), 13, "\"Road\"");
  ForeignMeshOptions options;
  for (const char* name : {"road", "Road"}) {
    options.uses = {mesh_use("fix", std::string(name) + "=y")};
    EXPECT_EQ(mesh_of(text, options).fixities.size(), 2u) << name;
  }
  options.uses = {mesh_use("fix", "ROAD=y")};
  EXPECT_NE(rejection(text, options).find("'ROAD' may mean 'road' or 'Road'"), std::string::npos)
      << rejection(text, options);
}

struct Broken {
  std::string text, wanted;
};

TEST(MeshFiles, BrokenFilesAreRejectedWithTheirLine) {
  const std::string nodes = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n";
  const std::vector<Broken> cases{
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3\n*NSET,NSET=A\n1\n",
       "mesh:7: error: element 1 has 3 nodes; 4 were expected"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3,8\n", "mesh:7: error: element 1: node 8 is not defined"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3,4\n1,1,2,3,4\n", "mesh:8: error: element 1 stands twice"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,x,4\n", "mesh:7: error: the number of a node was expected, not 'x'"},
      {nodes + "*ELEMENT,TYPE=C3D8\n1,1,2,3,4,1,2,3,4\n", "only C3D8"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3,4\n*ELEMENT,TYPE=CAX4\n2,1,2,3,4\n",
       "mesh:8: error: CAX4 stands beside"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3,4\n*NSET,NSET=A\n7\n",
       "mesh:9: error: set A: node 7 is not defined"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3,4\n*NSET,NSET=A,GENERATE\n4,1\n",
       "mesh:9: error: the numbers of GENERATE"},
      {nodes + "*ELEMENT,TYPE=CPE4\n1,1,2,3,4\n*ELSET,ELSET=A\nB\n",
       "mesh:9: error: set A: a number or the name"},
      {nodes + "*ELEMENT\n1,1,2,3,4\n", "mesh:6: error: *ELEMENT needs its name: TYPE=NAME"},
      {nodes + "*INCLUDE, INPUT=more.inp\n",
       "mesh:6: error: *INCLUDE is not supported: put the lines of more.inp"},
      {nodes + "*NGEN\n1,4\n", "mesh:6: error: *NGEN is not supported"},
      {"*NODE\n1,0,nan\n", "mesh:2: error: a coordinate was expected, not 'nan'"},
      {"*NODE\n1,0,0\n1,0,0\n", "mesh:3: error: node 1 stands twice"},
      {"*NODE\n1,0\n", "mesh:2: error: node 1 needs x and y"},
      {"1,0,0\n", "mesh:1: error: a keyword such as *NODE"},
      {"", "the file holds no mesh"},
      {nodes + "*ELEMENT,TYPE=CPE3\n1,1,2,2\n", "mesh:7: error: element 1 has no area"},
      {"$MeshFormat\n3.0 0 8\n$EndMeshFormat\n", "mesh:2: error: MSH version 3.0 is not known; 4.1 or 2.2"},
      {"$MeshFormat\n2.2 1 8\n", "mesh:2: error: the file is binary, of version 2.2"},
      {kText22.substr(0, kText22.find("9 5 5")) + "$EndNodes\n",
       "a whole number was expected, not '$EndNodes'"},
  };
  for (const Broken& one : cases)
    EXPECT_NE(rejection(one.text).find(one.wanted), std::string::npos) << one.wanted << "\n"
                                                                       << rejection(one.text);
  ForeignMeshOptions options;
  options.uses = {mesh_use("fix", "botom=xy")};
  EXPECT_NE(rejection(block("CPE8"), options).find("did you mean bottom?"), std::string::npos)
      << rejection(block("CPE8"), options);
  EXPECT_THROW(mesh_use("fix", "bottom=z"), std::invalid_argument);
  EXPECT_THROW(mesh_use("force", "a=1"), std::invalid_argument);
}

// Cut short and with bytes changed: a model or an InputError, nothing else.
TEST(MeshFiles, DamagedFilesNeverCrash) {
  std::mt19937 random(7);
  int rejected = 0;
  for (const std::string& good : {kText41, kText22, kInp, binary41(), block("CPE8")})
    for (int i = 0; i < 400; ++i) {
      std::string text = good;
      if (i % 2 == 0) text.resize(random() % text.size());
      for (unsigned n = random() % 4; n > 0 && !text.empty(); --n)
        text[random() % text.size()] =
            static_cast<char>(i % 3 == 0 ? random() % 256 : "0123456789-.,*$ \n\""[random() % 18]);
      try {
        mesh_of(text);
      } catch (const InputError&) {
        ++rejected;
      }
    }
  EXPECT_GT(rejected, 1000);
}

}  // namespace
}  // namespace sage::test
