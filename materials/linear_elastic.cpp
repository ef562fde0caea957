#include "materials/linear_elastic.hpp"

namespace sage {

ElasticModuli moduli_from_young(double youngs_modulus, double poissons_ratio) {
  return {youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio)),
          youngs_modulus / (2.0 * (1.0 + poissons_ratio))};
}

Matrix4 elastic_matrix(const ElasticModuli& moduli) {
  const double on = moduli.K + 4.0 / 3.0 * moduli.G;
  const double off = moduli.K - 2.0 / 3.0 * moduli.G;
  Matrix4 D;
  D << on, off, off, 0.0, off, on, off, 0.0, off, off, on, 0.0, 0.0, 0.0, 0.0, moduli.G;
  return D;
}

}  // namespace sage
