#include "materials/darcy_free_surface.hpp"

namespace sage {

namespace {

constexpr double kLeast = 1e-3;
constexpr Quantity kHistory[] = {{"relative_permeability", Dimension::none, 1.0}};

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = {
      required("permeability", Dimension::velocity, "permeability k1 where all pores hold water"),
      optional("permeability_2", Dimension::velocity, "permeability k2 across the direction of k1; 0 = k1",
               0.0),
      optional("direction", Dimension::angle, "direction of k1, counter-clockwise from +x", 0.0),
      optional("ramp", Dimension::length,
               "pressure head over which the permeability falls, half of it above and half below p = 0; 0 = "
               "the size "
               "of each element",
               0.0),
      optional("least", Dimension::none, "part of the permeability that dry soil keeps", kLeast)};
  return table;
}

}  // namespace

RelativePermeability relative_permeability(double pressure_head, double ramp, double least) {
  const double s = ramp > 0.0 ? pressure_head / ramp + 0.5 : pressure_head < 0.0 ? 0.0 : 1.0;
  if (s >= 1.0) return {1.0, 0.0};
  if (s <= 0.0) return {least, 0.0};
  return {least + (1.0 - least) * s * s * (3.0 - 2.0 * s), (1.0 - least) * 6.0 * s * (1.0 - s) / ramp};
}

DarcyFreeSurface::DarcyFreeSurface(const Matrix2& k, double ramp, double least)
    : k_(k), ramp_(ramp), least_(least) {}

LawTraits DarcyFreeSurface::traits() const {
  return {.history = kHistory, .wants_context = true};
}

// Steady: what flows follows from the head itself, whatever came before.
Outcome DarcyFreeSurface::update(const PointIn<3>& in, PointOut<3>& out) const {
  const Vector<3> eps = in.eps0 + in.deps;
  const double ramp = in.context->easing * (ramp_ > 0.0 ? ramp_ : in.context->size);
  const RelativePermeability k_r = relative_permeability(eps[2] - in.context->place.y(), ramp, least_);
  const Vector2 saturated = k_ * eps.head<2>();
  out.sigma << k_r.value * saturated, 0.0;
  out.D.setZero();
  out.D.topLeftCorner<2, 2>() = k_r.value * k_;
  out.D.topRightCorner<2, 1>() = k_r.slope * saturated;
  const bool stands = in.deps.isZero(0.0) && in.context->dt == 0.0;
  if (stands) out.sigma = in.sigma0;
  out.h1[0] = stands ? in.h0[0] : k_r.value;
  out.status = PointStatus::elastic;
  return Outcome::ok;
}

MaterialEntry darcy_free_surface_entry() {
  MaterialEntry entry{"darcy_free_surface", "Darcy's law below a free surface, nearly dry above it", 3, rows(),
                      [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
                        const Parameters p(rows(), values, units);
                        return std::make_unique<DarcyFreeSurface>(permeability_of(p), p.not_negative("ramp"),
                                                                  p.between("least", 1e-6, 0.1));
                      }};
  entry.flow = true;
  entry.history = kHistory;
  return entry;
}

}  // namespace sage
