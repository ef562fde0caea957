#include "sage/record/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sage/analysis/stage_warnings.hpp"
#include "sage/record/values.hpp"
#include "sage/record/without_rounding.hpp"

namespace sage {

namespace {

constexpr std::size_t kReportRows = 6;  // of a report's table
constexpr std::size_t kReports = 2;     // triaxial and node reports shown; the others are in their files
constexpr std::size_t kPoints = 4;      // the same of points

auto to(std::string& text) {
  return std::back_inserter(text);
}

std::string status_words(const Model& model, const RunResult& result) {
  switch (result.status) {
    case RunStatus::completed:
      return completed_words(model, result.motion);
    case RunStatus::not_converged:
      return "NOT CONVERGED";
    case RunStatus::singular:
      return "NOT CONVERGED: singular stiffness matrix";
    case RunStatus::stopped:
      return "STOPPED as asked";
    case RunStatus::failed:
      return "FAILED";
  }
  return "FAILED";
}

std::string point_words(const std::array<long, kStatuses>& points) {
  std::string text;
  for (PointStatus s : kAtStrength) {
    const long count = points[static_cast<std::size_t>(s)];
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status_name(s));
  }
  return text.empty() ? "none yielded, slipping or open" : text;
}

int wide(int width, int digits) {
  return digits > 0 ? std::max(width, digits + 8) : width;
}

// Rows spread evenly over the path; the last of each stage is kept.
template <class Row>
std::vector<Row> chosen(const std::vector<Row>& rows) {
  if (rows.size() <= kReportRows) return rows;
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i + 1 == rows.size() || rows[i + 1].stage != rows[i].stage) ends.push_back(i);
  const std::size_t stages = std::min(ends.size(), kReportRows);
  std::vector<std::size_t> take(ends.end() - static_cast<std::ptrdiff_t>(stages), ends.end());
  const std::size_t between = kReportRows - take.size();
  for (std::size_t k = 1; k <= between; ++k) take.push_back(k * rows.size() / (between + 1) - 1);
  std::sort(take.begin(), take.end());
  take.erase(std::unique(take.begin(), take.end()), take.end());
  std::vector<Row> result;
  for (std::size_t i : take) result.push_back(rows[i]);
  return result;
}

template <class Numbers>
void take_largest(double& largest, const Numbers& numbers) {
  for (const double number : numbers)
    if (std::isfinite(number)) largest = std::max(largest, std::abs(number));
}

constexpr const char* kHeldNote =
    "    * holds part of forces that are let go over the stage, borne by no load and no support\n";

// A number in a column of `width`, or wider where more digits are asked for; "-" where it is not known.
std::string cell(double value, const char* usual, int width, int digits) {
  if (std::isnan(value)) return fmt::format("{:>{}}", "-", wide(width, digits));
  return fmt::format(
      "{:>{}}", digits > 0 ? fmt::format("{:.{}g}", value, digits) : fmt::format(fmt::runtime(usual), value),
      wide(width, digits));
}

void triaxial_table(std::string& text, const Model& model, std::size_t index,
                    const std::vector<TriaxialRow>& rows, int digits) {
  fmt::format_to(to(text), "  triaxial {:<6}{:>7}{:>{}}{:>{}}{:>{}}{:>{}}\n", index + 1, "incr", "strain",
                 wide(10, digits), "measured [" + model.units.stress + "]", wide(18, digits),
                 "correct [" + model.units.stress + "]", wide(18, digits), "ratio", wide(10, digits));
  for (const TriaxialRow& r : chosen(rows))
    fmt::format_to(to(text), "    stage {:<7}{:>7}{}{:>{}}{}{}\n", r.stage, r.increment,
                   cell(r.axial_strain, "{:.4g}", 10, digits),
                   cell(r.measured_deviator, "{:.5g}", 0, digits) + (r.held != 0.0 ? "*" : ""),
                   wide(18, digits), cell(r.correct_deviator, "{:.5g}", 18, digits),
                   cell(r.ratio, "{:.4f}", 10, digits));
  if (std::ranges::any_of(rows, [](const TriaxialRow& r) { return r.held != 0.0; })) text += kHeldNote;
}

