#include "sage/record/csv.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sage/analysis/shown_status.hpp"
#include "sage/record/number.hpp"
#include "sage/record/values.hpp"

namespace sage {

namespace {

// A table's cells, one behind the other.
struct Cells {
  std::string& text;
  int digits = kCsvDigits;

  void result(double value) const { append_result_cell(text, value, digits); }
  void optional(double value) const { append_optional_cell(text, value, digits); }
  void integer(long value) const {
    text += ',';
    append_integer(text, value, 0);
  }
  void word(std::string_view value) const {
    text += ',';
    text += value;
  }
  void blank() const { text += ','; }
  // The first two columns.
  void begin(const StepReport& report) const {
    append_integer(text, report.stage + 1, 0);
    integer(report.increment);
  }
  void end() const { text += '\n'; }
};

std::string head(const Model& model) {
  return "# " + model.title + "\n" + sign_convention(model, "# ");
}

std::string increments_header(const Model& model) {
  return head(model) +
         fmt::format(
             "stage,increment,load_factor[-],converged,iterations,relative_force[-],relative_displacement[-],"
             "relative_energy[-],cuts,substeps,elastic,unloading,yielded,slipping,open,apex,worst_node,worst_"
             "component,"
             "worst_residual[{}],smallest_pivot_ratio[-],displacement_over_extent[-]\n",
             model.units.force);
}

std::string nodes_header(const Model& model) {
  return head(model) + fmt::format(
                           "stage,increment,node,x[{0}],y[{0}],ux[{0}],uy[{0}],load_x[{1}],load_y[{1}],"
                           "reaction_x[{1}],reaction_y[{1}]\n",
                           model.units.length, model.units.force);
}

// Names of the history variables of all laws of solids, or of all others, each once.
std::vector<Quantity> history_columns(const Model& model, bool solid) {
  std::vector<Quantity> columns;
  for (const Group& group : model.groups) {
    if (group.solid() != solid) continue;
    const auto quantities =
        std::visit([](const auto* law) { return law->history(); }, model.material_of(group).law_ref());
    for (const Quantity& q : quantities)
      if (std::none_of(columns.begin(), columns.end(), [&](const Quantity& c) { return c.name == q.name; }))
        columns.push_back(q);
  }
  return columns;
}

std::string points_header(const Model& model, bool solid, const std::vector<Quantity>& history) {
  const UnitSystem& u = model.units;
  std::string text = head(model);
  if (model.geometry == Geometry::axisymmetric) text += "# x = r, y = z, zz = hoop\n";
  text += fmt::format("stage,increment,group,element,point,x[{0}],y[{0}],", u.length);
  text += solid ? fmt::format(
                      "stress_xx[{0}],stress_yy[{0}],stress_zz[{0}],stress_xy[{0}],strain_xx[-],strain_yy[-],"
                      "strain_zz[-],strain_xy[-]",
                      u.stress)
                : fmt::format("shear[{0}],normal[{0}],relative_shear[{1}],relative_normal[{1}]", u.stress,
                              u.length);
  text += ",stress_level[-],status";
  for (const Quantity& q : history) text += fmt::format(",{}[{}]", q.name, unit_text(q.dimension, u));
  return text + "\n";
}

void increment_row(const Cells& cells, const StepReport& r) {
  const IterationRecord last = r.iterations.empty() ? IterationRecord{} : r.iterations.back();
  cells.begin(r);
  cells.result(r.load_factor);
  cells.integer(r.converged ? 1 : 0);
  cells.integer(r.total_iterations);
  // Of a step that failed they may be anything.
  for (double v : {last.force, last.displacement, last.energy}) cells.optional(v);
  cells.integer(r.cuts);
  cells.integer(r.substeps);
  for (long count : r.points) cells.integer(count);
}

void worst_columns(const Cells& cells, const Model& model, const StepReport& r) {
  if (r.worst.node >= 0) {
    cells.integer(model.mesh.number[static_cast<std::size_t>(r.worst.node)]);
    cells.word(r.worst.component == 0 ? "x" : "y");
    cells.optional(r.worst.residual);
  } else {
    for (int i = 0; i < 3; ++i) cells.blank();
  }
  if (r.smallest_pivot_ratio >= 0.0)
    cells.optional(r.smallest_pivot_ratio);
  else
    cells.blank();
  cells.optional(r.motion);
  cells.end();
}

void node_rows(const Cells& cells, const Model& model, const StepReport& report, const Solution& s) {
  const std::vector<char> active = active_nodes(model, *s.activity);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const auto n = static_cast<std::size_t>(node);
    if (!active[n]) continue;
    cells.begin(report);
    cells.integer(model.mesh.number[n]);
    for (int c = 0; c < 2; ++c) cells.result(model.mesh.x(c, node));
    for (int c = 0; c < 2; ++c) cells.result((*s.u)[2 * node + c]);
    for (int c = 0; c < 2; ++c) cells.result((*s.external)[2 * node + c]);
    for (std::size_t c = 0; c < 2; ++c) {
      if (s.activity->held[2 * n + c])
        cells.result(reaction(s, 2 * node + static_cast<int>(c)));
      else
        cells.blank();
    }
    cells.end();
  }
}

void history_cells(const Cells& cells, const GroupData& data, std::size_t point,
                   const std::vector<std::string_view>& columns) {
  const std::span<const Quantity> quantities = history_of(data);
  const double* h = data.state.committed.h.data() + point * quantities.size();
  for (std::string_view column : columns) {
    const auto it =
        std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& q) { return q.name == column; });
    if (it == quantities.end())
      cells.blank();
    else
      cells.result(outward(*it, h[it - quantities.begin()]));
  }
}

