#include "sage/analysis/element_work.hpp"

#include <algorithm>

namespace sage {

ElementWork::ElementWork(const Model& model, bool keep_geometry)
    : model_(&model), keep_geometry_(keep_geometry) {
  std::size_t dofs = 0, geometry = 0, stresses = 0, contexts = 0;
  for (const Group& group : model.groups) {
    const ElementTraits& traits = group.element->traits();
    dofs = std::max(dofs, static_cast<std::size_t>(traits.dofs));
    geometry = std::max(geometry, static_cast<std::size_t>(traits.geometry_size()));
    stresses = std::max(stresses, static_cast<std::size_t>(traits.points * traits.law_size));
    if (wants_context(model.material_of(group).law_ref()))
      contexts = std::max(contexts, static_cast<std::size_t>(traits.points));
  }
  geometry_.resize(geometry);
  contexts_.resize(contexts);
  sigma_.resize(stresses);
  eps_.resize(stresses);
  no_stress_.assign(stresses, 0.0);
  K_.resize(dofs * dofs);
  f_.resize(dofs);
  du_.resize(dofs);
  u0_.resize(dofs);
  spread_.resize(2 * dofs);
  if (model.large_strain &&
      std::ranges::any_of(model.stages, [](const Stage& s) { return !s.pressures.empty(); }))
    load_change_.setZero(DofMap(model).dofs());
}

void ElementWork::stop_if_asked_at(int element) const {
  constexpr int kEvery = 256;
  if (element % kEvery == 0) stop_if_asked(stop_asked_);
}

bool ElementWork::keeps_geometry(const GroupData& data) const {
  return keep_geometry_ && !data.constant && !data.four_abreast();
}

void ElementWork::prepare(GroupData& data) {
  if (!keeps_geometry(data) || !data.geometry.empty()) return;
  const Group& group = *data.group;
  const auto size = static_cast<std::size_t>(group.element->traits().geometry_size());
  data.geometry.resize(size * static_cast<std::size_t>(group.elements()));
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(model_->mesh, group, e, x_);
    group.element->geometry(x_, {data.geometry.data() + static_cast<std::size_t>(e) * size, size});
  }
}

void ElementWork::go_on_from(const ElementWork& other) {
  stop_asked_ = other.stop_asked_;
  committed_ = other.committed_;
  step_time_ = other.step_time_;
}

const double* ElementWork::geometry_of(GroupData& data, int element) {
  const Group& group = *data.group;
  const auto size = static_cast<std::size_t>(group.element->traits().geometry_size());
  if (!keeps_geometry(data)) {
    element_coordinates(model_->mesh, group, element, x_);
    group.element->geometry(x_, {geometry_.data(), size});
    return geometry_.data();
  }
  prepare(data);
  return data.geometry.data() + static_cast<std::size_t>(element) * size;
}

const PointContext* ElementWork::contexts_of(const GroupData& data, int element) {
  element_coordinates(model_->mesh, *data.group, element, x_);
  for (int p = 0; p < data.group->element->traits().points; ++p)
    contexts_[p] = context_of(data, element, x_, p, step_time_);
  return contexts_.data();
}

