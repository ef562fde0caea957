// Isotropic linear elasticity in bulk and shear modulus, so that nu -> 1/2 loses no more than K/G does.
#pragma once

#include "sage/core/law.hpp"

namespace sage {

struct ElasticModuli {
  double K, G;  // bulk and shear modulus                                    [stress]
};

// From Young's modulus and Poisson's ratio: K = E/3(1-2nu), G = E/2(1+nu).
ElasticModuli moduli_from_young(double youngs_modulus, double poissons_ratio);

// D = K 1x1 + 2G I_dev with engineering shear.                              [chapter 7, E matrix]
Matrix4 elastic_matrix(const ElasticModuli& moduli);

class LinearElastic final : public SolidLaw {
 public:
  explicit LinearElastic(const ElasticModuli& moduli) : D_(elastic_matrix(moduli)) {}
  bool symmetric() const override { return true; }
  bool linear() const override { return true; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    out.sigma.noalias() = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  Matrix4 D_;
};

}  // namespace sage
