#include "sage/app/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "sage/analysis/spectrum.hpp"
#include "sage/math/quadrature.hpp"
#include "sage/model/locate.hpp"
#include "sage/model/locking.hpp"
#include "sage/record/report.hpp"
#include "sage/record/sampler.hpp"
#include "sage/record/section_forces.hpp"

namespace sage::app {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kNoStress = std::numeric_limits<double>::quiet_NaN();

bool is_last(const Model& model, const StepReport& step) {
  return step.stage + 1 == static_cast<int>(model.stages.size()) && step.increment == step.increments;
}

// A place in the parent shape of an element.
Vector2 place_in(const Model& model, const Location& holder, const Vector2& parent) {
  const Group& group = model.groups[holder.group];
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, group, holder.element, x);
  const auto nodes = static_cast<std::size_t>(x.cols());
  std::vector<double> N(nodes), dN(2 * nodes);
  group.element->shape_functions(parent, N, dN);
  return x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
}

// Gauss points: the error of an element, which has the highest degrees, has no mean over them; what comes from elsewhere has.
void add_grid(const Model& model, const Location& holder, int element,
              std::vector<Surroundings::Place>& places) {
  const bool triangle = model.groups[holder.group].entry->triangle();
  const double size = triangle ? 0.5 : 4.0;  // of the parent shape
  for (const RulePoint& q : gauss_area(triangle, 5))
    places.push_back(
        {place_in(model, holder, {q.xi, q.eta}), static_cast<int>(holder.group), element, q.w / size});
}

double size_of(const Model& model, const Location& holder) {
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, model.groups[holder.group], holder.element, x);
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

// The place is the corner that the layers of a grading shrink to, or next to nothing beside it.
bool is_last_layer(const Model& model, const Location& holder) {
  constexpr double kLayer = 1e-3, kDeepLayer = 1e-6;  // of the mesh; four layers are below the first
  const double extent = (model.mesh.x.rowwise().maxCoeff() - model.mesh.x.rowwise().minCoeff()).maxCoeff();
  const bool vertex = (holder.parent.cwiseAbs() - Vector2::Ones()).cwiseAbs().maxCoeff() < 1e-6;
  return size_of(model, holder) < (vertex ? kLayer : kDeepLayer) * extent;
}

// Of stress (or strain) components at the points of an element; NaN for elements of low degree.
Vector4 missing_in(const Group& group, const std::vector<double>& at_points, const Location& holder) {
  constexpr int kLeastDegree = 4;
  const int line = group.element->traits().degree + 1, points = group.element->traits().points;
  if (!group.entry->square() || line <= kLeastDegree || points != line * line)
    return Vector4::Constant(kNoStress);
  const LegendreParts parts(line);
  const Eigen::Map<const Eigen::Matrix4Xd> values(
      at_points.data() + 4 * static_cast<std::size_t>(holder.element) * static_cast<std::size_t>(points), 4,
      points);
  Vector4 missing;
  for (int c = 0; c < 4; ++c) missing[c] = parts.missing(values.row(c).transpose(), holder.parent);
  return missing;
}

// Columns of the usual fields of a point report.
struct Columns {
  std::vector<const FieldEntry*> field;  // of each column
  std::vector<int> component;
};

Columns columns_of(const FieldList& fields) {
  Columns columns;
  for (const FieldEntry* field : fields)
    for (std::size_t c = 0; c < field->size(); ++c) {
      columns.field.push_back(field);
      columns.component.push_back(static_cast<int>(c));
    }
  return columns;
}

