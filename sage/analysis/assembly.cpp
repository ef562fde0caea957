#include "sage/analysis/assembly.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "sage/analysis/shown_status.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

namespace {

// Matrices of nonlinear groups are kept to see whether K has changed, as long as they are
// not the bulk of the memory.
constexpr std::size_t kMostKept = std::size_t{1} << 26;  // bytes

std::span<const Quantity> history_of(const LawRef& law) {
  return std::visit([](const auto* l) { return l->history(); }, law);
}

// K u cannot be better than rounding of its largest terms.  Near nu = 1/2 those belong to a change of volume
// that all but vanishes, and summing B u first keeps the digits.
bool well_conditioned(const LawRef& law) {
  constexpr double kMostRatio = 1e4;  // of the largest to the smallest stiffness; nu = .4998
  const auto* solid = std::get_if<const SolidLaw*>(&law);
  if (solid == nullptr) return true;  // of joints the relative displacement is taken first
  std::vector<double> h(history_of(law).size());
  PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), h};
  std::vector<double> h1 = h;
  PointOut<4> out;
  out.h1 = h1;
  if ((*solid)->update(in, out) != Outcome::ok) return false;
  const Vector4 stiffness = out.D.selfadjointView<Eigen::Lower>().eigenvalues();
  return stiffness[3] <= kMostRatio * stiffness[0];
}

std::size_t matrix_size(const GroupData& data) {
  const auto dofs = static_cast<std::size_t>(data.group->element->traits().dofs);
  return dofs * dofs;
}

std::span<const int> nodes_of(const GroupData& data, int element) {
  return {data.group->nodes_of(element), data.group->node_count()};
}

bool stress_free(const GroupData& data) {
  const std::vector<double>& sigma = data.state.committed.sigma;
  return std::all_of(sigma.begin(), sigma.end(), [](double s) { return s == 0.0; });
}

}  // namespace

Assembly::Assembly(const Model& model, const Scene& scene, const Skips& skips, WorkCounters& work)
    : model_(&model), scene_(&scene), skips_(skips), work_(&work) {
  std::size_t dofs = 0, geometry = 0, stresses = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    const ElementTraits& traits = group.element->traits();
    GroupData data;
    data.group = &group;
    data.law = model.material_of(group).law_ref();
    data.constant = scene.group_linear[g] != 0 && skips.elements && well_conditioned(data.law);
    dofs = std::max(dofs, static_cast<std::size_t>(traits.dofs));
    geometry = std::max(geometry, static_cast<std::size_t>(traits.geometry_size()));
    stresses = std::max(stresses, static_cast<std::size_t>(traits.points * traits.law_size));
    groups_.push_back(std::move(data));
    reset_group(g);
  }
  scratch_geometry_.resize(geometry);
  scratch_sigma_.resize(stresses);
  scratch_eps_.resize(stresses);
  no_stress_.assign(stresses, 0.0);
  scratch_K_.resize(dofs * dofs);
  scratch_f_.resize(dofs);
  scratch_du_.resize(dofs);
  internal_.setZero(model.dofs());
  behind_.setZero(model.dofs());
  if (!std::ranges::all_of(groups_, &GroupData::constant)) changing_.setZero(model.dofs());
}

void Assembly::reset_group(std::size_t group) {
  GroupData& data = groups_[group];
  const ElementTraits& traits = data.group->element->traits();
  data.state = StateStore(static_cast<std::size_t>(data.group->elements() * traits.points), traits.law_size,
                          history_of(data.law), !data.constant);
}

void Assembly::enter_stage(const Activity& activity, const Eigen::VectorXd& rate) {
  if (is_behind_) recover_states();
  rate_ = rate;
  const auto dofs = static_cast<std::size_t>(model_->dofs());
  node_used_ = active_nodes(*model_, activity);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].active = activity.group[g] != 0;
    if (!groups_[g].active) continue;
    if (!keeps_matrices(groups_[g]) && groups_[g].group->elements() > 0) keep_matrices(groups_[g]);
  }
  equation_of_dof_.assign(dofs, -1);
  dof_of_equation_.clear();
  for (std::size_t dof = 0; dof < dofs; ++dof) {
    if (!node_used_[dof / 2] || activity.held[dof]) continue;
    equation_of_dof_[dof] = static_cast<int>(dof_of_equation_.size());
    dof_of_equation_.push_back(static_cast<int>(dof));
  }
  equations_ = static_cast<int>(dof_of_equation_.size());
  condensation_.reset();
  number_elements();
}

