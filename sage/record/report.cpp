#include "sage/record/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "sage/analysis/external_loads.hpp"
#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/pore_steps.hpp"
#include "sage/math/rounding.hpp"
#include "sage/record/nodal_values.hpp"
#include "sage/record/number.hpp"
#include "sage/record/output.hpp"
#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kSubsteps = 10;  // of the law, an increment

// What the weight of the soil puts on the report's nodes: what acts at the start of a stage stays, what is
// born or added in it grows.
struct Weights {
  Eigen::VectorXd start, end;

  Weights(const Model& model, int stage) {
    Activity activity(model);
    Vector2 gravity = Vector2::Zero();
    for (int s = 0; s < stage; ++s) {
      activity.enter(model.stages[s]);
      gravity += model.stages[s].gravity;
    }
    std::vector<char> both = activity.group;
    activity.enter(model.stages[stage]);
    for (std::size_t g = 0; g < both.size(); ++g) both[g] = both[g] && activity.group[g];
    start = weight_of(model, both, gravity, std::max(0, stage - 1));
    end = weight_of(model, activity.group, gravity + model.stages[stage].gravity, stage);
  }
};

// Forces on the report's nodes that nothing bears when a stage starts: they are held, and let go over the
// stage. What equilibrium leaves at free nodes is not meant.
std::array<double, 2> released_forces(const Model& model, const Report& report, const Solution& start) {
  constexpr double kNoticed = 1e-4;  // of the model's largest force
  const std::vector<char> active = active_nodes(model, *start.activity);
  std::array<double, 2> sum{0.0, 0.0};
  for (int node : report.nodes)
    for (int c = 0; c < 2; ++c) {
      const int dof = DofMap::displacement(node, c);
      if (active[node] && !start.activity->is_constrained(dof))
        sum[c] += (*start.internal)[dof] - (*start.external)[dof];
    }
  const double largest = start.internal->size() > 0 ? start.internal->lpNorm<Eigen::Infinity>() : 0.0;
  for (double& s : sum)
    if (std::abs(s) <= kNoticed * largest) s = 0.0;
  return sum;
}

const SolidLaw* specimen_law(const Model& model, const Report& report) {
  if (report.group < 0) return nullptr;
  const LawRef law = model.material_of(model.groups[report.group]).law_ref();
  const auto* solid = std::get_if<const SolidLaw*>(&law);
  return solid != nullptr ? *solid : nullptr;
}

// What stands in the comment lines above the columns.
std::string remarks(const Model& model, std::size_t index) {
  const Report& report = model.reports[index];
  const UnitSystem& u = model.units;
  const std::string per = forces_per(model);
  if (report.kind == ReportKind::triaxial)
    return fmt::format(
        "# triaxial report; compression positive; strain and deviator count from the start of stage {0}; units "
        "{1}, {2}, {3}; forces {4}\n"
        "# correct: one point of the law, frictionless ends; ratio = measured / correct deviator\n{5}",
        report.stage + 1, u.length, u.force, u.stress, per,
        model.large_strain ? "# large strain: nominal deviators, by the first area; *_corrected by that of a "
                             "cylinder of the same "
                             "length with the volume of the correct test\n"
                           : "");
  if (report.kind == ReportKind::nodes)
    return fmt::format(
        "# node report: mean displacement since the start of stage {}, sum of the forces that loads and "
        "supports "
        "put on the nodes, without the weight of the soil; positive along +x, +y; forces {}\n{}",
        report.stage + 1, per,
        model.has_pores()
            ? "# excess_pressure: mean of the nodes; outflow: volume that has left through them; degree: "
              "of consolidation, of the whole model\n"
            : "");
  if (report.kind == ReportKind::discharge)
    return fmt::format(
        "# discharge through a line of nodes, from its left to its right; volumes per time {}\n"
        "# gradient: largest fall of the head across the line at its nodes; head: mean of its nodes\n"
        "# fx, fy: what the water presses with from the left of the line on what lies to its right\n",
        per);
  if (report.kind == ReportKind::uplift)
    return fmt::format(
        "# uplift on a line of nodes, at the end of each stage; forces {}\n"
        "# weight: soil and free water above the line; water: pore pressure on it; uplift = weight / water\n"
        "# heave = (weight - water at rest) / (water - water at rest): buoyant weight over seepage force; "
        "blank without "
        "flow upwards\n",
        per);
  if (report.kind == ReportKind::section)
    return fmt::format(
        "# {}; forces of total stress {}\n"
        "# axial_force compression positive; bending_moment about the middle of the cut, positive with tension "
        "at its "
        "first "
        "end; shear_force positive where the right of the cut pushes towards its second end\n"
        "# length of the cut in active solids, blank forces without any; *_error: by another smoothing of the "
        "stress less the value, an estimate\n",
        report_title(model, index),
        model.geometry == Geometry::axisymmetric ? "per unit of circumference at the middle of the cut"
                                                 : "per unit of thickness");
  if (kind_at_points(model) == ElementKind::flow)
    return fmt::format(
        "# {}; head, pressure head and velocity of the water; units {}\n# blank while nothing is active "
        "there\n",
        report_title(model, index), u.length);
  return fmt::format(
      "# {}; displacement along +x, +y and strain since the start of stage {}; stress and strain compression "
      "positive, shear likewise reversed and engineering; units {}, {}\n"
      "# mean_stress = (xx + yy + zz) / 3, deviator = sqrt(3 J2); blank while nothing is active there\n{}{}",
      report_title(model, index), report.stage + 1, u.length, u.stress,
      model.large_strain ? fmt::format("# large strain: {}\n", kLargeStrainWords) : std::string(),
      model.geometry == Geometry::axisymmetric ? "# x = r, y = z, zz = hoop\n" : "");
}

