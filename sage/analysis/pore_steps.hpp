// Steps of consolidation that are chosen by their error, and the degree or pressure that ends a stage.
//
// A step from t to t + dt takes two parts with one matrix (Alexander 1977, L-stable, of second order): backward Euler over
// g dt, then the theta method with theta = sqrt(2) - 1 over the rest; g = 1 - 1/sqrt(2).  docs/theory/consolidation.md
#pragma once

#include "sage/analysis/run_parts.hpp"

namespace sage {

// Volume of soil at each excess pressure: that of every element, shared equally by its corners.  One entry per dof.
Eigen::VectorXd pore_volumes(const Model& model, std::span<const GroupData> groups, const DofMap& map);

class PoreSteps {
 public:
  // `run` must outlive it.
  explicit PoreSteps(const RunParts& run) : run_(run) {}

  enum class Part { first, second };

  // Of the stage in hand, where water flows.
  bool chooses() const;
  // Share of the stage that the next step takes on the way to a load factor.
  double next(double end) const;
  void begin_part(Part part, double size);
  // A table of time may have a corner where an increment starts: rates of pressure before it say nothing of those behind it.
  void begin_increment();
  // After both parts: true where the step may stay.  Otherwise next() is smaller, and the run goes back to its start.
  bool accept(double size);
  // The state at the start of a step that is taken back.
  void go_back(const std::string& kept, double reached);

  // Before the supports of a stage take their pressures; and of a run that resumes.
  static void open_stage(const RunParts& run);
  static void resume(const RunParts& run);
  // After a step: notes how far the water has gone.  True where that ends the stage.
  bool measure() const;
  // What a stage ends with, for its reader.
  static std::vector<Diagnostic> remarks(const RunParts& run);

 private:
  bool open_in_no_time(double dt);
  double root_mean_square(const Eigen::VectorXd& pressures) const;
  double error_of(double dt, const Eigen::VectorXd& first_rate, const Eigen::VectorXd& last_rate) const;

  const RunParts& run_;
  Eigen::VectorXd start_, middle_;  // unknowns at the start of the step and between its parts
};

}  // namespace sage
