// One screen about a run, for the terminal.
#pragma once

#include <filesystem>

#include "sage/record/discretisation.hpp"
#include "sage/record/extremes.hpp"
#include "sage/record/output.hpp"
#include "sage/record/push.hpp"
#include "sage/record/report.hpp"
#include "sage/record/strength.hpp"

namespace sage {

// Collects what the summary tells.  Costs nothing worth counting.
class RunRecord final : public Observer {
 public:
  struct StageCount {
    int increments = 0, iterations = 0, cuts = 0;
  };

  void on_warning(const Diagnostic& d) override;
  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override;
  void on_stage_start(const Model& model, int stage, const Solution& solution) override {
    strength.start(model, stage, solution);
  }
  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_stage_end(const Model&, int stage, const EquilibriumAudit&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  // At the ends of stages, for the extremes of structures.
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  // Forces of supports that are moved.
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char> behind) const override {
    return Pushes::needs_nodes(model, report.stage, behind);
  }
  bool wants_structures(const Model& model, const StepReport& report) const override {
    return has_structures(model) && report.increment == model.stages[report.stage].increments;
  }
  void on_finish(const Model&, const RunResult&) override;
  void exchange(Archive& archive) override;

  Scene scene;
  std::string solver;
  int equations = 0;
  int warnings = 0;                      // of the run and of reading
  std::string notes;                     // of the run, a line each
  std::vector<StageCount> stages;        // those begun
  std::array<long, kStatuses> points{};  // at the last increment
  double out_of_balance = 0.0;           // the largest of all stages
  int audited = 0;                       // stages that reached their end
  StrengthRows strength;
  Pushes pushes;
  std::vector<ExtremeRow> structures;  // at the end of each stage
  Envelope envelope;                   // of the same stages, at the ends of elements
  StepReport failed;                   // of a run that did not converge
  RunResult result;
  // Of the whole run, for the caller to fill in; not shown before.
  double seconds = 0.0;
  Profile profile;
};

// About 30 lines of at most 80 columns.  A run that did not converge says so in its second line and in its last.  digits:
// of the reports' numbers; 0 = as many as fit the eye.  sketch: lines that stand behind the reports (sketch_text).
// details: also the kind of scene, the work and its times.
std::string summary(const Model& model, const RunRecord& record, const Reports* reports,
                    const std::vector<std::filesystem::path>& files, const DiscretisationError* error = nullptr,
                    int digits = 0, const std::string& sketch = "", bool details = false);

}  // namespace sage
