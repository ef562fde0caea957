#include "sage/analysis/skips/constant_region.hpp"

#include <algorithm>

#include "sage/math/dense.hpp"

namespace sage {

namespace {

constexpr int kLinearUnit = 512;            // elements that a thread takes at a time
constexpr int kWorthLinearThreads = 10000;  // elements from which on threads gain

bool stress_free(const GroupData& data) {
  const std::vector<double>& sigma = data.state.committed.sigma;
  return std::all_of(sigma.begin(), sigma.end(), [](double s) { return s == 0.0; });
}

}  // namespace

ConstantRegion::ConstantRegion(const Model& model, std::vector<GroupData>& groups, ElementWork& element,
                               WorkCounters& work)
    : model_(&model), groups_(&groups), element_(&element), work_(&work) {}

// K u cannot be better than rounding of its largest terms.  Near nu = 1/2 those belong to a change of volume
// that all but vanishes, and summing B u first keeps the digits.
bool ConstantRegion::suits(const Group& group, const LawRef& law) {
  if (!group.element->traits().linear) return false;
  if (group.flow()) return true;
  if (!group.entry->unknowns.empty()) return false;
  constexpr double kMostRatio = 1e4;  // of the largest to the smallest stiffness; nu = .4998
  const auto* solid = std::get_if<const SolidLaw*>(&law);
  if (solid == nullptr) return true;  // of joints the relative displacement is taken first
  std::vector<double> h((*solid)->traits().history.size());
  PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), h};
  std::vector<double> h1 = h;
  PointOut<4> out;
  out.h1 = h1;
  if ((*solid)->update(in, out) != Outcome::ok) return false;
  const Eigen::VectorXd stiffness = dense_matrix::symmetric_eigensystem(out.D).values;
  return stiffness[3] <= kMostRatio * stiffness[0];
}

void ConstantRegion::make_matrices(GroupData& data, const std::vector<int>& shapes) {
  data.matrix = shapes;
  const int matrices = *std::max_element(data.matrix.begin(), data.matrix.end()) + 1;
  data.K.resize(static_cast<std::size_t>(matrices) * data.matrix_size());
  int made = 0;
  for (int e = 0; e < data.group->elements(); ++e) {
    element_->stop_if_asked_at(e);
    if (data.matrix[e] != made) continue;
    element_->evaluate(data, e, nullptr, data.K.data() + static_cast<std::size_t>(made) * data.matrix_size());
    ++made;
  }
  make_shifts(data, made);
  work_->element_evaluations += made;
}

void ConstantRegion::make_shifts(GroupData& data, int matrices) const {
  const std::size_t n = data.dofs();
  data.shift.assign(static_cast<std::size_t>(matrices) * n, 0.0);
  const bool ring =
      model_->geometry == Geometry::axisymmetric && !data.group->interface() && !data.group->flow();
  if (!ring) return;
  for (std::size_t m = 0; m < static_cast<std::size_t>(matrices); ++m)
    for (std::size_t j = 0; j < n; j += 2)
      for (std::size_t i = 0; i < n; ++i) data.shift[m * n + i] += data.K[(m * n + j) * n + i];
}

void ConstantRegion::take_states() {
  for (GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    data.force.clear();
    if (stress_free(data)) continue;
    const std::size_t dofs = data.dofs();
    data.force.resize(static_cast<std::size_t>(data.group->elements()) * dofs);
    for (int e = 0; e < data.group->elements(); ++e) {
      element_->evaluate(data, e, nullptr, nullptr);
      std::copy_n(element_->f(), dofs, data.force.data() + static_cast<std::size_t>(e) * dofs);
    }
    work_->element_evaluations += data.group->elements();
  }
}

void ConstantRegion::add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& to) {
  sums_.fill(0.0);
  for (GroupData& data : *groups_)
    if (data.active && data.constant) add_group(data, du, to);
}

