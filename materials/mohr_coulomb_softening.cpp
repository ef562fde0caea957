#include "materials/mohr_coulomb_softening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/mohr_coulomb.hpp"
#include "materials/stress_measures.hpp"

namespace sage {

namespace {

constexpr double kUnchanged = -1.0;  // of a value at strain_2: that at strain_1

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> r = elastic_rows();
    r.push_back(
        required("cohesion", Dimension::stress, "cohesion c before plastic strain", ParameterRole::strength));
    r.push_back(required("friction_angle", Dimension::angle, "friction angle phi before plastic strain",
                         ParameterRole::friction_angle));
    r.push_back(required("dilation_angle", Dimension::angle, "dilation angle psi before plastic strain",
                         ParameterRole::dilation_angle));
    r.push_back(
        required("strain_1", Dimension::none, "plastic shear strain, sum of sqrt(2 de_p:de_p), of the next"));
    r.push_back(required("cohesion_1", Dimension::stress, "c at strain_1", ParameterRole::strength));
    r.push_back(
        required("friction_angle_1", Dimension::angle, "phi at strain_1", ParameterRole::friction_angle));
    r.push_back(
        required("dilation_angle_1", Dimension::angle, "psi at strain_1", ParameterRole::dilation_angle));
    r.push_back(
        optional("strain_2", Dimension::none, "plastic shear strain of the last values; -1 = none", -1.0));
    r.push_back(optional("cohesion_2", Dimension::stress, "c there; -1 = as at strain_1", kUnchanged,
                         ParameterRole::strength));
    r.push_back(optional("friction_angle_2", Dimension::angle, "phi there; -1 = as at strain_1", kUnchanged,
                         ParameterRole::friction_angle));
    r.push_back(optional("dilation_angle_2", Dimension::angle, "psi there; -1 = as at strain_1", kUnchanged,
                         ParameterRole::dilation_angle));
    r.push_back(optional("shape", Dimension::none,
                         "after strain_1: 0 straight to strain_2, 1 exponential with that length", 0.0));
    r.push_back(optional("tension_cut_off", Dimension::stress, "largest tension; -1 = the apex only", -1.0,
                         ParameterRole::tension_limit));
    r.push_back(
        optional("band_width", Dimension::length,
                 "of the band whose strains these are: strength then decreases with strain times element "
                 "size over this; 0 = with strain alone",
                 0.0));
    return r;
  }();
  return table;
}

StrengthPath path_from(const Parameters& p) {
  const auto angle = [&](const char* name, double before) {
    return p.number(name) == kUnchanged ? before : p.angle(name);
  };
  StrengthPath path{};
  path.c = {p.not_negative("cohesion"), p.not_negative("cohesion_1"), 0.0};
  path.c[2] = p.number("cohesion_2") == kUnchanged ? path.c[1] : p.not_negative("cohesion_2");
  path.phi = {p.angle("friction_angle"), p.angle("friction_angle_1"), 0.0};
  path.phi[2] = angle("friction_angle_2", path.phi[1]);
  path.psi = {p.angle("dilation_angle"), p.angle("dilation_angle_1"), 0.0};
  path.psi[2] = angle("dilation_angle_2", path.psi[1]);
  const char* const names[] = {"dilation_angle", "dilation_angle_1", "dilation_angle_2"};
  for (std::size_t i = 0; i < 3; ++i)
    if (path.psi[i] > path.phi[i]) p.refuse(names[i], "must not exceed the friction angle there");
  path.exponential = p.code("shape", {0, 1}) == 1;
  path.strain[0] = p.positive("strain_1");
  path.strain[1] = p.number("strain_2");
  const bool ends = path.c[2] == path.c[1] && path.phi[2] == path.phi[1] && path.psi[2] == path.psi[1];
  if (path.strain[1] == -1.0 && ends) path.strain[1] = std::numeric_limits<double>::infinity();
  if (!(path.strain[1] > path.strain[0])) p.refuse("strain_2", "must be greater than strain_1");
  path.T = p.number("tension_cut_off") == -1.0 ? std::numeric_limits<double>::infinity()
                                               : p.not_negative("tension_cut_off");
  path.band_width = p.not_negative("band_width");
  return path;
}

// (1 + sin)/(1 - sin), and its derivative.
double slope_of(double angle) {
  return (1.0 + std::sin(angle)) / (1.0 - std::sin(angle));
}
double slope_rate(double angle) {
  const double rest = 1.0 - std::sin(angle);
  return 2.0 * std::cos(angle) / (rest * rest);
}

}  // namespace

MovingPlanes StrengthPath::at(double kappa) const {
  // Share of the way from value `from` to the next, and its change with kappa.
  std::size_t from = 0;
  double share = kappa / strain[0], rate = 1.0 / strain[0];
  if (kappa >= strain[0]) {
    from = 1;
    const double length = strain[1] - strain[0], way = (kappa - strain[0]) / length;
    const double left = std::exp(-way);
    share = exponential ? 1.0 - left : std::min(way, 1.0);
    rate = exponential ? left / length : way < 1.0 ? 1.0 / length : 0.0;
  }
  const auto value = [&](const std::array<double, 3>& v) { return v[from] + share * (v[from + 1] - v[from]); };
  const auto change = [&](const std::array<double, 3>& v) { return rate * (v[from + 1] - v[from]); };
  const double angle = value(phi), dilation = value(psi), cohesion = value(c);
  const double N = slope_of(angle), N_rate = slope_rate(angle) * change(phi), root = std::sqrt(N);
  return {{N, 2.0 * cohesion * root, slope_of(dilation), T},
          {N_rate, 2.0 * change(c) * root + cohesion * N_rate / root, slope_rate(dilation) * change(psi), 0.0}};
}

