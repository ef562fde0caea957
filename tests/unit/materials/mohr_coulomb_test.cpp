// Expected values: closed forms of triaxial and plane strain failure, and, for associated flow, the closest
// point in the energy norm found by trying every subset of the planes (Kuhn-Tucker conditions).
#include "materials/mohr_coulomb.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "materials/stress_measures.hpp"
#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

double Kp(double degrees) {
  const double s = std::sin(degrees * kRadiansPerDegree);
  return (1 + s) / (1 - s);
}

// sigma_3 = 50, phi = 36.87 (K_p = 4): q = 150 from 5 % strain, and flow without volume change for psi = 0.
TEST(MohrCoulomb, TriaxialCompression) {
  const double phi = std::asin(0.6) / kRadiansPerDegree;
  for (const int steps : {1, 3, 50}) {
    const auto path = triaxial_test(*test::solid(4, {3000.0, 0.3, 0.0, phi, 0.0}), 50.0, 0.15, steps);
    EXPECT_NEAR(path.back().deviator, 150.0, 150.0 * 1e-10);
    EXPECT_NEAR(path.back().volume_strain, 0.05 * 0.4, 1e-10);
    EXPECT_EQ(path.back().status, PointStatus::yielded);
  }
}

// Dilation in triaxial compression: d eps_v / d eps_1 = 1 - K_psi after yield (compression positive).
TEST(MohrCoulomb, DilationInTriaxialCompression) {
  const auto path = triaxial_test(*test::solid(4, {1e4, 0.3, 10.0, 30.0, 10.0}), 100.0, 0.2, 40);
  const TriaxialPoint &a = path[30], &b = path[40];
  EXPECT_NEAR((b.volume_strain - a.volume_strain) / (b.axial_strain - a.axial_strain), 1.0 - Kp(10.0), 1e-9);
}

// Compression and extension mobilise the same angle: sigma_1 = sigma_3 K_p + 2 c sqrt(K_p).
TEST(MohrCoulomb, TriaxialExtension) {
  const auto law = test::solid(4, {1e4, 0.3, 10.0, 25.0, 5.0});
  const double q = -triaxial_test(*law, 100.0, -0.1, 20).back().deviator;
  EXPECT_NEAR(100.0, (100.0 - q) * Kp(25.0) + 20.0 * std::sqrt(Kp(25.0)), 1e-9);
}

// Pulled apart in all directions: the stress is the apex, c cot(phi), also where K_p < 2; next to nothing is
// left of the stiffness, and that is not negative.
TEST(MohrCoulomb, ApexOfEveryFriction) {
  for (const double phi : {2.0, 10.0, 15.0, 19.0, 25.0, 40.0}) {
    const auto a = test::update<4>(*test::solid(4, {1e4, 0.3, 10.0, phi, 0.0}), {-5, -5, -5, 0},
                                   {0.1, 0.1, 0.1, 0.0}, {0.0, 0.0});
    const double apex = 10.0 / std::tan(phi * kRadiansPerDegree);
    EXPECT_NEAR((a.sigma - Vector4(apex, apex, apex, 0.0)).norm(), 0.0, 1e-9 * apex) << phi;
    EXPECT_EQ(a.status, PointStatus::apex);
    for (int k = 0; k < 4; ++k) {
      EXPECT_GT(a.D(k, k), 0.0) << phi;
      EXPECT_LT(a.D(k, k), 1e-2 * 1e4) << phi;
    }
  }
}

// Cut off in tension out of the plane, isotropic in the plane: strain flows out of the plane only, so that the
// stresses in the plane fall by lambda dl, dl = excess / (lambda + 2 G), and shear in the plane meets the whole
// elastic G.
TEST(MohrCoulomb, TensionOutOfPlaneLeavesTheShearStiffness) {
  const double lambda = 1e4 * 0.3 / (1.3 * 0.4), G = 1e4 / 2.6, T = 5.0;
  const auto a = test::update<4>(*test::solid(4, {1e4, 0.3, 50.0, 20.0, 0.0, T}), {-20, -20, 0, 0},
                                 {-0.003, -0.003, 0.01, 0.0}, {0.0, 0.0});
  const double out = 2.0 * G * 0.01 + lambda * 0.004, flow = (out - T) / (lambda + 2.0 * G);
  const double in = -20.0 - 2.0 * G * 0.003 + lambda * 0.004 - lambda * flow;
  EXPECT_NEAR((a.sigma - Vector4(in, in, T, 0.0)).norm(), 0.0, 1e-10);
  EXPECT_EQ(a.status, PointStatus::cut_off);
  EXPECT_NEAR(a.D(3, 3), G, 1e-9 * G);
}