std::string header(const Model& model, std::size_t index) {
  std::string text = "# " + model.title + "\n" + remarks(model, index) + "stage,increment";
  for (const ReportColumn& column : report_columns(model, model.reports[index]))
    text += fmt::format(",{}[{}]", column.name, column.unit);
  return text + "\n";
}

}  // namespace

struct Reports::NodeSums {
  // Mean over the deck's own nodes, so that it keeps its meaning in finer meshes.
  double displacement[2] = {0, 0};
  double force[2] = {0, 0};  // sum of internal forces, less the weight
  double extent = 0.0;       // of the nodes where they are now: pi r_max^2, or the width in plane strain
};

namespace {

std::vector<ReportColumn> section_columns(const Model& model) {
  const std::string force = model.units.force, moment = unit_text(Dimension::moment, model.units);
  std::vector<ReportColumn> columns{
      {"axial_force", force, true}, {"shear_force", force, true}, {"bending_moment", moment, true}};
  if (model.geometry == Geometry::axisymmetric)
    columns.insert(columns.end(), {{"hoop_force", force, true}, {"hoop_moment", moment, true}});
  columns.insert(columns.end(), {{"length", model.units.length},
                                 {"axial_force_error", force, true},
                                 {"shear_force_error", force, true},
                                 {"bending_moment_error", moment, true}});
  return columns;
}

std::vector<double> section_values(const Model& model, const SectionForces& r) {
  std::vector<double> values{r.axial, r.shear, r.moment};
  if (model.geometry == Geometry::axisymmetric) values.insert(values.end(), {r.hoop, r.hoop_moment});
  values.insert(values.end(), {r.length, r.error[0], r.error[1], r.error[2]});
  return values;
}

}  // namespace

std::vector<ReportColumn> report_columns(const Model& model, const Report& report) {
  const UnitSystem& u = model.units;
  if (report.kind == ReportKind::triaxial) {
    std::vector<ReportColumn> columns{{"axial_strain", "-"},
                                      {"force", u.force},
                                      {"measured_deviator", u.stress},
                                      {"correct_deviator", u.stress, true},
                                      {"measured_axial", u.stress},
                                      {"correct_axial", u.stress, true},
                                      {"ratio", "-", true}};
    if (model.large_strain)
      columns.insert(columns.end(),
                     {{"measured_corrected", u.stress, true}, {"correct_corrected", u.stress, true}});
    return columns;
  }
  if (report.kind == ReportKind::nodes) {
    std::vector<ReportColumn> columns{{"ux", u.length}, {"uy", u.length}, {"fx", u.force}, {"fy", u.force}};
    if (model.has_pores())
      columns.insert(columns.end(), {{"time", "-"},
                                     {"excess_pressure", u.stress, true},
                                     {"outflow", unit_text(Dimension::volume, u), true},
                                     {"degree", "-", true}});
    return columns;
  }
  if (report.kind == ReportKind::discharge)
    return {{"discharge", unit_text(Dimension::discharge, u), true},
            {"gradient", "-", true},
            {"head", u.length, true},
            {"fx", u.force, true},
            {"fy", u.force, true}};
  if (report.kind == ReportKind::uplift)
    return {{"weight", u.force}, {"water", u.force}, {"uplift", "-", true}, {"heave", "-", true}};
  if (report.kind == ReportKind::section) return section_columns(model);
  const FieldTable table = fields_of(model);
  std::vector<ReportColumn> columns;
  for (const FieldEntry* field : point_report_fields(model, table, report))
    for (std::size_t c = 0; c < field->size(); ++c)
      columns.push_back({field->column(c), unit_text(field->dimension, u), true});
  return columns;
}

