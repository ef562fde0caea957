// Laws on one point against closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "sage/core/point_driver.hpp"
#include "sage/math/quadrature.hpp"
#include "tests/studies/verify/cases.hpp"

namespace sage::verify {

namespace {

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

// Cone of triaxial compression in extension: q = M p with M = 6 sin phi/(3 - sin phi), cell = p + q/3,
// axial = p - 2q/3, so sin phi_e = 3 M/(6 - M).  Mohr-Coulomb keeps phi.
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

// The angle whose cone of triaxial compression has this alpha (friction) or beta (dilation).
double cone_angle(double alpha) {
  return std::asin(3 * std::sqrt(3.0) * alpha / (2 + std::sqrt(3.0) * alpha)) / kDegree;
}

// Constant strain rate from a point on the cone: R = |s| = sqrt2 (k - alpha I1), psi the angle between
// s and de. Without volume change R = R0 + B, tan(psi/2) = tan(psi0/2) (R/R0)^(-2 G e/B), e = |de|, B =
// -3 sqrt2 K alpha deps_v. With dilation: the rate equations R psi' = -2 G e sin psi, R' = A cos psi +
// B, integrated to 10 digits.
void constant_rate(Record& record) {
  const double G = 1000.0, nu = 0.3, K = 2 * G * (1 + nu) / (3 * (1 - 2 * nu)), E = 2 * G * (1 + nu);
  const double alpha = 0.2, k = 10.0, phi = cone_angle(alpha);
  const double c = k * std::sqrt(3.0) * (3 - std::sin(phi * kDegree)) / (6 * std::cos(phi * kDegree));
  const double p0 = -20.0, volume = -0.004;  // mean stress, tension +; volume strain
  const double R0 = std::sqrt(2.0) * (k - alpha * 3 * p0);
  const Vector4 one(1, 1, 1, 0), direction = Vector4(2.0, -1.0, -1.0, 0.0) / std::sqrt(6.0);
  const Vector4 sigma0 = R0 * direction + p0 * one;
  const Vector4 de = 0.02 * (0.3 * direction + 0.8 * Vector4(0.0, 1.0, -1.0, 0.0) / std::sqrt(2.0));
  struct Answer {
    double R, p, psi;
  };
  const auto follow = [&](const SolidLaw& law, int steps) -> Answer {
    PointDriver<4> driver(law, sigma0);
    const Vector4 step = (de + volume / 3 * one) / steps;
    for (int i = 0; i < steps; ++i)
      driver.advance({Control::strain, Control::strain, Control::strain, Control::strain}, step);
    const double p = driver.sigma().head<3>().mean();
    const Vector4 s = driver.sigma() - p * one;
    return {s.norm(), p, std::acos(s.dot(de) / (s.norm() * de.norm()))};
  };

  const double e = de.norm(), B = -3 * std::sqrt(2.0) * alpha * K * volume, R1 = R0 + B;
  const double psi0 = std::acos(de.dot(direction) / e);
  const double psi1 = 2 * std::atan(std::tan(psi0 / 2) * std::pow(R1 / R0, -2 * G * e / B));
  const Answer exact = follow(*solid(record, 3, {E, nu, c, phi, 0.0, 1.0, 1.0, -1.0, 0.0, 1.0}), 1);
  record.near(Where::point, "exact integration in one step: angle of the deviator", exact.psi, psi1, 1e-9);
  record.near(Where::point, "exact integration in one step: size of the deviator", exact.R, R1, 1e-9);

  struct Reference {
    double beta;
    Answer end;
  };
  const Reference references[] = {{0.0, {38.466608897, -28.66666667, 0.5059691287}},
                                  {0.05, {41.025704081, -31.68258926, 0.5187885227}},
                                  {0.2, {45.268943836, -36.68329527, 0.5386025838}}};
  for (const auto& [beta, end] : references) {
    const auto law = solid(record, 3, {E, nu, c, phi, cone_angle(beta), 1.0, beta == 0.0 ? 1.0 : 0.0});
    std::vector<double> size, error;
    for (int steps : {20, 40, 80}) {
      const Answer found = follow(*law, steps);
      size.push_back(1.0 / steps);
      error.push_back(std::abs(found.psi / end.psi - 1.0));
    }
    record.order(Where::point, fmt::format("angle of the deviator, radial return, beta = {:g}", beta), size,
                 error, 1.0);
    const Answer fine = follow(*law, 4000);
    record.near(Where::point, fmt::format("size of the deviator, 4000 steps, beta = {:g}", beta), fine.R, end.R,
                1e-4);
    record.near(Where::point, fmt::format("mean stress (tension +), 4000 steps, beta = {:g}", beta), fine.p,
                end.p, 1e-4);
  }
}

// Mohr-Coulomb, c = 0, phi = 30, nu = .2, squeezed without lateral strain from sigma = 1 all round: elastic
// with K0 = nu/(1 - nu) to sigma1 = N sigma3, then along that edge (both lateral stresses smallest).  There the
// lateral plastic strain is M/2 of the axial one outwards, and that of elasticity takes it back, so that with t
// the growth of sigma3 and de the strain after yield  E de = t (N - 2 nu + 2 (1 - nu - nu N)/M).
void oedometer(Record& record) {
  const double E = 20000.0, nu = 0.2, phi = 30.0, strain = 0.02, N = 3.0, K0 = nu / (1 - nu);
  constexpr auto e = Control::strain;
  for (double psi : {0.0, 10.0, 30.0}) {
    const double sine = std::sin(psi * kDegree), M = (1 + sine) / (1 - sine);
    const double grown = (N - 1) / (1 - N * K0);  // of sigma1, where it yields
    const double left = strain - grown * (1 + nu) * (1 - 2 * nu) / (E * (1 - nu));
    const double lateral = 1 + K0 * grown + E * left / (N - 2 * nu + 2 * (1 - nu - nu * N) / M);
    for (int steps : {1, 20}) {
      const auto law = solid(record, 4, {E, nu, 0.0, phi, psi});
      PointDriver<4> driver(*law, Vector4(-1.0, -1.0, -1.0, 0.0));
      for (int i = 0; i < steps; ++i) driver.advance({e, e, e, e}, {0.0, -strain / steps, 0.0, 0.0});
      const std::string name = fmt::format("psi = {:g}, {} steps: ", psi, steps);
      record.near(Where::point, name + "axial stress", -driver.sigma()[1], N * lateral, 1e-9);
      record.near(Where::point, name + "lateral stress", -driver.sigma()[0], lateral, 1e-9);
      record.near(Where::point, name + "stress out of plane", -driver.sigma()[2], lateral, 1e-9);
    }
  }
}

// q = eps/(1/E_i + eps R_f/q_f).  K = 400, n = .5, R_f = .8, c = 5, phi = 33, sigma3 = 100.
void duncan_chang(Record& record) {
  const double strain[] = {0.001, 0.005, 0.01, 0.02}, q[] = {35.789399, 123.878397, 178.928255, 230.042010};
  const std::vector<double> parameters{400, 0.5, 0.8, 600, 200, 0.2, 5.0, 33.0, 0.0};
  const std::vector<double> poisson{400, 0.5, 0.8, 600, 0.3, 0.0, 0.0, 5.0, 33.0};  // nu = .3
  const std::map<int, const char*> names{
      {5, "Duncan & Chang 1970"}, {6, "Duncan et al. 1980"}, {7, "inside Mohr-Coulomb"}};
  for (const auto& [code, name] : names)
    for (int steps : {20, 80}) {
      const auto law = solid(record, code, code == 5 ? poisson : parameters);
      for (std::size_t i = 0; i < 4; ++i)
        record.near(Where::point, fmt::format("{}, {} steps: deviator at {:g} %", name, steps, 100 * strain[i]),
                    triaxial_test(*law, 100.0, strain[i], steps).back().deviator, q[i], 2e-3);
    }
  // Beyond failure the law inside Mohr-Coulomb may not overshoot q_f = 257.62971.
  record.near(Where::point, "inside Mohr-Coulomb: deviator at 10 %",
              triaxial_test(*solid(record, 7, parameters), 100.0, 0.10, 20).back().deviator, 257.62971, 1e-7);
}

// The hyperbolic law of Duncan et al. (1980) once more, in plain rates: K = 400, n = .5, R_f = .8, K_ur = 600,
// K_b = 250, m = .3, c = 5, phi = 33.
struct PlainHyperbola {
  double pa = 101.325, c = 5.0, phi = 33.0 * kDegree;
  double initial(double s3) const { return 400 * pa * std::sqrt(s3 / pa); }
  double reload(double s3) const { return 600 * pa * std::sqrt(s3 / pa); }
  double bulk(double s3, double E) const {
    return std::clamp(250 * pa * std::pow(s3 / pa, 0.3), E / 3, E / (3 * (1 - 2 * 0.49)));
  }
  double failure(double s3) const {
    return (2 * c * std::cos(phi) + 2 * s3 * std::sin(phi)) / (1 - std::sin(phi));
  }
  double tangent(double s1, double s3) const {
    return initial(s3) * std::pow(1 - 0.8 * (s1 - s3) / failure(s3), 2);
  }
  double shear(double s1, double s3) const {
    const double E = tangent(s1, s3), B = bulk(s3, E);
    return 3 * B * E / (9 * B - E);
  }
};

// Integral of f from a to b: Gauss with three points in 2000 parts.
double integral(double a, double b, const std::function<double(double)>& f) {
  constexpr int kParts = 2000;
  const double part = (b - a) / kParts;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double middle = a + (i + 0.5) * part;
    for (const auto& [xi, w] : GaussLine<3>::table) sum += 0.5 * part * w * f(middle + 0.5 * part * xi);
  }
  return sum;
}

// Paths other than drained compression, whose references are the rates above integrated by other means.
void hyperbola_paths(Record& record) {
  constexpr auto e = Control::strain, s = Control::stress;
  const PlainHyperbola plain;
  const std::vector<double> parameters{400, 0.5, 0.8, 600, 250, 0.3, 5.0, 33.0};
  for (int code : {6, 7}) {
    const char* name = code == 6 ? "Duncan et al. 1980" : "inside Mohr-Coulomb";
    const auto law = solid(record, code, parameters);
    const Vector4 start(-100.0, -100.0, -100.0, 0.0);
    {  // simple shear without volume change: s1,3 = 100 +- tau, gamma = integral of d tau/G
      const double tau = 45.0;
      const double gamma = integral(0.0, tau, [&](double t) { return 1 / plain.shear(100 + t, 100 - t); });
      PointDriver<4> driver(*law, start);
      for (int i = 0; i < 40; ++i) driver.advance({e, e, e, e}, {0.0, 0.0, 0.0, gamma / 40});
      record.near(Where::point, fmt::format("{}: simple shear, tau at gamma = {:.5f}", name, gamma),
                  driver.sigma()[3], tau, 2e-3);
    }
    {  // drained compression to q = 200, then back to 60: E_ur below 3/4 of 200, linear above
      const double q1 = 200.0, q2 = 60.0, E_i = plain.initial(100), E_ur = plain.reload(100);
      const double strain = q1 / (E_i * (1 - 0.8 * q1 / plain.failure(100)));
      const double back = integral(0.75 * q1, q1,
                                   [&](double q) {
                                     const double E = plain.tangent(100 + q, 100);
                                     return 1 / (E_ur + (E - E_ur) * (q / q1 - 0.75) / 0.25);
                                   }) +
                          (0.75 * q1 - q2) / E_ur;
      PointDriver<4> driver(*law, start);
      for (int i = 0; i < 80; ++i) driver.advance({s, e, s, e}, {-100.0, -strain / 80, -100.0, 0.0});
      for (int i = 0; i < 80; ++i) driver.advance({s, e, s, e}, {-100.0, back / 80, -100.0, 0.0});
      record.near(Where::point, fmt::format("{}: deviator after unloading by {:.3e}", name, back),
                  -driver.sigma()[1] - 100, q2, 3e-3);
    }
    {  // oedometer from 50 to 3 %: d s1 = (B + 4G/3) de, d s3 = (B - 2G/3) de, by the midpoint rule
      constexpr int kSteps = 20000;
      const double de = 0.03 / kSteps;
      double s1 = 50.0, s3 = 50.0;
      const auto rates = [&](double a, double b) {
        const double G = plain.shear(a, b), B = plain.bulk(b, plain.tangent(a, b));
        return Vector2(B + 4 * G / 3, B - 2 * G / 3);
      };
      for (int i = 0; i < kSteps; ++i) {
        const Vector2 half = 0.5 * de * rates(s1, s3), full = de * rates(s1 + half[0], s3 + half[1]);
        s1 += full[0];
        s3 += full[1];
      }
      PointDriver<4> driver(*law, 0.5 * start);
      for (int i = 0; i < 20; ++i) driver.advance({e, e, e, e}, {0.0, -0.03 / 20, 0.0, 0.0});
      record.near(Where::point, fmt::format("{}: oedometer, axial stress at 3 %", name), -driver.sigma()[1], s1,
                  2e-3);
      record.near(Where::point, fmt::format("{}: oedometer, lateral stress at 3 %", name), -driver.sigma()[0],
                  s3, 2e-3);
    }
  }
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
               "rounding 1e-9; radial return is of order 1: 1e-4 with 4000 steps", constant_rate},
              {"law.oedometer", "Mohr-Coulomb without lateral strain, along the edge of equal lateral stresses",
               "sigma3 grows by E de/(N - 2 nu + 2 (1 - nu - nu N)/M) after yield", Grade::exact,
               "the same with any step: 1e-9", oedometer},
              {"law.hyperbola", "hyperbolic laws, drained compression", "q = eps/(1/E_i + eps R_f/q_f)",
               Grade::exact, "substepping tolerance 1e-3 a substep: 2e-3; strength 1e-7", duncan_chang},
              {"law.hyperbola_paths", "hyperbolic laws in simple shear, unloading and the oedometer",
               "the law's rates (H1) to (H5), integrated by quadrature", Grade::exact,
               "substepping tolerance 1e-3 a substep: 2e-3, 3e-3 for what is left after unloading",
               hyperbola_paths},
          }};
}

}  // namespace sage::verify
