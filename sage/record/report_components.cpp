#include "sage/record/report_components.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sage/model/activity.hpp"
#include "sage/model/flow_line.hpp"
#include "sage/model/locate.hpp"
#include "sage/model/section_cut.hpp"

namespace sage {

namespace {

std::vector<std::string> columns_of(const Model& model, const Report& report) {
  if (report.kind == ReportKind::triaxial) {
    std::vector<std::string> names{"ratio",        "measured_deviator", "axial_strain",
                                   "force",        "correct_deviator",  "measured_axial",
                                   "correct_axial"};
    if (model.large_strain) names.insert(names.end(), {"measured_corrected", "correct_corrected"});
    return names;
  }
  if (report.kind == ReportKind::nodes) return {"ux", "uy", "fx", "fy"};
  std::vector<std::string> names;
  for (const ReportColumn& column : report_columns(model, report)) names.push_back(column.name);
  return names;
}

std::string name_of(std::size_t report, const std::string& column) {
  return "report" + std::to_string(report + 1) + "." + column;
}

// Nodes of the deck in a report that are held in a direction at some time.
int held_nodes(const Model& model, const Report& report, std::size_t c) {
  const auto holds = [&](const std::vector<Fixity>& fixities, int node) {
    return std::any_of(fixities.begin(), fixities.end(),
                       [&](const Fixity& f) { return f.node == node && f.code[c] == FixityCode::fixed; });
  };
  return static_cast<int>(std::count_if(report.nodes.begin(), report.nodes.end(), [&](int node) {
    return node < model.mesh.deck_nodes &&
           (holds(model.fixities, node) ||
            std::any_of(model.stages.begin(), model.stages.end(),
                        [&](const Stage& stage) { return holds(stage.fixities, node); }));
  }));
}

int deck_nodes(const Model& model, const Report& report) {
  return static_cast<int>(std::count_if(report.nodes.begin(), report.nodes.end(),
                                        [&](int node) { return node < model.mesh.deck_nodes; }));
}

void add_triaxial(const Model& model, const Report& report, std::size_t i, const std::vector<TriaxialRow>& rows,
                  std::vector<ReportComponent>& all) {
  const TriaxialRow& r = rows.back();
  const double values[] = {r.ratio,         r.measured_deviator,  r.axial_strain,
                           r.force,         r.correct_deviator,   r.measured_axial,
                           r.correct_axial, r.measured_corrected, r.correct_corrected};
  const std::vector<std::string> columns = columns_of(model, report);
  for (std::size_t k = 0; k < columns.size(); ++k)
    all.push_back({name_of(i, columns[k]), values[k], std::abs(values[k]), false});
  all[all.size() - columns.size() + (std::isfinite(r.ratio) ? 0 : 1)].main = true;
}

void add_nodes(const Model& model, const Report& report, std::size_t i, const std::vector<NodesRow>& rows,
               std::vector<ReportComponent>& all) {
  double largest[2] = {0.0, 0.0};  // displacement, force
  for (const NodesRow& row : rows)
    for (int c = 0; c < 2; ++c) {
      largest[0] = std::max(largest[0], std::abs(row.displacement[c]));
      largest[1] = std::max(largest[1], std::abs(row.force[c]));
    }
  const std::vector<std::string> columns = columns_of(model, report);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t c = k % 2;
    const int held = held_nodes(model, report, c), nodes = deck_nodes(model, report);
    const bool force = k >= 2, main = force ? held >= 2 : held < 2 && held < nodes;
    const double value = (force ? rows.back().force : rows.back().displacement)[c];
    all.push_back({name_of(i, columns[k]), value, largest[force ? 1 : 0], main});
  }
}

// Sisters of a point's component are those of its dimension: displacements, strains, stresses.
void add_point(const Model& model, std::size_t i, const Reports& reports, std::vector<ReportComponent>& all) {
  const std::vector<ReportColumn> columns = report_columns(model, model.reports[i]);
  std::map<Dimension, double> largest;
  const FieldTable table = fields_of(model);
  std::vector<Dimension> family;
  for (const FieldEntry* field : point_report_fields(model, table, model.reports[i]))
    family.insert(family.end(), field->size(), field->dimension);
  for (std::size_t row = 0; row < reports.rows(i); ++row) {
    const std::vector<double> values = reports.values(i, row);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      double& most = largest[family[k]];
      if (std::abs(values[k]) > most) most = std::abs(values[k]);
    }
  }
  const std::vector<double> last = reports.values(i, reports.rows(i) - 1);
  const bool flow = kind_at_points(model) == ElementKind::flow;
  for (std::size_t k = 0; k < columns.size(); ++k)
    all.push_back({name_of(i, columns[k].name), last[k], largest[family[k]],
                   k < 2 || columns[k].name.starts_with(flow ? "velocity_" : "stress_")});
}