FieldList point_report_fields(const Model& model, const FieldTable& table, const Report& report) {
  if (kind_at_points(model) == ElementKind::flow)
    return fields_at_places(table, {"head", "pressure_head", "velocity"}, report.fields);
  return fields_at_places(table, {"displacement", "strain", "stress", "mean_stress", "deviator"},
                          report.fields);
}

std::string report_title(const Model& model, std::size_t index) {
  const Report& report = model.reports[index];
  std::string text = fmt::format("report {}", index + 1);
  if (report.kind == ReportKind::point)
    text += fmt::format(", {} at ({:.10g}; {:.10g})", report.name.empty() ? "point" : report.name,
                        report.place.x(), report.place.y());
  if (report.kind == ReportKind::section)
    text += fmt::format(", {} from ({:.10g}; {:.10g}) to ({:.10g}; {:.10g})",
                        report.name.empty() ? "cut" : report.name, report.place.x(), report.place.y(),
                        report.end.x(), report.end.y());
  return text;
}

namespace {

// The values of the first point, where those of all others differ by no more than `share` of the largest of all.
std::vector<double> value_of_all(const std::vector<double>& values, std::size_t size, double share) {
  if (size == 0 || values.size() < size) return {};
  double largest = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    largest = std::max(largest, std::abs(values[i]));
    apart = std::max(apart, std::abs(values[i] - values[i % size]));
  }
  if (!(apart <= share * largest)) return {};
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace

SpecimenStart start_of_specimen(const Model& model, const Report& report, const Solution& solution) {
  constexpr double kAlike = 1e-6;
  SpecimenStart start;
  const std::span<const GroupData> groups = solution.groups();
  const auto at = static_cast<std::size_t>(report.group);
  if (report.group < 0 || at >= groups.size()) return start;
  if (!model.large_strain && has_constant_stiffness(groups[at].law)) return start;
  const StateStore& state = groups[at].state;
  if (state.law_size() != 4) return start;
  const auto history = static_cast<std::size_t>(state.history_size());
  const std::size_t of_law = history_of(groups[at].law).size();
  std::vector<double> of_laws;  // without what the elements remember, which comes last
  for (std::size_t first = 0; first < state.committed.h.size(); first += history)
    of_laws.insert(of_laws.end(), state.committed.h.begin() + static_cast<std::ptrdiff_t>(first),
                   state.committed.h.begin() + static_cast<std::ptrdiff_t>(first + of_law));
  start.history = value_of_all(of_laws, of_law, kAlike);
  if (start.history.empty() && of_law > 0)
    start.note =
        "history differs between the points of the specimen; the correct test starts from the law's own";
  start.sigma = value_of_all(state.committed.sigma, 4, kAlike);
  if (start.sigma.empty()) return start;
  const double off = kAlike * std::max(std::abs(report.cell_pressure), 1e-300);
  const bool ring = model.geometry == Geometry::axisymmetric;
  const auto held = [&](std::size_t i) { return std::abs(start.sigma[i] + report.cell_pressure) <= off; };
  if (held(0) && (!ring || held(2))) return start;
  // Under large strain the lateral stress counts: the test keeps that of the specimen.
  if (model.large_strain)
    start.note =
        "the lateral stress of the specimen is not the report's cell pressure; the correct test keeps the "
        "specimen's";
  else
    start.sigma.clear();
  return start;
}

CorrectTest::CorrectTest(const SolidLaw& law, Geometry geometry, double cell_pressure,
                         const SpecimenStart& start, bool large_strain)
    : geometry_(geometry),
      large_strain_(large_strain),
      start_(-cell_pressure, -cell_pressure, -cell_pressure, 0.0) {
  if (!start.sigma.empty()) start_ = Eigen::Map<const Vector4>(start.sigma.data());
  try {
    driver_ = std::make_unique<PointDriver<4>>(law, start_, start.history);
  } catch (const AnalysisError& error) {
    failure_ = error.what();
  }
}

namespace {

std::array<Control, 4> controls(Geometry geometry) {
  const bool ring = geometry == Geometry::axisymmetric;
  return {Control::stress, Control::strain, ring ? Control::stress : Control::strain, Control::strain};
}

}  // namespace

void CorrectTest::shorten(double axial_strain, double duration) {
  const double part = -(axial_strain - axial_strain_) / kSubsteps;
  const Vector4 step(start_[0], part, geometry_ == Geometry::axisymmetric ? start_[2] : 0.0, 0.0);
  for (int i = 0; i < kSubsteps; ++i) driver_->advance(controls(geometry_), step, duration / kSubsteps);
}

// By logarithmic strains and Kirchhoff stresses: the lateral ones are the cell pressure times the change of volume, which
// is that of the last part; parts without axial strain make up for that.
void CorrectTest::shorten_much(double axial_strain, double duration) {
  constexpr int kAgain = 40;
  constexpr double kSame = rounding::kResult;
  const double part = (std::log1p(-axial_strain) - std::log1p(-axial_strain_)) / kSubsteps;
  const auto advance = [&](double strain, double time) {
    const double volume = std::exp(driver_->eps().head<3>().sum());
    const Vector4 step(start_[0] * volume, strain,
                       geometry_ == Geometry::axisymmetric ? start_[2] * volume : 0.0, 0.0);
    driver_->advance(controls(geometry_), step, time);
    return std::abs(std::exp(driver_->eps().head<3>().sum()) / volume - 1.0);
  };
  for (int i = 0; i < kSubsteps; ++i) {
    advance(part, duration / kSubsteps);
    if (start_[0] == 0.0) continue;
    for (int n = 0; n < kAgain && advance(0.0, 0.0) > kSame;) ++n;
  }
}

double CorrectTest::deviator_at(double axial_strain, double duration) {
  if (!driver_) return kUnknown;
  try {
    if (large_strain_)
      shorten_much(axial_strain, duration);
    else
      shorten(axial_strain, duration);
  } catch (const AnalysisError& error) {
    driver_.reset();
    failure_ = error.what();
    return kUnknown;
  }
  axial_strain_ = axial_strain;
  if (!large_strain_) return outward(driver_->sigma()[1]) - outward(start_[1]);
  // Kirchhoff stress over the volume ratio is Cauchy stress.
  return outward(driver_->sigma()[1] / (1.0 - axial_strain) - start_[1] * area_ratio());
}

double CorrectTest::area_ratio() const {
  if (!large_strain_) return 1.0;
  return driver_ ? std::exp(driver_->eps().head<3>().sum()) / (1.0 - axial_strain_) : kUnknown;
}

namespace {

double extent_of(const Model& model, const Report& report, const Solution& solution) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const int node : report.nodes) {
    const double x = model.mesh.x(0, node) + (*solution.u)[DofMap::displacement(node, 0)];
    least = std::min(least, x);
    most = std::max(most, x);
  }
  return model.geometry == Geometry::axisymmetric ? kPi * most * most : most - least;
}

}  // namespace

