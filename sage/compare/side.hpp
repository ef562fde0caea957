// One of the two runs that a comparison sets side by side, with all that the comparison looks at.
#pragma once

#include <limits>
#include <memory>
#include <span>

#include "sage/analysis/run.hpp"
#include "sage/record/report.hpp"
#include "sage/record/result.hpp"
#include "sage/record/summary.hpp"

namespace sage::compare {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// A straight side of the box around the mesh.
struct Face {
  std::string name;  // bottom, top, left, right
  int normal = 0;    // direction of the outward normal: 0 = x, 1 = y
  double outward = 1.0;
  std::vector<int> nodes;
  std::vector<char> at_end;  // of each node: it belongs to another face too
  double area = 0.0;         // of the part between its outermost nodes, times unit thickness or the full ring
  double length = 0.0;       // distance to the opposite face
  bool whole = false;        // it reaches from corner to corner of the box
};

// Bottom, top, left, right of the nodes in use; no left face on the axis r = 0, where there is no area.
std::vector<Face> faces_of(const Model& model);

// What the outside does to a face, along +x and +y: the sum of its nodes' internal forces (supports, loads and
// the nodes' share of body forces).
struct FaceState {
  Vector2 force = Vector2::Zero();
  Vector2 inner_force = Vector2::Zero();   // the same without the nodes at the face's ends
  Vector2 displacement = Vector2::Zero();  // plain mean of the nodes
  Vector2 spread = Vector2::Zero();        // largest minus smallest displacement of the nodes
  std::vector<double> normal_force;        // of each node, along the face's normal axis
  std::vector<char> held;                  // each node's displacement along that axis is prescribed
};

// Stress of a face, compression positive: mean normal stress, and mean shear along +y or +x.
// NaN on a face without area.
double normal_stress(const Face& face, const FaceState& state);
double shear_stress(const Face& face, const FaceState& state);

// What a run's tolerance of equilibrium leaves open: numbers below it are zero.
//   force         tolerance x |internal forces| x sqrt(dofs): the most that out-of-balance forces add up to
//   displacement, stress  tolerance x the largest of the run
struct Floors {
  double force = 0.0, displacement = 0.0, stress = 0.0;
};

struct StageState {
  int stage = 0;             // from 0
  double load_factor = 1.0;  // reached; below 1 where the run failed
  Vector2 applied = Vector2::Zero(), reactions = Vector2::Zero();
  std::vector<FaceState> faces_before, faces;  // at the start and at the end
};

// Numbers of integration points.
struct PointCounts {
  long solids = 0, yielded = 0, apex = 0, cut_off = 0;  // yielded: apex and cut_off included
  long interfaces = 0, slipping = 0, open = 0;
};
PointCounts count_points(const Mesh& mesh, const Solution& solution);

class Side {
 public:
  // label: "A: deck.dat, plane strain".  Reports go to folder/stem.report1.csv ...
  Side(std::string label, Model model, const std::filesystem::path& folder, const std::string& stem);
  // Of a run that has ended.
  Side(std::string label, std::unique_ptr<Model> model, std::unique_ptr<Reports> reports, RunRecord record,
       Result result);
  // A side that could not even begin.
  Side(std::string label, std::string error) : label_(std::move(label)), error_(std::move(error)) {}

  // Runs the model; what is thrown ends in error().
  // watching: more observers.
  void run(const Catalogue& catalogue, const RunSettings& settings, std::span<Observer* const> watching = {});

  const std::string& label() const { return label_; }
  // Empty when the run is complete; otherwise why not.  The last state in equilibrium may still be there.
  const std::string& error() const { return error_; }
  // Where finer and finer meshes were asked for and left the side less certain than wanted: why; else empty.
  const std::string& not_reached() const { return not_reached_; }
  void set_not_reached(std::string why) { not_reached_ = std::move(why); }
  // Where warnings count as errors: its run had some.
  bool strict_failure() const { return strict_failure_; }
  void set_strict_failure(bool failed) { strict_failure_ = failed; }
  bool has_model() const { return model_ != nullptr; }
  bool has_state() const { return !result_.ends().empty(); }
  const Model& model() const { return *model_; }
  const RunRecord& record() const { return record_; }
  const Reports& reports() const { return *reports_; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<StageState>& stages() const { return stages_; }
  const Floors& floors() const { return floors_; }
  Solution first() const { return result_.starts().front().view(); }  // before the first increment
  Solution last() const { return result_.ends().back().view(); }

 private:
  std::vector<FaceState> face_states(const Solution& now) const;
  void read_result();
  void close_stage(StageState& state, const Frame& end);
  void raise_floors(const Stage& stage, const Frame& end);

  std::string label_, error_, not_reached_;
  bool strict_failure_ = false;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Reports> reports_;
  RunRecord record_;
  std::vector<Face> faces_;
  std::vector<StageState> stages_;
  Floors floors_;
  Result result_;
};

}  // namespace sage::compare
