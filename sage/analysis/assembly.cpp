#include "sage/analysis/assembly.hpp"

#include <cmath>

namespace sage {

namespace {

using ConstMatrix = Eigen::Map<const Eigen::MatrixXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;
using MutableVector = Eigen::Map<Eigen::VectorXd>;

std::span<const Quantity> history_of(const LawRef& law) {
  return std::visit([](const auto* l) { return l->history(); }, law);
}

}  // namespace

Assembly::Assembly(const Model& model, const Scene& scene, WorkCounters& work)
    : model_(&model), scene_(&scene), work_(&work) {
  std::size_t dofs = 0, geometry = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    const ElementTraits& traits = group.element->traits();
    GroupData data;
    data.group = &group;
    data.law = model.material_of(group).law_ref();
    data.linear = scene.group_linear[g] != 0;
    data.state = StateStore(static_cast<std::size_t>(group.elements() * traits.points), traits.law_size,
                            history_of(data.law));
    dofs = std::max(dofs, static_cast<std::size_t>(traits.dofs));
    geometry = std::max(geometry, static_cast<std::size_t>(traits.geometry_size()));
    groups_.push_back(std::move(data));
  }
  scratch_geometry_.resize(geometry);
  scratch_K_.resize(dofs * dofs);
  scratch_f_.resize(dofs);
  scratch_du_.resize(dofs);
  internal_.setZero(model.dofs());
  coupling_.setZero(model.dofs());
}

void Assembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  rate_ = rate;
  const auto dofs = static_cast<std::size_t>(model_->dofs());
  std::vector<char> used(dofs, 0);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].active = activity.group[g] != 0;
    if (!groups_[g].active) continue;
    for (int node : groups_[g].group->nodes) used[2 * static_cast<std::size_t>(node)] = 1;
  }
  equation_of_dof_.assign(dofs, -1);
  dof_of_equation_.clear();
  for (std::size_t dof = 0; dof < dofs; ++dof) {
    if (!used[dof - dof % 2] || activity.held[dof]) continue;
    equation_of_dof_[dof] = static_cast<int>(dof_of_equation_.size());
    dof_of_equation_.push_back(static_cast<int>(dof));
  }
  equations_ = static_cast<int>(dof_of_equation_.size());
  element_equations_ = {};
  for (GroupData& data : groups_) {
    if (!data.active) continue;
    data.first_element = element_equations_.count();
    const Group& group = *data.group;
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      for (std::size_t i = 0; i < group.node_count(); ++i)
        for (int c = 0; c < 2; ++c)
          element_equations_.equations.push_back(equation_of_dof_[static_cast<std::size_t>(2 * nodes[i] + c)]);
      element_equations_.offset.push_back(static_cast<std::int64_t>(element_equations_.equations.size()));
    }
  }
}

void Assembly::add_to_globals(const GroupData& data, int element, const double* f, const double* K,
                              LinearSolver* solver) {
  const int* nodes = data.group->nodes_of(element);
  const int n = static_cast<int>(data.group->node_count());
  bool moving = false;
  for (int i = 0; i < n; ++i) {
    const int dof = 2 * nodes[i];
    internal_[dof] += f[2 * i];
    internal_[dof + 1] += f[2 * i + 1];
    scale_sum_ += f[2 * i] * f[2 * i] + f[2 * i + 1] * f[2 * i + 1];
    moving = moving || rate_[dof] != 0.0 || rate_[dof + 1] != 0.0;
  }
  if (solver == nullptr) return;
  solver->add(data.first_element + element, K);
  if (!moving) return;
  for (int j = 0; j < 2 * n; ++j) {
    const double rate = rate_[2 * nodes[j / 2] + j % 2];
    if (rate == 0.0) continue;
    for (int i = 0; i < 2 * n; ++i) coupling_[2 * nodes[i / 2] + i % 2] += K[j * 2 * n + i] * rate;
  }
}