std::vector<double> missing_of(const Model& model, const Solution& solution,
                               const std::vector<Location>& holders, const Columns& columns) {
  Vector4 stress = Vector4::Zero(), strain = Vector4::Zero();
  for (const Location& holder : holders) {
    const PointStates& state = solution.groups()[holder.group].state.committed;
    const Group& group = model.groups[holder.group];
    if (!group.solid()) return std::vector<double>(columns.field.size(), kNoStress);
    stress = stress.cwiseMax(missing_in(group, state.sigma, holder));
    strain = strain.cwiseMax(missing_in(group, state.eps, holder));
  }
  std::vector<double> missing;
  for (std::size_t k = 0; k < columns.field.size(); ++k) {
    const std::string& name = columns.field[k]->name;
    const auto c = columns.component[k];
    missing.push_back(name == "stress"                              ? stress[c]
                      : name == "strain"                            ? strain[c]
                      : name == "mean_stress" || name == "deviator" ? stress.maxCoeff()
                                                                    : kNoStress);
  }
  return missing;
}

// What a mesh changed at the places of the one before, column by column; sisters are the components of a field.
std::vector<LocalErrors::Change> changes_in(const std::vector<const FieldEntry*>& fields,
                                            const Surroundings& earlier, const Surroundings& now) {
  std::vector<LocalErrors::Change> changes(fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k) {
    LocalErrors::Change& change = changes[k];
    std::map<int, double> squares, means;  // by element
    for (std::size_t p = 1; p < earlier.places.size(); ++p) {
      const Surroundings::Place& place = earlier.places[p];
      const double difference = now.at_earlier[p][k] - earlier.values[p][k];
      squares[place.element] += place.weight * difference * difference;
      means[place.element] += place.weight * difference;
    }
    change.own = std::abs(now.at_earlier[0][k] - earlier.values[0][k]);
    for (const auto& [element, square] : squares) change.own = std::max(change.own, std::sqrt(square));
    for (const auto& [element, mean] : means) change.mean = std::max(change.mean, std::abs(mean));
    change.missing = now.missing[k];
  }
  for (std::size_t k = 0; k < fields.size(); ++k)
    for (std::size_t s = 0; s < fields.size(); ++s) {
      if (fields[s] != fields[k]) continue;
      changes[k].largest = std::max(changes[k].largest, changes[s].own);
      changes[k].largest_mean = std::max(changes[k].largest_mean, changes[s].mean);
      changes[k].largest_missing = std::max(changes[k].largest_missing, changes[s].missing);
      changes[k].size = std::max(changes[k].size, std::abs(now.values[0][s]));
    }
  return changes;
}

}  // namespace

namespace {

// Forces along the cut of a section and along others beside it, by steps of a tenth of its length.  They may agree on two
// meshes by chance at one place, as stresses at a point may.
void read_cuts(const Model& model, const Solution& solution, const Report& report, Surroundings& here) {
  constexpr int kSteps = 5;
  const ProbeMaker probes(model, solution.activity->group);
  const Vector2 along = report.end - report.place;
  const std::size_t count = model.geometry == Geometry::axisymmetric ? 5 : 3;
  for (int step = 0; step <= 2 * kSteps; ++step) {
    Report beside = report;
    const Vector2 shift = 0.1 * (step <= kSteps ? step : kSteps - step) * Vector2(along.y(), -along.x());
    beside.place += shift;
    beside.end += shift;
    const Vector2 middle = 0.5 * (beside.place + beside.end);
    if (model.geometry == Geometry::axisymmetric && !(middle.x() > 0.0)) continue;
    const SectionForces f = SectionSum(model, beside, solution.activity->group, probes).forces(model, solution);
    here.places.push_back({middle, report.group});
    const std::vector<double> forces{f.axial, f.shear, f.moment, f.hoop, f.hoop_moment};
    here.values.emplace_back(forces.begin(), forces.begin() + static_cast<std::ptrdiff_t>(count));
  }
}

// The largest change of each force and moment on any of the cuts.  Cuts outside of the solids have none.
std::vector<double> changes_of_cuts(const Surroundings& earlier, const Surroundings& now) {
  std::vector<double> changes(now.values.front().size(), 0.0);
  for (std::size_t p = 0; p < now.values.size(); ++p)
    for (std::size_t k = 0; k < changes.size(); ++k)
      if (const double change = std::abs(now.values[p][k] - earlier.values[p][k]); change > changes[k])
        changes[k] = change;
  return changes;
}

}  // namespace

