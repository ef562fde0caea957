// beam3 for sections that may yield: two beam2 in a row, from node 1 to node 3 and on to node 2.  docs/theory/structures.md
#pragma once

#include <string_view>
#include <vector>

#include "elements/beam.hpp"

namespace sage {

// Dofs as those of Beam3; a side that is curved becomes two chords.
template <class Kinematics, Release released = Release::none>
class BeamHalves final : public Element {
  static constexpr int kDofs = 9 + slip_dofs(released);

 public:
  explicit BeamHalves(std::string_view name);
  const ElementTraits& traits() const override { return traits_; }
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Outcome evaluate(const ElementIn& in, ElementOut& out) const override;
  Vector2 position(const NodeCoordinates& x, int point) const override;
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override;
  const std::vector<std::vector<int>>& edges() const override;
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override;
  // Formulation::force_at.
  static void force_at(const NodeCoordinates& x, double xi, const Vector2& force, std::span<double> f);
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override;

 private:
  Beam2<Kinematics, released> first_;
  Beam2<Kinematics> second_;
  ElementTraits traits_;
};

}  // namespace sage
