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
}

void ElementWork::stop_if_asked_at(int element) const {
  constexpr int kEvery = 256;
  if (element % kEvery == 0) stop_if_asked(stop_asked_);
}

void ElementWork::gather(const GroupData& data, int element, const Eigen::VectorXd& u) {
  const int* nodes = data.group->nodes_of(element);
  for (std::size_t i = 0; i < data.group->node_count(); ++i) {
    du_[2 * i] = u[2 * nodes[i]];
    du_[2 * i + 1] = u[2 * nodes[i] + 1];
  }
}

const double* ElementWork::geometry_of(GroupData& data, int element) {
  const Group& group = *data.group;
  const auto size = static_cast<std::size_t>(group.element->traits().geometry_size());
  const bool keep = keep_geometry_ && !data.constant;
  if (!keep) {
    element_coordinates(model_->mesh, group, element, x_);
    group.element->geometry(x_, {geometry_.data(), size});
    return geometry_.data();
  }
  if (data.geometry.empty()) {
    data.geometry.resize(size * static_cast<std::size_t>(group.elements()));
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model_->mesh, group, e, x_);
      group.element->geometry(x_, {data.geometry.data() + static_cast<std::size_t>(e) * size, size});
    }
  }
  return data.geometry.data() + static_cast<std::size_t>(element) * size;
}

const PointContext* ElementWork::contexts_of(const GroupData& data, int element) {
  element_coordinates(model_->mesh, *data.group, element, x_);
  for (int p = 0; p < data.group->element->traits().points; ++p)
    contexts_[static_cast<std::size_t>(p)] = context_of(data, element, x_, p, moment_);
  return contexts_.data();
}

Outcome ElementWork::evaluate(GroupData& data, int element, const Eigen::VectorXd* du, double* K) {
  const ElementTraits& traits = data.group->element->traits();
  const auto points = static_cast<std::size_t>(traits.points);
  const auto law_size = static_cast<std::size_t>(traits.law_size);
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const auto e = static_cast<std::size_t>(element);
  if (du != nullptr)
    gather(data, element, *du);
  else
    std::fill(du_.begin(), du_.end(), 0.0);
  const std::size_t at = e * points * law_size;
  ElementIn in;
  in.geometry = geometry_of(data, element);
  in.du = du_.data();
  in.law = data.law;
  const bool has_room = !data.state.committed.sigma.empty();
  in.sigma0 = has_room ? data.state.committed.sigma.data() + at : no_stress_.data();
  in.eps0 = has_room ? data.state.committed.eps.data() + at : no_stress_.data();
  in.h0 = data.state.committed.h.data() + e * points * history;
  if (data.wants_context) in.contexts = contexts_of(data, element);
  ElementOut out;
  out.K = K;
  out.f = f_.data();
  out.sigma1 = data.constant ? sigma_.data() : data.state.trial.sigma.data() + at;
  out.eps1 = data.constant ? eps_.data() : data.state.trial.eps.data() + at;
  out.h1 = data.state.trial.h.data() + e * points * history;
  out.status = data.state.trial.status.data() + e * points;
  return data.group->element->evaluate(in, out);
}

double add_force(const GroupData& data, int element, const double* f, Eigen::VectorXd& to) {
  const int* nodes = data.group->nodes_of(element);
  const int n = static_cast<int>(data.group->node_count());
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const int dof = 2 * nodes[i];
    to[dof] += f[2 * i];
    to[dof + 1] += f[2 * i + 1];
    sum += f[2 * i] * f[2 * i] + f[2 * i + 1] * f[2 * i + 1];
  }
  return sum;
}

}  // namespace sage