// weight: at the start and the end of the stage, of which load_factor has passed.
Reports::NodeSums Reports::sum_nodes(const Model& model, const Report& report, const Solution& solution,
                                     const double (&weight)[2][2], double load_factor) {
  NodeSums sums;
  for (int c = 0; c < 2; ++c) sums.force[c] = -(1.0 - load_factor) * weight[0][c] - load_factor * weight[1][c];
  int own = 0;
  for (int node : report.nodes) {
    const bool of_deck = node < model.mesh.deck_nodes;
    own += of_deck ? 1 : 0;
    for (int c = 0; c < 2; ++c) {
      if (of_deck) sums.displacement[c] += (*solution.u)[DofMap::displacement(node, c)];
      sums.force[c] += (*solution.internal)[DofMap::displacement(node, c)];
    }
  }
  for (double& d : sums.displacement) d /= std::max(own, 1);
  if (model.large_strain) sums.extent = extent_of(model, report, solution);
  return sums;
}

void Reports::on_start(const Model& model, const Scene&, std::string_view, int) {
  model_ = &model;
  fields_ = fields_of(model);
  for (std::size_t i = 0; i < model.reports.size(); ++i) {
    Series series;
    if (to_files_) {
      series.file = OutFile(folder_ / (stem_ + ".report" + std::to_string(i + 1) + ".csv"));
      series.file.text() = header(model, i);
    }
    if (model.reports[i].kind == ReportKind::point) {
      series.fields = point_report_fields(model, fields_, model.reports[i]);
      series.of_flow = kind_at_points(model) == ElementKind::flow;
      series.start.assign(size_of(series.fields), 0.0);
    }
    series_.push_back(std::move(series));
    columns_.push_back(report_columns(model, model.reports[i]));
  }
}

