#include "materials/duncan_selig.hpp"

#include "materials/duncan_chang.hpp"

namespace sage {

MaterialEntry duncan_selig_entry() {
  return {"duncan_selig",
          "hyperbolic E and bulk modulus of the mean stress (Duncan; Selig 1988)",
          4,
          duncan_chang_rows(VolumeRule::bulk_selig),
          [](std::span<const double> values, const UnitSystem& units) {
            return make_duncan_chang(VolumeRule::bulk_selig, values, units);
          },
          DuncanChang::kHistory};
}

}  // namespace sage
