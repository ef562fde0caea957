#include "materials/duncan_chang.hpp"

namespace sage {

std::vector<Parameter> duncan_chang_rows(VolumeRule volume) {
  std::vector<Parameter> r = hyperbolic_rows(volume);
  r.push_back(optional("largest_poissons_ratio", Dimension::none, "upper bound of Poisson's ratio", 0.49));
  r.push_back(
      optional("stress_floor", Dimension::none, "smallest sigma_3 for the moduli, as a fraction of p_a", 0.01));
  r.push_back(optional("tangent", Dimension::none, "0 consistent (unsymmetric), 1 isotropic (symmetric)", 0.0));
  r.push_back(
      optional("principals", Dimension::none, "sigma_1, sigma_3 of 0 all three, 1 those in the plane", 0.0));
  r.push_back(
      optional("step_tolerance", Dimension::none, "relative error of a substep, by its Euler half", 1e-3));
  return r;
}

LawPtr make_duncan_chang(VolumeRule volume, std::span<const double> values, const UnitSystem& units) {
  const std::vector<Parameter> table = duncan_chang_rows(volume);
  const Parameters p(table, values, units);
  HyperbolicSteps steps;
  steps.moduli = hyperbolic_parameters(p, volume);
  const auto tangent = static_cast<HyperbolicTangent>(p.code("tangent", {0, 1}));
  steps.in_plane = p.code("principals", {0, 1}) == 1;
  steps.tolerance = p.between("step_tolerance", 1e-10, 1.0);
  return std::make_unique<DuncanChang>(steps, tangent);
}

bool DuncanChang::initialise(const Vector4& sigma, std::span<double> h) const {
  const Extremes s = extremes(sigma, steps_.in_plane);
  h[kMemory] = stress_state(steps_.moduli, s.sigma_1, s.sigma_3).v;
  return hyperbolic_level(steps_.moduli, s.sigma_1, s.sigma_3) <= 1.0 + 1e-8;
}

bool DuncanChang::accepts_history(const Vector4& sigma, std::span<const double> h) const {
  double own[1];
  initialise(sigma, own);
  return h[kMemory] >= own[kMemory] * (1.0 - 1e-8);
}

Outcome DuncanChang::update(const PointIn<4>& in, PointOut<4>& out) const {
  const HyperbolicAnswer a = integrate(steps_, in.sigma0, in.deps, in.h0[kMemory]);
  out.sigma = a.sigma;
  out.D = tangent_ == HyperbolicTangent::consistent ? a.J : a.D;
  out.h1[kMemory] = a.memory;
  out.status = a.status;
  return a.accurate ? Outcome::ok : Outcome::cut_step;
}

double DuncanChang::stress_level(const Vector4& sigma, std::span<const double> /*h*/) const {
  const Extremes s = extremes(sigma, steps_.in_plane);
  return hyperbolic_level(steps_.moduli, s.sigma_1, s.sigma_3);
}

MaterialEntry duncan_chang_1970_entry() {
  return {"duncan_chang_1970",
          "hyperbolic E and Poisson's ratio (Duncan & Chang 1970)",
          4,
          duncan_chang_rows(VolumeRule::poisson_1970),
          [](std::span<const double> values, const UnitSystem& units) {
            return make_duncan_chang(VolumeRule::poisson_1970, values, units);
          },
          DuncanChang::kHistory};
}

MaterialEntry duncan_chang_eb_entry() {
  return {"duncan_chang_eb",
          "hyperbolic E and bulk modulus (Duncan, Byrne, Wong & Mabry 1980)",
          4,
          duncan_chang_rows(VolumeRule::bulk_1980),
          [](std::span<const double> values, const UnitSystem& units) {
            return make_duncan_chang(VolumeRule::bulk_1980, values, units);
          },
          DuncanChang::kHistory};
}

}  // namespace sage
