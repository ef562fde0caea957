// Linear systems for tests and benchmarks of solvers, made so that neither elements nor laws are needed.
#pragma once

#include <random>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"

namespace sage::conformance {

struct System {
  int equations = 0;
  ElementEquations elements;
  std::vector<Eigen::MatrixXd> K;  // one an element, full size

  void add_element(std::vector<int> element_equations, Eigen::MatrixXd matrix);
};

// Which displacements of an n x m mesh of Q4 elements are prescribed.
enum class Supports {
  triaxial,  // left edge on rollers, bottom fixed, top prescribed
  bottom,    // bottom fixed
  none,      // free in space: three rigid-body modes
};

struct MeshSettings {
  int columns = 14, rows = 28;
  Supports supports = Supports::triaxial;
  double poisson = 0.3;
  // Share of an unsymmetric rank-one term in every element's modulus, as in non-associated plasticity;
  // 0 = elastic.
  double unsymmetric = 0.0;
  // Modulus of the topmost row of elements over that of the others.
  double stiff_top = 1.0;
};

// Unit squares with fully integrated plane-strain Q4 elements, E = 1000.
System q4_mesh(const MeshSettings& settings);

// Elements of random size and equations, diagonally dominant after assembly; -1 among the equations.
System random_system(int equations, bool symmetric, unsigned seed);

// Two systems side by side; the equations of the second follow those of the first.
System join(const System& first, const System& second);

// One spring between two equations (-1 = ground).
System& add_spring(System& system, int a, int b, double stiffness);

// The assembled matrix; symmetric solvers see the same, because they read the upper triangles.
Eigen::MatrixXd dense(const System& system);

// K x, element by element, and the largest column sum of the elements' |K| added up, which is at least that of
// |K|.
Eigen::VectorXd product(const System& system, const Eigen::VectorXd& x);
double norm1(const System& system);

// Terms between -1 and 1.
inline Eigen::VectorXd random_vector(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> term(-1.0, 1.0);
  return Eigen::VectorXd::NullaryExpr(n, [&] { return term(random); });
}

inline std::span<double> span_of(Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// An optional interface of a solver.  Throws std::bad_cast where the solver does not offer it.
template <class Extension>
Extension& offered_by(LinearSolver& solver) {
  return dynamic_cast<Extension&>(solver);
}
template <class Extension>
const Extension& offered_by(const LinearSolver& solver) {
  return dynamic_cast<const Extension&>(solver);
}

// analyse, clear and add.
void load(LinearSolver& solver, const System& system);

}  // namespace sage::conformance
