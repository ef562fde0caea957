#include "sage/output/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sage/analysis/loads.hpp"
#include "sage/output/number.hpp"
#include "sage/output/values.hpp"

namespace sage {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kSubsteps = 10;  // of the law, an increment
constexpr int kDigits = 10;

struct NodeSums {
  // Mean over the deck's own nodes, so that it keeps its meaning in finer meshes.
  double displacement[2] = {0, 0};
  double force[2] = {0, 0};  // sum of internal forces, less the weight
};

// What the weight of the soil puts on the report's nodes: what acts at the start of a stage stays, what is
// placed or added in it grows.
struct Weights {
  Eigen::VectorXd start, end;

  Weights(const Model& model, int stage) {
    Activity activity(model);
    Vector2 gravity = Vector2::Zero();
    for (int s = 0; s < stage; ++s) {
      activity.enter(model.stages[static_cast<std::size_t>(s)]);
      gravity += model.stages[static_cast<std::size_t>(s)].gravity;
    }
    std::vector<char> both = activity.group;
    activity.enter(model.stages[static_cast<std::size_t>(stage)]);
    for (std::size_t g = 0; g < both.size(); ++g) both[g] = both[g] && activity.group[g];
    start = weight_of(model, both, gravity);
    end = weight_of(model, activity.group, gravity + model.stages[static_cast<std::size_t>(stage)].gravity);
  }
};

// weight: at the start and the end of the stage, of which load_factor has passed.
NodeSums sum_nodes(const Model& model, const Report& report, const Solution& solution,
                   const double (&weight)[2][2], double load_factor) {
  NodeSums sums;
  for (int c = 0; c < 2; ++c) sums.force[c] = -(1.0 - load_factor) * weight[0][c] - load_factor * weight[1][c];
  int own = 0;
  for (int node : report.nodes) {
    const bool of_deck = node < model.mesh.deck_nodes;
    own += of_deck ? 1 : 0;
    for (int c = 0; c < 2; ++c) {
      if (of_deck) sums.displacement[c] += (*solution.u)[2 * node + c];
      sums.force[c] += (*solution.internal)[2 * node + c];
    }
  }
  for (double& d : sums.displacement) d /= std::max(own, 1);
  return sums;
}

// Forces on the report's nodes that nothing bears when a stage starts: they are held, and let go over the
// stage. What equilibrium leaves at free nodes is not meant.
std::array<double, 2> released_forces(const Model& model, const Report& report, const Solution& start) {
  constexpr double kNoticed = 1e-4;  // of the model's largest force
  const std::vector<char> active = active_nodes(model, *start.activity);
  std::array<double, 2> sum{0.0, 0.0};
  for (int node : report.nodes)
    for (int c = 0; c < 2; ++c) {
      const int dof = 2 * node + c;
      if (active[static_cast<std::size_t>(node)] && !start.activity->held[static_cast<std::size_t>(dof)])
        sum[static_cast<std::size_t>(c)] += (*start.internal)[dof] - (*start.external)[dof];
    }
  const double largest = start.internal->size() > 0 ? start.internal->lpNorm<Eigen::Infinity>() : 0.0;
  for (double& s : sum)
    if (std::abs(s) <= kNoticed * largest) s = 0.0;
  return sum;
}

const SolidLaw* specimen_law(const Model& model, const Report& report) {
  if (report.group < 0) return nullptr;
  const LawRef law = model.material_of(model.groups[static_cast<std::size_t>(report.group)]).law_ref();
  const auto* solid = std::get_if<const SolidLaw*>(&law);
  return solid != nullptr ? *solid : nullptr;
}

std::string header(const Model& model, const Report& report) {
  const UnitSystem& u = model.units;
  const std::string per = forces_per(model.geometry);
  std::string text = "# " + model.title + "\n";
  if (report.kind == ReportKind::triaxial)
    return text +
           fmt::format(
               "# triaxial report; compression positive; strain and deviator count from the start of stage "
               "{0}; units {1}, {2}, {3}; forces {4}\n"
               "# correct: one point of the law, frictionless ends; ratio = measured / correct deviator\n"
               "stage,increment,axial_strain[-],force[{2}],measured_deviator[{3}],correct_deviator[{3}],"
               "measured_axial[{3}],correct_axial[{3}],ratio[-]\n",
               report.stage + 1, u.length, u.force, u.stress, per);
  return text + fmt::format(
                    "# node report: mean displacement since the start of stage {0}, sum of the forces that "
                    "loads and supports put on the nodes, without the weight of the soil; positive along +x, "
                    "+y; forces {3}\n"
                    "stage,increment,ux[{1}],uy[{1}],fx[{2}],fy[{2}]\n",
                    report.stage + 1, u.length, u.force, per);
}

void append_row(std::string& text, int stage, int increment, std::initializer_list<double> values) {
  append_integer(text, stage, 0);
  text += ',';
  append_integer(text, increment, 0);
  for (double value : values) {
    text += ',';
    if (!std::isnan(value)) append_plain(text, value, kDigits);
  }
  text += '\n';
}

}  // namespace

CorrectTest::CorrectTest(const SolidLaw& law, Geometry geometry, double cell_pressure)
    : geometry_(geometry), cell_pressure_(cell_pressure) {
  const double p = -cell_pressure;
  try {
    driver_ = std::make_unique<PointDriver<4>>(law, Vector4(p, p, p, 0.0));
  } catch (const AnalysisError&) {  // the law can't carry the cell pressure
  }
}

