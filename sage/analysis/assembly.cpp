#include "sage/analysis/assembly.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/kept_matrices.hpp"
#include "sage/analysis/path_error.hpp"
#include "sage/analysis/shown_status.hpp"
#include "sage/analysis/tangent.hpp"
#include "sage/model/spread_loads.hpp"

namespace sage {

namespace {

template <int N>
void initialise(const Law<N>& law, const double* sigma, std::span<double> h) {
  law.initialise(Eigen::Map<const Vector<N>>(sigma), h);
}

// Dofs and fields of elements with unknowns of their own.
void list_dofs(GroupData& data, const DofMap& dof_map) {
  if (data.group->entry->unknowns.empty()) return;
  std::vector<int> dofs;
  for (int e = 0; e < data.group->elements(); ++e) {
    dof_map.list(*data.group, e, dofs);
    if (dofs.size() != data.dofs())
      throw std::logic_error(data.group->element_name + ": its entry lists " + std::to_string(dofs.size()) +
                             " unknowns, its traits have " + std::to_string(data.dofs()) + " dofs");
    data.dof_list.insert(data.dof_list.end(), dofs.begin(), dofs.end());
  }
  for (const int dof : dofs) data.field_of_dof.push_back(dof_map.at(dof).field);
}

// Which elements the prescribed motion of a stage reaches.
void mark_moved(GroupData& data, const Eigen::VectorXd& rate) {
  const auto elements = static_cast<std::size_t>(data.group->elements());
  data.moved.assign(elements, 0);
  for (std::size_t e = 0; e < elements; ++e) {
    const ElementDofs dofs = data.dofs_of(static_cast<int>(e));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (rate[dofs[i]] != 0.0) data.moved[e] = 1;
  }
}

// Interfaces pressed by their mean pressure, structures without force.
void make_elastic(GroupData& data) {
  PointStates& states = data.state.committed;
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const auto size = static_cast<std::size_t>(data.state.law_size());
  double pressure = 0.0;
  for (std::size_t p = 0; data.group->interface() && p < states.status.size(); ++p)
    pressure += std::abs(states.sigma[p * size + 1]) / static_cast<double>(states.status.size());
  std::ranges::fill(states.sigma, 0.0);
  std::visit(
      [&](const auto* law) {
        const std::span<const Quantity> names = law->traits().history;
        for (std::size_t p = 0; p < states.status.size(); ++p) {
          if (data.group->interface()) states.sigma[p * size + 1] = pressure > 0.0 ? -pressure : -1.0;
          for (std::size_t i = 0; i < history; ++i) states.h[p * history + i] = names[i].initial;
          initialise(*law, states.sigma.data() + p * size, {states.h.data() + p * history, history});
        }
      },
      data.law);
}

bool all_finite(const FieldSums& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

FieldSums scales_of(const FieldSums& a, const FieldSums& b) {
  FieldSums scales{};
  for (std::size_t f = 0; f < scales.size(); ++f) scales[f] = std::sqrt(a[f] + b[f]);
  return scales;
}

}  // namespace

Assembly::Assembly(const Model& model, const Scene& scene, const Skips& skips, WorkCounters& work)
    : model_(&model),
      scene_(&scene),
      skips_(skips),
      work_(&work),
      dof_map_(model),
      element_(model, !scene.linear),
      changing_(groups_, element_, work),
      constant_(model, groups_, element_, work),
      deferred_(std::ranges::any_of(model.groups, &Group::structure)) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    GroupData data(model.groups[g]);
    data.law = model.material_of(model.groups[g]).law_ref();
    data.second_law = model.second_law_of(model.groups[g]);
    data.wants_context = wants_context(data.law);
    data.sees_spread = sees_spread_loads(*data.group, data.law);
    eases_ = eases_ || (data.wants_context && data.group->flow());
    wants_step_time_ = wants_step_time_ || data.wants_context || data.sees_spread ||
                       data.group->element->traits().sees_unknowns;
    data.constant =
        scene.group_linear[g] != 0 && skips.elements && ConstantRegion::suits(*data.group, data.law);
    list_dofs(data, dof_map_);
    find_fours(data);
    groups_.push_back(std::move(data));
    reset_group(g);
  }
  internal_.setZero(dof_map_.dofs());
  if (!std::ranges::all_of(groups_, &GroupData::constant)) changing_.size_forces(dof_map_.dofs());
}

void Assembly::set_step_time(const StepTime& step_time) {
  element_.set_step_time(step_time);
  if (step_time.stage == spread_stage_) return;
  spread_stage_ = step_time.stage;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (!groups_[g].sees_spread) continue;
    groups_[g].spread_start = spread_loads(*model_, step_time.stage - 2, g);
    groups_[g].spread_end = spread_loads(*model_, step_time.stage - 1, g);
  }
}