// Failure on an edge that leaves both stresses in the plane equal, out-of-plane compression and extension: they
// stay equal whatever the increment in the plane, so there is no shear stiffness, and no more of one direction
// than of the other.
TEST(MohrCoulomb, EdgesOfEqualStressesInThePlane) {
  const auto law = test::solid(4, {1e4, 0.3, 5.0, 30.0, 10.0});
  const double Y = 10.0 * std::sqrt(Kp(30.0));
  for (const Vector4& deps : {Vector4(0.01, 0.01, -0.03, 0.0), Vector4(-0.015, -0.015, 0.02, 0.0)}) {
    const auto a = test::update<4>(*law, {-100, -100, -100, 0}, deps, {0.0, 0.0});
    const double largest = std::max(-a.sigma[0], -a.sigma[2]), smallest = std::min(-a.sigma[0], -a.sigma[2]);
    EXPECT_NEAR(a.sigma[0], a.sigma[1], 1e-10);
    EXPECT_NEAR(largest, Kp(30.0) * smallest + Y, 1e-9);
    EXPECT_NEAR(a.D(3, 3), 0.0, 1e-9 * 1e4);
    EXPECT_NEAR((a.D.row(0) - a.D.row(1)).norm(), 0.0, 1e-9 * 1e4);
  }
}

// Stretched alike in all directions to the apex: what is left of the volume strain after p/K is plastic.
TEST(MohrCoulomb, PlasticVolumeStrainAtTheApex) {
  const auto law = test::solid(4, {1e4, 0.3, 10.0, 30.0, 0.0});
  std::vector<double> h(2, -1.0);
  EXPECT_TRUE(law->initialise(Vector4::Zero(), h));
  EXPECT_EQ(h, std::vector<double>(2, 0.0));
  const auto a = test::update<4>(*law, Vector4::Zero(), 0.01 * unit_tensor(), h);
  const double K = 1e4 / (3 * 0.4), apex = 10.0 / std::tan(30.0 * kRadiansPerDegree);
  EXPECT_NEAR(a.h[1], 0.03 - apex / K, 1e-14);
  EXPECT_NEAR(a.h[0], 0.0, 1e-14);
}

// Tresca, simple shear: tau = c, whatever the mean stress.
TEST(MohrCoulomb, TrescaInSimpleShear) {
  const auto a =
      test::update<4>(*test::solid(4, {1e4, 0.49, 20.0, 0.0}), {-5, -5, -5, 0}, {0, 0, 0, 0.05}, {0.0, 0.0});
  EXPECT_NEAR(a.sigma[3], 20.0, 1e-12);
  EXPECT_NEAR(a.sigma[0], -5.0, 1e-12);
  EXPECT_NEAR(a.h[0], 0.05 - 20.0 / (1e4 / 2.98), 1e-14);
}

// Plane strain at constant lateral stress: K_p in the plane, with sigma_zz in between.
TEST(MohrCoulomb, PlaneStrainPassive) {
  constexpr std::array<Control, 4> kPlane{Control::strain, Control::stress, Control::strain, Control::strain};
  const auto law = test::solid(4, {1e4, 0.3, 8.0, 32.0, 0.0});
  PointDriver<4> point(*law, {-100.0, -100.0, -100.0, 0.0});
  for (int i = 0; i < 20; ++i) point.advance(kPlane, {-0.01, -100.0, 0.0, 0.0});
  EXPECT_NEAR(-point.sigma()[0], 100.0 * Kp(32.0) + 16.0 * std::sqrt(Kp(32.0)), 1e-8);
  EXPECT_LT(point.sigma()[2], -100.0);
  EXPECT_GT(point.sigma()[2], point.sigma()[0]);
}

// Beyond the apex: c cot phi in all directions, for any dilation.
TEST(MohrCoulomb, Apex) {
  for (const double psi : {0.0, 12.0, 30.0}) {
    const auto law = test::solid(4, {1e4, 0.3, 10.0, 30.0, psi});
    const auto a = test::update<4>(*law, Vector4::Zero(), {0.02, 0.021, 0.019, 0.001}, {0.0, 0.0});
    EXPECT_EQ(a.status, PointStatus::apex);
    EXPECT_LT((a.sigma - 10.0 / std::tan(30.0 * kRadiansPerDegree) * unit_tensor()).norm(), 1e-11);
  }
}