void node_table(std::string& text, const Model& model, std::size_t index, const std::vector<NodesRow>& rows,
                int digits) {
  const AxisNames names = axis_names(model.geometry);
  const UnitSystem& u = model.units;
  double length = 0.0, most = 0.0;
  for (const NodesRow& r : rows) {
    take_largest(length, r.displacement);
    take_largest(most, r.force);
  }
  fmt::format_to(to(text), "  nodes {:<11}sum of the forces on these nodes, {}\n    {:<13}{:>7}", index + 1,
                 forces_per(model), "", "incr");
  for (const std::string_view axis : {names.x, names.y})
    fmt::format_to(to(text), "{:>{}}", fmt::format("u-{} [{}]", axis, u.length), wide(12, digits));
  for (const std::string_view axis : {names.x, names.y})
    fmt::format_to(to(text), "{:>{}}", fmt::format("force-{} [{}]", axis, u.force), wide(15, digits));
  text += '\n';
  bool any_held = false;
  for (const NodesRow& r : chosen(rows)) {
    const bool held = r.held[0] != 0.0 || r.held[1] != 0.0;
    any_held = any_held || held;
    fmt::format_to(to(text), "    stage {:<7}{:>7}", r.stage, r.increment);
    for (double d : r.displacement) text += cell(without_rounding(d, length), "{:.5g}", 12, digits);
    for (double f : r.force) text += cell(without_rounding(f, most), "{:.6g}", 15, digits);
    text += held ? " *\n" : "\n";
  }
  if (any_held) text += kHeldNote;
}

// Names of the columns over their units.
void point_headings(std::string& text, const Model& model, const FieldList& fields, int width) {
  std::string names, units;
  for (const FieldEntry* field : fields)
    for (std::size_t c = 0; c < field->size(); ++c) {
      names += fmt::format("{:>{}}", field->label(c, model.geometry), width);
      units += fmt::format("{:>{}}", "[" + unit_text(field->dimension, model.units) + "]", width);
    }
  fmt::format_to(to(text), "    {:<5}{:>5}{}\n    {:<10}{}\n", "stage", "incr", names, "", units);
}

void point_table(std::string& text, const Model& model, std::size_t index, const std::vector<PointRow>& rows,
                 int digits) {
  constexpr int kWidth = 11;
  const Report& report = model.reports[index];
  fmt::format_to(to(text), "  point {:<11}{} ({:.10g}; {:.10g})\n", index + 1, report.name, report.place.x(),
                 report.place.y());
  const bool flow = kind_at_points(model) == ElementKind::flow;
  const FieldTable table = fields_of(model);
  point_headings(text, model,
                 flow ? fields_named(table, {"head", "pressure_head", "velocity"})
                      : fields_named(table, {"displacement", "stress"}),
                 wide(kWidth, digits));
  double length = 0.0, most = 0.0;
  for (const PointRow& r : rows) {
    take_largest(length, r.displacement);
    take_largest(most, r.stress);
  }
  const auto number = [&](double value) {
    const std::string five = cell(value, "{:.5g}", kWidth, digits);
    return digits == 0 && five.front() != ' ' ? cell(value, "{:.3g}", kWidth, digits) : five;
  };
  for (const PointRow& r : chosen(rows)) {
    fmt::format_to(to(text), "    {:<5}{:>5}", r.stage, r.increment);
    if (flow) {
      for (double value : r.flow) text += number(value);
    } else {
      for (double u : r.displacement) text += number(without_rounding(u, length));
      for (double stress : r.stress) text += number(without_rounding(stress, most));
    }
    text += '\n';
  }
}

void discharge_table(std::string& text, const Model& model, std::size_t index,
                     const std::vector<DischargeRow>& rows, int digits) {
  fmt::format_to(to(text), "  discharge {:<5}{:>7}{:>{}}{:>{}}{:>{}}\n", index + 1, "incr",
                 "[" + unit_text(Dimension::discharge, model.units) + "]", wide(18, digits), "gradient",
                 wide(14, digits), "head [" + model.units.length + "]", wide(14, digits));
  for (const DischargeRow& r : chosen(rows))
    fmt::format_to(to(text), "    stage {:<7}{:>7}{}{}{}\n", r.stage, r.increment,
                   cell(r.discharge, "{:.6g}", 18, digits), cell(r.gradient, "{:.5g}", 14, digits),
                   cell(r.head, "{:.5g}", 14, digits));
}