void Assembly::take_spread_loads(double load_factor) {
  const double t = load_factor;
  for (std::size_t g = 0; g < groups_.size() && spread_stage_ > 0; ++g) {
    if (!groups_[g].sees_spread) continue;
    std::vector<double>&start = groups_[g].spread_start, &end = groups_[g].spread_end;
    const std::vector<double> last = std::exchange(end, spread_loads(*model_, spread_stage_ - 1, g));
    const std::size_t size = std::max({start.size(), last.size(), end.size()});
    for (std::vector<double>* list : {&start, &end}) list->resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      const double now = (1.0 - t) * start[i] + (i < last.size() ? t * last[i] : 0.0);
      start[i] = (now - t * end[i]) / (1.0 - t);
    }
  }
}

bool Assembly::sees_unknowns() const {
  return std::ranges::any_of(groups_,
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

void Assembly::reset_group(std::size_t group) {
  GroupData& data = groups_[group];
  const ElementTraits& traits = data.group->element->traits();
  data.state = StateStore(static_cast<std::size_t>(data.group->elements() * traits.points), traits.law_size,
                          history_of(data.law, traits), !data.constant);
}

void Assembly::take_laws() {
  for (GroupData& data : groups_) {
    data.law = model_->material_of(*data.group).law_ref();
    data.second_law = model_->second_law_of(*data.group);
    data.step_of_matrices = {};
    find_fours(data);
    std::ranges::fill(data.constant_four_abreast, char{0});
  }
}

// What moved so far concerns the groups that were active then.
bool Assembly::constant_groups_change(const Activity& activity) const {
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].constant && groups_[g].active != (activity.group[g] != 0)) return true;
  return false;
}

void Assembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  if (deferred_.behind() && constant_groups_change(activity)) recover_states();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].active = activity.group[g] != 0;
    if (!groups_[g].active) continue;
    make_room_for_matrices(g);
    mark_moved(groups_[g], rate);
  }
  equations_.number(*model_, activity);
  condensation_.reset();
  region_step_ = RegionStep::open;
  number_elements();
}

void Assembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate, int increments,
                           const SolverMaker& make) {
  enter_stage(activity, rate);
  if (!skips_.condensation || scene_->linear || !dof_map_.only_displacement()) return;
  Profile::Scope scope(work_->profile, phase::kCondensation);
  condensation_ =
      condense_if_it_pays(groups_, equations_.dofs(), dof_map_.dofs(), increments, scene_->symmetric, make);
  if (!condensation_) return;
  rate_ = rate;
  scope.add_operations(condensation_->report().factor_operations);
  work_->condensed = condensation_->condensed();
  work_->twin_equations = std::max(work_->twin_equations, long{condensation_->repeated_equations()});
  equations_.keep(condensation_->kept());
  number_elements();
}

void Assembly::set_stage_loads(const Eigen::VectorXd& loads) {
  const Profile::Scope scope(work_->profile, phase::kCondensation);
  if (condensation_) condensation_->begin_stage(loads, rate_, constant_.sums()[0]);
}

void Assembly::make_room_for_matrices(std::size_t group) {
  GroupData& data = groups_[group];
  if (data.keeps_matrices() || data.group->elements() == 0) return;
  if (data.constant)
    constant_.make_matrices(data, scene_->shapes[group]);
  else if (skips_.factors && !scene_->linear)
    keep_matrices(data);
}

void Assembly::number_elements() {
  elements_ = 0;
  for (GroupData& data : groups_) {
    if (!in_system(data)) continue;
    data.first_element = elements_;
    elements_ += data.group->elements();
  }
  if (condensation_) ++elements_;
}

ElementEquations Assembly::element_equations() const {
  ElementEquations list;
  std::size_t terms = 0;
  for (const GroupData& data : groups_)
    if (in_system(data)) terms += static_cast<std::size_t>(data.group->elements()) * data.dofs();
  list.equations.reserve(terms + (condensation_ ? equations_.dofs().size() : 0));
  list.offset.reserve(static_cast<std::size_t>(elements_) + 1);
  for (const GroupData& data : groups_)
    if (in_system(data)) append_equations(data, equations_.of_dofs(), list);
  if (model_->has_pores())
    for (int eq = 0; eq < equations(); ++eq) {
      const auto field = static_cast<std::size_t>(dof_map_.at(dof_of(eq)).field);
      list.pressure.push_back(model_->unknowns[field].of_pores ? 1 : 0);
    }
  if (!condensation_) return list;
  for (int eq = 0; eq < equations(); ++eq) list.equations.push_back(eq);
  list.offset.push_back(static_cast<std::int64_t>(list.equations.size()));
  return list;
}