// A limit at c cot phi or beyond is no limit: the tip is reached, not the cut-off.
TEST(MohrCoulomb, CutOffBeyondTheApexIsNone) {
  const double apex = 10.0 / std::tan(30.0 * kRadiansPerDegree);
  const auto status = [](double limit) {
    const auto law = test::solid(4, {1e4, 0.3, 10.0, 30.0, 0.0, limit});
    return test::update<4>(*law, Vector4::Zero(), {0.02, 0.021, 0.019, 0.001}, {0.0, 0.0}).status;
  };
  EXPECT_EQ(status(1.5 * apex), PointStatus::apex);
  EXPECT_EQ(status(0.9 * apex), PointStatus::cut_off);  // all three principal stresses at the limit
  EXPECT_EQ(status(0.0), PointStatus::cut_off);
  const auto soil = test::solid(4, {1e4, 0.3, 0.0, 30.0, 0.0, 0.0});  // c = 0: the tip is at zero too
  EXPECT_EQ(test::update<4>(*soil, Vector4::Zero(), {0.02, 0.021, 0.019, 0.001}, {0.0, 0.0}).status,
            PointStatus::apex);
}

// Cut-off at 3: uniaxial stretch holds sigma_1 = 3, the others follow nu/(1-nu) of ... the elastic part: they
// keep sigma_2 = sigma_3 = lambda-free value sigma_tr - D b lambda: 3 nu/(1-nu).
TEST(MohrCoulomb, TensionCutOff) {
  const auto law = test::solid(4, {1e4, 0.25, 50.0, 30.0, 0.0, 3.0});
  const auto a = test::update<4>(*law, Vector4::Zero(), {1e-3, 0.0, 0.0, 0.0}, {0.0, 0.0});
  EXPECT_EQ(a.status, PointStatus::cut_off);
  EXPECT_NEAR(a.sigma[0], 3.0, 1e-12);
  EXPECT_NEAR(a.sigma[1], 1.0, 1e-12);  // 3 * 0.25/0.75
  EXPECT_NEAR(a.sigma[2], 1.0, 1e-12);
}

// Turning the trial by any angle turns the answer.
TEST(MohrCoulomb, IsotropicInThePlane) {
  const MohrCoulombPlanes planes = mohr_coulomb_planes(5.0, 0.5, 0.2, 1e300);
  const ElasticModuli elastic{8000.0, 3000.0};
  const Vector4 principal_trial{-20.0, -300.0, -90.0, 0.0};
  const MohrCoulombReturn straight = return_to_planes(planes, elastic, principal_trial);
  const Matrix4 T = stress_from_principal_axes(std::cos(1.4), std::sin(1.4));
  EXPECT_LT((return_to_planes(planes, elastic, T * principal_trial).sigma - T * straight.sigma).norm(), 1e-11);
}

// Associated flow: every answer is the closest admissible point.  Brute force over all subsets of up to three
// of the twelve planes; 1e-9: conditioning of corners that nearly coincide.
class ClosestPoint {
 public:
  ClosestPoint(const MohrCoulombPlanes& planes, const ElasticModuli& elastic)
      : D_(elastic_matrix(elastic).topLeftCorner<3, 3>()) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) add(planes.N * Vector<3>::Unit(i) - Vector<3>::Unit(j), planes.Y);
    if (planes.T < 1e299)
      for (int i = 0; i < 3; ++i) add(Vector<3>::Unit(i), planes.T);
  }
  Vector<3> operator()(const Vector<3>& trial) const {
    const std::size_t n = normals_.size();
    double best = 1e300;
    Vector<3> answer = trial;
    for (std::size_t a = 0; a <= n; ++a)
      for (std::size_t b = a; b <= n; ++b)
        for (std::size_t c = b; c <= n; ++c) consider(trial, {a, b, c}, best, answer);
    return answer;
  }

 private:
  void add(const Vector<3>& normal, double limit) {
    normals_.push_back(normal);
    limits_.push_back(limit);
  }
  // Index n means "no plane".
  void consider(const Vector<3>& trial, std::array<std::size_t, 3> set, double& best, Vector<3>& answer) const {
    Matrix<3> A = Matrix<3>::Zero(), unused = Matrix<3>::Zero();
    Vector<3> y = Vector<3>::Zero();
    for (int i = 0; i < 3; ++i) {
      const std::size_t plane = set[i];
      const bool repeated = i > 0 && plane == set[i - 1];
      if (plane == normals_.size() || repeated) {
        unused(i, i) = 1.0;
      } else {
        A.col(i) = normals_[plane];
        y[i] = limits_[plane];
      }
    }
    const Matrix<3> S = A.transpose() * D_ * A + unused;
    const Eigen::FullPivLU<Matrix<3>> lu(S);
    if (!lu.isInvertible()) return;
    const Vector<3> s = trial - D_ * A * lu.solve(A.transpose() * trial - y);
    const double scale = trial.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < normals_.size(); ++i)
      if (normals_[i].dot(s) - limits_[i] > 1e-9 * scale) return;
    const double distance = (trial - s).dot(D_.inverse() * (trial - s));
    if (distance < best) {
      best = distance;
      answer = s;
    }
  }
  Matrix<3> D_;
  std::vector<Vector<3>> normals_;
  std::vector<double> limits_;
};

