// A law of one's own that depends on time: Maxwell's body.  This is the example of materials/README.md for laws
// that want their context.
#pragma once

#include "materials/linear_elastic.hpp"
#include "materials/parameters.hpp"
#include "sage/core/catalogue.hpp"

namespace own {

// d sigma/dt = D d eps/dt - sigma / tau, by backward Euler: sigma = (sigma0 + D deps) / (1 + dt / tau).  Under a
// strain that stays, n equal steps leave (1 + dt / tau)^-n of the stress.
class Maxwell final : public sage::SolidLaw {
 public:
  explicit Maxwell(const sage::Parameters& p)
      : D_(sage::elastic_matrix(
            sage::moduli_from_young(p.positive("youngs_modulus"), p.number("poissons_ratio")))),
        tau_(p.positive("relaxation_time")) {}
  sage::LawTraits traits() const override { return {.symmetric = true, .wants_context = true}; }
  sage::Outcome update(const sage::PointIn<4>& in, sage::PointOut<4>& out) const override {
    const double left = 1.0 / (1.0 + in.context->dt / tau_);
    out.sigma = left * (in.sigma0 + D_ * in.deps);
    out.D = left * D_;
    out.status = sage::PointStatus::elastic;
    return sage::Outcome::ok;
  }

 private:
  sage::Matrix4 D_;
  double tau_;
};

inline sage::MaterialEntry maxwell() {
  using sage::Dimension;
  static const std::vector<sage::Parameter> rows = {
      sage::required("youngs_modulus", Dimension::stress, "E", sage::ParameterRole::youngs_modulus),
      sage::required("poissons_ratio", Dimension::none, "nu", sage::ParameterRole::poissons_ratio),
      sage::required("relaxation_time", Dimension::none, "tau, in the unit of the stages' duration")};
  return {"maxwell", "elasticity that relaxes", 4, rows,
          [](std::span<const double> values, const sage::UnitSystem& units) -> sage::LawPtr {
            return std::make_unique<Maxwell>(sage::Parameters(rows, values, units));
          }};
}

}  // namespace own