Outcome Assembly::evaluate_group(GroupData& data, const Eigen::VectorXd& du, LinearSolver* solver) {
  const Group& group = *data.group;
  const ElementTraits& traits = group.element->traits();
  const auto geometry_size = static_cast<std::size_t>(traits.geometry_size());
  const auto points = static_cast<std::size_t>(traits.points);
  const auto law_size = static_cast<std::size_t>(traits.law_size);
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const bool keep_geometry = !scene_->linear;
  if (keep_geometry && data.geometry.empty()) {
    data.geometry.resize(geometry_size * static_cast<std::size_t>(group.elements()));
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model_->mesh, group, e, scratch_x_);
      group.element->geometry(
          scratch_x_, {data.geometry.data() + static_cast<std::size_t>(e) * geometry_size, geometry_size});
    }
  }
  ElementIn in;
  in.law = data.law;
  in.du = scratch_du_.data();
  ElementOut out;
  out.f = scratch_f_.data();
  out.K = solver != nullptr ? scratch_K_.data() : nullptr;
  for (int e = 0; e < group.elements(); ++e) {
    const auto eu = static_cast<std::size_t>(e);
    if (keep_geometry) {
      in.geometry = data.geometry.data() + eu * geometry_size;
    } else {
      element_coordinates(model_->mesh, group, e, scratch_x_);
      group.element->geometry(scratch_x_, {scratch_geometry_.data(), geometry_size});
      in.geometry = scratch_geometry_.data();
    }
    const int* nodes = group.nodes_of(e);
    for (std::size_t i = 0; i < group.node_count(); ++i) {
      scratch_du_[2 * i] = du[2 * nodes[i]];
      scratch_du_[2 * i + 1] = du[2 * nodes[i] + 1];
    }
    const std::size_t at = eu * points * law_size;
    in.sigma0 = data.state.committed.sigma.data() + at;
    in.eps0 = data.state.committed.eps.data() + at;
    in.h0 = data.state.committed.h.data() + eu * points * history;
    out.sigma1 = data.state.trial.sigma.data() + at;
    out.eps1 = data.state.trial.eps.data() + at;
    out.h1 = data.state.trial.h.data() + eu * points * history;
    out.status = data.state.trial.status.data() + eu * points;
    if (group.element->evaluate(in, out) == Outcome::cut_step) return Outcome::cut_step;
    add_to_globals(data, e, out.f, out.K, solver);
  }
  work_->element_evaluations += group.elements();
  return Outcome::ok;
}

Outcome Assembly::evaluate(const Eigen::VectorXd& du, LinearSolver* solver) {
  const Timer timer(work_->assembly_seconds);
  ++(solver != nullptr ? work_->assemblies : work_->residuals);
  internal_.setZero();
  scale_sum_ = 0.0;
  if (solver != nullptr) {
    solver->clear();
    coupling_.setZero();
  }
  for (GroupData& data : groups_) {
    if (!data.active) continue;
    if (evaluate_group(data, du, solver) == Outcome::cut_step) return Outcome::cut_step;
  }
  force_scale_ = std::sqrt(scale_sum_);
  return std::isfinite(force_scale_) ? Outcome::ok : Outcome::cut_step;
}

namespace {

struct WeightedMean {
  double sum = 0.0, weight = 0.0;
};

template <int N>
void add_path_error(const GroupData& data, const Law<N>& law, WeightedMean& mean) {
  const StateStore& state = data.state;
  const ElementTraits& traits = data.group->element->traits();
  const auto stride = static_cast<std::size_t>(traits.geometry_size() / traits.points);
  const auto history = static_cast<std::size_t>(state.history_size());
  const std::size_t points = state.committed.status.size();
  for (std::size_t p = 0; p < points; ++p) {
    const auto at = [&](const std::vector<double>& v) { return Eigen::Map<const Vector<N>>(v.data() + p * N); };
    const auto h = [&](const PointStates& s) {
      return std::span<const double>(s.h.data() + p * history, history);
    };
    const Vector<N> sigma0 = at(state.committed.sigma), sigma1 = at(state.trial.sigma);
    const Vector<N> eps0 = at(state.committed.eps), deps = at(state.trial.eps) - eps0;
    const double work = data.geometry[p * stride] * std::abs((sigma1 - sigma0).dot(deps));
    mean.weight += work;
    mean.sum += work * law.path_error({sigma0, eps0, deps, h(state.committed)}, sigma1, h(state.trial));
  }
}

}  // namespace

double Assembly::path_error() const {
  if (scene_->linear) return 0.0;
  WeightedMean mean;
  for (const GroupData& data : groups_)
    if (data.active) std::visit([&](const auto* law) { add_path_error(data, *law, mean); }, data.law);
  return mean.weight > 0.0 ? mean.sum / mean.weight : 0.0;
}

void Assembly::commit() {
  for (GroupData& data : groups_)
    if (data.active) data.state.commit();
}

std::array<long, kStatuses> Assembly::count_points() const {
  std::array<long, kStatuses> counts{};
  for (const GroupData& data : groups_) {
    if (!data.active) continue;
    for (PointStatus status : data.state.committed.status) ++counts[static_cast<std::size_t>(status)];
  }
  return counts;
}

}  // namespace sage
