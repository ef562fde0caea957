// The seam between analysis and linear solvers.  A solver owns its storage, so that skyline, frontal and
// sparse libraries all fit.  Nothing is ever silently symmetrised.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "sage/core/stop.hpp"

namespace sage {

// The equations of every element: for element e, equations[offset[e] .. offset[e+1]); -1 = prescribed dof.
struct ElementEquations {
  std::vector<std::int64_t> offset{0};
  std::vector<int> equations;
  int count() const { return static_cast<int>(offset.size()) - 1; }
  std::span<const int> of(int element) const {
    const auto e = static_cast<std::size_t>(element);
    return {equations.data() + offset[e], static_cast<std::size_t>(offset[e + 1] - offset[e])};
  }
};

// Where each equation stands: for solvers that number or scale by it.
struct EquationPlace {
  Eigen::Vector2d x = Eigen::Vector2d::Zero();  // of its node
  int node = 0;                                 // counted from 0
  int field = 0, component = 0;                 // field: 0 = displacement, then the model's others
};

struct SolverTraits {
  std::string_view name;
  bool symmetric = false;     // uses only a symmetric K (one triangle); must not be given an unsymmetric one
  bool wants_places = false;  // set_places() is called before analyse()
};

// What the last factorisation can tell about itself.  Negative = not known.
struct FactorReport {
  double smallest_pivot_ratio = -1.0;  // min over equations of |pivot| / largest term of its original row
  double growth = -1.0;                // largest term of the factors / largest term of K
  double backward_error = -1.0;        // largest |b - K x| / (||K|| |x| + |b|) of the refined answers so far
  int negative_pivots = -1;            // LDL^T only
  std::int64_t factor_entries = -1;  // stored terms of the factors; fewer after factorise() where parts repeat
  int twin_equations = 0;            // that took the factors of others, because they are the same (set_twins)
  std::size_t memory_bytes = 0;
  // Floating-point, of one factorisation, and of one solution without refinement.  Known from analyse() on; after
  // factorise() the first is what was done.
  double factor_operations = -1.0, solve_operations = -1.0;
};

// Instructions of the processor that a solver's loops are made of, for those that have several sets of them.
enum class Kernels { automatic, avx2, avx512 };

// Matrices of elements with consecutive numbers, one after the other, each as LinearSolver::add takes it.
struct ElementMatrices {
  int first = 0, count = 0;
  const double* K = nullptr;
  std::size_t size = 0;  // doubles from one matrix to the next
};

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual const SolverTraits& traits() const = 0;

  // How many threads factorise() may use from the next analyse() on.  Answers do not depend on it, to the last
  // bit.  Solvers without threads of their own do nothing.
  virtual void set_threads(int /*threads*/) {}

  // Which kernels serve from the next analyse() on; automatic: the fastest that this machine has.  Answers do not
  // depend on it, to the last bit.  Throws AnalysisError where the machine or the build lacks them.  Solvers without
  // kernels of their own do nothing.
  virtual void set_kernels(Kernels /*wanted*/) {}
  // Name of those in use; empty: it has no choice.
  virtual std::string_view kernels() const { return {}; }

  // At most so many steps of iterative refinement in every solve() from the next factorise() on, with residuals
  // in twice the working precision: an answer then has all digits that the matrix determines.
  virtual void set_refinement(int /*steps*/) {}

  // From now on long work asks it now and then and throws Stopped where it says so; the same call may be made
  // again then.  Libraries that nothing can interrupt ask before they begin.
  virtual void set_stop(const StopAsked& /*asked*/) {}

  // One entry an equation, for those that want them; valid within the call.  A solver that is given a part of
  // the equations alone (the skip 'condensation') gets none.
  virtual void set_places(std::span<const EquationPlace> /*places*/) {}

  // From the next analyse() on the last so many equations, the border n, stay: factorise() eliminates only those
  // before them, l.  solve() is then of no use, and those for a border below serve.  False: this solver, or as it
  // is set, can't do so, and has no border.
  virtual bool set_border(int /*equations*/) { return false; }

  // From the next analyse() on one factorise() is expected, no more: room that only factorise() needs may be given
  // back as soon as it has served.  Another one takes it again.
  virtual void expect_one_factorisation() {}

  // Whether a factorise() that is expected to be the only one may do what repeats in the matrix once, from the next
  // analyse() on; as a rule it may.  Answers do not depend on it, to the last bit.
  virtual void set_twins(bool /*wanted*/) {}

  // Numbering, symbolic work and storage for a pattern.  Called once per pattern.
  virtual void analyse(int equations, ElementEquations elements) = 0;

  // Zeroes the matrix, keeps the pattern.
  virtual void clear() = 0;

  // Adds an element matrix: dofs x dofs, column-major, in the order of the element's equations as given to
  // analyse; rows and columns of equation -1 are left out.  Symmetric solvers read the upper triangle.
  virtual void add(int element, const double* K) = 0;

  // A part of adding some: the calls for part 0, 1 ... parts - 1, in any order and from several threads at once, do
  // what add() does for one after the other, to the last bit.
  virtual void add_part(const ElementMatrices& some, int part, int /*parts*/) {
    if (part != 0) return;
    for (int e = 0; e < some.count; ++e) add(some.first + e, some.K + static_cast<std::size_t>(e) * some.size);
  }

  // Throws SingularMatrix.
  virtual void factorise() = 0;

  // x = K^-1 b.  b and x may be the same vector.  Needs factorise() since the last add().
  virtual void solve(std::span<const double> b, std::span<double> x) const = 0;

  // With a border.  S = K_nn - K_nl K_ll^-1 K_ln, what factorise() leaves of it: border x border, column-major,
  // both triangles.
  virtual void border_matrix(double* /*S*/) const { throw std::logic_error("this solver keeps no border"); }
  // y_n = b_n - K_nl K_ll^-1 b_l; y_l is for fill_in().  Linear in b.  b and y may be the same vector.
  virtual void eliminate(std::span<const double> /*b*/, std::span<double> /*y*/) const {
    throw std::logic_error("this solver keeps no border");
  }
  // x_l = K_ll^-1 (b_l - K_ln x_n), from y_l of eliminate(b) and x_n, which stand in x and of which x_n stays.
  virtual void fill_in(std::span<double> /*x*/) const { throw std::logic_error("this solver keeps no border"); }

  virtual FactorReport report() const { return {}; }

  // Those below serve iterative refinement, the dogleg and the estimate of the condition number, on demand.
  // y = K x, with K as it was added (a factorisation does not destroy it).  x and y must differ.
  virtual void multiply(std::span<const double> /*x*/, std::span<double> /*y*/) const {
    throw std::logic_error("this solver does not keep its matrix");
  }
  // y = K^T x, likewise.
  virtual void multiply_transposed(std::span<const double> /*x*/, std::span<double> /*y*/) const {
    throw std::logic_error("this solver does not keep its matrix");
  }
  // Largest column sum of |K|.  Negative = not known.
  virtual double norm1() const { return -1.0; }
  // x = K^-T b, under the conditions of solve().
  virtual void solve_transposed(std::span<const double> /*b*/, std::span<double> /*x*/) const {
    throw std::logic_error("this solver does not solve with the transposed matrix");
  }
};

}  // namespace sage
