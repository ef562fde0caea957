// Isotropic laws that large strain can use: their stress has an elastic logarithmic strain.
#pragma once

#include <span>

#include "sage/core/law.hpp"

namespace sage {

// Under large strain the law gets Kirchhoff stress and increments of the elastic logarithmic strain
// (docs/theory/large_strain.md).  It must answer strains that have not the axes of its stress by an elastic trial
// stress  sigma0 + 2 G dev(deps) + (mean stress).
class ElasticShear : public SolidLaw {
 public:
  // G of that trial stress at a committed state, for increments that leave the volume as it is.  > 0.
  virtual double shear_modulus(const Vector4& sigma, std::span<const double> h) const = 0;
};

}  // namespace sage
