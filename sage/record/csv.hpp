// Comma-separated tables for programs.  Lines that start with '#' are comments (signs and units; how the run
// ended); then one header line with the unit of each column in brackets.  Blank = not known or does not apply.
#pragma once

#include "sage/record/end_forces.hpp"
#include "sage/record/number.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/output.hpp"

namespace sage {

struct CsvOptions {
  bool increments = true;  // STEM.increments.csv: a row an increment
  bool nodes = false;      // STEM.nodes.csv: a row a node of an output increment
  // STEM.points.csv and, where there are interfaces or structures, STEM.interfaces.csv and STEM.structures.csv; of
  // structures also STEM.ends.csv (a row an end of an element) and STEM.envelope.csv (of all stages).
  bool points = false;
  int digits = kCsvDigits;
  std::vector<std::string> fields = {};  // more of the table's fields, behind the usual columns
};

class Csv final : public Output {
 public:
  // Throws OutputError.
  Csv(const std::filesystem::path& folder, const std::string& stem, CsvOptions options = {});

  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override;
  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  void on_stage_end(const Model&, int stage, const EquilibriumAudit&, const Solution&) override;
  void on_finish(const Model&, const RunResult&) override;
  bool wants_states(const Model& model, const StepReport& report) const override {
    return wants_points_ && is_output_increment(stage_of(model, report.stage), report);
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return (wants_points_ || nodes_.file.open()) && is_output_increment(stage_of(model, report.stage), report);
  }
  void exchange(Archive& archive) override;
  void stop(const std::string& reason) override;
  std::vector<std::filesystem::path> files() const override { return files_; }

 private:
  struct Table {
    OutFile file;
    FieldList fields;  // columns, in this order
  };
  std::array<Table*, 8> all() {
    return {&increments_, &nodes_, &points_, &interfaces_, &structures_, &flows_, &ends_, &envelope_table_};
  }
  Table& of(ElementKind kind);
  void open(Table& table, const std::string& header, const Model& model);
  void choose_fields(const Model& model);
  void add_increment(const Model&, const StepReport&);
  void add_states(const Model&, const StepReport&, const Solution&);
  void open_ends(const Model&);
  void add_ends(const Model&, const StepReport&, const Solution&);
  void add_envelope(const Model&);
  void comment(const std::string& line);
  void finish();

  std::filesystem::path folder_;
  std::string stem_;
  int digits_;
  std::vector<std::string> asked_;  // fields
  bool wants_points_;
  FieldTable fields_;                                                  // of the model
  std::vector<FieldEntry> unknowns_;                                   // besides displacement
  std::array<std::vector<FieldEntry>, kElementKinds.size()> history_;  // of the laws of each kind
  Table increments_, nodes_, points_, interfaces_, structures_, flows_, ends_, envelope_table_;
  std::vector<std::size_t> quantities_;  // of ends
  Envelope envelope_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace sage