bool Reports::wants_states(const Model& model, const StepReport&) const {
  return std::any_of(model.reports.begin(), model.reports.end(), [](const Report& r) {
    return r.kind == ReportKind::point || r.kind == ReportKind::discharge || r.kind == ReportKind::section;
  });
}

bool Reports::wants_nodes(const Model& model, const StepReport& step, std::span<const char> behind) const {
  return std::ranges::any_of(model.reports, [&](const Report& report) {
    return report.stage <= step.stage &&
           std::ranges::any_of(report.nodes, [&](int node) { return behind[node] != 0; });
  });
}

void Reports::on_stage_start(const Model& model, int stage, const Solution& solution) {
  if (series_.empty()) return;
  enter_points(model, solution);
  if (model.stages[stage].pores == PoreWater::flows) first_pressure_ = std::abs(pressure_);
  const Weights weights(model, stage);
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Series& series = series_[i];
    const Report& report = model.reports[i];
    series.last_load_factor = 0.0;
    std::ranges::copy(released_forces(model, report, solution), series.released);
    series.release_noted = false;
    for (int c = 0; c < 2; ++c) {
      series.weight[0][c] = series.weight[1][c] = 0.0;
      for (int node : report.nodes) {
        series.weight[0][c] += weights.start[DofMap::displacement(node, c)];
        series.weight[1][c] += weights.end[DofMap::displacement(node, c)];
      }
    }
    if (model.stages[stage].resets_displacements) forget_displacements(series, report, stage);
    if (stage >= report.stage) count_from_here(series, model, solution);
    if (series.begun || stage < report.stage) continue;
    series.begun = true;
    const NodeSums sums = sum_nodes(model, report, solution, series.weight, 0.0);
    std::copy(sums.displacement, sums.displacement + 2, series.start_displacement);
    series.start_force = -sums.force[1];
    series.start_extent = sums.extent;
    if (report.kind == ReportKind::triaxial) {
      series.specimen = start_of_specimen(model, report, solution);
      if (model.large_strain && solution.u->cwiseAbs().maxCoeff() > 1e-9 * report.height)
        series.specimen.note =
            "large strain: the correct test takes the mesh for the shape at the start of the report, which has "
            "moved before; its values differ by that strain";
      if (!series.specimen.note.empty()) add_message(series, series.specimen.note, "S531");
    }
    begin(series, model, report);
  }
}

// The stage sets the displacements to zero.  The strain of a specimen goes on.
void Reports::forget_displacements(Series& series, const Report& report, int stage) {
  if (!series.begun && !series.filled) return;
  for (double& start : series.start_displacement) start = 0.0;
  if (!series.triaxial.empty())
    series.start_displacement[1] = series.triaxial.back().axial_strain * report.height;
  std::size_t at = 0;
  for (const FieldEntry* field : series.fields)
    for (std::size_t c = 0; c < field->size(); ++c, ++at)
      if (field->from_start && field->place() == FieldPlace::node) series.start[at] = 0.0;
  if (report.kind == ReportKind::nodes || report.kind == ReportKind::point)
    series.file.text() +=
        fmt::format("# displacements count from the start of stage {} from here on\n", stage + 1);
}

void Reports::begin(Series& series, const Model& model, const Report& report) {
  if (report.kind != ReportKind::triaxial) return;
  series.area = report_area(model, report);
  if (const SolidLaw* law = specimen_law(model, report))
    series.correct = std::make_unique<CorrectTest>(*law, model.geometry, report.cell_pressure, series.specimen,
                                                   model.large_strain);
}

// Once, in front of the first row whose correct deviator is not known.
void Reports::note_blank(Series& series, const TriaxialRow& row) {
  if (!series.correct || series.correct->failure().empty() || !std::isnan(row.correct_deviator)) return;
  if (!series.triaxial.empty() && std::isnan(series.triaxial.back().correct_deviator)) return;
  add_message(
      series,
      fmt::format("correct values and ratio are blank from stage {}, increment {} on (axial strain {:.6g}): {}",
                  row.stage, row.increment, row.axial_strain, series.correct->failure()),
      "S530");
}

void Reports::add_message(Series& series, const std::string& words, Code code) {
  series.messages.push_back(with_code(one_line(words), code));
  series.file.text() += "# " + series.messages.back() + "\n";
}

// Once a stage, in front of the first row that is concerned.
void Reports::note_release(Series& series, const Model& model, const StepReport& step) {
  const bool any = series.released[0] != 0.0 || series.released[1] != 0.0;
  if (!any || series.release_noted || step.load_factor >= 1.0) return;
  series.release_noted = true;
  series.file.text() += fmt::format(
      "# stage {}: forces on these nodes that nothing bears (fx {:.6g}, fy {:.6g} {} at its start) are let go "
      "over "
      "the stage; rows before its end hold (1 - load factor) of them\n",
      step.stage + 1, series.released[0], series.released[1], model.units.force);
}

