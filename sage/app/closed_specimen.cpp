#include "sage/app/closed_specimen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sage/builder/lattice_mesh.hpp"
#include "sage/core/point_driver.hpp"
#include "sage/model/dof_map.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

constexpr double kWaterWeight = 9.81;
const UnitSystem kUnits{"m", "kN", "kPa", 101.325, kWaterWeight};
constexpr double kShrink = 20.0;  // largest element over the smallest, along each side

LatticeMesh mesh_of(const ClosedSpecimen& specimen) {
  const int rows = std::max(1, static_cast<int>(std::lround(specimen.columns * specimen.slenderness)));
  const auto lines = [](double length, int intervals) {
    return graded(0.0, length, intervals, std::pow(kShrink, -1.0 / intervals));
  };
  return {
      .x = lines(1.0, specimen.columns), .y = lines(specimen.slenderness, rows), .element = specimen.element};
}

// Integrals of the functions that are 1 on a line, 0 on the others and linear between them: with r dr, and with dy.
std::vector<double> radial_weights(const std::vector<double>& r) {
  std::vector<double> weights(r.size(), 0.0);
  for (std::size_t i = 0; i + 1 < r.size(); ++i) {
    const double width = r[i + 1] - r[i];
    weights[i] += width * (2.0 * r[i] + r[i + 1]) / 6.0;
    weights[i + 1] += width * (r[i] + 2.0 * r[i + 1]) / 6.0;
  }
  return weights;
}

std::vector<double> axial_weights(const std::vector<double>& y) {
  std::vector<double> weights(y.size(), 0.0);
  for (std::size_t i = 0; i + 1 < y.size(); ++i) {
    weights[i] += 0.5 * (y[i + 1] - y[i]);
    weights[i + 1] += 0.5 * (y[i + 1] - y[i]);
  }
  return weights;
}

// Strain and time at the start of each part.
std::vector<SpecimenPart> starts_of(const std::vector<SpecimenPart>& parts) {
  std::vector<SpecimenPart> starts;
  SpecimenPart sum;
  for (const SpecimenPart& part : parts) {
    starts.push_back(sum);
    sum.strain += part.strain;
    sum.duration += part.duration;
  }
  return starts;
}

// Gathers the states.  Nodes are in the order of the mesh.
class Gauge final : public Observer {
 public:
  Gauge(const ClosedSpecimen& specimen, const std::vector<SpecimenPart>& parts, const Model& model,
        std::vector<SpecimenState>& states)
      : parts_(parts),
        starts_(starts_of(parts)),
        first_stage_(specimen.cell > 0.0 ? 1 : 0),
        mesh_(mesh_of(specimen)),
        dofs_(model),
        states_(states) {}

  void on_stage_start(const Model&, int stage, const Solution& solution) override {
    if (stage == first_stage_) first_force_ = force(solution);
  }
  bool wants_states(const Model&, const StepReport&) const override { return false; }

  void on_increment(const Model&, const StepReport& step, const Solution& solution) override {
    if (step.stage < first_stage_) return;
    const auto part = static_cast<std::size_t>(step.stage - first_stage_);
    const int up = 2 * mesh_.rows(), right = 2 * mesh_.columns();
    states_.push_back({.time = starts_[part].duration + step.load_factor * parts_[part].duration,
                       .strain = starts_[part].strain + step.load_factor * parts_[part].strain,
                       .deviator = (force(solution) - first_force_) / std::numbers::pi,
                       .pressure_end = pressure(solution, 0, up),
                       .pressure_middle = pressure(solution, 0, 0),
                       .pressure_rim = pressure(solution, right, 0),
                       .pressure_mean = mean_pressure(solution)});
  }

 private:
  double force(const Solution& solution) const {
    double sum = 0.0;
    for (const int node : mesh_.row(2 * mesh_.rows()))
      sum -= (*solution.internal)[DofMap::displacement(node - 1, 1)];
    return sum;
  }
  double pressure(const Solution& solution, int i, int j) const {
    return (*solution.u)[dofs_.of(mesh_.node(i, j) - 1, 1)];
  }
  double mean_pressure(const Solution& solution) const {
    const std::vector<double> radial = radial_weights(mesh_.x), axial = axial_weights(mesh_.y);
    double sum = 0.0, volume = 0.0;
    for (std::size_t j = 0; j < axial.size(); ++j)
      for (std::size_t i = 0; i < radial.size(); ++i) {
        sum += axial[j] * radial[i] * pressure(solution, 2 * static_cast<int>(i), 2 * static_cast<int>(j));
        volume += axial[j] * radial[i];
      }
    return sum / volume;
  }

