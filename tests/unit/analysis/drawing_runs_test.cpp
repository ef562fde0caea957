// Drawings that run: supports across turned lines, and meshes of other programs.  Right values are closed forms.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "sage/app/commands.hpp"
#include "sage/model_file/model_file.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

using scenes::WholeRun;

const scenes::Workbench& drawn_bench() {
  static const scenes::Workbench bench = app::make_workbench();
  return bench;
}

Model drawn_model(const std::string& text) {
  return build_model(read_model_file_text(text, "drawing.sage.toml"), drawn_bench().catalogue());
}

// Codes of errors and warnings of a model.
std::string codes_of(const std::string& text) {
  std::string codes;
  const auto add = [&](const Diagnostics& all) {
    for (const Diagnostic& one : all.list())
      if (one.severity != Severity::note) codes += to_string(one.code) + " ";
  };
  try {
    add(drawn_model(text).diagnostics);
  } catch (const InputError& error) {
    add(error.diagnostics());
  }
  return codes;
}

std::string file_head(bool ring) {
  return fmt::format("title = \"ground\"\ngeometry = \"{}\"\n", ring ? "axisymmetric" : "plane strain");
}
const std::string kHead =
    "[units]\nlength = \"m\"\nforce = \"kN\"\nstress = \"kPa\"\nwater_unit_weight = 10.0\n"
    "[mesh]\nelement = \"quad8\"\nsize = 1.0\nmesher = \"blocks\"\n";
const std::string kSoils =
    "[[material]]\nname = \"sand\"\nlaw = \"mohr_coulomb\"\nunit_weight = 17.0\n"
    "youngs_modulus = 20000.0\npoissons_ratio = 0.3\ncohesion = 1.0\nfriction_angle = 35.0\ndilation_angle = "
    "0.0\n"
    "[[material]]\nname = \"clay\"\nlaw = \"mohr_coulomb\"\nunit_weight = 16.0\n"
    "youngs_modulus = 8000.0\npoissons_ratio = 0.3\ncohesion = 100.0\nfriction_angle = 22.0\ndilation_angle = "
    "0.0\n";

// Two by three, its base on a line, its sides on two.
std::string square() {
  return file_head(false) +
         "fixity = [{line = \"base\", x = \"fixed\", y = \"fixed\"}, {line = \"left\", x = \"fixed\"}, "
         "{line = \"right\", x = \"fixed\"}]\n" +
         kHead + kSoils +
         "[[line]]\nname = \"base\"\npoints = [[1, -3], [3, -3]]\n"
         "[[line]]\nname = \"left\"\npoints = [[1, -3], [1, 0]]\n"
         "[[line]]\nname = \"right\"\npoints = [[3, -3], [3, 0]]\n"
         "[[area]]\nname = \"upper\"\noutline = [[1, -3], [3, -3], [3, 0], [1, 0]]\nmaterial = \"sand\"\n"
         "[[stage]]\ntitle = \"weight\"\ngravity_y = -1.0\n";
}

// A block on a plane that is turned by an angle: its base slides along, one of its sides holds it there.  Pressure 50 on its
// top: sigma across the base is 50 and 0 along it, and the top comes down by p h (1 - nu^2) / E.
TEST(TurnedSupport, BlockOnAnInclinedPlane) {
  for (const double degrees : {0.0, 30.0, 75.0, 140.0}) {
    const double a = degrees * std::numbers::pi / 180.0;
    const auto place = [a](double along, double up) {
      return fmt::format("[{:.15g}, {:.15g}]", 5.0 + along * std::cos(a) - up * std::sin(a),
                         5.0 + along * std::sin(a) + up * std::cos(a));
    };
    const std::string text =
        file_head(false) +
        "fixity = [{line = \"base\", normal = \"fixed\"}, {line = \"back\", normal = \"fixed\"}]\n" + kHead +
        "[[material]]\nname = \"rock\"\nlaw = \"linear_elastic\"\nyoungs_modulus = 2000.0\npoissons_ratio = "
        "0.25\n" +
        fmt::format(
            "[[line]]\nname = \"base\"\npoints = [{0}, {1}]\n[[line]]\nname = \"back\"\npoints = [{0}, {3}]\n"
            "[[line]]\nname = \"top\"\npoints = [{3}, {2}]\n"
            "[[area]]\nname = \"block\"\noutline = [{0}, {1}, {2}, {3}]\nmaterial = \"rock\"\n",
            place(0, 0), place(3, 0), place(3, 2), place(0, 2)) +
        "[[stage]]\npressure = [{line = \"top\", normal1 = 50.0, normal2 = 50.0}]\n";
    const WholeRun run = drawn_bench().run(drawn_model(text));
    ASSERT_TRUE(run.completed()) << run.failure;
    const Vector2 up(-std::sin(a), std::cos(a)), origin(5.0, 5.0);
    for (int node = 0; node < run.model->mesh.nodes(); ++node) {
      const double height = up.dot(Vector2(run.model->mesh.x.col(node)) - origin);
      if (std::abs(height - 2.0) > 1e-9) continue;
      const Vector2 u(run.last().u[DofMap::displacement(node, 0)], run.last().u[DofMap::displacement(node, 1)]);
      EXPECT_NEAR(up.dot(u), -50.0 * 2.0 * (1.0 - 0.0625) / 2000.0, 1e-6) << degrees;
    }
  }
}

