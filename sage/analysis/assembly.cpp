#include "sage/analysis/assembly.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/loads.hpp"
#include "sage/analysis/path_error.hpp"
#include "sage/analysis/shown_status.hpp"
#include "sage/analysis/step_iteration.hpp"
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

// What was at this load factor stays.
void take_followed_edges(GroupData& data, std::vector<FollowedEdge> edges, double t) {
  const std::vector<FollowedEdge> last = std::exchange(data.followed, std::move(edges));
  for (FollowedEdge& edge : data.followed) {
    const auto old = std::ranges::find_if(last, [&](const FollowedEdge& other) {
      return other.element == edge.element && other.end.edge == edge.end.edge;
    });
    const EdgeTraction none, &start = old == last.end() ? none : old->start,
                             &end = old == last.end() ? none : old->end;
    const auto start_of = [t](const Vector2& from, const Vector2& to, const Vector2& now_to) -> Vector2 {
      return ((1.0 - t) * from + t * to - t * now_to) / (1.0 - t);
    };
    edge.start.normal = start_of(start.normal, end.normal, edge.end.normal);
    edge.start.shear = start_of(start.shear, end.shear, edge.end.shear);
  }
}

}  // namespace

bool all_finite(const FieldSums& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

FieldSums scales_of(const FieldSums& a, const FieldSums& b) {
  FieldSums scales{};
  for (std::size_t f = 0; f < scales.size(); ++f) scales[f] = std::sqrt(a[f] + b[f]);
  return scales;
}

Assembly::Assembly(const Model& model, const Scene& scene, WorkCounters& work, const Prepare& prepare)
    : model_(&model), scene_(&scene), work_(&work), dof_map_(model), element_(model, !scene.linear) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    GroupData data(model.groups[g]);
    data.law = model.material_of(model.groups[g]).law_ref();
    data.second_law = model.second_law_of(model.groups[g]);
    data.wants_context = wants_context(data.law);
    data.sees_spread = sees_spread_loads(*data.group, data.law);
    eases_ = eases_ || (data.wants_context && data.group->flow());
    wants_step_time_ = wants_step_time_ || data.wants_context || data.sees_spread ||
                       data.group->element->traits().sees_unknowns;
    list_dofs(data, dof_map_);
    if (prepare) prepare(data, g);
    groups_.push_back(std::move(data));
    reset_group(g);
  }
  internal_.setZero(dof_map_.dofs());
}

void Assembly::set_step_time(const StepTime& step_time) {
  element_.set_step_time(step_time);
  if (step_time.stage == spread_stage_) return;
  spread_stage_ = step_time.stage;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].group->element->traits().large_strain)
      groups_[g].followed = followed_edges(*model_, step_time.stage - 1, static_cast<int>(g));
    if (!groups_[g].sees_spread) continue;
    groups_[g].spread_start = spread_loads(*model_, step_time.stage - 2, g);
    groups_[g].spread_end = spread_loads(*model_, step_time.stage - 1, g);
  }
}

void Assembly::take_spread_loads(double load_factor) {
  const double t = load_factor;
  for (std::size_t g = 0; g < groups_.size() && spread_stage_ > 0; ++g)
    if (groups_[g].group->element->traits().large_strain)
      take_followed_edges(groups_[g], followed_edges(*model_, spread_stage_ - 1, static_cast<int>(g)), t);
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
  }
}

void Assembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].active = activity.group[g] != 0;
    if (groups_[g].active) mark_moved(groups_[g], rate);
  }
  equations_.number(*model_, activity);
  number_elements();
}

const EliminatedDofs& Assembly::eliminated() const {
  static const EliminatedDofs none{};
  return none;
}

void Assembly::number_elements() {
  elements_ = 0;
  for (GroupData& data : groups_) {
    if (!in_system(data)) continue;
    data.first_element = elements_;
    elements_ += data.group->elements();
  }
}

ElementEquations Assembly::element_equations() const {
  ElementEquations list;
  std::size_t terms = 0;
  for (const GroupData& data : groups_)
    if (in_system(data)) terms += static_cast<std::size_t>(data.group->elements()) * data.dofs();
  list.equations.reserve(terms);
  list.offset.reserve(static_cast<std::size_t>(elements_) + 1);
  for (const GroupData& data : groups_)
    if (in_system(data)) append_equations(data, equations_.of_dofs(), list);
  if (model_->has_pores())
    for (int eq = 0; eq < equations(); ++eq) {
      const auto field = static_cast<std::size_t>(dof_map_.at(dof_of(eq)).field);
      list.pressure.push_back(model_->unknowns[field].of_pores ? 1 : 0);
    }
  return list;
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

void Assembly::exchange(Archive& archive, bool before_step) {
  for (GroupData& data : groups_) exchange_states(data, archive, before_step);
}

void Assembly::exchange_states(GroupData& data, Archive& archive, bool before_step) {
  const bool trial = before_step && data.active && !data.constant && !archive.reading();
  PointStates& states = trial ? data.state.trial : data.state.committed;
  archive(states.sigma);
  archive(states.eps);
  archive(states.h);
  archive(states.status);
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

}  // namespace sage