bool Assembly::in_system(const GroupData& data) const {
  return data.active && !(condensation_ && data.constant);
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
    if (in_system(data)) terms += data.group->nodes.size() * 2;
  list.equations.reserve(terms + (condensation_ ? dof_of_equation_.size() : 0));
  list.offset.reserve(static_cast<std::size_t>(elements_) + 1);
  for (const GroupData& data : groups_)
    if (in_system(data)) append_equations(*data.group, equation_of_dof_, list);
  if (!condensation_) return list;
  for (int eq = 0; eq < equations_; ++eq) list.equations.push_back(eq);
  list.offset.push_back(static_cast<std::int64_t>(list.equations.size()));
  return list;
}

void Assembly::condense(int increments, const SolverMaker& make) {
  // Measured: the matrix of the border costs a solution for each of its dofs, an iteration saves about eight.
  constexpr int kWidestBorder = 400, kFewestCondensed = 100, kBorderPerIncrement = 15;
  if (!skips_.condensation || scene_->linear) return;
  std::vector<char> keep(static_cast<std::size_t>(model_->dofs()), 0);
  for (const GroupData& data : groups_) {
    if (!data.active || data.constant) continue;
    for (int node : data.group->nodes)
      for (int c = 0; c < 2; ++c) keep[static_cast<std::size_t>(2 * node + c)] = 1;
  }
  const auto kept =
      static_cast<int>(std::count_if(dof_of_equation_.begin(), dof_of_equation_.end(),
                                     [&](int dof) { return keep[static_cast<std::size_t>(dof)] != 0; }));
  const int condensed = equations_ - kept;
  if (kept == 0 || kept > kWidestBorder || condensed < kFewestCondensed || condensed < 4 * kept ||
      kept > kBorderPerIncrement * increments)
    return;
  try {
    condensation_ = std::make_unique<Condensation>(groups_, dof_of_equation_, keep, make);
  } catch (const SingularMatrix&) {
    return;  // a region that only its border holds: the whole system says what is wrong, or solves it
  }
  constexpr double kPoorPivot = 1e-6;  // of an ill-conditioned region: its elimination would cost digits
  if (condensation_->report().smallest_pivot_ratio < kPoorPivot) {
    condensation_.reset();
    return;
  }
  work_->condensed = condensed;
  for (int dof : dof_of_equation_) equation_of_dof_[static_cast<std::size_t>(dof)] = -1;
  dof_of_equation_ = condensation_->kept();
  equations_ = kept;
  for (int eq = 0; eq < equations_; ++eq)
    equation_of_dof_[static_cast<std::size_t>(dof_of_equation_[static_cast<std::size_t>(eq)])] = eq;
  number_elements();
}

// Room for the matrices that are kept: of every shape once where the group is constant, else of every element.
void Assembly::keep_matrices(GroupData& data) {
  const auto elements = static_cast<std::size_t>(data.group->elements());
  if (data.constant) {
    data.matrix = scene_->shapes[static_cast<std::size_t>(&data - groups_.data())];
    const int shapes = *std::max_element(data.matrix.begin(), data.matrix.end()) + 1;
    data.K.resize(static_cast<std::size_t>(shapes) * matrix_size(data));
    int made = 0;
    for (int e = 0; e < data.group->elements(); ++e) {
      stop_if_asked_at(e);
      if (data.matrix[static_cast<std::size_t>(e)] != made) continue;
      evaluate_element(data, e, nullptr, data.K.data() + static_cast<std::size_t>(made) * matrix_size(data));
      ++made;
    }
    make_shifts(data, made);
    work_->element_evaluations += made;
  } else if (skips_.factors && !scene_->linear && elements * matrix_size(data) * sizeof(double) <= kMostKept) {
    data.matrix.resize(elements);
    for (std::size_t e = 0; e < elements; ++e) data.matrix[e] = static_cast<int>(e);
    data.K.assign(elements * matrix_size(data), 0.0);
  }
}

void Assembly::make_shifts(GroupData& data, int matrices) const {
  const std::size_t n = data.dofs();
  data.shift.assign(static_cast<std::size_t>(matrices) * n, 0.0);
  const bool ring = model_->geometry == Geometry::axisymmetric && data.group->solid();
  if (!ring) return;
  for (std::size_t m = 0; m < static_cast<std::size_t>(matrices); ++m)
    for (std::size_t j = 0; j < n; j += 2)
      for (std::size_t i = 0; i < n; ++i) data.shift[m * n + i] += data.K[(m * n + j) * n + i];
}

