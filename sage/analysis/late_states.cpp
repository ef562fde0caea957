#include "sage/analysis/late_states.hpp"

#include <algorithm>
#include <utility>

namespace sage {

namespace {

void bring_up_to_date(GroupData& data, const Eigen::VectorXd& behind, ElementWork& element,
                      WorkCounters& work) {
  const auto size = static_cast<std::size_t>(data.group->element->traits().points * data.state.law_size());
  for (int e = 0; e < data.group->elements(); ++e) {
    element.evaluate(data, e, &behind, nullptr);
    const std::size_t at = static_cast<std::size_t>(e) * size;
    std::copy_n(element.sigma(), size, data.state.committed.sigma.data() + at);
    std::copy_n(element.eps(), size, data.state.committed.eps.data() + at);
  }
  std::swap(data.state.committed.h, data.state.trial.h);
  std::swap(data.state.committed.status, data.state.trial.status);
  work.element_evaluations += data.group->elements();
}

}  // namespace

void LateStates::recover(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work) {
  for (GroupData& data : groups) data.state.make_room();
  if (!is_behind_) return;
  const Profile::Scope scope(work.profile, phase::kAssembly);
  for (GroupData& data : groups)
    if (data.active && data.constant)
      bring_up_to_date(data, data.group->structure() ? structures_ : others_, element, work);
  others_.setZero();
  structures_.setZero();
  is_behind_ = false;
}

void LateStates::recover_structures(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work) {
  for (GroupData& data : groups)
    if (data.group->structure()) data.state.make_room();
  if (structures_.isZero(0.0)) return;
  const Profile::Scope scope(work.profile, phase::kAssembly);
  for (GroupData& data : groups)
    if (data.active && data.constant && data.group->structure())
      bring_up_to_date(data, structures_, element, work);
  structures_.setZero();
}

}  // namespace sage
