#include "materials/linear_elastic.hpp"

namespace sage {

namespace {

const std::vector<Parameter>& bulk_and_shear_rows() {
  static const std::vector<Parameter> rows = {
      required("bulk_modulus", Dimension::stress, "bulk modulus K", ParameterRole::modulus),
      required("shear_modulus", Dimension::stress, "shear modulus G", ParameterRole::modulus),
  };
  return rows;
}

}  // namespace

ElasticModuli moduli_from_young(double youngs_modulus, double poissons_ratio) {
  return {youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio)),
          youngs_modulus / (2.0 * (1.0 + poissons_ratio))};
}

ElasticModuli moduli_from_young_and_bulk(double youngs_modulus, double bulk_modulus) {
  return {bulk_modulus, 3.0 * bulk_modulus * youngs_modulus / (9.0 * bulk_modulus - youngs_modulus)};
}

Matrix4 elastic_matrix(const ElasticModuli& moduli) {
  const double on = moduli.K + 4.0 / 3.0 * moduli.G;
  const double off = moduli.K - 2.0 / 3.0 * moduli.G;
  Matrix4 D;
  D << on, off, off, 0.0, off, on, off, 0.0, off, off, on, 0.0, 0.0, 0.0, 0.0, moduli.G;
  return D;
}

std::vector<Parameter> elastic_rows() {
  return {required("youngs_modulus", Dimension::stress, "Young's modulus E", ParameterRole::youngs_modulus),
          required("poissons_ratio", Dimension::none, "Poisson's ratio nu, below 0.5",
                   ParameterRole::poissons_ratio)};
}

ElasticModuli elastic_parameters(const Parameters& p) {
  return moduli_from_young(p.positive("youngs_modulus"), p.poissons_ratio("poissons_ratio"));
}

MaterialEntry linear_elastic_entry() {
  return {"linear_elastic", "isotropic linear elasticity from Young's modulus and Poisson's ratio", 4,
          elastic_rows(), [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            const std::vector<Parameter> rows = elastic_rows();
            return std::make_unique<LinearElastic>(elastic_parameters(Parameters(rows, values, units)));
          }};
}

MaterialEntry linear_elastic_kg_entry() {
  return {"linear_elastic_kg", "isotropic linear elasticity from bulk and shear modulus", 4,
          bulk_and_shear_rows(), [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            const Parameters p(bulk_and_shear_rows(), values, units);
            return std::make_unique<LinearElastic>(
                ElasticModuli{p.positive("bulk_modulus"), p.positive("shear_modulus")});
          }};
}

}  // namespace sage