// The discharge is what converges everywhere: a gradient may have no bound at a corner, and the others come with it.
void add_discharge(const Model& model, std::size_t i, const Reports& reports,
                   std::vector<ReportComponent>& all) {
  const std::vector<std::string> columns = columns_of(model, model.reports[i]);
  const std::vector<double> last = reports.values(i, reports.rows(i) - 1);
  std::vector<double> largest(columns.size(), 0.0);
  for (std::size_t row = 0; row < reports.rows(i); ++row) {
    const std::vector<double> values = reports.values(i, row);
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (std::abs(values[k]) > largest[k]) largest[k] = std::abs(values[k]);
  }
  const std::size_t fx = columns.size() - 2;
  largest[fx] = largest[fx + 1] = std::max(largest[fx], largest[fx + 1]);
  for (std::size_t k = 0; k < columns.size(); ++k)
    all.push_back({name_of(i, columns[k]), last[k], largest[k], k == 0});
}

void add_uplift(std::size_t i, const Reports& reports, std::vector<ReportComponent>& all) {
  const std::vector<double> last = reports.values(i, reports.rows(i) - 1);
  for (std::size_t k = 0; k < last.size(); ++k)
    all.push_back({name_of(i, reports.columns(i)[k].name), last[k], std::abs(last[k]), k == 2});
}

// Sisters of a force are the others of all rows, those of a moment also the largest force times the length of the cut: a moment
// that is nothing beside that is rounding.
void add_section(const Model& model, std::size_t i, const Reports& reports, std::vector<ReportComponent>& all) {
  const std::vector<ReportColumn>& columns = reports.columns(i);
  const std::vector<double> last = reports.values(i, reports.rows(i) - 1);
  std::map<std::string, double> largest;  // by unit
  for (std::size_t row = 0; row < reports.rows(i); ++row) {
    const std::vector<double> values = reports.values(i, row);
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (std::abs(values[k]) > largest[columns[k].unit]) largest[columns[k].unit] = std::abs(values[k]);
  }
  const std::size_t forces = model.geometry == Geometry::axisymmetric ? 5 : 3;
  double& moments = largest[columns[2].unit];
  moments = std::max(moments, largest[columns[0].unit] * reports.sections(i).back().value.length);
  for (std::size_t k = 0; k < columns.size(); ++k)
    all.push_back({name_of(i, columns[k].name), last[k], largest[columns[k].unit], k < forces});
}

// Empty where the cut meets a solid that is active at the end.
std::string why_no_section(const Model& model, const Report& report) {
  Activity activity(model);
  for (const Stage& stage : model.stages) activity.enter(stage);
  if (!cut_pieces(model, report.place, report.end, activity.group, report.group).empty()) return {};
  return "no solid on its cut is active at the end";
}

// Empty where water flows through the line at the end.
std::string why_no_discharge(const Model& model, const Report& report) {
  Activity activity(model);
  for (const Stage& stage : model.stages) activity.enter(stage);
  const std::string fault = flow_line(model, activity.group, report.nodes).fault;
  return fault.empty() ? fault : "its line at the end: " + fault;
}

}  // namespace

std::vector<std::string> component_names(const Model& model) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.reports.size(); ++i)
    for (const std::string& column : columns_of(model, model.reports[i])) names.push_back(name_of(i, column));
  return names;
}

std::string why_no_value(const Model& model, std::size_t index) {
  const Report& report = model.reports[index];
  if (report.kind == ReportKind::discharge) return why_no_discharge(model, report);
  if (report.kind == ReportKind::section) return why_no_section(model, report);
  if (report.kind != ReportKind::point) return {};
  const std::string point = fmt::format("the point ({:.10g}; {:.10g})", report.place.x(), report.place.y());
  const std::vector<Location> found = Locator(model, kind_at_points(model)).at(report.place);
  if (one_body(model, found, {}, report.group).empty()) return point + " lies outside the mesh";
  Activity activity(model);
  int last_holder = -1, removed_in = 0;
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    activity.enter(model.stages[s]);
    const std::vector<Location> now = one_body(model, found, activity.group, report.group);
    if (now.empty() && removed_in == 0) removed_in = static_cast<int>(s) + 1;
    if (now.empty()) continue;
    last_holder = model.groups[now.front().group].number;
    removed_in = 0;
  }
  if (last_holder < 0) return "no element that holds " + point + " is ever active";
  if (removed_in == 0) return {};
  return "group " + std::to_string(last_holder) + ", which holds " + point + ", is removed in stage " +
         std::to_string(removed_in);
}

std::vector<ReportComponent> last_components(const Model& model, const Reports& reports) {
  std::vector<ReportComponent> all;
  for (std::size_t i = 0; i < model.reports.size() && i < reports.count(); ++i) {
    const Report& report = model.reports[i];
    if (report.kind == ReportKind::triaxial && !reports.triaxial(i).empty())
      add_triaxial(model, report, i, reports.triaxial(i), all);
    if (report.kind == ReportKind::nodes && !reports.nodes(i).empty())
      add_nodes(model, report, i, reports.nodes(i), all);
    if (report.kind == ReportKind::point && reports.rows(i) > 0) add_point(model, i, reports, all);
    if (report.kind == ReportKind::uplift && reports.rows(i) > 0) add_uplift(i, reports, all);
    if (report.kind == ReportKind::section && reports.rows(i) > 0) add_section(model, i, reports, all);
    if (report.kind == ReportKind::discharge && reports.rows(i) > 0) add_discharge(model, i, reports, all);
  }
  return all;
}

}  // namespace sage
