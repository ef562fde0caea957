#include "sage/analysis/skips/changing_region.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sage/analysis/skips/kept_matrices.hpp"
#include "sage/analysis/tangent.hpp"
#include "sage/core/calls_in_order.hpp"

namespace sage {

namespace {

constexpr int kUnit = 16 * kAbreast;  // elements that a thread takes at a time
// Points from which on threads gain: waking one takes as long as some tens of elements.
constexpr int kWorthThreads = 2400;

bool are_many(const Group& group) {
  return group.elements() * group.element->traits().points >= kWorthThreads;
}

bool needs_order_of(const LawRef& law) {
  return std::visit([](const auto* held) { return held != nullptr && needs_order(*held); }, law);
}

// Elements give the same on any thread; loads that follow the motion go into one sum.
bool may_be_divided(const GroupData& data) {
  return data.followed.empty() && !needs_order_of(data.law) && !needs_order_of(data.second_law);
}

}  // namespace

ChangingRegion::ChangingRegion(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work)
    : groups_(&groups), element_(&element), work_(&work) {}

void ChangingRegion::set_threads(int threads) {
  const bool useful = std::ranges::any_of(
      *groups_, [](const GroupData& data) { return !data.constant && are_many(*data.group); });
  pool_ = useful && threads > 1 ? std::make_unique<ThreadPool>(threads) : nullptr;
  own_.assign(pool_ != nullptr ? static_cast<std::size_t>(threads) : 0, *element_);
}

bool ChangingRegion::divides(const GroupData& data) const {
  return pool_ != nullptr && are_many(*data.group) && may_be_divided(data);
}

// f: forces of elements first, first + 1 ..., one after the other.
void ChangingRegion::add_forces(const GroupData& data, int first, int last, const double* f) {
  for (int e = first; e < last; ++e, f += data.dofs()) add_force(data, e, f, forces_, sums_);
}

// One unit, of elements first, first + 1 ...; f as in add_forces.  Matrices go where the group keeps them.
Outcome ChangingRegion::evaluate_unit(GroupData& data, const PassFourAbreast& pass, int first, double* f,
                                      bool with_K, bool& changed) const {
  element_->stop_if_asked_at(first);
  const std::size_t dofs = data.dofs();
  const int last = std::min(first + kUnit, data.group->elements());
  for (int e = first; e < last; e += kAbreast, f += kAbreast * dofs) {
    double* K = with_K ? data.K.data() + static_cast<std::size_t>(e) * dofs * dofs : nullptr;
    if (pass.evaluate(e, f, K, changed) == Outcome::cut_step) return Outcome::cut_step;
  }
  return Outcome::ok;
}

Outcome ChangingRegion::evaluate_in_units(GroupData& data, const PassFourAbreast& pass, Tangent* tangent) {
  bool changed = false;
  element_forces_.resize(std::max(element_forces_.size(), std::size_t{kUnit} * data.dofs()));
  double* const f = element_forces_.data();
  for (int first = 0; first < data.group->elements(); first += kUnit) {
    if (evaluate_unit(data, pass, first, f, tangent != nullptr, changed) == Outcome::cut_step)
      return Outcome::cut_step;
    add_forces(data, first, std::min(first + kUnit, data.group->elements()), f);
  }
  if (changed && tangent != nullptr) tangent->differs();
  return Outcome::ok;
}

// Threads make what belongs to one element alone; sums over elements have the order that they have on one thread.
Outcome ChangingRegion::evaluate_on_threads(GroupData& data, const PassFourAbreast& pass, Tangent* tangent) {
  const int elements = data.group->elements();
  const std::size_t dofs = data.dofs();
  element_forces_.resize(std::max(element_forces_.size(), static_cast<std::size_t>(elements) * dofs));
  std::atomic<bool> changed = false, cut = false;
  pool_->run((elements + kUnit - 1) / kUnit, [&](int unit, int /*thread*/) {
    const int first = unit * kUnit;
    double* const f = element_forces_.data() + static_cast<std::size_t>(first) * dofs;
    bool differs = changed;
    if (evaluate_unit(data, pass, first, f, tangent != nullptr, differs) == Outcome::cut_step) cut = true;
    if (differs) changed = true;
  });
  if (cut) return Outcome::cut_step;
  add_forces(data, 0, elements, element_forces_.data());
  if (changed && tangent != nullptr) tangent->differs();
  return Outcome::ok;
}

// Of a group that keeps no matrices.
Outcome ChangingRegion::evaluate_and_add(GroupData& data, const PassFourAbreast& pass, Tangent& tangent) {
  const std::size_t dofs = data.dofs();
  element_forces_.resize(std::max(element_forces_.size(), kAbreast * dofs));
  element_matrices_.resize(std::max(element_matrices_.size(), kAbreast * dofs * dofs));
  for (int first = 0; first < data.group->elements(); first += kAbreast) {
    element_->stop_if_asked_at(first);
    bool changed = true;
    if (pass.evaluate(first, element_forces_.data(), element_matrices_.data(), changed) == Outcome::cut_step)
      return Outcome::cut_step;
    const int last = std::min(first + kAbreast, data.group->elements());
    add_forces(data, first, last, element_forces_.data());
    for (int e = first; e < last; ++e)
      add_matrix(data, e, element_matrices_.data() + static_cast<std::size_t>(e - first) * dofs * dofs,
                 tangent);
  }
  return Outcome::ok;
}

Outcome ChangingRegion::evaluate_four_abreast(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  prepare_four_abreast(element_->model().mesh, data);
  const PassFourAbreast pass(data, du);
  if (tangent != nullptr && !data.keeps_matrices()) return evaluate_and_add(data, pass, *tangent);
  return divides(data) ? evaluate_on_threads(data, pass, tangent) : evaluate_in_units(data, pass, tangent);
}

Outcome ChangingRegion::evaluate_in_turn(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  double* const K = tangent != nullptr ? element_->K() : nullptr;
  for (int e = 0; e < data.group->elements(); ++e) {
    element_->stop_if_asked_at(e);
    if (element_->evaluate(data, e, &du, K) == Outcome::cut_step) return Outcome::cut_step;
    add_force(data, e, element_->f(), forces_, sums_);
    if (tangent == nullptr) continue;
    if (!data.keeps_matrices())
      add_matrix(data, e, K, *tangent);
    else if (replace_matrix(data, e, K))
      tangent->differs();
  }
  return Outcome::ok;
}

// Elements first ... last - 1 on threads, each with buffers of its own.  Matrices go where the group keeps them, or else to
// element_matrices_.
Outcome ChangingRegion::evaluate_block(GroupData& data, const Eigen::VectorXd& du, Block block, bool with_K,
                                       bool& changed) {
  const std::size_t dofs = data.dofs(), size = data.matrix_size();
  std::atomic<bool> differs = false, cut = false;
  pool_->run((block.last - block.first + kUnit - 1) / kUnit, [&](int unit, int thread) {
    ElementWork& own = own_[thread];
    const int first = block.first + unit * kUnit, last = std::min(first + kUnit, block.last);
    for (int e = first; e < last && !cut; ++e) {
      own.stop_if_asked_at(e);
      const auto place = static_cast<std::size_t>(e - block.first);
      double* K = nullptr;
      if (with_K) K = data.keeps_matrices() ? own.K() : element_matrices_.data() + place * size;
      if (own.evaluate(data, e, &du, K) == Outcome::cut_step) cut = true;
      std::copy_n(own.f(), dofs, element_forces_.data() + place * dofs);
      if (with_K && data.keeps_matrices() && replace_matrix(data, e, K)) differs = true;
    }
  });
  changed = changed || differs;
  return cut ? Outcome::cut_step : Outcome::ok;
}

// Sums over elements have the order that they have on one thread.
Outcome ChangingRegion::evaluate_side_by_side(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  constexpr int kBlock = 16 * kUnit;  // elements whose matrices have a place until they are added
  const int elements = data.group->elements();
  const bool adds = tangent != nullptr && !data.keeps_matrices();
  const std::size_t room = std::min(elements, kBlock);
  element_forces_.resize(std::max(element_forces_.size(), room * data.dofs()));
  if (adds) element_matrices_.resize(std::max(element_matrices_.size(), room * data.matrix_size()));
  element_->prepare(data);
  for (ElementWork& own : own_) own.go_on_from(*element_);
  bool changed = false;
  for (int first = 0; first < elements; first += kBlock) {
    const Block block{first, std::min(first + kBlock, elements)};
    if (evaluate_block(data, du, block, tangent != nullptr, changed) == Outcome::cut_step)
      return Outcome::cut_step;
    add_forces(data, block.first, block.last, element_forces_.data());
    if (adds) add_matrices(data, block, element_matrices_.data(), *tangent);
  }
  if (changed && tangent != nullptr) tangent->differs();
  return Outcome::ok;
}

Outcome ChangingRegion::evaluate_one_by_one(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  const bool in_step = has_matrix_of_step(data);
  if (tangent != nullptr && in_step && matrices_stand(data, element_->step_time())) tangent = nullptr;
  const Outcome outcome =
      divides(data) ? evaluate_side_by_side(data, du, tangent) : evaluate_in_turn(data, du, tangent);
  if (outcome == Outcome::cut_step) return outcome;
  if (tangent != nullptr && in_step) {
    const StepTime& now = element_->step_time();
    data.step_of_matrices = {now.dt, now.flow_dt, now.theta};
  }
  return Outcome::ok;
}

Outcome ChangingRegion::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  element_->begin_pass();
  forces_.setZero();
  sums_.fill(0.0);
  for (GroupData& data : *groups_) {
    if (!data.active || data.constant) continue;
    const Outcome outcome =
        data.four_abreast() ? evaluate_four_abreast(data, du, tangent) : evaluate_one_by_one(data, du, tangent);
    if (outcome == Outcome::cut_step) return Outcome::cut_step;
    work_->element_evaluations += data.group->elements();
  }
  return Outcome::ok;
}

void ChangingRegion::add_matrices(const GroupData& data, Block block, const double* K, Tangent& tangent) const {
  const std::size_t size = data.matrix_size();
  const ElementMatrices matrices{data.first_element + block.first, block.last - block.first, K, size};
  if (divides(data)) {
    const int parts = pool_->threads();
    pool_->run(parts, [&](int part, int /*thread*/) { tangent.add_part(matrices, part, parts); });
  } else {
    tangent.add_part(matrices, 0, 1);
  }
  for (int e = block.first; e < block.last; ++e)
    if (data.moved[e]) tangent.couple(data.dofs_of(e), K + static_cast<std::size_t>(e - block.first) * size);
}

void ChangingRegion::add_kept(const GroupData& data, Tangent& tangent) const {
  add_matrices(data, {0, data.group->elements()}, data.K.data(), tangent);
}

}  // namespace sage