void Assembly::take_states() {
  for (GroupData& data : groups_) {
    if (!data.active || !data.constant) continue;
    data.force.clear();
    if (stress_free(data)) continue;
    const std::size_t dofs = data.dofs();
    data.force.resize(static_cast<std::size_t>(data.group->elements()) * dofs);
    for (int e = 0; e < data.group->elements(); ++e) {
      evaluate_element(data, e, nullptr, nullptr);
      std::copy_n(scratch_f_.data(), dofs, data.force.data() + static_cast<std::size_t>(e) * dofs);
    }
    work_->element_evaluations += data.group->elements();
  }
}

void Assembly::gather(const GroupData& data, int element, const Eigen::VectorXd& u) {
  const int* nodes = data.group->nodes_of(element);
  for (std::size_t i = 0; i < data.group->node_count(); ++i) {
    scratch_du_[2 * i] = u[2 * nodes[i]];
    scratch_du_[2 * i + 1] = u[2 * nodes[i] + 1];
  }
}

// Every so many elements, the first included.
void Assembly::stop_if_asked_at(int element) const {
  constexpr int kEvery = 256;
  if (element % kEvery == 0) stop_if_asked(stop_asked_);
}

// Returns |f|^2.
double Assembly::add_force(const GroupData& data, int element, const double* f, Eigen::VectorXd& to) const {
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

const double* Assembly::geometry_of(GroupData& data, int element) {
  const Group& group = *data.group;
  const auto size = static_cast<std::size_t>(group.element->traits().geometry_size());
  const bool keep = !scene_->linear && !data.constant;
  if (!keep) {
    element_coordinates(model_->mesh, group, element, scratch_x_);
    group.element->geometry(scratch_x_, {scratch_geometry_.data(), size});
    return scratch_geometry_.data();
  }
  if (data.geometry.empty()) {
    data.geometry.resize(size * static_cast<std::size_t>(group.elements()));
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model_->mesh, group, e, scratch_x_);
      group.element->geometry(scratch_x_, {data.geometry.data() + static_cast<std::size_t>(e) * size, size});
    }
  }
  return data.geometry.data() + static_cast<std::size_t>(element) * size;
}

// Forces into scratch_f_, states into the trial side.  du = nullptr: none.
Outcome Assembly::evaluate_element(GroupData& data, int element, const Eigen::VectorXd* du, double* K) {
  const ElementTraits& traits = data.group->element->traits();
  const auto points = static_cast<std::size_t>(traits.points);
  const auto law_size = static_cast<std::size_t>(traits.law_size);
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const auto e = static_cast<std::size_t>(element);
  if (du != nullptr)
    gather(data, element, *du);
  else
    std::fill(scratch_du_.begin(), scratch_du_.end(), 0.0);
  const std::size_t at = e * points * law_size;
  ElementIn in;
  in.geometry = geometry_of(data, element);
  in.du = scratch_du_.data();
  in.law = data.law;
  const bool has_room = !data.state.committed.sigma.empty();
  in.sigma0 = has_room ? data.state.committed.sigma.data() + at : no_stress_.data();
  in.eps0 = has_room ? data.state.committed.eps.data() + at : no_stress_.data();
  in.h0 = data.state.committed.h.data() + e * points * history;
  ElementOut out;
  out.K = K;
  out.f = scratch_f_.data();
  out.sigma1 = data.constant ? scratch_sigma_.data() : data.state.trial.sigma.data() + at;
  out.eps1 = data.constant ? scratch_eps_.data() : data.state.trial.eps.data() + at;
  out.h1 = data.state.trial.h.data() + e * points * history;
  out.status = data.state.trial.status.data() + e * points;
  return data.group->element->evaluate(in, out);
}

Outcome Assembly::evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  const std::size_t size = matrix_size(data);
  const bool compare = tangent != nullptr && keeps_matrices(data);
  for (int e = 0; e < data.group->elements(); ++e) {
    stop_if_asked_at(e);
    if (evaluate_element(data, e, &du, tangent != nullptr ? scratch_K_.data() : nullptr) == Outcome::cut_step)
      return Outcome::cut_step;
    changing_sum_ += add_force(data, e, scratch_f_.data(), changing_);
    if (compare) {
      double* kept = data.K.data() + static_cast<std::size_t>(e) * size;
      if (std::memcmp(kept, scratch_K_.data(), size * sizeof(double)) == 0) continue;
      std::copy_n(scratch_K_.data(), size, kept);
      tangent->differs();
    } else if (tangent != nullptr) {
      tangent->add(data.first_element + e, nodes_of(data, e), scratch_K_.data());
    }
  }
  work_->element_evaluations += data.group->elements();
  return Outcome::ok;
}

