// What the mesh leaves uncertain, for the summary: the Zienkiewicz-Zhu estimate of the stress error, and what
// follows from it for a triaxial ratio.
#pragma once

#include <optional>
#include <string>

#include "sage/analysis/error_estimate.hpp"
#include "sage/record/report.hpp"

namespace sage {

// Estimated at the end of the last stage (or of the last increment in equilibrium).
class DiscretisationError final : public Observer {
 public:
  // reports: of the same run, notified of every event before this.
  explicit DiscretisationError(const Reports& reports) : reports_(&reports) {}

  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override;
  void on_stage_start(const Model&, int stage, const Solution&) override;
  void on_stage_end(const Model&, int stage, const EquilibriumAudit&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;

  // The ends of stages: the last one is measured, the report's counts from the end of the one before it.
  bool wants_states(const Model&, const StepReport& report) const override {
    return report.increment == 0 || report.increment == report.increments;
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return wants_states(model, report);
  }
  void exchange(Archive&) override;

  const std::optional<ErrorEstimate>& estimate() const { return estimate_; }
  // Error of the last ratio of the first triaxial report; nothing where it does not follow from the energy.
  //
  // The end moves by d, all else is held at zero: F d = a(u, u), and the mesh's
  // F_h d = a(u_h, u_h) = a(u, u) + |e|^2.  So F_h - F = |e|^2 / d, the square of the error in the energy norm of what the report's stages add.
  const std::optional<double>& ratio_error() const { return ratio_error_; }
  // Why a model has no estimate, for the summary; empty: it has one.
  static std::string why_none(const Model& model);
  // Lines of the summary.
  std::string text(const Model& model) const;

 private:
  void compute(const Model& model, const Solution& solution);

  const Reports* reports_;
  bool linear_ = false;
  int report_ = -1;  // the first triaxial one
  std::optional<StressState> start_;
  std::optional<ErrorEstimate> estimate_;
  std::optional<double> ratio_error_;
};

// The number of digits that an error leaves: "1.0863 +- 0.0004".
std::string with_error(double value, double error);

}  // namespace sage