void uplift_table(std::string& text, const Model& model, std::size_t index, const std::vector<UpliftRow>& rows,
                  int digits) {
  fmt::format_to(to(text), "  uplift {:<8}{:>{}}{:>{}}{:>{}}{:>{}}\n", index + 1,
                 "weight [" + model.units.force + "]", wide(18, digits), "water", wide(14, digits), "uplift",
                 wide(12, digits), "heave", wide(12, digits));
  for (const UpliftRow& r : chosen(rows))
    fmt::format_to(to(text), "    stage {:<5}{}{}{}{}\n", r.stage, cell(r.value.weight, "{:.5g}", 18, digits),
                   cell(r.value.water, "{:.5g}", 14, digits), cell(r.value.uplift, "{:.4g}", 12, digits),
                   cell(r.value.heave, "{:.4g}", 12, digits));
}

void section_table(std::string& text, const Model& model, std::size_t index,
                   const std::vector<SectionRow>& rows, int digits) {
  fmt::format_to(to(text), "  section {:<7}{:>7}{:>{}}{:>{}}{:>{}}   {}\n", index + 1, "incr",
                 "axial [" + model.units.force + "]", wide(18, digits), "shear", wide(14, digits),
                 "moment [" + unit_text(Dimension::moment, model.units) + "]", wide(18, digits),
                 model.reports[index].name);
  for (const SectionRow& r : chosen(rows)) {
    const SectionForces& f = r.value;
    const double force =
        std::max({std::abs(f.axial), std::abs(f.shear), f.length > 0.0 ? std::abs(f.moment) / f.length : 0.0});
    fmt::format_to(to(text), "    stage {:<5}{:>7}{}{}{}\n", r.stage, r.increment,
                   cell(without_rounding(f.axial, force), "{:.5g}", 18, digits),
                   cell(without_rounding(f.shear, force), "{:.5g}", 14, digits),
                   cell(without_rounding(f.moment, force * f.length), "{:.5g}", 18, digits));
  }
}

void report_tables(std::string& text, const Model& model, const Reports& reports, int digits) {
  std::size_t shown = 0, points = 0;
  for (std::size_t i = 0; i < reports.count(); ++i) {
    if (!reports.triaxial(i).empty() && shown++ < kReports)
      triaxial_table(text, model, i, reports.triaxial(i), digits);
    for (const std::string& message : reports.messages(i))
      fmt::format_to(to(text), "    warning: report {}: {}\n", i + 1, message);
    if (!reports.nodes(i).empty() && shown++ < kReports) node_table(text, model, i, reports.nodes(i), digits);
    if (!reports.discharges(i).empty() && shown++ < kReports)
      discharge_table(text, model, i, reports.discharges(i), digits);
    if (!reports.uplifts(i).empty() && shown++ < kReports)
      uplift_table(text, model, i, reports.uplifts(i), digits);
    if (!reports.sections(i).empty() && shown++ < kReports)
      section_table(text, model, i, reports.sections(i), digits);
    if (!reports.points(i).empty() && points++ < kPoints)
      point_table(text, model, i, reports.points(i), digits);
  }
}

void status_lines(std::string& text, const Model& model, const RunRecord& record) {
  const RunResult& result = record.result;
  fmt::format_to(to(text), "  status      {}\n", status_words(model, result));
  if (result.status == RunStatus::completed) return;
  if (!model.left_out.empty()) fmt::format_to(to(text), "              PARTIAL: {}\n", left_out_words(model));
  fmt::format_to(
      to(text),
      "              stopped in stage {} of {}, increment {} of {}; last equilibrium at load factor {:.4g} of "
      "the stage\n",
      record.failed.stage + 1, model.stages.size(), record.failed.increment, record.failed.increments,
      record.failed.load_factor);
  if (const std::string beyond = motion_words(model, result.motion); !beyond.empty())
    fmt::format_to(to(text), "              {}\n", beyond);
}