bool SurroundingsReader::wants_states(const Model& model, const StepReport& step) const {
  return is_last(model, step);
}

void SurroundingsReader::on_increment(const Model& model, const StepReport& step, const Solution& solution) {
  if (!is_last(model, step)) return;
  found.assign(model.reports.size(), {});
  const ElementKind kind = kind_at_points(model);
  const FieldTable table = fields_of(model);
  std::optional<Locator> locator;
  for (std::size_t i = 0; i < model.reports.size(); ++i) {
    const Report& report = model.reports[i];
    if (report.kind == ReportKind::section) read_cuts(model, solution, report, found[i]);
    if (report.kind != ReportKind::point) continue;
    if (!locator) locator.emplace(model, kind);
    const std::vector<Location> holders =
        one_body(model, locator->at(report.place), solution.activity->group, report.group);
    if (holders.empty()) continue;
    const FieldList fields = point_report_fields(model, table, report);
    const Sampler sampler(model, solution, fields, kind);
    Surroundings& here = found[i];
    here.places.push_back({report.place, report.group});
    here.at_corner = true;
    int element = 0;
    for (const Location& holder : holders) {
      add_grid(model, holder, element++, here.places);
      here.at_corner = here.at_corner && is_last_layer(model, holder);
    }
    for (const Surroundings::Place& place : here.places)
      here.values.push_back(sampler.at(place.at, place.group).values);
    here.missing = missing_of(model, solution, holders, columns_of(fields));
    if (i >= earlier_->size()) continue;
    for (const Surroundings::Place& place : (*earlier_)[i].places)
      here.at_earlier.push_back(sampler.at(place.at, place.group).values);
  }
}

namespace {

// How the errors of a sequence's meshes follow from what they change: measured on 520 points in ten scenes
// (docs/theory/accuracy.md), so that no error is too small and the median is less than ten times the true one.
struct Shares {
  double change, missing;  // of what the mesh changed, and of what its elements show to be missing
  double slow;             // from this ratio of two changes on the series is a slow geometric one
  double mean = 0.0;       // of the mean change over the elements
  double before = 0.0;     // a change below this part of the one before is chance
};

// mesh: from 1.  Pressures near nu = 1/2 converge less evenly.
Shares shares_of(int mesh, double stiffness_of_volume) {
  if (mesh == 2) return {0.55, 1.45, kUnknown};
  if (mesh == 3) return {0.46, 2.2, 0.4};
  if (mesh == 4) return {std::pow(stiffness_of_volume, 0.05) / 26.0, 1.4, 0.45};
  if (mesh == 5)
    return {std::min(std::sqrt(stiffness_of_volume) / 200.0, 0.11), 1.1, 0.2, 0.35,
            std::min(1e-4 * stiffness_of_volume, 0.015)};
  return {0.035, 1.5, 0.2, 0.3};
}

// Of the largest of a number and its sisters: equilibrium to 1e-10 leaves pressures open by K / G times as much.
double least_share(double stiffness_of_volume) {
  return convergence::kLeastError + 1e-11 * stiffness_of_volume;
}

// The rest of a geometric series, with caution.
double rest(double r, double caution) {
  return r >= 1.0 ? kUnknown : caution * r / (1.0 - r);
}

// The largest K / G of the solids.
double stiffness_of_volume(const Model& model) {
  double most = 0.0;
  for (const Group& group : model.groups) {
    if (!group.solid() || group.elements() == 0) continue;
    const double nu = poissons_ratio(model.material_of(group));
    most = std::max(most, 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)));
  }
  return most;
}

}  // namespace

