// Laws of beams and shells: forces and moments of a section, for each unit of width.
// [axial, hoop, shear, bending, hoop bending], tension positive.  docs/theory/structures.md
#pragma once

#include <array>

#include "materials/parameters.hpp"
#include "sage/core/law.hpp"

namespace sage {

// Constant stiffness.  along, around: force for a strain; bending the same of moments; `coupling`: what a strain
// around adds along, and the other way round, as a share (Poisson's ratio of a plate).
struct SectionStiffness {
  double EA = 0.0, EA_around = 0.0, GA = 0.0, EI = 0.0, EI_around = 0.0, coupling = 0.0;

  Matrix<5> matrix() const;
};

class SectionElastic final : public Law<5> {
 public:
  explicit SectionElastic(const SectionStiffness& stiffness) : D_(stiffness.matrix()) {}
  LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<5>& in, PointOut<5>& out) const override {
    out.sigma.noalias() = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  Matrix<5> D_;
};

// The same until axial force and moment reach |M|/M_p + (N/N_p)^2 = 1, the strength of a rectangle of one yield
// stress; then plastic with the normal as its flow, without hardening.  Shear and what runs around the axis stay
// elastic.
class SectionPlastic final : public Law<5> {
 public:
  // Strengths are positive; infinity: no limit.
  SectionPlastic(const SectionStiffness& stiffness, double axial_strength, double moment_strength)
      : s_(stiffness), D_(stiffness.matrix()), n_(1.0 / axial_strength), m_(1.0 / moment_strength) {}
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_axial_strain", Dimension::none, 0.0}, {"plastic_curvature", Dimension::none, 0.0}}};
  LawTraits traits() const override { return {.history = kHistory, .symmetric = true}; }
  bool initialise(const Vector<5>& sigma, std::span<double> h) const override;
  Outcome update(const PointIn<5>& in, PointOut<5>& out) const override;
  double stress_level(const Vector<5>& sigma, std::span<const double> h) const override;
  std::string caution() const override {
    if (s_.EA_around == 0.0 && s_.EI_around == 0.0) return {};
    return "only the force and the moment along the line are limited: those around the axis stay elastic, so "
           "that a "
           "plate or shell that needs them to fail has no collapse load";
  }

 private:
  enum { kAxial = 0, kBending = 3 };
  double multiplier(double N, double M) const;

  SectionStiffness s_;
  Matrix<5> D_;
  double n_, m_;  // one over the strengths
};

MaterialEntry plate_entry();            // E, nu, thickness
MaterialEntry section_elastic_entry();  // EA, EI, GA
MaterialEntry section_plastic_entry();  // EA, EI, N_p, M_p, GA

}  // namespace sage
