// docs/decisions/0004-own-vtu-writer.md says why this does not call the VTK libraries.
#include "sage/record/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>

#include "sage/analysis/shown_status.hpp"
#include "sage/model/foreign_element.hpp"
#include "sage/record/nodal_values.hpp"
#include "sage/record/values.hpp"

namespace sage {

namespace {

static_assert(std::endian::native == std::endian::little, "the VTU writer appends raw little-endian data");

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class T>
constexpr std::string_view vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

// XML tags with offsets, and the data that they point to: each block is its size in bytes
// (UInt64), then its bytes.
class VtuText {
 public:
  void tag(std::string_view text) {
    xml_ += text;
    xml_ += '\n';
  }

  template <class T>
  void array(std::string_view name, int components, const std::vector<T>& values,
             std::string_view attributes = "") {
    fmt::format_to(std::back_inserter(xml_),
                   "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" "
                   "offset=\"{}\"/>\n",
                   vtk_type<T>(), name, components, attributes, data_.size());
    const std::uint64_t bytes = values.size() * sizeof(T);
    data_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    data_.append(reinterpret_cast<const char*>(values.data()), bytes);
  }

  std::string text() && {
    xml_ += "  <AppendedData encoding=\"raw\">\n_";
    xml_ += data_;
    xml_ += "\n  </AppendedData>\n</VTKFile>\n";
    return std::move(xml_);
  }

