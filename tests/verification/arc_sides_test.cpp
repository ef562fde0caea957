// Meshes of a drawing with arcs: finer ones follow the circle, and no longer the sides of the first mesh.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "sage/app/commands.hpp"
#include "sage/mesh/subdivide.hpp"
#include "sage/model/arc_sides.hpp"
#include "sage/model/locate.hpp"
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

const std::string kMaterials = R"(
material = [
  {name = "soil", law = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3},
  {name = "lining", law = "section_elastic", axial_stiffness = 1, bending_stiffness = 1},
  {name = "joint", law = "goodman", normal_stiffness = 100, shear_stiffness = 100},
]
)";

// The beginning of a model file; its points and what is drawn follow.
std::string drawing(const std::string& element, double size, const std::string& mesher,
                    const std::string& materials = kMaterials) {
  return fmt::format(R"(
geometry = "plane strain"
units = {{length = "m", force = "kN", stress = "kPa"}}
mesh = {{element = "{}", size = {}, mesher = "{}"}})",
                     element, size, mesher) +
         materials;
}

// A quarter of Lame's ring, radii 1 and 2, E = 1, nu = .3, pressure 1 within; two elements along the inner arc.
std::string ring(const std::string& element, const std::string& mesher, const std::string& more = "") {
  return drawing(element, 0.8, mesher) + R"(
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
        if (!sides.centre(nodes[edge[0]], nodes[edge[1]])) continue;
        const double radius = model.mesh.x.col(nodes[edge[0]]).norm();
        for (const int local : edge) {
          EXPECT_NEAR(model.mesh.x.col(nodes[local]).norm(), radius, 1e-14);
          ++counted;
        }
      }
  EXPECT_GT(counted, 0);
  EXPECT_FALSE(has_parabolic_sides(model));
}

// Corners of elements on a circle around the origin; all sides between two of them follow it, and their nodes.
std::size_t nodes_on_circle(const Model& model, double radius) {
  const auto on = [&](int node) { return std::abs(model.mesh.x.col(node).norm() - radius) < 1e-12; };
  const ArcSides sides(model.mesh);
  std::size_t straight = 0, off = 0;
  std::set<std::pair<double, double>> corners;
  for (const Group& group : model.groups)
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const int* const nodes = group.nodes_of(e);
        const int a = nodes[edge[0]], z = nodes[edge[1]];
        if (!on(a) || !on(z) || a == z) continue;
        straight += sides.centre(a, z) ? 0 : 1;
        for (const int local : edge) off += on(nodes[local]) ? 0 : 1;
        for (const int node : {a, z})
          corners.emplace(std::round(1e9 * model.mesh.x(0, node)), std::round(1e9 * model.mesh.x(1, node)));
      }
  EXPECT_EQ(straight, 0u);
  EXPECT_EQ(off, 0u);
  return corners.size();
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
    expect_on_circles(model, 3);
    int beams = 0;
    for (const Group& group : model.groups) {
      if (!group.structure()) continue;
      for (const int node : group.nodes) EXPECT_NEAR(model.mesh.x.col(node).norm(), 1.5, 1e-14);
      beams += group.elements();
    }
    EXPECT_GT(beams, 8);
  }
}

// Where another line with joints meets a circle, the bodies beside it have nodes of their own, and all of these follow it:
// a lining that a fault crosses.
TEST(ArcSides, JointsThatCrossACircleFollowIt) {
  if (!gmsh_available()) GTEST_SKIP() << "no Gmsh";
  for (const char* const element : {"quad4", "quad8", "tri6"}) {
    const std::string text = drawing(element, 3.0, "gmsh") + R"(
points = {centre = [0, 0], sw = [-10, -10], se = [10, -10]}
line = [
  {name = "lining", shape = "circle", centre = "centre", radius = 2, size = 1.3, beam = "lining", interface = {side = "both", material = "joint"}},
  {name = "fault", points = [[-10, 0], [10, 0]], beam = "lining", interface = {side = "both", material = "joint"}},
]
area = [{name = "ground", outline = ["sw", "se", [10, 10], [-10, 10]], material = "soil"}]
fixity = [{point = "sw", x = "fixed", y = "fixed"}, {point = "se", y = "fixed"}]
[[stage]]
)";
    const std::size_t first = nodes_on_circle(model_of(text, 0), 2.0),
                      finer = nodes_on_circle(model_of(text, 2), 2.0);
    EXPECT_EQ(finer, 4 * first);
  }
}

