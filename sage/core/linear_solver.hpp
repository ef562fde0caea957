// The interface between analysis and linear solvers.  A solver owns its storage, so that skyline, frontal and
// sparse libraries all fit.  Nothing is ever silently symmetrised.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "sage/platform/stop.hpp"

namespace sage {

// The equations of every element: for element e, equations[offset[e] .. offset[e+1]); -1 = prescribed dof.
struct ElementEquations {
  std::vector<std::int64_t> offset{0};
  std::vector<int> equations;
  // A flag for each equation, or none at all: a pressure that balances a change of volume.  Its diagonal is zero or
  // negative, so that it is eliminated behind the displacements around it.
  std::vector<char> pressure{};
  int count() const { return static_cast<int>(offset.size()) - 1; }
  std::span<const int> of(int element) const {
    const auto e = static_cast<std::size_t>(element);
    return {equations.data() + offset[e], static_cast<std::size_t>(offset[e + 1] - offset[e])};
  }
};

// What the choice of a solver depends on.
struct SystemSize {
  int equations = 0;
  bool symmetric = false;
  bool pores = false;  // the model has excess pressures (ElementEquations::pressure)
};

struct SolverTraits {
  std::string_view name;
  bool symmetric = false;  // uses only a symmetric K (one triangle); must not be given an unsymmetric one
};

// What the last factorisation can tell about itself.  Negative = not known.
struct FactorReport {
  double smallest_pivot_ratio = -1.0;  // min over equations of |pivot| / largest term of its original row
  double growth = -1.0;                // largest term of the factors / largest term of K
  double backward_error = -1.0;        // largest |b - K x| / (||K|| |x| + |b|) of the refined answers so far
  int negative_pivots = -1;            // LDL^T only
  int repeated_equations = 0;          // that share the factors of others (SolverEntry::make_with_repeats)
  std::int64_t factor_entries = -1;  // stored terms of the factors; fewer after factorise() where parts repeat
  std::string_view kernels = {};     // name of the set of loops in use; empty: the solver has no choice
  std::size_t memory_bytes = 0;
  // Floating-point, of one factorisation, and of one solution without refinement.  Known from analyse() on; after
  // factorise() the first is what was done.
  double factor_operations = -1.0, solve_operations = -1.0;
};

// Instructions of the processor that a solver's loops are made of, for those that have several sets of them.
enum class Kernels { automatic, avx2, avx512 };

// How a solver works from the next analyse() on.  Answers do not depend on threads and kernels, to the last bit.
struct SolverSettings {
  int threads = 1;                       // that factorise() and solve() may use
  Kernels kernels = Kernels::automatic;  // automatic: the fastest that this machine has
  // At most so many steps of iterative refinement in every solve(), with residuals in twice the working precision:
  // an answer then has all digits that the matrix determines.
  int refinement_steps = 0;
  // One factorise() is expected, no more: memory that only factorise() needs may be freed as soon as it has served.
  // Another factorise() allocates it again.
  bool one_factorisation = false;
  // Long work calls it now and then and throws Stopped where it returns true; the same call may then be made again.
  // Libraries that nothing can interrupt ask before they begin.
  StopAsked stop_asked = {};
};

// inaccurate: x is wrong by a large part of b, and refinement did not help (FactorReport::backward_error).
enum class [[nodiscard]] SolveStatus : std::uint8_t{ok, inaccurate};

// The functions that every solver has.  What some solvers can do beyond them stands in solver_extensions.hpp.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual const SolverTraits& traits() const = 0;

  // A solver follows the settings that it knows and ignores the others.  Throws AnalysisError where the machine or
  // the build lacks the kernels.
  virtual void configure(const SolverSettings& /*settings*/) {}

  // Numbering, symbolic work and storage for a pattern.  Called once per pattern.
  virtual void analyse(int equations, ElementEquations elements) = 0;

  // Zeroes the matrix, keeps the pattern.
  virtual void clear() = 0;

  // Adds an element matrix: dofs x dofs, column-major, in the order of the element's equations as given to
  // analyse; rows and columns of equation -1 are left out.  Symmetric solvers read the upper triangle.
  virtual void add(int element, const double* K) = 0;

  // Throws SingularMatrix.
  virtual void factorise() = 0;

  // x = K^-1 b.  b and x may be the same vector.  Needs factorise() since the last add().
  virtual SolveStatus solve(std::span<const double> b, std::span<double> x) const = 0;

  virtual FactorReport report() const { return {}; }
};

}  // namespace sage
