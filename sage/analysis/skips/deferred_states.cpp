#include "sage/analysis/skips/deferred_states.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "sage/platform/thread_pool.hpp"

namespace sage {

namespace {

void take_time(ElementWork& element, const Eigen::VectorXd& committed, double flow_dt) {
  StepTime time = element.step_time();
  time.flow_dt = flow_dt;
  time.theta = 1.0;
  element.set_step_time(time);
  element.set_committed(&committed);
}

}  // namespace

void DeferredStates::seep(const Eigen::VectorXd& du, const Eigen::VectorXd& before, const StepTime& time) {
  if (start_.size() == 0) {
    start_ = before;
    seepage_.setZero(du.size());
  }
  if (time.flow_dt != 0.0) seepage_ += time.flow_dt * (before + time.theta * du);
}

// Where water has flowed, first what the integral of the pressures moves in a unit of time, then all else in none.
void DeferredStates::bring_up_to_date(GroupData& data, const Eigen::VectorXd& behind,
                                      const ElementWork& element, WorkCounters& work, int threads) const {
  const bool seeps = seeps_ && data.group->solid() && data.group->entry->has_pores();
  const std::size_t history = data.state.history_size() * data.group->element->traits().points;
  const auto size = static_cast<std::size_t>(data.group->element->traits().points * data.state.law_size());
  const auto elements = static_cast<std::size_t>(data.group->elements());
  constexpr std::size_t kWorthThreads = 10000;  // elements from which on threads gain
  std::optional<ThreadPool> pool;
  if (threads > 1 && elements >= kWorthThreads) pool.emplace(threads);
  in_pieces(pool ? &*pool : nullptr, elements, [&](std::size_t first, std::size_t last) {
    ElementWork room = element;
    for (std::size_t e = first; e < last; ++e) {
      if (seeps) {
        take_time(room, seepage_, 1.0);
        room.evaluate(data, static_cast<int>(e), nullptr, nullptr);
        std::copy_n(data.state.trial.h.data() + e * history, history,
                    data.state.committed.h.data() + e * history);
        take_time(room, start_, 0.0);
      }
      room.evaluate(data, static_cast<int>(e), &behind, nullptr);
      std::copy_n(room.sigma(), size, data.state.committed.sigma.data() + e * size);
      std::copy_n(room.eps(), size, data.state.committed.eps.data() + e * size);
    }
  });
  std::swap(data.state.committed.h, data.state.trial.h);
  std::swap(data.state.committed.status, data.state.trial.status);
  work.element_evaluations += data.group->elements();
}

void DeferredStates::recover(std::vector<GroupData>& groups, ElementWork& element, WorkCounters& work,
                             int threads) {
  for (GroupData& data : groups) data.state.make_room();
  if (!is_behind_) return;
  const Profile::Scope scope(work.profile, phase::kAssembly);
  for (GroupData& data : groups) {
    const Eigen::VectorXd& behind = data.group->structure() ? structures_ : others_;
    if (data.active && data.constant && behind.size() > 0)
      bring_up_to_date(data, behind, element, work, threads);
  }
  others_.resize(0);
  structures_.resize(0);
  start_.resize(0);
  seepage_.resize(0);
  is_behind_ = false;
}

void DeferredStates::recover_structures(std::vector<GroupData>& groups, ElementWork& element,
                                        WorkCounters& work) {
  for (GroupData& data : groups)
    if (data.group->structure()) data.state.make_room();
  if (structures_.size() == 0) return;
  const Profile::Scope scope(work.profile, phase::kAssembly);
  for (GroupData& data : groups)
    if (data.active && data.constant && data.group->structure())
      bring_up_to_date(data, structures_, element, work, 1);
  structures_.resize(0);
}

}  // namespace sage
