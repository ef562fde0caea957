// A law of one's own: soil that is stiffer along its layers than across them.  This is the example of
// materials/README.md.
#pragma once

#include <Eigen/LU>

#include "materials/parameters.hpp"
#include "sage/core/catalogue.hpp"

namespace own {

// Cross-anisotropic elasticity, layers across y: eps = C sigma with E_h, E_v, nu_hh, nu_vh = -eps_h / eps_v
// under sigma_v, and G between y and x.  Love (1927), section 110.
class Layered final : public sage::SolidLaw {
 public:
  explicit Layered(const sage::Parameters& p) {
    const double E_h = p.positive("modulus_along"), E_v = p.positive("modulus_across"),
                 nu_hh = p.number("ratio_along"), nu_vh = p.number("ratio_across");
    sage::Matrix4 C = sage::Matrix4::Zero();
    C.topLeftCorner<3, 3>() << 1.0 / E_h, -nu_vh / E_v, -nu_hh / E_h,  //
        -nu_vh / E_v, 1.0 / E_v, -nu_vh / E_v,                         //
        -nu_hh / E_h, -nu_vh / E_v, 1.0 / E_h;
    C(3, 3) = 1.0 / p.positive("shear_modulus");
    D_ = C.inverse();
  }
  sage::LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  sage::Outcome update(const sage::PointIn<4>& in, sage::PointOut<4>& out) const override {
    out.sigma = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = sage::PointStatus::elastic;
    return sage::Outcome::ok;
  }

 private:
  sage::Matrix4 D_;
};

inline sage::MaterialEntry layered() {
  using sage::Dimension;
  static const std::vector<sage::Parameter> rows = {
      sage::required("modulus_along", Dimension::stress, "E_h, along the layers", sage::ParameterRole::modulus),
      sage::required("modulus_across", Dimension::stress, "E_v, across the layers",
                     sage::ParameterRole::modulus),
      sage::required("ratio_along", Dimension::none, "nu_hh"),
      sage::required("ratio_across", Dimension::none, "nu_vh"),
      sage::required("shear_modulus", Dimension::stress, "G between both", sage::ParameterRole::modulus)};
  return {"layered", "cross-anisotropic elasticity", 4, rows,
          [](std::span<const double> values, const sage::UnitSystem& units) -> sage::LawPtr {
            return std::make_unique<Layered>(sage::Parameters(rows, values, units));
          }};
}

}  // namespace own