// Rising degrees and layers, then halved: from what the last mesh changed around the point (`change`, and the largest of
// the number's sisters) and from what is missing.
double LocalErrors::spectral_error(const Change& now, const Change* before, double stiffness) const {
  constexpr double kSisters = 0.3, kMostOff = 1.5;
  const Shares shares = shares_of(mesh_, stiffness);
  const auto with_sisters = [](double own, double largest) { return std::max(own, kSisters * largest); };
  double change = with_sisters(now.own, now.largest), slow = 0.0;
  double missing = std::isnan(now.missing) ? 0.0 : with_sisters(now.missing, now.largest_missing);
  if (before != nullptr && !now.only_rounding()) {
    const double r = now.largest / before->largest;
    if (r >= 1.0) return kUnknown;
    if (r > shares.slow) slow = rest(r, 3.0) * change;
    change = std::max(change, shares.before * with_sisters(before->own, before->largest));
    // What the mesh before showed to be missing can be compared with what this one changed.
    if (mesh_ == 3 && before->largest_missing > 0.0)
      missing *= std::max(0.5, std::min(kMostOff, now.largest / before->largest_missing));
  }
  const double mean = with_sisters(now.mean, now.largest_mean);
  const double all = std::hypot(shares.change * change, shares.mean * mean, shares.missing * missing);
  return std::max({all, slow, least_share(stiffness) * now.size});
}

// Halved elements of degree p: no change counts as falling faster than by 2^-(p - 1), one order less than the best, since a
// point may do better than its surroundings by chance; nor than by half of three meshes, the first of which may be too
// coarse for a rate.
double LocalErrors::halving_error(const Change& now, const Change* before) const {
  if (now.only_rounding()) return now.own;
  if (before == nullptr) return kUnknown;
  const double least = mesh_ == 3 ? 0.5 : std::min(0.5, 2.0 / std::sqrt(sequence_.most));
  return now.own * rest(std::max(now.largest / before->largest, least), 2.0);
}

std::vector<double> LocalErrors::errors_of(const Model& model, std::size_t report, const Surroundings& now) {
  if (model.reports[report].kind == ReportKind::section) {
    if (report < earlier_.size() && earlier_[report].values.size() == now.values.size())
      return changes_of_cuts(earlier_[report], now);
    return std::vector<double>(now.values.front().size(), kUnknown);
  }
  const FieldTable table = fields_of(model);
  const Columns columns = columns_of(point_report_fields(model, table, model.reports[report]));
  const std::size_t count = columns.field.size();
  if (report >= earlier_.size() || now.at_earlier.empty()) return std::vector<double>(count, kUnknown);
  const std::vector<Change> change = changes_in(columns.field, earlier_[report], now);
  const double stiffness = stiffness_of_volume(model);
  std::vector<Change>& before = changes_[report];
  std::vector<double> errors;
  for (std::size_t k = 0; k < count; ++k) {
    const Change* earlier = before.empty() ? nullptr : &before[k];
    double error = sequence_.kind == convergence::MeshSequence::spectral
                       ? spectral_error(change[k], earlier, stiffness)
                       : halving_error(change[k], earlier);
    if (now.at_corner && columns.field[k]->place() != FieldPlace::node) error = kUnknown;
    errors.push_back(error);
  }
  before = change;
  return errors;
}

std::vector<double> LocalErrors::after(const Model& model, const std::vector<ReportComponent>& components,
                                       std::vector<Surroundings> found) {
  ++mesh_;
  changes_.resize(model.reports.size());
  std::vector<double> errors(components.size(), kNoStress);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].places.empty()) continue;
    const std::vector<double> own = errors_of(model, i, found[i]);
    const std::vector<ReportColumn> columns = report_columns(model, model.reports[i]);
    for (std::size_t k = 0; k < std::min(columns.size(), own.size()); ++k)
      for (std::size_t c = 0; c < components.size(); ++c)
        if (components[c].name == "report" + std::to_string(i + 1) + "." + columns[k].name) errors[c] = own[k];
  }
  earlier_ = std::move(found);
  return errors;
}

}  // namespace sage::app
