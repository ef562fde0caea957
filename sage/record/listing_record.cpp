// What was done: increments, equilibrium, reports, work.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/analysis/free_surface.hpp"
#include "sage/record/listing_parts.hpp"
#include "sage/record/number.hpp"
#include "sage/record/values.hpp"
#include "sage/record/without_rounding.hpp"

namespace sage::listing {

namespace {

void put(std::string& text, double value, int width, int digits) {
  if (std::isnan(value))
    fmt::format_to(to(text), "{:>{}}", "-", width);
  else
    append_scientific(text, value, width, digits);
}

constexpr const char* kHeldNote =
    "   * the force holds part of what is let go over the stage, borne by no load and no support\n";

bool holds(const NodesRow& row) {
  return row.held[0] != 0.0 || row.held[1] != 0.0;
}

void triaxial_rows(std::string& text, const Model& model, const std::vector<TriaxialRow>& rows) {
  const std::string& stress = model.units.stress;
  fmt::format_to(
      to(text),
      "   measured: force on the report's nodes / {}area.  correct: the law with frictionless ends.\n",
      model.large_strain ? "first " : "");
  fmt::format_to(to(text), "   {:>5}{:>6}{:>12}{:>15}{:>15}{:>15}{:>15}{:>15}{:>10}\n", "stage", "incr",
                 "strain", "force", "meas. deviator", "corr. deviator", "meas. axial", "corr. axial", "ratio");
  fmt::format_to(to(text), "   {:>5}{:>6}{:>12}{:>15}{:>15}{:>15}{:>15}{:>15}{:>10}\n", "", "", "-",
                 model.units.force, stress, stress, stress, stress, "-");
  for (const TriaxialRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    put(text, r.axial_strain, 12, 5);
    for (double v : {r.force, r.measured_deviator, r.correct_deviator, r.measured_axial, r.correct_axial})
      put(text, v, 15, 6);
    fmt::format_to(to(text), "{:>10}\n",
                   (std::isnan(r.ratio) ? std::string("-") : fmt::format("{:.5f}", r.ratio)) +
                       (r.held != 0.0 ? " *" : ""));
  }
  if (std::ranges::any_of(rows, [](const TriaxialRow& r) { return r.held != 0.0; })) text += kHeldNote;
}

void node_rows(std::string& text, const Model& model, const std::vector<NodesRow>& rows) {
  const AxisNames names = axis_names(model.geometry);
  fmt::format_to(
      to(text), "   {:>5}{:>6}{:>14}{:>14}{:>14}{:>14}    (mean displacement {}, sum of forces {})\n", "stage",
      "incr", fmt::format("u-{}", names.x), fmt::format("u-{}", names.y), fmt::format("force-{}", names.x),
      fmt::format("force-{}", names.y), model.units.length, model.units.force);
  if (model.has_pores())
    fmt::format_to(
        to(text),
        "   then: time, mean excess pressure {}, volume {} that has left through the nodes, degree of "
        "consolidation of the model\n",
        model.units.stress, unit_text(Dimension::volume, model.units));
  for (const NodesRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    for (double v : {r.displacement[0], r.displacement[1], r.force[0], r.force[1]}) put(text, v, 14, 6);
    if (model.has_pores())
      for (double v : r.pores) put(text, v, 14, 6);
    text += holds(r) ? " *\n" : "\n";
  }
  if (std::ranges::any_of(rows, holds)) text += kHeldNote;
}

void discharge_rows(std::string& text, const Model& model, const std::vector<DischargeRow>& rows) {
  fmt::format_to(
      to(text),
      "   {:>5}{:>6}{:>14}{:>14}{:>14}{:>14}{:>14}    (discharge {}, from the left of the line to its right; "
      "largest gradient across it; mean head {}; what the water presses with to its right {})\n",
      "stage", "incr", "discharge", "gradient", "head", "fx", "fy",
      unit_text(Dimension::discharge, model.units), model.units.length, model.units.force);
  for (const DischargeRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    for (double v : {r.discharge, r.gradient, r.head, r.force[0], r.force[1]}) put(text, v, 14, 6);
    text += '\n';
  }
}

void uplift_rows(std::string& text, const Model& model, const std::vector<UpliftRow>& rows) {
  fmt::format_to(
      to(text),
      "   {:>5}{:>6}{:>14}{:>14}{:>14}{:>14}    (weight above the line and water on it {}, {}; uplift = weight "
      "/ water; heave = buoyant weight / seepage force)\n",
      "stage", "incr", "weight", "water", "uplift", "heave", model.units.force, forces_per(model));
  for (const UpliftRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    for (double v : {r.value.weight, r.value.water, r.value.uplift, r.value.heave}) put(text, v, 14, 6);
    text += '\n';
  }
}

void section_rows(std::string& text, const Model& model, const std::vector<SectionRow>& rows) {
  const bool ring = model.geometry == Geometry::axisymmetric;
  fmt::format_to(to(text), "   {:>5}{:>6}{:>14}{:>14}{:>16}", "stage", "incr", "axial force", "shear force",
                 "bending moment");
  if (ring) fmt::format_to(to(text), "{:>14}{:>14}", "hoop force", "hoop moment");
  fmt::format_to(
      to(text),
      "{:>14}{:>14}{:>14}{:>14}    ({}, {} per unit of {}; of total stress, compression positive; error: "
      "estimates)\n",
      "length", "axial error", "shear error", "moment error", model.units.force,
      unit_text(Dimension::moment, model.units), ring ? "circumference at the middle of the cut" : "thickness");
  for (const SectionRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    put(text, r.value.axial, 14, 6);
    put(text, r.value.shear, 14, 6);
    put(text, r.value.moment, 16, 6);
    if (ring) put(text, r.value.hoop, 14, 6);
    if (ring) put(text, r.value.hoop_moment, 14, 6);
    put(text, r.value.length, 14, 6);
    for (const double error : r.value.error) put(text, error, 14, 3);
    text += '\n';
  }
}

void flow_point_rows(std::string& text, const Model& model, const std::vector<PointRow>& rows) {
  fmt::format_to(to(text), "   stage  incr{:>14}{:>14}{:>14}{:>14}    (heads {}, velocity {})\n", "head",
                 "pressure head", "velocity-x", "velocity-y", model.units.length,
                 unit_text(Dimension::velocity, model.units));
  for (const PointRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    for (double v : r.flow) put(text, v, 14, 6);
    text += '\n';
  }
}

void point_rows(std::string& text, const Model& model, const std::vector<PointRow>& rows) {
  if (kind_at_points(model) == ElementKind::flow) return flow_point_rows(text, model, rows);
  text += "   stage  incr";
  const FieldTable table;
  for (const FieldEntry* field : fields_named(table, {"displacement", "strain", "stress"}))
    for (std::size_t c = 0; c < field->size(); ++c)
      fmt::format_to(to(text), "{:>14}", field->label(c, model.geometry));
  fmt::format_to(to(text), "    (displacement {}, stress {})\n", model.units.length, model.units.stress);
  for (const PointRow& r : rows) {
    fmt::format_to(to(text), "   {:>5}{:>6}", r.stage, r.increment);
    for (double v : r.displacement) put(text, v, 14, 6);
    for (double v : r.strain) put(text, v, 14, 6);
    for (double v : r.stress) put(text, v, 14, 6);
    text += '\n';
  }
}

}  // namespace

void free_surface(std::string& text, const Model& model, const Solution& solution) {
  constexpr std::size_t kAcross = 4;
  if (std::ranges::none_of(solution.groups(), has_free_surface)) return;
  const std::vector<Vector2> places = sage::free_surface(model, solution.activity->group, solution.groups(),
                                                         solution.activity->dof_map, *solution.u);
  const AxisNames names = axis_names(model.geometry);
  fmt::format_to(to(text), "\n   Free surface, where pressure 0 crosses edges of elements: {}, {} [{}]\n",
                 names.x, names.y, model.units.length);
  if (places.empty()) text += "   none: all soil is wet, or all is dry\n";
  for (std::size_t i = 0; i < places.size(); ++i)
    fmt::format_to(to(text), "{}{:11.5g}{:11.5g}{}", i % kAcross == 0 ? " " : "   ", places[i].x(),
                   places[i].y(), i % kAcross == kAcross - 1 || i + 1 == places.size() ? "\n" : "");
}

void increment_columns(std::string& text) {
  text +=
      "\n    incr  load factor  iter  rel. force  rel. displ  rel. energy  cuts  yielded slipping     open     "
      "apex  cut off\n";
}

void increment(std::string& text, const StepReport& report) {
  const IterationRecord last = report.iterations.empty() ? IterationRecord{} : report.iterations.back();
  append_integer(text, report.increment, 8);
  append_scientific(text, report.load_factor, 13, 6);
  append_integer(text, report.total_iterations, 6);
  append_scientific(text, last.force, 12, 3);
  append_scientific(text, last.displacement, 12, 3);
  append_scientific(text, last.energy, 13, 3);
  append_integer(text, report.cuts, 6);
  for (PointStatus s : kAtStrength) append_integer(text, report.points[static_cast<std::size_t>(s)], 9);
  text += report.converged ? "\n" : "   NOT CONVERGED\n";
}

// Models of water alone have no forces.
void force_sums(std::string& text, const Model& model, const EquilibriumAudit& audit) {
  const AxisNames names = axis_names(model.geometry);
  const double scale = std::max({std::abs(audit.applied[0]), std::abs(audit.applied[1]),
                                 std::abs(audit.reactions[0]), std::abs(audit.reactions[1])});
  for (int c = 0; c < 2; ++c) {
    fmt::format_to(to(text), "   {:>12}", c == 0 ? names.x : names.y);
    for (double v : {audit.applied[c], audit.reactions[c], audit.applied[c] + audit.reactions[c]})
      put(text, without_rounding(v, scale), 16, 8);
    text += c == 0 && model.geometry == Geometry::axisymmetric
                ? "   (radial forces of a ring need no sum of zero)\n"
                : "\n";
  }
  if (model.geometry == Geometry::plane_strain)
    fmt::format_to(to(text), "   {:>12}{:>48.3E}   (about the origin)\n", "moment",
                   without_rounding(audit.moment, audit.scale));
}

void audit(std::string& text, const Model& model, const EquilibriumAudit& audit) {
  const bool has_forces = audit.scale > 0.0 || audit.fields.empty();
  fmt::format_to(to(text), "\n   Equilibrium of the whole model ({}{})\n   {:>12}{:>16}{:>16}{:>16}\n",
                 has_forces ? model.units.force + ", " : "", forces_per(model), "", "applied", "reactions",
                 "sum");
  if (has_forces) force_sums(text, model, audit);
  for (std::size_t i = 0; i < audit.fields.size(); ++i) {
    const UnknownField& field = model.unknowns[i + 1];
    const FieldAudit& sums = audit.fields[i];
    if (sums.applied == 0.0 && sums.reactions == 0.0) continue;
    fmt::format_to(to(text), "   {:>12}", field.load);
    for (double v : {sums.applied, sums.reactions, sums.applied + sums.reactions})
      put(text, without_rounding(v, sums.scale), 16, 8);
    fmt::format_to(to(text), "   ({}{})\n", field.name,
                   field.balanced ? "" : "; elements keep or make some, it needs no sum of zero");
  }
  fmt::format_to(to(text), "   largest out of balance / force scale: {:.2e}\n", audit.out_of_balance);
}

void report_rows(std::string& text, const Model& model, const Reports& reports) {
  for (std::size_t i = 0; i < reports.count(); ++i) {
    const Report& report = model.reports[i];
    switch (report.kind) {
      case ReportKind::triaxial:
        heading(text, fmt::format("REPORT {}: TRIAXIAL TEST (COMPRESSION POSITIVE)", i + 1));
        triaxial_rows(text, model, reports.triaxial(i));
        for (const std::string& message : reports.messages(i)) text += "   warning: " + message + "\n";
        break;
      case ReportKind::nodes:
        heading(text, fmt::format("REPORT {}: NODES", i + 1));
        node_rows(text, model, reports.nodes(i));
        break;
      case ReportKind::discharge:
        heading(text, fmt::format("REPORT {}: DISCHARGE", i + 1));
        discharge_rows(text, model, reports.discharges(i));
        break;
      case ReportKind::uplift:
        heading(text, fmt::format("REPORT {}: UPLIFT AND HYDRAULIC HEAVE", i + 1));
        uplift_rows(text, model, reports.uplifts(i));
        break;
      case ReportKind::section:
        heading(text, fmt::format("REPORT {}: SECTION {}({:.10g}; {:.10g}) TO ({:.10g}; {:.10g})", i + 1,
                                  report.name.empty() ? "" : report.name + " ", report.place.x(),
                                  report.place.y(), report.end.x(), report.end.y()));
        section_rows(text, model, reports.sections(i));
        break;
      case ReportKind::point:
        heading(text,
                fmt::format("REPORT {}: POINT {}({:.10g}; {:.10g})", i + 1,
                            report.name.empty() ? "" : report.name + " ", report.place.x(), report.place.y()));
        point_rows(text, model, reports.points(i));
        break;
    }
  }
}

void work(std::string& text, const RunResult& result) {
  const WorkCounters& w = result.work;
  heading(text, "WORK");
  fmt::format_to(to(text), "   stages done {}, increments done {}\n", result.stages_done,
                 result.increments_done);
  fmt::format_to(
      to(text),
      "   stiffness assemblies {}, force-only passes {}, element evaluations {}, linear products {}\n",
      w.assemblies, w.residuals, w.element_evaluations, w.linear_products);
  fmt::format_to(to(text), "   patterns analysed {}, factorisations {}, solves {}\n", w.analyses,
                 w.factorisations, w.solves);
}

}  // namespace sage::listing
