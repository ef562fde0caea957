#include "sage/record/msh_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>

#include "sage/model/foreign_element.hpp"
#include "sage/model/msh_numbers.hpp"
#include "sage/record/state_time.hpp"
#include "sage/record/vtk_data.hpp"

namespace sage {

namespace {

struct Step {
  double time = 0.0;
  int index = 0;
};

// One view of one state.
class View {
 public:
  // kind: "NodeData".  numbers: per row.  words: all numbers of a row, its element and count included.
  View(OutFile& file, MshForm form, std::string_view kind, const std::string& name, const Step& step,
       int numbers, std::size_t rows, std::size_t words)
      : file_(file), numbers_(file.text(), form), kind_(kind) {
    if (form == MshForm::binary) file.text().reserve(file.text().size() + 1000 + rows * words * sizeof(double));
    fmt::format_to(std::back_inserter(file.text()), "${}\n1\n\"{}\"\n1\n{}\n3\n{}\n{}\n{}\n", kind, name,
                   step.time, step.index, numbers, rows);
  }
  void add(int number) { numbers_ << number; }
  void add(double value) { numbers_ << value; }
  void end_row() { numbers_.end_line(); }
  void close() {
    numbers_.end_section(kind_);
    file_.checkpoint();  // the next view has its memory
  }

 private:
  OutFile& file_;
  MshNumbers numbers_;
  std::string_view kind_;
};

std::string view_name(const FieldEntry& field, const std::string& name, const UnitSystem& units) {
  std::string text = name + field_unit(field, units);
  std::ranges::replace(text, '"', '\'');
  return text;
}

void add_node_views(OutFile& file, MshForm form, const Model& model, const Solution& now,
                    const FieldTable& table, const Step& step) {
  const NodeViews views(model, now);
  for (const FieldEntry& field : table.rows()) {
    if (field.place() != FieldPlace::node || field.form != FieldForm::number) continue;
    const bool vector = field.shape == FieldShape::vector;
    const auto nodes = static_cast<std::size_t>(model.mesh.nodes());
    View view(file, form, "NodeData", view_name(field, field.name, model.units), step, vector ? 3 : 1, nodes,
              vector ? 4 : 2);
    std::vector<double> value(std::max<std::size_t>(field.size(), 3), 0.0);
    for (int node = 0; node < model.mesh.nodes(); ++node) {
      read_field(field, views.at(node), value.data());
      view.add(model.mesh.number[node]);
      // A support that is not there gives no reaction.
      for (std::size_t c = 0; c < (vector ? 3u : 1u); ++c)
        view.add(vector && std::isnan(value[c]) ? 0.0 : value[c]);
      view.end_row();
    }
    view.close();
  }
}

// From [xx yy zz xy yz xz] to rows of the matrix.
constexpr std::array<std::size_t, 9> kMatrix{0, 3, 5, 3, 1, 4, 5, 4, 2};

void add_matrix(View& view, const double* value) {
  for (std::size_t c : kMatrix) view.add(value[c]);
  view.end_row();
}

// Of each node its entry, -1 where it has none; empty where a node has more than one.
std::vector<int> entry_of_nodes(const Model& model, const NodalLayout& layout) {
  std::vector<int> entry(static_cast<std::size_t>(model.mesh.nodes()), -1);
  for (int i = 0; i < layout.entries(); ++i)
    if (std::exchange(entry[layout.node[i]], i) >= 0) return {};
  return entry;
}

// Where no node has two values: a quarter of what the nodes of every solid take.
void add_tensor_of_nodes(OutFile& file, MshForm form, const Model& model, const std::vector<int>& entries,
                         const VtkArray& array, const Step& step) {
  const auto& values = std::get<std::vector<double>>(array.values);
  const std::vector<double> none(6, std::numeric_limits<double>::quiet_NaN());
  View view(file, form, "NodeData", view_name(*array.field, array.name, model.units), step, 9, entries.size(),
            10);
  for (std::size_t node = 0; node < entries.size(); ++node) {
    view.add(model.mesh.number[node]);
    add_matrix(view, entries[node] < 0 ? none.data() : &values[static_cast<std::size_t>(entries[node]) * 6]);
  }
  view.close();
}

void add_tensor_view(OutFile& file, MshForm form, const Model& model, const NodalLayout& layout,
                     const VtkArray& array, const Step& step) {
  if (const std::vector<int> entries = entry_of_nodes(model, layout); !entries.empty())
    return add_tensor_of_nodes(file, form, model, entries, array, step);
  const auto& values = std::get<std::vector<double>>(array.values);
  std::size_t rows = 0, nodes = 0;  // nodes: the most of one element
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.solid() || layout.of_group[g].empty()) continue;
    rows += static_cast<std::size_t>(group.elements());
    nodes = std::max(nodes, foreign_nodes(*group.entry, group.entry->gmsh).size());
  }
  View view(file, form, "ElementNodeData", view_name(*array.field, array.name, model.units), step, 9, rows,
            9 * nodes + 1);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.solid() || layout.of_group[g].empty()) continue;
    const std::vector<int> order = foreign_nodes(*group.entry, group.entry->gmsh);
    for (int e = 0; e < group.elements(); ++e) {
      view.add(group.element_numbers[e]);
      view.add(static_cast<int>(order.size()));
      for (int i : order) {
        const std::size_t at = static_cast<std::size_t>(e) * group.node_count() + static_cast<std::size_t>(i);
        const auto entry = static_cast<std::size_t>(layout.of_group[g][at]);
        for (std::size_t c : kMatrix) view.add(values[entry * 6 + c]);
      }
      view.end_row();
    }
  }
  view.close();
}

