#include "sage/analysis/step_iteration.hpp"

#include <algorithm>

#include "sage/analysis/load_control.hpp"

namespace sage {

StepIteration::StepIteration(Assembly& assembly_of_step, Tangent& tangent_of_step,
                             const Eigen::VectorXd& target_of_step, double part,
                             const NewtonSettings& settings_of_step, WorkCounters& counters,
                             Eigen::VectorXd& step)
    : assembly(assembly_of_step),
      tangent(tangent_of_step),
      target(target_of_step),
      settings(settings_of_step),
      work(counters),
      du(step),
      pass(assembly.begin_step(target, part, settings.so_far)),
      policy(settings.policy != nullptr ? *settings.policy : plain_policy),
      rate_part(part),
      measures(assembly, tangent, target, settings, du),
      criterion(settings.tolerance, settings.refine, tangent.linear()),
      residual(assembly.equations()) {
  result.outcome = StepOutcome::law_cut;
  result.iterations.reserve(settings.max_iterations);
}

Outcome StepIteration::assemble(bool with_K) {
  K_is_here = with_K;
  const Outcome outcome = pass->iterate(du, with_K ? &tangent : nullptr);
  if (outcome == Outcome::ok) form_residual();
  return outcome;
}

Outcome StepIteration::form_tangent() {
  K_is_here = true;
  return pass->iterate(du, &tangent);
}

void StepIteration::form_residual() {
  const Eigen::VectorXd& f = assembly.internal_force();
  const Equations& equations = assembly.numbering();
  for (int eq = 0; eq < equations.count(); ++eq)
    residual[eq] = equations.force(target, eq) - equations.force(f, eq);
}

// The run needs most memory while it factorises: the correction is allocated after that.
void StepIteration::solve() {
  if (settings.damping_fall > 0.0) tangent.damp(damping);
  tangent.factorise(work);
  correction.resize(assembly.equations());
  tangent.solve(residual, correction, work);
  if (settings.control != nullptr) settings.control->correct(*this);
  if (settings.damping_fall > 0.0) tangent.forget();
}

void StepIteration::move(double factor) {
  for (int eq = 0; eq < assembly.equations(); ++eq) assembly.numbering().move(du, eq, factor * correction[eq]);
}

void StepIteration::advance() {
  measures.take_energy(correction, residual);
  slope = work_left();
  step_length = 1.0;
  move(1.0);
}

bool StepIteration::predict(const Eigen::VectorXd& rate) {
  const bool committed = settings.start == NewtonStart::committed;
  if (!(committed ? start_from_committed() : start_from_du(rate))) return false;
  solve();
  result.predicted_work = measures.take_first(correction, residual);
  if (committed) du = rate_part * rate;
  measures.take_prescribed(rate, rate_part);
  move(1.0);
  return true;
}

// Prescribed displacements enter through K(free, prescribed).
bool StepIteration::start_from_committed() {
  du.setZero();
  if (!start_known && water_flows(assembly)) {
    // Time alone moves water.  Where K depends on nothing but the size of the step, the kept one may be that of another.
    if (assemble(!tangent.current() || linear_in_step(assembly)) == Outcome::cut_step) return false;
  }
  if (!tangent.current() && form_tangent() == Outcome::cut_step) return false;
  if (start_known) {
    residual = start_residual;
  } else {
    measures.take_start();
    form_residual();
  }
  const Eigen::VectorXd& coupling = tangent.coupling();
  for (int eq = 0; eq < assembly.equations(); ++eq)
    residual[eq] -= rate_part * assembly.numbering().force(coupling, eq);
  return true;
}

// du is near the answer.
bool StepIteration::start_from_du(const Eigen::VectorXd& rate) {
  take_prescribed(rate);
  if (form_tangent() == Outcome::cut_step) return false;
  measures.take_start();
  form_residual();
  return true;
}

void StepIteration::take_prescribed(const Eigen::VectorXd& rate) {
  const Eigen::VectorXd free = free_part_of_du();
  du = rate_part * rate;
  for (int eq = 0; eq < assembly.equations(); ++eq) assembly.numbering().set(du, eq, free[eq]);
}

Eigen::VectorXd StepIteration::free_part_of_du() const {
  Eigen::VectorXd free(assembly.equations());
  for (int eq = 0; eq < assembly.equations(); ++eq) free[eq] = assembly.numbering().unknown(du, eq);
  return free;
}

bool StepIteration::converged() {
  const IterationRecord record = pass->measure(*this);
  result.iterations.push_back(record);
  if (settings.pulse != nullptr)
    settings.pulse->iterated(static_cast<int>(result.iterations.size()), record.force);
  const double size = residual_size();
  const bool done = is_in_equilibrium(record);
  if (done || size <= best) result.worst = measures.worst(residual);
  best = std::min(best, size);
  if (!done) return false;
  const std::span<const FieldMeasure> fields = measures.measured();
  result.force_left = fields.size() == 1 ? record.force : 0.0;
  for (std::size_t f = 0; fields.size() > 1 && f < fields.size(); ++f)
    if (!criterion.is_even(fields[f], static_cast<int>(f), measures))
      result.force_left = std::max(result.force_left, fields[f].record.force);
  result.outcome = StepOutcome::converged;
  return true;
}

}  // namespace sage
