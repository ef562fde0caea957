// The interior point method on programs whose answer is known, and the factors that it rests on.
#include "sage/bounds/cone_program.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace sage::bounds {
namespace {

// One stress point under stresses (-confining, -tau) and no shear: Mohr-Coulomb's greatest principal stress.
ConeProgram compression(double c, double phi, double confining) {
  ConeProgram program;
  Cone cone;
  cone.h0[0] = 2.0 * c * std::cos(phi);
  cone.G << std::sin(phi), std::sin(phi), 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -2.0;
  program.cones = {cone};
  Part part{0, 1, {0, 1, 2}, -Eigen::MatrixXd::Identity(3, 3)};
  program.parts = {part};
  program.b0 = Eigen::Vector3d(confining, 0.0, 0.0);
  program.b1 = Eigen::Vector3d(0.0, 1.0, 0.0);
  return program;
}

void expect_solution(const ConeProgram& program, double tau) {
  for (const Side side : {Side::primal, Side::dual}) {
    ConeOptions options;
    options.side = side;
    const ConeSolution found = solve(program, options);
    ASSERT_EQ(found.status, ConeStatus::solved);
    EXPECT_NEAR(found.tau, tau, 2e-5 * tau);
    EXPECT_NEAR(found.dual, tau, 2e-5 * tau);
    EXPECT_LT(side == Side::primal ? found.primal_residual : found.dual_residual, 1e-12);
  }
}

// s1 = s3 (1 + sin) / (1 - sin) + 2 c cos / (1 - sin).
TEST(ConeProgram, FindsTheStrengthInCompression) {
  const double phi = 0.5, sine = std::sin(phi);
  expect_solution(compression(3.0, phi, 2.0), (2.0 * (1.0 + sine) + 2.0 * 3.0 * std::cos(phi)) / (1.0 - sine));
}

// Without friction the mean stress has no influence on yield: s1 = s3 + 2 c.
TEST(ConeProgram, FindsTheStrengthWithoutFriction) {
  expect_solution(compression(3.0, 0.0, 2.0), 8.0);
}

// The velocities of the dual program: power 1 of the live load, flow rule.
TEST(ConeProgram, GivesVelocitiesThatFollowTheFlowRule) {
  const double phi = 0.3, sine = std::sin(phi);
  const ConeProgram program = compression(1.0, phi, 1.0);
  ConeOptions options;
  options.side = Side::dual;
  const ConeSolution found = solve(program, options);
  EXPECT_NEAR(found.u[1], 1.0, 1e-5);
  EXPECT_NEAR(found.u[0], -(1.0 + sine) / (1.0 - sine), 1e-3);
}

// tau as a part of the strength: s1 = 4 c - 2 tau at equal loads.
TEST(ConeProgram, FindsTheStrengthThatIsLeft) {
  ConeProgram program = compression(2.0, 0.0, 1.0);
  program.b0[1] = 2.0;
  program.b1.setZero();
  program.cones[0].h1[0] = -2.0;
  const ConeSolution found = solve(program);
  ASSERT_EQ(found.status, ConeStatus::solved);
  EXPECT_NEAR(found.tau, 1.5, 1e-4);
}

TEST(ConeProgram, SaysThatTheFixedLoadsAloneAreTooLarge) {
  ConeProgram program = compression(1.0, 0.0, 10.0);
  program.b0[1] = 0.0;
  program.b1 = Eigen::Vector3d(0.0, 0.0, 1.0);
  EXPECT_NE(solve(program).status, ConeStatus::solved);
}

TEST(ConeProgram, StopsWhenAsked) {
  ConeOptions options;
  options.stop_asked = [] { return true; };
  EXPECT_EQ(solve(compression(1.0, 0.0, 1.0), options).status, ConeStatus::stopped);
}

// A chain of couplings of three equations each against a dense solution; equation 5 repeats equation 4.
TEST(SparseFactor, SolvesWhatADenseFactorSolves) {
  constexpr int kEquations = 41;
  std::vector<Coupling> couplings;
  std::vector<Eigen::MatrixXd> parts;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(kEquations, kEquations);
  for (int i = 0; i + 2 < kEquations; i += 2) {
    couplings.push_back({{i, i + 1, i + 2}, {static_cast<double>((7 * i) % 13), static_cast<double>(i % 5)}});
    Eigen::Matrix3d A;
    A << 2.0 + i, 1.0, 0.5, 1.0, 3.0, -0.25 * i, 0.5, 0.1, 1.0;
    const Eigen::Matrix3d part = A * A.transpose();
    K.block<3, 3>(i, i) += part;
    parts.push_back(part);
  }
  SparseFactor factor(kEquations, couplings);
  const auto part = [&](int i) -> const Eigen::MatrixXd& { return parts[i]; };
  factor.factorise(part, 1e-13);
  EXPECT_EQ(factor.dropped(), 0);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(kEquations, -1.0, 2.0);
  Eigen::VectorXd x = b;
  factor.solve(x);
  const Eigen::VectorXd expected = K.partialPivLu().solve(b);
  EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
}

TEST(SparseFactor, LeavesOutAnEquationThatDependsOnOthers) {
  std::vector<Eigen::MatrixXd> parts{Eigen::MatrixXd::Ones(2, 2)};
  const std::vector<Coupling> couplings{{{0, 1}, Eigen::Vector2d::Zero()}};
  SparseFactor factor(2, couplings);
  factor.factorise([&](int) -> const Eigen::MatrixXd& { return parts[0]; }, 1e-13);
  EXPECT_EQ(factor.dropped(), 1);
  Eigen::VectorXd x = Eigen::Vector2d(3.0, 3.0);
  factor.solve(x);
  EXPECT_NEAR(x.sum(), 3.0, 1e-12);
}

}  // namespace
}  // namespace sage::bounds