namespace {

// f = start + K u but for its first `skipped` columns + shift times the motion of the first node along x.
// count: terms of f; 0 = only `terms` says.  Where the compiler knows it, sums stay in registers; their order is
// the same.
template <std::size_t count, std::size_t skipped = 2>
void multiply(const double* K, const double* shift, double x, const double* u, std::size_t terms,
              const double* start, double* f) {
  constexpr std::size_t kRoom = count > 0 ? count : 1;
  const std::size_t n = count > 0 ? count : terms;
  double in_registers[kRoom];
  double* const sum = count > 0 ? in_registers : f;
  for (std::size_t i = 0; i < n; ++i) sum[i] = (start != nullptr ? start[i] : 0.0) + shift[i] * x;
  for (std::size_t j = skipped; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) sum[i] += K[j * n + i] * u[j];
  if constexpr (count > 0) std::copy_n(sum, n, f);
}

using Product = void (*)(const double* K, const double* shift, double x, const double* u, std::size_t terms,
                         const double* start, double* f);

Product product_for(bool heads, std::size_t n) {
  if (heads) return n == 4 ? multiply<4, 1> : n == 8 ? multiply<8, 1> : multiply<0, 1>;
  return n == 8 ? multiply<8> : n == 16 ? multiply<16> : multiply<0>;
}

// Displacements of an element, or its heads, relative to its first node.
void take_relative(double* u, std::size_t n, bool heads) {
  const double x = u[0], y = u[1];
  const std::size_t step = heads ? 1 : 2;
  for (std::size_t i = 0; i < n; i += step) {
    u[i] -= x;
    if (!heads) u[i + 1] -= y;
  }
}

}  // namespace

// K times displacements relative to the first node: differences of neighbours are exact where they are small,
// and stiff joints and nu near 1/2 make much of every rounding.  A shift along y costs nothing, one along x
// only in a ring.  So with heads, of which a level that is the same everywhere costs nothing.
void ConstantRegion::add_group(GroupData& data, const Eigen::VectorXd& du, Eigen::VectorXd& to) {
  if (data.force.empty() && du.isZero(0.0)) return data.trial_force.clear();
  const int elements = data.group->elements();
  data.trial_force.resize(static_cast<std::size_t>(elements) * data.dofs());
  // Threads make what belongs to one element alone; sums have the order that they have on one thread.
  const bool divided = pool_ != nullptr && elements >= kWorthLinearThreads;
  if (divided)
    pool_->run((elements + kLinearUnit - 1) / kLinearUnit, [&](int unit, int thread) {
      double* const u = room_[thread].data();
      for (int e = unit * kLinearUnit; e < std::min((unit + 1) * kLinearUnit, elements); ++e)
        make_force(data, e, du, u);
    });
  for (int e = 0; e < elements; ++e) {
    if (!divided) make_force(data, e, du, element_->du());
    add_force(data, e, data.trial_force.data() + static_cast<std::size_t>(e) * data.dofs(), to, sums_);
  }
  work_->linear_products += elements;
}

// u: room for the element's unknowns.
void ConstantRegion::make_force(GroupData& data, int e, const Eigen::VectorXd& du, double* u) const {
  element_->stop_if_asked_at(e);
  const std::size_t n = data.dofs(), begin = static_cast<std::size_t>(e) * n;
  const bool heads = data.group->flow();
  data.dofs_of(e).gather(du, u);
  const double x = u[0];
  take_relative(u, n, heads);
  product_for(heads, n)(data.matrix_of(e), data.shift_of(e), x, u, n,
                        data.force.empty() ? nullptr : data.force.data() + begin,
                        data.trial_force.data() + begin);
}

void ConstantRegion::set_threads(int threads) {
  const bool useful = std::ranges::any_of(*groups_, [](const GroupData& data) {
    return data.constant && data.group->elements() >= kWorthLinearThreads;
  });
  pool_ = useful && threads > 1 ? std::make_unique<ThreadPool>(threads) : nullptr;
  if (pool_ == nullptr) return;
  std::size_t most = 0;
  for (const GroupData& data : *groups_) most = std::max(most, data.dofs());
  room_.resize(threads, std::vector<double>(most));
}

void ConstantRegion::add_committed_forces(Eigen::VectorXd& to) const {
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant || data.force.empty()) continue;
    for (int e = 0; e < data.group->elements(); ++e)
      data.dofs_of(e).add(data.force.data() + static_cast<std::size_t>(e) * data.dofs(), to);
  }
}

}  // namespace sage
