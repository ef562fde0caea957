#include "sage/analysis/skips/assembly_by_regions.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/congruent.hpp"
#include "sage/analysis/skips/kept_matrices.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

AssemblyByRegions::AssemblyByRegions(const Model& model, const Scene& scene, const Skips& skips,
                                     WorkCounters& work)
    : Assembly(model, scene, work,
               [&](GroupData& data, std::size_t g) {
                 const bool in_step = skips.elements && ConstantRegion::suits_in_step(model, data);
                 data.constant = in_step || (scene.group_linear[g] != 0 && skips.elements &&
                                             ConstantRegion::suits(*data.group, data.law));
                 find_fours(data);
               }),
      skips_(skips),
      changing_(groups_, element_, work),
      constant_(model, groups_, element_, work),
      deferred_(std::ranges::any_of(model.groups, &Group::structure), constant_.any_flows()) {
  if (!std::ranges::all_of(groups_, &GroupData::constant)) changing_.size_forces(dof_map_.dofs());
}

void AssemblyByRegions::set_threads(int threads) {
  Assembly::set_threads(threads);
  changing_.set_threads(threads);
  constant_.set_threads(threads);
}

void AssemblyByRegions::take_laws() {
  Assembly::take_laws();
  for (GroupData& data : groups_) {
    data.step_of_matrices = {};
    find_fours(data);
    std::ranges::fill(data.constant_four_abreast, char{0});
  }
}

bool AssemblyByRegions::begin_states(bool any) {
  if (!deferred_.behind()) return true;
  if (!any) return false;  // the forces of constant groups stay
  recover_states();
  return true;
}

// What moved so far concerns the groups that were active then.
bool AssemblyByRegions::constant_groups_change(const Activity& activity) const {
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].constant && groups_[g].active != (activity.group[g] != 0)) return true;
  return false;
}

void AssemblyByRegions::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  if (deferred_.behind() && constant_groups_change(activity)) recover_states();
  Assembly::enter_stage(activity, rate);
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].active) make_room_for_matrices(g);
}

void AssemblyByRegions::make_room_for_matrices(std::size_t group) {
  GroupData& data = groups_[group];
  if (data.keeps_matrices() || data.group->elements() == 0) return;
  if (data.constant)
    constant_.make_matrices(data, constant_.flows(data) ? shapes_of(model_->mesh, *data.group, model_->geometry)
                                                        : scene_->shapes[group]);
  else if (skips_.factors && !scene_->linear)
    keep_matrices(data);
}

void AssemblyByRegions::fill(Tangent& tangent) const {
  for (const GroupData& data : groups_) {
    if (!in_system(data) || !data.keeps_matrices()) continue;
    if (!data.constant) {
      changing_.add_kept(data, tangent);
      continue;
    }
    std::vector<double> room(data.matrix_size());
    for (int e = 0; e < data.group->elements(); ++e) {
      element_.stop_if_asked_at(e);
      add_matrix(data, e, constant_.matrix_of(data, e, room.data()), tangent);
    }
  }
}

Outcome AssemblyByRegions::evaluate_changing(const Eigen::VectorXd& du, Tangent* tangent) {
  ++(tangent != nullptr ? work_->assemblies : work_->residuals);
  const auto elements = [&] {
    if (tangent != nullptr && constant_.take_step()) tangent->differs();
    return changing_.evaluate(du, tangent);
  };
  Outcome outcome = Outcome::ok;
  if (tangent != nullptr) {
    const bool all_kept = std::ranges::all_of(groups_, [](const GroupData& data) {
      return !data.active || data.group->elements() == 0 || data.keeps_matrices();
    });
    outcome = tangent->assemble(all_kept, elements, [&] { fill(*tangent); });
  } else {
    outcome = elements();
  }
  return outcome == Outcome::ok && all_finite(changing_.sums()) ? Outcome::ok : Outcome::cut_step;
}

void AssemblyByRegions::add_constant(const Eigen::VectorXd& du, Eigen::VectorXd& to) {
  if (changing_.forces().size() > 0)
    to = changing_.forces();
  else
    to.setZero(dof_map_.dofs());
  constant_.add_forces(du, to);
  force_scale_ = scales_of(changing_.sums(), constant_.sums());
}

Outcome AssemblyByRegions::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  const Profile::Scope scope(work_->profile, phase::kAssembly);
  Outcome outcome = evaluate_changing(du, tangent);
  if (outcome == Outcome::ok) {
    add_constant(du, internal_);
    if (!all_finite(force_scale_)) outcome = Outcome::cut_step;
  }
  if (tangent != nullptr) tangent->settle(outcome);
  return outcome;
}

void AssemblyByRegions::commit_changing() {
  for (GroupData& data : groups_)
    if (data.active && !data.constant) data.state.commit();
}

// Of constant groups, of which a step has the forces.
void AssemblyByRegions::commit_constant() {
  for (GroupData& data : groups_)
    if (data.active && data.constant) std::swap(data.force, data.trial_force);
}

void AssemblyByRegions::commit_again(const Eigen::VectorXd& du) {
  commit_changing();
  commit_constant();
  constant_.commit(du);
}

void AssemblyByRegions::commit(const Eigen::VectorXd& du) {
  commit_again(du);
  const bool constant =
      std::ranges::any_of(groups_, [](const GroupData& data) { return data.active && data.constant; });
  if (!constant) return;
  deferred_.move(du, constant_.before_commit(), element_.step_time());
  if (!skips_.states) recover_states();
}

void AssemblyByRegions::exchange(Archive& archive, bool before_step) {
  const bool tried = before_step && has_constant_forces();
  for (GroupData& data : groups_) {
    exchange_states(data, archive, before_step);
    if (data.constant) archive(tried && data.active && !archive.reading() ? data.trial_force : data.force);
  }
  deferred_.exchange(archive);
  constant_.exchange(archive, before_step);
}

}  // namespace sage