// What the places of points need, for the groups that are active now.
void Reports::enter_points(const Model& model, const Solution& solution) {
  if (probed_ == solution.activity->group) return;
  probed_ = solution.activity->group;
  std::optional<ProbeMaker> maker;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const Report& report = model.reports[i];
    if (report.kind == ReportKind::discharge) series_[i].line = flow_line(model, probed_, report.nodes);
    if (report.kind != ReportKind::point && report.kind != ReportKind::section) continue;
    if (!maker) maker.emplace(model, probed_, kind_at_points(model));
    if (report.kind == ReportKind::section)
      series_[i].section = SectionSum(model, report, probed_, *maker);
    else
      series_[i].probe = maker->at(report.place, report.group);
  }
}

// What lives at nodes counts from the first time that something is there, what lives at points from the time of
// the group that is.
void Reports::count_from_here(Series& series, const Model& model, const Solution& solution) {
  if (!series.probe.active() || (series.filled && series.group == series.probe.group)) return;
  const Sample now = sample_of(model, series.probe, solution, series.fields);
  std::size_t at = 0;
  for (const FieldEntry* field : series.fields)
    for (std::size_t c = 0; c < field->size(); ++c, ++at)
      if (field->from_start && (field->place() == FieldPlace::point || !series.filled))
        series.start[at] = now.values[at];
  series.group = series.probe.group;
  series.filled = true;
}

void Reports::add_triaxial(Series& series, std::size_t index, const StepReport& step, const NodeSums& sums) {
  const Report& report = model_->reports[index];
  TriaxialRow r;
  r.stage = step.stage + 1;
  r.increment = step.increment;
  r.axial_strain = -(sums.displacement[1] - series.start_displacement[1]) / report.height;
  r.force = -sums.force[1];
  const bool grows = model_->large_strain && series.start_extent > 0.0;
  const double growth = grows ? sums.extent / series.start_extent : 1.0;
  r.measured_deviator = (r.force - series.start_force * growth) / series.area;
  const double before =
      step.started_at >= 0.0 ? step.started_at : static_cast<double>(step.increment - 1) / step.increments;
  r.duration = (step.load_factor - before) * model_->stages[step.stage].duration;
  r.correct_deviator = series.correct ? series.correct->deviator_at(r.axial_strain, r.duration) : kUnknown;
  r.measured_axial = report.cell_pressure + r.measured_deviator;
  r.correct_axial = report.cell_pressure + r.correct_deviator;
  r.ratio = r.correct_deviator != 0.0 ? r.measured_deviator / r.correct_deviator : kUnknown;
  if (!std::isfinite(r.ratio)) r.ratio = kUnknown;  // of a correct deviator that is next to nothing
  const double area_ratio = series.correct ? series.correct->area_ratio() : kUnknown;
  r.measured_corrected = r.measured_deviator / area_ratio;
  r.correct_corrected = r.correct_deviator / area_ratio;
  r.held = -(1.0 - step.load_factor) * series.released[1];
  note_blank(series, r);
  series.triaxial.push_back(r);
}

void Reports::add_nodes(Series& series, const Report& report, const StepReport& step, const NodeSums& sums,
                        const Solution& solution) {
  NodesRow r{step.stage + 1, step.increment, {}, {}, {}};
  for (int c = 0; c < 2; ++c) {
    r.displacement[c] = sums.displacement[c] - series.start_displacement[c];
    r.force[c] = sums.force[c];
    r.held[c] = (1.0 - step.load_factor) * series.released[c];
  }
  if (model_->has_pores()) {
    const Activity& activity = *solution.activity;
    double time = 0.0, pressure = 0.0, left = 0.0;
    int count = 0, held = 0;
    for (int s = 0; s <= step.stage; ++s)
      time += model_->stages[s].duration * (s == step.stage ? step.load_factor : 1.0);
    time -= step.early;
    for (const int node : report.nodes) {
      const int dof = activity.dof_map.of(node, model_->pore_field());
      if (dof < 0) continue;
      ++count;
      pressure += (*solution.u)[dof];
      if (!activity.held[dof]) continue;
      ++held;
      left += (*solution.internal)[dof] - (*solution.external)[dof];
    }
    r.pores[0] = time;
    r.pores[1] = count > 0 ? pressure / count : kUnknown;
    r.pores[2] = held > 0 ? left : kUnknown;
    r.pores[3] = first_pressure_ != 0.0 ? 1.0 - std::abs(pressure_) / first_pressure_ : kUnknown;
  }
  series.nodes.push_back(r);
}