ValueAndSlope StrengthPath::strain_at(double kappa, double size) const {
  const auto rate = [&](std::size_t value) {
    return band_width > 0.0 && size > 0.0 && falls_to(value) ? band_width / size : 1.0;
  };
  if (kappa < strain[0]) return {rate(1) * kappa, rate(1)};
  return {rate(1) * strain[0] + rate(2) * (kappa - strain[0]), rate(2)};
}

bool MohrCoulombSoftening::initialise(const Vector4& sigma, std::span<double> h) const {
  std::ranges::fill(h, 0.0);
  return stress_level(sigma, h) <= 1.0 + 1e-8;
}

bool MohrCoulombSoftening::accepts_history(const Vector4& sigma, std::span<const double> h) const {
  return h[kShear] >= 0.0 && h[strength_index()] >= 0.0 && stress_level(sigma, h) <= 1.0 + 1e-8;
}

double MohrCoulombSoftening::stress_level(const Vector4& sigma, std::span<const double> h) const {
  return mohr_coulomb_level(path_.at(h[strength_index()]).planes, sigma);
}

std::string MohrCoulombSoftening::caution() const {
  if (!path_.softens() || path_.band_width > 0.0) return {};
  return "the strength falls with plastic strain: it gathers in bands as narrow as the elements, so that loads "
         "after "
         "the peak depend on the mesh (docs/theory/mohr_coulomb_softening.md)";
}

MohrCoulombSoftening::Attempt MohrCoulombSoftening::attempt(const ValueAndSlope& strain, const Vector4& trial,
                                                            double kappa) const {
  const MovingPlanes moving = path_.at(kappa);
  Attempt a;
  a.direction.setZero();
  if (!outside(moving.planes, trial)) {  // it has hardened beyond the trial stress
    a.moved = {{trial, Matrix4::Identity(), PointStatus::yielded}, Vector4::Zero(), Vector4::Zero()};
    a.lack = strain;
    return a;
  }
  a.moved = return_to_moving_planes(moving, elastic_, trial);
  const Vector4 s = deviator(trial - a.moved.back.sigma);
  const double q = std::sqrt(0.5 * contract(s, s));
  if (q > 0.0) a.direction = Vector4(s[0], s[1], s[2], 2.0 * s[3]) / (2.0 * q);
  a.lack = {strain.value - q / elastic_.G, strain.slope + a.direction.dot(a.moved.rate) / elastic_.G};
  return a;
}

// The strength at the end of the increment holds (implicit): kappa is the zero of what it lacks.
Outcome MohrCoulombSoftening::update(const PointIn<4>& in, PointOut<4>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  const std::size_t strength = strength_index();
  const double kappa0 = in.h0[strength];
  const Vector4 trial = in.sigma0 + D_elastic_ * in.deps;
  if (!outside(path_.at(kappa0).planes, trial)) {
    out.sigma = trial;
    out.D = D_elastic_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }
  const double size = in.context != nullptr ? in.context->size : 0.0;
  const double strain0 = path_.strain_at(kappa0, size).value;
  const auto strain = [&](double kappa) {
    const ValueAndSlope now = path_.strain_at(kappa, size);
    return ValueAndSlope{now.value - strain0, now.slope};
  };
  const auto lack = [&](double kappa) { return attempt(strain(kappa), trial, kappa).lack; };
  double reach = 2.0 * sqrt_j2(trial) / elastic_.G;
  for (int doubling = 0; doubling < 60 && lack(kappa0 + reach).value < 0.0; ++doubling) reach *= 2.0;
  const double kappa = rising_zero(lack, kappa0, kappa0 + reach, kappa0, 1e-16 * (kappa0 + reach));
  const Attempt last = attempt(strain(kappa), trial, kappa);
  if (!(last.lack.slope > 1e-9)) return Outcome::cut_step;
  const MohrCoulombReturn& back = last.moved.back;
  out.sigma = back.sigma;
  const Vector4 growth =
      (last.direction - back.R.transpose() * last.direction) / (elastic_.G * last.lack.slope);
  out.D = (back.R + last.moved.rate * growth.transpose()) * D_elastic_;
  out.status = back.status;
  out.h1[kShear] = strength == kShear ? kappa : in.h0[kShear] + strain(kappa).value;
  out.h1[strength] = kappa;
  out.h1[kVolume] += mean_stress(trial - back.sigma) / elastic_.K;
  return Outcome::ok;
}

MaterialEntry mohr_coulomb_softening_entry() {
  return {"mohr_coulomb_softening",
          "Mohr-Coulomb, cohesion, friction and dilation change with plastic shear strain",
          4,
          rows(),
          [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            const Parameters p(rows(), values, units);
            return std::make_unique<MohrCoulombSoftening>(elastic_parameters(p), path_from(p));
          },
          MohrCoulombSoftening::kHistory};
}

}  // namespace sage
