// Laws of bars, springs and rings: one force.  Tension positive.  docs/theory/structures.md
#pragma once

#include <array>
#include <limits>

#include "materials/parameters.hpp"
#include "sage/core/law.hpp"
#include "sage/core/spaced_members.hpp"

namespace sage {

// N = EA eps for each unit of thickness: what the card gives of one bar, divided by the spacing of the bars.
class AxialLaw : public Law<1>, public SpacedMembers {
 public:
  AxialLaw(double stiffness, double spacing) : EA_(stiffness / spacing), spacing_(spacing) {}
  double spacing() const override { return spacing_; }

 protected:
  double EA_;

 private:
  double spacing_;
};

class AxialElastic final : public AxialLaw {
 public:
  using AxialLaw::AxialLaw;
  LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<1>& in, PointOut<1>& out) const override;
};

// Carries tension (or compression) alone.  Slack is kept: the bar is taut again when the motion that made it slack
// has been undone.
class AxialOneWay final : public AxialLaw {
 public:
  AxialOneWay(double stiffness, double spacing, bool tension)
      : AxialLaw(stiffness, spacing), sign_(tension ? 1.0 : -1.0) {}
  static constexpr std::array<Quantity, 1> kHistory{{{"slack", Dimension::none, 0.0}}};
  LawTraits traits() const override { return {.history = kHistory, .symmetric = true}; }
  bool initialise(const Vector<1>& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector<1>& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<1>& in, PointOut<1>& out) const override;

 private:
  enum { kSlack };
  double sign_;
};

// Elastic up to a force in tension and one in compression, then perfectly plastic.
class AxialPlastic final : public AxialLaw {
 public:
  AxialPlastic(double stiffness, double spacing, double tension, double compression)
      : AxialLaw(stiffness, spacing), tension_(tension / spacing), compression_(compression / spacing) {}
  static constexpr std::array<Quantity, 1> kHistory{{{"plastic_strain", Dimension::none, 0.0}}};
  LawTraits traits() const override { return {.history = kHistory, .symmetric = true}; }
  bool initialise(const Vector<1>& sigma, std::span<double> h) const override;
  Outcome update(const PointIn<1>& in, PointOut<1>& out) const override;
  double stress_level(const Vector<1>& sigma, std::span<const double> h) const override;

 private:
  double tension_, compression_;  // both positive
};

MaterialEntry axial_elastic_entry();
MaterialEntry axial_one_way_entry();
MaterialEntry axial_plastic_entry();

}  // namespace sage
