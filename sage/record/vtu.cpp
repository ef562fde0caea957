// docs/decisions/0004-own-vtu-writer.md says why this does not call the VTK libraries.
#include "sage/record/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sage/core/units.hpp"
#include "sage/model/foreign_element.hpp"
#include "sage/record/state_time.hpp"
#include "sage/record/values.hpp"
#include "sage/record/vtk_data.hpp"
#include "sage/record/vtu_text.hpp"

namespace sage {

namespace {

// "psi, compression positive" where VTK keeps the unit of an array: vtkDataArray::UNITS_LABEL.
std::string unit_label(const FieldEntry& field, const UnitSystem& units) {
  constexpr std::string_view kSigns[] = {"", "compression positive", "positive along the axes"};
  std::string text = field.dimension == Dimension::none ? "" : unit_text(field.dimension, units);
  const std::string_view sign = kSigns[static_cast<std::size_t>(field.sign)];
  if (!text.empty() && !sign.empty()) text += ", ";
  text += sign;
  if (text.empty()) return text;
  return fmt::format(R"(<InformationKey name="UNITS_LABEL" location="vtkDataArray">{}</InformationKey>)",
                     xml_text(text));
}

void add_arrays(VtuText& vtu, const std::vector<VtkArray>& arrays, const UnitSystem& units) {
  for (const VtkArray& array : arrays) {
    std::string names;
    for (std::size_t c = 0; c < array.components.size(); ++c)
      names += fmt::format(" ComponentName{}=\"{}\"", c, array.components[c]);
    const int width = static_cast<int>(array.width);
    const std::string label = unit_label(*array.field, units);
    std::visit([&](const auto& values) { vtu.array(array.name, width, values, names, label); }, array.values);
  }
}

// Numbers alone: meshio refuses a file with words among them.  VTK takes TimeValue for the file's time.
void add_step(VtuText& vtu, const Model& model, const StepReport& step) {
  constexpr std::string_view kOne = " NumberOfTuples=\"1\"";
  vtu.tag("    <FieldData>");
  vtu.array("TimeValue", 1, std::vector{StateTime(model).at(step)}, kOne);
  vtu.array("stage", 1, std::vector{std::int32_t{step.stage + 1}}, kOne);
  vtu.array("increment", 1, std::vector{std::int32_t{step.increment}}, kOne);
  vtu.array("load_factor", 1, std::vector{step.load_factor}, kOne);
  vtu.tag("    </FieldData>");
}

void add_grid(VtuText& vtu, const VtkGrid& grid) {
  vtu.tag("      <Points>");
  vtu.array("Points", 3, grid.points);
  vtu.tag("      </Points>");
  vtu.tag("      <Cells>");
  vtu.array("connectivity", 1, grid.connectivity);
  vtu.array("offsets", 1, grid.offsets);
  vtu.array("types", 1, grid.types);
  vtu.tag("      </Cells>");
}

std::string not_converged(const StepReport& report) {
  return fmt::format("NOT CONVERGED: last state in equilibrium, stage {}, load factor {:.6g} of the stage",
                     report.stage + 1, report.load_factor);
}

// Title, units and signs as a comment: readers pass over it, people see it at the top.
// XML allows no "--" in it.
std::string head(const Model& model, std::string_view comment) {
  std::string text = fmt::format("  {}\n{}", model.title, sign_convention(model, "  "));
  if (!comment.empty()) text += fmt::format("  {}\n", comment);
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at))
    text.insert(at + 1, " ");
  return "<!--\n" + text + "-->\n";
}

}  // namespace

void warn_of_vtu(const Model& model, Diagnostics& diagnostics) {
  for (const Group& group : model.groups)
    if (group.elements() > 0 && group.entry->vtk.type == 0) warn_of_corners(group, "VTU", diagnostics);
}

std::string vtu_text(const Model& model, const Solution& solution, std::string_view comment,
                     const StepReport* step) {
  const NodalLayout layout = nodal_layout(model, *solution.activity);
  const VtkGrid grid = vtk_grid(model, layout);
  const FieldTable table = fields_of(model);
  VtuText vtu(head(model, comment));
  if (step != nullptr) add_step(vtu, model, *step);
  vtu.tag(fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", layout.entries(),
                      grid.types.size()));
  add_grid(vtu, grid);
  vtu.tag("      <PointData Vectors=\"displacement\">");
  add_arrays(vtu, vtk_point_data(model, solution, layout, table), model.units);
  vtu.tag("      </PointData>");
  vtu.tag("      <CellData>");
  add_arrays(vtu, vtk_cell_data(model, solution, table), model.units);
  vtu.tag("      </CellData>");
  return std::move(vtu).text();
}

Vtu::Vtu(std::filesystem::path folder, const std::string& stem)
    : folder_(std::move(folder)), stem_(plain_name(stem, "")), pvd_(folder_ / (stem + ".pvd")) {
  expect_no_folders(folder_, stem_ + "_", ".vtu");
  pvd_.text() =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
}

std::filesystem::path Vtu::file(int number) const {
  return folder_ / fmt::format("{}_{:04}.vtu", stem_, number);
}

void Vtu::add(const Model& model, const StepReport& report, const Solution& solution,
              std::string_view comment) {
  files_.push_back(file(++count_));
  const std::string name = files_.back().filename().string();
  write_file(files_.back(), vtu_text(model, solution, comment, &report));
  const StateTime time(model);
  if (count_ == 1) pvd_.text() += fmt::format("    <!-- timestep: {} -->\n", time.meaning());
  pvd_.text() += fmt::format("    <DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}\"/>\n", time.at(report),
                             xml_text(name));
  pvd_.checkpoint();
}

void Vtu::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  if (is_output_increment(stage_of(model, report.stage), report)) add(model, report, solution, "");
}

void Vtu::on_failure(const Model& model, const StepReport& report, const std::string&,
                     const Solution& solution) {
  const std::string comment = not_converged(report);
  add(model, report, solution, comment);
  pvd_.text() += "    <!-- " + comment + " -->\n";
}

void Vtu::finish(std::string_view comment) {
  if (!pvd_.open()) return;
  if (!comment.empty()) pvd_.text() += fmt::format("    <!-- {} -->\n", comment);
  pvd_.text() += "  </Collection>\n</VTKFile>\n";
  pvd_.finish();
  files_.push_back(pvd_.path());
}

void Vtu::on_finish(const Model&, const RunResult&) {
  finish("");
}

void Vtu::exchange(Archive& archive) {
  pvd_.exchange(archive);
  archive(count_);
  files_.clear();
  for (int i = 1; i <= count_; ++i) files_.push_back(file(i));
}

void Vtu::stop(const std::string&) {
  finish("RUN STOPPED, NOT COMPLETE");
}

}  // namespace sage
