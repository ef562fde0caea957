#include "sage/analysis/changing_region.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/kept_matrices.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

ChangingRegion::ChangingRegion(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work)
    : groups_(&groups), element_(&element), work_(&work) {}

Outcome ChangingRegion::evaluate_by_four(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  const std::size_t dofs = data.dofs();
  const bool add_now = tangent != nullptr && !data.keeps_matrices();
  for (int first = 0; first < data.group->elements(); first += kAbreast) {
    element_->stop_if_asked_at(first);
    bool changed = false;
    if (element_->evaluate_four(data, first, du, tangent != nullptr, changed) == Outcome::cut_step)
      return Outcome::cut_step;
    const int last = std::min(first + kAbreast, data.group->elements());
    for (int e = first; e < last; ++e) {
      const auto place = static_cast<std::size_t>(e - first);
      add_force(data, e, element_->f() + place * dofs, forces_, sums_);
      if (add_now) add_matrix(data, e, element_->K() + place * dofs * dofs, *tangent);
    }
    if (changed && tangent != nullptr && !add_now) tangent->differs();
  }
  work_->element_evaluations += data.group->elements();
  return Outcome::ok;
}

Outcome ChangingRegion::evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent) {
  if (data.by_four) return evaluate_by_four(data, du, tangent);
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
  work_->element_evaluations += data.group->elements();
  return Outcome::ok;
}

Outcome ChangingRegion::evaluate(const Eigen::VectorXd& du, Tangent* tangent) {
  forces_.setZero();
  sums_.fill(0.0);
  for (GroupData& data : *groups_)
    if (data.active && !data.constant && evaluate_group(data, du, tangent) == Outcome::cut_step)
      return Outcome::cut_step;
  return Outcome::ok;
}

}  // namespace sage