// A vector of three, or one component after the other.  rows: of the elements, in the order of the file; -1: none.
void add_element_views(OutFile& file, MshForm form, const VtkArray& array, const std::vector<int>& elements,
                       const std::vector<long>& rows, const Step& step, const UnitSystem& units) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto* values = std::get_if<std::vector<double>>(&array.values);
  if (values == nullptr) return;  // numbers of groups, materials, elements: the mesh says them
  const std::size_t together = array.field->shape == FieldShape::vector ? array.width : 1;
  for (std::size_t first = 0; first < array.width; first += together) {
    std::string name = array.name;
    if (together < array.width) name += "_" + array.components[first];
    View view(file, form, "ElementData", view_name(*array.field, name, units), step, static_cast<int>(together),
              elements.size(), together + 1);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      view.add(elements[i]);
      for (std::size_t c = first; c < first + together; ++c)
        view.add(rows[i] < 0 ? kNone : (*values)[static_cast<std::size_t>(rows[i]) * array.width + c]);
      view.end_row();
    }
    view.close();
  }
}

// Of the elements of a file: the row of each among the active ones.
std::vector<long> rows_of(const std::vector<int>& elements, const Solution& now) {
  std::unordered_map<int, long> row_of;
  for (const GroupData& data : now.groups())
    if (data.active)
      for (int number : data.group->element_numbers)
        row_of.try_emplace(number, static_cast<long>(row_of.size()));
  std::vector<long> rows(elements.size(), -1);
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (const auto row = row_of.find(elements[i]); row != row_of.end()) rows[i] = row->second;
  return rows;
}

}  // namespace

MshResults::MshResults(const std::filesystem::path& folder, const std::string& stem, const std::string& mesh,
                       std::vector<int> elements, MshForm form)
    : file_(folder / (stem + ".msh")), elements_(std::move(elements)), form_(form) {
  file_.text() = mesh;
}

void MshResults::add(const Model& model, const StepReport& report, const Solution& now) {
  const FieldTable table = fields_of(model);
  const Step step{StateTime(model).at(report), count_++};
  const NodalLayout layout = nodal_layout(model, *now.activity);
  add_node_views(file_, form_, model, now, table, step);
  for (const VtkArray& array : vtk_point_data(model, now, layout, table))
    if (array.field->shape == FieldShape::tensor) add_tensor_view(file_, form_, model, layout, array, step);
  const std::vector<long> rows = rows_of(elements_, now);
  for (const VtkArray& array : vtk_cell_data(model, now, table))
    add_element_views(file_, form_, array, elements_, rows, step, model.units);
  file_.checkpoint();
}

void MshResults::on_increment(const Model& model, const StepReport& report, const Solution& now) {
  if (is_output_increment(stage_of(model, report.stage), report)) add(model, report, now);
}

void MshResults::on_failure(const Model& model, const StepReport& report, const std::string& reason,
                            const Solution& now) {
  add(model, report, now);
  comment("NOT CONVERGED: " + reason);
}

// Readers pass over sections that they don't know.
void MshResults::comment(const std::string& text) {
  file_.text() += "$Comments\n" + text + "\n$EndComments\n";
}

void MshResults::finish() {
  if (!file_.open()) return;
  file_.finish();
  files_.push_back(file_.path());
}

void MshResults::on_finish(const Model&, const RunResult&) {
  finish();
}

void MshResults::exchange(Archive& archive) {
  file_.exchange(archive);
  archive(count_);
}

void MshResults::stop(const std::string&) {
  if (file_.open()) comment("RUN STOPPED, NOT COMPLETE");
  finish();
}

}  // namespace sage
