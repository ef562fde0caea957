// Evaluates one element at a time: buffers for its input and output.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "sage/analysis/step_time.hpp"
#include "sage/platform/stop.hpp"

namespace sage {

// Over the elements, of each field of unknowns: sum of the squares of their forces.
using FieldSums = std::array<double, kMostFields>;

class ElementWork {
 public:
  // keep_geometry: w and B of elements that are not constant stay from pass to pass.  The model must outlive it.
  ElementWork(const Model& model, bool keep_geometry);

  void set_stop(StopAsked asked) { stop_asked_ = std::move(asked); }
  // Every so many elements, the first included.  Throws Stopped.
  void stop_if_asked_at(int element) const;

  // Of all evaluations that follow, for laws that need it.
  void set_step_time(const StepTime& step_time) { step_time_ = step_time; }
  const StepTime& step_time() const { return step_time_; }
  // Committed unknowns, for elements that see them; they must stay there.
  void set_committed(const Eigen::VectorXd* u) { committed_ = u; }

  // Internal forces at committed state + du (nullptr: none) into f(), K where it is not nullptr.  Stress and
  // strain of constant groups go into sigma() and eps(), all other states into the trial side.
  Outcome evaluate(GroupData& data, int element, const Eigen::VectorXd* du, double* K);
  // What evaluate() would make for all elements at their first turn: then work of the group may be divided among threads,
  // each with an ElementWork of its own.
  void prepare(GroupData& data);
  // Takes the time, the committed unknowns and the wish to stop from another one.
  void go_on_from(const ElementWork& other);
  // Before each pass over the elements.
  void begin_pass() { load_change_.setZero(); }
  // What the motion adds to loads on edges, every dof, of the pass so far; size 0 where none follows.
  const Eigen::VectorXd& load_change() const { return load_change_; }
  const Model& model() const { return *model_; }
  double* du() { return du_.data(); }
  double* K() { return K_.data(); }
  const double* f() const { return f_.data(); }
  const double* sigma() const { return sigma_.data(); }
  const double* eps() const { return eps_.data(); }

 private:
  const double* committed_of(const ElementDofs& dofs);
  static const double* spread_of(const GroupData& data, int element, double load_factor, double* to);
  std::span<const EdgeTraction> edges_of(const GroupData& data, int element);
  bool keeps_geometry(const GroupData& data) const;
  const double* geometry_of(GroupData& data, int element);
  const PointContext* contexts_of(const GroupData& data, int element);

  const Model* model_;
  bool keep_geometry_;
  StopAsked stop_asked_;
  const Eigen::VectorXd* committed_ = nullptr;
  std::vector<double> geometry_, K_, f_, du_, u0_, spread_, sigma_, eps_;
  std::vector<double> no_stress_;  // zeros, of one element
  Eigen::Matrix2Xd x_;
  StepTime step_time_;
  // Under large strain: loads on the edges of one element, what its motion adds to them, and the sum of that.
  std::vector<EdgeTraction> edges_;
  std::vector<double> load_;
  Eigen::VectorXd load_change_;
  std::vector<PointContext> contexts_;  // of one element; none where no law wants them
};

// Whether the elements of a group have one matrix for each step size.
bool has_matrix_of_step(const GroupData& data);

// Adds an element's forces to those of all dofs, and their squares to the sums.
void add_force(const GroupData& data, int element, const double* f, Eigen::VectorXd& to, FieldSums& sums);

}  // namespace sage
