#include "sage/conformance/solver_systems.hpp"

#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace sage::conformance {

namespace {

using Eigen::MatrixXd;

// 4 x 4 modulus is not needed here: [xx yy xy] suffices for a stiffness.
Eigen::Matrix3d modulus(double E, double nu, double unsymmetric) {
  const double c = E / ((1.0 + nu) * (1.0 - 2.0 * nu));
  Eigen::Matrix3d D;
  D << c * (1 - nu), c * nu, 0, c * nu, c * (1 - nu), 0, 0, 0, c * (1 - 2 * nu) / 2;
  const Eigen::Vector3d flow(1.0, -0.6, 0.2), yield(1.0, -0.3, 0.5);
  return D - unsymmetric * (D * flow) * (D * yield).transpose() / yield.dot(D * flow);
}

// Unit square, nodes counter-clockwise from the lower left, 2 x 2 Gauss points.
MatrixXd q4_stiffness(const Eigen::Matrix3d& D) {
  MatrixXd K = MatrixXd::Zero(8, 8);
  const double g = 0.5 / std::sqrt(3.0);
  for (const double x : {0.5 - g, 0.5 + g})
    for (const double y : {0.5 - g, 0.5 + g}) {
      const std::array<double, 4> dx{-(1 - y), 1 - y, y, -y}, dy{-(1 - x), -x, x, 1 - x};
      Eigen::Matrix<double, 3, 8> B;
      for (int a = 0; a < 4; ++a) {
        const auto i = static_cast<std::size_t>(a);
        B.middleCols<2>(2 * a) << dx[i], 0, 0, dy[i], dy[i], dx[i];
      }
      K += 0.25 * B.transpose() * D * B;
    }
  return K;
}

bool prescribed(const MeshSettings& s, int i, int j, int direction) {
  if (s.supports == Supports::none) return false;
  if (j == 0) return true;
  if (s.supports == Supports::bottom) return false;
  return (j == s.rows) || (i == 0 && direction == 0);
}

}  // namespace

void System::add_element(std::vector<int> element_equations, MatrixXd matrix) {
  elements.equations.insert(elements.equations.end(), element_equations.begin(), element_equations.end());
  elements.offset.push_back(static_cast<std::int64_t>(elements.equations.size()));
  K.push_back(std::move(matrix));
}

System q4_mesh(const MeshSettings& s) {
  System system;
  std::vector<int> equation(static_cast<std::size_t>((s.columns + 1) * (s.rows + 1)) * 2);
  const auto slot = [&](int i, int j, int d) {
    return static_cast<std::size_t>((j * (s.columns + 1) + i) * 2 + d);
  };
  for (int j = 0; j <= s.rows; ++j)
    for (int i = 0; i <= s.columns; ++i)
      for (int d = 0; d < 2; ++d) equation[slot(i, j, d)] = prescribed(s, i, j, d) ? -1 : system.equations++;
  const MatrixXd soft = q4_stiffness(modulus(1000.0, s.poisson, s.unsymmetric));
  const MatrixXd stiff = q4_stiffness(modulus(1000.0 * s.stiff_top, s.poisson, s.unsymmetric));
  for (int j = 0; j < s.rows; ++j)
    for (int i = 0; i < s.columns; ++i) {
      std::vector<int> equations;
      for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
        for (int d = 0; d < 2; ++d) equations.push_back(equation[slot(a, b, d)]);
      system.add_element(std::move(equations), j == s.rows - 1 ? stiff : soft);
    }
  return system;
}

System random_system(int equations, bool symmetric, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> term(-1.0, 1.0);
  std::uniform_int_distribution<int> size(1, 6), pick(-1, equations - 1);
  System system;
  system.equations = equations;
  for (int e = 0; e < 2 * equations; ++e) {
    // Every equation is in an element; repetitions stand for tied dofs.
    std::vector<int> list{e % equations};
    for (int k = size(random); k > 1; --k) list.push_back(pick(random));
    const auto n = static_cast<Eigen::Index>(list.size());
    MatrixXd K = MatrixXd::NullaryExpr(n, n, [&] { return term(random); });
    if (symmetric) K = (0.5 * (K + K.transpose())).eval();
    K.diagonal().array() += 20.0;
    system.add_element(std::move(list), std::move(K));
  }
  return system;
}

System join(const System& first, const System& second) {
  System both = first;
  for (int e = 0; e < second.elements.count(); ++e) {
    const auto list = second.elements.of(e);
    std::vector<int> shifted(list.begin(), list.end());
    for (int& equation : shifted)
      if (equation >= 0) equation += first.equations;
    both.add_element(std::move(shifted), second.K[e]);
  }
  both.equations += second.equations;
  return both;
}

System& add_spring(System& system, int a, int b, double stiffness) {
  MatrixXd K(2, 2);
  K << stiffness, -stiffness, -stiffness, stiffness;
  system.add_element({a, b}, std::move(K));
  return system;
}

namespace {

// act(row, column, value) for every term of every element that is in the matrix.
template <class Act>
void each_term(const System& system, const Act& act) {
  for (int e = 0; e < system.elements.count(); ++e) {
    const auto list = system.elements.of(e);
    const MatrixXd& K = system.K[e];
    for (Eigen::Index c = 0; c < K.cols(); ++c)
      for (Eigen::Index r = 0; r < K.rows(); ++r) {
        const int i = list[r], j = list[c];
        if (i >= 0 && j >= 0) act(i, j, K(r, c));
      }
  }
}

}  // namespace

MatrixXd dense(const System& system) {
  MatrixXd A = MatrixXd::Zero(system.equations, system.equations);
  each_term(system, [&](int i, int j, double value) { A(i, j) += value; });
  return A;
}

Eigen::VectorXd product(const System& system, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(system.equations);
  each_term(system, [&](int i, int j, double value) { y(i) += value * x(j); });
  return y;
}

double norm1(const System& system) {
  System magnitudes = system;
  for (MatrixXd& K : magnitudes.K) K = K.cwiseAbs().transpose().eval();
  return product(magnitudes, Eigen::VectorXd::Ones(system.equations)).maxCoeff();
}

void load(LinearSolver& solver, const System& system) {
  solver.analyse(system.equations, system.elements);
  solver.clear();
  for (int e = 0; e < system.elements.count(); ++e) solver.add(e, system.K[e].data());
}

}  // namespace sage::conformance
