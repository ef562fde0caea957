// Geometry to mesh.  Areas and lengths come from the drawings; numbers of copies from counting sectors by hand.
#include <cmath>
#include <random>

#include "tests/unit/section/section_checks.hpp"

namespace sage::test {

namespace {

struct Kind {
  ElementShape shape;
  int nodes;
  Mesher mesher;
};

const Kind kKinds[] = {
    {ElementShape::quadrilateral, 2, Mesher::blocks}, {ElementShape::quadrilateral, 3, Mesher::blocks},
    {ElementShape::triangle, 3, Mesher::blocks},      {ElementShape::triangle, 2, Mesher::gmsh},
    {ElementShape::triangle, 3, Mesher::gmsh},        {ElementShape::quadrilateral, 3, Mesher::gmsh}};

// Of a rectilinear section, by all means there are.
template <class Check>
void with_all_kinds(Section section, const Check& check) {
  for (const Kind& kind : kKinds) {
    if (kind.mesher == Mesher::gmsh && !gmsh_available()) continue;
    SCOPED_TRACE(std::to_string(static_cast<int>(kind.shape)) + " with " + std::to_string(kind.nodes) +
                 " nodes, mesher " + std::to_string(static_cast<int>(kind.mesher)));
    section.shape = kind.shape;
    section.nodes_per_edge = kind.nodes;
    MeshSettings settings;
    settings.mesher = kind.mesher;
    check(mesh_section(section, settings));
  }
}

int copies(const SectionMesh& mesh, double x, double y) {
  return static_cast<int>(std::count_if(
      mesh.x.begin(), mesh.x.end(), [&](const Vector2& node) { return (node - Vector2(x, y)).norm() < 1e-9; }));
}

SectionMesh by_gmsh(const Section& section) {
  MeshSettings settings;
  settings.mesher = Mesher::gmsh;
  return mesh_section(section, settings);
}

TEST(SectionMesh, TwoRectanglesWithAJoint) {
  Section section;
  add_rectangle(section, "lower", 0, 0, 4, 1);
  add_rectangle(section, "upper", 0, 1, 4, 3);
  section.size = 0.5;
  add_line(section, "joint", {{0, 1}, {4, 1}}, InterfaceSide::both, false);
  with_all_kinds(section, [](const SectionMesh& mesh) {
    const MeshCheck check(mesh);
    EXPECT_NEAR(check.area(0), 4.0, 1e-12);
    EXPECT_NEAR(check.area(1), 8.0, 1e-12);
    EXPECT_NEAR(check.free_length(), 14.0 + 2 * 4.0, 1e-12);
    const LineMesh& joint = mesh.lines[0];
    EXPECT_EQ(joint.left_interfaces.size(), joint.segments.size());
    EXPECT_TRUE(joint.right_interfaces.empty());
    // To the right of the way from (0, 1) to (4, 1) is the lower body.
    EXPECT_EQ(joint.segments.front().left.area, 1);
    EXPECT_EQ(joint.segments.front().right.area, 0);
    for (std::size_t i = 0; i < joint.left.size(); ++i) EXPECT_NE(joint.left[i], joint.right[i]);
    EXPECT_TRUE(mesh.ties.empty());
  });
}

TEST(SectionMesh, BlocksHaveTheElementsOfTheirSize) {
  Section section;
  add_rectangle(section, "lower", 0, 0, 4, 1);
  add_rectangle(section, "upper", 0, 1, 4, 3);
  section.size = 0.5;
  section.shape = ElementShape::quadrilateral;
  const SectionMesh mesh = mesh_section(section);
  EXPECT_FALSE(mesh.by_gmsh);
  EXPECT_EQ(MeshCheck(mesh).elements(0), 8 * 2);
  EXPECT_EQ(MeshCheck(mesh).elements(1), 8 * 4);
  EXPECT_EQ(mesh.x.size(), 17U * 13U - 8U * 6U);  // quad8: no nodes in the middle
  MeshSettings finer;
  finer.size_factor = 0.5;
  EXPECT_EQ(MeshCheck(mesh_section(section, finer)).elements(1), 16 * 8);
}

Section wall_in_layers() {
  Section section;
  add_rectangle(section, "sand", 0, -4, 20, 0);
  add_rectangle(section, "clay", 0, -10, 20, -4);
  section.size = 1.0;
  add_line(section, "wall", {{10, 0}, {10, -6}}, InterfaceSide::both, true);
  return section;
}

TEST(SectionMesh, AWallHasThreeRowsOfNodesAndTwoAtItsToe) {
  with_all_kinds(wall_in_layers(), [](const SectionMesh& mesh) {
    const MeshCheck check(mesh);
    EXPECT_NEAR(check.area(0), 80.0, 1e-9);
    EXPECT_NEAR(check.area(1), 120.0, 1e-9);
    EXPECT_NEAR(check.free_length(), 60.0 + 2 * 6.0, 1e-9);
    const LineMesh& wall = mesh.lines[0];
    EXPECT_EQ(wall.left_interfaces.size(), wall.segments.size());
    EXPECT_EQ(wall.right_interfaces.size(), wall.segments.size());
    // Downwards: left is east.
    for (const LineSegment& segment : wall.segments) EXPECT_EQ(segment.left.area, segment.right.area);
    for (std::size_t i = 0; i < wall.beam.size(); ++i) {
      const std::set<int> here{wall.left[i], wall.beam[i], wall.right[i]};
      EXPECT_EQ(here.size(), i + 1 < wall.beam.size() ? 3U : 2U);
    }
    EXPECT_EQ(copies(mesh, 10, 0), 3);
    EXPECT_EQ(copies(mesh, 10, -4), 3);
    EXPECT_EQ(copies(mesh, 10, -6), 2);
    EXPECT_EQ(wall.left.back(), wall.right.back());
    EXPECT_EQ(mesh.points[9].beam, wall.beam.back());
    EXPECT_EQ(mesh.points[8].nodes.size(), 3U);
    EXPECT_EQ(mesh.points[8].nodes[0], wall.beam[0]);
    EXPECT_TRUE(mesh.ties.empty());
  });
}

TEST(SectionMesh, TheExampleOfTheManual) {
  SAGE_NEEDS_GMSH();
  Section section;
  section.points = {{"A", {0, 0}},  {"B", {20, 0}},    {"C", {20, 10}},
                    {"D", {0, 10}}, {"top", {10, 10}}, {"toe", {10, 4}}};
  section.areas = {{"clay", {{0}, {1}, {2}, {3}}}};
  SectionLine wall;
  wall.name = "wall";
  wall.points = {4, 5};
  wall.beam = true;
  wall.interface = InterfaceSide::both;
  wall.size = 0.5;
  section.lines = {wall};
  section.size = 2.0;
  const SectionMesh mesh = mesh_section(section);
  EXPECT_NEAR(MeshCheck(mesh).area(0), 200.0, 1e-9);
  EXPECT_EQ(mesh.lines[0].segments.size(), 12U);
}

TEST(SectionMesh, TheToeCanBeTiedOrOpen) {
  Section section = wall_in_layers();
  section.lines[0].last_end = LineEnd::tied;
  with_all_kinds(section, [](const SectionMesh& mesh) {
    const MeshCheck check(mesh);
    ASSERT_EQ(mesh.ties.size(), 1U);
    EXPECT_EQ(mesh.ties[0].first, mesh.lines[0].beam.back());
    EXPECT_EQ(mesh.ties[0].second, mesh.lines[0].left.back());
    EXPECT_EQ(mesh.ties[0].kind, NodePair::Kind::toe);
  });
  section.lines[0].last_end = LineEnd::open;
  with_all_kinds(section, [](const SectionMesh& mesh) {
    const MeshCheck check(mesh);
    EXPECT_TRUE(mesh.ties.empty());
    EXPECT_EQ(copies(mesh, 10, -6), 3);
    EXPECT_NE(mesh.lines[0].left.back(), mesh.lines[0].right.back());
  });
}

TEST(SectionMesh, ABeamWithoutInterfacesSharesTheNodesOfTheGround) {
  Section section = wall_in_layers();
  section.lines[0].interface = InterfaceSide::none;
  with_all_kinds(section, [](const SectionMesh& mesh) {
    EXPECT_NEAR(MeshCheck(mesh).free_length(), 60.0, 1e-9);
    EXPECT_EQ(mesh.lines[0].beam, mesh.lines[0].left);
    EXPECT_EQ(mesh.lines[0].beam, mesh.lines[0].right);
    EXPECT_TRUE(mesh.lines[0].left_interfaces.empty());
  });
  section.lines[0].interface = InterfaceSide::left;
  with_all_kinds(section, [](const SectionMesh& mesh) {
    EXPECT_EQ(copies(mesh, 10, -2), 2);
    EXPECT_EQ(mesh.lines[0].beam[0], mesh.lines[0].right[0]);
    EXPECT_EQ(mesh.lines[0].left_interfaces.size(), mesh.lines[0].segments.size());
    EXPECT_TRUE(mesh.lines[0].right_interfaces.empty());
    EXPECT_TRUE(mesh.ties.empty());
  });
}

TEST(SectionMesh, CrossingJointsMakeFourNodesAndEndingOnesThree) {
  Section section;
  add_rectangle(section, "rock", 0, 0, 4, 4);
  section.size = 0.5;
  add_line(section, "flat", {{0, 2}, {4, 2}}, InterfaceSide::both, false);
  add_line(section, "upright", {{1, 0}, {1, 4}}, InterfaceSide::both, false);
  add_line(section, "ending", {{3, 4}, {3, 2}}, InterfaceSide::both, false);
  add_line(section, "base", {{0, 0}, {4, 0}}, InterfaceSide::none, false);
  with_all_kinds(section, [](const SectionMesh& mesh) {
    // Supports along the base need both nodes where the upright joint reaches it.
    EXPECT_EQ(mesh.lines[3].nodes.size(), mesh.lines[3].left.size() + 1);
    EXPECT_NEAR(MeshCheck(mesh).free_length(), 16.0 + 2 * (4 + 4 + 2), 1e-9);
    EXPECT_EQ(copies(mesh, 1, 2), 4);
    EXPECT_EQ(copies(mesh, 3, 2), 3);
    EXPECT_EQ(copies(mesh, 2, 2), 2);
    EXPECT_EQ(copies(mesh, 0, 2), 2);
    EXPECT_TRUE(mesh.ties.empty());
  });
}

TEST(SectionMesh, AJointThatEndsInsideIsOpenOrTied) {
  Section section;
  add_rectangle(section, "rock", 0, 0, 4, 4);
  section.size = 0.5;
  add_line(section, "joint", {{0, 2}, {2, 2}}, InterfaceSide::left, false);
  with_all_kinds(section, [](const SectionMesh& mesh) {
    const MeshCheck check(mesh);
    EXPECT_EQ(copies(mesh, 2, 2), 2);
    EXPECT_TRUE(mesh.ties.empty());
  });
  section.lines[0].last_end = LineEnd::joined;
  with_all_kinds(section, [](const SectionMesh& mesh) {
    const MeshCheck check(mesh);
    EXPECT_NEAR(check.free_length(), 16.0 + 2 * 2, 1e-9);
    ASSERT_EQ(mesh.ties.size(), 1U);
    EXPECT_EQ(mesh.ties[0].kind, NodePair::Kind::end);
    EXPECT_EQ(mesh.lines[0].left.back(), mesh.lines[0].right.back());
  });
}

TEST(SectionMesh, WallAndSlabShareANode) {
  for (const InterfaceSide side : {InterfaceSide::none, InterfaceSide::right, InterfaceSide::both}) {
    Section section = wall_in_layers();
    add_line(section, "slab", {{0, -3}, {10, -3}}, side, true);
    with_all_kinds(section, [&](const SectionMesh& mesh) {
      const MeshCheck check(mesh);
      EXPECT_EQ(mesh.lines[1].beam.back(), mesh.points[11].beam);
      EXPECT_TRUE(std::count(mesh.lines[0].beam.begin(), mesh.lines[0].beam.end(), mesh.lines[1].beam.back()));
      // East one body; west one below and one above, or one that the bonded slab holds together.
      EXPECT_EQ(copies(mesh, 10, -3), side == InterfaceSide::none ? 3 : 4);
      // Bonded ground can't share the node of the wall, from which its interface parts it.
      EXPECT_EQ(mesh.ties.size(), side == InterfaceSide::both ? 0U : 1U);
    });
  }
}

TEST(SectionMesh, ALiningThatClosesHasThreeRows) {
  SAGE_NEEDS_GMSH();
  Section section;
  add_rectangle(section, "ground", -5, -5, 5, 5);
  section.size = 1.0;
  SectionLine lining;
  lining.name = "lining";
  lining.shape = LineShape::circle;
  lining.centre = add_point(section, 0, 0);
  lining.radius = 2.0;
  lining.beam = true;
  lining.interface = InterfaceSide::both;
  section.lines.push_back(lining);
  SectionArea core;
  core.name = "core";
  core.outline = {{-1, 0}};
  section.areas[0].holes = {core.outline};
  section.areas.push_back(core);
  for (const ElementShape shape : {ElementShape::triangle, ElementShape::quadrilateral}) {
    section.shape = shape;
    const SectionMesh mesh = by_gmsh(section);
    const MeshCheck check(mesh);
    EXPECT_NEAR(check.area(1), kPi * 4.0, 2e-3);
    EXPECT_NEAR(check.area(0) + check.area(1), 100.0, 1e-9);
    const LineMesh& line = mesh.lines[0];
    EXPECT_EQ(line.beam.front(), line.beam.back());
    EXPECT_EQ(line.left.front(), line.left.back());
    EXPECT_EQ(line.left_interfaces.size(), line.segments.size());
    // Counter-clockwise: the core is to the left.
    for (const LineSegment& segment : line.segments) {
      EXPECT_EQ(segment.left.area, 1);
      EXPECT_EQ(segment.right.area, 0);
    }
    for (const int node : line.nodes) EXPECT_NEAR(mesh.x[node].norm(), 2.0, 1e-12);
    EXPECT_EQ(line.nodes.size(), 3 * (line.beam.size() - 1));
  }
}

TEST(SectionMesh, HalfALiningEndsOnTheAxisOfSymmetry) {
  SAGE_NEEDS_GMSH();
  Section section;
  add_rectangle(section, "ground", 0, -5, 5, 5);
  section.size = 1.0;
  SectionLine lining;
  lining.name = "lining";
  lining.shape = LineShape::arc;
  lining.points = {add_point(section, 0, -2), add_point(section, 0, 2)};
  lining.centre = add_point(section, 0, 0);
  lining.beam = true;
  lining.interface = InterfaceSide::right;
  section.lines.push_back(lining);
  section.areas[0].holes = {{{-1, 0}}};  // closed along the axis
  const SectionMesh mesh = by_gmsh(section);
  const MeshCheck check(mesh);
  EXPECT_NEAR(check.area(0), 50.0 - kPi * 2.0, 2e-3);
  const LineMesh& line = mesh.lines[0];
  EXPECT_EQ(line.right_interfaces.size(), line.segments.size());
  EXPECT_TRUE(std::all_of(line.left.begin(), line.left.end(), [](int node) { return node < 0; }));
  for (std::size_t i = 0; i < line.beam.size(); ++i) EXPECT_NE(line.beam[i], line.right[i]);
  EXPECT_EQ(copies(mesh, 0, 2), 2);
  section.areas[0].holes.clear();
  const SectionMesh full = by_gmsh(section);
  EXPECT_NEAR(MeshCheck(full).area(0), 50.0, 1e-9);
  EXPECT_EQ(copies(full, 0, 2), 2);  // inside bonded to the beam, outside
}

TEST(SectionMesh, ACornerThatReenters) {
  SAGE_NEEDS_GMSH();
  Section section;
  section.areas.push_back(polygon(section, "L", {{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}}));
  section.size = 0.8;
  section.points[3].size = 0.1;
  const SectionMesh mesh = by_gmsh(section);
  const MeshCheck check(mesh);
  EXPECT_NEAR(check.area(0), 18.0, 1e-9);
  EXPECT_NEAR(check.free_length(), 22.0, 1e-9);
  const SectionMesh coarse = [&] {
    section.points[3].size = 0.0;
    return by_gmsh(section);
  }();
  EXPECT_GT(check.elements(0), 2 * MeshCheck(coarse).elements(0));
}

TEST(SectionMesh, SameInputSameMesh) {
  SAGE_NEEDS_GMSH();
  const SectionMesh one = by_gmsh(wall_in_layers());
  const SectionMesh other = by_gmsh(wall_in_layers());
  ASSERT_EQ(one.x.size(), other.x.size());
  for (std::size_t i = 0; i < one.x.size(); ++i) EXPECT_EQ(one.x[i], other.x[i]);
  EXPECT_EQ(one.areas[1].nodes, other.areas[1].nodes);
}

TEST(SectionMesh, RandomPolygonsWithWallsAndTunnels) {
  SAGE_NEEDS_GMSH();
  std::mt19937 random(39);
  const auto number = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 8U) / 16777216.0;
  };
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("polygon " + std::to_string(k));
    Section section;
    const int n = 5 + static_cast<int>(random() % 8);
    std::vector<Vector2> corners;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * (i + number(0.0, 0.3)) / n, radius = number(6.0, 10.0);
      corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    double area = 0.0;
    for (int i = 0; i < n; ++i) area += 0.5 * cross2(corners[i], corners[(i + 1) % n]);
    section.areas.push_back(polygon(section, "ground", corners));
    section.size = 2.0;
    section.nodes_per_edge = 2 + k % 2;
    section.shape = k % 4 < 2 ? ElementShape::triangle : ElementShape::quadrilateral;
    // Within 2.9 of the middle every place is ground.
    for (int w = 0; w < 1 + k % 3; ++w) {
      const double a = number(0, 2 * kPi), b = a + number(1.5, 4.5);
      add_line(section, "wall " + std::to_string(w),
               {2.9 * Vector2(std::cos(a), std::sin(a)), number(1.0, 2.9) * Vector2(std::cos(b), std::sin(b))},
               static_cast<InterfaceSide>(random() % 4), random() % 4 != 0);
    }
    if (k % 2 == 0) {
      SectionLine lining;
      lining.name = "lining";
      lining.shape = LineShape::circle;
      lining.centre = add_point(section, number(-1, 1), number(-1, 1));
      lining.radius = number(0.5, 1.5);
      lining.beam = true;
      lining.interface = static_cast<InterfaceSide>(random() % 4);
      section.lines.push_back(lining);
    }
    const SectionMesh mesh = by_gmsh(section);
    const MeshCheck check(mesh);
    EXPECT_NEAR(check.area(0), area, 1e-9 * area);
    for (const LineMesh& line : mesh.lines) EXPECT_GE(line.segments.size(), 1U);
  }
}

