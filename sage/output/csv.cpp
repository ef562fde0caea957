#include "sage/output/csv.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sage/analysis/shown_status.hpp"
#include "sage/output/number.hpp"
#include "sage/output/values.hpp"

namespace sage {

namespace {

constexpr int kDigits = 10;

void cell(std::string& text, double value) {
  text += ',';
  append_plain(text, value, kDigits);
}

void cell(std::string& text, long value) {
  text += ',';
  append_integer(text, value, 0);
}

void place(std::string& text, const StepReport& report) {
  append_integer(text, report.stage + 1, 0);
  cell(text, static_cast<long>(report.increment));
}

std::string head(const Model& model) {
  return "# " + model.title + "\n" + sign_convention(model, "# ");
}

std::string increments_header(const Model& model) {
  return head(model) +
         fmt::format(
             "stage,increment,load_factor[-],converged,iterations,relative_force[-],relative_displacement[-],"
             "relative_energy[-],cuts,substeps,elastic,unloading,yielded,slipping,open,apex,worst_node,worst_"
             "component,"
             "worst_residual[{}],smallest_pivot_ratio[-]\n",
             model.units.force);
}

std::string nodes_header(const Model& model) {
  return head(model) + fmt::format(
                           "stage,increment,node,x[{0}],y[{0}],ux[{0}],uy[{0}],load_x[{1}],load_y[{1}],"
                           "reaction_x[{1}],reaction_y[{1}]\n",
                           model.units.length, model.units.force);
}

// Names of the history variables of all laws of a size, each once.
std::vector<Quantity> history_columns(const Model& model, int law_size) {
  std::vector<Quantity> columns;
  for (const Group& group : model.groups) {
    if (group.element->traits().law_size != law_size) continue;
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

void increment_row(std::string& text, const StepReport& r) {
  const IterationRecord last = r.iterations.empty() ? IterationRecord{} : r.iterations.back();
  place(text, r);
  cell(text, r.load_factor);
  cell(text, r.converged ? 1L : 0L);
  cell(text, static_cast<long>(r.total_iterations));
  for (double v : {last.force, last.displacement, last.energy}) cell(text, v);
  cell(text, static_cast<long>(r.cuts));
  cell(text, static_cast<long>(r.substeps));
  for (long count : r.points) cell(text, count);
}

void worst_columns(std::string& text, const Model& model, const StepReport& r) {
  if (r.worst.node >= 0) {
    cell(text, static_cast<long>(model.mesh.number[static_cast<std::size_t>(r.worst.node)]));
    text += r.worst.component == 0 ? ",x" : ",y";
    cell(text, r.worst.residual);
  } else {
    text += ",,,";
  }
  text += ',';
  if (r.smallest_pivot_ratio >= 0.0) append_plain(text, r.smallest_pivot_ratio, kDigits);
  text += '\n';
}

void node_rows(std::string& text, const Model& model, const StepReport& report, const Solution& s) {
  const std::vector<char> active = active_nodes(model, *s.activity);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const auto n = static_cast<std::size_t>(node);
    if (!active[n]) continue;
    place(text, report);
    cell(text, static_cast<long>(model.mesh.number[n]));
    for (int c = 0; c < 2; ++c) cell(text, model.mesh.x(c, node));
    for (int c = 0; c < 2; ++c) cell(text, (*s.u)[2 * node + c]);
    for (int c = 0; c < 2; ++c) cell(text, (*s.external)[2 * node + c]);
    for (std::size_t c = 0; c < 2; ++c) {
      if (s.activity->held[2 * n + c])
        cell(text, reaction(s, 2 * node + static_cast<int>(c)));
      else
        text += ',';
    }
    text += '\n';
  }
}

void history_cells(std::string& text, const GroupData& data, std::size_t point,
                   const std::vector<std::string_view>& columns) {
  const std::span<const Quantity> quantities = history_of(data);
  const double* h = data.state.committed.h.data() + point * quantities.size();
  for (std::string_view column : columns) {
    const auto it =
        std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& q) { return q.name == column; });
    if (it == quantities.end())
      text += ',';
    else
      cell(text, outward(*it, h[it - quantities.begin()]));
  }
}

void point_rows(std::string& text, const Model& model, const StepReport& report, const GroupData& data,
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
      place(text, report);
      cell(text, static_cast<long>(group.number));
      cell(text, static_cast<long>(group.element_numbers[static_cast<std::size_t>(e)]));
      cell(text, static_cast<long>(p + 1));
      cell(text, at.x());
      cell(text, at.y());
      for (std::size_t i = 0; i < n; ++i) cell(text, outward(state.sigma[point * n + i]));
      for (std::size_t i = 0; i < n; ++i) cell(text, outward(state.eps[point * n + i]));
      cell(text, stress_level(data, point));
      text += ',';
      text += status_name(shown_status(model.mesh, data, point));
      history_cells(text, data, point, history);
      text += '\n';
    }
  }
}

}  // namespace

Csv::Csv(const std::filesystem::path& folder, const std::string& stem, CsvOptions options)
    : folder_(folder), stem_(stem) {
  if (options.increments) increments_ = OutFile(folder / (stem + ".increments.csv"));
  if (options.nodes) nodes_ = OutFile(folder / (stem + ".nodes.csv"));
  if (options.points) points_.file = OutFile(folder / (stem + ".points.csv"));
}

void Csv::on_start(const Model& model, const Scene&, std::string_view, int) {
  increments_.text() = increments_header(model);
  nodes_.text() = nodes_header(model);
  if (!points_.file.open()) return;
  const auto open = [&](Table& table, int law_size) {
    const std::vector<Quantity> columns = history_columns(model, law_size);
    table.file.text() = points_header(model, law_size == 4, columns);
    for (const Quantity& q : columns) table.history.push_back(q.name);
  };
  open(points_, 4);
  const bool interfaces = std::any_of(model.groups.begin(), model.groups.end(),
                                      [](const Group& g) { return g.element->traits().law_size == 2; });
  if (!interfaces) return;
  interfaces_.file = OutFile(folder_ / (stem_ + ".interfaces.csv"));
  open(interfaces_, 2);
}

void Csv::add_states(const Model& model, const StepReport& report, const Solution& solution) {
  if (nodes_.open()) node_rows(nodes_.text(), model, report, solution);
  if (points_.file.open())
    for (const GroupData& data : solution.assembly->groups()) {
      if (!data.active) continue;
      Table& table = data.state.law_size() == 4 ? points_ : interfaces_;
      point_rows(table.file.text(), model, report, data, table.history);
    }
  for (OutFile* file : all()) file->checkpoint();
}

void Csv::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  if (increments_.open()) {
    increment_row(increments_.text(), report);
    worst_columns(increments_.text(), model, report);
    increments_.checkpoint();
  }
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
  if (increments_.open()) {
    increment_row(increments_.text(), report);
    worst_columns(increments_.text(), model, report);
  }
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