// K times displacements relative to the first node: differences of neighbours are exact where they are small,
// and stiff joints and nu near 1/2 make much of every rounding.  A shift along y costs nothing, one along x
// only in a ring.
void Assembly::evaluate_constant(GroupData& data, const Eigen::VectorXd& du) {
  const std::size_t n = data.dofs();
  const bool from_zero = data.force.empty();
  data.trial_force.clear();
  if (from_zero && du.isZero(0.0)) return;
  data.trial_force.resize(static_cast<std::size_t>(data.group->elements()) * n);
  for (int e = 0; e < data.group->elements(); ++e) {
    stop_if_asked_at(e);
    gather(data, e, du);
    const double x = scratch_du_[0], y = scratch_du_[1];
    for (std::size_t i = 0; i < n; i += 2) {
      scratch_du_[i] -= x;
      scratch_du_[i + 1] -= y;
    }
    const double* K = data.matrix_of(e);
    const double* shift = data.shift_of(e);
    double* f = data.trial_force.data() + static_cast<std::size_t>(e) * n;
    if (!from_zero) std::copy_n(data.force.data() + static_cast<std::size_t>(e) * n, n, f);
    for (std::size_t i = 0; i < n; ++i) f[i] += shift[i] * x;
    for (std::size_t j = 2; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) f[i] += K[j * n + i] * scratch_du_[j];
    constant_sum_ += add_force(data, e, f, internal_);
  }
  work_->linear_products += data.group->elements();
}

// All matrices that are kept (those of other groups are added as they are made).
void Assembly::fill(Tangent& tangent) const {
  for (const GroupData& data : groups_) {
    if (!in_system(data) || !keeps_matrices(data)) continue;
    for (int e = 0; e < data.group->elements(); ++e) {
      stop_if_asked_at(e);
      tangent.add(data.first_element + e, nodes_of(data, e), data.matrix_of(e));
    }
  }
  if (condensation_) tangent.add(elements_ - 1, {}, condensation_->S().data());
}

Outcome Assembly::evaluate_groups(const Eigen::VectorXd& du, Tangent* tangent) {
  for (GroupData& data : groups_)
    if (data.active && !data.constant && evaluate_group(data, du, tangent) == Outcome::cut_step)
      return Outcome::cut_step;
  return Outcome::ok;
}

// Forces and matrices of the groups that are not constant, and all kept matrices into the tangent.
Outcome Assembly::evaluate_changing(const Eigen::VectorXd& du, Tangent* tangent) {
  ++(tangent != nullptr ? work_->assemblies : work_->residuals);
  changing_.setZero();
  changing_sum_ = 0.0;
  const auto elements = [&] { return evaluate_groups(du, tangent); };
  Outcome outcome = Outcome::ok;
  if (tangent != nullptr) {
    const bool all_kept = std::ranges::all_of(groups_, [&](const GroupData& data) {
      return !data.active || data.group->elements() == 0 || keeps_matrices(data);
    });
    outcome = tangent->assemble(all_kept, elements, [&] { fill(*tangent); });
  } else {
    outcome = elements();
  }
  return outcome == Outcome::ok && std::isfinite(changing_sum_) ? Outcome::ok : Outcome::cut_step;
}

void Assembly::add_constant(const Eigen::VectorXd& du) {
  if (changing_.size() > 0)
    internal_ = changing_;
  else
    internal_.setZero();
  constant_sum_ = 0.0;
  for (GroupData& data : groups_)
    if (data.active && data.constant) evaluate_constant(data, du);
  force_scale_ = std::sqrt(changing_sum_ + constant_sum_);
}

Outcome Assembly::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  const Timer timer(work_->assembly_seconds);
  Outcome outcome = evaluate_changing(du, tangent);
  if (outcome == Outcome::ok) {
    add_constant(du);
    if (!std::isfinite(force_scale_)) outcome = Outcome::cut_step;
  }
  if (tangent != nullptr) tangent->settle(outcome);
  return outcome;
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
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].active && !scene_->group_linear[g])  // whether its laws are evaluated (skips) or not
      std::visit([&](const auto* law) { add_path_error(groups_[g], *law, mean); }, groups_[g].law);
  return mean.weight > 0.0 ? mean.sum / mean.weight : 0.0;
}

