#include "materials/register_materials.hpp"

#include "materials/linear_elastic.hpp"

namespace sage {

namespace {

// Young's modulus and Poisson's ratio as decks give them (parameters `at` and `at + 1`).
ElasticModuli checked_moduli(std::span<const double> values, std::size_t at) {
  const double E = values[at], nu = values[at + 1];
  if (!(E > 0.0)) throw ParameterError(static_cast<int>(at), "Young's modulus must be greater than 0");
  if (nu >= 0.5)
    throw ParameterError(
        static_cast<int>(at) + 1,
        "Poisson's ratio must be below 0.5 (no mixed element here); 0.4999999 is safe with B-bar");
  if (!(nu > -1.0)) throw ParameterError(static_cast<int>(at) + 1, "Poisson's ratio must be greater than -1");
  return moduli_from_young(E, nu);
}

MaterialEntry linear_elastic_entry() {
  return {"linear_elastic",
          "isotropic linear elasticity from Young's modulus and Poisson's ratio",
          4,
          {{"youngs_modulus", Dimension::stress, "Young's modulus E", 0.0, true},
           {"poissons_ratio", Dimension::none, "Poisson's ratio nu, below 0.5", 0.0, true}},
          [](std::span<const double> values, const UnitSystem&) -> LawPtr {
            return std::make_unique<LinearElastic>(checked_moduli(values, 0));
          }};
}

}  // namespace

void register_materials(Catalogue& catalogue) {
  catalogue.materials.add(1, linear_elastic_entry());
}

}  // namespace sage
