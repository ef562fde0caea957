#include "sage/model/undrained.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

const Vector4 kVolume(1.0, 1.0, 1.0, 0.0);
// Bulk over shear modulus that the tangent sees at most: beyond, rounding of strains times the bulk is more than
// equilibrium allows.  docs/decisions/0029-stiff-water.md
constexpr double kStiffest = 1e8;
constexpr double kRigid = 1e30;  // what stands for water without any change of volume
constexpr double kUnknownStiffness = std::numeric_limits<double>::quiet_NaN();

struct Stiffness {
  double G = kUnknownStiffness, K = kUnknownStiffness;
};

Stiffness at_zero_stress(const SolidLaw& law) {
  if (law.traits().wants_context) return {};
  const std::vector<double> h = initial_values(law.traits().history);
  std::vector<double> h1 = h;
  const PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), h};
  PointOut<4> out;
  out.h1 = h1;
  if (law.update(in, out) != Outcome::ok || !(out.D(3, 3) > 0.0)) return {};
  return {out.D(3, 3), out.D.topLeftCorner<3, 3>().sum() / 9.0};
}

}  // namespace

UndrainedLaw::UndrainedLaw(std::unique_ptr<SolidLaw> grains) : grains_(std::move(grains)) {
  const std::span<const Quantity> own = grains_->traits().history;
  quantities_.assign(own.begin(), own.end());
  quantities_.push_back({"excess_pore_pressure", Dimension::stress});
  quantities_.push_back({"water_bulk", Dimension::stress});
  quantities_.push_back({"volume_left", Dimension::none});
  const double G = at_zero_stress(*grains_).G;
  stiffest_ = G > 0.0 ? kStiffest * G : std::numeric_limits<double>::infinity();
}

Vector4 UndrainedLaw::effective(const Vector4& sigma, std::span<const double> h) const {
  return sigma + h[excess()] * kVolume;
}

bool UndrainedLaw::initialise(const Vector4& sigma, std::span<double> h) const {
  return grains_->initialise(effective(sigma, h), h.first(excess()));
}

bool UndrainedLaw::accepts_history(const Vector4& sigma, std::span<const double> h) const {
  return grains_->accepts_history(effective(sigma, h), h.first(excess()));
}

Outcome UndrainedLaw::update(const PointIn<4>& in, PointOut<4>& out) const {
  const std::size_t n = excess();
  PointIn<4> grains = in;
  grains.sigma0 = effective(in.sigma0, in.h0);
  grains.h0 = in.h0.first(n);
  const std::span<double> all = out.h1;
  out.h1 = all.first(n);
  const Outcome outcome = grains_->update(grains, out);
  out.h1 = all;
  const double water = in.h0[n + 1], bulk = std::min(water, stiffest_);
  const double volume = in.h0[n + 2] + in.deps.head<3>().sum();
  const double excess = in.h0[n] - bulk * volume;
  all[n] = excess;
  all[n + 1] = water;
  all[n + 2] = bulk < water ? (1.0 - bulk / water) * volume : 0.0;
  if (outcome != Outcome::ok) return outcome;
  out.sigma -= excess * kVolume;
  out.D.topLeftCorner<3, 3>().array() += bulk;
  return outcome;
}

double UndrainedLaw::path_error(const PointIn<4>& in, const Vector4& sigma, std::span<const double> h) const {
  PointIn<4> grains = in;
  grains.sigma0 = effective(in.sigma0, in.h0);
  grains.h0 = in.h0.first(excess());
  return sage::path_error(*grains_, grains, effective(sigma, h), h.first(excess()));
}

double UndrainedLaw::stress_level(const Vector4& sigma, std::span<const double> h) const {
  return grains_->stress_level(effective(sigma, h), h.first(excess()));
}

bool UndrainedLaw::choose(int law, bool anew, const Vector4& sigma, std::span<double> h) const {
  const auto* const table = dynamic_cast<const ChoosesLaw<4>*>(grains_.get());
  return table == nullptr || table->choose(law, anew, effective(sigma, h), h.first(excess()));
}

LawPtr with_water(LawPtr law, bool undrained) {
  auto* const solid = std::get_if<std::unique_ptr<SolidLaw>>(&law);
  if (!undrained || solid == nullptr || *solid == nullptr) return law;
  return std::make_unique<UndrainedLaw>(std::move(*solid));
}

double bulk_for(const SolidLaw& law, double nu_u) {
  const Stiffness grains = at_zero_stress(law);
  if (nu_u == 0.5) return grains.G > 0.0 ? kRigid * grains.G : kUnknownStiffness;
  const double bulk = 2.0 * grains.G * (1.0 + nu_u) / (3.0 * (1.0 - 2.0 * nu_u)) - grains.K;
  return std::isfinite(bulk) && bulk > 0.0 ? bulk : kUnknownStiffness;
}

}  // namespace sage