 private:
  std::string xml_, data_;
};

// VTK's type of a group's cells: of their corners where it has none for the element.
int cell_type(const ElementEntry& entry) {
  if (entry.vtk.type != 0) return entry.vtk.type;
  return entry.triangle() ? 5 : 9;
}

void add_points(VtuText& vtu, const Model& model, const NodalLayout& layout) {
  std::vector<double> x;
  x.reserve(layout.node.size() * 3);
  for (int node : layout.node) x.insert(x.end(), {model.mesh.x(0, node), model.mesh.x(1, node), 0.0});
  vtu.tag("      <Points>");
  vtu.array("Points", 3, x);
  vtu.tag("      </Points>");
}

void add_cells(VtuText& vtu, const Model& model, const NodalLayout& layout) {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const std::vector<int>& entries = layout.of_group[g];
    if (entries.empty()) continue;
    const ElementEntry& entry = *model.groups[g].entry;
    const auto type = static_cast<std::uint8_t>(cell_type(entry));
    const std::vector<int> order = foreign_nodes(entry, entry.vtk);
    for (std::size_t at = 0; at < entries.size(); at += model.groups[g].node_count()) {
      for (int i : order) connectivity.push_back(entries[at + static_cast<std::size_t>(i)]);
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      types.push_back(type);
    }
  }
  vtu.tag("      <Cells>");
  vtu.array("connectivity", 1, connectivity);
  vtu.array("offsets", 1, offsets);
  vtu.array("types", 1, types);
  vtu.tag("      </Cells>");
}

template <class Value>
std::vector<double> vectors(const NodalLayout& layout, Value value) {
  std::vector<double> result;
  result.reserve(layout.node.size() * 3);
  for (int node : layout.node) result.insert(result.end(), {value(2 * node), value(2 * node + 1), 0.0});
  return result;
}

void add_point_data(VtuText& vtu, const Model& model, const Solution& s, const NodalLayout& layout) {
  const PointValue stress = [](const GroupData& data, std::size_t point, double* values) {
    const bool solid = data.group->solid();
    for (std::size_t i = 0; i < 4; ++i)
      values[i] = solid ? outward(data.state.committed.sigma[4 * point + i]) : kNone;
  };
  std::vector<std::int32_t> numbers;
  for (int node : layout.node) numbers.push_back(model.mesh.number[static_cast<std::size_t>(node)]);
  vtu.tag("      <PointData Vectors=\"displacement\">");
  vtu.array("displacement", 3, vectors(layout, [&](int dof) { return (*s.u)[dof]; }));
  vtu.array("external_force", 3, vectors(layout, [&](int dof) { return (*s.external)[dof]; }));
  vtu.array("reaction", 3, vectors(layout, [&](int dof) {
              return s.activity->held[static_cast<std::size_t>(dof)] ? reaction(s, dof) : 0.0;
            }));
  vtu.array("stress", 4, nodal_average(model, s, layout, 4, stress),
            " ComponentName0=\"xx\" ComponentName1=\"yy\" ComponentName2=\"zz\" ComponentName3=\"xy\"");
  vtu.array("node", 1, numbers);
  vtu.tag("      </PointData>");
}

// mean stress, q, stress level, yielded, interface shear, interface normal of a point.
constexpr int kCellValues = 6;
constexpr std::array<std::string_view, kCellValues> kCellNames{
    "mean_stress", "q", "stress_level", "yielded", "interface_shear", "interface_normal"};

void cell_values(const Mesh& mesh, const GroupData& data, std::size_t point, double* values) {
  const PointStates& state = data.state.committed;
  const bool solid = data.group->solid();
  const double* sigma = state.sigma.data() + point * static_cast<std::size_t>(data.state.law_size());
  const PointStatus status = shown_status(mesh, data, point);
  values[0] = solid ? mean_stress(sigma) : kNone;
  values[1] = solid ? deviator_stress(sigma) : kNone;
  values[2] = stress_level(data, point);
  values[3] = status == PointStatus::elastic || status == PointStatus::unloading ? 0.0 : 1.0;
  values[4] = solid ? kNone : outward(sigma[0]);
  values[5] = solid ? kNone : outward(sigma[1]);
}

void add_cell_data(VtuText& vtu, const Model& model, const Solution& s) {
  std::vector<std::int32_t> group_number, material_number, element_number;
  std::array<std::vector<double>, kCellValues> columns;
  bool interfaces = false;
  for (const GroupData& data : s.assembly->groups()) {
    if (!data.active) continue;
    const Group& group = *data.group;
    interfaces = interfaces || data.group->interface();
    const std::vector<double> values = element_average(
        data, kCellValues,
        [&](const GroupData& d, std::size_t point, double* v) { cell_values(model.mesh, d, point, v); });
    for (std::size_t k = 0; k < values.size(); ++k) columns[k % kCellValues].push_back(values[k]);
    const auto elements = static_cast<std::size_t>(group.elements());
    group_number.insert(group_number.end(), elements, group.number);
    material_number.insert(material_number.end(), elements, model.material_of(group).number);
    element_number.insert(element_number.end(), group.element_numbers.begin(), group.element_numbers.end());
  }
  vtu.tag("      <CellData>");
  vtu.array("group", 1, group_number);
  vtu.array("material", 1, material_number);
  vtu.array("element", 1, element_number);
  for (std::size_t c = 0; c < (interfaces ? 6u : 4u); ++c) vtu.array(kCellNames[c], 1, columns[c]);
  vtu.tag("      </CellData>");
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

std::string vtu_text(const Model& model, const Solution& solution, std::string_view comment) {
  const NodalLayout layout = nodal_layout(model, *solution.activity);
  std::size_t cells = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    cells += solution.activity->group[g] ? static_cast<std::size_t>(model.groups[g].elements()) : 0;
  VtuText vtu;
  vtu.tag(
      "<?xml version=\"1.0\"?>\n" + head(model, comment) +
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
  vtu.tag("  <UnstructuredGrid>");
  vtu.tag(fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", layout.entries(), cells));
  add_points(vtu, model, layout);
  add_cells(vtu, model, layout);
  add_point_data(vtu, model, solution, layout);
  add_cell_data(vtu, model, solution);
  vtu.tag("    </Piece>");
  vtu.tag("  </UnstructuredGrid>");
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
  write_file(files_.back(), vtu_text(model, solution, comment));
  pvd_.text() += fmt::format("    <DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}\"/>\n",
                             report.stage + report.load_factor, xml_text(name));
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
