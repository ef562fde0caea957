// Discretisation error of a solution, estimated from the stress itself (Zienkiewicz & Zhu 1992): a smooth
// stress is fitted to the places where the stress of the elements is most accurate, and its distance from the
// elements' own stress is taken for the error.  docs/theory/accuracy.md has the equations.
#pragma once

#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

struct ErrorEstimate {
  // Squares of norms, over the volume (full circle in axisymmetry): of the error, and of the stress itself.
  //   energy: integral s^T D^-1 s dV  (twice the elastic energy), where every solid group is linear
  //   else:   integral s^T s dV
  bool energy = true;
  double error = 0.0, size = 0.0;
  std::vector<std::vector<double>> element;  // part of `error` by group and element; empty = no active solid
  int worst_group = -1, worst_element = -1;  // the largest part; -1 = no error at all

  // |error| over |size + error|, 0 ... 1.
  double relative() const;
};

// Stress and strain of all points of all groups, as in the state store, and all displacements: to measure from another
// state than the unstressed one.
struct StressState {
  std::vector<std::vector<double>> sigma, eps;
  std::vector<double> u;
};
StressState stress_state(const Solution& solution);

// Groups whose estimate would be far from the error: they lock, for Poisson's ratio is near 1/2.  Indices.
std::vector<int> locking_groups(const Model& model);

// Of the committed stress of active solids, less `start` where given.  Fitted within each material, so that
// jumps between materials are not taken for errors.
ErrorEstimate estimate_error(const Model& model, const Solution& solution, const StressState* start = nullptr);

}  // namespace sage
