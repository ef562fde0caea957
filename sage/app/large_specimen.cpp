#include "sage/app/large_specimen.hpp"

#include <cmath>

#include "sage/builder/lattice_mesh.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

constexpr double kRadius = 1.4;
const UnitSystem kInchUnits{"in", "lbf", "psi", 14.696, 0.036111};
// With the reduced rule Newton's method stalls where a side rolls onto a platen.
LatticeMesh mesh_of(const LargeSpecimen& specimen) {
  const int rows = std::max(1, static_cast<int>(std::lround(specimen.columns * specimen.slenderness)));
  const auto lines = [&](double length, int intervals) {
    return graded(0.0, length, intervals, std::pow(specimen.shrink, -1.0 / intervals));
  };
  return {.x = lines(kRadius, specimen.columns),
          .y = lines(kRadius * specimen.slenderness, rows),
          .element = "quad8",
          .formulation = "full"};
}

// Ends and middle of each edge along a line of lattice nodes, then the platen.
std::vector<std::vector<int>> edges_on(const std::vector<int>& nodes, const std::vector<int>& platen) {
  std::vector<std::vector<int>> edges;
  for (std::size_t i = 0; i + 2 < nodes.size(); i += 2)
    edges.push_back({nodes[i], nodes[i + 2], nodes[i + 1], platen[0], platen[1]});
  return edges;
}

MaterialInput contact_law(const LargeSpecimen& specimen) {
  const double k = specimen.contact_stiffness * specimen.soil.parameters.at("youngs_modulus") / kRadius;
  if (!specimen.joint)
    return {.law = "goodman", .parameters = {{"shear_stiffness", 0.0}, {"normal_stiffness", k}}};
  MaterialInput joint = *specimen.joint;
  joint.parameters["compressive_stiffness"] = joint.parameters["tensile_stiffness"] = k;
  return joint;
}

// The line of the platen, from outside to the axis, so that the specimen is to its left.
std::vector<int> add_platen(const LargeSpecimen& specimen, ModelInput& input) {
  constexpr double kWide = 2.0;  // of a platen that only an end slides on
  const double height = kRadius * specimen.slenderness;
  const double radius = kRadius * (specimen.platen > 0.0 ? specimen.platen : kWide);
  input.nodes.emplace_back(radius, height);
  input.nodes.emplace_back(0.0, height);
  const int last = static_cast<int>(input.nodes.size());
  return {last - 1, last};
}

// Nodes that move with the platen.
std::vector<int> add_contact(const LargeSpecimen& specimen, const LatticeMesh& mesh, ModelInput& input) {
  const std::vector<int> end = mesh.row(2 * mesh.rows());
  std::vector<int> moved;
  if (!specimen.joint) moved = end;
  if (!specimen.joint && specimen.platen == 0.0) return moved;
  const std::vector<int> platen = add_platen(specimen, input);
  GroupInput contact{.element = "contact5", .material = 2, .elements = {}, .name = "contact"};
  if (specimen.joint) contact.elements = edges_on(end, platen);
  if (specimen.platen > 0.0) {
    const auto side = edges_on(mesh.column(2 * mesh.columns()), platen);
    contact.elements.insert(contact.elements.end(), side.begin(), side.end());
  }
  input.groups.push_back(contact);
  input.materials.push_back(contact_law(specimen));
  moved.insert(moved.end(), platen.begin(), platen.end());
  return moved;
}

// On the side, and on an end that the platen does not hold: contact bears what the platen adds to it.
StageInput cell_stage(const LargeSpecimen& specimen, const LatticeMesh& mesh) {
  StageInput stage{.title = "cell pressure"};
  const auto press = [&](const std::vector<int>& elements, int edge) {
    stage.pressures.push_back(
        {.elements = elements, .edge = edge, .normal1 = specimen.cell, .normal2 = specimen.cell});
  };
  press(mesh.right_elements(), mesh.right_edge());
  if (specimen.joint) press(mesh.upper_elements(), mesh.upper_edge());
  return stage;
}

}  // namespace

MaterialInput platen_friction(double friction_angle, double stiffness_number, double exponent) {
  return {.law = "clough_duncan",
          .parameters = {{"cohesion", 0.0},
                         {"friction_angle", friction_angle},
                         {"tensile_strength", 0.0},
                         {"failure_ratio", 0.0},
                         {"stiffness_number", stiffness_number},
                         {"stiffness_exponent", exponent},
                         {"failure_stiffness", 0.0},
                         {"shear_rule", 1.0}}};
}

ModelInput large_specimen_input(const LargeSpecimen& specimen, double strain, int increments) {
  const LatticeMesh mesh = mesh_of(specimen);
  const double height = kRadius * specimen.slenderness;
  ModelInput input;
  input.name = input.title = "specimen between rigid platens, large strain";
  input.geometry = Geometry::axisymmetric;
  input.units = kInchUnits;
  input.large_strain = true;
  input.materials = {specimen.soil};
  mesh.write(input);
  const std::vector<int> moved = add_contact(specimen, mesh, input);
  input.supports = {{.nodes = mesh.column(0), .x = FixityCode::fixed},
                    {.nodes = mesh.row(0), .y = FixityCode::fixed},
                    {.nodes = moved, .x = FixityCode::fixed, .y = FixityCode::fixed}};
  if (specimen.cell > 0.0) {
    input.initials = {{.values = {specimen.cell, specimen.cell, specimen.cell, 0.0}}};
    input.stages.push_back(cell_stage(specimen, mesh));
  }
  StageInput push{.title = "axial compression", .increments = increments};
  push.supports = {{.nodes = moved, .y = FixityCode::fixed, .y_value = -strain * height}};
  input.stages.push_back(push);
  input.reports = {{.kind = ReportKind::triaxial,
                    .nodes = moved,
                    .group = 1,
                    .stage = static_cast<int>(input.stages.size()),
                    .height = height,
                    .area = kPi * kRadius * kRadius,
                    .cell_pressure = specimen.cell}};
  return input;
}

LargeCurve run_large_specimen(const LargeSpecimen& specimen, double strain, int increments,
                              const Catalogue& catalogue, Pulse* pulse) {
  const Model model = build_model(large_specimen_input(specimen, strain, increments), catalogue);
  RunSettings settings;
  settings.choose_solver = choose_solver;
  settings.pulse = pulse;
  Reports reports;
  Observer* const observers[] = {&reports};
  const RunResult result = run(model, catalogue, settings, observers);
  LargeCurve curve{reports.triaxial(0), {}};
  if (result.status != RunStatus::completed) curve.reason = result.reason;
  return curve;
}

}  // namespace sage::app
