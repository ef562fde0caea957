#include "sage/analysis/skips/condensed_assembly.hpp"

#include "sage/analysis/skips/condensed_step.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

void CondensedAssembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  condensation_.reset();
  region_step_ = RegionStep::open;
  AssemblyByRegions::enter_stage(activity, rate);
}

void CondensedAssembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate, int increments,
                                    const SolverMaker& make) {
  enter_stage(activity, rate);
  Profile::Scope scope(work_->profile, phase::kCondensation);
  condensation_ =
      condense_if_it_pays(groups_, equations_.dofs(), dof_map_.dofs(), increments, scene_->symmetric, make);
  if (!condensation_) return;
  rate_ = rate;
  const FactorReport report = condensation_->matrix().report();
  scope.add_operations(report.factor_operations);
  work_->condensed = condensation_->matrix().condensed();
  work_->twin_equations = std::max(work_->twin_equations, long{report.repeated_equations});
  equations_.keep(condensation_->matrix().kept());
  number_elements();
}

void CondensedAssembly::set_stage_loads(const Eigen::VectorXd& loads) {
  const Profile::Scope scope(work_->profile, phase::kCondensation);
  if (condensation_) condensation_->begin_stage(loads, rate_, constant_.sums()[0]);
}

ElementEquations CondensedAssembly::element_equations() const {
  ElementEquations list = Assembly::element_equations();
  if (!condensation_) return list;
  for (int eq = 0; eq < equations(); ++eq) list.equations.push_back(eq);
  list.offset.push_back(static_cast<std::int64_t>(list.equations.size()));
  return list;
}

const EliminatedDofs& CondensedAssembly::eliminated() const {
  return condensation_ ? *condensation_ : Assembly::eliminated();
}

void CondensedAssembly::fill(Tangent& tangent) const {
  AssemblyByRegions::fill(tangent);
  if (condensation_) tangent.add(elements_, condensation_->matrix().S().data());
}

void CondensedAssembly::add_constant(const Eigen::VectorXd& du, Eigen::VectorXd& to) {
  if (!is_behind()) return AssemblyByRegions::add_constant(du, to);
  motion_ = du;
  condensation_->add_motion(motion_);
  AssemblyByRegions::add_constant(motion_, to);
}

Outcome CondensedAssembly::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  const bool behind = is_behind() && region_step_ != RegionStep::filled_in;
  const bool by_border = behind || region_step_ == RegionStep::waits;
  return by_border ? evaluate_with_border(du, tangent) : AssemblyByRegions::evaluate(du, tangent);
}

// The force scale of the constant region is that of the last whole evaluation.
Outcome CondensedAssembly::evaluate_with_border(const Eigen::VectorXd& du, Tangent* tangent) {
  const Profile::Scope scope(work_->profile, phase::kAssembly);
  const Outcome outcome = evaluate_changing(du, tangent);
  if (tangent != nullptr) tangent->settle(outcome);
  if (outcome == Outcome::cut_step) return outcome;
  internal_ = changing_.forces();
  condensation_->add_forces(du, internal_);
  force_scale_ = scales_of(changing_.sums(), constant_.sums());
  return Outcome::ok;
}

void CondensedAssembly::commit_again(const Eigen::VectorXd& du) {
  commit_changing();
  if (region_step_ == RegionStep::waits)
    return condensation_->predictor().accept_border(condensation_->matrix().kept(), du);
  commit_constant();
  if (region_step_ == RegionStep::filled_in) condensation_->predictor().accept_whole(constant_.sums()[0]);
}

void CondensedAssembly::commit(const Eigen::VectorXd& du) {
  if (region_step_ == RegionStep::waits) ++work_->border_steps;
  AssemblyByRegions::commit(du);
}

void CondensedAssembly::exchange(Archive& archive, bool before_step) {
  const bool condensed = before_step && condensation_ != nullptr;
  if (condensed) {
    archive(region_step_);
    condensation_->predictor().exchange(archive);
    FieldSums sums = constant_.sums();
    archive(sums);
    constant_.set_sums(sums);
  }
  AssemblyByRegions::exchange(archive, before_step);
  if (condensed && archive.reading()) take_constant_force();
}

void CondensedAssembly::take_constant_force() {
  constant_force_.setZero(dof_map_.dofs());
  constant_.add_committed_forces(constant_force_);
}

// forces: of all elements there.
void CondensedAssembly::fill_in(Eigen::VectorXd& du, Eigen::VectorXd& forces) {
  constexpr int kSteps = 3;
  condensation_->complete(du);
  add_constant(du, forces);
  double residual = condensation_->largest_residual(forces);
  for (int i = 0; i < kSteps && residual > kRegionRounding * force_scale(0); ++i) {
    condensation_->refine(forces, du);
    add_constant(du, forces);
    const double last = std::exchange(residual, condensation_->largest_residual(forces));
    if (residual > 0.5 * last) break;
  }
}

void CondensedAssembly::catch_up(const Eigen::VectorXd& target, double load_factor,
                                 const Eigen::VectorXd& start, Eigen::VectorXd& u) {
  Eigen::VectorXd du = Eigen::VectorXd::Zero(u.size());
  CondensedStep(*this, target, 0.0, {load_factor, &start, &u}).complete(du);
  commit_constant();
  condensation_->predictor().accept_whole(constant_.sums()[0]);
  drop_step();
  deferred_.move(du);
  u += du;
}

void CondensedAssembly::show_recovered(Eigen::VectorXd& motion, Eigen::VectorXd& forces) {
  const Profile::Scope scope(work_->profile, phase::kCondensation);
  const FieldSums scale = force_scale_, sums = constant_.sums();
  motion.setZero(dof_map_.dofs());
  fill_in(motion, forces);
  force_scale_ = scale;
  constant_.set_sums(sums);
}

void CondensedAssembly::recover_states_at(const Eigen::VectorXd& motion) {
  deferred_.move(motion);
  recover_states();
  deferred_.move(-motion);
}

std::unique_ptr<IteratedStep> CondensedAssembly::begin_step(const Eigen::VectorXd& target, double rate_part,
                                                            const StageSoFar& so_far) {
  if (!condensation_) return Assembly::begin_step(target, rate_part, so_far);
  return std::make_unique<CondensedStep>(*this, target, rate_part, so_far);
}

}  // namespace sage