// Joints that end on the inner circle of a ring divide its sides too.
TEST(ArcSides, JointsThatEndAtACircleFollowIt) {
  if (!gmsh_available()) GTEST_SKIP() << "no Gmsh";
  for (const char* const element : {"quad4", "quad8"}) {
    const std::string text = drawing(element, 0.8, "gmsh") + R"(
points = {centre = [0, 0]}
line = [
  {name = "hole", shape = "circle", centre = "centre", radius = 1},
  {name = "outer", shape = "circle", centre = "centre", radius = 3},
  {name = "east", points = [[1, 0], [3, 0]], interface = {side = "both", material = "joint"}},
  {name = "west", points = [[-3, 0], [-1, 0]], interface = {side = "both", material = "joint"}},
]
area = [{name = "ring", outline = ["outer"], holes = [["hole"]], material = "soil"}]
fixity = [{line = "outer", x = "fixed", y = "fixed"}]
[[stage]]
)";
    const Model model = model_of(text, 2);
    for (int i = 0; i < model.mesh.nodes(); ++i) {
      const double radius = model.mesh.x.col(i).norm();
      EXPECT_GE(radius, 1.0 - 1e-14);
      EXPECT_LE(radius, 3.0 + 1e-13);
    }
  }
}

// Half of a lining with joints, whose ends can't turn on the line of symmetry: of the nodes there the lining's alone have a
// rotation.  Its ring force and moment are those of the whole.
TEST(ArcSides, RotationsOfHalfALiningAreHeldAtItsEnds) {
  if (!gmsh_available()) GTEST_SKIP() << "no Gmsh";
  const auto moment_of = [](bool half) {
    const std::string lining = half ? R"(shape = "arc", points = ["invert", "crown"], centre = "centre")"
                                    : R"(shape = "circle", centre = "centre", radius = 2)";
    const std::string left = half ? "0" : "-8";
    const std::string materials = R"(
material = [
  {name = "soil", law = "linear_elastic", youngs_modulus = 1e4, poissons_ratio = 0.3},
  {name = "lining", law = "section_elastic", axial_stiffness = 1e6, bending_stiffness = 1e4},
  {name = "joint", law = "goodman", normal_stiffness = 1e6, shear_stiffness = 1e3},
]
)";
    const std::string text = drawing("quad8", 1.2, "gmsh", materials) +
                             fmt::format(R"(
points = {{centre = [0, 0], crown = [0, 2], invert = [0, -2]}}
line = [
  {{name = "lining", {0}, size = 0.5, beam = "lining", interface = {{side = "both", material = "joint"}}}},
  {{name = "left", points = [[{1}, -8], [{1}, 8]]}},
  {{name = "right", points = [[8, -8], [8, 8]]}},
  {{name = "bottom", points = [[{1}, -8], [8, -8]]}},
  {{name = "top", points = [[8, 8], [{1}, 8]]}},
]
area = [{{name = "ground", outline = [[{1}, -8], [8, -8], [8, 8], [{1}, 8]], material = "soil"}}]
fixity = [{{line = "left", x = "fixed"}}, {{line = "right", x = "fixed"}}, {{line = "bottom", y = "fixed"}}{2}]
[[stage]]
pressure = [{{line = "top", normal1 = 100, normal2 = 100}}]
)",
                                         lining, left,
                                         half ? R"(, {point = "crown", unknown = "rotation", x = "fixed"},
  {point = "invert", unknown = "rotation", x = "fixed"})"
                                              : "");
    scenes::WholeRun run = bench().run(model_of(text, 1));
    EXPECT_TRUE(run.completed()) << run.failure;
    for (std::size_t g = 0; g < run.model->groups.size(); ++g)
      if (run.model->groups[g].structure()) return run.stress[g].row(2).cwiseAbs().maxCoeff();
    return 0.0;
  };
  const double whole = moment_of(false), half = moment_of(true);
  EXPECT_GT(whole, 0.0);
  EXPECT_NEAR(half, whole, 0.01 * whole);  // on other meshes
}

// Beyond an open end of a joint the ground is whole: two elements share the first edge but for the pair at the end, and what
// divides it divides both.  Nodes on the edge were made twice, so that the ground stayed open over one edge of the first mesh.
TEST(ArcSides, TheGroundIsWholeBeyondOpenEndsOfJoints) {
  if (!gmsh_available()) GTEST_SKIP() << "no Gmsh";
  for (const char* const element : {"quad4", "quad8", "tri6"})
    for (const char* const shape :
         {"points = [[-2, 0], [2, 0]]", "shape = \"arc\", points = [[2, 0], [0, 2]], centre = \"centre\""}) {
      const std::string text = drawing(element, 1.5, "gmsh") + fmt::format(R"(
points = {{centre = [0, 0]}}
line = [
  {{name = "joint", {}, beam = "lining", first_end = "open", last_end = "open", interface = {{side = "both", material = "joint"}}}},
  {{name = "bottom", points = [[-5, -5], [5, -5]]}},
]
area = [{{name = "ground", outline = [[-5, -5], [5, -5], [5, 5], [-5, 5]], material = "soil"}}]
fixity = [{{line = "bottom", x = "fixed", y = "fixed"}}]
[[stage]]
)",
                                                                           shape);
      for (const int refine : {0, 1, 2}) {
        const Model model = model_of(text, refine);
        std::set<int> of_joints;
        for (const Group& group : model.groups)
          if (group.interface()) of_joints.insert(group.nodes.begin(), group.nodes.end());
        std::map<std::pair<double, double>, int> others;
        for (int i = 0; i < model.mesh.nodes(); ++i)
          if (!of_joints.contains(i))
            ++others[{std::round(1e8 * model.mesh.x(0, i)), std::round(1e8 * model.mesh.x(1, i))}];
        for (const auto& [place, count] : others)
          EXPECT_EQ(count, 1) << element << ' ' << shape << ' ' << refine << " (" << place.first << ' '
                              << place.second;
      }
    }
}

