// Meshes of a drawing with arcs: finer ones follow the circle, and no longer the sides of the first mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sage/app/commands.hpp"
#include "sage/model/arc_sides.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/section/section_mesh.hpp"
#include "tests/studies/scenes/lame.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

const scenes::Workbench& bench() {
  static const scenes::Workbench all = app::make_workbench();
  return all;
}

// A quarter of Lame's ring, radii 1 and 2, E = 1, nu = .3, pressure 1 within; two elements along the inner arc.
std::string ring(const std::string& element, const std::string& mesher, const std::string& more = "") {
  return R"(
geometry = "plane strain"
units = {length = "m", force = "kN", stress = "kPa"}
mesh = {element = ")" +
         element + R"(", size = 0.8, mesher = ")" + mesher + R"("}
material = [
  {name = "soil", law = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3},
  {name = "lining", law = "section_elastic", axial_stiffness = 1, bending_stiffness = 1},
  {name = "joint", law = "goodman", normal_stiffness = 100, shear_stiffness = 100},
]
points = {centre = [0, 0], a = [1, 0], b = [2, 0], c = [0, 2], d = [0, 1]}
line = [
  {name = "inner", shape = "arc", points = ["a", "d"], centre = "centre"},
  {name = "outer", shape = "arc", points = ["b", "c"], centre = "centre"},
  {name = "bottom", points = ["a", "b"]},
  {name = "left", points = ["d", "c"]},
)" + more +
         R"(]
area = [{name = "ring", outline = ["bottom", "outer", "left", "inner"], material = "soil"}]
fixity = [{line = "bottom", y = "fixed"}, {line = "left", x = "fixed"}]
[[stage]]
pressure = [{line = "inner", side = "right", normal1 = 1, normal2 = 1}]
)";
}

Model model_of(const std::string& text, int refine, bool layers = false, int element = 0) {
  BuildOptions options;
  options.refine = refine;
  if (layers) options.gradings = {{1, 3, 0.15}};
  options.refine_graded = layers ? 1 : 0;
  options.element = element;
  return build_model(read_model_file_text(text, "ring.sage.toml"), bench().catalogue(), options);
}

// Relative error of the displacements at all nodes.
double error_of(const std::string& element, const std::string& mesher, int refine) {
  scenes::WholeRun run = bench().run(model_of(ring(element, mesher), refine));
  EXPECT_TRUE(run.completed()) << run.failure;
  return scenes::lame_error(run, scenes::LameBody::sector, 0.3);
}

// The closed form is that of circles, so the error falls with the order of the element (2 and 4, measured at nodes) until the
// fourth mesh.  On sides that stay straight or parabolas it stays above .04 and 1e-3.
TEST(ArcSides, FinerMeshesConvergeToTheCircle) {
  for (const auto& [element, mesher, order, last] :
       {std::tuple{"quad4", "blocks", 1.9, 3e-3}, std::tuple{"quad8", "blocks", 3.4, 3e-6},
        std::tuple{"tri3", "gmsh", 1.7, 6e-3}, std::tuple{"tri6", "gmsh", 3.2, 2e-5}}) {
    if (std::string(mesher) == "gmsh" && !gmsh_available()) continue;
    const double coarse = error_of(element, mesher, 2), fine = error_of(element, mesher, 3);
    EXPECT_GT(std::log2(coarse / fine), order) << element << ' ' << coarse << ' ' << fine;
    EXPECT_LT(fine, last) << element;
  }
}

// Nodes along the inner and the outer arc of a model: all have the radius of their circle, to rounding.
void expect_on_circles(const Model& model, std::size_t arcs) {
  EXPECT_EQ(model.mesh.arcs.size(), arcs);
  const ArcSides sides(model.mesh);
  int counted = 0;
  for (const Group& group : model.groups)
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const int* const nodes = group.nodes_of(e);
        if (!sides.contains(nodes[edge[0]], nodes[edge[1]])) continue;
        const double radius = model.mesh.x.col(nodes[edge[0]]).norm();
        for (const int local : edge) {
          EXPECT_NEAR(model.mesh.x.col(nodes[local]).norm(), radius, 1e-14);
          ++counted;
        }
      }
  EXPECT_GT(counted, 0);
  EXPECT_FALSE(has_parabolic_sides(model));
}

// Layers at a corner divide sides unevenly; elements of higher degree have more nodes inside a side.
TEST(ArcSides, LayersAndHighDegreesFollowTheCircle) {
  constexpr int kQuad25 = 7;
  expect_on_circles(model_of(ring("quad8", "blocks"), 1, true), 2);
  expect_on_circles(model_of(ring("quad4", "blocks"), 2, true), 2);
  expect_on_circles(model_of(ring("quad4", "blocks"), 1, false, kQuad25), 2);
}

// A lining with joints to the ground has nodes of its own on the same circle.
TEST(ArcSides, LiningsAndJointsFollowTheCircle) {
  const std::string lining =
      R"(  {name = "lining", shape = "arc", points = [[1.5, 0], [0, 1.5]], centre = "centre", beam = "lining", interface = {side = "both", material = "joint"}},
)";
  for (const char* const element : {"quad8", "quad4"}) {
    const Model model = model_of(ring(element, "automatic", lining), 2);
    expect_on_circles(model, 5);
    int beams = 0;
    for (const Group& group : model.groups) {
      if (!group.structure()) continue;
      for (const int node : group.nodes) EXPECT_NEAR(model.mesh.x.col(node).norm(), 1.5, 1e-14);
      beams += group.elements();
    }
    EXPECT_GT(beams, 8);
  }
}

// A straight side between two nodes of a circle is not part of it: the flat invert of a tunnel.
TEST(ArcSides, ChordsStayStraight) {
  const std::string text = R"(
geometry = "plane strain"
units = {length = "m", force = "kN", stress = "kPa"}
mesh = {element = "tri3", size = 3, mesher = "gmsh"}
material = [{name = "soil", law = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3}]
points = {centre = [0, 0], a = [1, 0], d = [-1, 0]}
line = [{name = "crown", shape = "arc", points = ["a", "d"], centre = "centre", size = 3}]
area = [{name = "ground", outline = [[-3, -3], [3, -3], [3, 3], [-3, 3]], holes = [["crown"]], material = "soil"}]
fixity = [{point = "a", x = "fixed", y = "fixed"}, {point = "d", y = "fixed"}]
[[stage]]
)";
  if (!gmsh_available()) GTEST_SKIP() << "no Gmsh";
  const Model model = model_of(text, 2);
  ASSERT_EQ(model.mesh.arcs.size(), 1u);
  int flat = 0;
  for (int i = 0; i < model.mesh.nodes(); ++i) {
    const Vector2 x = model.mesh.x.col(i);
    if (x.norm() > 1.0 - 1e-9) continue;
    EXPECT_LT(x.y(), 1e-14);  // ground within the circle is below the invert
    flat += x.y() > -1e-14 ? 1 : 0;
  }
  EXPECT_GE(flat, 3);
}

}  // namespace
}  // namespace sage::test
