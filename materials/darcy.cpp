#include "materials/darcy.hpp"

#include <cmath>

namespace sage {

namespace {

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = {
      required("permeability", Dimension::velocity, "permeability k1"),
      optional("permeability_2", Dimension::velocity, "permeability k2 across the direction of k1; 0 = k1",
               0.0),
      optional("direction", Dimension::angle, "direction of k1, counter-clockwise from +x", 0.0)};
  return table;
}

}  // namespace

Darcy::Darcy(const Matrix2& k) : D_(Matrix<3>::Zero()) {
  D_.topLeftCorner<2, 2>() = k;
}

// 90 degrees give cos = 6e-17, which would couple the directions by rounding.
Matrix2 turned_permeability(double k1, double k2, double angle) {
  const double turns = angle / (0.5 * kPi), whole = std::round(turns);
  if (turns == whole) {
    const bool across = std::fmod(std::abs(whole), 2.0) == 1.0;
    return Vector2(across ? k2 : k1, across ? k1 : k2).asDiagonal();
  }
  const double c = std::cos(angle), s = std::sin(angle);
  Matrix2 k;
  k << k1 * c * c + k2 * s * s, (k1 - k2) * c * s, (k1 - k2) * c * s, k1 * s * s + k2 * c * c;
  return k;
}

Matrix2 permeability_of(const Parameters& p) {
  const double k1 = p.positive("permeability"), k2 = p.not_negative("permeability_2");
  const double angle = p.between("direction", -360.0, 360.0) * kRadiansPerDegree;
  return turned_permeability(k1, k2 > 0.0 ? k2 : k1, angle);
}

MaterialEntry darcy_entry() {
  MaterialEntry entry{"darcy", "Darcy's law, saturated, isotropic or along two directions", 3, rows(),
                      [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
                        const Parameters p(rows(), values, units);
                        return std::make_unique<Darcy>(permeability_of(p));
                      }};
  entry.flow = true;
  return entry;
}

}  // namespace sage
