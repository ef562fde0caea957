// A strip footing on sand, from arrays: built with a deck's checks, run, read and written as a deck.
// Prints the settlement under the middle of the footing; footing.dat is the same model for `sagefe run`.
#include <cstdio>
#include <fstream>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/analysis/run.hpp"
#include "sage/builder/model_input.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/record/result.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"

int main() try {
  sage::Catalogue catalogue;
  sage::register_elements(catalogue);
  sage::register_materials(catalogue);
  sage::register_solvers(catalogue);

  constexpr int n = 10;  // elements a side of 0.5 m; nodes are numbered from 1, row by row from below
  sage::ModelInput input{.title = "strip footing", .units = {"m", "kN", "kPa"}};
  input.materials = {
      {"drucker_prager",
       {{"youngs_modulus", 20e3}, {"poissons_ratio", 0.3}, {"friction_angle", 30.0}, {"cohesion", 5.0}}}};
  input.groups = {{.element = "quad4", .elements = {}, .formulation = "b-bar"}};
  sage::SupportInput sides{.x = sage::FixityCode::fixed};
  sage::SupportInput base{.x = sage::FixityCode::fixed, .y = sage::FixityCode::fixed};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const int node = j * (n + 1) + i + 1;
      input.nodes.emplace_back(0.5 * i, 0.5 * j);
      if (i < n && j < n) input.groups[0].elements.push_back({node, node + 1, node + n + 2, node + n + 1});
      if (j == 0) base.nodes.push_back(node);
      if (j > 0 && (i == 0 || i == n)) sides.nodes.push_back(node);
    }
  input.supports = {base, sides};
  sage::StageInput load{.title = "load", .increments = 10};
  load.pressures = {{.elements = {91, 92}, .edge = 3, .normal1 = 60.0, .normal2 = 60.0}};
  input.stages = {load};
  input.reports = {{.kind = sage::ReportKind::nodes, .nodes = {n * (n + 1) + 1}}};  // the middle of the footing

  const sage::Model model = build_model(input, catalogue);
  sage::Result result;
  sage::Observer* observers[] = {&result};
  const sage::RunResult run = sage::run(model, catalogue, {.choose_solver = sage::choose_solver}, observers);
  if (run.status != sage::RunStatus::completed) return 3;
  std::printf("settlement %.7f m\n", -(*result.ends()[0].view().u)[2 * model.reports[0].nodes[0] + 1]);
  sage::Diagnostics notes;
  std::ofstream("footing.dat") << sage1_text(model, notes);
} catch (const sage::InputError& e) {
  for (const sage::Diagnostic& d : e.diagnostics().list()) std::fprintf(stderr, "%s\n", to_string(d).c_str());
  return 2;
}
