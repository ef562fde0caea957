// A compressed specimen whose state is known in closed form, for the tests of all outputs.
#pragma once

#include <filesystem>

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/observer.hpp"

namespace sage::test {

// Elastic cylinder, radius 1, height 2, two quad4 one above the other (E = 1000, nu = .25), and on it an
// interface4 (k_n = 2000, k_s = 500, bonded) with a platen as its upper side.
//
//   node 70---80   platen (interface top)
//   node 50---60   y = 2
//   node 30---40   y = 1
//   node 10---20   y = 0
//
// compress(e): u_y = -e y, u_r = nu e r in the cylinder: sigma_yy = -E e, all else zero.  The platen goes down
// by 2 e + E e / k_n, so that the interface carries the same stress.
class Specimen {
 public:
  explicit Specimen(Geometry geometry = Geometry::axisymmetric, bool with_interface = true);
  Specimen(const Specimen&) = delete;
  Specimen& operator=(const Specimen&) = delete;

  static constexpr double kE = 1000.0, kNu = 0.25, kNormal = 2000.0;

  void compress(double axial_strain);
  Solution solution() const;
  // Increment `increment` of `increments` in stage `stage` (0-based), converged.
  StepReport step(int increment, int increments, int stage = 0) const;

  // Runs the calls that a run makes: start, stage start, `increments` equal increments
  // to `strain`, end, finish.
  void run(Observer& observer, double strain, int increments);
  // The same, but the last increment fails after a cut.
  void run_and_fail(Observer& observer, double strain, int increments);

  Catalogue catalogue;
  Model model;
  Scene scene;
  WorkCounters work;
  std::unique_ptr<Assembly> assembly;
  std::unique_ptr<Activity> activity;
  Eigen::VectorXd u, external;
  bool with_interface = true;
};

// A folder of its own for each test, emptied before.
std::filesystem::path fresh_folder(const std::string& name);
std::string contents(const std::filesystem::path& path);
std::vector<std::string> lines_of(const std::string& text);
// The column of a CSV text by its header (without the unit); comment lines are skipped.
std::vector<std::string> csv_column(const std::string& text, const std::string& name);
std::vector<double> csv_numbers(const std::string& text, const std::string& name);

}  // namespace sage::test
