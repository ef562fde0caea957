#include "sage/analysis/step_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/math/rounding.hpp"

namespace sage {

namespace {

constexpr double kUnitRounding = rounding::kFewProducts;

}  // namespace

StepMeasures::StepMeasures(const Assembly& assembly, const Tangent& tangent, const Eigen::VectorXd& target,
                           const NewtonSettings& settings, const Eigen::VectorXd& du)
    : assembly_(assembly), tangent_(tangent), target_(target), settings_(settings), du_(du), fields_(assembly) {
  for (int f = 0; f < fields_.count(); ++f) at(load_scale_, f) = load_size(f);
}

double StepMeasures::load_size(int field) const {
  double sum = 0.0;
  const ByField::Piece own = fields_.equations_of(field);
  for (int eq = own.begin; eq < own.end; ++eq) sum += std::pow(assembly_.numbering().force(target_, eq), 2);
  if (field == 0)
    for (int dof : assembly_.eliminated().dofs()) sum += std::pow(target_[dof], 2);
  return std::sqrt(sum);
}

void StepMeasures::take_start() {
  for (int f = 0; f < fields_.count(); ++f) at(start_scale_, f) = assembly_.force_scale(f);
}

void StepMeasures::take_prescribed(const Eigen::VectorXd& rate, double rate_part) {
  for (int f = 0; f < fields_.count(); ++f)
    at(prescribed_, f) = std::abs(rate_part) * fields_.largest_of_dofs(rate, f);
}

double StepMeasures::take_first(const Eigen::VectorXd& motion, const Eigen::VectorXd& force) {
  double work = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    work += at(energy_scale_, f) = std::abs(fields_.dot(motion, force, f));
  const double held = std::abs(assembly_.eliminated().held_work());
  energy_scale_[0] += held;
  work += held;
  for (int f = 0; f < fields_.count(); ++f)
    at(first_force_, f) =
        std::max({fields_.norm(force, f), at(start_scale_, f), at(load_scale_, f), own_forces(motion, f)});
  return work;
}

// What the first correction of a field makes in its own equations, where another field balances it.
double StepMeasures::own_forces(const Eigen::VectorXd& motion, int field) const {
  if (fields_.count() == 1 || tangent_.sizes().norm1() < 0.0) return 0.0;
  if (water_flows(assembly_) && linear_in_step(assembly_))
    return 0.0;  // no iteration runs away, and there are many steps
  return fields_.norm(tangent_.sizes().times(fields_.part(motion, field)), field);
}

void StepMeasures::take_energy(const Eigen::VectorXd& correction, const Eigen::VectorXd& residual) {
  for (int f = 0; f < fields_.count(); ++f)
    at(energy_scale_, f) = std::max(at(energy_scale_, f), std::abs(fields_.dot(correction, residual, f)));
}

double StepMeasures::scale(int field) const {
  return std::max({assembly_.force_scale(field), at(load_scale_, field), at(start_scale_, field)});
}

FieldMeasure StepMeasures::measure(int field, const Eigen::VectorXd& correction,
                                   const Eigen::VectorXd& residual, double step_length) const {
  const double force_scale = scale(field), size = fields_.norm_of_dofs(du_, field);
  const double force = fields_.norm(residual, field);
  const double energy = std::abs(fields_.dot(correction, residual, field)), whole = at(energy_scale_, field);
  FieldMeasure measure;
  measure.record.force = force_scale > 0.0 ? force / force_scale : 0.0;
  measure.record.displacement = size > 0.0 ? fields_.norm(correction, field) / size : 0.0;
  measure.record.energy = whole > 0.0 ? energy / whole : 0.0;
  measure.record.step_length = step_length;
  measure.scale = force_scale;
  measure.first = at(first_force_, field);
  measure.largest = fields_.largest(residual, field);
  return measure;
}

IterationRecord StepMeasures::measure(const Eigen::VectorXd& correction, const Eigen::VectorXd& residual,
                                      double step_length) {
  for (int f = 0; f < fields_.count(); ++f) measured_[f] = measure(f, correction, residual, step_length);
  IterationRecord record = measured_[0].record;
  const auto take = [](double& worst, double value) {
    if (!(value <= worst)) worst = value;  // not a number counts as worst
  };
  for (const FieldMeasure& other : measured().subspan(1)) {
    take(record.force, other.record.force);
    take(record.displacement, other.record.displacement);
    take(record.energy, other.record.energy);
  }
  return record;
}

double StepMeasures::size_of(const Eigen::VectorXd& residual) const {
  if (fields_.count() == 1) return residual.norm();
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    if (at(first_force_, f) > 0.0) sum += std::pow(fields_.norm(residual, f) / at(first_force_, f), 2);
  return std::sqrt(sum);
}

double StepMeasures::work_left(const Eigen::VectorXd& correction, const Eigen::VectorXd& residual) const {
  if (fields_.count() == 1) return correction.dot(residual);
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    if (at(energy_scale_, f) > 0.0) sum += fields_.dot(correction, residual, f) / at(energy_scale_, f);
  return sum;
}

// Beyond 1/eps of the step's own forces no digit of those is left in a residual: the iteration has run away,
// and what comes behind is noise, however small it may be beside the stress that it has made itself.
bool StepMeasures::is_hopeless(const Eigen::VectorXd& residual) const {
  for (int f = 0; f < fields_.count(); ++f) {
    const double size = fields_.norm(residual, f), first = at(first_force_, f);
    if (!std::isfinite(size) || (first > 0.0 && size * std::numeric_limits<double>::epsilon() > first))
      return true;
  }
  return false;
}

WorstDof StepMeasures::worst(const Eigen::VectorXd& residual) const {
  int worst = -1;
  double largest = -1.0;
  for (int f = 0; f < fields_.count(); ++f) {
    const int eq = fields_.place_of_largest(residual, f);
    if (eq < 0) continue;
    const double scale_here = fields_.count() > 1 ? scale(f) : 1.0;
    const double share = scale_here > 0.0 ? std::abs(residual[eq]) / scale_here : 0.0;
    if (share <= largest) continue;
    largest = share;
    worst = eq;
  }
  if (worst < 0) return {};
  const DofMap::Unknown unknown = assembly_.dof_map().at(assembly_.dof_of(worst));
  return {unknown.node, unknown.field, unknown.component, residual[worst]};
}

// Of the field's own block of K; of one among several from below, which is the careful side.
double StepMeasures::stiffness_norm(int field) const {
  const double norm1 = tangent_.sizes().norm1();
  if (fields_.count() == 1 || norm1 < 0.0) return norm1;
  return tangent_.sizes().coupling_of(fields_, field, field);
}

double StepMeasures::size_of_unknown(int field) const {
  const double before =
      settings_.committed != nullptr ? fields_.largest_of_dofs(*settings_.committed, field) : 0.0;
  return before + fields_.largest_of_dofs(du_, field);
}

double StepMeasures::of_step(int field) const {
  return kUnitRounding * stiffness_norm(field) * fields_.largest_of_dofs(du_, field);
}

double StepMeasures::of_all_steps(int field) const {
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    sum += tangent_.sizes().coupling_of(fields_, field, f) * fields_.largest_of_dofs(du_, f);
  return kUnitRounding * sum;
}

double StepMeasures::of_prescribed(int field) const {
  return kUnitRounding * stiffness_norm(field) * at(prescribed_, field);
}

double StepMeasures::of_unknowns(int field) const {
  return kUnitRounding * stiffness_norm(field) * size_of_unknown(field);
}

// Shut-in water carries a load without any displacement.  What is left of one is the rounding of that which the pressures
// alone would make.
double StepMeasures::of_all_unknowns(int field) const {
  double reach = size_of_unknown(0);
  const bool pores = settings_.unknowns != nullptr &&
                     std::ranges::any_of(*settings_.unknowns, [](const UnknownField& f) { return f.of_pores; });
  if (const double stiffness = pores ? stiffness_norm(0) : 0.0; stiffness > 0.0) {
    double force = 0.0;
    for (int f = 1; f < fields_.count(); ++f)
      force += tangent_.sizes().coupling_of(fields_, 0, f) * size_of_unknown(f);
    reach = std::max(reach, force / stiffness);
  }
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    sum +=
        kUnitRounding * tangent_.sizes().coupling_of(fields_, field, f) * (f == 0 ? reach : size_of_unknown(f));
  return sum;
}

double StepMeasures::of_moments(int field) const {
  if (settings_.unknowns == nullptr || !(*settings_.unknowns)[field].turns) return -1.0;
  return kUnitRounding * assembly_.force_scale(0) * settings_.size;
}

}  // namespace sage