// All matrices that are kept (those of other groups are added as they are made).
void Assembly::fill(Tangent& tangent) const {
  for (const GroupData& data : groups_) {
    if (!in_system(data) || !data.keeps_matrices()) continue;
    if (!data.constant) {
      changing_.add_kept(data, tangent);
      continue;
    }
    for (int e = 0; e < data.group->elements(); ++e) {
      element_.stop_if_asked_at(e);
      add_matrix(data, e, data.matrix_of(e), tangent);
    }
  }
  if (condensation_) tangent.add(elements_ - 1, condensation_->S().data());
}

// Forces and matrices of the groups that are not constant, and all kept matrices into the tangent.
Outcome Assembly::evaluate_changing(const Eigen::VectorXd& du, Tangent* tangent) {
  ++(tangent != nullptr ? work_->assemblies : work_->residuals);
  const auto elements = [&] { return changing_.evaluate(du, tangent); };
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

// to: forces of all elements.
void Assembly::add_constant(const Eigen::VectorXd& du, Eigen::VectorXd& to) {
  if (changing_.forces().size() > 0)
    to = changing_.forces();
  else
    to.setZero(dof_map_.dofs());
  if (region_is_behind()) {
    motion_ = du;
    condensation_->add_motion(motion_);
    constant_.add_forces(motion_, to);
  } else {
    constant_.add_forces(du, to);
  }
  force_scale_ = scales_of(changing_.sums(), constant_.sums());
}

Outcome Assembly::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  const bool behind = region_is_behind() && region_step_ != RegionStep::filled_in;
  if (behind || region_step_ == RegionStep::waits) return evaluate_with_border(du, tangent);
  const Profile::Scope scope(work_->profile, phase::kAssembly);
  Outcome outcome = evaluate_changing(du, tangent);
  if (outcome == Outcome::ok) {
    add_constant(du, internal_);
    if (!all_finite(force_scale_)) outcome = Outcome::cut_step;
  }
  if (tangent != nullptr) tangent->settle(outcome);
  return outcome;
}

Outcome Assembly::evaluate_elastic(Tangent& tangent) {
  std::vector<PointStates> committed;
  for (GroupData& data : groups_) {
    committed.push_back(data.state.committed);
    if (data.active && !data.constant && !data.group->solid() && !data.group->flow()) make_elastic(data);
  }
  const Outcome outcome = evaluate(Eigen::VectorXd::Zero(dof_map_.dofs()), &tangent);
  for (std::size_t g = 0; g < groups_.size(); ++g) std::swap(groups_[g].state.committed, committed[g]);
  return outcome;
}

// The force scale of the constant region is that of the last whole evaluation.
Outcome Assembly::evaluate_with_border(const Eigen::VectorXd& du, Tangent* tangent) {
  const Profile::Scope scope(work_->profile, phase::kAssembly);
  const Outcome outcome = evaluate_changing(du, tangent);
  if (tangent != nullptr) tangent->settle(outcome);
  if (outcome == Outcome::cut_step) return outcome;
  internal_ = changing_.forces();
  condensation_->add_forces(du, internal_);
  force_scale_ = scales_of(changing_.sums(), constant_.sums());
  return Outcome::ok;
}

double Assembly::path_error() const {
  return scene_->linear ? 0.0
                        : mean_path_error(model_->mesh, groups_, scene_->group_linear, element_.step_time());
}

void Assembly::commit_again(const Eigen::VectorXd& du) {
  for (GroupData& data : groups_)
    if (data.active && !data.constant) data.state.commit();
  if (region_step_ == RegionStep::waits)
    condensation_->accept_border(du);
  else
    commit_constant();
}

// Of constant groups, of which a step has the forces.
void Assembly::commit_constant() {
  for (GroupData& data : groups_)
    if (data.active && data.constant) std::swap(data.force, data.trial_force);
  if (region_step_ == RegionStep::filled_in) condensation_->accept_whole(constant_.sums()[0]);
}

void Assembly::commit(const Eigen::VectorXd& du) {
  if (region_step_ == RegionStep::waits) ++work_->border_steps;
  commit_again(du);
  const bool constant =
      std::ranges::any_of(groups_, [](const GroupData& data) { return data.active && data.constant; });
  if (!constant) return;
  deferred_.move(du);
  if (!skips_.states) recover_states();
}

void Assembly::exchange(Archive& archive, bool before_step) {
  const bool condensed = before_step && condensation_ != nullptr;
  if (condensed) {
    archive(region_step_);
    condensation_->exchange(archive);
    FieldSums sums = constant_.sums();
    archive(sums);
    constant_.set_sums(sums);
  }
  const bool forces_before = before_step && region_step_ != RegionStep::waits;
  for (GroupData& data : groups_) {
    const bool trial = before_step && data.active && !data.constant && !archive.reading();
    PointStates& states = trial ? data.state.trial : data.state.committed;
    archive(states.sigma);
    archive(states.eps);
    archive(states.h);
    archive(states.status);
    if (data.constant)
      archive(forces_before && data.active && !archive.reading() ? data.trial_force : data.force);
  }
  deferred_.exchange(archive);
  if (condensed && archive.reading()) take_constant_force();
}