void point_rows(const Cells& cells, const Model& model, const StepReport& report, const GroupData& data,
                const std::vector<std::string_view>& history) {
  const Group& group = *data.group;
  const PointStates& state = data.state.committed;
  const auto n = static_cast<std::size_t>(data.state.law_size());
  const int count = group.element->traits().points;
  Eigen::Matrix2Xd x;
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(model.mesh, group, e, x);
    for (int p = 0; p < count; ++p) {
      const auto point = static_cast<std::size_t>(e * count + p);
      const Vector2 at = group.element->position(x, p);
      cells.begin(report);
      cells.integer(group.number);
      cells.integer(group.element_numbers[static_cast<std::size_t>(e)]);
      cells.integer(p + 1);
      cells.result(at.x());
      cells.result(at.y());
      for (std::size_t i = 0; i < n; ++i) cells.result(outward(state.sigma[point * n + i]));
      for (std::size_t i = 0; i < n; ++i) cells.result(outward(state.eps[point * n + i]));
      cells.optional(stress_level(data, point));  // infinite where no strength is left
      cells.word(status_name(shown_status(model.mesh, data, point)));
      history_cells(cells, data, point, history);
      cells.end();
    }
  }
}

// A result that is no number throws: the rows of its state are then taken back.
template <class AddRows>
void add_whole(OutFile& file, const AddRows& add_rows) {
  if (!file.open()) return;
  const std::size_t before = file.text().size();
  try {
    add_rows(file.text());
  } catch (...) {
    file.text().resize(before);
    throw;
  }
}

}  // namespace

Csv::Csv(const std::filesystem::path& folder, const std::string& stem, CsvOptions options)
    : folder_(folder), stem_(stem), digits_(options.digits) {
  if (options.increments) increments_ = OutFile(folder / (stem + ".increments.csv"));
  if (options.nodes) nodes_ = OutFile(folder / (stem + ".nodes.csv"));
  if (options.points) points_.file = OutFile(folder / (stem + ".points.csv"));
}

void Csv::on_start(const Model& model, const Scene&, std::string_view, int) {
  increments_.text() = increments_header(model);
  nodes_.text() = nodes_header(model);
  if (!points_.file.open()) return;
  const auto open = [&](Table& table, bool solid) {
    const std::vector<Quantity> columns = history_columns(model, solid);
    table.file.text() = points_header(model, solid, columns);
    for (const Quantity& q : columns) table.history.push_back(q.name);
  };
  open(points_, true);
  const bool interfaces =
      std::any_of(model.groups.begin(), model.groups.end(), [](const Group& g) { return g.interface(); });
  if (!interfaces) return;
  interfaces_.file = OutFile(folder_ / (stem_ + ".interfaces.csv"));
  open(interfaces_, false);
}

void Csv::add_increment(const Model& model, const StepReport& report) {
  add_whole(increments_, [&](std::string& text) {
    const Cells cells{text, digits_};
    increment_row(cells, report);
    worst_columns(cells, model, report);
  });
}

void Csv::add_states(const Model& model, const StepReport& report, const Solution& solution) {
  add_whole(nodes_, [&](std::string& text) { node_rows({text, digits_}, model, report, solution); });
  for (Table* table : {&points_, &interfaces_})
    add_whole(table->file, [&](std::string& text) {
      for (const GroupData& data : solution.assembly->groups())
        if (data.active && data.group->solid() == (table == &points_))
          point_rows({text, digits_}, model, report, data, table->history);
    });
  for (OutFile* file : all()) file->checkpoint();
}

void Csv::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  add_increment(model, report);
  increments_.checkpoint();
  if (is_output_increment(stage_of(model, report.stage), report)) add_states(model, report, solution);
}

void Csv::exchange(Archive& archive) {
  for (OutFile* file : all()) file->exchange(archive);
}

void Csv::comment(const std::string& line) {
  for (OutFile* file : all())
    if (file->open()) file->text() += "# " + line + "\n";
}

void Csv::on_failure(const Model& model, const StepReport& report, const std::string&,
                     const Solution& solution) {
  add_increment(model, report);
  add_states(model, report, solution);
  comment(fmt::format(
      "NOT CONVERGED in stage {}, increment {}; the last state in equilibrium is at load factor {:.6g}",
      report.stage + 1, report.increment, report.load_factor));
}

void Csv::finish() {
  for (OutFile* file : all()) {
    if (!file->open()) continue;
    file->finish();
    files_.push_back(file->path());
  }
}

void Csv::on_finish(const Model&, const RunResult&) {
  finish();
}

void Csv::stop(const std::string& reason) {
  comment("RUN STOPPED, NOT COMPLETE: " + one_line(reason));
  finish();
}

}  // namespace sage
