// What meshes have around the points of reports.  Two meshes may agree at a point by chance, for the error of an
// element changes its sign many times; they do not agree by chance everywhere around it.
#pragma once

#include <span>
#include <vector>

#include "sage/analysis/observer.hpp"
#include "sage/convergence/convergence.hpp"
#include "sage/record/report_components.hpp"

namespace sage::app {

// Of a point report at the end of a run; empty where nothing is active at the point.  Of a section report: places are the
// middles of its cut and of others beside it, values their forces and moments.
struct Surroundings {
  struct Place {
    Vector2 at = Vector2::Zero();
    int group = -1;       // that answers there, as in Report::group
    int element = -1;     // of those that hold the point, from 0
    double weight = 0.0;  // in the mean over that element
  };
  std::vector<Place> places;                    // the point, then a grid over the elements that hold it
  std::vector<std::vector<double>> values;      // of each place: the columns of the report, as they are
  std::vector<double> missing;                  // of each column: LegendreParts::missing; NaN = not known
  std::vector<std::vector<double>> at_earlier;  // of each place of the coarser mesh
  bool at_corner = false;                       // the elements that hold it are the last layers of a grading
};

class SurroundingsReader final : public Observer {
 public:
  // earlier: of the coarser mesh, by report; empty where there is none.
  explicit SurroundingsReader(const std::vector<Surroundings>& earlier) : earlier_(&earlier) {}

  void on_increment(const Model&, const StepReport&, const Solution&) override;
  bool wants_states(const Model&, const StepReport&) const override;

  std::vector<Surroundings> found;  // by report

 private:
  const std::vector<Surroundings>* earlier_;
};

// Errors of the numbers of point and section reports, mesh by mesh.
class LocalErrors {
 public:
  explicit LocalErrors(convergence::MeshSequence sequence) : sequence_(sequence) {}

  const std::vector<Surroundings>& earlier() const { return earlier_; }
  // After the next mesh: an error for each of its components, NaN where it is of no point or section.
  std::vector<double> after(const Model& model, const std::vector<ReportComponent>& components,
                            std::vector<Surroundings> found);

  // Of a number and the largest of its sisters: what a mesh changed in and around the elements that held the point in the
  // mesh before (root mean square, no less than at the point; mean), and what its own elements show to be missing.
  struct Change {
    double own = 0.0, largest = 0.0, mean = 0.0, largest_mean = 0.0, missing = 0.0, largest_missing = 0.0,
           size = 0.0;  // the largest of the numbers themselves
    bool only_rounding() const { return largest <= 1e-9 * size; }
  };

 private:
  double spectral_error(const Change& now, const Change* before, double stiffness) const;
  double halving_error(const Change& now, const Change* before) const;
  std::vector<double> errors_of(const Model& model, std::size_t report, const Surroundings& now);

  convergence::MeshSequence sequence_;
  int mesh_ = 0;  // from 1
  std::vector<Surroundings> earlier_;
  std::vector<std::vector<Change>> changes_;  // by report and column: of the mesh before
};

}  // namespace sage::app
