// Isotropic linear elasticity in bulk and shear modulus, so that nu -> 1/2 loses no more than K/G does.
// docs/theory/linear_elastic.md
#pragma once

#include "materials/parameters.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/law.hpp"

namespace sage {

struct ElasticModuli {
  double K, G;  // bulk and shear modulus                                    [stress]
};

// From Young's modulus and Poisson's ratio: K = E / (3 (1 - 2 nu)), G = E / (2 (1 + nu)).
ElasticModuli moduli_from_young(double youngs_modulus, double poissons_ratio);

// From Young's and bulk modulus: G = 3KE/(9K-E), finite for nu = 1/2.        [Duncan et al. 1980]
ElasticModuli moduli_from_young_and_bulk(double youngs_modulus, double bulk_modulus);

// D = K 1x1 + 2G I_dev with engineering shear.                              [chapter 7, E matrix]
Matrix4 elastic_matrix(const ElasticModuli& moduli);

class LinearElastic final : public ElasticShear {
 public:
  explicit LinearElastic(const ElasticModuli& moduli) : D_(elastic_matrix(moduli)) {}
  LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    out.sigma.noalias() = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }
  double shear_modulus(const Vector4& /*sigma*/, std::span<const double> /*h*/) const override {
    return D_(3, 3);
  }

 private:
  Matrix4 D_;
};

// Young's modulus and Poisson's ratio as decks give them, of a law whose table has the rows.
ElasticModuli elastic_parameters(const Parameters& p);
std::vector<Parameter> elastic_rows();

MaterialEntry linear_elastic_entry();     // E, nu
MaterialEntry linear_elastic_kg_entry();  // K, G

}  // namespace sage
