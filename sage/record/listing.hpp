// The listing: what was read, what was done and what came out, in columns, for people.
#pragma once

#include "sage/core/catalogue.hpp"
#include "sage/record/extremes.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/output.hpp"
#include "sage/record/report.hpp"
#include "sage/record/strength.hpp"

namespace sage {

// Tables of nodes, points and interfaces.  automatic = stage_end, or none in a model of more than
// kManyPoints points (a failed run still shows its last converged state).
enum class Tables { automatic, none, stage_end, all };

inline constexpr int kManyPoints = 20000;

struct ListingOptions {
  Tables tables = Tables::automatic;
  std::string date = {};                 // shown if given; left out, so that listings compare
  const Reports* reports = nullptr;      // whose rows the listing repeats at its end
  std::vector<std::string> fields = {};  // more of the table's fields, behind the usual columns
};

// STEM.lst
class Listing final : public Output {
 public:
  // Throws OutputError.  The catalogue names the parameters and must outlive the listing.
  Listing(const std::filesystem::path& folder, const std::string& stem, const Catalogue& catalogue,
          ListingOptions options = {});

  void on_warning(const Diagnostic&) override;
  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override;
  void on_stage_start(const Model&, int stage, const Solution&) override;
  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_stage_end(const Model&, int stage, const EquilibriumAudit&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  void on_finish(const Model&, const RunResult&) override;
  bool wants_states(const Model& model, const StepReport& report) const override {
    const bool last = report.increment == report.increments;
    return last ? tables_ != Tables::none
                : tables_ == Tables::all && is_output_increment(stage_of(model, report.stage), report);
  }
  void exchange(Archive& archive) override;
  void stop(const std::string& reason) override;
  std::vector<std::filesystem::path> files() const override;

 private:
  void warn(const Diagnostic&);

  OutFile file_;
  const Catalogue* catalogue_;
  ListingOptions options_;
  Tables tables_ = Tables::stage_end;
  std::vector<Diagnostic> early_;  // warnings from before the header
  StrengthRows strength_;
  std::vector<ExtremeRow> structures_;  // at the ends of stages
  Envelope envelope_;
  bool started_ = false, columns_shown_ = false;
  std::string last_state_;  // "stage 2, increment 10, load factor 1"
};

}  // namespace sage