TEST(TurnedSupport, MistakesAreNamed) {
  const std::string text = square();
  const auto with = [&](const std::string& support) {
    std::string changed = text;
    const std::string left = "{line = \"left\", x = \"fixed\"}";
    changed.replace(changed.find(left), left.size(), support);
    return codes_of(changed);
  };
  EXPECT_EQ(with("{line = \"left\", normal = \"fixed\"}"), "");
  EXPECT_EQ(with("{line = \"left\", normal = \"fixed\", x = \"fixed\"}"), "S155 ");
  EXPECT_EQ(with("{line = \"left\", normal = \"stuck\"}"), "S153 ");
}

// Two squares side by side, as a mesher writes them, with a named curve between them and around them.
const std::string kMeshFile =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n1 1 \"base\"\n1 2 \"between\"\n1 3 \"outer\"\n1 "
    "4 \"top\"\n"
    "2 5 \"soil\"\n2 6 \"fill\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 "
    "2 1 0\n"
    "$EndNodes\n$Elements\n8\n1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 1 2 2 2 2 5\n4 1 2 3 3 1 4\n5 1 2 4 4 5 6\n6 1 2 "
    "3 5 6 3\n"
    "7 3 2 5 1 1 2 5 4\n8 3 2 6 2 2 3 6 5\n$EndElements\n";

// Whole at once: tests of other processes may read it.
void write_mesh() {
  const std::string own = fmt::format("drawing_runs_test.{}.msh", ::getpid());
  std::ofstream(own) << kMeshFile;
  std::filesystem::rename(own, "drawing_runs_test.msh");
}

std::string of_mesh_file(const std::string& joint, const std::string& more = "") {
  return "title = \"mesh\"\ngeometry = \"plane strain\"\n"
         "fixity = [{line = \"base\", x = \"fixed\", y = \"fixed\"}]\n" +
         ("[units]\nlength = \"m\"\nforce = \"kN\"\nstress = \"kPa\"\n"
          "[mesh]\nfile = \"drawing_runs_test.msh\"\nelement = \"quad8\"\n" +
          kSoils + "[[line]]\nname = \"base\"\n[[line]]\nname = \"top\"\n[[line]]\nname = \"between\"\n" +
          joint +
          "[[area]]\nname = \"soil\"\nmaterial = \"clay\"\n[[area]]\nname = \"fill\"\nmaterial = \"sand\"\n"
          "[[stage]]\npressure = [{line = \"top\", normal1 = 10.0, normal2 = 10.0}]\n") +
         more;
}

// Surfaces are areas, curves are lines; the nodes along a line with a joint are split: 13 nodes of two quad8 and three more.
TEST(MeshFile, SurfacesAreAreasAndCurvesAreLines) {
  write_mesh();
  const Model whole = drawn_model(of_mesh_file(""));
  EXPECT_EQ(whole.mesh.nodes(), 13);
  EXPECT_EQ(whole.groups.size(), 2u);
  EXPECT_EQ(whole.stages[0].pressures.size(), 1u);
  EXPECT_EQ(whole.fixities.size(), 5u);
  const Model jointed = drawn_model(of_mesh_file("interface = {factor = 0.5, thickness = 0.1}\n"));
  EXPECT_EQ(jointed.mesh.nodes(), 16);
  EXPECT_EQ(jointed.groups.size(), 3u);
  const WholeRun run = drawn_bench().run(drawn_model(of_mesh_file("")));
  EXPECT_TRUE(run.completed()) << run.failure;
}

TEST(MeshFile, MistakesAreNamed) {
  write_mesh();
  std::string text = of_mesh_file("");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return codes_of(changed);
  };
  EXPECT_EQ(with("name = \"between\"", "name = \"betwen\""), "S628 ");
  EXPECT_EQ(with("name = \"fill\"", "name = \"filling\""), "S628 ");
  EXPECT_EQ(with("\"quad8\"", "\"tri6\""), "S628 ");
  EXPECT_NE(with("drawing_runs_test.msh", "no_such.msh"), "");
}

}  // namespace
}  // namespace sage::test