  const std::vector<SpecimenPart>& parts_;
  std::vector<SpecimenPart> starts_;
  int first_stage_ = 0;
  LatticeMesh mesh_;
  DofMap dofs_;
  std::vector<SpecimenState>& states_;
  double first_force_ = 0.0;
};

// The membrane and the platen hold the first stress.
StageInput cell_stage(const ClosedSpecimen& specimen, const LatticeMesh& mesh) {
  StageInput stage{.title = "cell pressure"};
  stage.pressures = {{.elements = mesh.right_elements(),
                      .edge = mesh.right_edge(),
                      .normal1 = specimen.cell,
                      .normal2 = specimen.cell}};
  return stage;
}

LawPtr law_of(const MaterialInput& material, const Catalogue& catalogue) {
  const auto& entries = catalogue.materials.entries();
  const auto found = std::ranges::find(entries, material.law, [](const auto& one) { return one.second.name; });
  if (found == entries.end()) throw std::invalid_argument(material.law + " is no law of the catalogue");
  std::vector<double> values;
  for (const Parameter& parameter : found->second.parameters) {
    const auto given = material.parameters.find(parameter.name);
    values.push_back(given != material.parameters.end() ? given->second : parameter.fallback);
  }
  return found->second.law_for(values, kUnits, material.name);
}

StageInput stage_of(const SpecimenPart& part, const std::vector<int>& platen, double height) {
  StageInput stage{.title = part.duration > 0.0 ? "water free to move" : "no water moves",
                   .increments = part.increments};
  stage.pores = part.duration > 0.0 ? PoreWater::flows : PoreWater::shut_in;
  if (part.duration > 0.0) stage.duration = part.duration;
  stage.theta = part.theta;
  if (part.strain != 0.0)
    stage.supports = {{.nodes = platen, .y = FixityCode::fixed, .y_value = -part.strain * height}};
  return stage;
}

}  // namespace

ModelInput specimen_input(const ClosedSpecimen& specimen, const std::vector<SpecimenPart>& parts) {
  const LatticeMesh mesh = mesh_of(specimen);
  ModelInput input;
  input.name = input.title = "closed specimen between rough platens";
  input.geometry = Geometry::axisymmetric;
  input.units = kUnits;
  input.materials = {specimen.skeleton,
                     {"pore_flow", {{"permeability", kWaterWeight * specimen.permeability}}}};
  mesh.write(input);
  const std::vector<int> platen = mesh.row(2 * mesh.rows());
  input.supports = {{.nodes = mesh.column(0), .x = FixityCode::fixed},
                    {.nodes = mesh.row(0), .y = FixityCode::fixed},
                    {.nodes = platen, .x = FixityCode::fixed, .y = FixityCode::fixed}};
  if (specimen.cell > 0.0) {
    input.initials = {{.values = {specimen.cell, specimen.cell, specimen.cell, 0.0}}};
    input.stages.push_back(cell_stage(specimen, mesh));
  }
  for (const SpecimenPart& part : parts) input.stages.push_back(stage_of(part, platen, specimen.slenderness));
  return input;
}

SpecimenCurve run_specimen(const ClosedSpecimen& specimen, const std::vector<SpecimenPart>& parts,
                           const Catalogue& catalogue, Pulse* pulse) {
  const Model model = build_model(specimen_input(specimen, parts), catalogue);
  RunSettings settings;
  settings.choose_solver = choose_solver;
  settings.pulse = pulse;
  SpecimenCurve curve;
  Gauge gauge(specimen, parts, model, curve.states);
  Observer* const observers[] = {&gauge};
  const RunResult result = run(model, catalogue, settings, observers);
  if (result.status != RunStatus::completed) curve.reason = result.reason;
  return curve;
}

std::vector<FrictionlessState> frictionless_test(const ClosedSpecimen& specimen, double strain, int steps,
                                                 const Catalogue& catalogue) {
  const LawPtr law = law_of(specimen.skeleton, catalogue);
  PointDriver<4> point(*std::get<std::unique_ptr<SolidLaw>>(law),
                       Vector4(-specimen.cell, -specimen.cell, -specimen.cell, 0.0));
  constexpr std::array<Control, 4> kControl{Control::strain, Control::strain, Control::strain, Control::strain};
  const double d = strain / steps;
  std::vector<FrictionlessState> states;
  for (int i = 0; i < steps; ++i) {
    point.advance(kControl, Vector4(0.5 * d, -d, 0.5 * d, 0.0));
    // The total radial stress stays: what the skeleton loses of its own is carried by the water.
    states.push_back({point.sigma()[0] - point.sigma()[1], point.sigma()[0] + specimen.cell});
  }
  return states;
}

}  // namespace sage::app