void Reports::add_point(Series& series, const Model& model, const StepReport& step, const Solution& solution) {
  std::vector<double> v = sample_of(model, series.probe, solution, series.fields).values;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] -= series.start[i];
  PointRow r;
  r.stage = step.stage + 1;
  r.increment = step.increment;
  const double* at = v.data();
  if (series.of_flow) {
    for (double& number : r.flow) number = *at++;
  } else {
    for (double& displacement : r.displacement) displacement = *at++;
    for (double& strain : r.strain) strain = *at++;
    for (double& stress : r.stress) stress = *at++;
    r.mean = *at++;
    r.deviator = *at++;
  }
  series.more.insert(series.more.end(), v.begin() + (at - v.data()), v.end());
  series.points.push_back(r);
}

void Reports::add_discharge(Series& series, const Model& model, const Report& report, const StepReport& step,
                            const Solution& solution) {
  DischargeRow r{step.stage + 1, step.increment, kUnknown, kUnknown, kUnknown, {kUnknown, kUnknown}};
  if (series.line.fault.empty()) {
    const FlowThrough through =
        flow_through(model, series.line, report.nodes, solution.groups(), *solution.activity, *solution.u);
    r.discharge = through.discharge;
    r.gradient = through.gradient;
    r.head = through.head;
    for (int i = 0; i < 2; ++i) r.force[i] = through.force[i];
  }
  series.discharges.push_back(r);
}

std::size_t Reports::rows(std::size_t index) const {
  const Series& series = series_[index];
  return series.triaxial.size() + series.nodes.size() + series.points.size() + series.discharges.size() +
         series.uplifts.size() + series.sections.size();  // of one kind only
}

std::pair<int, int> Reports::step(std::size_t index, std::size_t row) const {
  const Series& series = series_[index];
  if (row < series.triaxial.size()) return {series.triaxial[row].stage, series.triaxial[row].increment};
  if (row < series.nodes.size()) return {series.nodes[row].stage, series.nodes[row].increment};
  if (row < series.discharges.size()) return {series.discharges[row].stage, series.discharges[row].increment};
  if (row < series.uplifts.size()) return {series.uplifts[row].stage, series.uplifts[row].increment};
  if (row < series.sections.size()) return {series.sections[row].stage, series.sections[row].increment};
  return {series.points.at(row).stage, series.points.at(row).increment};
}

std::vector<double> Reports::values(std::size_t index, std::size_t row) const {
  const Series& series = series_[index];
  if (row < series.triaxial.size()) {
    const TriaxialRow& r = series.triaxial[row];
    std::vector<double> values{
        r.axial_strain,  r.force, r.measured_deviator, r.correct_deviator, r.measured_axial,
        r.correct_axial, r.ratio};
    if (model_->large_strain) values.insert(values.end(), {r.measured_corrected, r.correct_corrected});
    return values;
  }
  if (row < series.nodes.size()) {
    const NodesRow& r = series.nodes[row];
    std::vector<double> values{r.displacement[0], r.displacement[1], r.force[0], r.force[1]};
    if (model_->has_pores()) values.insert(values.end(), std::begin(r.pores), std::end(r.pores));
    return values;
  }
  if (row < series.discharges.size()) {
    const DischargeRow& r = series.discharges[row];
    return {r.discharge, r.gradient, r.head, r.force[0], r.force[1]};
  }
  if (row < series.uplifts.size()) {
    const Uplift& r = series.uplifts[row].value;
    return {r.weight, r.water, r.uplift, r.heave};
  }
  if (row < series.sections.size()) return section_values(*model_, series.sections[row].value);
  const PointRow& r = series.points.at(row);
  std::vector<double> values;
  if (series.of_flow) {
    values.assign(r.flow, r.flow + 4);
  } else {
    values.assign(r.displacement, r.displacement + 2);
    values.insert(values.end(), r.strain, r.strain + 4);
    values.insert(values.end(), r.stress, r.stress + 4);
    values.insert(values.end(), {r.mean, r.deviator});
  }
  const std::size_t more = series.more.size() / series.points.size();
  const double* first = series.more.data() + row * more;
  values.insert(values.end(), first, first + more);
  return values;
}