void counts(std::string& text, const Model& model, const RunRecord& record, bool details) {
  RunRecord::StageCount sum;
  for (const auto& stage : record.stages) {
    sum.increments += stage.increments;
    sum.iterations += stage.iterations;
    sum.cuts += stage.cuts;
  }
  const char* geometry = model.geometry == Geometry::axisymmetric ? "axisymmetric" : "plane strain";
  fmt::format_to(to(text), "  model       {}; {} elements, {} equations\n", geometry, record.scene.elements,
                 record.equations);
  if (details)
    fmt::format_to(to(text), "  scene       {}, {}; {} elements, {} points, {} equations\n", geometry,
                   describe(record.scene), record.scene.elements, record.scene.points, record.equations);
  const std::string& kernels = record.result.kernels;
  fmt::format_to(to(text), "  solver      {}{}\n", record.solver,
                 kernels.empty() ? "" : ", kernels " + kernels);
  fmt::format_to(to(text), "  path        {} of {} stages, {} increments, {} iterations, {} cuts\n",
                 record.result.stages_done, model.stages.size(), record.result.increments_done, sum.iterations,
                 sum.cuts);
  fmt::format_to(to(text), "  points      {}\n", point_words(record.points));
}

// What was left out, in one line; nothing if nothing was.
std::string skipped(const WorkCounters& w) {
  std::string parts;
  const auto add = [&](long count, const char* what) {
    if (count > 0) parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", count, what);
  };
  add(w.condensed, "equations condensed");
  add(w.border_steps, "steps by the border of a condensed region");
  add(w.twin_equations, "equations with the factors of others");
  add(w.linear_products, "elements by K u");
  add(w.kept_factors, "solves with kept factors");
  add(w.repeats, "increments repeated");
  return parts.empty() ? "" : "  left out    " + parts + "\n";
}

void work_lines(std::string& text, const RunRecord& record) {
  const WorkCounters& w = record.result.work;
  const auto own = [&](std::string_view phase) { return w.profile.seconds(phase); };
  fmt::format_to(to(text),
                 "  work        {} assemblies and {} force passes {:.3g} s, {} factorisations {:.3g} s, {} "
                 "solves {:.3g} s\n",
                 w.assemblies, w.residuals, own(phase::kAssembly), w.factorisations, own(phase::kFactors),
                 w.solves, own(phase::kSolution));
  fmt::format_to(to(text), "              numbering {:.3g} s, ", own(phase::kNumbering));
  if (w.condensed > 0) fmt::format_to(to(text), "condensation {:.3g} s, ", own(phase::kCondensation));
  fmt::format_to(to(text), "iteration {:.3g} s, start and checks {:.3g} s, output {:.3g} s\n",
                 own(phase::kIteration),
                 own(phase::kStart) + own(phase::kChecks) + record.profile.seconds(phase::kAnalysis),
                 own(phase::kOutput) + own(phase::kCheckpoint));
  if (record.seconds > 0.0)
    fmt::format_to(to(text),
                   "              reading {:.3g} s, model {:.3g} s, files {:.3g} s, whole run {:.3g} s\n",
                   record.profile.seconds(phase::kReading), record.profile.seconds(phase::kModel),
                   record.profile.seconds(phase::kFiles), record.seconds);
  text += skipped(w);
}

void note_lines(std::string& text, const std::string& notes) {
  constexpr std::size_t kShown = 3;
  std::size_t count = 0;
  for (std::size_t at = 0, end = 0; (end = notes.find('\n', at)) != std::string::npos; at = end + 1)
    if (++count <= kShown) fmt::format_to(to(text), "  note        {}\n", notes.substr(at, end - at));
  if (count > kShown) fmt::format_to(to(text), "  {:<12}and {} more (see the listing)\n", "", count - kShown);
}

void file_lines(std::string& text, const std::vector<std::filesystem::path>& files) {
  constexpr std::size_t kShown = 5;
  for (std::size_t i = 0; i < std::min(files.size(), kShown); ++i)
    fmt::format_to(to(text), "  {:<12}{}\n", i == 0 ? "files" : "", files[i].string());
  if (files.size() > kShown) fmt::format_to(to(text), "  {:<12}and {} more\n", "", files.size() - kShown);
}

}  // namespace

