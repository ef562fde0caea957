// Reports that the deck asks for: a triaxial test against the law's own answer, sums over nodes, and points.
#pragma once

#include <memory>

#include "sage/core/point_driver.hpp"
#include "sage/model/flow_line.hpp"
#include "sage/record/number.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/output.hpp"
#include "sage/record/sampler.hpp"
#include "sage/record/section_forces.hpp"
#include "sage/record/uplift.hpp"

namespace sage {

// One increment of a triaxial report.  Compression positive, in the deck's units; NaN = not known.
//   force              F = - sum over the report's nodes of the internal force in y (full circle, or unit
//   thickness) axial_strain       - (mean u_y - its value at the start of the report's stage) / height
//   measured_deviator  (F - F at the start of the stage) / area
//                      (large strain: F at the start grows as the area of the nodes does, which the cell pressure follows)
//   correct_deviator   of one point of the law under the same axial strain with frictionless ends: both lateral
//                      stresses stay at the cell pressure (plane strain: sigma_xx stays and eps_zz = 0)
//   *_axial            cell pressure + deviator
//   *_corrected        under large strain: deviators by the area of a cylinder (or strip) that stays one, with the
//                      volume of the correct test; the others are nominal, by the first area
//   ratio              measured_deviator / correct_deviator
//   held               part of the force that neither loads nor supports put there: forces that are let go over
//                      the stage (a release, an excavation, an initial stress out of balance) and stand in part
struct TriaxialRow {
  int stage = 0, increment = 0;  // both from 1
  double axial_strain = 0.0, force = 0.0;
  double measured_deviator = 0.0, correct_deviator = 0.0;
  double measured_axial = 0.0, correct_axial = 0.0;
  double ratio = 0.0;
  double measured_corrected = 0.0, correct_corrected = 0.0;
  double held = 0.0;
  double duration = 1.0;  // of the increment, for laws that depend on time
};

// One increment of a node report.  Mean displacement of the nodes since the start of the report's stage, and
// the sum of the forces that loads and supports put on them, with what is still held of forces that are let go
// over the stage (held: that part alone, 0 where it is not worth a word); all along +x and +y.
struct NodesRow {
  int stage = 0, increment = 0;
  double displacement[2] = {0, 0};
  double force[2] = {0, 0};
  double held[2] = {0, 0};
  // Of models with pore water: the time (sum of the stages' durations), the mean excess pressure of those nodes that have
  // one, the volume that has left through those that are held, and the degree of consolidation of the model: 1 less the
  // mean excess pressure over that at the start of the last stage of consolidation.  NaN = there is none.
  double pores[4] = {};
};

// One increment of a point report.  Displacement along +x and +y and strain since the start of the report's
// stage, or since the place was filled; stress as it is.  Strain and stress [xx yy zz xy] compression positive,
// engineering shear; NaN while nothing is active there.
struct PointRow {
  int stage = 0, increment = 0;
  double displacement[2] = {0, 0};
  double strain[4] = {0, 0, 0, 0};
  double stress[4] = {0, 0, 0, 0};
  double mean = 0.0, deviator = 0.0;  // p = (xx + yy + zz) / 3 and q = sqrt(3 J2) of that stress
  // Instead, where the model has elements of flow alone: head, pressure head, velocity along x and y.
  double flow[4] = {0, 0, 0, 0};
};

// One increment of a discharge report: FlowThrough of the line; NaN while nothing that water flows through is
// active on its left.
struct DischargeRow {
  int stage = 0, increment = 0;
  double discharge = 0.0, gradient = 0.0, head = 0.0;
  double force[2] = {0, 0};
};

// A stage of an uplift report (uplift.hpp).
struct UpliftRow {
  int stage = 0, increment = 0;  // its last
  Uplift value;
};

// One increment of a section report (section_forces.hpp).
struct SectionRow {
  int stage = 0, increment = 0;
  SectionForces value;
};

// The usual fields of a point report, whose values are those numbers; then come those of Report::fields.
FieldList point_report_fields(const Model& model, const FieldTable& table, const Report& report);

// A column of a report's file, behind stage and increment.
struct ReportColumn {
  std::string name, unit;
  bool optional = false;  // may have no value: blank
};
std::vector<ReportColumn> report_columns(const Model& model, const Report& report);

// "report 2", or with the name and place of a point or a cut: "report 2, crest at (0.5; 1)", "report 3, slab from (0; 1) to (0; 2)".
std::string report_title(const Model& model, std::size_t index);

// Where a triaxial report's frictionless test starts.  Tension positive, the law's own signs; empty: the isotropic
// cell pressure, the law's own history.
struct SpecimenStart {
  std::vector<double> sigma, history;
  std::string note;  // why it is not where the mesh starts; empty: it is
};
// The stress and history of the specimen's points, where all are alike; the stress only if the lateral stresses that are
// held are the cell pressure.
SpecimenStart start_of_specimen(const Model& model, const Report& report, const Solution& solution);

// The frictionless test: axial strain is given, the lateral stress stays at the cell pressure.
class CorrectTest {
 public:
  // large_strain: the deviator is the nominal one (force over first area), the cell pressure acts on the present side.
  CorrectTest(const SolidLaw& law, Geometry geometry, double cell_pressure, const SpecimenStart& start = {},
              bool large_strain = false);
  // Growth of the axial stress (compression +) at an axial strain (compression +) since the start, that much time after
  // the call before; NaN from where no state is found on.
  double deviator_at(double axial_strain, double duration = 1.0);
  // Of the last call: the present area over the first; 1 under small strain.
  double area_ratio() const;
  // Why no state was found; empty while there is one.
  const std::string& failure() const { return failure_; }

