#include "sage/analysis/late_states.hpp"

#include <algorithm>
#include <utility>

#include "sage/core/thread_pool.hpp"

namespace sage {

namespace {

constexpr int kWorthThreads = 10000;  // elements from which on threads gain
constexpr int kUnit = 1024;           // that one of them takes at a time

// Of elements first to last - 1.
void update_states(GroupData& data, int first, int last, const Eigen::VectorXd& behind, ElementWork& element) {
  const auto size = static_cast<std::size_t>(data.group->element->traits().points * data.state.law_size());
  for (int e = first; e < last; ++e) {
    element.evaluate(data, e, &behind, nullptr);
    const std::size_t at = static_cast<std::size_t>(e) * size;
    std::copy_n(element.sigma(), size, data.state.committed.sigma.data() + at);
    std::copy_n(element.eps(), size, data.state.committed.eps.data() + at);
  }
}

void bring_up_to_date(GroupData& data, const Eigen::VectorXd& behind, ElementWork& element, WorkCounters& work,
                      int threads) {
  const int elements = data.group->elements();
  if (threads > 1 && elements >= kWorthThreads) {
    ThreadPool pool(threads);
    std::vector<ElementWork> rooms(static_cast<std::size_t>(pool.threads()), element);
    pool.run((elements + kUnit - 1) / kUnit, [&](int unit, int thread) {
      update_states(data, unit * kUnit, std::min((unit + 1) * kUnit, elements), behind,
                    rooms[static_cast<std::size_t>(thread)]);
    });
  } else {
    update_states(data, 0, elements, behind, element);
  }
  std::swap(data.state.committed.h, data.state.trial.h);
  std::swap(data.state.committed.status, data.state.trial.status);
  work.element_evaluations += data.group->elements();
}

}  // namespace

void LateStates::recover(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work,
                         int threads) {
  for (GroupData& data : groups) data.state.make_room();
  if (!is_behind_) return;
  const Profile::Scope scope(work.profile, phase::kAssembly);
  for (GroupData& data : groups)
    if (data.active && data.constant)
      bring_up_to_date(data, data.group->structure() ? structures_ : others_, element, work, threads);
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
      bring_up_to_date(data, structures_, element, work, 1);
  structures_.setZero();
}

}  // namespace sage
