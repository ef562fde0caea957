// Goodman, Taylor & Brekke (1968): joint with constant stiffness, no stress while open.
// docs/theory/goodman.md
#pragma once

#include <array>

#include "materials/parameters.hpp"
#include "sage/core/law.hpp"

namespace sage {

struct GoodmanParameters {
  double k_s, k_n;  // shear and normal stiffness                            [stress/length]
  bool opens;       // false: bonded for ever, and then the law is linear
};

// tau = k_s w_s, sigma_n = k_n w_n (Equation 7.14); both zero while the normal stress would be tensile.
// The joint closes again when the opening, kept as history, is used up.
class Goodman final : public InterfaceLaw {
 public:
  explicit Goodman(const GoodmanParameters& parameters) : p_(parameters) {}
  static constexpr std::array<Quantity, 1> kHistory{{{"gap", Dimension::length, 0.0}}};
  LawTraits traits() const override { return {.history = kHistory, .symmetric = true, .linear = !p_.opens}; }
  bool initialise(const Vector2& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector2& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<2>& in, PointOut<2>& out) const override;
  std::string caution() const override {
    return p_.k_s > 0.0 ? "" : "no shear resistance: the shear stiffness is zero";
  }

 private:
  enum { kGap };
  GoodmanParameters p_;
};

MaterialEntry goodman_entry();

}  // namespace sage