// The places where a point lies that typed digits put a little off the circle: the sides that end there go on around the
// centre, and the error of Lame's ring is that of its mesh.
TEST(ArcSides, EndsOfTypedDigitsAreOnTheirCircles) {
  std::string text = ring("quad8", "blocks");
  text.replace(text.find("d = [0, 1]"), 10, "d = [0, 1.00002]");
  scenes::WholeRun run = bench().run(model_of(text, 2));
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_EQ(run.model->mesh.arcs.size(), 2u);
  EXPECT_LT(scenes::lame_error(run, scenes::LameBody::sector, 0.3),
            5e-5);  // 2e-5 of the place, 2e-5 of the mesh
}

// A stiff core in a square, with circles that begin at several angles: no element has two sides on the circle, which would
// make its corner between them flatter in each finer mesh, and no place of the circle is a singular corner.
TEST(ArcSides, NoElementHasTwoSidesOnACircle) {
  if (!gmsh_available()) GTEST_SKIP() << "no Gmsh";
  for (const char* const element : {"quad4", "quad8", "tri6"})
    for (const double angle : {0.0, 10.0, 33.0, 77.0}) {
      const std::string materials = R"(
material = [
  {name = "soil", law = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3},
  {name = "core", law = "linear_elastic", youngs_modulus = 3, poissons_ratio = 0.3},
]
)";
      const std::string text = drawing(element, 1.5, "gmsh", materials) + fmt::format(R"(
points = {{centre = [0, 0]}}
line = [
  {{name = "rim", shape = "circle", centre = "centre", radius = 1, start_angle = {}}},
  {{name = "bottom", points = [[-4, -4], [4, -4]]}},
  {{name = "left", points = [[-4, -4], [-4, 4]]}},
]
area = [
  {{name = "ground", outline = [[-4, -4], [4, -4], [4, 4], [-4, 4]], holes = [["rim"]], material = "soil"}},
  {{name = "inside", outline = ["rim"], material = "core"}},
]
fixity = [{{line = "bottom", y = "fixed"}}, {{line = "left", x = "fixed"}}]
[[stage]]
)",
                                                                                      angle);
      const Model model = model_of(text, 0);
      const ArcSides sides(model.mesh);
      for (const Group& group : model.groups)
        for (int e = 0; e < group.elements(); ++e) {
          const int* const nodes = group.nodes_of(e);
          int on_circle = 0;
          for (const std::vector<int>& edge : group.element->edges())
            on_circle += sides.centre(nodes[edge[0]], nodes[edge[1]]) ? 1 : 0;
          EXPECT_LE(on_circle, 1) << element << ' ' << angle;
        }
      EXPECT_TRUE(mesh::singular_corners(model).empty()) << element << ' ' << angle;
    }
}

// The first mesh is a polygon within the circle, the body of the drawing is not.
TEST(ArcSides, PointsOnADrawnCircleAreInTheMesh) {
  for (const char* const element : {"quad4", "quad8", "tri3"}) {
    const Model model = model_of(ring(element, "blocks"), 0);
    const Locator locator(model);
    for (const double angle : {0.1, 0.3, 0.8, 1.3})
      for (const double radius : {1.0, 2.0}) {
        const auto at = [&](double r) { return locator.at(r * Vector2(std::cos(angle), std::sin(angle))); };
        EXPECT_EQ(at(radius).size(), 1u) << element << ' ' << angle << ' ' << radius;
        EXPECT_TRUE(at(2.001).empty());
      }
    const double middle = 0.05 * std::numbers::pi;  // of the first of five sides
    EXPECT_TRUE(locator.at(0.985 * Vector2(std::cos(middle), std::sin(middle))).empty()) << "in the hole";
    EXPECT_TRUE(locator.at({1.99, -0.005}).empty()) << "beside the end of the arc";
  }
}

// A straight side between two nodes of a circle is not part of it: the flat invert of a tunnel.
TEST(ArcSides, ChordsStayStraight) {
  const std::string text = drawing("tri3", 3.0, "gmsh") + R"(
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