// Throws AnalysisError for a result that is no finite number: the file then ends before its row.
void Reports::append_row(std::size_t index) {
  const std::size_t last = rows(index) - 1;
  const auto [stage, increment] = step(index, last);
  const std::vector<double> numbers = values(index, last);
  std::string text;
  append_integer(text, stage, 0);
  text += ',';
  append_integer(text, increment, 0);
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    if (columns_[index][c].optional)
      append_optional_cell(text, numbers[c], digits_);
    else
      append_result_cell(text, numbers[c], digits_);
  }
  series_[index].file.text() += text + "\n";
}

void Reports::add_rows(const Model& model, const StepReport& step, const Solution& solution) {
  enter_points(model, solution);
  if (model.has_pores() && !series_.empty()) {
    pressure_ = pore_volumes(model, solution.groups(), solution.activity->dof_map).dot(*solution.u);
    if (stage_of(model, step.stage).pores == PoreWater::flows)
      first_pressure_ = std::max(first_pressure_, std::abs(pressure_));
  }
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Series& series = series_[i];
    const Report& report = model.reports[i];
    if (!series.begun) continue;
    series.last_load_factor = step.load_factor;
    note_release(series, model, step);
    if (report.kind == ReportKind::point) {
      add_point(series, model, step, solution);
    } else if (report.kind == ReportKind::discharge) {
      add_discharge(series, model, report, step, solution);
    } else if (report.kind == ReportKind::section) {
      series.sections.push_back({step.stage + 1, step.increment, series.section.forces(model, solution)});
    } else if (report.kind == ReportKind::uplift) {
      if (step.load_factor < 1.0) continue;
      series.uplifts.push_back({step.stage + 1, step.increment,
                                uplift_on(model, step.stage, report.nodes, *solution.activity, *solution.u)});
    } else {
      const NodeSums sums = sum_nodes(model, report, solution, series.weight, step.load_factor);
      if (report.kind == ReportKind::triaxial)
        add_triaxial(series, i, step, sums);
      else
        add_nodes(series, report, step, sums, solution);
    }
    append_row(i);
    if (to_files_)
      series.file.checkpoint();
    else
      series.file.text().clear();
  }
}

void Reports::on_increment(const Model& model, const StepReport& step, const Solution& solution) {
  add_rows(model, step, solution);
}

// The part of the increment that did converge is a state in equilibrium: it gets its row.
void Reports::on_failure(const Model& model, const StepReport& step, const std::string&,
                         const Solution& solution) {
  if (!series_.empty() && step.load_factor != series_.front().last_load_factor) add_rows(model, step, solution);
  for (Series& series : series_)
    series.file.text() += fmt::format(
        "# NOT CONVERGED in stage {}, increment {}: the last row is the last state in equilibrium, load factor "
        "{:.6g}\n",
        step.stage + 1, step.increment, step.load_factor);
}

void Reports::finish() {
  for (Series& series : series_) {
    if (!series.file.open()) continue;
    series.file.finish();
    files_.push_back(series.file.path());
  }
}

void Reports::on_finish(const Model&, const RunResult&) {
  finish();
}

namespace {

void exchange_texts(Archive& archive, std::vector<std::string>& texts) {
  std::size_t count = texts.size();
  archive(count);
  texts.resize(count);
  for (std::string& text : texts) archive(text);
}

}  // namespace

// The law's own test is driven again through the strains of the rows so far.
void Reports::exchange(Archive& archive) {
  archive(pressure_);
  archive(first_pressure_);
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Series& series = series_[i];
    series.file.exchange(archive);
    archive(series.begun);
    archive(series.start_displacement);
    archive(series.start_force);
    archive(series.start_extent);
    archive(series.weight);
    archive(series.last_load_factor);
    archive(series.released);
    archive(series.release_noted);
    archive(series.specimen.sigma);
    archive(series.specimen.history);
    archive(series.specimen.note);
    exchange_texts(archive, series.messages);
    archive(series.triaxial);
    archive(series.nodes);
    archive(series.points);
    archive(series.discharges);
    archive(series.uplifts);
    archive(series.sections);
    archive(series.filled);
    archive(series.group);
    archive(series.start);
    archive(series.more);
    if (!archive.reading() || !series.begun) continue;
    begin(series, *model_, model_->reports[i]);
    if (series.correct)
      for (const TriaxialRow& row : series.triaxial)
        series.correct->deviator_at(row.axial_strain, row.duration);
  }
}

void Reports::stop(const std::string& reason) {
  for (Series& series : series_)
    series.file.text() += "# RUN STOPPED, NOT COMPLETE: " + one_line(reason) + "\n";
  finish();
}

}  // namespace sage
