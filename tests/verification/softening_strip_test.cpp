// A strip footing on clay that softens, on three meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sage/model_file/model_file.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

// Rough rigid strip of half width 1 m; c falls from 20 to 10 kPa over a plastic shear strain of .2 in a band of that width.  n
// quad8 under the half width.
std::string strip(int n, const std::string& band_width) {
  return R"(
geometry = "plane strain"
units = {length = "m", force = "kN", stress = "kPa"}
mesh = {element = "quad8", mesher = "blocks", size = )" +
         std::to_string(1.0 / n) + R"(}
material = [{name = "clay", law = "mohr_coulomb_softening", youngs_modulus = 10000, poissons_ratio = 0.45, cohesion = 20, friction_angle = 0, dilation_angle = 0, strain_1 = 0.2, cohesion_1 = 10, friction_angle_1 = 0, dilation_angle_1 = 0, band_width = )" +
         band_width + R"(}]
points = {a = [0, 3], b = [1, 3]}
line = [
  {name = "footing", points = ["a", "b"]},
  {name = "base", points = [[0, 0], [4, 0]]},
  {name = "axis", points = [[0, 0], [0, 3]]},
  {name = "side", points = [[4, 0], [4, 3]]},
]
area = [{name = "soil", outline = [[0, 0], [4, 0], [4, 3], "b", "a"], material = "clay"}]
fixity = [{line = "base", x = "fixed", y = "fixed"}, {line = "axis", x = "fixed"}, {line = "side", x = "fixed"}]
[[stage]]
increments = 13
fixity = [{line = "footing", x = "fixed", y = "fixed", y_value = -0.0325}]
)";
}

// Largest force on the half width.
double peak(int n, const std::string& band_width) {
  static const scenes::Workbench bench = app::make_workbench();
  const scenes::WholeRun run = bench.run(
      build_model(read_model_file_text(strip(n, band_width), "strip.sage.toml"), bench.catalogue(), {}));
  EXPECT_TRUE(run.completed()) << run.failure;
  const Mesh& mesh = run.model->mesh;
  std::vector<int> footing;
  for (int i = 0; i < mesh.nodes(); ++i)
    if (mesh.x(1, i) > 3.0 - 1e-9 && mesh.x(0, i) < 1.0 + 1e-9) footing.push_back(mesh.number[i]);
  double most = 0.0;
  for (const scenes::Snapshot& at : run.increments) most = std::max(most, -run.reaction(at, footing, 1));
  EXPECT_GT(most, -run.reaction(run.last(), footing, 1)) << "the load has not fallen yet";
  return most;
}

// Softening that counts strain times element size gives a peak that hardly depends on the mesh: 2 % is the gate, and what is
// left is the discretisation error of the collapse load.  Softening by strain alone loses 5 % from the first mesh to the second.
TEST(SofteningStrip, PeakHardlyDependsOnTheMesh) {
  const double coarse = peak(4, "0.25"), middle = peak(8, "0.25"), fine = peak(12, "0.25");
  EXPECT_LT(std::max({coarse, middle, fine}) / std::min({coarse, middle, fine}) - 1.0, 0.02)
      << coarse << ' ' << middle << ' ' << fine;
  EXPECT_GT(peak(4, "0") / peak(8, "0") - 1.0, 0.04);
}

}  // namespace
}  // namespace sage::test
