#include "tests/unit/record/specimen.hpp"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/text.hpp"

namespace sage::test {

namespace {

int code_of(const Registry<MaterialEntry>& registry, const std::string& name) {
  for (const auto& [code, entry] : registry.entries())
    if (entry.name == name) return code;
  throw std::logic_error("no law " + name);
}

int code_of(const Registry<ElementEntry>& registry, const std::string& name) {
  for (const auto& [code, entry] : registry.entries())
    if (entry.name == name) return code;
  throw std::logic_error("no element " + name);
}

Material material(const Catalogue& catalogue, int number, const std::string& law,
                  std::vector<double> parameters) {
  Material m;
  m.number = number;
  m.name = law + " here";
  m.law_name = law;
  m.code = code_of(catalogue.materials, law);
  m.entry = catalogue.materials.share(m.code);
  m.parameters = std::move(parameters);
  m.law = catalogue.materials.find(m.code)->make(m.parameters, {});
  return m;
}

Group group(const Catalogue& catalogue, int number, const std::string& element, Geometry geometry, int material,
            std::vector<int> numbers, std::vector<int> nodes) {
  Group g;
  g.number = number;
  g.name = element == "quad4" ? "specimen" : "end";
  set_element(g, catalogue, code_of(catalogue.elements, element), 1, geometry);
  g.element_name = element;
  g.material = material;
  g.element_numbers = std::move(numbers);
  g.nodes = std::move(nodes);
  return g;
}

}  // namespace

Specimen::Specimen(Geometry geometry, bool interface) : with_interface(interface) {
  register_elements(catalogue);
  register_materials(catalogue);
  model.file = "specimen.dat";
  model.title = "compressed specimen";
  model.geometry = geometry;
  model.units = {"in", "lbf", "psi", 14.696, 0.036111};
  const int nodes = with_interface ? 8 : 6;
  model.mesh.x.resize(2, nodes);
  for (int i = 0; i < nodes; ++i) {
    model.mesh.x.col(i) = Vector2(i % 2, std::min(i / 2, 2));
    model.mesh.number.push_back(10 * (i + 1));
  }
  model.mesh.deck_nodes = nodes;
  model.materials.push_back(material(catalogue, 1, "linear_elastic", {kE, kNu}));
  model.groups.push_back(group(catalogue, 1, "quad4", geometry, 0, {101, 102}, {0, 1, 3, 2, 2, 3, 5, 4}));
  if (with_interface) {
    model.materials.push_back(material(catalogue, 2, "goodman", {500.0, kNormal, 1.0}));
    model.groups.push_back(group(catalogue, 2, "interface4", geometry, 1, {201}, {4, 5, 7, 6}));
  }
  for (int node : {0, 1})
    model.fixities.push_back({node, {FixityCode::unchanged, FixityCode::fixed}, {0, 0}, 0});
  for (int node : {0, 2, 4, 6})
    if (node < nodes) model.fixities.push_back({node, {FixityCode::fixed, FixityCode::unchanged}, {0, 0}, 0});
  Stage stage;
  stage.number = 1;
  stage.title = "axial compression";
  for (int node : {nodes - 2, nodes - 1})
    stage.fixities.push_back({node, {FixityCode::fixed, FixityCode::fixed}, {0, 0}, 0});
  model.stages.push_back(stage);
  scene = analyse_scene(model);
  assembly = make_assembly(model, scene, Skips{}, work);
  activity = std::make_unique<Activity>(model);
  activity->enter(model.stages[0]);
  assembly->enter_stage(*activity, Eigen::VectorXd::Zero(DofMap(model).dofs()));
  u.setZero(DofMap(model).dofs());
  external.setZero(DofMap(model).dofs());
  if (assembly->evaluate(u, nullptr) != Outcome::ok) throw std::logic_error("specimen");
  assembly->commit(u);
  assembly->recover_states();
}

void Specimen::compress(double e) {
  Eigen::VectorXd next = Eigen::VectorXd::Zero(DofMap(model).dofs());
  const bool ring = model.geometry == Geometry::axisymmetric;
  const double lateral = ring ? kNu : kNu / (1.0 - kNu);             // plane strain: eps_zz = 0
  const double stress = ring ? kE * e : kE * e / (1.0 - kNu * kNu);  // sigma_yy, compression +
  for (int i = 0; i < 6; ++i) {
    next[2 * i] = lateral * e * model.mesh.x(0, i);
    next[2 * i + 1] = -e * model.mesh.x(1, i);
  }
  if (with_interface)
    for (int i : {6, 7}) {
      next[2 * i] = next[2 * (i - 2)];  // no shear
      next[2 * i + 1] = -2.0 * e - stress / kNormal;
    }
  const Eigen::VectorXd du = next - u;
  if (assembly->evaluate(du, nullptr) != Outcome::ok) throw std::logic_error("specimen");
  assembly->commit(du);
  assembly->recover_states();
  u = next;
}

Solution Specimen::solution() const {
  return {&u, &assembly->internal_force(), &external, assembly.get(), activity.get()};
}

StepReport Specimen::step(int increment, int increments, int stage) const {
  StepReport report;
  report.stage = stage;
  report.increment = increment;
  report.increments = increments;
  report.load_factor = static_cast<double>(increment) / increments;
  report.iterations = {{1e-3, 1e-2, 1e-4, 1.0}, {1.5e-11, 2.5e-7, 3.5e-13, 1.0}};
  report.total_iterations = 2;
  report.points = assembly->count_points();
  report.worst = {3, 0, 1, 1.25e-9};
  return report;
}

void Specimen::run(Observer& observer, double strain, int increments) {
  model.stages[0].increments = increments;
  observer.on_start(model, scene, "fake", 7);
  observer.on_stage_start(model, 0, solution());
  for (int i = 1; i <= increments; ++i) {
    compress(strain * i / increments);
    observer.on_increment(model, step(i, increments), solution());
  }
  observer.on_stage_end(model, 0, {{0, 0}, {0.5, 0.25}, 0.0, 1e-12, 1.0, {}}, solution());
  RunResult result;
  result.stages_done = 1;
  result.increments_done = increments;
  observer.on_finish(model, result);
}

void Specimen::run_and_fail(Observer& observer, double strain, int increments) {
  model.stages[0].increments = increments;
  observer.on_start(model, scene, "fake", 7);
  observer.on_stage_start(model, 0, solution());
  for (int i = 1; i < increments; ++i) {
    compress(strain * i / increments);
    observer.on_increment(model, step(i, increments), solution());
  }
  StepReport report = step(increments, increments);
  report.load_factor = (increments - 0.5) / increments;
  report.converged = false;
  report.cuts = 12;
  compress(strain * report.load_factor);  // the half that did converge
  observer.on_failure(model, report, "no equilibrium found\n  try: something else", solution());
  RunResult result;
  result.status = RunStatus::not_converged;
  result.reason = "no equilibrium found";
  result.increments_done = increments - 1;
  observer.on_finish(model, result);
}

std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder = scratch_folder(name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return "(no file " + path.string() + ")";
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> csv_column(const std::string& text, const std::string& name) {
  std::vector<std::string> column;
  std::size_t index = 0;
  bool header = true;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string> row = split(line, ',');
    if (header) {
      while (index < row.size() && row[index].substr(0, row[index].find('[')) != name) ++index;
      if (index == row.size()) throw std::logic_error("no column " + name);
      header = false;
    } else {
      column.push_back(row.at(index));
    }
  }
  return column;
}

std::vector<double> csv_numbers(const std::string& text, const std::string& name) {
  std::vector<double> numbers;
  for (const std::string& field : csv_column(text, name))
    numbers.push_back(field.empty() ? std::nan("") : std::stod(field));
  return numbers;
}

}  // namespace sage::test