void Assembly::take_constant_force() {
  constant_force_.setZero(dof_map_.dofs());
  constant_.add_committed_forces(constant_force_);
}

std::array<long, kStatuses> Assembly::count_points() const {
  std::array<long, kStatuses> counts{};
  for (const GroupData& data : groups_) {
    if (!data.active) continue;
    for (std::size_t p = 0; p < data.state.committed.status.size(); ++p)
      ++counts[static_cast<std::size_t>(shown_status(model_->mesh, data, p))];
  }
  return counts;
}

namespace {

// What one solution leaves of the forces is rounding, times the stiffness ratio within the region.
constexpr double kRounding = 1e-14;

}  // namespace

IteratedStep::IteratedStep(Assembly& assembly, const Eigen::VectorXd& target, double rate_part,
                           const StageSoFar& so_far)
    : assembly_(&assembly), region_(assembly.condensation_.get()) {
  if (region_ == nullptr) return;
  const Profile::Scope scope(assembly.work_->profile, phase::kCondensation);
  assembly.region_step_ = Assembly::RegionStep::open;
  if (!region_->predictor().is_behind()) assembly.take_constant_force();
  region_->begin_step(rate_part, so_far, target, assembly.constant_force_, kRounding * assembly.force_scale(0));
  assembly.internal_ = assembly.changing_.forces();
  region_->add_start_forces(assembly.internal_);
}

Outcome IteratedStep::iterate(const Eigen::VectorXd& du, Tangent* tangent) {
  return region_ == nullptr ? assembly_->evaluate(du, tangent) : assembly_->evaluate_with_border(du, tangent);
}

void IteratedStep::complete(Eigen::VectorXd& du) {
  if (region_ == nullptr) return;
  Assembly& all = *assembly_;
  const Profile::Scope scope(all.work_->profile, phase::kCondensation);
  all.fill_in(du, all.internal_);
  region_->set_base(all.internal_, all.changing_.forces(), du);
  all.region_step_ = Assembly::RegionStep::filled_in;
}

bool IteratedStep::must_fill_in() const {
  if (region_ == nullptr) return false;
  const bool is_filled_in = assembly_->region_step_ == Assembly::RegionStep::filled_in;
  return is_filled_in || !assembly_->skips_.states || !region_->predictor().may_wait();
}

bool IteratedStep::wait(const Eigen::VectorXd& du, double out_of_balance, double limit) {
  constexpr double kFarBelow = 1e-3;
  if (region_ == nullptr || must_fill_in()) return false;
  Assembly& all = *assembly_;
  const double most = limit * std::sqrt(all.changing_.sums()[0] + region_->predictor().least_force_squares());
  if (!(out_of_balance <= most) || !(region_->rounding(du) <= kFarBelow * most)) return false;
  all.region_step_ = Assembly::RegionStep::waits;
  return true;
}

double IteratedStep::whole_norm(const Eigen::VectorXd& correction) {
  return region_ != nullptr ? region_->whole_norm(correction) : correction.norm();
}

// forces: of all elements there.
void Assembly::fill_in(Eigen::VectorXd& du, Eigen::VectorXd& forces) {
  constexpr int kSteps = 3;
  condensation_->complete(du);
  add_constant(du, forces);
  double residual = condensation_->largest_residual(forces);
  for (int i = 0; i < kSteps && residual > kRounding * force_scale(0); ++i) {
    condensation_->refine(forces, du);
    add_constant(du, forces);
    const double last = std::exchange(residual, condensation_->largest_residual(forces));
    if (residual > 0.5 * last) break;
  }
}

void Assembly::catch_up(const Eigen::VectorXd& target, double share, const Eigen::VectorXd& start,
                        Eigen::VectorXd& u) {
  Eigen::VectorXd du = Eigen::VectorXd::Zero(u.size());
  IteratedStep(*this, target, 0.0, {share, &start, &u}).complete(du);
  commit_constant();
  drop_step();
  deferred_.move(du);
  u += du;
}

void Assembly::show_region(Eigen::VectorXd& motion, Eigen::VectorXd& forces) {
  const Profile::Scope scope(work_->profile, phase::kCondensation);
  const FieldSums scale = force_scale_, sums = constant_.sums();
  motion.setZero(dof_map_.dofs());
  fill_in(motion, forces);
  force_scale_ = scale;
  constant_.set_sums(sums);
}

void Assembly::recover_states_at(const Eigen::VectorXd& motion) {
  deferred_.move(motion);
  recover_states();
  deferred_.move(-motion);
}

}  // namespace sage
