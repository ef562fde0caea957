#include "sage/analysis/assembly.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/element_loads.hpp"
#include "sage/analysis/path_error.hpp"
#include "sage/analysis/step_iteration.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

bool all_finite(const FieldSums& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

FieldSums scales_of(const FieldSums& a, const FieldSums& b) {
  FieldSums scales{};
  for (std::size_t f = 0; f < scales.size(); ++f) scales[f] = std::sqrt(a[f] + b[f]);
  return scales;
}

Assembly::Assembly(const Model& model, const Scene& scene, WorkCounters& work, const Prepare& prepare)
    : StageGroups(model, scene, prepare), work_(&work), element_(model, !scene.linear) {
  for (const GroupData& data : groups_) {
    eases_ = eases_ || (data.wants_context && data.group->flow());
    wants_step_time_ = wants_step_time_ || data.wants_context || data.sees_spread ||
                       data.group->element->traits().sees_unknowns;
  }
  internal_.setZero(dof_map_.dofs());
}

void Assembly::set_step_time(const StepTime& step_time) {
  element_.set_step_time(step_time);
  if (step_time.stage == loads_stage_) return;
  loads_stage_ = step_time.stage;
  begin_element_loads(*model_, loads_stage_ - 1, groups_);
}

void Assembly::take_element_loads(double load_factor) {
  if (loads_stage_ > 0) change_element_loads(*model_, loads_stage_ - 1, load_factor, groups_);
}

bool sees_unknowns(const Assembly& assembly) {
  return std::ranges::any_of(assembly.groups(),
                             [](const GroupData& data) { return data.group->element->traits().sees_unknowns; });
}

bool water_flows(const Assembly& assembly) {
  return assembly.step_time().flow_dt > 0.0 &&
         std::ranges::any_of(assembly.groups(),
                             [](const GroupData& data) { return data.group->entry->has_pores(); });
}

bool linear_in_step(const Assembly& assembly) {
  for (std::size_t g = 0; g < assembly.groups().size(); ++g)
    if (assembly.groups()[g].active && assembly.scene().group_linear[g] == 0 &&
        !has_matrix_of_step(assembly.groups()[g]))
      return false;
  return true;
}

const EliminatedDofs& Assembly::eliminated() const {
  static const EliminatedDofs none{};
  return none;
}

Outcome Assembly::evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent,
                                 FieldSums& sums) {
  double* const K = tangent != nullptr ? element_.K() : nullptr;
  for (int e = 0; e < data.group->elements(); ++e) {
    element_.stop_if_asked_at(e);
    if (element_.evaluate(data, e, &du, K) == Outcome::cut_step) return Outcome::cut_step;
    add_force(data, e, element_.f(), forces_, sums);
    if (tangent != nullptr) add_matrix(data, e, K, *tangent);
  }
  work_->element_evaluations += data.group->elements();
  return Outcome::ok;
}

// A pass that fails leaves the forces of the one before.
Outcome Assembly::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  const Profile::Scope scope(work_->profile, phase::kAssembly);
  ++(tangent != nullptr ? work_->assemblies : work_->residuals);
  FieldSums sums{};
  const auto elements = [&] {
    element_.begin_pass();
    forces_.setZero(dof_map_.dofs());
    for (GroupData& data : groups_)
      if (data.active && evaluate_group(data, du, tangent, sums) == Outcome::cut_step) return Outcome::cut_step;
    return Outcome::ok;
  };
  Outcome outcome = tangent != nullptr ? tangent->assemble(false, elements, [] {}) : elements();
  if (outcome == Outcome::ok && !all_finite(sums)) outcome = Outcome::cut_step;
  if (outcome == Outcome::ok) {
    internal_ = forces_;
    force_scale_ = scales_of(sums, {});
  }
  if (tangent != nullptr) tangent->settle(outcome);
  return outcome;
}

double Assembly::path_error() const {
  return scene_->linear ? 0.0
                        : mean_path_error(model_->mesh, groups_, scene_->group_linear, element_.step_time());
}

std::unique_ptr<IteratedStep> Assembly::begin_step(const Eigen::VectorXd& /*target*/, double /*rate_part*/,
                                                   const StageSoFar& /*so_far*/) {
  return std::make_unique<IteratedStep>(*this);
}

Outcome IteratedStep::iterate(const Eigen::VectorXd& du, Tangent* tangent) {
  return assembly_->evaluate(du, tangent);
}

IterationRecord IteratedStep::measure(StepIteration& step) {
  return step.measure();
}

void Assembly::commit_again(const Eigen::VectorXd& /*du*/) {
  for (GroupData& data : groups_)
    if (data.active) data.state.commit();
}

}  // namespace sage
