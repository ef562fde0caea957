#include "sage/analysis/skips/constant_region.hpp"

#include <algorithm>
#include <array>

#include "sage/analysis/skips/kept_matrices.hpp"
#include "sage/math/dense.hpp"

namespace sage {

namespace {

constexpr int kLinearUnit = 512;            // elements that a thread takes at a time
constexpr int kWorthLinearThreads = 10000;  // elements from which on threads gain

constexpr std::size_t kMostPressures = 9;  // of an element
// Time in which what flows is all that matters, a power of 2; dividing by it is exact.
constexpr double kLongTime = 0x1p100;

bool stress_free(const GroupData& data) {
  const std::vector<double>& sigma = data.state.committed.sigma;
  return std::all_of(sigma.begin(), sigma.end(), [](double s) { return s == 0.0; });
}

// Unknowns of an element that are no displacements: they come last.
std::size_t pressures_of(const GroupData& data) {
  return std::ranges::count_if(data.field_of_dof, [](int field) { return field > 0; });
}

// K u cannot be better than rounding of its largest terms.  Near nu = 1/2 those belong to a change of volume
// that all but vanishes, and summing B u first keeps the digits.
bool keeps_digits(const SolidLaw& law) {
  constexpr double kMostRatio = 1e4;  // of the largest to the smallest stiffness; nu = .4998
  std::vector<double> h(law.traits().history.size());
  PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), h};
  std::vector<double> h1 = h;
  PointOut<4> out;
  out.h1 = h1;
  if (law.update(in, out) != Outcome::ok) return false;
  const Eigen::VectorXd stiffness = dense_matrix::symmetric_eigensystem(out.D).values;
  return stiffness[3] <= kMostRatio * stiffness[0];
}

// Sets the time of elements for as long as it lives.
class TimeOfElements {
 public:
  TimeOfElements(ElementWork& element, double flow_dt) : element_(&element), before_(element.step_time()) {
    StepTime time = before_;
    time.flow_dt = flow_dt;
    time.theta = 1.0;
    element.set_step_time(time);
  }
  TimeOfElements(const TimeOfElements&) = delete;
  TimeOfElements& operator=(const TimeOfElements&) = delete;
  ~TimeOfElements() { element_->set_step_time(before_); }

 private:
  ElementWork* element_;
  StepTime before_;
};

}  // namespace

ConstantRegion::ConstantRegion(const Model& model, std::vector<GroupData>& groups, ElementWork& element,
                               WorkCounters& work)
    : model_(&model), groups_(&groups), element_(&element), work_(&work), flows_(groups.size()) {
  for (const GroupData& data : groups)
    if (data.constant && data.group->solid() && data.group->entry->has_pores())
      flow_in(data).pressures = pressures_of(data);
}

bool ConstantRegion::suits(const Group& group, const LawRef& law) {
  if (!group.element->traits().linear) return false;
  if (group.flow()) return true;
  if (!group.entry->unknowns.empty()) return false;
  const auto* solid = std::get_if<const SolidLaw*>(&law);
  // Of joints the relative displacement is taken first.
  return solid == nullptr || keeps_digits(**solid);
}

// Where a group comes or goes, its states start with pressures that others have.
bool ConstantRegion::suits_in_step(const Model& model, const GroupData& data) {
  const Group& group = *data.group;
  if (!has_matrix_of_step(data) || !group.solid() || !group.entry->has_pores()) return false;
  const auto number = static_cast<int>(&group - model.groups.data());
  const bool comes_or_goes = std::ranges::any_of(model.stages, [number](const Stage& stage) {
    return std::ranges::find(stage.births, number) != stage.births.end() ||
           std::ranges::find(stage.deaths, number) != stage.deaths.end();
  });
  const std::size_t pressures = pressures_of(data);
  return !comes_or_goes && pressures > 0 && pressures <= kMostPressures &&
         keeps_digits(*std::get<const SolidLaw*>(data.law));
}

void ConstantRegion::make_matrices(GroupData& data, const std::vector<int>& shapes) {
  data.matrix = shapes;
  const int matrices = *std::max_element(data.matrix.begin(), data.matrix.end()) + 1;
  data.K.resize(static_cast<std::size_t>(matrices) * data.matrix_size());
  int made = 0;
  const TimeOfElements shut(*element_, 0.0);
  for (int e = 0; e < data.group->elements(); ++e) {
    element_->stop_if_asked_at(e);
    if (data.matrix[e] != made) continue;
    element_->evaluate(data, e, nullptr, data.K.data() + static_cast<std::size_t>(made) * data.matrix_size());
    ++made;
  }
  make_shifts(data, made);
  if (flows(data)) make_flows(data, made);
  work_->element_evaluations += made;
}