Outcome ElementWork::evaluate(GroupData& data, int element, const Eigen::VectorXd* du, double* K) {
  const ElementTraits& traits = data.group->element->traits();
  const auto points = static_cast<std::size_t>(traits.points);
  const auto law_size = static_cast<std::size_t>(traits.law_size);
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const auto e = static_cast<std::size_t>(element);
  const ElementDofs dofs = data.dofs_of(element);
  if (du != nullptr)
    dofs.gather(*du, du_.data());
  else
    std::fill(du_.begin(), du_.end(), 0.0);
  const std::size_t at = e * points * law_size;
  ElementIn in;
  in.geometry = geometry_of(data, element);
  in.du = du_.data();
  in.law = data.law;
  in.second_law = data.second_law;
  in.four_law = data.four_law;
  const bool has_room = !data.state.committed.sigma.empty();
  in.sigma0 = has_room ? data.state.committed.sigma.data() + at : no_stress_.data();
  in.eps0 = has_room ? data.state.committed.eps.data() + at : no_stress_.data();
  in.h0 = data.state.committed.h.data() + e * points * history;
  if (data.wants_context) in.contexts = contexts_of(data, element);
  if (traits.sees_unknowns) {
    in.u0 = committed_of(dofs);
    in.dt = step_time_.dt;
    in.flow_dt = step_time_.flow_dt;
    in.theta = step_time_.theta;
  }
  if (traits.sees_coordinates) {
    element_coordinates(model_->mesh, *data.group, element, x_);
    in.x = x_.data();
  }
  if (data.sees_spread) {
    in.spread = spread_of(data, element, step_time_.load_factor, spread_.data());
    in.spread0 =
        spread_of(data, element, step_time_.load_factor - step_time_.share, spread_.data() + data.dofs());
  }
  if (!data.followed.empty()) in.edges = edges_of(data, element);
  if (!in.edges.empty()) load_.resize(data.dofs());
  ElementOut out;
  out.K = K;
  out.f = f_.data();
  out.sigma1 = data.constant ? sigma_.data() : data.state.trial.sigma.data() + at;
  out.eps1 = data.constant ? eps_.data() : data.state.trial.eps.data() + at;
  out.h1 = data.state.trial.h.data() + e * points * history;
  out.status = data.state.trial.status.data() + e * points;
  if (in.edges.empty()) return data.group->element->evaluate(in, out);
  out.load = load_.data();
  const Outcome outcome = data.group->element->evaluate(in, out);
  if (outcome == Outcome::ok) dofs.add(load_.data(), load_change_);
  return outcome;
}

// At the load factor of the step's end.
std::span<const EdgeTraction> ElementWork::edges_of(const GroupData& data, int element) {
  const double t = step_time_.load_factor;
  edges_.clear();
  for (auto at = std::ranges::lower_bound(data.followed, element, {}, &FollowedEdge::element);
       at != data.followed.end() && at->element == element; ++at)
    edges_.push_back({at->end.edge, (1.0 - t) * at->start.normal + t * at->end.normal,
                      (1.0 - t) * at->start.shear + t * at->end.shear});
  return edges_;
}

// At a load factor of the stage.
const double* ElementWork::spread_of(const GroupData& data, int element, double load_factor, double* to) {
  const std::size_t dofs = data.dofs(), first = static_cast<std::size_t>(element) * dofs;
  for (std::size_t i = 0; i < dofs; ++i) {
    const double start = data.spread_start.empty() ? 0.0 : data.spread_start[first + i];
    const double end = data.spread_end.empty() ? 0.0 : data.spread_end[first + i];
    to[i] = (1.0 - load_factor) * start + load_factor * end;
  }
  return to;
}

// Without committed unknowns the elements have not moved yet.
const double* ElementWork::committed_of(const ElementDofs& dofs) {
  u0_.assign(u0_.size(), 0.0);
  if (committed_ != nullptr) dofs.gather(*committed_, u0_.data());
  return u0_.data();
}

void add_force(const GroupData& data, int element, const double* f, Eigen::VectorXd& to, FieldSums& sums) {
  if (data.dof_list.empty()) {
    const int* nodes = data.group->nodes_of(element);
    const int n = static_cast<int>(data.group->node_count());
    double sum = 0.0;
#pragma GCC unroll 4
    for (int i = 0; i < n; ++i) {
      const int dof = DofMap::displacement(nodes[i]);
      two_in_a_row(to.data() + dof) += two_in_a_row(f + 2 * i);
      sum += f[2 * i] * f[2 * i] + f[2 * i + 1] * f[2 * i + 1];
    }
    sums[0] += sum;
    return;
  }
  const ElementDofs dofs = data.dofs_of(element);
  dofs.add(f, to);
  // Dofs of one field stand together: its sum stays in a register.
  for (std::size_t i = 0; i < dofs.size();) {
    const int field = data.field_of_dof[i];
    double sum = 0.0;
    for (; i < dofs.size() && data.field_of_dof[i] == field; ++i) sum += f[i] * f[i];
    sums[field] += sum;
  }
}

bool has_matrix_of_step(const GroupData& data) {
  const ElementTraits& traits = data.group->element->traits();
  return traits.linear_in_step && has_constant_stiffness(data.law) &&
         (traits.second_law_size == 0 || has_constant_stiffness(data.second_law));
}

}  // namespace sage
