// The law my_clay of docs/tutorial/own_law.md: elastic up to the surface of von Mises, whose strength grows with the plastic
// shear strain: c = c0 + H gamma_p.
//
// Inside: tension positive, radians, [xx yy zz xy] with engineering shear strain (zz: out of plane, or hoop).
#include <array>
#include <cmath>

#include "materials/linear_elastic.hpp"
#include "materials/parameters.hpp"
#include "sage/core/plugin.hpp"

namespace {

using namespace sage;

// What a point remembers; outputs find it under this name.
constexpr std::array<Quantity, 1> kHistory{
    {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain}}};

// The order is that of the card of parameters.
const std::vector<Parameter>& table() {
  static const std::vector<Parameter> rows = {
      required("youngs_modulus", Dimension::stress, "E", ParameterRole::youngs_modulus),
      required("poissons_ratio", Dimension::none, "nu", ParameterRole::poissons_ratio),
      required("shear_strength", Dimension::stress, "c, the root of J2 at yield", ParameterRole::strength),
      optional("hardening", Dimension::stress, "H, growth of c with the plastic shear strain", 0.0)};
  return rows;
}

// Root of J2, and the deviator in `s`.
double root_of_j2(const Vector4& sigma, Vector4& s) {
  s = sigma;
  s.head<3>().array() -= sigma.head<3>().mean();
  return std::sqrt(0.5 * s.head<3>().squaredNorm() + s[3] * s[3]);
}

class MyClayLaw final : public SolidLaw {
 public:
  explicit MyClayLaw(const Parameters& p)
      : moduli_(moduli_from_young(p.positive("youngs_modulus"), p.poissons_ratio("poissons_ratio"))),
        elastic_(elastic_matrix(moduli_)),
        c_(p.positive("shear_strength")),
        hardening_(p.not_negative("hardening")) {}

  // D is symmetric in every state.
  LawTraits traits() const override { return {.history = kHistory, .symmetric = true}; }

  // Whether it can carry this stress at the start.
  bool initialise(const Vector4& sigma, std::span<double>) const override {
    Vector4 s;
    return root_of_j2(sigma, s) <= c_ * (1.0 + 1e-9);
  }

  // Committed state in, trial state out: stress, its derivative, history, status; every field on every call.
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    out.sigma = in.sigma0 + elastic_ * in.deps;
    out.D = elastic_;
    out.h1[0] = in.h0[0];
    out.status = PointStatus::elastic;
    Vector4 s;
    const double j = root_of_j2(out.sigma, s);
    const double c = strength(in.h0[0]);
    if (j <= c) return Outcome::ok;
    // j - G dg = c + H dg: the plastic shear strain dg takes the deviator back along the radius; the mean stress stays.
    const double G = moduli_.G;
    const double dg = (j - c) / (G + hardening_);
    const double r = 1.0 - G * dg / j;
    out.sigma -= (1.0 - r) * s;
    const Vector4 mean(1.0, 1.0, 1.0, 0.0);
    const Matrix4 volume = moduli_.K * mean * mean.transpose();
    out.D =
        volume + r * (elastic_ - volume) - (G / (j * j)) * (G / (G + hardening_) - 1.0 + r) * s * s.transpose();
    out.h1[0] += dg;
    out.status = PointStatus::yielded;
    return Outcome::ok;
  }

  double stress_level(const Vector4& sigma, std::span<const double> history) const override {
    Vector4 s;
    return root_of_j2(sigma, s) / strength(history[0]);
  }

 private:
  double strength(double plastic_shear_strain) const { return c_ + hardening_ * plastic_shear_strain; }

  ElasticModuli moduli_;
  Matrix4 elastic_;
  double c_;
  double hardening_;
};

MaterialEntry entry() {
  MaterialEntry law{"my_clay", "elastic up to the surface of von Mises, which hardens", 4, table(),
                    [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
                      return std::make_unique<MyClayLaw>(Parameters(table(), values, units));
                    }};
  law.history = kHistory;
  // With what `sagefe conform` tries it: parameters in kPa, m and degrees, and an increment of strain that reaches
  // the strength.
  law.trials = {{.values = {2e4, 0.3, 50.0, 0.0}, .strain = 0.01, .bounded = true},
                {.values = {2e4, 0.49, 50.0, 2e3}, .strain = 0.01, .bounded = true}};
  return law;
}

}  // namespace

SAGE_PLUGIN("my_clay", "0.1", "nobody yet",
            [](Catalogue& catalogue) { catalogue.materials.add(1000, entry()); })