void RunRecord::on_warning(const Diagnostic& d) {
  if (d.severity == Severity::warning)
    ++warnings;
  else if (d.code != kDetailNote)
    notes += with_code(d.message, d.code) + "\n";
}

void RunRecord::exchange(Archive& archive) {
  archive(solver);
  archive(equations);
  archive(warnings);
  archive(notes);
  archive(stages);
  archive(points);
  archive(out_of_balance);
  archive(audited);
  strength.exchange(archive);
  pushes.exchange(archive);
  archive(structures);
  envelope.exchange(archive);
}

void RunRecord::on_start(const Model& model, const Scene& scene_found, std::string_view solver_name,
                         int equation_count) {
  scene = scene_found;
  solver = solver_name;
  equations = equation_count;
  warnings += model.diagnostics.warnings();
}

void RunRecord::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  if (report.converged) {
    strength.increment(model, report);
    pushes.increment(model, report, solution);
  }
  stages.resize(std::max(stages.size(), static_cast<std::size_t>(report.stage) + 1));
  StageCount& stage = stages[report.stage];
  ++stage.increments;
  stage.iterations += report.total_iterations;
  stage.cuts += report.cuts;
  points = report.points;
}

void RunRecord::on_stage_end(const Model& model, int stage, const EquilibriumAudit& audit,
                             const Solution& solution) {
  strength.end(model, stage, solution);
  const std::vector<ExtremeRow> now = extremes(model, stage, solution);
  structures.insert(structures.end(), now.begin(), now.end());
  if (!now.empty()) envelope.add(model, stage, solution);
  out_of_balance = std::max(out_of_balance, audit.out_of_balance);
  ++audited;
}

void RunRecord::on_failure(const Model& model, const StepReport& report, const std::string&,
                           const Solution& solution) {
  on_increment(model, report, solution);
  --stages.back().increments;
  failed = report;
  strength.failed(model, report, solution);
}

void RunRecord::on_finish(const Model&, const RunResult& run_result) {
  result = run_result;
}

std::string summary(const Model& model, const RunRecord& record, const Reports* reports,
                    const std::vector<std::filesystem::path>& files, const DiscretisationError* error,
                    int digits, const std::string& sketch, bool details) {
  const UnitSystem& u = model.units;
  std::string text = model.title + "\n";
  status_lines(text, model, record);
  counts(text, model, record, details);
  if (const auto& rows = record.strength.rows(); !rows.empty())
    text += "  strength divided by factors, each an analysis of its own\n" + strength_table(model, rows);
  if (const std::vector<ExtremeRow> all = envelope(record.structures); !all.empty())
    text += fmt::format("  structures  extremes of {}; {}\n",
                        model.stages.size() > 1 ? "all stages, each at its end" : "the stage",
                        structure_forces_per(model)) +
            extremes_table(model, all, model.stages.size() > 1);
  if (reports != nullptr) report_tables(text, model, *reports, digits);
  if (record.result.status == RunStatus::completed) {
    const auto yielded = record.points[static_cast<std::size_t>(PointStatus::yielded)];
    text += record.pushes.text(model, yielded);
  }
  text += sketch;
  if (error != nullptr) text += error->text(model);
  if (record.audited > 0)
    fmt::format_to(to(text), "  equilibrium whole model out of balance by {:.1e} of its largest force\n",
                   record.out_of_balance);
  if (details) work_lines(text, record);
  if (record.warnings > 0) fmt::format_to(to(text), "  warnings    {} (see the listing)\n", record.warnings);
  note_lines(text, record.notes);
  file_lines(text, files);
  fmt::format_to(to(text), "  signs       compression positive; units {}, {}, {}; forces {}\n", u.length,
                 u.force, u.stress,
                 model.geometry == Geometry::axisymmetric ? "for full circle" : forces_per(model));
  if (record.result.status != RunStatus::completed)
    fmt::format_to(
        to(text), "  {}\n",
        "NOT CONVERGED: the results end at the last state in equilibrium; see the listing for the reason");
  return text;
}

}  // namespace sage
