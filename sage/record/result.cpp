#include "sage/record/result.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

// A group's committed states without what is kept of its elements.
GroupData states_of(const GroupData& data) {
  GroupData copy(*data.group);
  copy.law = data.law;
  copy.active = data.active;
  const PointHistory history = history_of(data.law, data.group->element->traits());
  copy.state = StateStore(0, data.state.law_size(), history, false);
  copy.state.committed = data.state.committed;
  copy.pore = data.pore;
  return copy;
}

}  // namespace

Frame::Frame(const Model& model, const StepReport& report, const Solution& now)
    : report_(report), u_(*now.u), internal_(*now.internal), external_(*now.external), activity_(model) {
  if (report_.iterations.size() > 1)
    report_.iterations.erase(report_.iterations.begin(), report_.iterations.end() - 1);
  activity_ = *now.activity;
  for (const GroupData& data : now.groups()) {
    groups_.push_back(states_of(data));
    if (data.active)
      for (double sigma : data.state.committed.sigma)
        largest_stress_ = std::max(largest_stress_, std::abs(sigma));
  }
}

Frame::Frame(const Model& model) : activity_(model) {
  for (const Group& group : model.groups) {
    GroupData data(group);
    data.law = model.material_of(group).law_ref();
    const ElementTraits& traits = group.element->traits();
    data.state = StateStore(0, traits.law_size, history_of(data.law, traits), false);
    if (!model.water.empty() && group.solid())
      data.pore.assign(group.elements() * group.element->traits().points, 0.0);
    groups_.push_back(std::move(data));
  }
}

void Frame::exchange_report(Archive& archive) {
  StepReport& r = report_;
  archive(r.cuts);
  archive(r.substeps);
  archive(r.iterations);
  archive(r.total_iterations);
  archive(r.points);
  archive(r.worst.node);  // member by member: the bytes between them are nobody's
  archive(r.worst.field);
  archive(r.worst.component);
  archive(r.worst.residual);
  archive(r.smallest_pivot_ratio);
  archive(r.motion);
}

std::size_t Frame::size_of_state() const {
  constexpr std::size_t kCounts = 4096;
  std::size_t numbers = static_cast<std::size_t>(u_.size() + internal_.size() + external_.size()),
              words = activity_.held.size();
  for (const GroupData& data : groups_) {
    const PointStates& state = data.state.committed;
    numbers += state.sigma.size() + state.eps.size() + state.h.size() + data.pore.size();
    words += state.status.size();
  }
  return kCounts + numbers * sizeof(double) + words * sizeof(int);
}

bool Frame::follows_from_fields(const GroupData& data) {
  return data.active && data.group->solid() && data.group->excess < 0 && data.state.law_size() == 4;
}

void Frame::set_fields(std::size_t group, std::vector<double> stress, std::vector<double> strain) {
  PointStates& state = groups_[group].state.committed;
  for (std::vector<double>* values : {&stress, &strain})
    for (double& value : *values) value = 0.0 - value;
  state.sigma = std::move(stress);
  state.eps = std::move(strain);
}

void Frame::exchange_state(Archive& archive, bool whole) {
  archive(report_.stage);
  archive(report_.increment);
  archive(report_.increments);
  archive(report_.load_factor);
  archive(report_.converged);
  archive(u_);
  archive(internal_);
  archive(external_);
  archive(activity_.group);
  archive(activity_.held);
  for (TurnedNode& node : activity_.turned) {
    archive(node.by_xy);
    for (TurnedNode::Axis& axis : node.axes) archive(axis.held);
    archive(node.slides);
    archive(node.slide);
  }
  for (GroupData& data : groups_) {
    archive(data.active);
    PointStates& state = data.state.committed;
    if (whole || !follows_from_fields(data)) {
      archive(state.sigma);
      archive(state.eps);
    }
    archive(state.h);
    archive(state.status);
    if (!data.pore.empty()) archive(data.pore);
  }
}

void Result::on_stage_start(const Model& model, int stage, const Solution& now) {
  StepReport report;
  report.stage = stage;
  last_ = report;
  starts_.emplace_back(model, report, now);
  if (starts_.size() > 1) starts_.back().drop_points();
}

void Result::on_increment(const Model&, const StepReport& report, const Solution&) {
  last_ = report;
}

void Result::end(const Model& model, const StepReport& report, const Solution& now) {
  if (!ends_.empty()) ends_.back().drop_points();
  ends_.emplace_back(model, report, now);
}

void Result::on_stage_end(const Model& model, int, const EquilibriumAudit&, const Solution& now) {
  end(model, last_, now);
}

void Result::on_failure(const Model& model, const StepReport& report, const std::string&, const Solution& now) {
  end(model, report, now);
}

}  // namespace sage
