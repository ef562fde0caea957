// Laws on one point against closed forms.
#include <fmt/format.h>

#include <cmath>

#include "sage/core/point_driver.hpp"
#include "sage/verify/cases.hpp"

namespace sage::verify {

namespace {

constexpr double kDegree = kRadiansPerDegree;

const UnitSystem kKilopascal{"m", "kN", "kPa", 101.325, 9.81};

std::unique_ptr<SolidLaw> solid(const Record& record, int code, const std::vector<double>& parameters) {
  LawPtr law = record.bench().catalogue().materials.find(code)->make(parameters, kKilopascal);
  return std::move(std::get<std::unique_ptr<SolidLaw>>(law));
}

// sigma3 = 50, E = 3000, sin phi = 3/5, c = 0: K_p = 4, q_f = 150, yield at eps_a = 5 %, then flow without
// volume change: eps_r = -nu eps_y - (eps_a - eps_y)/2.  With cohesion q_f = sigma3 (K_p - 1) + 2 c sqrt(K_p).
void triaxial_compression(Record& record) {
  const double nu = 0.3, phi = std::asin(0.6) / kDegree;
  for (int code : {3, 4}) {
    const char* name = code == 3 ? "Drucker-Prager" : "Mohr-Coulomb";
    for (int steps : {1, 20}) {
      const auto path = triaxial_test(*solid(record, code, {3000.0, nu, 0.0, phi, 0.0}), 50.0, 0.10, steps);
      record.near(Where::point, fmt::format("{}, {} steps: deviator at 10 %", name, steps),
                  path.back().deviator, 150.0, 1e-9);
      // eps_v = eps_a + 2 eps_r, compression positive: all of it elastic, eps_y (1 - 2 nu).
      record.near(Where::point, fmt::format("{}, {} steps: volume strain at 10 %", name, steps),
                  path.back().volume_strain, 0.05 * (1 - 2 * nu), 1e-9);
    }
    const auto cohesive = triaxial_test(*solid(record, code, {3000.0, nu, 12.0, phi, 0.0}), 50.0, 0.20, 5);
    record.near(Where::point, fmt::format("{}, c = 12: deviator at failure", name), cohesive.back().deviator,
                50.0 * 3 + 2 * 12.0 * 2, 1e-9);
  }
}

// Cone of triaxial compression in extension: q = M p with M = 6 sin phi/(3 - sin phi), cell = p + q/3, axial =
// p - 2q/3, so sin phi_e = 3 M/(6 - M).  Mohr-Coulomb keeps phi.
void triaxial_extension(Record& record) {
  const double cell = 100.0;
  for (double phi : {20.0, 30.0}) {
    const double M = 6 * std::sin(phi * kDegree) / (3 - std::sin(phi * kDegree)), sine = 3 * M / (6 - M);
    for (int code : {3, 4}) {
      const auto path = triaxial_test(*solid(record, code, {3e4, 0.3, 0.0, phi, 0.0}), cell, -0.10, 10);
      const double axial = cell + path.back().deviator;  // the smallest principal stress
      const double mobilised = (cell - axial) / (cell + axial);
      const double reference = code == 4 ? std::sin(phi * kDegree) : sine;
      record.near(Where::point,
                  fmt::format("sin of mobilised friction, {}, phi = {:g}",
                              code == 3 ? "Drucker-Prager" : "Mohr-Coulomb", phi),
                  mobilised, reference, 1e-6);
    }
  }
}

// Passive compression in plane strain, tension +: sigma_xx = -p held, eps_yy driven.  Friction at collapse.
double plane_strain_sine(const SolidLaw& law, double p) {
  PointDriver<4> driver(law, {-p, -p, -p, 0.0});
  for (int i = 0; i < 400; ++i)
    driver.advance({Control::stress, Control::strain, Control::strain, Control::strain},
                   {-p, -0.005, 0.0, 0.0});
  return (driver.sigma()[0] - driver.sigma()[1]) / -(driver.sigma()[0] + driver.sigma()[1]);
}

// sin phi* = 3 alpha sqrt(1 - 3 beta^2)/(1 - 3 alpha beta); alpha = beta = 2 sin phi/(sqrt 3 (3 - sin phi)) for
// the cone of compression.
void plane_strain_cone(Record& record) {
  for (double phi : {20.0, 30.0}) {
    const double s = std::sin(phi * kDegree), alpha = 2 * s / (std::sqrt(3.0) * (3 - s));
    const double level = 100.0;
    record.near(Where::point, fmt::format("compression cone, no volume change, phi = {:g}", phi),
                plane_strain_sine(*solid(record, 3, {1e5, 0.3, 0.0, phi, 0.0, 1.0, 1.0}), level), 3 * alpha,
                1e-6);
    record.near(Where::point, fmt::format("compression cone, associated, phi = {:g}", phi),
                plane_strain_sine(*solid(record, 3, {1e5, 0.3, 0.0, phi, phi, 1.0, 0.0}), level),
                3 * alpha * std::sqrt(1 - 3 * alpha * alpha) / (1 - 3 * alpha * alpha), 1e-6);
    record.near(Where::point, fmt::format("plane strain cone, associated, phi = {:g}", phi),
                plane_strain_sine(*solid(record, 3, {1e5, 0.3, 0.0, phi, phi, 3.0, 0.0}), level), s, 1e-6);
    record.near(Where::point, fmt::format("plane strain cone, no volume change, phi = {:g}", phi),
                plane_strain_sine(*solid(record, 3, {1e5, 0.3, 0.0, phi, 0.0, 4.0, 1.0}), level), s, 1e-6);
    record.near(Where::point, fmt::format("Mohr-Coulomb, phi = {:g}", phi),
                plane_strain_sine(*solid(record, 4, {1e5, 0.3, 0.0, phi, 0.0}), level), s, 1e-9);
  }
}

// Constant strain rate from a point on the cone: R = |s| = sqrt2 (k - alpha I1), psi the angle between s and
// de.  Without volume change R = R0 + B, tan(psi/2) = tan(psi0/2) (R/R0)^(-2 G e/B), e = |de|, B = -3 sqrt2 K
// alpha deps_v.
void constant_rate(Record& record) {
  const double G = 1000.0, nu = 0.3, K = 2 * G * (1 + nu) / (3 * (1 - 2 * nu)), E = 2 * G * (1 + nu);
  const double phi = 30.0, c = 5.0;
  const double s30 = std::sin(phi * kDegree), alpha = 2 * s30 / (std::sqrt(3.0) * (3 - s30));
  const double k = 6 * c * std::cos(phi * kDegree) / (std::sqrt(3.0) * (3 - s30));
  const double p0 = -20.0;  // mean stress, tension +
  const double R0 = std::sqrt(2.0) * (k - alpha * 3 * p0);
  const Vector4 direction = Vector4(2.0, -1.0, -1.0, 0.0) / std::sqrt(6.0);
  const Vector4 sigma0 = R0 * direction + p0 * Vector4(1, 1, 1, 0);
  // Deviatoric strain rate with a component off s0, volume shrinking.
  const Vector4 de = 0.02 * (0.3 * direction + 0.8 * Vector4(0.0, 1.0, -1.0, 0.0) / std::sqrt(2.0));
  const double volume = -0.004, e = de.norm();
  const double B = -3 * std::sqrt(2.0) * alpha * K * volume, R1 = R0 + B;
  const double psi0 = std::acos(de.dot(direction) / e);
  const double psi1 = 2 * std::atan(std::tan(psi0 / 2) * std::pow(R1 / R0, -2 * G * e / B));
  const auto angle_after = [&](const SolidLaw& law, int steps, double& R) {
    PointDriver<4> driver(law, sigma0);
    const Vector4 step = (de + volume / 3 * Vector4(1, 1, 1, 0)) / steps;
    for (int i = 0; i < steps; ++i)
      driver.advance({Control::strain, Control::strain, Control::strain, Control::strain}, step);
    Vector4 s = driver.sigma();
    s.head<3>().array() -= s.head<3>().mean();
    R = s.norm();
    return std::acos(s.dot(de) / (R * e));
  };
  double R = 0.0;
  const auto exact_law = solid(record, 3, {E, nu, c, phi, 0.0, 1.0, 1.0, -1.0, 0.0, 1.0});
  record.near(Where::point, "exact integration in one step: angle of the deviator",
              angle_after(*exact_law, 1, R), psi1, 1e-9);
  record.near(Where::point, "exact integration in one step: size of the deviator", R, R1, 1e-9);
  std::vector<double> size, error;
  const auto radial_law = solid(record, 3, {E, nu, c, phi, 0.0, 1.0, 1.0});
  for (int steps : {20, 40, 80}) {
    size.push_back(1.0 / steps);
    error.push_back(std::abs(angle_after(*radial_law, steps, R) / psi1 - 1.0));
  }
  record.order(Where::point, "radial return: angle of the deviator", size, error, 1.0);
}

// q = eps/(1/E_i + eps R_f/q_f).  K = 400, n = .5, R_f = .8, c = 5, phi = 33, sigma3 = 100.
void duncan_chang(Record& record) {
  const double strain[] = {0.001, 0.005, 0.01, 0.02}, q[] = {35.789399, 123.878397, 178.928255, 230.042010};
  const std::vector<double> parameters{400, 0.5, 0.8, 600, 200, 0.2, 5.0, 33.0, 0.0};
  for (int code : {6, 7})
    for (int steps : {20, 80}) {
      const auto law = solid(record, code, parameters);
      for (std::size_t i = 0; i < 4; ++i)
        record.near(
            Where::point,
            fmt::format("{}, {} steps: deviator at {:g} %",
                        code == 6 ? "Duncan et al. 1980" : "inside Mohr-Coulomb", steps, 100 * strain[i]),
            triaxial_test(*law, 100.0, strain[i], steps).back().deviator, q[i], 2e-3);
    }
  // Beyond failure the law inside Mohr-Coulomb may not overshoot q_f = 257.62971.
  record.near(Where::point, "inside Mohr-Coulomb: deviator at 10 %",
              triaxial_test(*solid(record, 7, parameters), 100.0, 0.10, 20).back().deviator, 257.62971, 1e-7);
}

}  // namespace

Section law_cases() {
  return {"Laws on one point",
          {
              {"law.triaxial_compression", "Drucker-Prager and Mohr-Coulomb, drained compression",
               "q_f = sigma3 (K_p - 1) + 2 c sqrt(K_p)", Grade::exact, "the same with any step: 1e-9",
               triaxial_compression},
              {"law.triaxial_extension", "the cone of triaxial compression in extension",
               "sin phi_e = 3M/(6 - M), M = 6 sin phi/(3 - sin phi)", Grade::exact, "flow to the limit: 1e-6",
               triaxial_extension},
              {"law.plane_strain", "friction that the cones give in plane strain collapse",
               "sin phi* = 3 alpha sqrt(1 - 3 beta^2)/(1 - 3 alpha beta)", Grade::exact,
               "flow to the limit: 1e-6", plane_strain_cone},
              {"law.constant_rate", "Drucker-Prager under a constant strain rate",
               "tan(psi/2) = tan(psi0/2)(R/R0)^(-2Ge/B); Krieg & Krieg 1977 for alpha = 0", Grade::exact,
               "rounding 1e-9; radial return is of order 1", constant_rate},
              {"law.hyperbola", "hyperbolic laws, drained compression", "q = eps/(1/E_i + eps R_f/q_f)",
               Grade::exact, "substepping tolerance 1e-3 a substep: 2e-3; strength 1e-7", duncan_chang},
          }};
}

}  // namespace sage::verify
