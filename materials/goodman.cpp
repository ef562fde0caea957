#include "materials/goodman.hpp"

namespace sage {

namespace {

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = {
      required("shear_stiffness", Dimension::stress_per_length, "shear stiffness k_s"),
      required("normal_stiffness", Dimension::stress_per_length, "normal stiffness k_n"),
      optional("tension", Dimension::none, "0 opens in tension, 1 never opens", 0.0),
  };
  return table;
}

}  // namespace

bool Goodman::initialise(const Vector2& sigma, std::span<double> h) const {
  h[kGap] = 0.0;
  return !p_.opens || sigma[1] <= 0.0;
}

// A gap stands between bodies that don't touch.
bool Goodman::accepts_history(const Vector2& sigma, std::span<const double> h) const {
  return h[kGap] == 0.0 || (p_.opens && h[kGap] > 0.0 && sigma.isZero(0.0));
}

Outcome Goodman::update(const PointIn<2>& in, PointOut<2>& out) const {
  // An open joint carries nothing until its gap is used up; a closed one has no gap.
  const double opening = in.h0[kGap] + in.deps[1];
  const double normal = in.sigma0[1] + p_.k_n * opening;

  if (p_.opens && normal > 0.0) {
    out.sigma.setZero();
    out.D.setZero();
    out.h1[kGap] = opening + in.sigma0[1] / p_.k_n;
    out.status = PointStatus::open;
    return Outcome::ok;
  }
  out.sigma << in.sigma0[0] + p_.k_s * in.deps[0], normal;  // Equation 7.14
  out.D << p_.k_s, 0.0, 0.0, p_.k_n;
  out.h1[kGap] = 0.0;
  out.status = PointStatus::elastic;
  return Outcome::ok;
}

MaterialEntry goodman_entry() {
  return {
      "goodman",
      "interface with constant shear and normal stiffness, no stress while open",
      2,
      rows(),
      [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
        const Parameters p(rows(), values, units);
        return std::make_unique<Goodman>(GoodmanParameters{
            p.not_negative("shear_stiffness"), p.positive("normal_stiffness"), p.code("tension", {0, 1}) == 0});
      },
      Goodman::kHistory};
}

}  // namespace sage