TEST(MohrCoulomb, AssociatedReturnIsTheClosestPoint) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const ElasticModuli elastic{8000.0, 3000.0};
  const double none = 1e300;
  const std::vector<MohrCoulombPlanes> cases = {
      mohr_coulomb_planes(5.0, 0.5, 0.5, none), mohr_coulomb_planes(5.0, 0.0, 0.0, none),
      mohr_coulomb_planes(0.0, 0.6, 0.6, none), mohr_coulomb_planes(5.0, 0.5, 0.5, 2.0),
      mohr_coulomb_planes(5.0, 0.0, 0.0, 0.0),  mohr_coulomb_planes(5.0, 1.2, 1.2, 0.5)};
  for (const MohrCoulombPlanes& planes : cases) {
    const ClosestPoint closest(planes, elastic);
    for (int i = 0; i < 150; ++i) {
      Vector4 trial{uniform(random), uniform(random), uniform(random), 0.0};
      trial *= 40.0;
      if (i % 5 == 0) trial[1] = trial[0];  // equal principals
      if (!outside(planes, trial)) continue;
      const Vector4 answer = return_to_planes(planes, elastic, trial).sigma;
      const Vector<3> expected = closest(trial.head<3>());
      EXPECT_LT((answer.head<3>() - expected).norm(), 1e-7) << "trial " << trial.transpose();
    }
  }
}

TEST(MohrCoulomb, SymmetricOnlyIfAssociated) {
  EXPECT_TRUE(test::solid(4, {1e4, 0.3, 1, 30, 30})->traits().symmetric);
  EXPECT_TRUE(test::solid(4, {1e4, 0.3, 1, 0, 0})->traits().symmetric);
  EXPECT_FALSE(test::solid(4, {1e4, 0.3, 1, 30, 0})->traits().symmetric);
}

TEST(MohrCoulomb, StressLevelAndInitialStress) {
  const auto law = test::solid(4, {1e4, 0.3, 0.0, std::asin(0.6) / kRadiansPerDegree});
  std::array<double, 2> h{};
  EXPECT_NEAR(law->stress_level({-50, -200, -100, 0}, h), 1.0, 1e-12);
  EXPECT_NEAR(law->stress_level({-50, -110, -60, 0}, h), 60.0 / (0.6 * 160.0), 1e-12);
  EXPECT_TRUE(law->initialise({-50, -199.9, -60, 0}, h));
  EXPECT_FALSE(law->initialise({-50, -201, -60, 0}, h));
  EXPECT_FALSE(law->initialise({1, 1, 1, 0}, h));
}

// With a cut-off the level is sigma_1/T where that is more than the share of the shear strength; without
// tensile strength it is 1 as soon as a tension or nothing presses.
TEST(MohrCoulomb, StressLevelOfTheCutOff) {
  const auto level = [](double T, const Vector4& sigma) {
    return test::solid(4, {1e4, 0.3, 20.0, 30.0, 0.0, T})->stress_level(sigma, {});
  };
  const auto shear = [](double s1, double s3) {
    return (s1 - s3) / (40.0 * std::cos(30.0 * kRadiansPerDegree) - 0.5 * (s1 + s3));
  };
  EXPECT_NEAR(level(0.5, {0.25, 0.0, 0.0, 0.0}), 0.5, 1e-14);
  EXPECT_NEAR(level(0.5, {0.25, -60.0, 0.0, 0.0}), shear(0.25, -60.0), 1e-14);
  EXPECT_NEAR(level(0.5, {-1.0, -1.0, -1.0, 0.0}), 0.0, 1e-14);
  EXPECT_EQ(level(0.0, {0.0, -10.0, -10.0, 0.0}), 1.0);
  EXPECT_NEAR(level(0.0, {-5.0, -20.0, -10.0, 0.0}), shear(-5.0, -20.0), 1e-14);
}

}  // namespace
}  // namespace sage
