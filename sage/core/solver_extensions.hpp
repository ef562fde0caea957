// Optional interfaces of linear solvers.  A solver derives from those that it offers, beside LinearSolver; the analysis
// looks for each once, by dynamic_cast, when it makes a solver.  A solver without them computes the same results.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace sage {

// Position of an equation in the model: for solvers that number or scale by it.
struct EquationPlace {
  Eigen::Vector2d x = Eigen::Vector2d::Zero();  // of its node
  int node = 0;                                 // counted from 0
  int field = 0, component = 0;                 // field: 0 = displacement, then the model's others
};

class PlacedSolver {
 public:
  // One entry per equation, before analyse(); valid within the call.  A solver for a part of the equations alone (the
  // skip 'condensation') does not get them.
  virtual void set_places(std::span<const EquationPlace> places) = 0;

 protected:
  ~PlacedSolver() = default;
};

// Matrices of elements with consecutive numbers, one after the other, each as LinearSolver::add takes it.
struct ElementMatrices {
  int first = 0, count = 0;
  const double* K = nullptr;
  std::size_t size = 0;  // doubles from one matrix to the next
};

// Adds element matrices on several threads.
class ParallelAssembly {
 public:
  // A part of adding some: the calls for part 0, 1 ... parts - 1, in any order and from several threads at once, do
  // what LinearSolver::add does for one element after the other, to the last bit.
  virtual void add_part(const ElementMatrices& some, int part, int parts) = 0;

 protected:
  ~ParallelAssembly() = default;
};

// Products with K as it was added (a factorisation does not destroy it), and solutions with its transpose: for the
// dogleg, the estimate of the condition number and the start of an increment from the last one.
class KeptMatrix {
 public:
  // y = K x.  x and y must differ.
  virtual void multiply(std::span<const double> x, std::span<double> y) const = 0;
  // y = K^T x, likewise.
  virtual void multiply_transposed(std::span<const double> x, std::span<double> y) const = 0;
  // Largest column sum of |K|.
  virtual double norm1() const = 0;
  // x = K^-T b, under the conditions of LinearSolver::solve.
  virtual void solve_transposed(std::span<const double> b, std::span<double> x) const = 0;

 protected:
  ~KeptMatrix() = default;
};

// Static condensation (Schur complement).  The last equations, the border n, are not eliminated; those before them are
// the interior l.  factorise() then factorises K_ll alone.
class BorderSolver {
 public:
  // Size of the border from the next analyse() on; LinearSolver::solve is then of no use.  False: the solver, as it is
  // configured, can not keep a border.
  virtual bool set_border(int equations) = 0;
  // S = K_nn - K_nl K_ll^-1 K_ln: border x border, column-major, both triangles.
  virtual void border_matrix(double* S) const = 0;
  // y_n = b_n - K_nl K_ll^-1 b_l; y_l is for recover().  Linear in b.  b and y may be the same vector.
  virtual void eliminate(std::span<const double> b, std::span<double> y) const = 0;
  // x_l = K_ll^-1 (b_l - K_ln x_n), from y_l of eliminate(b) and x_n, both given in x; x_n stays.
  virtual void recover(std::span<double> x) const = 0;

 protected:
  ~BorderSolver() = default;
};

}  // namespace sage
