// Reports that the deck asks for: a triaxial test against the law's own answer, and sums over nodes.
#pragma once

#include <memory>

#include "sage/core/point_driver.hpp"
#include "sage/output/out_file.hpp"
#include "sage/output/output.hpp"

namespace sage {

// One increment of a triaxial report.  Compression positive, in the deck's units; NaN = not known.
//   force              F = - sum over the report's nodes of the internal force in y (full circle, or unit
//   thickness) axial_strain       - (mean u_y - its value at the start of the report's stage) / height
//   measured_deviator  (F - F at the start of the stage) / area
//   correct_deviator   of one point of the law under the same axial strain with frictionless ends: both lateral
//                      stresses stay at the cell pressure (plane strain: sigma_xx stays and eps_zz = 0)
//   *_axial            cell pressure + deviator
//   ratio              measured_deviator / correct_deviator
//   held               part of the force that neither loads nor supports put there: forces that are let go over
//                      the stage (a release, an excavation, an initial stress out of balance) and stand in part
struct TriaxialRow {
  int stage = 0, increment = 0;  // both from 1
  double axial_strain = 0.0, force = 0.0;
  double measured_deviator = 0.0, correct_deviator = 0.0;
  double measured_axial = 0.0, correct_axial = 0.0;
  double ratio = 0.0;
  double held = 0.0;
};

// One increment of a node report.  Mean displacement of the nodes since the start of the report's stage, and
// the sum of the forces that loads and supports put on them, with what is still held of forces that are let go
// over the stage (held: that part alone, 0 where it is not worth a word); all along +x and +y.
struct NodesRow {
  int stage = 0, increment = 0;
  double displacement[2] = {0, 0};
  double force[2] = {0, 0};
  double held[2] = {0, 0};
};

// The frictionless test: axial strain is given, the lateral stress stays at the cell pressure.
class CorrectTest {
 public:
  // Starts from the isotropic cell pressure (compression +).
  CorrectTest(const SolidLaw& law, Geometry geometry, double cell_pressure);
  // Deviator (compression +) at an axial strain (compression +) since the start; NaN once the law can't follow.
  double deviator_at(double axial_strain);

 private:
  Geometry geometry_;
  double cell_pressure_, axial_strain_ = 0.0;
  std::unique_ptr<PointDriver<4>> driver_;  // null: the path can't be followed further
};

// Area under the report's nodes: pi r_max^2, or the width in plane strain.
double report_area(const Model& model, const Report& report);

// STEM.report1.csv, STEM.report2.csv, ... and the same rows in memory.
class Reports final : public Output {
 public:
  Reports(std::filesystem::path folder, std::string stem)
      : folder_(std::move(folder)), stem_(std::move(stem)) {}

  // Rows so far of the model's report `index` (0-based); empty if it is of the other kind.
  const std::vector<TriaxialRow>& triaxial(std::size_t index) const { return series_[index].triaxial; }
  const std::vector<NodesRow>& nodes(std::size_t index) const { return series_[index].nodes; }
  std::size_t count() const { return series_.size(); }

  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override;
  void on_stage_start(const Model&, int stage, const Solution&) override;
  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  void on_finish(const Model&, const RunResult&) override;
  void exchange(Archive& archive) override;
  void stop(const std::string& reason) override;
  std::vector<std::filesystem::path> files() const override { return files_; }

 private:
  struct Series {
    OutFile file;
    bool begun = false;
    double start_displacement[2] = {0, 0}, start_force = 0.0, area = 0.0;
    double weight[2][2] = {};  // of the nodes, at the start and the end of the stage; x, y
    double released[2] = {0,
                          0};  // forces at the start of the stage that are let go over it; 0 = none to speak of
    bool release_noted = false;  // in the file
    double last_load_factor = 0.0;
    std::unique_ptr<CorrectTest> correct;
    std::vector<TriaxialRow> triaxial;
    std::vector<NodesRow> nodes;
  };
  static void begin(Series& series, const Model& model, const Report& report);
  static void note_release(Series& series, const Model& model, const StepReport& step);
  void add_rows(const Model&, const StepReport&, const Solution&);
  void finish();

  std::filesystem::path folder_;
  std::string stem_;
  std::vector<Series> series_;
  const Model* model_ = nullptr;  // since on_start
  std::vector<std::filesystem::path> files_;
};

}  // namespace sage
