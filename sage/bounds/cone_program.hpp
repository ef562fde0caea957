// The conic program of both bounds on a collapse load, and the interior point method that solves it.
// docs/theory/bounds.md
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sage/bounds/sparse_factor.hpp"

namespace sage::bounds {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

// Yield condition of a stress point: h0 + tau h1 - G sigma lies in the cone |(s1, s2)| <= s0.  An interface has two
// components: the last row and column of G and the last terms of h0 and h1 are zero.
struct Cone {
  Matrix3 G = Matrix3::Zero();
  Vector3 h0 = Vector3::Zero(), h1 = Vector3::Zero();
};

// What the stresses of consecutive points add to the equations: A sigma, A of equations x 3 points.
struct Part {
  int first_point = 0, points = 0;
  std::vector<int> equations;
  Eigen::MatrixXd A;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

// Largest tau with
//   sum over parts of A sigma = b0 + tau b1   (equilibrium; multipliers y)
//   h0 + tau h1 - G sigma in the cone         (yield; multipliers z)
// The dual: least h0 z - b0 u, u = -y, with A^T u = G^T z, z in the cone, b1 u - h1 z = 1: the power of dissipation
// less that of the fixed loads where that of the live loads is 1.
struct ConeProgram {
  std::vector<Cone> cones;  // by point
  std::vector<Part> parts;
  Eigen::VectorXd b0, b1;      // one entry an equation
  std::vector<int> dependent;  // equations that follow from others, whose multipliers are zero

  int points() const { return static_cast<int>(cones.size()); }
  int equations() const { return static_cast<int>(b0.size()); }
};

// Which of the two programs has to be satisfied to rounding: that of the stresses or that of the velocities.
enum class Side { primal, dual };

struct ConeOptions {
  Side side = Side::primal;
  double gap = 1e-5;  // relative, that ends the iteration
  int iterations = 100;
  std::function<bool()> stop_asked;
};

enum class ConeStatus {
  solved,
  stopped,      // as options.stop_asked wanted
  no_progress,  // the steps became too short; what is there may be of use
  infeasible,   // no stresses satisfy the equations: tau falls without end
  unbounded,    // tau grows without end
};

struct ConeSolution {
  ConeStatus status = ConeStatus::no_progress;
  double tau = 0.0, dual = 0.0;    // of the primal and the dual program
  double scale = 0.0;              // of their difference, at least
  Eigen::Matrix3Xd sigma, s, z;    // by point
  Eigen::VectorXd u;               // by equation: velocities
  double primal_residual = 1e300;  // largest |A sigma - b|, relative to the largest term of b
  double dual_residual = 1e300;    // largest |A^T u - G^T z|, relative to the largest |z|
  double power_residual = 1e300;   // |b1 u - h1 z - 1|
  int iterations = 0;

  double relative_gap() const;
};

ConeSolution solve(const ConeProgram& program, const ConeOptions& options = {});

// A sigma.
Eigen::VectorXd forces(const ConeProgram& program, const Eigen::Matrix3Xd& sigma);
// A^T u.
Eigen::Matrix3Xd strains(const ConeProgram& program, const Eigen::VectorXd& u);

}  // namespace sage::bounds