// The first message that mesh_section gives.
std::string message_of_mesh(const Section& section, Mesher mesher = Mesher::automatic) {
  try {
    MeshSettings settings;
    settings.mesher = mesher;
    mesh_section(section, settings);
  } catch (const SectionError& error) {
    return to_string(error.code()) + " " + error.what();
  }
  return "";
}

void expect_words(const std::string& message, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(SectionErrors, NameTheAreaOrTheLine) {
  Section section;
  section.areas.push_back(polygon(section, "bow", {{0, 0}, {2, 2}, {2, 0}, {0, 2}}));
  expect_words(message_of_mesh(section), {"S255", "area bow", "(1, 1)"});

  section = {};
  add_rectangle(section, "one", 0, 0, 2, 2);
  add_rectangle(section, "two", 1, 1, 3, 3);
  expect_words(message_of_mesh(section), {"S256", "area two", "area one", "(1.5, 1.5)"});
  section.areas.pop_back();

  add_line(section, "stray", {{1, 1}, {4, 1}}, InterfaceSide::none, false);
  expect_words(message_of_mesh(section), {"S257", "line stray", "(2.5, 1)"});
  section.lines[0].beam = true;
  EXPECT_EQ(message_of_mesh(section, Mesher::blocks), "");
  section.lines.clear();
  add_line(section, "lost", {{5, 1}, {4, 1}}, InterfaceSide::none, true);
  expect_words(message_of_mesh(section), {"S257", "line lost", "touches none"});
  section.lines.clear();
  add_line(section, "rim", {{0, 0}, {2, 0}}, InterfaceSide::both, false);
  expect_words(message_of_mesh(section), {"S257", "line rim", "on both sides"});

  section.lines.clear();
  add_line(section, "wall", {{1, 2}, {1, 0.5}}, InterfaceSide::both, true);
  add_line(section, "pile", {{1, 1}, {1, 0}}, InterfaceSide::none, true);
  expect_words(message_of_mesh(section), {"S258", "line pile", "line wall"});
}

TEST(SectionErrors, IncompleteData) {
  Section section;
  expect_words(message_of_mesh(section), {"S254", "no area"});
  add_rectangle(section, "one", 0, 0, 2, 2);
  section.areas[0].outline.push_back({17, -1});
  expect_words(message_of_mesh(section), {"S254", "area one", "17"});
  section.areas[0].outline.pop_back();
  section.areas[0].size = -1;
  expect_words(message_of_mesh(section), {"S254", "area one", "-1"});
  section.areas[0].size = 1e-5;
  expect_words(message_of_mesh(section), {"S262", "elements"});
  section.areas[0].size = 0;
  section.areas[0].outline.resize(2);
  expect_words(message_of_mesh(section), {"S254", "area one", "three points"});
}

TEST(SectionErrors, AHoleMustLieInside) {
  Section section;
  add_rectangle(section, "ground", 0, 0, 4, 4);
  const SectionArea hole = polygon(section, "", {{3, 1}, {5, 1}, {5, 2}, {3, 2}});
  section.areas[0].holes.push_back(hole.outline);
  expect_words(message_of_mesh(section), {"S255", "area ground", "hole 1", "outside"});
}

TEST(SectionErrors, WithoutGmshAreasThatAreNoBlocksAreNamed) {
  Section section;
  add_rectangle(section, "block", 0, 0, 2, 2);
  section.areas.push_back(polygon(section, "wedge", {{2, 0}, {4, 0}, {2, 2}}));
  expect_words(message_of_mesh(section, Mesher::blocks), {"S259", "area wedge", "four sides"});
}

}  // namespace

}  // namespace sage::test