 private:
  void shorten(double axial_strain, double duration);
  void shorten_much(double axial_strain, double duration);

  Geometry geometry_;
  bool large_strain_;
  Vector4 start_;
  double axial_strain_ = 0.0;
  std::unique_ptr<PointDriver<4>> driver_;  // null: the path can't be followed further
  std::string failure_;
};

// STEM.report1.csv, STEM.report2.csv, ... and the same rows in memory.
class Reports final : public Output {
 public:
  // digits: of the files' numbers.
  Reports(std::filesystem::path folder, std::string stem, int digits = kCsvDigits)
      : folder_(std::move(folder)), stem_(std::move(stem)), digits_(digits) {}
  // In memory alone.
  Reports() : digits_(kCsvDigits), to_files_(false) {}

  // Rows so far of the model's report `index` (0-based); empty if it is of the other kind.
  const std::vector<TriaxialRow>& triaxial(std::size_t index) const { return series_[index].triaxial; }
  const std::vector<NodesRow>& nodes(std::size_t index) const { return series_[index].nodes; }
  const std::vector<PointRow>& points(std::size_t index) const { return series_[index].points; }
  const std::vector<DischargeRow>& discharges(std::size_t index) const { return series_[index].discharges; }
  const std::vector<UpliftRow>& uplifts(std::size_t index) const { return series_[index].uplifts; }
  const std::vector<SectionRow>& sections(std::size_t index) const { return series_[index].sections; }
  std::size_t count() const { return series_.size(); }
  const std::vector<ReportColumn>& columns(std::size_t index) const { return columns_[index]; }

  // Warnings about a report, with their codes: why values are blank, and from where on.
  const std::vector<std::string>& messages(std::size_t index) const { return series_[index].messages; }

  // The same for reports of any kind: their rows so far, each row's stage and increment (from 1), and its
  // values in the order of report_columns().
  std::size_t rows(std::size_t index) const;
  std::pair<int, int> step(std::size_t index, std::size_t row) const;
  std::vector<double> values(std::size_t index, std::size_t row) const;

  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override;
  void on_stage_start(const Model&, int stage, const Solution&) override;
  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  bool wants_states(const Model&, const StepReport&) const override;
  bool wants_nodes(const Model& model, const StepReport&, std::span<const char> behind) const override;
  void on_finish(const Model&, const RunResult&) override;
  void exchange(Archive& archive) override;
  void stop(const std::string& reason) override;
  std::vector<std::filesystem::path> files() const override { return files_; }

 private:
  struct NodeSums;
  struct Series {
    OutFile file;
    bool begun = false;
    double start_displacement[2] = {0, 0}, start_force = 0.0, area = 0.0;
    double start_extent = 0.0;  // NodeSums::extent, under large strain
    double weight[2][2] = {};   // of the nodes, at the start and the end of the stage; x, y
    double released[2] = {0,
                          0};  // forces at the start of the stage that are let go over it; 0 = none to speak of
    bool release_noted = false;  // in the file
    double last_load_factor = 0.0;
    SpecimenStart specimen;  // of a triaxial report
    std::unique_ptr<CorrectTest> correct;
    std::vector<std::string> messages;
    std::vector<TriaxialRow> triaxial;
    std::vector<NodesRow> nodes;
    std::vector<PointRow> points;
    std::vector<DischargeRow> discharges;
    std::vector<UpliftRow> uplifts;
    std::vector<SectionRow> sections;
    SectionSum section;         // of a cut, for the groups that are active now
    FlowLine line;              // of a discharge, in the present stage
    std::vector<double> more;   // numbers of Report::fields, a row behind the other
    Probe probe;                // of a point, in the present stage
    bool filled = false;        // something was born there, and what follows counts from it
    int group = -1;             // that `start` belongs to
    std::vector<double> start;  // numbers of a point that rows count from; 0 = as they are
    FieldList fields;           // of a point
    bool of_flow = false;       // a point in a model of flow alone
  };
  static void forget_displacements(Series& series, const Report& report, int stage);
  static void begin(Series& series, const Model& model, const Report& report);
  static void add_message(Series& series, const std::string& words, Code code);
  static void note_blank(Series& series, const TriaxialRow& row);
  static void note_release(Series& series, const Model& model, const StepReport& step);
  static NodeSums sum_nodes(const Model&, const Report&, const Solution&, const double (&weight)[2][2],
                            double load_factor);
  void enter_points(const Model&, const Solution&);
  static void count_from_here(Series&, const Model&, const Solution&);
  void add_triaxial(Series&, std::size_t index, const StepReport&, const NodeSums&);
  void add_nodes(Series&, const Report&, const StepReport&, const NodeSums&, const Solution&);
  static void add_point(Series&, const Model&, const StepReport&, const Solution&);
  static void add_discharge(Series&, const Model&, const Report&, const StepReport&, const Solution&);
  void append_row(std::size_t index);
  void add_rows(const Model&, const StepReport&, const Solution&);
  void finish();

  std::filesystem::path folder_;
  std::string stem_;
  int digits_;
  bool to_files_ = true;
  std::vector<Series> series_;
  std::vector<std::vector<ReportColumn>> columns_;
  FieldTable fields_;
  const Model* model_ = nullptr;  // since on_start
  double pressure_ = 0.0;         // integral of the excess pressure at the last increment
  double first_pressure_ = 0.0;   // largest since the start of the last stage of consolidation
  std::vector<char> probed_;      // groups that were active when the probes were made
  std::vector<std::filesystem::path> files_;
};

}  // namespace sage