double CorrectTest::deviator_at(double axial_strain) {
  if (!driver_) return kUnknown;
  const bool ring = geometry_ == Geometry::axisymmetric;
  const std::array<Control, 4> control{Control::stress, Control::strain,
                                       ring ? Control::stress : Control::strain, Control::strain};
  const double lateral = -cell_pressure_, part = -(axial_strain - axial_strain_) / kSubsteps;
  const Vector4 step(lateral, part, ring ? lateral : 0.0, 0.0);
  try {
    for (int i = 0; i < kSubsteps; ++i) driver_->advance(control, step);
  } catch (const AnalysisError&) {
    driver_.reset();
    return kUnknown;
  }
  axial_strain_ = axial_strain;
  return outward(driver_->sigma()[1]) - cell_pressure_;
}

double report_area(const Model& model, const Report& report) {
  if (report.area > 0.0) return report.area;
  if (report.nodes.empty()) return kUnknown;
  double low = model.mesh.x(0, report.nodes.front()), high = low;
  for (int node : report.nodes) {
    low = std::min(low, model.mesh.x(0, node));
    high = std::max(high, model.mesh.x(0, node));
  }
  return model.geometry == Geometry::axisymmetric ? kPi * high * high : high - low;
}

void Reports::on_start(const Model& model, const Scene&, std::string_view, int) {
  model_ = &model;
  for (std::size_t i = 0; i < model.reports.size(); ++i) {
    Series series;
    series.file = OutFile(folder_ / (stem_ + ".report" + std::to_string(i + 1) + ".csv"));
    series.file.text() = header(model, model.reports[i]);
    series_.push_back(std::move(series));
  }
}

void Reports::on_stage_start(const Model& model, int stage, const Solution& solution) {
  if (series_.empty()) return;
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
        series.weight[0][c] += weights.start[2 * node + c];
        series.weight[1][c] += weights.end[2 * node + c];
      }
    }
    if (series.begun || stage < report.stage) continue;
    series.begun = true;
    const NodeSums sums = sum_nodes(model, report, solution, series.weight, 0.0);
    std::copy(sums.displacement, sums.displacement + 2, series.start_displacement);
    series.start_force = -sums.force[1];
    begin(series, model, report);
  }
}

void Reports::begin(Series& series, const Model& model, const Report& report) {
  if (report.kind != ReportKind::triaxial) return;
  series.area = report_area(model, report);
  if (const SolidLaw* law = specimen_law(model, report))
    series.correct = std::make_unique<CorrectTest>(*law, model.geometry, report.cell_pressure);
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

void Reports::add_rows(const Model& model, const StepReport& step, const Solution& solution) {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Series& series = series_[i];
    const Report& report = model.reports[i];
    if (!series.begun) continue;
    series.last_load_factor = step.load_factor;
    note_release(series, model, step);
    const double held = 1.0 - step.load_factor;
    const NodeSums sums = sum_nodes(model, report, solution, series.weight, step.load_factor);
    if (report.kind == ReportKind::nodes) {
      series.nodes.push_back({step.stage + 1,
                              step.increment,
                              {sums.displacement[0] - series.start_displacement[0],
                               sums.displacement[1] - series.start_displacement[1]},
                              {sums.force[0], sums.force[1]},
                              {held * series.released[0], held * series.released[1]}});
      const NodesRow& r = series.nodes.back();
      append_row(series.file.text(), r.stage, r.increment,
                 {r.displacement[0], r.displacement[1], r.force[0], r.force[1]});
    } else {
      TriaxialRow r;
      r.stage = step.stage + 1;
      r.increment = step.increment;
      r.axial_strain = -(sums.displacement[1] - series.start_displacement[1]) / report.height;
      r.force = -sums.force[1];
      r.measured_deviator = (r.force - series.start_force) / series.area;
      r.correct_deviator = series.correct ? series.correct->deviator_at(r.axial_strain) : kUnknown;
      r.measured_axial = report.cell_pressure + r.measured_deviator;
      r.correct_axial = report.cell_pressure + r.correct_deviator;
      r.ratio = r.correct_deviator != 0.0 ? r.measured_deviator / r.correct_deviator : kUnknown;
      r.held = -held * series.released[1];
      series.triaxial.push_back(r);
      append_row(series.file.text(), r.stage, r.increment,
                 {r.axial_strain, r.force, r.measured_deviator, r.correct_deviator, r.measured_axial,
                  r.correct_axial, r.ratio});
    }
    series.file.checkpoint();
  }
}

void Reports::on_increment(const Model& model, const StepReport& step, const Solution& solution) {
  add_rows(model, step, solution);
}

// The part of the increment that did converge is a state in equilibrium: it gets its row.
void Reports::on_failure(const Model& model, const StepReport& step, const std::string&,
                         const Solution& solution) {
  if (!series_.empty() && step.load_factor > series_.front().last_load_factor) add_rows(model, step, solution);
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

// The law's own test is driven again through the strains of the rows so far.
void Reports::exchange(Archive& archive) {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Series& series = series_[i];
    series.file.exchange(archive);
    archive(series.begun);
    archive(series.start_displacement);
    archive(series.start_force);
    archive(series.weight);
    archive(series.last_load_factor);
    archive(series.released);
    archive(series.release_noted);
    archive(series.triaxial);
    archive(series.nodes);
    if (!archive.reading() || !series.begun) continue;
    begin(series, *model_, model_->reports[i]);
    if (series.correct)
      for (const TriaxialRow& row : series.triaxial) series.correct->deviator_at(row.axial_strain);
  }
}

void Reports::stop(const std::string& reason) {
  for (Series& series : series_)
    series.file.text() += "# RUN STOPPED, NOT COMPLETE: " + one_line(reason) + "\n";
  finish();
}

}  // namespace sage
