// States of a run that outlive it: what pictures, comparisons, tables and the result file read, so that nobody
// runs a model twice or reads its own output files.
#pragma once

#include <vector>

#include "sage/record/output.hpp"

namespace sage {

// One committed state, with all that the table's fields are computed from.
class Frame {
 public:
  // The model must outlive the frame.
  Frame(const Model& model, const StepReport& report, const Solution& now);
  // Empty, to be filled by exchange().
  explicit Frame(const Model& model);

  // Of iterations only the last.
  const StepReport& report() const { return report_; }
  // Stands for the solution that the frame was made of; has no assembly.
  Solution view() const {
    return {&u_, &internal_, &external_, nullptr, &activity_, groups_, report_.stage, report_.load_factor};
  }
  double largest_stress() const { return largest_stress_; }  // |component| of all active points
  // What is left are displacements and forces.
  void drop_points() { groups_.clear(); }
  // To bytes and back, the one behind the other: most of the report, and all else.  Equal states give equal bytes,
  // whether or not the run was interrupted.  whole = false: without stress and strain of groups whose fields
  // say them (follows_from_fields).
  void exchange_report(Archive& archive);
  void exchange_state(Archive& archive, bool whole = true);
  std::size_t size_of_state() const;  // bytes, about
  // Whether the fields `stress` and `strain` of a group say all of its points' stress and strain: they are those of
  // solids, compression positive.
  static bool follows_from_fields(const GroupData& data);
  // The values of these fields, one point behind the other, for the group of this place.
  void set_fields(std::size_t group, std::vector<double> stress, std::vector<double> strain);

 private:
  StepReport report_;
  Eigen::VectorXd u_, internal_, external_;
  Activity activity_;
  std::vector<GroupData> groups_;  // committed states alone
  double largest_stress_ = 0.0;
};

// In memory: the start and the end of every stage, or what the run reached of the last one.  Points have states at
// the start of the run and at its end.
class Result final : public Observer {
 public:
  void on_stage_start(const Model&, int stage, const Solution&) override;
  void on_increment(const Model&, const StepReport& report, const Solution&) override;
  void on_stage_end(const Model&, int stage, const EquilibriumAudit&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  bool wants_states(const Model&, const StepReport& report) const override {
    return report.increment == 0 || report.increment == report.increments;
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return wants_states(model, report);
  }

  // One a stage that has begun.  An end that was not reached has none.
  const std::vector<Frame>& starts() const { return starts_; }
  const std::vector<Frame>& ends() const { return ends_; }

 private:
  void end(const Model& model, const StepReport& report, const Solution& now);

  std::vector<Frame> starts_, ends_;
  StepReport last_;
};

}  // namespace sage