// K of a long time is all flow, but for rounding.
void ConstantRegion::make_flows(GroupData& data, int matrices) {
  const TimeOfElements long_time(*element_, kLongTime);
  PoreFlow& own = flow_in(data);
  const std::size_t n = data.dofs(), first = n - own.pressures;
  own.flow.clear();
  data.step_of_matrices = {1.0, 0.0, 1.0};
  std::vector<double> K(data.matrix_size());
  for (int e = 0, made = 0; e < data.group->elements() && made < matrices; ++e) {
    if (data.matrix[e] != made) continue;
    const double* const shut = data.matrix_of(e);
    element_->evaluate(data, e, nullptr, K.data());
    for (std::size_t j = first; j < n; ++j)
      for (std::size_t i = first; i < n; ++i) own.flow.push_back((K[j * n + i] - shut[j * n + i]) / kLongTime);
    ++made;
  }
}

bool ConstantRegion::take_step() {
  const StepTime& now = element_->step_time();
  bool changes = false;
  for (GroupData& data : *groups_) {
    if (!data.active || !flows(data) || matrices_stand(data, now)) continue;
    data.step_of_matrices = {now.dt, now.flow_dt, now.theta};
    changes = true;
  }
  return changes;
}

const double* ConstantRegion::matrix_of(const GroupData& data, int element, double* room) const {
  const double* const shut = data.matrix_of(element);
  const auto [dt, flow_dt, theta] = data.step_of_matrices;
  if (!flows(data) || flow_dt == 0.0) return shut;
  const std::size_t n = data.dofs(), first = n - flow_in(data).pressures;
  const double* flow = flow_in(data).of(data, element);
  std::copy_n(shut, data.matrix_size(), room);
  for (std::size_t j = first; j < n; ++j)
    for (std::size_t i = first; i < n; ++i) room[j * n + i] += theta * flow_dt * *flow++;
  return room;
}

void ConstantRegion::make_shifts(GroupData& data, int matrices) const {
  const std::size_t n = data.dofs(), displacements = n - flow_in(data).pressures;
  data.shift.assign(static_cast<std::size_t>(matrices) * n, 0.0);
  const bool ring =
      model_->geometry == Geometry::axisymmetric && !data.group->interface() && !data.group->flow();
  if (!ring) return;
  for (std::size_t m = 0; m < static_cast<std::size_t>(matrices); ++m)
    for (std::size_t j = 0; j < displacements; j += 2)
      for (std::size_t i = 0; i < n; ++i) data.shift[m * n + i] += data.K[(m * n + j) * n + i];
}

void ConstantRegion::take_states() {
  for (GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    data.force.clear();
    if (stress_free(data) && !flows(data)) continue;
    const TimeOfElements shut(*element_, 0.0);
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
  return n == 8 ? multiply<8> : n == 16 ? multiply<16> : n == 20 ? multiply<20> : multiply<0>;
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
  if (data.force.empty() && !flows(data) && du.isZero(0.0)) return data.trial_force.clear();
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
  const double* const start = data.force.empty() ? nullptr : data.force.data() + begin;
  double* const f = data.trial_force.data() + begin;
  const std::size_t displacements = n - flow_in(data).pressures;
  take_relative(u, displacements, heads);
  product_for(heads, n)(data.matrix_of(e), data.shift_of(e), x, u, n, start, f);
  if (flows(data)) add_flow(data, e, u + displacements, f + displacements);
}

// dp: change of an element's pressures in the step; f: of its pressures.  Differences of pressures are taken first: in a long
// step what flows is a small part of what each of them would move.
void ConstantRegion::add_flow(const GroupData& data, int e, const double* dp, double* f) const {
  const StepTime& now = element_->step_time();
  if (now.flow_dt == 0.0) return;
  const PoreFlow& own = flow_in(data);
  const std::size_t n = own.pressures, first = data.dofs() - n;
  const int* const dofs = data.dof_list.data() + static_cast<std::size_t>(e) * data.dofs() + first;
  std::array<double, kMostPressures> p;
  for (std::size_t i = 0; i < n; ++i) p[i] = (u_.size() > 0 ? u_[dofs[i]] : 0.0) + now.theta * dp[i];
  const double* flow = own.of(data, e);
  for (std::size_t j = 0; j < n; ++j) {
    const double moved = now.flow_dt * (p[j] - p[0]);
    for (std::size_t i = 0; i < n; ++i) f[i] += *flow++ * moved;
  }
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

void ConstantRegion::commit(const Eigen::VectorXd& du) {
  if (!any_flows()) return;
  if (u_.size() == 0) u_.setZero(du.size());
  u_before_ = u_;
  u_ += du;
}

void ConstantRegion::exchange(Archive& archive, bool before_step) {
  if (!any_flows()) return;
  if (archive.reading())
    archive(u_);
  else
    archive(before_step ? u_before_ : u_);
}

void ConstantRegion::add_committed_forces(Eigen::VectorXd& to) const {
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant || data.force.empty()) continue;
    for (int e = 0; e < data.group->elements(); ++e)
      data.dofs_of(e).add(data.force.data() + static_cast<std::size_t>(e) * data.dofs(), to);
  }
}

}  // namespace sage
