// A host program that takes an analysis from increment to increment: it presses a layer until the settlement passes a
// limit, takes half of the pressure off, and goes on to the end of the stage.
// The layer is 2 m thick with E = 20 MPa and nu = 0 between smooth sides, so that it settles by p H / E.
#include <cstdio>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/analysis/analysis.hpp"
#include "sage/builder/model_input.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"

namespace {

constexpr int kRows = 4;  // of elements of 0.5 m; nodes are numbered from 1, two in each row from below

sage::ModelInput layer() {
  sage::ModelInput input{.title = "layer", .units = {"m", "kN", "kPa"}};
  input.materials = {{"linear_elastic", {{"youngs_modulus", 20e3}, {"poissons_ratio", 0.0}}}};
  input.groups = {{.element = "quad4", .elements = {}}};
  sage::SupportInput sides{.x = sage::FixityCode::fixed};
  sage::SupportInput base{.x = sage::FixityCode::fixed, .y = sage::FixityCode::fixed};
  base.nodes = {1, 2};
  for (int j = 0; j <= kRows; ++j) {
    input.nodes.emplace_back(0.0, 0.5 * j);
    input.nodes.emplace_back(1.0, 0.5 * j);
    if (j > 0) sides.nodes.insert(sides.nodes.end(), {2 * j + 1, 2 * j + 2});
    if (j < kRows) input.groups[0].elements.push_back({2 * j + 1, 2 * j + 2, 2 * j + 4, 2 * j + 3});
  }
  input.supports = {base, sides};
  sage::StageInput press{.title = "press", .increments = 10};
  press.pressures = {{.elements = {kRows}, .edge = 3, .normal1 = 100.0, .normal2 = 100.0}};
  input.stages = {press};
  return input;
}

}  // namespace

int main() try {
  sage::Catalogue catalogue;
  sage::register_elements(catalogue);
  sage::register_materials(catalogue);
  sage::register_solvers(catalogue);
  sage::Model model = build_model(layer(), catalogue);

  sage::Analysis analysis(model, catalogue, {.choose_solver = sage::choose_solver});
  // Vertical displacement of the last node: it is an entry per dof, x and y of each node in turn.
  const auto settlement = [&] { return -1e3 * (*analysis.state().u)[2 * model.mesh.nodes() - 1]; };
  analysis.open();
  while (analysis.advance())
    if (settlement() > 5.5) break;
  std::printf("after increment %d: %.4f mm\n", analysis.increment(), settlement());

  for (sage::EdgeLoad& load : model.stages[0].pressures) load.normal = sage::Vector2(30.0, 30.0);
  analysis.take_loads();
  while (analysis.advance()) {
  }
  std::printf("with 30 kPa: %.4f mm\n", settlement());
  const sage::RunResult result = analysis.close();
  std::printf("%s", result.reason.c_str());
  return result.status == sage::RunStatus::completed ? 0 : 3;
} catch (const sage::InputError& e) {
  for (const sage::Diagnostic& d : e.diagnostics().list()) std::fprintf(stderr, "%s\n", to_string(d).c_str());
  return 2;
}