void Assembly::begin_step(const Eigen::VectorXd& target, double rate_part) {
  if (!condensation_) return;
  const Timer timer(work_->solve_seconds);
  constant_force_.setZero(model_->dofs());
  for (const GroupData& data : groups_) {
    if (!data.active || !data.constant || data.force.empty()) continue;
    for (int e = 0; e < data.group->elements(); ++e)
      add_force(data, e, data.force.data() + static_cast<std::size_t>(e) * data.dofs(), constant_force_);
  }
  prescribed_ = rate_part * rate_;
  condensation_->begin_step(target, prescribed_, constant_force_);
  internal_ = changing_;
  condensation_->add_start_forces(internal_);
}

// The force scale of the linear region is that of the last whole evaluation: complete() brings it up to date.
Outcome Assembly::iterate(const Eigen::VectorXd& du, Tangent* tangent) {
  if (!condensation_) return evaluate(du, tangent);
  const Timer timer(work_->assembly_seconds);
  const Outcome outcome = evaluate_changing(du, tangent);
  if (tangent != nullptr) tangent->settle(outcome);
  if (outcome == Outcome::cut_step) return outcome;
  internal_ = changing_;
  condensation_->add_forces(du, internal_);
  force_scale_ = std::sqrt(changing_sum_ + constant_sum_);
  return Outcome::ok;
}

void Assembly::complete(Eigen::VectorXd& du) {
  // What one solution leaves of the forces is rounding, times the stiffness ratio within the region.
  constexpr double kRounding = 1e-14;
  constexpr int kSteps = 3;
  if (!condensation_) return;
  const Timer timer(work_->assembly_seconds);
  condensation_->complete(du);
  add_constant(du);
  double residual = condensation_->largest_residual(internal_);
  for (int i = 0; i < kSteps && residual > kRounding * force_scale_; ++i) {
    condensation_->refine(internal_, du);
    add_constant(du);
    const double last = std::exchange(residual, condensation_->largest_residual(internal_));
    if (residual > 0.5 * last) break;
  }
  condensation_->set_base(internal_, changing_, du);
}

double Assembly::whole_norm(const Eigen::VectorXd& correction) {
  return condensation_ ? condensation_->whole_norm(correction) : correction.norm();
}

void Assembly::commit_again() {
  for (GroupData& data : groups_) {
    if (!data.active) continue;
    if (data.constant)
      std::swap(data.force, data.trial_force);
    else
      data.state.commit();
  }
}

void Assembly::commit(const Eigen::VectorXd& du) {
  commit_again();
  const bool constant = std::any_of(groups_.begin(), groups_.end(),
                                    [](const GroupData& data) { return data.active && data.constant; });
  if (!constant) return;
  behind_ += du;
  is_behind_ = true;
  if (!skips_.states) recover_states();
}

void Assembly::recover_states() {
  for (GroupData& data : groups_) data.state.make_room();
  if (!is_behind_) return;
  const Timer timer(work_->assembly_seconds);
  for (GroupData& data : groups_) {
    if (!data.active || !data.constant) continue;
    const auto size = static_cast<std::size_t>(data.group->element->traits().points * data.state.law_size());
    for (int e = 0; e < data.group->elements(); ++e) {
      evaluate_element(data, e, &behind_, nullptr);
      const std::size_t at = static_cast<std::size_t>(e) * size;
      std::copy_n(scratch_sigma_.data(), size, data.state.committed.sigma.data() + at);
      std::copy_n(scratch_eps_.data(), size, data.state.committed.eps.data() + at);
    }
    std::swap(data.state.committed.h, data.state.trial.h);
    std::swap(data.state.committed.status, data.state.trial.status);
    work_->element_evaluations += data.group->elements();
  }
  behind_.setZero();
  is_behind_ = false;
}

void Assembly::exchange(Archive& archive, bool before_step) {
  for (GroupData& data : groups_) {
    const bool trial = before_step && data.active && !data.constant && !archive.reading();
    PointStates& states = trial ? data.state.trial : data.state.committed;
    archive(states.sigma);
    archive(states.eps);
    archive(states.h);
    archive(states.status);
    if (data.constant)
      archive(before_step && data.active && !archive.reading() ? data.trial_force : data.force);
  }
  archive(behind_);
  archive(is_behind_);
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
